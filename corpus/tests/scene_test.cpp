// SPDX-License-Identifier: Apache-2.0
//
// The scene format: exact round trips, strict refusals, whole files only; and the corpus is legal.
#include "corpus/scene.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace surefill::corpus {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDraw = "draw\n  vertex 0 0 0 1\n  vertex 4 0 0 1\n  vertex 0 4 0 1\n  triangle 0 1 2\nend\n";

// A scene text with these lines before the first draw (line 3 is the first of them) and a plain draw after them.
std::string with_frame_lines(const std::string& lines) {
  return "surefill-scene 1\ntarget 4 4\n" + lines + "\n" + kDraw;
}

// A scene text with these lines in its draw; line 4 is the first of them.
std::string with_draw_lines(const std::string& lines) {
  return "surefill-scene 1\ntarget 4 4\ndraw\n" + lines + "\nend\n";
}

std::string refusal(const std::string& text) {
  try {
    (void)read_scene(text, "f");
  } catch (const SceneError& error) {
    return error.what();
  }
  return "accepted";
}

class EmptyFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("surefill-scene-test-" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directory(folder_);
  }
  void TearDown() override {
    fs::permissions(folder_, fs::perms::owner_all);
    fs::remove_all(folder_);
  }
  std::ptrdiff_t files() const {
    return std::distance(fs::recursive_directory_iterator(folder_), fs::recursive_directory_iterator());
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  fs::path folder_;
};

Scene triangle_scene() {
  return read_scene(with_frame_lines(""));
}

TEST(Corpus, EveryFileComesBackAndIsLegal) {
  for (const std::string& path : list_corpus(SUREFILL_CORPUS "/cases")) {
    SCOPED_TRACE(path);
    const Scene scene = read_scene_file(path);
    const std::string text = write_scene(scene);
    const Scene again = read_scene(text, "written");
    EXPECT_TRUE(equal(scene, again));
    EXPECT_EQ(text, write_scene(again));
    EXPECT_NE(scene.comment.find("Origin: "), std::string::npos);
    const Frame frame(scene);
    EXPECT_EQ(validate(frame.target(), frame.draws()), Status::ok);
  }
}

TEST(SceneText, AwkwardFloatsComeBackBitForBit) {
  std::vector<float> values{0.F,  -0.F,    0x1p-149F, -0x1p-149F, 0x1.8p-140F, 0x1p-126F,        0x1.fffffep-127F,
                            0.1F, 1.F / 3, 0x1p24F,   9999.5F,    12345.F,     0x1.fffffep+127F, 999999,
                            1e6F, 0.0625F, 0.03125F,  -99.75F,    65536.0625F};
  values.push_back(std::numeric_limits<float>::infinity());
  values.push_back(-std::numeric_limits<float>::infinity());
  std::uint32_t bits = 1;
  for (int i = 0; i < 100000; ++i) {
    bits = bits * 1664525 + 1013904223;
    const auto value = std::bit_cast<float>(bits);
    if (!std::isnan(value)) values.push_back(value);
  }
  Scene scene = triangle_scene();
  for (const float value : values) scene.draws[0].vertices.push_back({value, -value, 0, 1, {}});
  const Scene again = read_scene(write_scene(scene));
  EXPECT_TRUE(equal(scene, again));
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint32_t>(again.draws[0].vertices[i + 3].x), std::bit_cast<std::uint32_t>(values[i]));
  }
}

TEST(SceneText, NansComeBackAsNan) {
  Scene scene = triangle_scene();
  scene.draws[0].vertices[1].z = std::bit_cast<float>(0xffc01234u);
  EXPECT_NE(write_scene(scene).find("vertex 4 0 nan 1"), std::string::npos);
  EXPECT_TRUE(equal(scene, read_scene(write_scene(scene))));
}

