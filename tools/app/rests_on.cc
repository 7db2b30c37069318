#include "tools/app/rests_on.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "runtime/enumerate/plan_enumerator.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {
namespace {

using compiler::Literal;
using compiler::Timepoint;
using harness::LedgerEntry;
using harness::LedgerStatus;

/// "Detect(cup)" of "Detect(cup) = cup1", "Go(r2)" of "Go(r2) fails (blocked)".
std::string_view event_of(std::string_view step) {
  const auto end = step.find(' ');
  return step.substr(0, end);
}

bool is_asked(const LedgerEntry& entry, std::string_view scenario) {
  return entry.scenario == scenario && entry.status != LedgerStatus::kRepaired;
}

class Executions {
 public:
  Executions(const compiler::CompiledModel& model, Context& context)
      : model_(model),
        index_(model),
        session_(model, runtime::make_cadical_solver(&context.stop())) {}

  base::Known go_through(const LedgerEntry& entry) {
    if (entry.event == "start") return some(0, {});
    if (entry.trace) {
      std::vector<Literal> happens;
      for (const auto& step : *entry.trace) {
        if (!add(event_of(step), static_cast<Timepoint>(happens.size()), happens)) {
          return base::Known::kNo;
        }
      }
      const auto last = static_cast<Timepoint>(happens.size());
      if (!add(entry.event, last, happens)) return base::Known::kNo;
      return some(last + 1, happens);
    }
    for (Timepoint t = 0; t < model_.horizon; ++t) {
      std::vector<Literal> happens;
      if (!add(entry.event, t, happens)) continue;
      const auto answer = some(t + 1, happens);
      if (answer != base::Known::kNo) return answer;
    }
    return base::Known::kNo;
  }

 private:
  /// False: it never happens there.
  bool add(std::string_view event, Timepoint t, std::vector<Literal>& happens) const {
    if (t >= model_.horizon) return false;
    const auto literal = index_.find(compiler::AtomKind::kHappens, event, t);
    if (literal) happens.push_back(*literal);
    return literal.has_value();
  }

  base::Known some(Timepoint steps, const std::vector<Literal>& happens) {
    switch (session_.solve_whole(steps, happens)) {
      case runtime::SolveStatus::kSatisfiable:
        return base::Known::kYes;
      case runtime::SolveStatus::kUnsatisfiable:
        return base::Known::kNo;
      case runtime::SolveStatus::kUnknown:
        break;
    }
    return base::Known::kUndecided;
  }

  const compiler::CompiledModel& model_;
  compiler::AtomIndex index_;
  runtime::SolverSession session_;
};

bool happens_at(const runtime::Trace& trace, std::size_t t, std::string_view event) {
  const auto events = trace.happens(t);
  return std::find(events.begin(), events.end(), event) != events.end();
}

bool goes_through(const runtime::Trace& trace, const LedgerEntry& entry) {
  if (entry.event == "start") return true;
  const auto steps = trace.points.empty() ? 0 : trace.points.size() - 1;
  for (std::size_t t = entry.trace ? entry.trace->size() : 0; t < steps; ++t) {
    bool is_there = happens_at(trace, t, entry.event);
    for (std::size_t i = 0; is_there && entry.trace && i < t; ++i) {
      is_there = happens_at(trace, i, event_of((*entry.trace)[i]));
    }
    if (is_there) return true;
    if (entry.trace) break;
  }
  return false;
}

}  // namespace

std::vector<RestsOn> rests_on(const compiler::CompiledModel& model, const harness::Ledger& ledger,
                              std::string_view scenario, Context& context) {
  std::vector<RestsOn> out;
  std::optional<Executions> executions;
  for (const auto& entry : ledger.entries) {
    if (!is_asked(entry, scenario)) continue;
    if (!executions) executions.emplace(model, context);
    const auto answer = executions->go_through(entry);
    if (answer != base::Known::kNo) out.push_back({&entry, answer});
  }
  return out;
}

std::vector<RestsOn> rests_on(const runtime::Trace& trace, const harness::Ledger& ledger,
                              std::string_view scenario) {
  std::vector<RestsOn> out;
  for (const auto& entry : ledger.entries) {
    if (is_asked(entry, scenario) && goes_through(trace, entry)) {
      out.push_back({&entry, base::Known::kYes});
    }
  }
  return out;
}

std::string rests_on_words(const RestsOn& one) {
  const auto& entry = *one.entry;
  auto out = fmt::format("{} ({}): ", entry.id, harness::status_text(entry));
  out += entry.says.empty() ? entry.event : entry.says;
  if (entry.trace && !entry.trace->empty()) {
    out += fmt::format("; the events before it are {}", fmt::join(*entry.trace, ", "));
  }
  if (one.goes_through == base::Known::kUndecided) out += "; whether any gets there is not known";
  return out;
}

base::Result<PropertyAnswer> ask_property(const std::string& scenario_file,
                                          const std::string& property,
                                          const harness::Ledger& ledger, std::string_view scenario,
                                          Context& context) {
  ModelOptions options;
  options.models = {scenario_file};
  options.property = property;
  const auto compilation = compile_models(options, context);
  if (!compilation) return context.sink().already_reported();
  const auto& model = compilation->model;
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()));
  runtime::PlanEnumerator enumerator(session, {.order = runtime::TraceOrder::kAny});
  const auto violation = enumerator.next();
  PropertyAnswer out;
  out.horizon = model.horizon;
  if (violation) {
    out.verdict = PropertyAnswer::Verdict::kViolated;
    out.horizon = static_cast<Timepoint>(violation->length());
    out.rests_on = rests_on(*violation, ledger, scenario);
  } else if (enumerator.exploration() != runtime::Exploration::kStopped) {
    out.verdict = PropertyAnswer::Verdict::kHolds;
    out.rests_on = rests_on(model, ledger, scenario, context);
  }
  return out;
}

}  // namespace parallax::tools
