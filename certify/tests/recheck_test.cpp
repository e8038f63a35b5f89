// SPDX-License-Identifier: Apache-2.0
//
// recheck: what became of a certificate's findings, on the rival of then, another one, and the engine.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "properties/machinery/test_folder.hpp"

namespace surefill {
namespace {

class Recheck : public InFolder {
 protected:
  int surefill(const std::string& arguments) {
    const std::string line =
        "cd '" + folder_.string() + "' && " SUREFILL_COMMAND " " + arguments + " >out.txt 2>err.txt";
    const int status = std::system(line.c_str());
    out = contents(folder_ / "out.txt");
    error = contents(folder_ / "err.txt");
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  }
  // How many lines begin with the word?
  int lines(const std::string& word) const {
    int found = out.starts_with(word + " ") ? 1 : 0;
    for (std::size_t at = out.find("\n" + word + " "); at != std::string::npos;
         at = out.find("\n" + word + " ", at + 1)) {
      ++found;
    }
    return found;
  }
  bool says(const std::string& text) const { return out.find(text) != std::string::npos; }
  // Refused in one line, which holds `cause`, before anything is printed.
  void expect_refused(const std::string& arguments, const std::string& cause) {
    EXPECT_EQ(surefill("recheck " + arguments), 2) << arguments;
    EXPECT_EQ(out, "") << arguments;
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
    EXPECT_TRUE(error.starts_with("surefill: ") && error.find(cause) != std::string::npos) << error;
  }

  std::string out, error;
};

const std::string kZoo = "--plugin " SUREFILL_ZOO_PLUGIN " ";

TEST_F(Recheck, SaysWhatIsStillThereWhatChangedAndWhatIsGone) {
  const std::string inclusive = kZoo + "--plugin-arguments edges-inclusive";
  ASSERT_EQ(
      surefill("certify --jobs 1 --only 'model-corpus,partition-fan,partition-delaunay,alone,split' --json c.json " +
               inclusive),
      1);
  // The same again.
  EXPECT_EQ(surefill("recheck c.json " + inclusive), 1) << out << error;
  const int findings = lines("still");
  EXPECT_GE(findings, 2) << out;
  EXPECT_EQ(lines("changed") + lines("gone"), 0) << out;
  EXPECT_TRUE(
      says(std::to_string(findings) + " findings: " + std::to_string(findings) + " still there, 0 changed, 0 gone"))
      << out;
  // A right one, and the engine itself.
  EXPECT_EQ(surefill("recheck c.json --plugin " SUREFILL_ENGINE_PLUGIN), 0) << out << error;
  EXPECT_EQ(lines("gone"), findings) << out;
  EXPECT_TRUE(says("the certificate is of ")) << out;
  // Another fault: not one of them is the same.
  EXPECT_EQ(surefill("recheck c.json " + kZoo + "--plugin-arguments edges-exclusive"), 1) << out << error;
  EXPECT_EQ(lines("still"), 0) << out;
  EXPECT_GE(lines("changed"), 1) << out;
  EXPECT_TRUE(says("\n         now: ")) << out;
  // One that ends itself at each scene judges nothing, and nothing is gone.
  EXPECT_EQ(surefill("recheck c.json --time-limit 1 --plugin " SUREFILL_ENGINE_PLUGIN " --plugin-arguments exit"), 1)
      << out << error;
  EXPECT_EQ(lines("gone"), 0) << out;
  // By name.
  EXPECT_EQ(surefill("recheck c.json 'partition-f*' " + inclusive), 1) << out << error;
  EXPECT_EQ(lines("still"), 1) << out;
  EXPECT_TRUE(says("still    partition-fan: ") && says("1 finding: 1 still there")) << out;
}

TEST_F(Recheck, FindingsWithoutASceneAreRunByTheirNumber) {
  const std::string engine = "--plugin " SUREFILL_FLOAT_EDGES;
  ASSERT_EQ(surefill("certify --jobs 1 --only model --json c.json " + engine), 1) << out << error;
  EXPECT_EQ(surefill("recheck c.json " + engine), 1) << out << error;
  EXPECT_EQ(lines("still"), 1) << out;
  EXPECT_EQ(surefill("recheck c.json --plugin " SUREFILL_FIXED_POINT), 0) << out << error;
  EXPECT_EQ(lines("gone"), 1) << out;
  EXPECT_TRUE(says("  its model was: ")) << out;
}

TEST_F(Recheck, CertificatesWithoutFindings) {
  ASSERT_EQ(surefill("certify --jobs 1 --only order,scale --json c.json"), 0) << out << error;
  EXPECT_EQ(surefill("recheck c.json"), 0);
  EXPECT_EQ(out, "c.json: it has no findings\n");
  expect_refused("c.json order", "c.json: nothing was found by order; it has no findings");
}

TEST_F(Recheck, RefusesWhatItCannotUse) {
  const std::string inclusive = kZoo + "--plugin-arguments edges-inclusive";
  ASSERT_EQ(surefill("certify --jobs 1 --only 'partition-fan,scale' --json c.json " + inclusive), 1) << out << error;
  // What a file names is not started.
  expect_refused("c.json", "no program is started because a file names it, so say which: --plugin " SUREFILL_ZOO_PLUGIN
                           " --plugin-arguments edges-inclusive");
  expect_refused("c.json nothing " + inclusive, "c.json: no check nothing; its findings: partition-fan");
  expect_refused("c.json scale " + inclusive, "c.json: nothing was found by scale; its findings: partition-fan");
  expect_refused("c.json partition-fan scale " + inclusive, "nothing was found by scale");
  expect_refused("none.json", "none.json: cannot be read");
  expect_refused(".", ".: ");
  expect_refused("c.json --plugin none.so", "none.so: no such file");
  expect_refused("c.json --plugin a.so --adapter opengl", "--plugin");
  expect_refused("", "JSON");
  std::string text = contents(folder_ / "c.json");
  std::ofstream(folder_ / "cut.json") << text.substr(0, text.size() / 2);
  expect_refused("cut.json", "cut.json: ");
  const std::size_t at = text.find("edges-inclusive");
  ASSERT_NE(at, std::string::npos);
  std::ofstream(folder_ / "edited.json") << text.replace(at, 5, "ledge");
  expect_refused("edited.json", "edited.json: ");
}

}  // namespace
}  // namespace surefill
