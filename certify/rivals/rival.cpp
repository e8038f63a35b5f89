// SPDX-License-Identifier: Apache-2.0
#include "certify/rivals/rival.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "certify/rivals/frame.hpp"
#include "certify/rivals/model.hpp"
#include "certify/rivals/stated_model.hpp"
#include "oracle/oracle.hpp"

namespace surefill::adapters {

namespace {

constexpr std::chrono::milliseconds kLeastOpeningTime{20000};
constexpr int kMostDeaths = 10;                 // of one that draws other scenes
constexpr int kMostFirstFailures = 3;           // of one that has drawn nothing yet
constexpr std::size_t kMostStructWords = 4096;  // of version 2
constexpr std::size_t kMostAlone = 200;         // triangles that are drawn alone to find counts

std::string cause_of(const Answer& answer) {
  std::string text = text_of(answer.words);
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 32) c = ' ';
  }
  const std::size_t begin = text.find_first_not_of(' ');
  return begin == std::string::npos ? "it gives no reason" : text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

[[noreturn]] void refuse(const std::string& what) {
  throw RivalUnopened("the rasterizer describes itself wrongly: " + what);
}

// Numbers that the header does not allow: a rival that says such things is not asked further.
void check_info(const surefill_adapter_info& info, std::uint32_t version) {
  const surefill_adapter_model& model = info.model;
  if ((info.outputs & ~kAllOutputs) != 0) refuse("an output that there is not");
  if ((info.outputs & (SUREFILL_ADAPTER_COUNT | SUREFILL_ADAPTER_INDEX | SUREFILL_ADAPTER_DEPTH)) == 0) {
    refuse("it has none of the outputs count, index and depth");
  }
  if (info.features >> (version == SUREFILL_ADAPTER_VERSION ? 19 : 21) != 0) refuse("a feature that there is not");
  if (info.form > SUREFILL_ADAPTER_FORM_CLIP) refuse("a form that there is not");
  if (model.kind > SUREFILL_ADAPTER_MODEL_GRID) refuse("a model that there is not");
  if (model.grid_bits > 12 || model.grid_offset_x > 15 || model.grid_offset_y > 15 || model.grid_rounding > 2) {
    refuse("a grid that there is not");
  }
  if (model.fill_rule > 7) refuse("a fill rule that there is not");
  if (model.profile > SUREFILL_ADAPTER_PROFILE_OPENGL) refuse("a profile that there is not");
  if (model.y > SUREFILL_ADAPTER_Y_UNKNOWN || model.depth_range > SUREFILL_ADAPTER_DEPTH_RANGE_UNKNOWN) {
    refuse("a convention that there is not");
  }
  if (info.max_components > kMaxComponents) refuse("more components than an attribute has");
  if (std::memchr(info.name, 0, sizeof info.name) == nullptr || info.name[0] == '\0') refuse("it has no name");
  if (std::memchr(info.version, 0, sizeof info.version) == nullptr) refuse("its version has no end");
}

template <typename Value>
void turn_rows(std::span<Value> values, int height) {
  const std::size_t rows = static_cast<std::size_t>(height), row = values.size() / rows;
  for (std::size_t y = 0; y < rows / 2; ++y) {
    std::swap_ranges(values.begin() + static_cast<std::ptrdiff_t>(y * row),
                     values.begin() + static_cast<std::ptrdiff_t>((y + 1) * row),
                     values.begin() + static_cast<std::ptrdiff_t>((rows - 1 - y) * row));
  }
}

// The target with only the outputs of the mask.
Target with_outputs(Target target, std::uint32_t outputs) {
  if (!(outputs & SUREFILL_ADAPTER_COUNT)) target.count = {};
  if (!(outputs & SUREFILL_ADAPTER_INDEX)) target.index = {};
  if (!(outputs & SUREFILL_ADAPTER_DEPTH)) target.depth = {};
  if (!(outputs & SUREFILL_ADAPTER_BARYCENTRICS)) target.barycentrics = {};
  if (!(outputs & SUREFILL_ADAPTER_ATTRIBUTES)) target.attributes = {};
  return target;
}

// The adapter shows a rival the attributes that are asked for; B1 drops triangles for the others, too.
void skip_unseen_attributes(std::span<const Draw> draws, std::size_t seen) {
  for (const Draw& draw : draws) {
    for (std::size_t k = seen; k < draw.attributes.size(); ++k) {
      const std::span<const float> values = draw.attributes[k].values;
      if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); })) {
        throw RivalSkips("attributes with a NaN or an infinity that are not asked for");
      }
    }
  }
}

