// SPDX-License-Identifier: Apache-2.0
//
// A rasterizer under test: somebody's, behind an adapter, in processes of its own.
#ifndef SUREFILL_CERTIFY_ADAPTERS_RIVAL_HPP
#define SUREFILL_CERTIFY_ADAPTERS_RIVAL_HPP

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "certify/adapter.h"
#include "certify/judge/rival.hpp"
#include "certify/rivals/process.hpp"
#include "properties/machinery/compare.hpp"
#include "surefill/surefill.hpp"

namespace surefill::adapters {

using RivalFailure = judge::Failure;

// There is nothing to judge: it cannot be started or opened, or describes itself wrongly. what() is one line, never
// without a cause.
class RivalUnopened : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

using RivalSkips = judge::Declined;

struct RivalOptions {
  std::vector<std::string> command;            // program and its arguments
  std::string arguments;                       // for open
  std::chrono::milliseconds time_limit{5000};  // for one scene
};

// Outputs of a rival that a judge looks at, as bits of the adapter.
inline constexpr std::uint32_t kAllOutputs = SUREFILL_ADAPTER_COUNT | SUREFILL_ADAPTER_INDEX | SUREFILL_ADAPTER_DEPTH |
                                             SUREFILL_ADAPTER_BARYCENTRICS | SUREFILL_ADAPTER_ATTRIBUTES;

// Thread-safe, but for `set_model`: each thread that draws has a process of its own for as long as it does.
class Rival {
  // A number is larger by 1 while this lives.
  class Raised {
   public:
    explicit Raised(std::atomic<int>& number) : number_(number) { ++number_; }
    ~Raised() { --number_; }
    Raised(const Raised&) = delete;
    Raised& operator=(const Raised&) = delete;

   private:
    std::atomic<int>& number_;
  };

 public:
  // Starts a process and asks who it is. Throws RivalUnopened.
  explicit Rival(RivalOptions options);
  Rival(const Rival&) = delete;
  Rival& operator=(const Rival&) = delete;

  // In the words of version 1, whichever version it speaks; features beyond those of version 1 have their bits, and so have
  // lines and points (frame.hpp).
  const surefill_adapter_info& info() const { return info_; }
  std::uint32_t version() const { return version_; }
  // The primitives beside triangles that it claims, as bits: version 2.
  std::uint32_t primitives() const { return primitives_; }
  // The model that it states: version 2.
  const std::optional<judge::Model>& stated() const { return stated_; }
  void set_model(const surefill_adapter_model& model) { info_.model = model; }
  // It says which row is the first one, and which range clip depth has; else info() has the usual ones.
  bool says_rows() const { return says_rows_; }
  bool says_depth_range() const { return says_depth_range_; }

  // Draws the frame, under the model, into those buffers of the target that the rival has; leaves the others as they
  // are. Where it has no count, each triangle is drawn alone and the covers are added up. Throws RivalFailure,
  // RivalSkips.
  void draw(const Target& target, std::span<const Draw> draws);

  // It died (exited, crashed, hung, spoke nonsense) on several scenes, or never drew one: a caller who goes on starts
  // it again for each scene, and learns nothing new. why_given_up() says what came of the last.
  bool given_up() const;
  std::string why_given_up() const;
  // It has drawn something.
  bool has_drawn() const { return drawn_ > 0; }
  // A scene that kills it can be made smaller: some scenes do not, and it does not take its time each time.
  bool is_reducible() const;

  // While one lives, deaths are not counted: for whoever makes such a scene smaller.
  class Uncounted : Raised {
   public:
    explicit Uncounted(Rival& rival) : Raised(rival.uncounted_) {}
  };

  // While one lives, viewports are wide ones (frame.hpp): for whoever asks about anything else.
  class WideViewports : Raised {
   public:
    explicit WideViewports(Rival& rival) : Raised(rival.wide_viewports_) {}
  };

  // While one lives, the y of viewports is counted from the bottom row: for whoever asks whether the rival does so.
  class TurnedViewports : Raised {
   public:
    explicit TurnedViewports(Rival& rival) : Raised(rival.turned_viewports_) {}
  };

 private:
  std::unique_ptr<Process> take();
  [[noreturn]] void fail(const std::string& cause, bool died);
  void take_second_version(Process& process, const Words& words);
  void draw_once(Target target, std::span<const Draw> draws);
  void add_up_counts(const Target& target, std::span<const Draw> draws);

  RivalOptions options_;
  std::uint32_t version_ = SUREFILL_ADAPTER_VERSION;
  surefill_adapter_info info_{};
  std::uint32_t primitives_ = 0;
  std::optional<judge::Model> stated_;
  bool says_rows_ = true, says_depth_range_ = true;
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<Process>> idle_;
  std::string last_failure_;
  std::atomic<int> deaths_ = 0, failures_ = 0;  // a death is a failure, too
  std::atomic<int> timeouts_ = 0;               // all of them
  std::atomic<int> uncounted_ = 0, wide_viewports_ = 0, turned_viewports_ = 0;
  std::atomic<std::uint64_t> drawn_ = 0;
};

// The rival as a renderer. Outputs that it lacks, or that are not among `judged`, are the oracle's under the rival's
// model, so that what compares images looks at the rival's part alone. Throws as Rival::draw.
properties::Renderer rival_renderer(Rival& rival, std::uint32_t judged = kAllOutputs);

// The oracle under the rival's model, in every draw.
properties::Renderer model_renderer(const Rival& rival);

// The scene with the rival's model in every draw, so that it needs no rival to be understood.
corpus::Scene scene_under_model(corpus::Scene scene, const surefill_adapter_info& info);

}  // namespace surefill::adapters

#endif  // SUREFILL_CERTIFY_ADAPTERS_RIVAL_HPP