TEST(SceneText, EveryFieldComesBack) {
  Scene scene;
  scene.comment = "Title\n\n  indented # and more\t\xc3\xa9\n";
  scene.width = 3;
  scene.height = 2;
  scene.samples = 4;
  scene.depth_test = DepthTest::greater_equal;
  scene.origin = {-4194304, 7};
  scene.sample_locations = {{0, 15}, {3, 4}, {3, 4}, {15, 0}};
  scene.more = {true, true, true};
  scene.attribute_location = AttributeLocation::centroid;
  for (int i = 0; i < 24; ++i) scene.initial_depth.push_back(static_cast<float>(i) / 3);
  scene.attributes = {{"u-v", 2, Interpolation::noperspective}, {"_id", 1, Interpolation::flat}};
  SceneDraw draw;
  draw.viewport = Viewport{1, 2, 3, 4, 0.1F, 0.9F, ClipDepth::zero_to_one, ClipY::down};
  draw.vertices = {{1, 2, 3, 4, {5, 6, 7}}, {8, 9, 10, -0.F, {-0.F, 0.3F, 1e-45F}}, {0, 0, 0, 1, {0, 0, 0}}};
  draw.triangles = {{{0, 1, 2}, 7}, {{2, 1, 0}, 4294967294}};
  draw.width = 0.3F;
  draw.first_index = 5;
  draw.interpolations = {Interpolation::flat};
  draw.front_face = FrontFace::counter_clockwise;
  draw.cull = Cull::front;
  draw.depth_mode = DepthMode::clamp;
  draw.depth_write = false;
  draw.scissor = Scissor{-2147483647 - 1, 0, 2147483647, 1};
  draw.grid = Grid{12, 15, 3, GridRounding::truncate};
  draw.culling_box.emplace().fill({1, 2, 3, 0.1F});
  draw.depth_bias = DepthBias{-0.F, 0.1F};
  for (const FillRule rule :
       {FillRule::top_left, FillRule::top_right, FillRule::bottom_left, FillRule::bottom_right, FillRule::southwards,
        FillRule::southwards_west, FillRule::northwards, FillRule::northwards_west}) {
    draw.fill_rule = rule;
    scene.draws.push_back(draw);
  }
  scene.draws[1].viewport->clip_depth = ClipDepth::minus_one_to_one;
  scene.draws[2].viewport->clip_depth = ClipDepth::minus_one_to_one;
  scene.draws[2].viewport->clip_y = ClipY::up;
  scene.draws[3].viewport->clip_y = ClipY::up;
  const std::string text = write_scene(scene);
  EXPECT_TRUE(equal(scene, read_scene(text))) << text;
  Scene changed = scene;
  changed.draws[7].vertices[1].w = 0;
  EXPECT_FALSE(equal(scene, changed));
  Scene layered = triangle_scene();
  layered.layers = 16;
  EXPECT_TRUE(equal(layered, read_scene(write_scene(layered))));
  EXPECT_FALSE(equal(layered, triangle_scene()));
}

TEST(Scene, LinesAndPointsAreWrittenAndReadAgain) {
  for (const Primitive primitive : {Primitive::lines, Primitive::points}) {
    Scene scene = read_scene(with_frame_lines(""));
    SceneDraw& draw = scene.draws[0];
    draw.primitive = primitive;
    draw.width = 0.3F;
    const bool lines = primitive == Primitive::lines;
    draw.triangles = {{{0, lines ? 2u : 0u, lines ? 2u : 0u}, 7}, {{1, 1, 1}, 8}};
    EXPECT_TRUE(equal(read_scene(write_scene(scene)), scene)) << write_scene(scene);
    const Frame frame(scene);
    EXPECT_EQ(frame.draws()[0].indices.size(), lines ? 4u : 2u);
    EXPECT_EQ(validate(frame.target(), frame.draws()), Status::ok);
  }
}

TEST(SceneText, CommentsComeBack) {
  for (const char* comment : {"", "a", "a\nb", "a\n", "\n", "\n\na", " a", "a\n\nb", "#", "a # b "}) {
    Scene scene = triangle_scene();
    scene.comment = comment;
    EXPECT_EQ(read_scene(write_scene(scene)).comment, comment) << write_scene(scene);
  }
  Scene scene = triangle_scene();
  scene.comment = std::string(10000, 'x');
  EXPECT_TRUE(equal(scene, read_scene(write_scene(scene))));
  scene.comment = std::string("a\0b", 3);
  EXPECT_THROW((void)write_scene(scene), SceneError);
}

