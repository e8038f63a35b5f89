// SPDX-License-Identifier: Apache-2.0
#include "mutation/called.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>
#include <vector>

#include "certify/judge/facts.hpp"
#include "certify/judge/inference.hpp"
#include "certify/judge/words.hpp"
#include "certify/rivals/model.hpp"
#include "certify/rivals/names.hpp"
#include "certify/run/checks.hpp"
#include "certify/run/progress.hpp"
#include "mutation/zoo/further.hpp"
#include "mutation/zoo/zoo.hpp"
#include "properties/generators/generators.hpp"
#include "properties/machinery/properties.hpp"

namespace surefill::mutation {
namespace {

using corpus::Image;
using corpus::Scene;
using Render = Status (*)(const Target& target, zoo::Draws draws);

// Scenes as certify has them, each drawn by each rasterizer once.
class Pool {
 public:
  std::size_t random(std::size_t n) {
    const auto found = random_.find(n);
    if (found != random_.end()) return found->second;
    properties::SceneLimits limits;
    limits.state = n % 2 == 1;
    limits.samples = n % 4 == 1;
    limits.grid = true;
    limits.conservative = n % 4 == 3;
    const auto categories = properties::categories();
    const std::uint64_t seed = certify::case_seed(1, "naming", n);
    return random_[n] = add(properties::random_scene(categories[n / 4 % categories.size()], seed, limits));
  }
  std::size_t of(const properties::Property& property, std::size_t n) {
    const auto key = std::pair(&property, n);
    const auto found = properties_.find(key);
    if (found != properties_.end()) return found->second;
    return properties_[key] = add(properties::sampled_case(property, n));
  }

  const Scene& scene(std::size_t n) const { return scenes_[n]; }
  // Empty where it says that it cannot.
  const Image& drawn(Render render, std::size_t n) {
    const auto key = std::pair(render, n);
    const auto found = images_.find(key);
    if (found != images_.end()) return found->second;
    corpus::Frame frame(scenes_[n], properties::outputs_of(scenes_[n]));
    Image& image = images_[key];
    if (render(frame.target(), frame.draws()) == Status::ok) image = std::move(frame.image());
    return image;
  }

 private:
  std::size_t add(Scene scene) {
    scenes_.push_back(std::move(scene));
    return scenes_.size() - 1;
  }

  std::vector<Scene> scenes_;
  std::map<std::size_t, std::size_t> random_;
  std::map<std::pair<const properties::Property*, std::size_t>, std::size_t> properties_;
  std::map<std::pair<Render, std::size_t>, Image> images_;
};

Status right(const Target& target, zoo::Draws draws) {
  if (const Status status = validate(target, draws); status != Status::ok) return status;
  return properties::oracle_renderer()(target, draws);
}

// Scenes on which it is wrong, as a run finds them: of every property the first ones, and random ones.
std::vector<std::size_t> wrong_scenes(Pool& pool, Render render, std::size_t cases_of_property,
                                      std::vector<Scene>& fine) {
  constexpr std::size_t kOfProperties = 8, kAll = 24, kTries = 1200;
  std::vector<std::size_t> wrong;
  const auto look_at = [&](std::size_t n) {
    const Image &actual = pool.drawn(render, n), &expected = pool.drawn(right, n);
    if (expected.count.empty() || actual.count.empty()) return false;
    if (properties::compare(pool.scene(n), expected, actual, 1).differences == 0) {
      if (fine.size() < kAll) fine.push_back(pool.scene(n));
      return false;
    }
    wrong.push_back(n);
    return true;
  };
  for (const properties::Property& property : properties::all_properties()) {
    for (std::size_t n = 0; n < cases_of_property && wrong.size() < kOfProperties; ++n) {
      if (look_at(pool.of(property, n))) break;
    }
  }
  fine.clear();  // of random ones alone
  for (std::size_t n = 0; n < kTries && (wrong.size() < kAll || n < 2 * kAll); ++n) look_at(pool.random(n));
  return wrong;
}

std::vector<judge::Wrong> shown_wrong(Pool& pool, Render render, std::vector<Scene>& fine) {
  std::vector<std::size_t> found;
  // What is seen rarely is looked for longer.
  for (const std::size_t cases : {10u, 300u}) {
    found = wrong_scenes(pool, render, cases, fine);
    if (!found.empty()) break;
  }
  std::vector<judge::Wrong> wrong;
  for (const std::size_t n : found) wrong.push_back({pool.scene(n), pool.drawn(right, n), pool.drawn(render, n)});
  return wrong;
}

// Draws in this process.
class Drawn : public judge::Rival {
 public:
  explicit Drawn(Render render) : render_(render) {}
  corpus::Outputs outputs() const override { return {}; }
  double position_step() const override { return 0; }
  Image draw(const Scene& scene, const corpus::Outputs& wanted) override {
    corpus::Frame frame(scene, wanted);
    if (render_(frame.target(), frame.draws()) != Status::ok) throw judge::Declined("it says so");
    return std::move(frame.image());
  }

