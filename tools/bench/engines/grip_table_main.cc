// parallax_grip_table [--runs N] [--form FORM] [--margin M] [--step MS] [--engine ENGINE]
//                     [--contacts-per-pair N]
// Lifts and drives of generated grips, by form, margin, step and engine: how many loads slipped in
// the hand, and how many left it. Without an option everything is tried, 300 times each.

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/engine/engine_module.h"
#include "tools/bench/engines/grip_trials.h"

namespace parallax::tools {
namespace {

using harness::EngineKind;

struct Selection {
  std::uint64_t runs = 300;
  std::string form, engine;  // empty: all
  std::optional<double> margin, step_ms;
  harness::SolverSpec solver;
};

template <typename Number>
bool read(const char* text, Number& number) {
  const char* const end = text + std::strlen(text);
  const auto [stopped, error] = std::from_chars(text, end, number);
  return error == std::errc{} && stopped == end;
}

bool read_options(int count, char** arguments, Selection& chosen) {
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string_view name = arguments[i];
    const char* const value = arguments[i + 1];
    double number = 0.0;
    if (name == "--form") {
      chosen.form = value;
    } else if (name == "--engine") {
      chosen.engine = value;
    } else if (name == "--runs" && read(value, chosen.runs)) {
    } else if (name == "--contacts-per-pair" && read(value, chosen.solver.max_contacts_per_pair)) {
    } else if (name == "--margin" && read(value, number)) {
      chosen.margin = number;
    } else if (name == "--step" && read(value, number)) {
      chosen.step_ms = number;
    } else {
      return false;
    }
  }
  return count % 2 == 1;
}

void print_cell(const GripCell& cell, const Selection& chosen) {
  std::uint64_t slipped = 0, lost = 0;
  std::int64_t again = 0, unsolved = 0;
  double worst_m = 0.0;
  for (std::uint64_t seed = 1; seed <= chosen.runs; ++seed) {
    const GripTrial trial = try_grip(cell, seed, chosen.solver);
    lost += trial.lost ? 1 : 0;
    slipped += trial.lost || trial.slip_m > kGripSlip_m ? 1 : 0;
    again += trial.solved_again;
    unsolved += trial.unsolved;
    if (!trial.lost) worst_m = std::max(worst_m, trial.slip_m);
  }
  fmt::print("| {} | {:g} | {:g} ms | {} | {} of {} | {} | {:.1f} mm | {} | {} |\n",
             to_string(cell.form), cell.margin, 1e3 * cell.timestep_s, to_string(cell.engine),
             slipped, chosen.runs, lost, 1e3 * worst_m, again, unsolved);
  std::fflush(stdout);
}

void print_table(const Selection& chosen) {
  const std::vector<EngineKind> engines = harness::engines_here();
  fmt::print(
      "| load | margin | step | engine | slipped | lost | most slip of what was held | steps "
      "solved again | messages of unsolved steps |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const GripForm form : kGripForms) {
    if (!chosen.form.empty() && chosen.form != to_string(form)) continue;
    for (const double margin : {1.2, 2.0, 5.0}) {
      if (chosen.margin.value_or(margin) != margin) continue;
      for (const double step_ms : {4.0, 2.0, 1.0, 0.5}) {
        if (chosen.step_ms.value_or(step_ms) != step_ms) continue;
        for (const EngineKind engine : engines) {
          if (!chosen.engine.empty() && chosen.engine != to_string(engine)) continue;
          print_cell({form, margin, 1e-3 * step_ms, engine}, chosen);
        }
      }
    }
  }
}

}  // namespace
}  // namespace parallax::tools

int main(int count, char** arguments) {
  parallax::tools::Selection chosen;
  if (!parallax::tools::read_options(count, arguments, chosen)) {
    fmt::print(stderr,
               "usage: parallax_grip_table [--runs N] [--form FORM] [--margin M] [--step MS] "
               "[--engine ENGINE] [--contacts-per-pair N]\n");
    return 2;
  }
  parallax::tools::print_table(chosen);
  return 0;
}
