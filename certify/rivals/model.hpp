// SPDX-License-Identifier: Apache-2.0
//
// A rival and the oracle as the judge sees them, and the model that a rival follows: what it declares, what probing
// finds.
#ifndef SUREFILL_CERTIFY_ADAPTERS_MODEL_HPP
#define SUREFILL_CERTIFY_ADAPTERS_MODEL_HPP

#include <optional>
#include <string>
#include <vector>

#include "certify/judge/images.hpp"
#include "certify/judge/inference.hpp"
#include "certify/rivals/rival.hpp"

namespace surefill::adapters {

// The rival, which must outlive this, as the judge draws with it.
class JudgedRival : public judge::Rival {
 public:
  explicit JudgedRival(adapters::Rival& rival) : rival_(rival) {}
  corpus::Outputs outputs() const override;
  double position_step() const override;
  Primitives primitives() const override;
  corpus::Image draw(const corpus::Scene& scene, const corpus::Outputs& wanted) override;

 private:
  adapters::Rival& rival_;
};

// oracle::cover, cover_line, cover_point and may_turn.
const judge::Expected& oracle_expected();

// What probing said.
struct Inference {
  surefill_adapter_model model{};     // where `fits`, complete; else what could be found, of kind UNKNOWN
  bool fits = false;                  // section 6 has a model that explains every probe
  judge::Inference judged;            // the whole of it
  std::vector<std::string> problems;  // one line each: what no model explains
};

// Draws some hundreds of small triangles, all in front of the eye. Throws RivalFailure, RivalSkips.
Inference infer_model(Rival& rival);

// The same model in section 11's words; and back, if section 6 has it.
judge::Model model_of(const surefill_adapter_model& model);
std::optional<surefill_adapter_model> adapter_model(const judge::Model& model,
                                                    const surefill_adapter_model& conventions);

// How a rival with this information is judged, its model being the one in there, or else `found`.
// `stated`: the model that it states (version 2).
judge::Terms terms_of(const surefill_adapter_info& info, const std::optional<judge::Model>& stated,
                      const judge::Inference& found);

// The model that it declares or states, in words.
std::string declared_model(const Rival& rival);

// "Grid of 8 bits, nearest_even, offset (0, 0), fill rule top_left, rows from the top, profile d3d11".
std::string describe_model(const surefill_adapter_model& model);

// What coverage depends on is the same.
bool same_coverage(const surefill_adapter_model& a, const surefill_adapter_model& b);

const char* profile_name(std::uint32_t profile);

}  // namespace surefill::adapters

#endif  // SUREFILL_CERTIFY_ADAPTERS_MODEL_HPP
