#include "tests/runtime/monitor/trace_log.h"

#include <algorithm>

#include "runtime/solver/sat_solver.h"

namespace parallax::test {
namespace {

using compiler::AtomKind;
using compiler::CompiledModel;
using compiler::EventId;
using compiler::FluentId;
using compiler::Literal;
using compiler::Timepoint;

std::optional<Literal> happens_at(const CompiledModel& model, std::size_t event, Timepoint t) {
  const auto slot = model.events[event].slot;
  if (!slot) return std::nullopt;
  return Literal::positive(model.variable(*slot, t));
}

/// Outcome of the plan's perform at t: 1 success, -1 failure, 0 no perform.
int performed_at(const CompiledModel& model, const runtime::SatSolver& solver, Timepoint t) {
  bool performs = false, succeeds = false;
  for (std::size_t v = 0; v < model.fixed.size(); ++v) {
    const auto& atom = model.fixed[v];
    const auto literal = Literal::positive(static_cast<std::int32_t>(v) + 1);
    if (atom.kind == AtomKind::kLocation && atom.time == t &&
        std::holds_alternative<compiler::PlanStepId>(atom.plan)) {
      performs = performs || solver.value(literal);
    }
    if (atom.kind == AtomKind::kSucceeded && atom.time == t + 1) {
      succeeds = succeeds || solver.value(literal);
    }
  }
  return performs ? (succeeds ? 1 : -1) : 0;
}

bool is_subset(const std::vector<bool>& some, const std::vector<bool>& all) {
  for (std::size_t i = 0; i < some.size(); ++i) {
    if (some[i] && !all[i]) return false;
  }
  return true;
}

/// Does the log's step stand for the events of the trace at p?
bool is_told(const PlainTrace& trace, std::size_t p, const runtime::ToldStep& told,
             const std::vector<bool>& unobserved) {
  for (std::size_t e = 0; e < unobserved.size(); ++e) {
    const bool named = std::find(told.events.begin(), told.events.end(),
                                 EventId(static_cast<std::uint32_t>(e))) != told.events.end();
    if (named && !trace.happens[p][e]) return false;
    if (!named && trace.happens[p][e] && !unobserved[e]) return false;
  }
  return !told.succeeded || trace.performed[p] == 0 || (trace.performed[p] > 0) == *told.succeeded;
}

bool is_untold(const PlainTrace& trace, std::size_t p, const std::vector<bool>& unobserved) {
  const auto& happens = trace.happens[p];
  return std::find(happens.begin(), happens.end(), true) != happens.end() &&
         is_subset(happens, unobserved);
}

bool agrees(const PlainTrace& trace, std::size_t p, const runtime::Observation& observed) {
  for (std::size_t f = 0; f < observed.size(); ++f) {
    if (observed[f] != 0 && trace.holds[p][f] != (observed[f] > 0)) return false;
  }
  return true;
}

bool has_one_of_each(const PlainTrace& trace, std::size_t p,
                     const std::vector<runtime::OneOfFluents>& one_of) {
  return std::all_of(one_of.begin(), one_of.end(), [&](const auto& fluents) {
    return std::any_of(fluents.begin(), fluents.end(),
                       [&](FluentId fluent) { return trace.holds[p][fluent.index()]; });
  });
}

/// The lines that the trace goes with and ends after, as flags by number of lines.
void note_lines(const PlainTrace& trace, const Log& log, const std::vector<bool>& unobserved,
                std::vector<bool>& reached) {
  const auto n = trace.happens.size();
  std::vector<bool> at(n + 1, false);
  at[0] = true;
  const auto close = [&] {
    for (std::size_t p = 0; p < n; ++p) {
      if (at[p] && is_untold(trace, p, unobserved)) at[p + 1] = true;
    }
  };
  close();
  for (std::size_t i = 0; i < log.size(); ++i) {
    std::vector<bool> next(n + 1, false);
    for (std::size_t p = 0; p <= n; ++p) {
      if (!at[p]) continue;
      if (log[i].observed) {
        next[p] = agrees(trace, p, *log[i].observed) && has_one_of_each(trace, p, log[i].one_of);
      } else if (p < n && is_told(trace, p, log[i].told, unobserved)) {
        next[p + 1] = true;
      }
    }
    at = std::move(next);
    close();
    if (at[n]) reached[i + 1] = true;
  }
}

runtime::Observation partly(const std::vector<bool>& holds, FuzzRandom& random) {
  runtime::Observation out(holds.size(), 0);
  const std::size_t share = random.below(101);
  for (std::size_t f = 0; f < holds.size(); ++f) {
    if (random.chance(share)) out[f] = holds[f] ? 1 : -1;
  }
  return out;
}

}  // namespace

std::optional<std::vector<PlainTrace>> plain_traces(const CompiledModel& model, Timepoint n,
                                                    std::size_t limit) {
  const auto solver = runtime::make_cadical_solver();
  for (std::size_t c = 0; c < model.clauses.size(); ++c) {
    if (model.clause_timepoints[c] <= n) solver->add_clause(model.clauses[c]);
  }
  std::vector<PlainTrace> out;
  std::vector<Literal> blocking;
  while (solver->solve() == runtime::SolveStatus::kSatisfiable) {
    if (out.size() == limit) return std::nullopt;
    auto& trace = out.emplace_back();
    blocking.clear();
    const auto read = [&](std::optional<Literal> literal) {
      const bool value = literal && solver->value(*literal);
      if (literal) blocking.push_back(value ? ~*literal : *literal);
      return value;
    };
    for (Timepoint t = 0; t <= n; ++t) {
      auto& holds = trace.holds.emplace_back();
      for (std::uint32_t f = 0; f < model.fluents.size(); ++f) {
        holds.push_back(read(model.holds_at(FluentId(f), t)));
      }
      if (t == n) break;
      auto& happens = trace.happens.emplace_back();
      for (std::size_t e = 0; e < model.events.size(); ++e) {
        happens.push_back(read(happens_at(model, e, t)));
      }
      trace.performed.push_back(performed_at(model, *solver, t));
    }
    for (std::size_t v = 0; v < model.fixed.size(); ++v) {
      const auto& atom = model.fixed[v];
      const bool of_plan = atom.kind == AtomKind::kLocation || atom.kind == AtomKind::kSucceeded;
      if (of_plan && atom.time <= n) read(Literal::positive(static_cast<std::int32_t>(v) + 1));
    }
    if (blocking.empty()) break;
    solver->add_clause(blocking);
  }
  return out;
}

Log random_log(const CompiledModel& model, const std::vector<PlainTrace>& traces,
               const std::vector<bool>& unobserved, FuzzRandom& random) {
  Log log;
  const bool of_nothing = traces.empty() || random.chance(15);
  PlainTrace trace;
  if (of_nothing) {
    for (std::size_t t = 0; t < 3; ++t) {
      auto& holds = trace.holds.emplace_back();
      for (std::size_t f = 0; f < model.fluents.size(); ++f) holds.push_back(random.chance(40));
      if (t == 2) break;
      auto& happens = trace.happens.emplace_back();
      for (std::size_t e = 0; e < model.events.size(); ++e) happens.push_back(random.chance(30));
      trace.performed.push_back(0);
    }
  } else {
    trace = random.pick(traces);
  }
  for (std::size_t t = 0; t < trace.holds.size(); ++t) {
    for (auto seen = random.below(3); seen > 0; --seen) {
      log.push_back({partly(trace.holds[t], random), {}});
      // Two or three fluents of which it was not seen which one holds; sometimes none does.
      if (model.fluents.size() < 2 || !random.chance(30)) continue;
      auto& set = log.back().one_of.emplace_back();
      for (std::size_t n = 2 + random.below(2); n > 0; --n) {
        set.emplace_back(static_cast<std::uint32_t>(random.below(model.fluents.size())));
      }
    }
    if (t == trace.happens.size()) break;
    if (is_untold(trace, t, unobserved) && random.chance(60)) continue;
    LogItem item;
    for (std::uint32_t e = 0; e < model.events.size(); ++e) {
      if (!trace.happens[t][e] || (unobserved[e] && random.chance(50))) continue;
      item.told.events.emplace_back(e);
    }
    if (trace.performed[t] != 0 && random.chance(50)) {
      item.told.succeeded = trace.performed[t] > 0;
    }
    log.push_back(std::move(item));
  }
  if (log.empty() || random.chance(50)) return log;
  // Made wrong, perhaps: an event too many or too few, a fluent turned round, a wrong outcome.
  auto& item = log[random.below(log.size())];
  if (item.observed && !item.observed->empty()) {
    auto& value = (*item.observed)[random.below(item.observed->size())];
    value = static_cast<std::int8_t>(value == 0 ? 1 : -value);
  } else if (!item.observed && item.told.succeeded && random.chance(50)) {
    item.told.succeeded = !*item.told.succeeded;
  } else if (!item.observed && !model.events.empty()) {
    const EventId event(static_cast<std::uint32_t>(random.below(model.events.size())));
    auto& events = item.told.events;
    const auto found = std::find(events.begin(), events.end(), event);
    if (found != events.end()) {
      events.erase(found);
    } else {
      events.push_back(event);
      std::sort(events.begin(), events.end());
    }
  }
  return log;
}

std::size_t admitted_lines(const std::vector<std::vector<PlainTrace>>& lengths, const Log& log,
                           const std::vector<bool>& unobserved) {
  std::vector<bool> reached(log.size() + 1, false);
  for (const auto& traces : lengths) {
    for (const auto& trace : traces) note_lines(trace, log, unobserved, reached);
  }
  std::size_t lines = 0;
  while (lines < log.size() && reached[lines + 1]) ++lines;
  return lines;
}

}  // namespace parallax::test
