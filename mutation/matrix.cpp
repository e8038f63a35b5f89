// SPDX-License-Identifier: Apache-2.0
#include "mutation/matrix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include "certify/run/progress.hpp"

namespace surefill::mutation {
namespace {

using certify::interrupted;
using properties::Property;

std::vector<RightRasterizer> right_rasterizers() {
  std::vector<RightRasterizer> all;
  all.push_back({"exact", {properties::oracle_renderer()}, std::nullopt, FillRule::top_left, 1});
  all.push_back(
      {"exact, second oracle", {properties::clipped_oracle_renderer()}, std::nullopt, FillRule::top_left, 10});
  constexpr const char* kRoundings[] = {"nearest even", "nearest up", "truncate"};
  constexpr const char* kCorners[] = {"top left", "top right", "bottom left", "bottom right"};
  for (const int bits : {4, 8, 12})
    for (unsigned rounding = 0; rounding < 3; ++rounding)
      for (unsigned corner = 0; corner < 4; ++corner)
        all.push_back({fmt::format("Grid {}, {}, {}", bits, kRoundings[rounding], kCorners[corner]),
                       {properties::oracle_renderer(), properties::clipped_oracle_renderer()},
                       Grid{bits, 0, 0, static_cast<GridRounding>(rounding)},
                       static_cast<FillRule>(corner),
                       20});
  return all;
}

corpus::Scene under_model(corpus::Scene scene, const RightRasterizer& right) {
  if (!right.grid) return scene;
  for (corpus::SceneDraw& draw : scene.draws) {
    if (draw.conservative != Conservative::none) continue;  // M4: no Grid there
    draw.grid = right.grid;
    draw.fill_rule = right.corner;
  }
  return scene;
}

// One column: the cases in turn, each drawn by every specimen that is still alive.
class Column {
 public:
  Column(KillMatrix& matrix, std::size_t number, const ZooOptions& options)
      : matrix_(matrix), number_(number), property_(*matrix.properties[number]), options_(options) {}

  void run(std::mutex& mutex) {
    std::vector<std::size_t> alive(matrix_.specimens.size());
    for (std::size_t row = 0; row < alive.size(); ++row) alive[row] = row;
    const std::uint64_t cases = properties::affordable_cases(property_, options_.cases);
    const std::uint64_t deep = std::max(cases, properties::affordable_cases(property_, options_.deep));
    for (std::uint64_t n = 0; n < deep && !alive.empty() && !interrupted(); ++n) {
      if (n == cases) std::erase_if(alive, [&](std::size_t row) { return !names(row); });
      const corpus::Scene scene = properties::sampled_case(property_, n);
      std::erase_if(alive, [&](std::size_t row) {
        const bool killed = property_.decide(scene, matrix_.specimens[row]->render).differences != 0;
        if (killed) matrix_.first_kill[row][number_] = n;
        return killed;
      });
    }
    for (const RightRasterizer& right : matrix_.right) {
      if (right.grid && !property_.holds_under_grid) continue;
      const std::uint64_t some = std::max<std::uint64_t>(1, cases / right.share);
      for (std::uint64_t n = 0; n < some && !interrupted(); ++n) {
        const corpus::Scene scene = under_model(properties::sampled_case(property_, n), right);
        for (const properties::Renderer& renderer : right.renderers) {
          const properties::TrialResult verdict = property_.decide(scene, renderer);
          const std::lock_guard lock(mutex);
          ++matrix_.right_cases;
          if (verdict.differences != 0)
            matrix_.accusations.push_back(
                fmt::format("{} accuses {} in case {}: {}", property_.name, right.name, n, verdict.finding));
        }
      }
    }
  }

 private:
  bool names(std::size_t row) const { return std::string_view(matrix_.specimens[row]->named_by) == property_.name; }

  KillMatrix& matrix_;
  std::size_t number_;
  const Property& property_;
  const ZooOptions& options_;
};

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return result;
}

}  // namespace

std::size_t KillMatrix::column(const std::string& property) const {
  for (std::size_t c = 0; c < properties.size(); ++c)
    if (property == properties[c]->name) return c;
  return properties.size();
}

