// SPDX-License-Identifier: Apache-2.0
//
// The built command as a process: what it prints and returns, and that bad input leaves no output behind.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "corpus/scene.hpp"
#include "properties/machinery/test_folder.hpp"

namespace surefill {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int status = -1;  // exit status, or 128 + signal
  std::string out, err;
};

class Command : public InFolder {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }

  // "zoo" is a command of its own, with the same manners.
  static std::string command_of(const std::string& arguments) {
    return arguments.starts_with("zoo ") ? SUREFILL_ZOO_COMMAND + arguments.substr(3)
                                         : SUREFILL_COMMAND " " + arguments;
  }

  // Runs the command in the folder, with arguments as a shell takes them.
  Outcome run(const std::string& arguments) const {
    // Beside the folder, so that what the command leaves in it can be listed.
    const std::string out = folder_.string() + ".out", err = folder_.string() + ".err";
    const std::string line = "cd '" + folder_.string() + "' && " + command_of(arguments) + " >" + out + " 2>" + err;
    const int status = std::system(line.c_str());
    Outcome outcome;
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.out = contents(out);
    outcome.err = contents(err);
    fs::remove(out);
    fs::remove(err);
    return outcome;
  }

  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  // Wrong usage or input: status 2, nothing on stdout, one line on stderr that holds `cause`, no new file.
  void expect_refused(const std::string& arguments, const std::string& cause) const {
    const std::vector<std::string> before = files();
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_EQ(outcome.err.rfind(arguments.starts_with("zoo ") ? "surefill-zoo: " : "surefill: ", 0), 0u)
        << arguments << "\n"
        << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << arguments << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find(cause), std::string::npos) << arguments << "\n" << outcome.err;
    EXPECT_EQ(files(), before) << arguments;
  }
};

constexpr const char* kOneTriangle =
    "surefill-scene 1\ntarget 4 4\ndraw\nvertex 0 0 0 1\nvertex 4 0 0 1\nvertex 0 4 0 1\ntriangle 0 1 2\nend\n";
constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

bool is_png(const std::string& bytes) {
  return bytes.starts_with("\x89PNG\r\n\x1a\n") && bytes.ends_with("\xAE\x42\x60\x82");
}

// Any case can be had, right or wrong, with its scene as it is.
TEST_F(Command, OneCaseAndItsScene) {
  const Outcome outcome = run("certify --only random-ordinary --case 3");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("random-ordinary, case 3 of "), std::string::npos) << outcome.out;
  EXPECT_EQ(files(), std::vector<std::string>{"random-ordinary-case-3-1.scene"});
  EXPECT_EQ(run("replay random-ordinary-case-3-1.scene").status, 0);
  expect_refused("certify --only random-ordinary --case 1000000", "has cases 0 to ");
  expect_refused("certify --only 'random-*' --case 3", "the name of one check");
  expect_refused("certify --case 3", "the name of one check");
}

TEST_F(Command, RefusesWrongUsage) {
  write("a.obj", kTriangle);
  expect_refused("", "a subcommand is needed: render, certify");
  expect_refused("--no-such-option", "no-such-option");
  expect_refused("paint a.obj", "paint");
  expect_refused("render a.obj", "--output");
  expect_refused("render a.obj -o out.png --size 0x5", "--size 0x5");
  expect_refused("render a.obj -o out.png --size 5", "--size 5");
  expect_refused("render a.obj -o out.png --size 5x-1", "--size 5x-1");
  expect_refused("render a.obj -o out.png --size 5x16385", "16384");
  expect_refused("render a.obj -o out.png --size 5x5x5", "--size");
  expect_refused("render a.obj -o out.png --size 99999999999x5", "--size");
  expect_refused("render a.obj -o out.png --eye 1,2", "--eye 1,2");
  expect_refused("render a.obj -o out.png --eye 1,2,nan", "--eye");
  expect_refused("render a.obj -o out.png --eye 1,1,1 --target 1,1,1", "eye and target");
  expect_refused("render a.obj -o out.png --eye 0,1,0 --target 0,0,0", "up direction");
  expect_refused("render a.obj -o out.png --fov 180", "field of view");
  expect_refused("render a.obj -o out.png --orthographic --fov 30", "--fov");
  expect_refused("render a.obj -o out.png --height 3", "--orthographic");
  expect_refused("render a.obj -o out.png --orthographic --height 0", "--height");
  expect_refused("render a.obj -o out.png --orthographic --near 5 --far 4", "near < far");
  expect_refused("render a.obj -o out.png --near 5 --far 4", "near");
  expect_refused("render a.obj -o out.png --show shadow", "shadow");
  expect_refused("render a.obj -o out.png --cull left", "left");
  expect_refused("render a.obj -o out.png --transparent", "transparent");
  expect_refused("certify --level enormous", "enormous");
  expect_refused("certify --only no-such-check", "no-such-check");
  expect_refused("certify --jobs 0", "jobs");
  expect_refused("certify --seed x", "seed");
}

