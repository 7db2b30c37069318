#include "runtime/certify/completeness_claim.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/artifact/atom_kinds.h"

namespace parallax::runtime {

using compiler::AtomKind;
using compiler::Literal;

CompletenessClaim::CompletenessClaim(const CompiledModel& model)
    : model_(model),
      index_(model),
      variables_(model.variable_count() + (model.has_constraints ? 2 * model.horizon + 2 : 0)) {
  model.for_each_atom([&](std::int32_t variable, AtomKind kind, const std::string& name,
                          std::optional<Timepoint> time) {
    const bool result = kind == AtomKind::kResult && model.has_constraints;
    if (kind != AtomKind::kHoldsAt && kind != AtomKind::kHappens && !result) return;
    observables_.push_back({Literal::positive(variable), kind, time.value_or(0), name});
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
    const auto& names = observable.kind == AtomKind::kHoldsAt ? point.holds : point.happens;
    found.values[i] = std::binary_search(names.begin(), names.end(), observable.name);
  }
  traces_.push_back(std::move(found));
}

/// The clauses of timepoint t, 1 .. horizon, hold.
Literal CompletenessClaim::reaches(Timepoint t) const {
  return Literal::positive(model_.variable_count() + t);
}

/// The trace ends at n, 1 .. horizon; 0: it goes on beyond the horizon.
Literal CompletenessClaim::ends(Timepoint n) const {
  return Literal::positive(model_.variable_count() + model_.horizon + 1 + n);
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
    guarded.push_back(~reaches(t));
    visit(guarded);
  }
}

/// The trace is its initial state, where the constraints hold.
Literal CompletenessClaim::ends_at_start() const {
  return Literal::positive(model_.variable_count() + 2 * model_.horizon + 2);
}

/// A trace that ends at n reaches n, and the constraints hold there and at no earlier timepoint (0
/// counts if it has a hit atom). One that goes on reaches the horizon without that.
void CompletenessClaim::visit_length(Timepoint n, const Visit& visit) const {
  const auto last = n == 0 ? model_.horizon : n;
  const auto imply = [&](Literal consequence) {
    const Literal clause[] = {~ends(n), consequence};
    visit(clause);
  };
  for (Timepoint t = 1; t <= last; ++t) {
    imply(reaches(t));
    const auto hit = index_.find(AtomKind::kHit, "hit", t);
    PARALLAX_REQUIRE(hit.has_value(), "every timepoint from 1 has its hit atom");
    imply(t == n ? *hit : ~*hit);
  }
  if (const auto hit = index_.find(AtomKind::kHit, "hit", 0)) imply(~*hit);
  if (n > 0) return;
  if (const auto running = index_.find(AtomKind::kRunning, "running", last)) imply(*running);
}

void CompletenessClaim::visit_lengths(const Visit& visit) const {
  if (!model_.has_constraints) return;
  std::vector<Literal> some;
  if (const auto hit = index_.find(AtomKind::kHit, "hit", 0)) {
    const Literal clause[] = {~ends_at_start(), *hit};
    visit(clause);
    some.push_back(ends_at_start());
  }
  for (Timepoint n = shortest_; n <= model_.horizon; ++n) {
    some.push_back(ends(n));
    visit_length(n, visit);
  }
  visit(some);
}

void CompletenessClaim::visit_traces(const Visit& visit) const {
  std::vector<Literal> clause;
  for (const auto& found : traces_) {
    clause.clear();
    if (model_.has_constraints) {
      clause.push_back(found.length > 0 ? ~ends(found.length) : ~ends_at_start());
    }
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
