#pragma once

// A world whose trace has several initial states: a box in one of the cells s1, s2, ... of a line,
// a push that brings it to the goal, and a robot that stays in its cell.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "harness/campaign/campaign.h"
#include "tests/harness/campaign/named_trace.h"

namespace parallax::harness::test {

/// How often pushes go wrong, by the cell of the box.
struct CellRates {
  std::vector<double> fails, loses;  // probabilities whose sum is at most 1
  std::size_t cells() const { return fails.size(); }
  double mean() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < cells(); ++i) sum += fails[i] + loses[i];
    return sum / static_cast<double>(cells());
  }
};

/// Goes wrong by the place in the cell, so that the probability is exact.
class CellSimulator final : public Simulator {
 public:
  explicit CellSimulator(CellRates rates) : rates_(std::move(rates)) {}
  static SimulatorInfo description() {
    return {"cells",  "1", "bitwise", true, {{"box.x", "m", true}, {"robot.x", "m", true}},
            {"push"}, 0.01};
  }
  SimulatorInfo info() override { return description(); }
  Outcome reset(const State& initial, std::uint64_t) override {
    box_m_ = std::get<double>(initial.at("box.x"));
    robot_m_ = std::get<double>(initial.at("robot.x"));
    return {};
  }
  Outcome act(std::string_view, const State&, double) override {
    const double cell = std::floor(box_m_), u = box_m_ - cell;
    const auto i = static_cast<std::size_t>(cell);
    if (u < rates_.fails[i]) return {SimStatus::kFailed, "stuck", 0.1, {}};
    if (u >= 1.0 - rates_.loses[i]) return {SimStatus::kLost, "numbers blew up", 0.0, {}};
    box_m_ = -0.5;
    return {SimStatus::kOk, "", 0.1, {}};
  }
  State observe() override { return {{"box.x", box_m_}, {"robot.x", robot_m_}}; }

 private:
  CellRates rates_;
  double box_m_ = 0.0, robot_m_ = 0.0;
};

inline std::string cell_scenario(std::size_t cells) {
  std::string regions = "goal: {x: [-1, 0]}";
  for (std::size_t i = 0; i < cells; ++i) {
    regions += ", s" + std::to_string(i + 1) + ": {x: [" + std::to_string(i) + ", " +
               std::to_string(i + 1) + "]}";
  }
  return "model: domain.e\nhorizon: 1\nsimulator: {command: [cells]}\nregions: {cells: {" +
         regions +
         "}}\n"
         "mapping:\n"
         "  BoxIn(region): {inside: region, body: box}\n"
         "  RobotIn(region): {inside: region, body: robot}\n"
         "actions:\n  Push(): {controller: push}\n"
         "limits: {max_lost_in_a_row: 1000}\n";
}

/// The trace of the push, and its initial states as pairs of cells of box and robot, from 1.
class CellFeed : public TraceFeed {
 public:
  using Cells = std::pair<std::size_t, std::size_t>;

  CellFeed(std::size_t cells, std::vector<Cells> states)
      : states_(std::move(states)), symbols_(table(cells)) {}
  /// A robot in the first cell, and the box in any of them.
  static std::vector<Cells> boxes(std::size_t cells) {
    std::vector<Cells> out;
    for (std::size_t i = 1; i <= cells; ++i) out.emplace_back(i, 1);
    return out;
  }

  base::Result<std::optional<CampaignTrace>> next() override {
    if (std::exchange(given_, true)) return std::optional<CampaignTrace>();
    return std::optional(trace(states_.front()));
  }
  std::string exploration() const override { return "all traces explored"; }
  runtime::Symbols symbols() const override { return symbols_; }
  base::Result<std::optional<TraceStarts>> starts(const CampaignTrace&,
                                                  std::span<const compiler::FluentId>) override {
    TraceStarts out;
    for (const auto& cells : states_) out.states.push_back(state(cells));
    out.weights = weights;
    out.more = more;
    out.parts = parts;
    return std::optional(std::move(out));
  }
  base::Result<std::pair<base::Known, std::optional<CampaignTrace>>> from(
      const CampaignTrace&, std::span<const compiler::FluentId>,
      const std::vector<compiler::FluentId>& wanted) override {
    ++asked;
    for (const auto& cells : states_) {
      if (state(cells) == wanted) {
        return std::pair(base::Known::kYes, std::optional(trace(cells)));
      }
    }
    return std::pair(base::Known::kNo, std::optional<CampaignTrace>());
  }

  /// Lists none: candidates have box and robot in any of the cells.
  void draw_from_all(std::size_t cells) {
    more = true;
    parts.assign(2, {});
    for (std::size_t cell = 1; cell <= cells; ++cell) {
      parts[0].push_back({box(cell)});
      parts[1].push_back({robot(cell)});
    }
  }

  CampaignTrace trace(const Cells& cells) const {
    const auto robot = "RobotIn(s" + std::to_string(cells.second) + ")";
    auto out = named_trace(
        1, "push", {{"BoxIn(s" + std::to_string(cells.first) + ")", robot}, {"BoxIn(goal)", robot}},
        {{"Push()"}}, symbols_);
    out.other_initial_states = states_.size() > 1 ? base::Known::kYes : base::Known::kNo;
    return out;
  }
  compiler::FluentId box(std::size_t cell) const {
    return *symbols_->fluent("BoxIn(s" + std::to_string(cell) + ")");
  }
  compiler::FluentId robot(std::size_t cell) const {
    return *symbols_->fluent("RobotIn(s" + std::to_string(cell) + ")");
  }

  std::vector<double> weights;
  bool more = false;
  std::vector<std::vector<std::vector<compiler::FluentId>>> parts;
  std::int64_t asked = 0;  // questions of `from`

 private:
  static Table table(std::size_t cells) {
    std::vector<std::string> fluents = {"BoxIn(goal)", "RobotIn(goal)"};
    for (std::size_t i = 1; i <= cells; ++i) {
      fluents.push_back("BoxIn(s" + std::to_string(i) + ")");
      fluents.push_back("RobotIn(s" + std::to_string(i) + ")");
    }
    return table_of(fluents);
  }
  std::vector<compiler::FluentId> state(const Cells& cells) const {
    std::vector<compiler::FluentId> out = {box(cells.first), robot(cells.second)};
    std::sort(out.begin(), out.end());
    return out;
  }

  std::vector<Cells> states_;
  Table symbols_;
  bool given_ = false;
};

}  // namespace parallax::harness::test
