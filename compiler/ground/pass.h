#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/source_file.h"

namespace parallax::compiler {

/// One step of a stage. The order of the steps is a table of them, which the stage runs and anybody
/// can print.
struct PassInfo {
  std::string_view name;         // "effects"
  std::string_view description;  // one line
};

/// How large the value is after a pass. Before there are clauses their number is 0.
struct PassSize {
  std::size_t atoms = 0, nodes = 0;  // of the formula store
  std::size_t constraints = 0;       // formulas that hold
  std::size_t clauses = 0;           // before those of every timepoint are repeated
};

struct PassRun {
  PassInfo pass;
  bool applied = true;  // false: the options, or the model, leave nothing to do
  double seconds = 0;   // wall clock
  PassSize size;
};

/// Log of the passes of a compilation, in the order in which they ran.
struct PassLog {
  std::string wanted;                        // the pass after which the value is kept as text
  const base::SourceFiles* files = nullptr;  // for the places in that text; null: without places
  std::vector<PassRun> runs = {};
  std::optional<std::string> text = {};
};

/// A pass over a stage's state: member functions of its class.
template <typename State>
struct Pass {
  PassInfo info;
  void (State::*run)();
  std::string (State::*text)(const base::SourceFiles*) const;  // the value afterwards
  bool (State::*applies)() const = nullptr;                    // null: always
};

/// Runs the table in order. `State` has `PassSize size() const`.
template <typename State>
void run_passes(std::span<const Pass<State>> passes, State& state, PassLog* log) {
  for (const auto& pass : passes) {
    const bool applies = pass.applies == nullptr || (state.*pass.applies)();
    const auto begin = std::chrono::steady_clock::now();
    if (applies) (state.*pass.run)();
    if (log == nullptr) continue;
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    log->runs.push_back({pass.info, applies, spent.count(), state.size()});
    if (log->wanted == pass.info.name) log->text = (state.*pass.text)(log->files);
  }
}

template <typename State>
std::vector<PassInfo> infos_of(std::span<const Pass<State>> passes) {
  std::vector<PassInfo> infos;
  for (const auto& pass : passes) infos.push_back(pass.info);
  return infos;
}

}  // namespace parallax::compiler
