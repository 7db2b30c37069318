#include "runtime/certify/completeness_claim.h"

#include <fmt/format.h>

#include <algorithm>

namespace parallax::runtime {

using compiler::AtomKind;
using compiler::Literal;

CompletenessClaim::CompletenessClaim(const CompiledModel& model)
    : model_(model),
      lengths_(model),
      index_(model),
      variables_(model.has_constraints ? lengths_.last() : model.variable_count()) {
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    const auto kind = atom.kind;
    const bool result = kind == AtomKind::kResult && model.has_constraints;
    if (kind != AtomKind::kHoldsAt && kind != AtomKind::kHappens && !result) return;
    const auto name = result ? to_string(kind, atom.plan) : atom.name;
    observables_.push_back({atom.literal(), kind, atom.time.value_or(0), atom.number, name});
  });
}

/// Two traces of this length are one if they agree on the keys.
bool CompletenessClaim::is_key(const Observable& observable, Timepoint length) const {
  if (!model_.has_constraints) return true;
  // What a perform returned is known one timepoint later.
  const auto last = observable.kind == AtomKind::kResult ? length : length - 1;
  return observable.kind != AtomKind::kHoldsAt && observable.time <= last;
}

void CompletenessClaim::add(const Trace& trace) {
  Found found{trace.length(), std::vector<bool>(observables_.size(), false)};
  for (std::size_t i = 0; i < observables_.size(); ++i) {
    const auto& observable = observables_[i];
    if (!is_key(observable, found.length)) continue;
    if (observable.kind == AtomKind::kResult) {
      const auto& before = trace.points[static_cast<std::size_t>(observable.time) - 1];
      found.values[i] = before.returned == observable.name;
      continue;
    }
    const auto& point = trace.points[static_cast<std::size_t>(observable.time)];
    found.values[i] = observable.kind == AtomKind::kHoldsAt
                          ? contains(point.holds, compiler::FluentId(observable.number))
                          : contains(point.happens, compiler::EventId(observable.number));
  }
  traces_.push_back(std::move(found));
}

std::vector<Literal> CompletenessClaim::given() const {
  std::vector<Literal> literals;
  if (model_.has_constraints) return literals;
  for (Timepoint t = 1; t <= model_.horizon; ++t) literals.push_back(lengths_.reaches(t));
  return literals;
}

void CompletenessClaim::visit_model(const Visit& visit) const {
  std::vector<Literal> guarded;
  for (std::size_t i = 0; i < model_.clauses.size(); ++i) {
    const auto t = model_.clause_timepoints[i];
    const bool always = !model_.has_constraints || t == 0 || model_.clause_is_definition[i];
    if (always) {
      visit(model_.clauses[i]);
      continue;
    }
    guarded.assign(model_.clauses[i].begin(), model_.clauses[i].end());
    guarded.push_back(~lengths_.reaches(t));
    visit(guarded);
  }
}

/// A trace that ends at n reaches n, and the constraints hold there and at no earlier timepoint (0
/// counts if it has a hit atom).
void CompletenessClaim::visit_end(Timepoint n, const Visit& visit) const {
  const auto imply = [&](Literal consequence) {
    const Literal clause[] = {~lengths_.ends(n), consequence};
    visit(clause);
  };
  for (Timepoint t = 1; t <= n; ++t) imply(lengths_.reaches(t));
  for (Timepoint t = 0; t <= n; ++t) {
    const auto hit = index_.hit(t);
    PARALLAX_REQUIRE(hit.has_value() || t == 0, "every timepoint from 1 has its hit atom");
    if (hit) imply(t == n ? *hit : ~*hit);
  }
}

/// One that goes on reaches the horizon without that.
void CompletenessClaim::visit_going_on(const Visit& visit) const {
  const auto imply = [&](Literal consequence) {
    const Literal clause[] = {~lengths_.goes_on(), consequence};
    visit(clause);
  };
  for (Timepoint t = 1; t <= model_.horizon; ++t) imply(lengths_.reaches(t));
  for (Timepoint t = 0; t <= model_.horizon; ++t) {
    if (const auto hit = index_.hit(t)) imply(~*hit);
  }
  if (const auto running = index_.running(model_.horizon)) {
    imply(*running);
  }
}

void CompletenessClaim::visit_lengths(const Visit& visit) const {
  if (!model_.has_constraints) return;
  std::vector<Literal> some;
  if (may_go_on_) {
    some.push_back(lengths_.goes_on());
    visit_going_on(visit);
  }
  const bool hits_at_start = index_.hit(0).has_value();
  for (Timepoint n = hits_at_start ? 0 : 1; n <= model_.horizon; ++n) {
    some.push_back(lengths_.ends(n));
    visit_end(n, visit);
  }
  visit(some);
}

void CompletenessClaim::visit_traces(const Visit& visit) const {
  std::vector<Literal> clause;
  for (const auto& found : traces_) {
    clause.clear();
    if (model_.has_constraints) clause.push_back(~lengths_.ends(found.length));
    for (std::size_t i = 0; i < observables_.size(); ++i) {
      if (!is_key(observables_[i], found.length)) continue;
      clause.push_back(found.values[i] ? ~observables_[i].literal : observables_[i].literal);
    }
    visit(clause);
  }
}

void CompletenessClaim::for_each_clause(const Visit& visit) const {
  visit_model(visit);
  visit_lengths(visit);
  visit_traces(visit);
}

void CompletenessClaim::write_dimacs(std::ostream& out) const {
  std::int64_t clauses = 0;
  for_each_clause([&](std::span<const Literal>) { ++clauses; });
  out << fmt::format(
      "c No model: these are all traces of the model up to timepoint {}.\n"
      "c First its {} clauses, at the end {} for the traces that were listed.\n",
      model_.horizon, model_.clauses.size(), traces_.size());
  for (const auto& source : model_.sources) {
    out << fmt::format("c source {} {:016x}\n", source.name, source.hash);
  }
  for (const auto& observable : observables_) {
    out << fmt::format("c map {} {}({},{})\n", observable.literal.dimacs(),
                       compiler::to_string(observable.kind), observable.name, observable.time);
  }
  out << fmt::format("p cnf {} {}\n", variables_, clauses);
  std::string line;
  for_each_clause([&](std::span<const Literal> clause) {
    line.clear();
    for (const auto literal : clause)
      fmt::format_to(std::back_inserter(line), "{} ", literal.dimacs());
    line += "0\n";
    if (out) out << line;
  });
}

}  // namespace parallax::runtime