TEST(SceneText, DefaultsAreLeftOutAndNumbersReadWell) {
  EXPECT_EQ(write_scene(triangle_scene()), std::string("surefill-scene 1\ntarget 4 4\n\n") + kDraw);
  Scene scene = triangle_scene();
  scene.draws[0].vertices = {{0.5F, -0.F, 0.1F, 0x1p-149F, {}}, {12345.5F, 99999.F, -1.0625F, -8.25F, {}}};
  scene.draws[0].triangles.clear();
  EXPECT_EQ(write_scene(scene),
            "surefill-scene 1\ntarget 4 4\n\ndraw\n  vertex 0.5 -0 0x1.99999ap-4 0x0.000002p-126\n"
            "  vertex 0x1.81ccp+13 99999 -0x1.1p+0 -8.25\nend\n");
}

TEST(SceneText, LineEndsAndTrailingCommentsAreFree) {
  const Scene scene =
      read_scene("# A\r\n\r\n#B\r\nsurefill-scene 1 # version\r\n# not this\r\n\ttarget\t4 4\r\ndraw\r\nend\r\n");
  EXPECT_EQ(scene.comment, "A\nB");
  EXPECT_EQ(scene.width, 4);
}

TEST(SceneText, DecimalsAreRoundedOnceToNearest) {
  // Above the midpoint of 1 and its successor by less than a double can tell: rounding through double would give 1.
  const Scene scene = read_scene(with_draw_lines("vertex 1.000000059604644775390626 16777217 8e-46 3.4028235e38"));
  const SceneVertex& vertex = scene.draws[0].vertices[0];
  EXPECT_EQ(vertex.x, 0x1.000002p+0F);
  EXPECT_EQ(vertex.y, 16777216.F);
  EXPECT_EQ(vertex.z, 0x1p-149F);
  EXPECT_EQ(vertex.w, std::numeric_limits<float>::max());
}

// float.hex() of a double that is a float32: 13 digits after the point, zeros at their end.
TEST(SceneText, HexfloatsAsPythonWritesThem) {
  const Scene scene = read_scene(with_draw_lines(
      "vertex 0x1.99999a0000000p-4 -0x1.8000000000000p+0 0x0.0000020000000p-126 0x1.fffffe0000000p+127\n"
      "vertex 0x0.0p+0 -0x0.0p+0 0x1.0000000000000p-149 0x1.00000000000000000000p+0"));
  const std::vector<SceneVertex>& v = scene.draws[0].vertices;
  EXPECT_EQ(v[0].x, 0.1F);
  EXPECT_EQ(v[0].y, -1.5F);
  EXPECT_EQ(v[0].z, 0x1p-149F);
  EXPECT_EQ(v[0].w, std::numeric_limits<float>::max());
  EXPECT_EQ(std::bit_cast<std::uint32_t>(v[1].y), 0x80000000u);
  EXPECT_EQ(v[1].z, 0x1p-149F);
  EXPECT_EQ(v[1].w, 1.F);
}

TEST(SceneText, AByteOrderMarkIsPassedOver) {
  const std::string text = "# A\n" + with_frame_lines("");
  EXPECT_TRUE(equal(read_scene("\xef\xbb\xbf" + text), read_scene(text)));
  EXPECT_EQ(refusal("\xef\xbb\xbf\xef\xbb\xbf" + text), "f:1: the first line must be 'surefill-scene 1'");
}

TEST(SceneText, OneInitialDepthServesAllSamples) {
  const Scene scene = read_scene(with_frame_lines("initial-depth nan"));
  EXPECT_EQ(scene.initial_depth.size(), 1u);
  const Frame frame(scene);
  ASSERT_EQ(frame.target().initial_depth.size(), 16u);
  EXPECT_TRUE(std::isnan(frame.target().initial_depth[15]));
}

TEST(SceneText, AHugeTargetIsReadWithoutItsMemory) {
  const Scene scene = read_scene(std::string("surefill-scene 1\ntarget 16384 16384\nsamples 16\n") + kDraw);
  EXPECT_EQ(scene.width, 16384);
}

TEST(SceneText, EveryCutIsRefused) {
  const std::string text =
      "# c\nsurefill-scene 1\ntarget 4 4\nattribute a 1 flat\ndraw\nvertex 1 2 3 4 5\ntriangle 0 0 0\nend\n";
  for (std::size_t size = 0; size < text.size(); ++size) {
    EXPECT_NE(refusal(text.substr(0, size)), "accepted") << size;
  }
  EXPECT_EQ(refusal(text), "accepted");
}