// Every option of every subcommand, as its help lists them: a new one is tested as soon as it is there.
TEST_F(Command, RefusesEmptyValues) {
  int options = 0;
  for (const std::string subcommand :
       {"render", "certify", "merge", "recheck", "replay", "reduce", "explain", "corpus add", "zoo"}) {
    std::istringstream help(run(subcommand + " --help").out);
    for (std::string line; std::getline(help, line);) {
      // "  -o,--output TEXT REQUIRED", and flags without a value.
      const std::size_t name = line.find("--");
      if (name == std::string::npos || (line.substr(0, name) != "  " && line.substr(0, name) != "  -o,")) continue;
      const std::size_t end = line.find(' ', name);
      if (end == std::string::npos || !std::isupper(static_cast<unsigned char>(line[end + 1]))) continue;
      if (line.compare(end + 1, 6, "Needs:") == 0 || line.compare(end + 1, 9, "Excludes:") == 0) continue;  // a flag
      const std::string option = line.substr(name, end - name);
      expect_refused(subcommand + " a " + option + " ''", option + ": an empty value");
      if (options++ % 8 == 0) expect_refused(subcommand + " a " + option + "=", option + ": an empty value");
    }
    if (subcommand != "certify" && subcommand != "zoo") expect_refused(subcommand + " ''", "an empty value");
  }
  EXPECT_GE(options, 50);
  expect_refused("render a.obj -o ''", "--output: an empty value");
  expect_refused("certify --only ,", "an empty name");
  expect_refused("certify --only corpus,,order", "an empty name");
  expect_refused("certify --only corpus,", "an empty name");
}

TEST_F(Command, NumbersHaveRanges) {
  write("a.obj", kTriangle);
  const std::pair<const char*, std::vector<const char*>> numbers[] = {
      {"certify --seed", {"-1", "99999999999999999999999", "18446744073709551616", "1.5", "0x1", "1e3", " 1", "+1"}},
      {"certify --jobs", {"-1", "0", "4097", "010x", "4294967297"}},
      {"certify --time-limit", {"-1", "0", "nan", "inf", "1e99", "3601", "0x1p3"}},
      {"certify --shard", {"-1/2", "0/2", "3/2", "1/99999999999999999999999", "1/", "/1", "1/100001"}},
      {"zoo --cases", {"-1", "0", "100000001"}},
      {"zoo --jobs", {"-1", "0", "4097"}},
      {"reduce a.scene -o b.scene --seconds", {"-1", "0", "86401", "99999999999999999999999"}},
      {"explain a.scene -o b.svg --tile", {"-8", "5", "0", "128", "0x8"}},
      {"explain a.scene -o b.svg --triangle", {"-1", "2147483648", "99999999999999999999999"}},
      {"render a.obj -o b.png --fov", {"-1", "181", "nan", "1e999"}},
      {"render a.obj -o b.png --near", {"-1", "0", "inf", "1e39"}},
      {"render a.obj -o b.png --far", {"-1", "0", "inf", "1e39"}},
      {"render a.obj -o b.png --eye", {"1,2,1e39", "1,2,inf", "1,2,-1e999"}},
  };
  for (const auto& [option, values] : numbers) {
    const std::string name = option + std::string(option).rfind("--");
    for (const char* value : values) expect_refused(option + std::string(" '") + value + "'", name + " " + value);
  }
  EXPECT_EQ(run("certify --only bad-arguments --seed 18446744073709551615").status, 0);
}

