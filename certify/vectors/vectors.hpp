// SPDX-License-Identifier: Apache-2.0
//
// Test vectors: frames, what is to come of them, and which faults they show (vectors/, docs/vectors.md). What is expected
// comes of the oracle.
#ifndef SUREFILL_CERTIFY_VECTORS_VECTORS_HPP
#define SUREFILL_CERTIFY_VECTORS_VECTORS_HPP

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "corpus/scene.hpp"
#include "mutation/zoo/zoo.hpp"

namespace surefill::vectors {

// Under which a test is owed: the page's sections 1 to 9, or section 11 with a grid of so many bits, nearest-even.
enum class Model : std::uint8_t { exact, grid4, grid8 };
inline constexpr std::array<std::string_view, 3> kModelNames{"exact", "grid4", "grid8"};
inline constexpr std::array<int, 3> kModelBits{0, 4, 8};

// What a model grants to depth, barycentrics and attributes: what they are within half a step of the grid, as positions
// are off by that, and a step more (R11), both ways; and so many times 2^-24 of the largest |Z/W|, or value, among the vertices.
inline constexpr int kGrantedRoundings = 64;

// What a sample is owed: a count from c to c + open, values from low to high.
struct Expected {
  std::vector<std::uint32_t> count, open, index;
  std::vector<float> depth, barycentrics;  // barycentrics: 3 a sample
  std::vector<std::vector<float>> attributes;
  std::vector<float> depth_high, barycentrics_high;  // under a model of intervals; else empty
  std::vector<std::vector<float>> attributes_high;
  std::vector<std::int32_t> winding;  // where the scene asks for it
};

struct VectorFrame {
  corpus::Scene scene;    // in pixel space, with first_index written out
  bool previous = false;  // initial depth is the depth that the frame before left
  Expected expected;
};

struct Test {
  int id = 0;
  std::string comment;
  std::set<std::string> flags;  // the faults that it was kept for
  std::set<std::string> kills;  // all that it shows
  std::set<std::string> rules;
  std::vector<Model> models;  // the first is the file's
  corpus::Outputs outputs;
  std::optional<std::array<int, 4>> window;  // x0, y0, x1, y1, where expectations are of a part of the target
  std::vector<VectorFrame> frames;

  // Elements of a buffer that are expected, in order: of one that has layers, layer by layer.
  std::vector<std::size_t> samples(bool layered = false) const;
};

// How a fault is seen, over the tests that show it.
struct Effects {
  bool no_image = false, more = false, fewer = false, index = false, depth = false, barycentrics = false,
       attributes = false, winding = false;
  void take(const Effects& other);
  std::string text() const;
};

struct Subject {
  std::string name, title;
  Model model = Model::exact;
  corpus::Outputs outputs;
  std::vector<std::string> folders;     // of corpus/cases
  std::vector<std::string> properties;  // whose cases are candidates, in this order
  std::size_t most_samples = 144;       // that a test expects
  bool keeps_state = true;              // of the draws; else fill rule, and nothing else
  bool keeps_rule = true;               // else top_left
  bool sequences = false;
  std::vector<std::string> modes = {};      // beginnings of rules ("C3 "): a fault is to be shown in each such mode
  std::uint64_t shallow = 80, deep = 1500;  // cases of a property: for all faults, for those that it names
};
std::span<const Subject> subjects();

// A frame or several that may become a test.
struct Candidate {
  std::string comment;
  std::set<std::string> rules;
  corpus::Outputs outputs;
  std::vector<VectorFrame> frames;
};

// Calls take(candidate, property) for each of the subject's candidates; `deep` says whether to go on with a property's
// cases for the faults that it names. Stops a property's cases where take returns false.
using Take = std::function<bool(const Candidate& candidate, const std::string& property, bool deep)>;
void for_each_candidate(const Subject& subject, const std::string& corpus, const Take& take);

// The candidate as a test with expectations, in a window if its target is large; nothing if it cannot be one.
std::optional<Test> test_of(const Subject& subject, const Candidate& candidate);

// Draws a test's frames into the same buffers, one after the other, by an implementation, twice, with other frames
// before; says how it is wrong, if it is so both times.
using Render = Status (*)(const Target&, std::span<const Draw>);
std::optional<Effects> wrong_by(const Test& test, Render render);

// A subject's tests, chosen: each shows a fault (in a mode, where the subject has modes), or names a rule, that none
// before it does.
struct File {
  Subject subject;
  std::vector<Test> tests;
};
using Faults = std::map<std::string, Effects>;  // how each fault is seen, by the name of its specimen
File choose(const Subject& subject, int number, const std::string& corpus, Faults& effects);
// Of all files, a few tests that show as many faults, in so many bytes of JSON.
File smoke_of(std::span<const File> files, std::size_t bytes);

// ---- as files
std::string json_of(const File& file, const Faults& effects);
std::string json_of(const Test& test);
std::string schema_of(const File& file);
std::string faults_of(const File& file);                        // a line a fault: its name, and the tests that show it
std::string text_of(const Test& test, bool with_expectations);  // one line

// What no file shows, and why.
std::string_view why_not_shown(std::string_view specimen);  // empty: it is to be shown

// ---- files that are there
// Of a folder, as tables of Markdown: its files, how many tests of each show which fault, and what none shows.
struct Tables {
  std::string files, matrix, not_shown;
};
Tables tables_of(const std::string& folder);
struct Owed {  // a test, as far as results are held against it; planes have a value a sample: bits, or counts
  int id = 0;
  std::string subject;
  std::vector<std::string> names;                                  // of the planes of a frame
  std::vector<std::vector<std::vector<std::uint32_t>>> low, high;  // by frame, plane, sample
  std::set<std::string> kills;
};
// Reads FOLDER/SUBJECT.json. Throws std::runtime_error.
std::vector<Owed> read_owed(const std::string& folder, const std::string& subject);
std::vector<std::string> subjects_in(const std::string& folder);

struct Verdict {
  std::string text;
  bool passed = false;
};
// Holds lines of results against what is owed. Of each file of which a test is answered, all are to be; but of those in
// the smoke set alone, if no others are answered.
Verdict verify(std::span<const Owed> owed, std::string_view lines, const std::set<int>& smoke);
// {"results": [{"id": 1001, "frames": [{"count": [...], ...}]}]}, frames as those that tests expect, as lines. Throws
// std::runtime_error, with path and cause, where it is not that; a plane that is left out has no values.
std::string lines_of_json(const std::string& text, const std::string& path, std::span<const Owed> owed);

}  // namespace surefill::vectors

#endif  // SUREFILL_CERTIFY_VECTORS_VECTORS_HPP