bool asks_for_nothing(const Target& target) {
  return target.count.empty() && target.index.empty() && target.depth.empty() && target.barycentrics.empty() &&
         target.attributes.empty();
}

}  // namespace

namespace {

// A process that was asked to open, and what it answered.
struct Opened {
  std::unique_ptr<Process> process;
  std::uint32_t version = SUREFILL_ADAPTER_VERSION;
  Answer answer;
  std::string failure;  // set: it cannot be used
};

Opened open_process(const RivalOptions& options) {
  Opened opened;
  Words body{SUREFILL_ADAPTER_VERSION};
  const Words arguments = text_words(options.arguments);
  body.insert(body.end(), arguments.begin(), arguments.end());
  try {
    opened.process = std::make_unique<Process>(options.command);
  } catch (const std::runtime_error& error) {
    opened.failure = error.what();
    return opened;
  }
  // Starting an interpreter or a device takes longer than a scene, and on a busy machine much longer.
  const auto limit = std::max(options.time_limit * 4, kLeastOpeningTime);
  opened.answer = opened.process->ask(kOpen, body, kInfoWords, limit);
  // One of version 2 that is asked for version 1 answers with its version alone.
  if (opened.answer.failure.empty() && opened.answer.status == SUREFILL_ADAPTER_OK &&
      opened.answer.words == Words{SUREFILL_ADAPTER2_VERSION}) {
    opened.version = body[0] = SUREFILL_ADAPTER2_VERSION;
    opened.answer = opened.process->ask(kOpen, body, kMostStructWords, limit);
  }
  const Answer& answer = opened.answer;
  if (!answer.failure.empty()) {
    opened.failure = "on being opened, " + answer.failure;
  } else if (answer.status != SUREFILL_ADAPTER_OK && answer.words == body) {
    // A program that copies its input, such as cat: the request's kind, 1, reads as a status.
    opened.failure = "on being opened, the rasterizer gave the request back: it does not speak the adapter's messages";
  } else if (answer.status == SUREFILL_ADAPTER_UNSUPPORTED) {
    opened.failure = cause_of(answer);
  } else if (answer.status != SUREFILL_ADAPTER_OK) {
    opened.failure = "the rasterizer cannot be opened: " + cause_of(answer);
  }
  return opened;
}

}  // namespace

Rival::Rival(RivalOptions options) : options_(std::move(options)) {
  Opened opened = open_process(options_);
  if (!opened.failure.empty()) throw RivalUnopened(opened.failure);
  const Words& words = opened.answer.words;
  version_ = opened.version;
  if (version_ == SUREFILL_ADAPTER2_VERSION) {
    take_second_version(*opened.process, words);
  } else if (words.size() != kInfoWords) {
    throw RivalUnopened(
        fmt::format("the rasterizer describes itself in {} words instead of {}", words.size(), kInfoWords));
  } else {
    std::memcpy(&info_, words.data(), sizeof info_);
  }
  check_info(info_, version_);
  if (primitives_ >> SUREFILL_ADAPTER2_LINES & 1u) info_.features |= kLines;
  if (primitives_ >> SUREFILL_ADAPTER2_POINTS & 1u) info_.features |= kPoints;
  says_rows_ = info_.model.y != SUREFILL_ADAPTER_Y_UNKNOWN;
  says_depth_range_ = info_.model.depth_range != SUREFILL_ADAPTER_DEPTH_RANGE_UNKNOWN;
  if (info_.model.y == SUREFILL_ADAPTER_Y_UNKNOWN) info_.model.y = SUREFILL_ADAPTER_Y_DOWN;
  if (info_.model.depth_range == SUREFILL_ADAPTER_DEPTH_RANGE_UNKNOWN) {
    info_.model.depth_range = SUREFILL_ADAPTER_ZERO_TO_ONE;
  }
  idle_.push_back(std::move(opened.process));
}

