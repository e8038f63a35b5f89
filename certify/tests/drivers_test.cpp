// SPDX-License-Identifier: Apache-2.0
//
// The OpenGL and Vulkan adapters on the drivers of this machine: what the pages of docs/certificates claim is replayed
// where the driver is the one that the page is about, and a state that is left wrong is noticed before any verdict.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "properties/machinery/test_folder.hpp"

namespace surefill {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOpenGl = "--adapter opengl --plugin-arguments ";
constexpr const char* kVulkan = "--adapter vulkan --plugin-arguments ";

class Drivers : public InFolder {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(__SANITIZE_UNDEFINED__)
    GTEST_SKIP() << "drivers are not built for sanitizers";
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
    GTEST_SKIP() << "drivers are not built for sanitizers";
#endif
#endif
    InFolder::SetUp();
    fs::create_directory_symlink(fs::path(SUREFILL_CERTIFICATES) / "scenes", folder_ / "scenes");
  }

  // The exit status; what is printed is in `out`.
  int surefill(const std::string& arguments) {
    const std::string line =
        "cd '" + folder_.string() + "' && " SUREFILL_COMMAND " " + arguments + " >out.txt 2>err.txt";
    const int status = std::system(line.c_str());
    out = contents(folder_ / "out.txt") + contents(folder_ / "err.txt");
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  }
  bool says(const std::string& text) const {
    return out.find(text) != std::string::npos;
  }

  // The driver's name and version; empty, with the reason in `out`, where there is none.
  std::string driver(const std::string& options) {
    const int status = surefill("certify --jobs 1 --only model " + options);
    const std::size_t end = out.find(": probing finds ");
    return status == 2 || end == std::string::npos ? "" : out.substr(0, end);
  }

  // Each state that the adapter leaves wrong on purpose keeps it from a verdict.
  void expect_noticed(const std::string& options, const std::vector<std::string>& faults) {
    if (driver(options).empty()) GTEST_SKIP() << out;
    for (const std::string& fault : faults) {
      EXPECT_EQ(
          surefill("certify --jobs 1 --only model " + options.substr(0, options.size() - 1) + " fault=" + fault + "'"),
          2)
          << fault << "\n"
          << out;
      EXPECT_TRUE(says("nothing to judge: ")) << fault << "\n" << out;
      EXPECT_TRUE(says("self-check") || says("multisampling is on")) << fault << "\n" << out;
      EXPECT_FALSE(says("CERTIFIED")) << fault << "\n" << out;
    }
  }

  // A page: `Driver: NAME` and `Options: OPTIONS` say what it is about. In blocks of ```console, each line after
  // `$ COMMAND` is in what the command prints ("..." stands for others, "(nowhere: TEXT)" for the absence of a text);
  // in blocks of ```text, each line is in the record of the run at standard level beside the page. `Suite: ` says that
  // the page is of an older suite: then its commands are not run.
  void replay_page(const std::string& name) {
    const fs::path pages = SUREFILL_CERTIFICATES;
    std::istringstream page(contents(pages / (name + ".md")));
    const std::string record = contents(pages / (name + ".txt"));
    std::string about, options, block, older;
    std::size_t commands = 0, quoted = 0;
    bool here = false;
    for (std::string line; std::getline(page, line);) {
      if (line.rfind("```", 0) == 0) {
        block = block.empty() ? line.substr(3) : "";
        continue;
      }
      if (block.empty()) {
        if (line.rfind("Driver: `", 0) == 0) about = line.substr(9, line.rfind('`') - 9);
        if (line.rfind("Suite: ", 0) == 0) older = line;
        if (line.rfind("Options: `", 0) == 0) options = line.substr(10, line.rfind('`') - 10);
      } else if (block == "text") {
        EXPECT_NE(record.find(line + "\n"), std::string::npos) << name << ".txt has no line: " << line;
        ++quoted;
      } else if (block == "console" && !older.empty()) {
        continue;
      } else if (block == "console" && line.rfind("$ surefill ", 0) == 0) {
        if (!here) {
          const std::string present = driver(options);
          if (present.empty()) GTEST_SKIP() << out;
          if (present != about) GTEST_SKIP() << name << ".md is about " << about << "; here is " << present;
          here = true;
        }
        const std::string driver_argument = options.substr(options.rfind(' ') + 1);
        EXPECT_NE(line.find(driver_argument), std::string::npos) << name << ": a command for another driver: " << line;
        surefill(line.substr(11));
        ++commands;
      } else if (block == "console" && line.rfind("(nowhere: ", 0) == 0) {
        const std::string text = line.substr(10, line.size() - 11);
        EXPECT_FALSE(says(text)) << name << ": expected nowhere\n" << text << "\nin\n" << out;
      } else if (block == "console" && line != "...") {
        EXPECT_TRUE(says(line)) << name << ": expected the line\n" << line << "\nin\n" << out;
      }
    }
    EXPECT_GT(quoted, 5u) << "the page quotes no run";
    if (!older.empty()) GTEST_SKIP() << name << ".md: " << older;
    EXPECT_GT(commands, 5u) << "the page has no claims";
  }

