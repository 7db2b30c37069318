#include "tools/app/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "compiler/base/codes/campaigns.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/graph/model_traces.h"
#include "runtime/graph/trace_count.h"

namespace parallax::tools {

using compiler::AtomKind;
using compiler::Literal;
using compiler::Timepoint;

namespace {

/// Budget in conflicts for finding needed instances, for all sets together: a fraction of the time
/// limit.
runtime::Effort effort_of(double time_limit_s) {
  constexpr double kMost = 100'000, kEachSecond = 5'000;  // conflicts
  const auto most = time_limit_s > 0 ? std::min(kMost, kEachSecond * time_limit_s) : kMost;
  return runtime::Effort(static_cast<std::int64_t>(most));
}

/// A trace with a valuation of every variable.
struct ValuedTrace {
  compiler::Timepoint length = 0;
  std::vector<bool> values;
};

/// A trace by its number; else how many there are, in digits.
struct Found {
  std::optional<runtime::Trace> trace;
  std::string count;
};

Found find_planned(const compiler::CompiledModel& model, std::int64_t number,
                   const Context& context) {
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()));
  runtime::PlanEnumerator enumerator(session);
  Found found;
  std::int64_t count = 0;
  for (; count < number; ++count) {
    found.trace = enumerator.next();
    if (!found.trace) break;
  }
  found.count = std::to_string(count);
  return found;
}

Found find_trace(const compiler::CompiledModel& model, std::int64_t number,
                 const Context& context) {
  if (model.has_constraints) return find_planned(model, number, context);
  runtime::TraceQuery query;
  query.wanted = number;
  query.stop = &context.stop();
  runtime::ModelTraces traces(model, query);
  traces.seek(static_cast<long>(number - 1));
  Found found;
  found.trace = traces.next();
  query.wanted = 0;
  if (!found.trace) found.count = runtime::count_traces(model, query).count.get_str();
  return found;
}

/// Every atom as the trace has it; what it does not show is the solver's choice.
std::optional<ValuedTrace> value(const compiler::CompiledModel& model, const runtime::Trace& trace,
                                 const Context& context) {
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()));
  std::vector<Literal> assumptions;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    const auto& [kind, time] = std::tie(atom.kind, atom.time);
    if (atom.needed_horizon(model.horizon) > trace.length()) return;
    const auto say = [&](bool is_true) {
      assumptions.push_back(is_true ? atom.literal() : ~atom.literal());
    };
    if (kind == AtomKind::kPredicate && !time) say(runtime::contains(trace.predicates, atom.name));
    if (!time) return;
    const auto& point = trace.points[static_cast<std::size_t>(*time)];
    if (kind == AtomKind::kHoldsAt) say(runtime::contains(point.holds, atom.fluent()));
    if (kind == AtomKind::kHappens) say(runtime::contains(point.happens, atom.event()));
    if (kind == AtomKind::kReleasedAt) say(runtime::contains(point.released, atom.fluent()));
  });
  if (session.solve_whole(trace.length(), assumptions) != runtime::SolveStatus::kSatisfiable) {
    return std::nullopt;
  }
  ValuedTrace valued{trace.length(), {}};
  for (std::int32_t v = 1; v <= model.variable_count(); ++v) {
    valued.values.push_back(session.value(Literal::positive(v)));
  }
  return valued;
}

base::Result<ValuedTrace> load_trace(const compiler::CompiledModel& model, std::int64_t number,
                                     Context& context) {
  const auto found = find_trace(model, number, context);
  const auto valued = found.trace ? value(model, *found.trace, context) : std::nullopt;
  if (valued) return *valued;
  if (context.stopped()) {
    return context.sink().error_about(codes::kExplanationCutShort, "",
                                      fmt::format("trace {} was not reached", number));
  }
  return context.sink().error_about(
      codes::kNoSuchTrace, "--trace", number,
      found.count == "0" ? "the model has none" : fmt::format("the model has {}", found.count));
}

/// The last timepoint at which the atom of a fact can be.
bool is_within(const TraceFact& fact, compiler::Timepoint length) {
  return fact.time.value_or(0) + (fact.kind == AtomKind::kHappens ? 1 : 0) <= length;
}

}  // namespace

