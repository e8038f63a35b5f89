// SPDX-License-Identifier: Apache-2.0
//
// The kill matrix: every specimen of the zoo, and right rasterizers, held against every property.
#ifndef SUREFILL_MUTATION_MATRIX_HPP
#define SUREFILL_MUTATION_MATRIX_HPP

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mutation/zoo/zoo.hpp"
#include "properties/machinery/properties.hpp"

namespace surefill::mutation {

struct ZooOptions {
  std::uint64_t cases = 100;   // of each property, a specimen that nothing names
  std::uint64_t deep = 20000;  // of the property that names the fault, at most
  int jobs = 1;
};

// A renderer that is right; all draws of a case are put on the grid first, where there is one.
struct RightRasterizer {
  std::string name;
  std::vector<properties::Renderer> renderers;  // each of them
  std::optional<Grid> grid;
  FillRule corner = FillRule::top_left;
  std::uint64_t share = 1;  // this part of the cases
};

constexpr std::uint64_t kAlive = std::numeric_limits<std::uint64_t>::max();

struct KillMatrix {
  std::vector<const zoo::Specimen*> specimens;          // rows
  std::vector<const properties::Property*> properties;  // columns
  std::vector<std::vector<std::uint64_t>> first_kill;   // by row, column: number of the case, or kAlive
  std::vector<RightRasterizer> right;
  std::vector<std::string> accusations;  // of right rasterizers: there must be none
  std::uint64_t right_cases = 0;         // that they were held against
  bool interrupted = false;

  std::size_t column(const std::string& property) const;
  std::size_t kills(std::size_t row) const;
  std::size_t killed_by(std::size_t column) const;
  std::vector<std::string> failures() const;  // survivors, properties that kill none, accusations: one line each
};

KillMatrix kill_matrix(const ZooOptions& options);

// For people, for docs/zoo.md and its picture (SVG).
std::string zoo_text(const KillMatrix& matrix);
std::string zoo_markdown(const KillMatrix& matrix, const std::string& picture);
std::string zoo_picture(const KillMatrix& matrix);

}  // namespace surefill::mutation

#endif  // SUREFILL_MUTATION_MATRIX_HPP
