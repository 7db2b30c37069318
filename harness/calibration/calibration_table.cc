#include <fmt/format.h>

#include <algorithm>

#include "harness/calibration/calibration.h"
#include "harness/confidence/rounding.h"

namespace parallax::harness {
namespace {

/// "1.02 %", in bold where it is more than is allowed.
std::string cell_text(const CalibrationCell& cell) {
  const auto share = fmt::format("{:.2f} %", 100.0 * cell.share());
  return fmt::format("{} ({:.0f})", cell.is_within() ? share : "**" + share + "**", cell.mean_runs);
}

std::string table_of(const std::vector<CalibrationCell>& cells) {
  std::vector<std::string> criteria, worlds;
  for (const auto& cell : cells) {
    const auto add = [](std::vector<std::string>& names, const std::string& name) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    };
    add(criteria, cell.criterion);
    add(worlds, cell.world);
  }
  std::string head = "| simulator | may be |", rule = "|---|---|", out;
  for (const auto& name : criteria) {
    head += fmt::format(" `{}` |", name);
    rule += "---|";
  }
  for (const auto& world : worlds) {
    std::string allowed, row;
    for (const auto& criterion : criteria) {
      const auto cell = std::find_if(cells.begin(), cells.end(), [&](const CalibrationCell& one) {
        return one.world == world && one.criterion == criterion;
      });
      if (cell == cells.end()) {
        row += " |";
        continue;
      }
      if (cell->allowed) {
        const auto may = percent_up(*cell->allowed);
        if (allowed.find(may) == std::string::npos) allowed += (allowed.empty() ? "" : ", ") + may;
      }
      row += " " + cell_text(*cell) + " |";
    }
    out += fmt::format("| {} | {} |{}\n", world, allowed, row);
  }
  return head + "\n" + rule + "\n" + out;
}

std::string json_cells(const std::vector<CalibrationCell>& cells) {
  std::string out;
  for (const auto& cell : cells) {
    out += fmt::format(
        R"({}{{"simulator":"{}","criterion":"{}","loops":{},"false_claims":{},"share":{},)"
        R"("mean_runs":{},"allowed":{},"within":{}}})",
        out.empty() ? "" : ",", cell.world, cell.criterion, cell.loops, cell.false_claims,
        cell.share(), cell.mean_runs, cell.allowed ? fmt::format("{}", *cell.allowed) : "null",
        cell.is_within());
  }
  return "[" + out + "]";
}

}  // namespace

std::string calibration_markdown(const CalibrationResult& result) {
  const auto& options = result.options;
  auto out = fmt::format(
      "Share of loops in which `p < {}` was claimed with {} confidence, and falsely, as p is {} "
      "(mean runs of a loop).\n",
      percent_up(options.epsilon), level_text(options.confidence_level),
      percent_up(options.epsilon));
  if (!result.in_process.empty()) {
    out += fmt::format("\n{} loops a cell, in process:\n\n{}", options.loops,
                       table_of(result.in_process));
  }
  if (!result.protocol.empty()) {
    out += fmt::format("\n{} campaigns a cell, simulators behind the protocol:\n\n{}",
                       options.protocol_loops, table_of(result.protocol));
  }
  return out;
}

std::string calibration_json(const CalibrationResult& result) {
  const auto& options = result.options;
  return fmt::format(
      R"({{"status":"ok","confidence":{},"epsilon":{},"seed":{},"complete":{},"within":{},)"
      R"("in_process":{},"protocol":{}}})"
      "\n",
      options.confidence_level, options.epsilon, options.seed, result.complete, result.is_within(),
      json_cells(result.in_process), json_cells(result.protocol));
}

}  // namespace parallax::harness