void Rival::take_second_version(Process& process, const Words& words) {
  surefill_adapter2_info info{};
  if (const std::string wrong = take_struct(words, &info, sizeof info); !wrong.empty()) refuse(wrong);
  constexpr std::uint64_t kHalf = ~std::uint32_t{0};
  if (info.outputs > kHalf) refuse("an output that there is not");
  if (info.features > kHalf) refuse("a feature that there is not");
  if (info.primitives >> (SUREFILL_ADAPTER2_POINTS + 1) != 0) refuse("a primitive that there is not");
  primitives_ = info.primitives & ~(1u << SUREFILL_ADAPTER2_TRIANGLES);
  std::memcpy(info_.name, info.name, sizeof info_.name);
  std::memcpy(info_.version, info.version, sizeof info_.version);
  info_.outputs = static_cast<std::uint32_t>(info.outputs);
  info_.features = static_cast<std::uint32_t>(info.features);
  info_.form = info.form;
  info_.model.grid_bits = info.reported_bits;
  info_.model.profile = info.profile;
  info_.model.y = info.rows;
  info_.model.depth_range = info.clip_depth;
  info_.max_width = info.max_width;
  info_.max_height = info.max_height;
  info_.max_vertices = info.max_vertices;
  info_.max_triangles = info.max_primitives;
  info_.max_attributes = info.max_attributes;
  info_.max_components = info.max_components;
  const Answer answer = process.ask(kModel, {}, kMostStructWords, options_.time_limit);
  if (!answer.failure.empty()) throw RivalUnopened("asked for its model, " + answer.failure);
  if (answer.status == SUREFILL_ADAPTER_UNSUPPORTED) return;
  if (answer.status != SUREFILL_ADAPTER_OK) throw RivalUnopened("asked for its model, it failed: " + cause_of(answer));
  surefill_adapter2_model model = default_model();
  if (const std::string wrong = take_struct(answer.words, &model, sizeof model); !wrong.empty()) refuse(wrong);
  stated_.emplace();
  if (const std::string wrong = take_model(model, *stated_); !wrong.empty()) refuse("its model has " + wrong);
  // What section 6 has, and nothing else in it, is known by that name: then images may be held to it to the bit.
  if (const auto expressed = adapter_model(*stated_, info_.model)) {
    judge::Model same = model_of(*expressed);
    same.distance = stated_->distance;
    same.turned = stated_->turned;
    if (same == *stated_) info_.model = *expressed;
  }
}

bool Rival::given_up() const {
  return deaths_ >= kMostDeaths || (drawn_ == 0 && failures_ >= kMostFirstFailures);
}

bool Rival::is_reducible() const {
  return drawn_ > 0 && timeouts_ < kMostDeaths;
}

std::string Rival::why_given_up() const {
  const std::lock_guard lock(mutex_);
  return drawn_ == 0 ? fmt::format("it drew nothing in {} attempts: {}", failures_.load(), last_failure_)
                     : fmt::format("it died on {} scenes, the last time so: {}", deaths_.load(), last_failure_);
}

void Rival::fail(const std::string& cause, bool died) {
  if (const std::lock_guard lock(mutex_); uncounted_ == 0 && !given_up()) {
    ++failures_;
    if (died) ++deaths_;
    last_failure_ = cause;
  }
  throw RivalFailure(cause);
}

std::unique_ptr<Process> Rival::take() {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      std::unique_ptr<Process> process = std::move(idle_.back());
      idle_.pop_back();
      return process;
    }
  }
  Opened opened = open_process(options_);
  if (!opened.failure.empty()) fail("started again: " + opened.failure, true);
  return std::move(opened.process);
}

void Rival::draw_once(Target target, std::span<const Draw> draws) {
  // Without draws there is no array that says how many components an attribute has; the empty image is +0 (V1).
  if (draws.empty()) {
    for (const AttributeTarget& attribute : target.attributes) {
      std::fill(attribute.values.begin(), attribute.values.end(), 0.0f);
    }
    target.attributes = {};
    if (asks_for_nothing(target)) return;
  }
  std::vector<float> initial_depth(target.initial_depth.begin(), target.initial_depth.end());
  const bool up = info_.model.y == SUREFILL_ADAPTER_Y_UP;
  if (up && !initial_depth.empty()) turn_rows(std::span<float>(initial_depth), target.height);
  target.initial_depth = initial_depth;
  AdapterFrame frame(target, draws, clip_form(info_, wide_viewports_ > 0));
  if (turned_viewports_ > 0) frame.turn_viewports();
  const std::vector<OutputBuffer> outputs = output_buffers(frame.scene(), frame.image());
  std::size_t due = 0;
  for (const OutputBuffer& output : outputs) due += output.size;

  std::unique_ptr<Process> process = take();
  const Answer answer = process->ask(kDraw, scene_words(frame.scene(), frame.image(), version_, frame.primitives()),
                                     due, options_.time_limit);
  if (answer.timed_out) ++timeouts_;
  if (!answer.failure.empty()) fail(answer.failure, true);
  {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(process));
  }
  if (answer.status == SUREFILL_ADAPTER_UNSUPPORTED) throw RivalSkips(cause_of(answer));
  if (answer.status != SUREFILL_ADAPTER_OK) fail("the rasterizer failed: " + cause_of(answer), false);
  if (answer.words.size() != due) {
    fail(fmt::format("the rasterizer answered {} words where {} are due", answer.words.size(), due), false);
  }
  ++drawn_;
  const std::uint32_t* words = answer.words.data();
  for (const OutputBuffer& output : outputs) {
    std::memcpy(output.words, words, output.size * 4);
    words += output.size;
  }
  if (!up) return;
  turn_rows(target.count, target.height);
  turn_rows(target.index, target.height);
  turn_rows(target.depth, target.height);
  turn_rows(target.barycentrics, target.height);
  for (const AttributeTarget& attribute : target.attributes) turn_rows(attribute.values, target.height);
}