  std::string out;
};

TEST_F(Drivers, PageLlvmpipe) {
  replay_page("llvmpipe");
}
TEST_F(Drivers, PageSoftpipe) {
  replay_page("softpipe");
}
TEST_F(Drivers, PageLavapipe) {
  replay_page("lavapipe");
}

TEST_F(Drivers, WrongStateIsNotBlamedOnLlvmpipe) {
  expect_noticed(kOpenGl + std::string("'driver=llvmpipe'"),
                 {"scissor", "viewport", "multisample", "cull", "blend", "depth-range", "polygon-offset", "color-mask",
                  "front-face", "depth-test"});
}
TEST_F(Drivers, WrongStateIsNotBlamedOnSoftpipe) {
  // It has no multisampling that could be left on.
  expect_noticed(kOpenGl + std::string("'driver=softpipe'"),
                 {"scissor", "viewport", "cull", "blend", "depth-range", "polygon-offset", "color-mask", "front-face",
                  "depth-test"});
}
TEST_F(Drivers, WrongStateIsNotBlamedOnVulkan) {
  expect_noticed(kVulkan + std::string("'device=llvmpipe'"),
                 {"scissor", "viewport", "multisample", "cull", "blend", "depth-range", "front-face", "depth-test"});
}

// The commands of docs/certify-your-rasterizer.md do what they say; those of drivers and scripts with one check only.
TEST_F(Drivers, TheHowToIsTrue) {
  const fs::path root = fs::path(SUREFILL_CERTIFICATES) / "../..";
  for (const char* name : {"certify", "examples"}) fs::create_directory_symlink(root / name, folder_ / name);
  std::istringstream page(contents(root / "docs/certify-your-rasterizer.md"));
  bool shell = false;
  std::size_t commands = 0;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("```", 0) == 0) shell = line == "```sh";
    const bool names_a_finding = line.find("FOUND.scene") != std::string::npos;
    if (!shell || line.rfind("```", 0) == 0 || names_a_finding) continue;
    ++commands;
    if (line.rfind("surefill ", 0) != 0) {
      EXPECT_EQ(std::system(("cd '" + folder_.string() + "' && " + line).c_str()), 0) << line;
      continue;
    }
    const bool of_driver = line.find("--adapter") != std::string::npos;
    const bool slow = of_driver || line.find("--command") != std::string::npos;
    const int status = surefill(line.substr(9) + " --jobs 1" + (slow ? " --only model" : ""));
    if (of_driver && status == 2) {
      EXPECT_TRUE(says("nothing to judge") || says("was not built")) << line << "\n" << out;
    } else {
      EXPECT_EQ(status, 0) << line << "\n" << out;
    }
  }
  EXPECT_GE(commands, 7u);
}

TEST_F(Drivers, AbsentDriversAreNotJudged) {
  EXPECT_EQ(surefill("certify --adapter opengl --plugin-arguments driver=none"), 2) << out;
  EXPECT_EQ(surefill("certify --adapter vulkan --plugin-arguments device=none"), 2) << out;
  EXPECT_EQ(surefill("certify --adapter opengl --plugin-arguments nonsense=1"), 2) << out;
  EXPECT_EQ(surefill("certify --adapter direct3d"), 2) << out;
}

TEST_F(Drivers, OpenGlConventionsAreFound) {
  const std::string options = kOpenGl + std::string("'driver=llvmpipe clip=classic'");
  if (driver(options).empty()) GTEST_SKIP() << out;
  EXPECT_TRUE(says("rows from the bottom")) << out;
  EXPECT_TRUE(says("clip depth -1 to 1")) << out;
  EXPECT_EQ(surefill("certify --jobs 1 --only 'model,partition-fan,tilings' " + options), 0) << out;
}

TEST_F(Drivers, VulkanIsUsedAsItsValidationLayerDemands) {
  const std::string options = kVulkan + std::string("'device=llvmpipe validation'");
  if (driver(options).empty()) GTEST_SKIP() << out;
  surefill("certify --jobs 1 --only 'model*,alone,values,scissor' " + options);
  EXPECT_TRUE(says("alone: ")) << out;
  EXPECT_FALSE(says("validation layer")) << out;
  EXPECT_EQ(surefill("certify --jobs 1 --only model --adapter vulkan --plugin-arguments 'validation fault=invalid'"),
            2);
  EXPECT_TRUE(says("the validation layer says: ")) << out;
}

}  // namespace
}  // namespace surefill