struct Refusal {
  std::string text, message;
};

TEST(SceneText, RefusalsNameLineAndCause) {
  const std::string three = "vertex 0 0 0 1\nvertex 4 0 0 1\nvertex 0 4 0 1\n";
  const std::vector<Refusal> refusals{
      // The file as a whole.
      {"", "f:1: the first line must be 'surefill-scene 1'"},
      {"# only a comment\n", "f:1: the first line must be 'surefill-scene 1'"},
      {"\n\ntarget 4 4\n", "f:3: the first line must be 'surefill-scene 1'"},
      {"surefill-scene 2\n", "f:1: version 2 is unknown; this reads version 1"},
      {"surefill-scene 1.0\n", "f:1: '1.0' is not an integer"},
      {"surefill-scene\n", "f:1: surefill-scene VERSION: 1 field expected, 0 given"},
      {"surefill-scene 1", "f:1: the last line has no line break: the file is cut short"},
      {"surefill-scene 1\ntarget 4 4\n", "f:2: no draw"},
      {"surefill-scene 1\ndraw\nend\n", "f:2: no target before the first draw"},
      {"\x1f\x8b\x08garbage",
       "f:1: this is gzip-compressed: scenes (.scene) and meshes (Wavefront .obj, .ply, .stl) are read; text in "
       "UTF-8"},
      {"\xff\xfes",
       "f:1: this is text in UTF-16: scenes (.scene) and meshes (Wavefront .obj, .ply, .stl) are read; text in UTF-8"},
      {with_frame_lines(std::string("sam\0ples 1", 10)), "f:3: control character: this is not a text file"},
      {with_frame_lines("# \x1b[0m"), "f:3: control character: this is not a text file"},
      {with_frame_lines("\x89PNG"), "f:3: unknown keyword '?PNG'"},
      {with_frame_lines(std::string(5000, 'x')), "f:3: line longer than 4096 characters"},
      {with_frame_lines(std::string(100, 'x')), "f:3: unknown keyword '" + std::string(40, 'x') + "...'"},
      {with_frame_lines("") + "samples 1\n", "f:10: 'samples' after a draw: only another draw can follow"},
      {with_frame_lines("end"), "f:3: unknown keyword 'end'"},
      // The frame.
      {with_frame_lines("surefill-scene 1"), "f:3: unknown keyword 'surefill-scene'"},
      {with_frame_lines("target 4 4"), "f:3: target is given twice"},
      {with_frame_lines("samples"), "f:3: samples N: 1 field expected, 0 given"},
      {with_frame_lines("samples 3"), "f:3: '3' is none of: 1, 2, 4, 8, 16"},
      {with_frame_lines("samples 32"), "f:3: '32' is outside 1..16"},
      {with_frame_lines("depth-test equal"), "f:3: 'equal' is none of: less, greater, less-equal, greater-equal"},
      {with_frame_lines("attribute-location center"), "f:3: 'center' is none of: centre, centroid"},
      {with_frame_lines("origin 4194305 0"), "f:3: '4194305' is outside -4194304..4194304"},
      {with_frame_lines("sample-locations 1 2 3"), "f:3: sample-locations X Y...: an X without a Y"},
      {with_frame_lines("sample-locations 1 16"), "f:3: '16' is outside 0..15"},
      {with_frame_lines("sample-locations 1 2\nsamples 2"), "f:3: sample-locations: 1 places for 2 samples (S7)"},
      {with_frame_lines("layers 17"), "f:3: '17' is outside 1..16"},
      {with_frame_lines("outputs depth"), "f:3: 'depth' is none of: winding, numbers, conservative-index"},
      {with_frame_lines("outputs winding winding"), "f:3: 'winding' is given twice"},
      {with_frame_lines("layers 2\ndraw\nconservative over\nend"),
       "f:5: a frame with a conservative draw has one layer (V4)"},
      {with_frame_lines("layers 2\ndraw\ndepth-write off\nend"),
       "f:6: a frame with layers has no draw with depth-write off (V4)"},
      {with_frame_lines("sample-locations 1 2\ndraw\nconservative over\nend"),
       "f:5: a frame with a conservative draw has no sample locations (S7)"},
      {with_draw_lines("depth-bias 0 inf"), "f:4: 'inf' is not finite"},
      {with_draw_lines("primitive line"), "f:4: 'line' is none of: triangles, lines, points"},
      {with_draw_lines("primitive lines\nwidth 0"), "f:5: '0' is not greater than 0"},
      {with_draw_lines("vertex 0 0 0 1\nline 0 0"), "f:5: line in a draw whose primitive is not lines"},
      {with_draw_lines("primitive points\nvertex 0 0 0 1\npoint 0\nline 0 0"),
       "f:7: a draw has triangles, lines or points, and one kind of them"},
      {with_draw_lines("primitive points\nvertex 0 0 0 1\npoint 0 1"),
       "f:6: point: 'id' and a number may follow the vertices"},
      {with_draw_lines("primitive points\ndepth-bias 0 1"), "f:6: lines and points have no depth-bias (I8)"},
      {with_draw_lines("grid 8 0 0 truncate\nprimitive lines"), "f:6: lines and points have no grid (M7)"},
      {with_frame_lines("initial-depth"), "f:3: initial-depth Z...: 1 or more fields expected, 0 given"},
      {with_frame_lines("initial-depth 1 2\ninitial-depth 3"),
       "f:4: initial-depth: 3 values for a target of 16 samples; give one, or one a sample"},
      {with_frame_lines("attribute a 1"), "f:3: attribute NAME COMPONENTS INTERPOLATION: 3 fields expected, 2 given"},
      {with_frame_lines("attribute a 5 flat"), "f:3: '5' is outside 1..4"},
      {with_frame_lines("attribute 1a 1 flat"),
       "f:3: '1a' is not a name: letters, digits, '_' and '-' after a letter or '_'"},
      {with_frame_lines("attribute a 1 smooth"), "f:3: 'smooth' is none of: perspective, noperspective, flat"},
      {with_frame_lines("attribute a 1 flat\nattribute a 2 flat"), "f:4: attribute 'a' is given twice"},
      {"surefill-scene 1\ntarget 0 4\n", "f:2: '0' is outside 1..16384"},
      {"surefill-scene 1\ntarget 4 16385\n", "f:2: '16385' is outside 1..16384"},
      {"surefill-scene 1\ntarget 4\n", "f:2: target WIDTH HEIGHT: 2 fields expected, 1 given"},
      {"surefill-scene 1\ntarget 4 99999999999999999999\n", "f:2: '99999999999999999999' is outside 1..16384"},
      {"surefill-scene 1\ntarget 4 +4\n", "f:2: '+4' is not an integer"},
      {"surefill-scene 1\ntarget 4 0x4\n", "f:2: '0x4' is not an integer"},
      // The draw.
      {"surefill-scene 1\ntarget 4 4\ndraw 1\nend\n", "f:3: draw: 0 fields expected, 1 given"},
      {"surefill-scene 1\ntarget 4 4\ndraw\n", "f:3: the draw of line 3 has no end"},
      {"surefill-scene 1\ntarget 4 4\ndraw\ncull back\n\n", "f:5: the draw of line 3 has no end"},
      {with_draw_lines("draw"), "f:4: unknown keyword 'draw'"},
      {with_draw_lines("cull none\ncull none"), "f:5: cull is given twice"},
      {with_draw_lines("cull both"), "f:4: 'both' is none of: none, front, back"},
      {with_draw_lines("front-face cw"), "f:4: 'cw' is none of: clockwise, counter-clockwise"},
      {with_draw_lines("fill-rule top_left"),
       "f:4: 'top_left' is none of: top-left, top-right, bottom-left, bottom-right, southwards, southwards-west, "
       "northwards, northwards-west, closed, open"},
      {with_draw_lines("depth-mode cut"), "f:4: 'cut' is none of: none, clip, clamp"},
      {with_draw_lines("depth-write yes"), "f:4: 'yes' is none of: on, off"},
      {with_draw_lines("conservative outer"), "f:4: 'outer' is none of: none, over, inner, overlap, touched"},
      {with_draw_lines("scissor 0 0 1"), "f:4: scissor X0 Y0 X1 Y1: 4 fields expected, 3 given"},
      {with_draw_lines("scissor 0 0 1 2147483648"), "f:4: '2147483648' is outside -2147483648..2147483647"},
      {with_draw_lines("scissor 0 0 1 1.5"), "f:4: '1.5' is not an integer"},
      {with_draw_lines("grid 13 0 0 truncate"), "f:4: '13' is outside 0..12"},
      {with_draw_lines("grid 8 16 0 truncate"), "f:4: '16' is outside 0..15"},
      {with_draw_lines("grid 8 0 -1 truncate"), "f:4: '-1' is outside 0..15"},
      {with_draw_lines("grid 8 0 0 down"), "f:4: 'down' is none of: nearest-even, nearest-up, truncate"},
      {with_draw_lines("culling-box 1 2 3"), "f:4: culling-box X Y Z W of eight corners: 32 fields expected, 3 given"},
      {with_draw_lines("viewport 0 0 4 4 0 inf"), "f:4: 'inf' is not finite"},
      {with_draw_lines("viewport 0 0 4 4 0 nan"), "f:4: 'nan' is not finite"},
      {with_draw_lines("viewport 0 0 4 4 0"),
       "f:4: viewport X Y WIDTH HEIGHT NEAR FAR [DEPTH-RANGE [Y-DIRECTION]]: 6 to 8 fields expected, 5 given"},
      {with_draw_lines("viewport 0 0 4 4 0 1 y-up"), "f:4: 'y-up' is none of: zero-to-one, minus-one-to-one"},
      {with_draw_lines("viewport 0 0 4 4 0 1 zero-to-one down"), "f:4: 'down' is none of: y-up, y-down"},
      {with_draw_lines("vertex 0 0 0"), "f:4: vertex X Y Z W [VALUES]: 4 or more fields expected, 3 given"},
      {with_draw_lines("interpolation a flat"), "f:4: no attribute 'a'"},
      {with_draw_lines("interpolation a"), "f:4: interpolation NAME INTERPOLATION: 2 fields expected, 1 given"},
      {"surefill-scene 1\ntarget 4 4\nattribute a 1 flat\ndraw\ninterpolation a flat\ninterpolation a flat\nend\n",
       "f:6: interpolation 'a' is given twice"},
      {with_draw_lines("vertex 0 0 0 1 2"), "f:4: vertex X Y Z W and 0 attribute values: 4 fields expected, 5 given"},
      {"surefill-scene 1\ntarget 4 4\nattribute a 3 flat\ndraw\nvertex 0 0 0 1 2 3\nend\n",
       "f:5: vertex X Y Z W and 3 attribute values: 7 fields expected, 6 given"},
      {with_draw_lines("vertex 0 0 0 1e39"), "f:4: '1e39' is beyond float32; write inf or 0 if that is meant"},
      {with_draw_lines("vertex 0 0 0 1e-50"), "f:4: '1e-50' is beyond float32; write inf or 0 if that is meant"},
      {with_draw_lines("vertex 0 0 0 0x1p+128"), "f:4: '0x1p+128' is not exactly a float32"},
      {with_draw_lines("vertex 0 0 0 0x1.0000001p+0"), "f:4: '0x1.0000001p+0' is not exactly a float32"},
      {with_draw_lines("vertex 0 0 0 0x1.00000000000000001p+0"),
       "f:4: '0x1.00000000000000001p+0' is not exactly a float32"},
      {with_draw_lines("vertex 0 0 0 0x1.0000000000001p+0"), "f:4: '0x1.0000000000001p+0' is not exactly a float32"},
      {with_draw_lines("vertex 0 0 0 0x1p-150"), "f:4: '0x1p-150' is not exactly a float32"},
      {with_draw_lines("vertex 0 0 0 0x"), "f:4: '0x' is not a number"},
      {with_draw_lines("vertex 0 0 0 0x1p"), "f:4: '0x1p' is not a number"},
      {with_draw_lines("vertex 0 0 0 0x-1"), "f:4: '0x-1' is not a number"},
      {with_draw_lines("vertex 0 0 0 1,5"), "f:4: '1,5' is not a number"},
      {with_draw_lines("vertex 0 0 0 +1"), "f:4: '+1' is not a number"},
      {with_draw_lines("vertex 0 0 0 --1"), "f:4: '--1' is not a number"},
      {with_draw_lines("vertex 0 0 0 -nan"), "f:4: '-nan' is not a number"},
      {with_draw_lines("vertex 0 0 0 infinity"), "f:4: 'infinity' is not a number"},
      {with_draw_lines("vertex 0 0 0 1e"), "f:4: '1e' is not a number"},
      {with_draw_lines("vertex 0 0 0 -"), "f:4: '-' is not a number"},
      {with_draw_lines(three + "triangle 0 1 3"), "f:7: no vertex 3: 3 vertices stand above this line"},
      {with_draw_lines("triangle 0 0 0"), "f:4: no vertex 0: 0 vertices stand above this line"},
      {with_draw_lines(three + "triangle 0 1"), "f:7: triangle I J K [id N]: 3 to 5 fields expected, 2 given"},
      {with_draw_lines(three + "triangle 0 1 2 7"), "f:7: triangle: 'id' and a number may follow the vertices"},
      {with_draw_lines(three + "triangle 0 1 2 id 4294967296"), "f:7: '4294967296' is outside 0..4294967295"},
      {with_draw_lines(three + "triangle 0 1 2 id 4294967295"),
       "f:7: id 4294967295 is what an empty sample holds (B5)"},
      {with_draw_lines(three + "triangle 0 1 2 id 1\ntriangle 0 1 2"), "f:8: id on some triangles of the draw only"},
      {with_draw_lines(three + "triangle 0 1 2\ntriangle 0 1 2 id 1"), "f:8: id on some triangles of the draw only"},
      {with_draw_lines(three + "point 0 0"), "f:7: point: 'id' and a number may follow the vertices"},
      {with_draw_lines(three + "line 0 1 inf"), "f:7: line: 'id' and a number may follow the vertices"},
      {with_draw_lines(three + "line 0 3"), "f:7: no vertex 3: 3 vertices stand above this line"},
      {with_draw_lines(three + "first-index 4294967295\ntriangle 0 1 2"),
       "f:9: first-index 4294967295 plus 1 triangles exceeds 4294967295 (B5)"},
      // M4.
      {with_draw_lines("conservative over\ndepth-mode clip"), "f:4: a conservative draw needs depth-mode none (M4)"},
      {with_draw_lines("grid 8 0 0 truncate\nconservative inner"), "f:5: a conservative draw has no grid (M4)"},
      {"surefill-scene 1\ntarget 4 4\nsamples 2\ndraw\nconservative over\nend\n",
       "f:5: a conservative draw needs samples 1 (M4)"},
  };
  for (const Refusal& r : refusals) EXPECT_EQ(refusal(r.text), r.message) << r.text;

  std::string many;
  for (int i = 0; i < 17; ++i) many += "attribute a" + std::to_string(i) + " 1 flat\n";
  EXPECT_EQ(refusal(with_frame_lines(many)), "f:19: more than 16 attributes");
}