TEST_F(Command, OverwritesNeitherInputsNorOtherOutputs) {
  write("a.obj", kTriangle);
  write("a.scene", kOneTriangle);
  write("a.json", "{}\n");
  fs::create_directory(path("folder"));
  fs::create_symlink("a.obj", path("link.png"));
  fs::create_hard_link(path("a.obj"), path("hard.png"));
  fs::create_symlink("a.scene", path("link.scene"));
  fs::create_symlink("a.scene", path("link.svg"));
  fs::create_symlink(".", path("here"));
  fs::create_symlink("not-there.html", path("link.html"));
  const std::string mesh = contents(path("a.obj")), scene = contents(path("a.scene"));
  const char* overwritten = "would be overwritten";
  expect_refused("render a.obj -o a.obj", ".png");
  expect_refused("render a.obj -o link.png", overwritten);
  expect_refused("render a.obj -o hard.png", overwritten);
  expect_refused("reduce a.scene -o a.scene", overwritten);
  expect_refused("reduce a.scene -o ./folder/../a.scene", overwritten);
  expect_refused("reduce here/a.scene -o \"$PWD/a.scene\"", overwritten);
  expect_refused("reduce a.scene -o link.scene", overwritten);
  expect_refused("explain a.scene -o link.svg", overwritten);
  expect_refused("merge a.json --json here/a.json", overwritten);
  expect_refused("certify --command 'python3 a.json' --resume ./a.json", overwritten);
  expect_refused("certify --json b.json --resume here/b.json", "is the file of --json, too");
  expect_refused("certify --html link.html --resume ./not-there.html", "is the file of --html, too");
  expect_refused("certify --json x.html --html x.html", ".json");
  expect_refused("render a.obj -o -", "/dev/stdout");
  expect_refused("certify --json -", "/dev/stdout");
  expect_refused("certify --resume -", "/dev/stdout");
  expect_refused("render a.obj -o x.jpg", "expected a name that ends in .png");
  expect_refused("render a.obj -o png", "expected a name that ends in .png");
  expect_refused("reduce a.scene -o x.obj", "expected a name that ends in .scene");
  expect_refused("explain a.scene -o x.pdf", "expected a name that ends in .svg or .png");
  expect_refused("merge a.json --html x.pdf", "expected a name that ends in .html or .htm");
  expect_refused("certify --junit x.json", "expected a name that ends in .xml");
  expect_refused("zoo --cases 1 --markdown x.txt --picture x.svg", "expected a name that ends in .md");
  expect_refused("zoo --cases 1 --markdown x.md --picture x.png", "expected a name that ends in .svg");
  EXPECT_EQ(contents(path("a.obj")), mesh);
  EXPECT_EQ(contents(path("a.scene")), scene);
  // A link to somewhere else stays a link; a pipe has any name.
  fs::create_symlink("drawn.png", path("elsewhere.png"));
  EXPECT_EQ(run("render a.obj --size 8x8 -o elsewhere.png").status, 0);
  EXPECT_TRUE(fs::is_symlink(path("elsewhere.png")) && is_png(contents(path("drawn.png"))));
  EXPECT_EQ(run("render a.obj --size 8x8 -o DRAWN.PNG").status, 0);
  EXPECT_EQ(run("render a.obj --size 8x8 -o /dev/stdout | cmp - drawn.png; echo $?").out, "0\n");
}

