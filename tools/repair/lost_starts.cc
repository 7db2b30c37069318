// Initial states that a repair takes from a model, by enumeration up to a limit.
//
// One solver has the model before the repair and gives one initial state after the other that
// leads to the constraints at some timepoint; each is then excluded by a clause. A second solver
// has the repaired model and is asked about each of them under assumptions. A state of which it
// finds no trace is lost. Both search the lengths of traces from the shortest on, since a state
// that leads there soon needs no more. If there are more states than the limit the result says
// so and is a sample of them.
//
// Cost: for each state at most two calls for each timepoint of the horizon.

#include "tools/repair/lost_starts.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/session/solver_session.h"

namespace parallax::tools {
namespace {

using compiler::Literal;
using compiler::Timepoint;
using runtime::SolveStatus;

constexpr std::size_t kMostStarts = 200;

/// A model, asked which initial states it has that lead to its constraints.
class StartFinder {
 public:
  StartFinder(const compiler::CompiledModel& model, const std::atomic<bool>& stop)
      : session_(model, runtime::make_cadical_solver(&stop)), index_(model) {
    for (const auto& fluent : model.fluents) {
      if (fluent.slot)
        slots_.emplace(fluent.name, Literal::positive(model.variable(*fluent.slot, 0)));
    }
  }

  /// An initial state that leads there, within the horizon. None: there is none, or it was stopped.
  bool find(const std::vector<Literal>& start) {
    for (Timepoint n = 0; n <= session_.model().horizon; ++n) {
      const auto hit = index_.hit(n);
      if (!hit) continue;
      auto wanted = start;
      wanted.push_back(*hit);
      const auto status = session_.solve(n, wanted);
      stopped_ = stopped_ || status == SolveStatus::kUnknown;
      if (stopped_ || status == SolveStatus::kSatisfiable) return !stopped_;
    }
    return false;
  }

  std::map<std::string, bool> found() const {
    std::map<std::string, bool> out;
    for (const auto& [name, literal] : slots_) out.emplace(name, session_.value(literal));
    return out;
  }

  void block(const std::map<std::string, bool>& state) {
    std::vector<Literal> clause;
    for (const auto& literal : literals(state)) clause.push_back(~literal);
    session_.add_clause(clause);
  }

  std::vector<Literal> literals(const std::map<std::string, bool>& state) const {
    std::vector<Literal> out;
    for (const auto& [name, holds] : state) {
      const auto slot = slots_.find(name);
      if (slot != slots_.end()) out.push_back(holds ? slot->second : ~slot->second);
    }
    return out;
  }

  bool stopped() const { return stopped_; }

 private:
  runtime::SolverSession session_;
  compiler::AtomIndex index_;
  std::map<std::string, Literal> slots_;  // at timepoint 0, by fluent
  bool stopped_ = false;
};

}  // namespace

LostStarts lost_starts(const compiler::CompiledModel& before, const compiler::CompiledModel& after,
                       const std::atomic<bool>& stop) {
  StartFinder had(before, stop), has(after, stop);
  LostStarts out;
  while (had.find({})) {
    if (out.of == kMostStarts) {
      out.more = true;
      break;
    }
    const auto state = had.found();
    const bool still = has.find(has.literals(state));
    if (has.stopped()) break;
    ++out.of;
    if (!still && out.lost++ == 0) {
      for (const auto& [name, holds] : state) {
        if (holds) out.first += (out.first.empty() ? "" : ", ") + name;
      }
      out.first = out.first.empty() ? "nothing holds" : out.first + " hold";
    }
    if (state.empty()) break;
    had.block(state);
  }
  return out;
}

}  // namespace parallax::tools