void Rival::add_up_counts(const Target& target, std::span<const Draw> draws) {
  skip_unseen_attributes(draws, 0);  // drawn alone they have no attributes
  const std::size_t total = sample_total(target);
  std::fill(target.count.begin(), target.count.end(), 0u);
  const bool by_index = (info_.outputs & SUREFILL_ADAPTER_INDEX) != 0;
  std::vector<std::uint32_t> index(by_index ? total : 0);
  std::vector<float> depth(by_index ? 0 : total);
  Target alone = with_outputs(target, 0);
  alone.initial_depth = {};  // covers count whatever their depth (M2)
  alone.index = index;
  alone.depth = depth;
  const float empty = (target.depth_test == DepthTest::greater ? -1.0f : 1.0f) * std::numeric_limits<float>::infinity();
  for (const Draw& draw : draws) {
    const std::size_t corners = corpus::corners_of(draw.primitive);
    for (std::size_t t = 0; corners * t < draw.indices.size(); ++t) {
      Draw one = draw;
      one.indices = draw.indices.subspan(corners * t, corners);
      one.identifiers = {};
      one.first_index = 0;
      one.depth_write = true;  // or no depth would say what it covers
      draw_once(alone, {&one, 1});
      for (std::size_t s = 0; s < total; ++s) {
        if (by_index ? index[s] != kNoTriangle : depth[s] != empty) ++target.count[s];
      }
    }
  }
}

void Rival::draw(const Target& target, std::span<const Draw> draws) {
  const std::vector<Draw> under = under_model(draws, info_);
  const std::string lacking = what_is_lacking(target, under, info_);
  if (!lacking.empty()) throw RivalSkips(lacking);
  const Target asked = with_outputs(target, info_.outputs);
  skip_unseen_attributes(under, asked.attributes.size());
  const bool conservative =
      std::any_of(under.begin(), under.end(), [](const Draw& draw) { return draw.conservative != Conservative::none; });
  std::size_t triangles = 0;
  for (const Draw& draw : under) triangles += draw.indices.size() / corpus::corners_of(draw.primitive);
  if (asked.count.empty() && !target.count.empty() && triangles > kMostAlone) {
    throw RivalSkips("so many triangles without a count");
  }
  if (conservative && asked.count.empty()) throw RivalSkips("conservative rasterization has counts alone (M4)");
  if (!asks_for_nothing(asked)) draw_once(asked, under);
  if (!target.count.empty() && asked.count.empty()) add_up_counts(target, under);
}

properties::Renderer rival_renderer(Rival& rival, std::uint32_t judged) {
  return [&rival, judged](const Target& target, std::span<const Draw> draws) {
    if (const Status status = validate(target, draws); status != Status::ok) return status;
    std::uint32_t own = rival.info().outputs & judged;
    if (judged & SUREFILL_ADAPTER_COUNT) own |= SUREFILL_ADAPTER_COUNT;  // made up where it is missing
    const Target theirs = with_outputs(target, own), rest = with_outputs(target, kAllOutputs & ~own);
    // First, so that a frame that is skipped costs no oracle.
    rival.draw(theirs, draws);
    if (!asks_for_nothing(rest)) oracle::render(rest, under_model(draws, rival.info()));
    return Status::ok;
  };
}

properties::Renderer model_renderer(const Rival& rival) {
  return [&rival](const Target& target, std::span<const Draw> draws) {
    if (const Status status = validate(target, draws); status != Status::ok) return status;
    oracle::render(target, under_model(draws, rival.info()));
    return Status::ok;
  };
}

corpus::Scene scene_under_model(corpus::Scene scene, const surefill_adapter_info& info) {
  for (corpus::SceneDraw& draw : scene.draws) {
    Draw plain;
    plain.state() = draw.state();
    draw.state() = under_model({&plain, 1}, info)[0].state();
  }
  return scene;
}

}  // namespace surefill::adapters
