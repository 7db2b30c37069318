// A trace of one model that another has not, by one solver.
//
// "The second model has no trace with these observables" has a quantifier: for all values of its
// hidden variables some clause is violated. Hidden variables that are functions of the
// observables (definitions.cc) are put into a circuit over the first model's variables, so that
// nothing is left to quantify, and one call answers. For the variables that stay free the
// statement is instantiated on demand: a candidate is verified on the second model, and the
// valuation that refutes it says which instance to require next (counterexample-guided
// refinement). After a limit of instances single traces are blocked instead, and then the answer
// is unknown. The timepoint by which a trace is excluded is found by bisection, since what
// excludes a prefix excludes all that continue it.
//
// Cost: two calls for each refinement, log2 of the horizon for the description of a trace.

#include "runtime/compare/difference_finder.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

namespace parallax::runtime {

using compiler::GroundName;

namespace {

/// The names of one kind that both lists have, with their slots, in the order of the first.
struct SharedName {
  std::uint32_t name = 0;
  std::optional<std::uint32_t> first, second;
};

class NameMatcher {
 public:
  explicit NameMatcher(SharedVocabulary& out) : out_(out) {}

  std::vector<SharedName> match(const std::vector<GroundName>& first,
                                const std::vector<GroundName>& second) {
    std::map<std::string_view, const GroundName*> others;
    for (const auto& ground : second) others.emplace(ground.name, &ground);
    std::vector<SharedName> shared;
    for (const auto& ground : first) {
      const auto found = others.find(ground.name);
      if (found == others.end()) {
        out_.only_first.push_back(ground.name);
        continue;
      }
      shared.push_back(
          {static_cast<std::uint32_t>(out_.names.size()), ground.slot, found->second->slot});
      out_.names.push_back(ground.name);
      others.erase(found);
    }
    for (const auto& [name, ground] : others) out_.only_second.emplace_back(name);
    return shared;
  }

 private:
  SharedVocabulary& out_;
};

}  // namespace

SharedVocabulary shared_vocabulary(const CompiledModel& first, const CompiledModel& second,
                                   Timepoint n) {
  SharedVocabulary out;
  NameMatcher matcher(out);
  const auto fluents = matcher.match(first.fluents, second.fluents);
  const auto events = matcher.match(first.events, second.events);
  out.fluents = fluents.size();
  out.events = events.size();
  std::sort(out.only_first.begin(), out.only_first.end());
  std::sort(out.only_second.begin(), out.only_second.end());
  const auto add = [&](AtomKind kind, const std::vector<SharedName>& names, Timepoint t) {
    for (const auto& name : names) {
      if (!name.first && !name.second) continue;
      SharedAtom atom{kind, name.name, t, std::nullopt, std::nullopt};
      if (name.first) atom.first = Literal::positive(first.variable(*name.first, t));
      if (name.second) atom.second = Literal::positive(second.variable(*name.second, t));
      out.shared.push_back(atom);
    }
  };
  for (Timepoint t = 0; t <= n; ++t) {
    add(AtomKind::kHoldsAt, fluents, t);
    if (t < n) add(AtomKind::kHappens, events, t);
  }
  return out;
}

SharedVocabulary exchanged(const SharedVocabulary& vocabulary) {
  auto out = vocabulary;
  for (auto& atom : out.shared) std::swap(atom.first, atom.second);
  std::swap(out.only_first, out.only_second);
  return out;
}

CompiledModel truncated(const CompiledModel& model, Timepoint n) {
  PARALLAX_REQUIRE(n <= model.horizon, "a model is not made longer");
  CompiledModel out = model;
  if (n == model.horizon) return out;
  out.horizon = n;
  out.clauses = {};
  out.clause_timepoints.clear();
  out.clause_origins.clear();
  out.clause_is_definition.clear();
  out.sections.clear();
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    if (model.clause_timepoints[i] > n) continue;
    out.clauses.add(model.clauses[i]);
    out.clause_timepoints.push_back(model.clause_timepoints[i]);
    out.clause_origins.push_back(model.clause_origins[i]);
    out.clause_is_definition.push_back(model.clause_is_definition[i]);
  }
  return out;
}

std::vector<bool> observed_in(const CompiledModel& model, const SharedVocabulary& vocabulary,
                              std::optional<Literal> SharedAtom::*side) {
  std::vector<bool> observed(static_cast<std::size_t>(model.variable_count()), false);
  for (const auto& atom : vocabulary.shared) {
    if (atom.needed_horizon() > model.horizon) continue;
    const auto& literal = atom.*side;
    if (literal) observed[static_cast<std::size_t>(literal->var()) - 1] = true;
  }
  return observed;
}