std::size_t KillMatrix::kills(std::size_t row) const {
  return static_cast<std::size_t>(
      std::count_if(first_kill[row].begin(), first_kill[row].end(), [](std::uint64_t n) { return n != kAlive; }));
}

std::size_t KillMatrix::killed_by(std::size_t column) const {
  return static_cast<std::size_t>(
      std::count_if(first_kill.begin(), first_kill.end(), [&](const auto& row) { return row[column] != kAlive; }));
}

std::vector<std::string> KillMatrix::failures() const {
  std::vector<std::string> lines;
  for (std::size_t row = 0; row < specimens.size(); ++row) {
    const std::size_t named = column(specimens[row]->named_by);
    if (named == properties.size())
      lines.push_back(fmt::format("{}: there is no property {}", specimens[row]->name, specimens[row]->named_by));
    else if (first_kill[row][named] == kAlive)
      lines.push_back(fmt::format("{} survives {}, which names its fault ({} others kill it)", specimens[row]->name,
                                  specimens[row]->named_by, kills(row)));
  }
  for (std::size_t c = 0; c < properties.size(); ++c)
    if (killed_by(c) == 0) lines.push_back(fmt::format("{} kills no specimen", properties[c]->name));
  lines.insert(lines.end(), accusations.begin(), accusations.end());
  return lines;
}

KillMatrix kill_matrix(const ZooOptions& options) {
  KillMatrix matrix;
  for (const zoo::Specimen& specimen : zoo::specimens()) matrix.specimens.push_back(&specimen);
  for (const Property& property : properties::all_properties()) matrix.properties.push_back(&property);
  matrix.first_kill.assign(matrix.specimens.size(), std::vector<std::uint64_t>(matrix.properties.size(), kAlive));
  matrix.right = right_rasterizers();
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::vector<std::thread> threads;
  for (int i = 0; i < options.jobs; ++i)
    threads.emplace_back([&] {
      for (std::size_t c = next++; c < matrix.properties.size(); c = next++) Column(matrix, c, options).run(mutex);
    });
  for (std::thread& thread : threads) thread.join();
  std::sort(matrix.accusations.begin(), matrix.accusations.end());
  matrix.interrupted = interrupted();
  return matrix;
}

std::string zoo_text(const KillMatrix& matrix) {
  std::string text =
      fmt::format("{:28} {:26} {:>7}  {}\n", "specimen", "named by", "at case", "properties that kill it");
  for (std::size_t row = 0; row < matrix.specimens.size(); ++row) {
    const zoo::Specimen& s = *matrix.specimens[row];
    const std::size_t named = matrix.column(s.named_by);
    const std::uint64_t at = named < matrix.properties.size() ? matrix.first_kill[row][named] : kAlive;
    text += fmt::format("{:28} {:26} {:>7}  {}\n", s.name, s.named_by, at == kAlive ? "never" : std::to_string(at),
                        matrix.kills(row));
  }
  text += fmt::format("\n{:28} {}\n", "property", "specimens that it kills");
  for (std::size_t c = 0; c < matrix.properties.size(); ++c)
    text += fmt::format("{:28} {}\n", matrix.properties[c]->name, matrix.killed_by(c));
  const std::vector<std::string> failures = matrix.failures();
  text += "\n";
  for (const std::string& line : failures) text += "FAILED  " + line + "\n";
  text += fmt::format("{} specimens, {} properties; {} right rasterizers in {} cases, {} false accusations: {}\n",
                      matrix.specimens.size(), matrix.properties.size(), matrix.right.size(), matrix.right_cases,
                      matrix.accusations.size(),
                      matrix.interrupted ? "interrupted"
                      : failures.empty() ? "every specimen is killed"
                                         : "FAILED");
  return text;
}