TEST_F(Command, RefusesEditedCertificates) {
  ASSERT_EQ(run("certify --only bad-arguments,order --json whole.json").status, 0);
  ASSERT_EQ(run("merge whole.json").status, 0);
  ASSERT_EQ(run("certify --only bad-arguments,order --resume run.state").status, 0);
  const std::string whole = contents(path("whole.json")), state = contents(path("run.state"));
  const auto edited = [](std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.rfind(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
  };
  const std::pair<const char*, const char*> edits[] = {{"\"differences\": 0", "\"differences\": 7"},
                                                       {"\"samples\": ", "\"samples\": -"},
                                                       {"\"done\": 8", "\"done\": 9"},
                                                       {"\"seed\": 1", "\"seed\": 2"},
                                                       {"\"order\"", "\"other\""},
                                                       {"\"failed\": 0", "\"failed\": 1"},
                                                       {"\"level\": \"quick\"", "\"level\": \"thorough\""}};
  for (const auto& [from, to] : edits) {
    write("edited.json", edited(whole, from, to));
    expect_refused("merge edited.json", "edited.json: its checksum is not that of its content");
    write("edited.state", edited(state, from, to));
    expect_refused("certify --only bad-arguments,order --resume edited.state", "edited or damaged");
  }
  write("edited.json", edited(whole, "\"verdict\": \"certified\"", "\"verdict\": \"not_certified\""));
  expect_refused("merge edited.json", "checksum");
  write("edited.json", edited(whole, "\"format_version\": 4", "\"format_version\": 3"));
  expect_refused("merge edited.json", "another version: 3, where 4 is read");
  write("edited.json", std::string(100000, '['));
  expect_refused("merge edited.json", "nested too deeply");
  write("edited.json", whole.substr(0, whole.size() / 2));
  expect_refused("merge edited.json", "not a certificate");
}

TEST_F(Command, RefusesBadFiles) {
  write("a.obj", kTriangle);
  write("empty.obj", "");
  write("short-face.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2");
  write("cut-corner.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/");
  write("cut-vertex.obj", "v 0 0 0\nv 1 0 0\nv 0 1");
  write("beyond.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 4\n");
  write("before.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n");
  write("zero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n");
  write("huge.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n");
  write("normal.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//2\n");
  write("word.obj", "v 0 0 zero\n");
  write("binary.obj", std::string("v 0 0 0\n\0\1\2", 11));
  write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  write("a.scene", "surefill-scene 99\n");
  fs::create_directory(path("folder"));
  fs::create_directory(path("folder.obj"));
  expect_refused("render short-face.obj -o out.png", "short-face.obj:4: a face needs three vertices");
  expect_refused("render cut-corner.obj -o out.png", "cut-corner.obj:4:");
  expect_refused("render cut-vertex.obj -o out.png", "cut-vertex.obj:3: a vertex needs three numbers");
  expect_refused("render beyond.obj -o out.png", "beyond.obj:5: the face names vertex 4, but the file has 3");
  expect_refused("render before.obj -o out.png", "before.obj:4:");
  expect_refused("render zero.obj -o out.png", "zero.obj:4:");
  expect_refused("render huge.obj -o out.png", "huge.obj:4:");
  expect_refused("render normal.obj -o out.png", "normal.obj:5: the face names normal 2");
  expect_refused("render word.obj -o out.png", "word.obj:1:");
  expect_refused("render binary.obj -o out.png", "binary.obj:2: not a text file");
  const std::string read = "scenes (.scene) and meshes (Wavefront .obj, .ply, .stl) are read";
  const std::pair<std::string, std::string> others[] = {{"\x1f\x8b\x08garbage", "gzip-compressed"},
                                                        {"ply\nformat ascii 1.0\n", "a PLY file"},
                                                        {"glTF\2\1", "a GLB file"},
                                                        {"solid cube\nfacet normal 0 0 1\n", "an STL file"},
                                                        {"\xff\xfev\1", "text in UTF-16"},
                                                        {"PK\3\4", "a zip archive"},
                                                        {"OFF\n3 1 0\n", "an OFF file"}};
  for (const auto& [bytes, name] : others) {
    write("other.obj", bytes);
    write("other.scene", bytes);
    const bool is_mesh = name == "a PLY file" || name == "an STL file";  // read by its content, and then cut short
    expect_refused("render other.obj -o out.png", is_mesh ? "other.obj: " : "other.obj:1: this is " + name);
    expect_refused("render other.obj -o out.png", is_mesh ? "" : read);
    expect_refused("render other.scene -o out.png", "other.scene:1: this is " + name);
    expect_refused("replay other.scene", read);
  }
  write("other.obj", "facet normal 0 0 1\n");
  expect_refused("render other.obj -o out.png", "\"facet\" is no OBJ statement: " + read);
  write("other.obj", kOneTriangle);
  expect_refused("render other.obj -o out.png", "this is a scene: its name must end in .scene");
  expect_refused("render binary.obj -o out.png", read);
  expect_refused("render points.obj -o out.png", "no triangle");
  expect_refused("render empty.obj -o out.png", "no triangle");
  expect_refused("render missing.obj -o out.png", "missing.obj: No such file");
  expect_refused("render folder.obj -o out.png", "folder.obj: is a directory");
  expect_refused("render a.obj -o folder", "folder: Is a directory");
  expect_refused("render a.obj -o missing/out.png", "missing/out.png: No such file");
  expect_refused("render a.obj -o a.obj/out.png", "a.obj/out.png: Not a directory");
  expect_refused("render a.scene -o out.png", "a.scene:1:");
  expect_refused("render missing.scene -o out.png", "missing.scene");
  expect_refused("replay a.scene", "a.scene:1:");
  expect_refused("replay missing.scene", "missing.scene");
  expect_refused("replay folder", "folder");
  expect_refused("reduce missing.scene -o out.scene", "missing.scene");
  expect_refused("certify --corpus folder --only corpus", "folder");
  expect_refused("certify --corpus missing --only mesh-spot", "missing");
  expect_refused("certify --json missing/a.json --only bad-arguments", "missing/a.json");
  expect_refused("certify --output-dir missing --only bad-arguments", "missing");
  EXPECT_EQ(run("certify --only bad-arguments >/dev/full; echo $? ").out, "2\n");
}

TEST_F(Command, DrawsPictures) {
  write("a.obj", kTriangle);
  for (const char* show : {"depth", "index", "barycentrics", "normals", "count"}) {
    for (const char* renderer : {"engine", "oracle"}) {
      const std::string name = std::string(show) + "-" + renderer + ".png";
      const Outcome outcome =
          run("render a.obj --size 40x30 --show " + std::string(show) + " --renderer " + renderer + " -o " + name);
      EXPECT_EQ(outcome.status, 0) << outcome.err;
      EXPECT_EQ(outcome.out + outcome.err, "");
      EXPECT_TRUE(is_png(contents(path(name))));
    }
    EXPECT_EQ(contents(path(std::string(show) + "-engine.png")), contents(path(std::string(show) + "-oracle.png")));
  }
  EXPECT_EQ(run("render a.obj --size 40x30 --eye 0.2,0.2,0.01 --target 0.2,0.3,-1 --fov 120 -o inside.png").status, 0);
  const std::string flat = "render a.obj --size 40x30 --orthographic --show index ";
  EXPECT_EQ(run(flat + "-o flat.png").status, 0);
  EXPECT_EQ(run(flat + "--eye 0.5,0.5,-3 --target 0.5,0.5,0 --height 1.5 -o behind.png").status, 0);
  EXPECT_EQ(run(flat + "--eye 0.5,0.5,3 --target 0.5,0.5,0 --height 1.5 --renderer oracle -o front.png").status, 0);
  EXPECT_NE(contents(path("front.png")), contents(path("behind.png")));
  // Without perspective a distance changes nothing.
  EXPECT_EQ(run(flat + "--eye 0.5,0.5,9 --target 0.5,0.5,0 --height 1.5 -o far.png").status, 0);
  EXPECT_EQ(contents(path("front.png")), contents(path("far.png")));
  write(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  write("a.stl",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
        "0\nendloop\nendfacet\nendsolid\n");
  for (const std::string mesh : {"a.ply", "a.stl"}) {
    EXPECT_EQ(run("render " + mesh + " --size 40x30 --show index -o mesh.png").status, 0);
    EXPECT_EQ(contents(path("mesh.png")), contents(path("index-engine.png"))) << mesh;
  }
  EXPECT_EQ(files().size(), 19u);
}

// Editors on Windows write one.
TEST_F(Command, TakesAByteOrderMark) {
  write("a.obj", kTriangle);
  write("mark.obj", std::string("\xef\xbb\xbf") + kTriangle);
  write("mark.scene", std::string("\xef\xbb\xbf") + kOneTriangle);
  EXPECT_EQ(run("render a.obj --size 8x8 -o a.png").status, 0);
  EXPECT_EQ(run("render mark.obj --size 8x8 -o mark.png").status, 0);
  EXPECT_EQ(contents(path("a.png")), contents(path("mark.png")));
  EXPECT_EQ(run("replay mark.scene").status, 0);
}

TEST_F(Command, WarnsOfVerticesThatAreNotFinite) {
  write("nan.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 0 inf 0\nf 1 2 3\nf 2 3 4\nf 1 3 5\n");
  write("without.obj", kTriangle);
  const Outcome outcome = run("render nan.obj -o nan.png --size 32x32 --show normals");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "surefill: warning: nan.obj: 2 of 3 triangles have a NaN or an infinity and are dropped\n");
  EXPECT_EQ(run("render without.obj -o without.png --size 32x32 --show normals").status, 0);
  EXPECT_EQ(contents(path("nan.png")), contents(path("without.png")));
}

TEST_F(Command, Certifies) {
  const Outcome outcome = run("certify --only 'corpus,bad-arguments,order' --json c.json --jobs 2");
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  EXPECT_EQ(outcome.err, "");  // no progress where there is no terminal
  EXPECT_NE(outcome.out.find("CERTIFIED: 3 checks"), std::string::npos) << outcome.out;
  EXPECT_NE(contents(path("c.json")).find("\"verdict\": \"certified\""), std::string::npos);
  EXPECT_EQ(files(), std::vector<std::string>{"c.json"});
  const Outcome list = run("certify --list");
  EXPECT_EQ(list.status, 0);
  for (const char* name : {"corpus: ", "mesh-spot: ", "random-ordinary: ", "float-environment: "}) {
    EXPECT_NE(list.out.find(name), std::string::npos) << name;
  }
}

TEST_F(Command, FindsTheSameWhateverTheThreads) {
  const auto without_seconds = [](const std::string& text) {
    std::istringstream lines(text);
    std::string result;
    for (std::string line; std::getline(lines, line);) {
      if (line.find(" differences, ") != std::string::npos) line.resize(line.rfind(','));
      if (line.find(" threads") == std::string::npos) result += line + "\n";
    }
    return result;
  };
  const std::string arguments = "certify --seed 5 --only 'random-sliver,octants,viewport' --jobs ";
  EXPECT_EQ(without_seconds(run(arguments + "1").out), without_seconds(run(arguments + "3").out));
}

// Band by band, so that memory stays bounded; places and sums are those of the whole.
TEST_F(Command, ReplaysLargeTargetsInBands) {
  corpus::Scene scene;
  scene.width = 3000;
  scene.height = 1500;
  corpus::SceneDraw& draw = scene.draws.emplace_back();
  draw.vertices = {{2990, 1398, 0, 1, {}}, {3000, 1398, 0, 1, {}}, {2990, 1402, 0, 1, {}}};
  draw.triangles.push_back({{0, 1, 2}, std::nullopt});
  write("large.scene", corpus::write_scene(scene));
  const Outcome outcome = run("replay large.scene");
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("drawn in bands of 1398 rows"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("equal: oracle = engine, 4500000 samples"), std::string::npos) << outcome.out;
}

TEST_F(Command, Replays) {
  write("a.scene", corpus::write_scene([] {
          corpus::Scene scene;
          scene.comment = "one triangle";
          scene.width = scene.height = 4;
          corpus::SceneDraw& draw = scene.draws.emplace_back();
          draw.vertices = {{0, 0, 0, 1, {}}, {4, 0, 0, 1, {}}, {0, 4, 0, 1, {}}};
          draw.triangles.push_back({{0, 1, 2}, std::nullopt});
          return scene;
        }()));
  for (const char* option : {"", "--second-oracle "}) {
    const Outcome outcome = run("replay " + std::string(option) + "a.scene");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("# one triangle"), std::string::npos);
    EXPECT_NE(outcome.out.find("    111.\n    11..\n    1...\n    ....\n"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("equal: oracle = "), std::string::npos);
  }
  EXPECT_NE(run("replay --all a.scene").out.find("pixel (3, 3)"), std::string::npos);
  expect_refused("reduce a.scene -o b.scene", "nothing differs");
}

TEST_F(Command, TellsItsVersionAndUsage) {
  const Outcome version = run("--version");
  EXPECT_EQ(version.status, 0);
  EXPECT_EQ(version.out.rfind("surefill " SUREFILL_VERSION " (", 0), 0u);
  for (const char* line : {"\ncompiler  ", "\nengine    ", "\nadapters  ", "\ncorpus    "}) {
    EXPECT_NE(version.out.find(line), std::string::npos) << version.out;
  }
  for (const char* arguments : {"--help", "render --help", "certify --help", "replay --help", "reduce --help"}) {
    const Outcome help = run(arguments);
    EXPECT_EQ(help.status, 0);
    EXPECT_NE(help.out.find("Usage: "), std::string::npos);
  }
}

}  // namespace
}  // namespace surefill