std::shared_ptr<const Definitions> definitions_for(const CompiledModel& model,
                                                   const SharedVocabulary& vocabulary,
                                                   std::optional<Literal> SharedAtom::*side,
                                                   const std::atomic<bool>* stop) {
  return std::make_shared<const Definitions>(
      find_definitions(model, observed_in(model, vocabulary, side), stop));
}

DifferenceFinder::DifferenceFinder(const CompiledModel& first, const CompiledModel& second,
                                   const SharedVocabulary& vocabulary, std::size_t max_refinements,
                                   const std::atomic<bool>* stop)
    : DifferenceFinder(first, definitions_for(first, vocabulary, &SharedAtom::first, stop), second,
                       definitions_for(second, vocabulary, &SharedAtom::second, stop), vocabulary,
                       max_refinements, stop) {}

DifferenceFinder::DifferenceFinder(const CompiledModel& first,
                                   std::shared_ptr<const Definitions> of_first,
                                   const CompiledModel& second,
                                   std::shared_ptr<const Definitions> of_second,
                                   const SharedVocabulary& vocabulary, std::size_t max_refinements,
                                   const std::atomic<bool>* stop)
    : first_(first),
      second_(second),
      vocabulary_(vocabulary),
      symbols_(symbols_of(first)),
      max_refinements_(max_refinements),
      solver_(make_cadical_solver(stop)),
      circuit_(*solver_, first.variable_count() + 1),
      first_definitions_(std::move(of_first)),
      second_definitions_(std::move(of_second)),
      verifier_(second, make_cadical_solver(stop)) {
  add_first();
  prepare_refutation();
}

/// Adds the first model with its definitions as gates, so that both models share equal parts.
void DifferenceFinder::add_first() {
  mapped_first_.emplace(first_, *first_definitions_, circuit_,
                        [](std::int32_t variable) { return Literal::positive(variable); });
  for (std::size_t c = 0; c < first_.clauses.size(); ++c) {
    if (first_definitions_->is_gate_clause[c]) continue;
    const auto clause = mapped_first_->clause(c);
    if (clause->satisfied) continue;
    asserted_.insert(*clause);
    solver_->add_clause(clause->literals);
  }
  // Witnesses with little in them are easier to read.
  for (const auto& atom : vocabulary_.shared) {
    if (atom.first) solver_->set_phase(~*atom.first);
  }
}

void DifferenceFinder::prepare_refutation() {
  std::vector<Literal> of_second(static_cast<std::size_t>(second_.variable_count()),
                                 circuit_.constant(false));
  std::vector<Refutation::Violations> impossible;
  for (const auto& atom : vocabulary_.shared) {
    if (atom.needed_horizon() > second_.horizon) continue;
    if (atom.first && atom.second) {
      of_second[static_cast<std::size_t>(atom.second->var()) - 1] = *atom.first;
    } else if (atom.first) {
      impossible.push_back({atom.needed_horizon(), *atom.first});
    }
  }
  refutation_.emplace(
      second_, *second_definitions_, circuit_, *solver_, asserted_,
      [&](std::int32_t v) { return of_second[static_cast<std::size_t>(v) - 1]; }, impossible);
  if (is_determined()) refutation_->require([](std::int32_t) { return false; });
}

DifferenceAnswer DifferenceFinder::find() { return search(std::nullopt, true); }
DifferenceAnswer DifferenceFinder::find_any() { return search(std::nullopt, false); }

DifferenceAnswer DifferenceFinder::find_with_fewer(std::size_t events) {
  if (events == 0) return DifferenceAnswer::kNone;
  if (!counter_) {
    std::vector<Literal> happens;
    for (const auto& atom : vocabulary_.shared) {
      if (atom.kind == AtomKind::kHappens && atom.time < second_.horizon && atom.first) {
        happens.push_back(*atom.first);
      }
    }
    counter_.emplace(circuit_, *solver_, happens, events);
  }
  return search(~counter_->at_least(events), true);
}

DifferenceAnswer DifferenceFinder::find(Timepoint by) {
  const auto status = solve(by, std::nullopt);
  // Whatever the values of the other variables are, a clause up to `by` is violated.
  if (status == SolveStatus::kUnsatisfiable) return DifferenceAnswer::kNone;
  if (status == SolveStatus::kUnknown) return DifferenceAnswer::kUnknown;
  return verify(by) == SolveStatus::kUnsatisfiable ? describe_found(by)
                                                   : DifferenceAnswer::kUnknown;
}

