#include "tools/app/consequences.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/ground_name.h"
#include "compiler/base/suggest.h"
#include "runtime/consequences/abduction.h"
#include "runtime/explain/contradiction.h"
#include "runtime/explain/group_solver.h"
#include "tools/app/plan_reservations.h"

namespace parallax::tools {
namespace {

using compiler::AtomKind;
using compiler::CompiledModel;
using compiler::Literal;

struct AskedFact {
  std::size_t declared = 0;  // its place among the model's fluents or events
  Literal atom;
  ConsequenceFact fact;
};

std::vector<AskedFact> facts_of(const CompiledModel& model, std::int64_t at) {
  std::vector<AskedFact> facts;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    const bool happens = atom.kind == AtomKind::kHappens;
    if (!happens && atom.kind != AtomKind::kHoldsAt) return;
    const auto time = atom.time.value_or(0);
    if (at >= 0 && time != at) return;
    const auto declared = happens ? atom.event().index() : atom.fluent().index();
    facts.push_back({declared,
                     atom.literal(),
                     {std::string(atom.name), time, happens, runtime::Extent::kUndecided, {}}});
  });
  std::sort(facts.begin(), facts.end(), [](const AskedFact& a, const AskedFact& b) {
    return std::tie(a.fact.time, a.fact.happens, a.declared) <
           std::tie(b.fact.time, b.fact.happens, b.declared);
  });
  return facts;
}

/// From which axioms do facts follow that hold in all traces?
class FactReasons {
 public:
  FactReasons(const CompiledModel& model, const std::vector<AskedFact>& facts, Context& context)
      : formula_(model),
        groups_(runtime::group_axioms(model)),
        solver_(runtime::load_axioms(formula_, groups_,
                                     runtime::make_cadical_solver(&context.stop()), facts.size())) {
    for (std::size_t i = 0; i < facts.size(); ++i) {
      const auto denied = ~facts[i].atom;
      solver_.add(std::span(&denied, 1), denial(i));
    }
  }

  std::optional<std::vector<std::uint32_t>> of(std::size_t fact) {
    runtime::IndexSet all;
    for (std::uint32_t g = 0; g < groups_.size(); ++g) all.push_back(g);
    all.push_back(denial(fact));
    if (solver_.solve(all) != runtime::SolveStatus::kUnsatisfiable) return std::nullopt;
    auto core = solver_.core();
    if (!runtime::shrink(solver_, core)) return std::nullopt;
    std::vector<std::uint32_t> origins;
    for (const auto group : core) {
      if (group < groups_.size()) origins.push_back(groups_.origins[group].front());
    }
    return origins;
  }

 private:
  std::uint32_t denial(std::size_t fact) const {
    return static_cast<std::uint32_t>(groups_.size() + fact);
  }
  runtime::ExecutionFormula formula_;
  runtime::AxiomGroups groups_;
  runtime::GroupSolver solver_;
};

/// The first timepoint before the horizon at which some execution comes to a cut of the plan. Where
/// the solver was stopped, the first at which one may.
std::optional<compiler::Timepoint> reached_cut(const CompiledModel& model, const Context& context) {
  const auto first = first_cut(model);
  if (!goes_behind_cut(model)) return std::nullopt;
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()));
  const compiler::AtomIndex index(model);
  for (auto t = *first; t < model.horizon; ++t) {
    for (std::size_t cut = 0; cut < model.plan_cuts.size(); ++cut) {
      const auto there = index.at(compiler::PlanCutId(static_cast<std::uint32_t>(cut)), t);
      if (!there) continue;
      const auto status = session.solve_whole(t, std::span(&*there, 1));
      if (status == runtime::SolveStatus::kSatisfiable) return t;
      if (status == runtime::SolveStatus::kUnknown) return first;
    }
  }
  return std::nullopt;
}

/// Is the fact about a time of which, behind a cut, nothing is known?
bool is_behind(const ConsequenceFact& fact, compiler::Timepoint cut) {
  return fact.time > cut || (fact.happens && fact.time == cut);
}

}  // namespace