ContradictionSearch::ContradictionSearch(const compiler::CompiledModel& model,
                                         const std::optional<ObservedRun>& run, Context& context)
    : context_(context),
      formula_(model, run ? std::optional(run->observed) : std::nullopt),
      axioms_(runtime::group_axioms(model)),
      texts_(model),
      effort_(effort_of(context.form().time_limit_s)) {}

base::Result<runtime::MinimalSets> ContradictionSearch::sets(const SetOptions& options) {
  auto solver =
      runtime::load_axioms(formula_, axioms_, runtime::make_cadical_solver(&context_.stop()));
  auto found = options.all ? runtime::all_minimal_sets(
                                 solver, static_cast<std::size_t>(options.limit), &context_.stop())
                           : runtime::smallest_set(solver, &context_.stop());
  if (found.unknown) {
    return context_.sink().error_about(codes::kExplanationCutShort, "",
                                       "whether there is a contradiction is not known");
  }
  return found;
}

base::Result<runtime::MinimalSets> ContradictionSearch::within(
    const runtime::IndexSet& contradiction) {
  auto found = sets({});
  if (!found || found->sets.empty()) return found;
  auto solver =
      runtime::load_axioms(formula_, axioms_, runtime::make_cadical_solver(&context_.stop()));
  if (solver.solve(contradiction) != runtime::SolveStatus::kUnsatisfiable) return found;
  auto set = solver.core();
  if (!runtime::shrink(solver, set)) return found;
  if (found->proven) found->lower_bound = found->sets.front().size();
  found->sets = {std::move(set)};
  return found;
}

Contradiction ContradictionSearch::look_at(const runtime::IndexSet& set) {
  runtime::ProofLimits limits;
  limits.stop = &context_.stop();
  const auto ground = runtime::ground_contradiction(formula_, axioms_, set, limits, effort_);
  if (ground.proof.verdict == runtime::ProofVerdict::kRejected) {
    context_.sink().error_about(codes::kProofRejected, "", ground.proof.reason);
  }
  Contradiction out{{}, ground.minimal, ground.proof.verdict, ground.clauses};
  for (const auto group : set) {
    out.axioms.push_back({axioms_.origins[group].front(), instances_of(group, ground.clauses)});
  }
  return out;
}

std::vector<std::string> ContradictionSearch::instances_of(
    std::uint32_t group, const std::vector<std::size_t>& clauses) const {
  std::vector<std::pair<compiler::Timepoint, std::string>> found;
  const auto& model = formula_.model();
  for (const auto clause : clauses) {
    if (axioms_.group_of[model.clause_origins[clause]] != group) continue;
    found.emplace_back(model.clause_timepoints[clause], texts_.clause(clause));
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> out;
  for (auto& [time, text] : found) out.push_back(std::move(text));
  return out;
}

base::Result<FactExplanation> explain_why(const compiler::CompiledModel& model,
                                          const WhyQuery& query, Context& context) {
  auto& sink = context.sink();
  const auto fact = parse_fact(query.fact, model, context);
  if (!fact) return sink.already_reported();
  const auto trace = load_trace(model, query.trace, context);
  if (!trace) return sink.already_reported();
  if (!is_within(*fact, trace->length)) {
    return sink.error_about(
        codes::kNoSuchFact, "--why", query.fact,
        fmt::format("trace {} ends at {}{}", query.trace, trace->length,
                    fact->kind == AtomKind::kHappens ? ", where nothing happens any more" : ""));
  }
  FactExplanation out{*fact, query.trace, std::nullopt, {}};
  if (!fact->atom) return out;
  const bool holds = trace->values[static_cast<std::size_t>(fact->atom->var()) - 1];
  out.asked = holds ? *fact->atom : ~*fact->atom;
  runtime::WhyOptions options;
  options.alternatives = query.all;
  options.stop = &context.stop();
  out.steps = runtime::explain_fact(model, trace->length, trace->values, *out.asked, options);
  const bool undecided = std::any_of(out.steps.begin(), out.steps.end(), [](const auto& step) {
    return step.kind == runtime::WhyKind::kUndecided;
  });
  if (undecided) {
    sink.error_about(codes::kExplanationCutShort, "", "whether every choice is one is not known");
  }
  return out;
}

}  // namespace parallax::tools