TEST(SceneText, TheLargestFirstIndexIsLegal) {
  const Scene scene = read_scene(with_draw_lines("vertex 0 0 0 1\ntriangle 0 0 0\nfirst-index 4294967294"));
  const Frame frame(scene);
  EXPECT_EQ(validate(frame.target(), frame.draws()), Status::ok);
}

TEST(SceneFrame, GivesTheEngineWhatTheSceneSays) {
  Scene scene = read_scene(
      "surefill-scene 1\ntarget 4 2\nsamples 2\nattribute a 2 flat\nattribute b 1 noperspective\n"
      "draw\nvertex 1 2 3 4 5 6 7\nvertex 8 9 10 11 12 13 14\ntriangle 0 1 0\ntriangle 1 1 0\nend\n"
      "draw\nviewport 0 0 4 2 0 1\nvertex 0 0 0.5 1 0 0 0\ntriangle 0 0 0 id 9\nend\n");
  const Frame frame(scene);
  scene = Scene{};
  ASSERT_EQ(frame.draws().size(), 2u);
  const Draw& first = frame.draws()[0];
  ASSERT_EQ(first.attributes.size(), 2u);
  for (std::uint32_t v = 0; v < 2; ++v) {
    const float base = v == 0 ? 5.F : 12.F;
    EXPECT_EQ(first.attributes[0].values[v * first.attributes[0].stride + 1], base + 1);
    EXPECT_EQ(first.attributes[1].values[v * first.attributes[1].stride], base + 2);
  }
  EXPECT_EQ(first.first_index, 0u);
  const Draw& second = frame.draws()[1];
  EXPECT_EQ(second.first_index, 2u);
  ASSERT_EQ(second.identifiers.size(), 1u);
  EXPECT_EQ(second.vertices[0].x, 2.F);
  EXPECT_EQ(second.vertices[0].y, 1.F);
  EXPECT_EQ(frame.target().attributes.size(), 2u);
  EXPECT_EQ(frame.image().attributes[0].size(), 32u);
  EXPECT_EQ(frame.image().barycentrics.size(), 48u);
  EXPECT_EQ(validate(frame.target(), frame.draws()), Status::ok);
}