std::string zoo_markdown(const KillMatrix& matrix, const std::string& picture) {
  std::string text = fmt::format(
      "# The zoo\n\n"
      "A suite is worth what it rejects. Here are {} small wrong rasterizers (`mutation/zoo/`), each with one fault, "
      "from blatant to nearly invisible; many were seen in a real program. Each is held against each of the {} "
      "properties, and must be killed by the one that names its fault. {} right rasterizers (exact, and Grid of 4, 8 "
      "and "
      "12 bits with each rounding and each corner) are held against them, too, and are never accused.\n\n"
      "`./dev test` does it in brief, `surefill-zoo` in full; this page is what `surefill-zoo --markdown docs/zoo.md "
      "--picture docs/zoo.svg` wrote. Each is also a rasterizer behind the adapter (docs/adapters.md): `surefill-zoo "
      "--plugin libsurefill_zoo.so` certifies all of them as rivals.\n\n"
      "![Kill matrix: specimens by properties]({})\n\n"
      "A dark cell is a kill within the first cases, a lighter one took more; the ringed cell is the property that "
      "names "
      "the fault.\n\n"
      "| specimen | what it does | seen in | named by | at case | killed by |\n|---|---|---|---|---:|---:|\n",
      matrix.specimens.size(), matrix.properties.size(), matrix.right.size(), picture);
  for (std::size_t row = 0; row < matrix.specimens.size(); ++row) {
    const zoo::Specimen& s = *matrix.specimens[row];
    const std::size_t named = matrix.column(s.named_by);
    const std::uint64_t at = named < matrix.properties.size() ? matrix.first_kill[row][named] : kAlive;
    text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", s.name, s.fault, s.seen_in, s.named_by,
                        at == kAlive ? "never" : std::to_string(at), matrix.kills(row));
  }
  text += "\n| property | rule | claim | kills |\n|---|---|---|---:|\n";
  for (std::size_t c = 0; c < matrix.properties.size(); ++c) {
    const Property& p = *matrix.properties[c];
    text += fmt::format("| {} | {} | {} | {} |\n", p.name, p.rule, p.claim, matrix.killed_by(c));
  }
  return text;
}

std::string zoo_picture(const KillMatrix& matrix) {
  constexpr int kCell = 13, kLeft = 190, kTop = 180;
  const int width = kLeft + kCell * static_cast<int>(matrix.properties.size()) + 60;  // the last labels lean out
  const int height = kTop + kCell * static_cast<int>(matrix.specimens.size()) + 8;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" width=\"{}\" height=\"{}\" "
      "font-family=\"sans-serif\" font-size=\"10\" fill=\"#222\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
      width, height, width, height);
  for (std::size_t c = 0; c < matrix.properties.size(); ++c) {
    const int x = kLeft + kCell * static_cast<int>(c) + 10;
    svg += fmt::format("<text transform=\"translate({} {}) rotate(-70)\">{}</text>\n", x, kTop - 5,
                       escaped(matrix.properties[c]->name));
  }
  // One path a colour: the cells that it fills.
  constexpr const char* kColours[] = {"#f0f0ee", "#1b4965", "#5c93b0", "#b5d3e0"};
  std::string cells[4], ringed;
  for (std::size_t row = 0; row < matrix.specimens.size(); ++row) {
    const int y = kTop + kCell * static_cast<int>(row);
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n", kLeft - 6, y + 10,
                       escaped(matrix.specimens[row]->name));
    for (std::size_t c = 0; c < matrix.properties.size(); ++c) {
      const std::string cell = fmt::format("M{} {}h12v12h-12z", kLeft + kCell * static_cast<int>(c), y);
      const std::uint64_t n = matrix.first_kill[row][c];
      cells[n == kAlive ? 0 : n < 10 ? 1 : n < 100 ? 2 : 3] += cell;
      if (std::string_view(matrix.specimens[row]->named_by) == matrix.properties[c]->name) ringed += cell;
    }
  }
  for (std::size_t i = 0; i < 4; ++i) svg += fmt::format("<path fill=\"{}\" d=\"{}\"/>\n", kColours[i], cells[i]);
  svg += fmt::format("<path fill=\"none\" stroke=\"#d1495b\" stroke-width=\"2\" d=\"{}\"/>\n", ringed);
  return svg + "</svg>\n";
}

}  // namespace surefill::mutation
