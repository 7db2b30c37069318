#include "tools/bench/row.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

namespace parallax::tools {
namespace {

std::string duration(double seconds) {
  if (seconds < 0.1) return fmt::format("{:.1f} ms", 1e3 * seconds);
  return fmt::format("{:.2f} s", seconds);
}

std::string line_of(const Side& side) {
  if (!side.cost) return fmt::format("{:<17}{}", side.program, side.remark);
  auto line =
      fmt::format("{:<17}{:>8} {:>8} {:>8.1f} MB", side.program, duration(side.cost->wall_s),
                  duration(side.cost->cpu_s), side.cost->peak_mb);
  if (!side.answer.empty()) line += fmt::format("   {}", side.answer);
  if (side.cost->output_mb >= 0.1) line += fmt::format("   wrote {:.1f} MB", side.cost->output_mb);
  return line;
}

nlohmann::ordered_json document(const Side& side) {
  nlohmann::ordered_json json = {{"program", side.program}, {"command", side.command}};
  if (side.cost) {
    json["wall_s"] = side.cost->wall_s;
    json["cpu_s"] = side.cost->cpu_s;
    json["peak_mb"] = side.cost->peak_mb;
    json["output_mb"] = side.cost->output_mb;
    json["runs"] = side.runs;
  }
  if (!side.answer.empty()) json["answer"] = side.answer;
  if (!side.remark.empty()) json["remark"] = side.remark;
  return json;
}

}  // namespace

std::optional<double> Row::ratio(std::size_t side) const {
  if (side == 0 || side >= sides.size()) return std::nullopt;
  if (!sides[0].cost || !sides[side].cost) return std::nullopt;
  return sides[side].cost->cpu_s / sides[0].cost->cpu_s;
}

bool Row::agrees() const {
  std::optional<std::string> known = expected;
  for (const auto& side : sides) {
    if (!side.cost || side.answer.empty()) continue;
    if (known && *known != side.answer) return false;
    known = side.answer;
  }
  return true;
}

std::string to_text(const Row& row) {
  std::string text;
  std::string label = row.name;
  for (std::size_t i = 0; i < row.sides.size(); ++i) {
    text += fmt::format("  {:<26}{}", label, line_of(row.sides[i]));
    if (const auto ratio = row.ratio(i)) text += fmt::format("   = {:.2f} x ours", *ratio);
    text += '\n';
    label.clear();
  }
  if (!row.note.empty()) {
    text += fmt::format("  {:<26}{}\n", label, row.note);
  }
  if (!row.agrees()) {
    text += fmt::format("  {:<26}ANSWERS DIFFER, expected {}\n", "", row.expected.value_or("?"));
  }
  return text;
}

std::string to_json(const std::vector<Row>& rows) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& row : rows) {
    nlohmann::ordered_json json = {{"section", row.section}, {"row", row.name}};
    json["sides"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < row.sides.size(); ++i) {
      json["sides"].push_back(document(row.sides[i]));
      if (const auto ratio = row.ratio(i)) json["sides"].back()["ratio"] = *ratio;
    }
    if (row.expected) json["expected"] = *row.expected;
    if (!row.note.empty()) json["note"] = row.note;
    json["agrees"] = row.agrees();
    list.push_back(std::move(json));
  }
  return nlohmann::ordered_json{{"rows", std::move(list)}}.dump(2) + '\n';
}

}  // namespace parallax::tools