TEST(SceneFrame, ConservativeScenesAskForCountsAlone) {
  const Frame frame(read_scene(with_draw_lines("conservative over")));
  EXPECT_EQ(frame.image().count.size(), 16u);
  EXPECT_TRUE(frame.target().index.empty() && frame.target().depth.empty() && frame.target().barycentrics.empty());
  EXPECT_EQ(validate(frame.target(), frame.draws()), Status::ok);
}

TEST(SceneFrame, RefusesWhatCannotBeDrawn) {
  EXPECT_THROW(Frame(read_scene(with_draw_lines("vertex 0 0 0 1\npoint 0"))), SceneError);
  EXPECT_THROW(Frame(read_scene(with_draw_lines("vertex 0 0 0 1\nline 0 0"))), SceneError);
  Scene scene = triangle_scene();
  scene.draws[0].vertices[1].attributes.push_back(1);
  EXPECT_THROW(Frame{scene}, SceneError);
}

TEST_F(EmptyFolder, AMissingOrEmptyCorpusFails) {
  EXPECT_THROW((void)list_corpus(folder_.string()), SceneError);
  EXPECT_THROW((void)list_corpus(path("missing")), SceneError);
  EXPECT_THROW((void)read_scene_file(path("missing.scene")), SceneError);
  EXPECT_THROW((void)read_scene_file(folder_.string()), SceneError);
  fs::create_directories(path("b/a"));
  for (const char* name : {"b/a/2.scene", "b/1.scene", "b/3.txt", "a.scene"}) {
    write_scene_file(triangle_scene(), path(name));
  }
  const std::vector<std::string> expected{path("a.scene"), path("b/1.scene"), path("b/a/2.scene")};
  EXPECT_EQ(list_corpus(folder_.string()), expected);
}