 private:
  Render render_;
};

// As a certificate has it: first what probing finds, if it is not the exact model, then what is like what is wrong.
std::vector<std::string> called(Pool& pool, Render render) {
  std::vector<std::string> sentences;
  Drawn drawn(render);
  const judge::Inference found = judge::infer(drawn, adapters::oracle_expected(), judge::Model{});
  std::vector<std::string> model;
  if (!found.shape.empty()) model.push_back(found.shape);
  if (found.known) {
    for (const std::string& sentence : judge::differences({}, found.model)) model.push_back(sentence);
    for (const std::string& sentence : judge::departures(found.model)) {
      if (std::find(model.begin(), model.end(), sentence) == model.end()) model.push_back(sentence);
    }
  }
  // Rounding on the way, and that no rule was found, come of what else it does: they are said last.
  const auto vague = [](const std::string& s) {
    return s.starts_with("positions are blurred") || s.starts_with("who owns");
  };
  std::vector<std::string> last;
  std::copy_if(model.begin(), model.end(), std::back_inserter(last), vague);
  std::erase_if(model, vague);
  if (!model.empty()) sentences.push_back(fmt::format("{}", fmt::join(model, "; ")));
  std::vector<Scene> fine;
  const std::vector<judge::Wrong> wrong = shown_wrong(pool, render, fine);
  const auto still_wrong = [render](const Scene& scene) {
    return properties::compare(scene, right, render, properties::outputs_of(scene), 1).differences > 0;
  };
  const auto both = [render](const Scene& scene) -> std::optional<judge::Wrong> {
    corpus::Frame expected(scene, properties::outputs_of(scene)), actual(scene, properties::outputs_of(scene));
    if (right(expected.target(), expected.draws()) != Status::ok) return std::nullopt;
    if (render(actual.target(), actual.draws()) != Status::ok) return std::nullopt;
    return judge::Wrong{scene, std::move(expected.image()), std::move(actual.image())};
  };
  const std::vector<judge::Name> names = judge::name_fault(certify::known_faults(), wrong, 0);
  const auto image = [](const auto& renderer) {
    return [renderer](const Scene& scene) -> std::optional<Image> {
      corpus::Frame frame(scene, properties::outputs_of(scene));
      if (renderer(frame.target(), frame.draws()) != Status::ok) return std::nullopt;
      return std::move(frame.image());
    };
  };
  judge::Questions questions{image(render), image(right), found.known ? found.model : judge::Model{}, true};
  // Samples that are moved are said by the model.
  if (found.known) questions.model = judge::with_facts(judge::Model{}, found.model);
  std::vector<std::string> likely = judge::ask(questions, certify::known_faults()).sentences;
  for (const std::string& sentence : certify::sentences_of(names, wrong, fine, {still_wrong, both}))
    likely.push_back(sentence);
  // A fault that draws all of it is said before what probing finds.
  const bool sure = wrong.size() >= 8 && !names.empty() && names.front().agreement >= 0.98;
  sentences.insert(sure ? sentences.begin() : sentences.end(), likely.begin(), likely.end());
  if (!last.empty()) sentences.push_back(fmt::format("{}", fmt::join(last, "; ")));
  // That no model explains it is no name.
  sentences.insert(sentences.end(), found.problems.begin(), found.problems.end());
  return sentences;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

// Is one of the words, separated by |, in the text?
bool says(const std::string& text, std::string_view words) {
  for (std::size_t begin = 0; begin <= words.size();) {
    const std::size_t end = std::min(words.find('|', begin), words.size());
    if (lower(text).find(lower(std::string(words.substr(begin, end - begin)))) != std::string::npos) return true;
    begin = end + 1;
  }
  return false;
}

std::string first_of(const std::vector<judge::Name>& names) {
  return names.empty() ? "no name" : certify::name_text(names.front());
}

}  // namespace

bool zoo_names(const std::function<void(const std::string&)>& print) {
  Pool pool;
  std::size_t named = 0, done = 0, further_named = 0, further_done = 0;
  for (const zoo::FurtherFault& fault : zoo::further_faults()) {
    if (certify::interrupted()) return false;
    const std::vector<std::string> sentences = called(pool, fault.render);
    const bool good = !sentences.empty() && says(sentences.front(), fault.must_say);
    ++further_done;
    if (good) ++further_named;
    print(fmt::format("{}further {}: {}\n", good ? "" : "OTHERWISE ", fault.name, fault.fault));
    for (const std::string& sentence : sentences) print("  " + sentence + "\n");
  }
  print(fmt::format("{} of {} further faults are called what they are\n", further_named, further_done));
  for (const zoo::Specimen& specimen : zoo::rival_specimens()) {
    if (certify::interrupted()) return false;
    std::vector<Scene> fine;
    const std::vector<judge::Wrong> wrong = shown_wrong(pool, specimen.render, fine);
    const std::vector<judge::Name> names = judge::name_fault(certify::known_faults(), wrong, 0);
    // Faults that explain it as well are one with it as far as anybody can tell.
    const bool good = std::any_of(names.begin(), names.end(), [&](const judge::Name& name) {
      return name.fault->name == specimen.name && name.agreement == names.front().agreement;
    });
    ++done;
    if (good) ++named;
    print(fmt::format("{}{:32} {}\n", good ? "" : "OTHERWISE ", specimen.name, first_of(names)));
  }
  print(fmt::format("{} of {} specimens are called what they are\n", named, done));
  return 10 * named >= 9 * done && 10 * further_named >= 7 * further_done;
}

}  // namespace surefill::mutation
