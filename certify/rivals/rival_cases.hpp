// SPDX-License-Identifier: Apache-2.0
//
// How one case of a rival is decided. A rival of the profile exact whose model section 6 has is *strict*: its images are
// the oracle's, bit for bit. Every other one is judged by section 11.
#ifndef SUREFILL_CERTIFY_RIVAL_CASES_HPP
#define SUREFILL_CERTIFY_RIVAL_CASES_HPP

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "certify/rivals/model.hpp"
#include "certify/rivals/rival.hpp"
#include "certify/run/checks.hpp"
#include "corpus/scene.hpp"
#include "properties/machinery/properties.hpp"

namespace surefill::certify {

// What the checks need to know of the rival. Its model is set: what it declares, else what was inferred.
struct RivalSubject {
  adapters::Rival* rival = nullptr;
  adapters::Inference inference;
  judge::Terms terms;
  bool strict = false;
  bool declared = false;                 // it says what its model is
  std::uint32_t reported_bits = 0;       // of subpixel precision, where it declares no model; 0: none
  std::vector<std::string> conventions;  // that it says, and that are found to be others: sentences
  bool slow = false;                     // a program over pipes: fewer cases
  std::string replay_option;             // how `surefill replay` is told of it
  // The features that judged cases needed, so far.
  std::shared_ptr<std::atomic<std::uint32_t>> challenged = std::make_shared<std::atomic<std::uint32_t>>(0);
};

// Probes, and sets the model.
RivalSubject meet_rival(adapters::Rival& rival);

// The features that are claimed and that no judged case needed, in words.
std::vector<std::string> not_challenged(const RivalSubject& subject);

CaseResult not_applicable();

// Runs one case of a scene. This is the one place where what a rival does wrong on the way (it crashes, hangs, answers
// nonsense) becomes a finding, and where what it declines becomes a case that does not apply.
CaseResult guarded_case(const corpus::Scene& scene, const std::function<CaseResult()>& run);

// Those of the scene's outputs that the rival has; a count in any case.
corpus::Outputs outputs_with(const adapters::Rival& rival, const corpus::Scene& scene);

// Draws the scene with both, and compares what is owed.
CaseResult judge_scene(const corpus::Scene& scene, const RivalSubject& subject, const judge::Looks& looks = {});

// Are some vertices behind the eye, or beyond the guard band? How such triangles are clipped is open in all
// profiles but exact.
bool is_clipped(const corpus::Scene& scene);

// A property on one case, as far as it is owed.
CaseResult property_case(const properties::Property& property, const corpus::Scene& scene, const RivalSubject& subject);

// Does it say of meshes that each sample is covered once?
bool is_tiling(const properties::Property& property);

// Is the property judged at all, of such a rival?
bool is_judged(const properties::Property& property, const RivalSubject& subject);

// The picture of a property's finding, if it has one of its own.
std::optional<properties::Exhibit> property_exhibit(const properties::Property& property, const corpus::Scene& scene,
                                                    const RivalSubject& subject);

// Draws a frame like this one with a triangle over the whole target, as near as depth goes, or as far: what is left of it in
// a buffer hides what comes, or does not. Throws as Rival::draw.
void draw_flat_frame(const corpus::Scene& scene, const RivalSubject& subject, bool near);

// The image of a draw and those of its triangles, each drawn alone.
CaseResult alone_case(const corpus::Scene& scene, const RivalSubject& subject);

// W / 2 for Z, so that no depth buffer and no clipping has a part: as properties that are judged by counts alone are drawn.
corpus::Scene with_flat_depth(corpus::Scene scene);

// May snapping, blur or cutting turn a triangle, or move its edges (R8, R9)?
bool may_turn(const corpus::Scene& scene, const RivalSubject& subject);

// T1 is owed on this mesh: the model is watertight, no triangle is turned by snapping or blur, and every edge is shared by
// two triangles or lies beside the target.
bool still_tiles(const corpus::Scene& scene, const RivalSubject& subject);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_RIVAL_CASES_HPP