TEST_F(EmptyFolder, FilesComeBackAndAreReplacedWhole) {
  Scene scene = triangle_scene();
  write_scene_file(scene, path("a.scene"));
  EXPECT_TRUE(equal(scene, read_scene_file(path("a.scene"))));
  scene.width = 9;
  write_scene_file(scene, path("a.scene"));
  EXPECT_TRUE(equal(scene, read_scene_file(path("a.scene"))));
  EXPECT_EQ(files(), 1);
}

TEST_F(EmptyFolder, AFailedWriteLeavesNothing) {
  EXPECT_THROW(write_scene_file(triangle_scene(), path("no/such/folder.scene")), SceneError);
  fs::create_directory(path("taken.scene"));
  EXPECT_THROW(write_scene_file(triangle_scene(), path("taken.scene")), SceneError);
  EXPECT_EQ(files(), 1);
  EXPECT_TRUE(fs::is_empty(path("taken.scene")));
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  // The superuser may write anywhere.
  if (::geteuid() != 0) {
    EXPECT_THROW(write_scene_file(triangle_scene(), path("b.scene")), SceneError);
  }
  EXPECT_THROW(write_scene_file(triangle_scene(), "/proc/surefill.scene"), SceneError);
}

TEST_F(EmptyFolder, MessagesOfFilesNameTheFile) {
  std::ofstream(path("bad.scene")) << "surefill-scene 1\ntarget 4\n";
  try {
    (void)read_scene_file(path("bad.scene"));
    FAIL() << "accepted";
  } catch (const SceneError& error) {
    EXPECT_EQ(error.what(), path("bad.scene") + ":2: target WIDTH HEIGHT: 2 fields expected, 1 given");
  }
}

}  // namespace
}  // namespace surefill::corpus
