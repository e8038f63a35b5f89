// SPDX-License-Identifier: Apache-2.0
//
// The built command as a process: what it prints and returns, and that bad input leaves no output behind.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
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

  // Runs the command in the folder, with arguments as a shell takes them.
  Outcome run(const std::string& arguments) const {
    // Beside the folder, so that what the command leaves in it can be listed.
    const std::string out = folder_.string() + ".out", err = folder_.string() + ".err";
    const std::string line =
        "cd '" + folder_.string() + "' && " SUREFILL_COMMAND " " + arguments + " >" + out + " 2>" + err;
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
    EXPECT_EQ(outcome.err.rfind("surefill: ", 0), 0u) << arguments << "\n" << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << arguments << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find(cause), std::string::npos) << arguments << "\n" << outcome.err;
    EXPECT_EQ(files(), before) << arguments;
  }
};

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

bool is_png(const std::string& bytes) {
  return bytes.starts_with("\x89PNG\r\n\x1a\n") && bytes.ends_with("\xAE\x42\x60\x82");
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
  expect_refused("render a.obj -o out.png --near 5 --far 4", "near");
  expect_refused("render a.obj -o out.png --show shadow", "shadow");
  expect_refused("render a.obj -o out.png --cull left", "left");
  expect_refused("render a.obj -o out.png --transparent", "transparent");
  expect_refused("certify --level enormous", "enormous");
  expect_refused("certify --only no-such-check", "no-such-check");
  expect_refused("certify --jobs 0", "jobs");
  expect_refused("certify --seed x", "seed");
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
  EXPECT_EQ(files().size(), 12u);
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
  for (const char* arguments : {"--help", "render --help", "certify --help", "replay --help", "reduce --help"}) {
    const Outcome help = run(arguments);
    EXPECT_EQ(help.status, 0);
    EXPECT_NE(help.out.find("Usage: "), std::string::npos);
  }
}

}  // namespace
}  // namespace surefill