base::Result<ModelConsequences> find_model_consequences(const CompiledModel& model,
                                                        const ConsequencesQuery& query,
                                                        Context& context) {
  if (query.at > model.horizon) {
    return context.sink().error_about(
        codes::kUsage, "--at",
        fmt::format("timepoint {} lies beyond the horizon {}", query.at, model.horizon));
  }
  if (query.why && model.has_constraints) {
    return context.sink().error_about(
        codes::kUsage, "--why",
        "asks for the axioms behind what holds at a known horizon; it does not go with a plan or "
        "--until (`parallax explain` tells one trace's facts)");
  }
  auto asked = facts_of(model, query.at);
  std::vector<Literal> atoms;
  for (const auto& one : asked) atoms.push_back(one.atom);
  // Traces that all have the horizon's length need no guards by which clauses come and go.
  runtime::SolverSession session(
      model, runtime::make_cadical_solver(&context.stop()),
      model.has_constraints ? runtime::Loading::kAsNeeded : runtime::Loading::kWitness);
  const auto found = runtime::find_consequences(
      session, atoms, query.only_always ? runtime::Asked::kAll : runtime::Asked::kAllAndSome);
  std::optional<FactReasons> reasons;
  if (query.why) reasons.emplace(model, asked, context);
  ModelConsequences out{{}, found.any, found.complete, reached_cut(model, context)};
  for (std::size_t i = 0; i < asked.size(); ++i) {
    auto& fact = asked[i].fact;
    fact.extent = found.extents[i];
    // Traces that meet constraints end before a cut, but not all of them may be known.
    const bool shown = model.has_constraints && fact.extent == runtime::Extent::kSome;
    if (out.cut && is_behind(fact, *out.cut) && !shown) fact.extent = runtime::Extent::kUndecided;
    const bool counts =
        fact.extent == runtime::Extent::kAll || fact.extent == runtime::Extent::kUndecided;
    if (query.only_always && !counts) continue;
    if (reasons && fact.extent == runtime::Extent::kAll && found.any == true) {
      fact.axioms = reasons->of(i);
      if (!fact.axioms) out.complete = false;
    }
    out.facts.push_back(std::move(fact));
  }
  return out;
}

base::Result<Abduction> abduce(const CompiledModel& model, const AbductionQuery& query,
                               Context& context) {
  std::vector<Literal> abducibles;
  std::vector<Occurrence> occurrences;
  for (const auto& event : query.events) {
    bool is_known = false;
    std::vector<std::string> names;
    for (const auto& declared : model.events) {
      is_known = is_known || base::is_instance(declared.name, event);
      names.push_back(base::symbol_of(declared.name));
    }
    if (is_known) continue;
    auto error = context.sink().error_about(codes::kNoSuchEvent, "--abduce", event);
    if (const auto near = base::nearest_name(event, names)) error.fix(*near);
    return error;
  }
  auto asked = facts_of(model, -1);
  for (const auto& one : asked) {
    const auto is_asked = [&](const auto& event) {
      return base::is_instance(one.fact.name, event);
    };
    if (!one.fact.happens || std::none_of(query.events.begin(), query.events.end(), is_asked)) {
      continue;
    }
    abducibles.push_back(one.atom);
    occurrences.push_back({one.fact.name, one.fact.time});
  }
  const auto observed = compiler::AtomIndex(model).hit(model.horizon);
  Abduction out;
  if (!observed) {
    out.complete = true;  // it speaks of later timepoints than there are
    return out;
  }
  runtime::SolverSession find(model, runtime::make_cadical_solver(&context.stop()));
  runtime::SolverSession refute(model, runtime::make_cadical_solver(&context.stop()));
  runtime::Explanations explanations(find, refute, model.horizon, abducibles, *observed);
  const auto wanted = static_cast<std::size_t>(query.limit);
  while (wanted == 0 || out.explanations.size() < wanted) {
    const auto set = explanations.next();
    if (!set) break;
    auto& told = out.explanations.emplace_back();
    for (const auto atom : *set) {
      const auto at = std::find(abducibles.begin(), abducibles.end(), atom) - abducibles.begin();
      told.push_back(occurrences[static_cast<std::size_t>(at)]);
    }
  }
  out.complete = explanations.exhausted();
  out.possible_only = explanations.possible_only();
  return out;
}

}  // namespace parallax::tools
