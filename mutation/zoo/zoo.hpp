// SPDX-License-Identifier: Apache-2.0
//
// The zoo: small wrong rasterizers, each with one fault, most of them seen in a real program. A suite is worth what it
// rejects; `surefill zoo` holds every specimen against every property.
#ifndef SUREFILL_PROPERTIES_ZOO_ZOO_HPP
#define SUREFILL_PROPERTIES_ZOO_ZOO_HPP

#include <span>

#include "surefill/surefill.hpp"

namespace surefill::zoo {

using Draws = std::span<const Draw>;

struct Specimen {
  const char* name;                                     // of the fault
  const char* fault;                                    // one line: what it does
  const char* seen_in;                                  // where: "project#issue", ...; empty where the fault is ours
  const char* named_by;                                 // the property that names the fault, and must reject it
  Status (*render)(const Target& target, Draws draws);  // as surefill::render; safe to call from several threads
};

// All of them, by theme: coverage, arithmetic, values, frames, modes, outputs, lines.
std::span<const Specimen> specimens();

// Those whose fault shows in what version 1 of the adapter has: all but output_specimens() and line_specimens().
std::span<const Specimen> rival_specimens();

// Further ways to be wrong that naming knows and the matrix does not: without names, origins and properties.
std::span<const Specimen> likenesses();

// One list a theme; specimens() joins them.
std::span<const Specimen> coverage_specimens();
std::span<const Specimen> arithmetic_specimens();
std::span<const Specimen> value_specimens();
std::span<const Specimen> frame_specimens();
std::span<const Specimen> mode_specimens();
std::span<const Specimen> output_specimens();
std::span<const Specimen> line_specimens();

}  // namespace surefill::zoo

#endif  // SUREFILL_PROPERTIES_ZOO_ZOO_HPP