DifferenceAnswer DifferenceFinder::search(std::optional<Literal> assumption, bool describes) {
  const auto by = second_.horizon;
  for (;;) {
    const auto status = solve(by, assumption);
    if (status == SolveStatus::kUnsatisfiable) return DifferenceAnswer::kNone;
    if (status == SolveStatus::kUnknown) return DifferenceAnswer::kUnknown;
    // Where one call answers, a trace that is only counted need not be looked at again.
    if (!describes && is_determined()) return DifferenceAnswer::kFound;
    const auto verified = verify(by);
    if (verified == SolveStatus::kUnsatisfiable) {
      return describes ? describe_found(by) : DifferenceAnswer::kFound;
    }
    if (verified == SolveStatus::kUnknown) return DifferenceAnswer::kUnknown;
    PARALLAX_REQUIRE(!is_determined(), "definitions leave nothing open but what is free");
    if (refinements_ == 2 * max_refinements_) return DifferenceAnswer::kUnknown;
    if (refinements_++ < max_refinements_) {
      refutation_->require([&](std::int32_t v) { return verifier_.value(Literal::positive(v)); });
    } else {
      block(by);  // no more than this one trace is learned
    }
  }
}

SolveStatus DifferenceFinder::solve(Timepoint by, std::optional<Literal> assumption) {
  refutation_->assume_by(by);
  if (assumption) solver_->assume(*assumption);
  const auto status = solver_->solve();
  if (status != SolveStatus::kSatisfiable) return status;
  found_.clear();
  for (const auto& atom : vocabulary_.shared) {
    found_.push_back(atom.first && solver_->value(*atom.first));
  }
  return status;
}

bool DifferenceFinder::is_true(const SharedAtom& atom) const {
  return found_[static_cast<std::size_t>(&atom - vocabulary_.shared.data())];
}

/// Has the second model, up to `by`, a valuation with the trace that was found?
SolveStatus DifferenceFinder::verify(Timepoint by) {
  if (impossible(by)) return SolveStatus::kUnsatisfiable;
  return verifier_.solve(by, observation(by));
}

std::vector<Literal> DifferenceFinder::observation(Timepoint by) const {
  std::vector<Literal> literals;
  for (const auto& atom : vocabulary_.shared) {
    if (!atom.second || atom.needed_horizon() > by) continue;
    literals.push_back(is_true(atom) ? *atom.second : ~*atom.second);
  }
  return literals;
}
std::vector<Literal> DifferenceFinder::observation() const { return observation(excluded_by_); }

std::optional<SharedAtom> DifferenceFinder::impossible(Timepoint by) const {
  for (const auto& atom : vocabulary_.shared) {
    if (!atom.second && atom.needed_horizon() <= by && is_true(atom)) return atom;
  }
  return std::nullopt;
}
std::optional<SharedAtom> DifferenceFinder::impossible() const { return impossible(excluded_by_); }

/// Decodes the trace, and looks for the earliest timepoint: what rules out a part of a trace rules
/// out the longer ones.
DifferenceAnswer DifferenceFinder::describe_found(Timepoint by) {
  trace_ = decode_trace(first_, symbols_, first_.horizon, [&](Literal literal) {
    const auto mapped = *mapped_first_->find(literal);
    return solver_->value(mapped);
  });
  Timepoint low = 0;
  excluded_by_ = by;
  while (low < excluded_by_) {
    const auto middle = low + (excluded_by_ - low) / 2;
    switch (verify(middle)) {
      case SolveStatus::kUnsatisfiable:
        excluded_by_ = middle;
        break;
      case SolveStatus::kSatisfiable:
        low = middle + 1;
        break;
      case SolveStatus::kUnknown:
        return DifferenceAnswer::kUnknown;
    }
  }
  return DifferenceAnswer::kFound;
}

std::size_t DifferenceFinder::events_before(Timepoint t) const {
  return static_cast<std::size_t>(
      std::count_if(vocabulary_.shared.begin(), vocabulary_.shared.end(), [&](const auto& atom) {
        return atom.kind == AtomKind::kHappens && atom.time < t && is_true(atom);
      }));
}

void DifferenceFinder::block() { block(first_.horizon); }

void DifferenceFinder::block(Timepoint up_to) {
  std::vector<Literal> clause;
  for (const auto& atom : vocabulary_.shared) {
    if (atom.first && atom.needed_horizon() <= up_to)
      clause.push_back(is_true(atom) ? ~*atom.first : *atom.first);
  }
  solver_->add_clause(clause);
}

}  // namespace parallax::runtime
