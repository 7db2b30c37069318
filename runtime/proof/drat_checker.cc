// Checks a DRAT refutation forwards, one step at a time (Wetzler, Heule and Hunt 2014).
//
// A clause that is added must follow: with all its literals false, unit propagation meets a
// conflict (RUP), or it does so for each resolvent on the first literal with a clause that has
// the complement (RAT). Adding a RAT clause may lose models but never the last one, so a
// contradiction at the end means that the formula has none. Assignments that follow from units
// are permanent. A deletion of a clause that supports one of them is ignored, as more clauses
// refute no less; every step is checked against exactly the clauses that are held. After a
// contradiction all further steps are right and need only be well-formed.
//
// Cost: one propagation for a RUP step; a RAT step looks at all clauses, unless the complement
// never occurred.

#include "runtime/proof/drat_checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "runtime/proof/proof_reader.h"

namespace parallax::runtime {
namespace {

/// Bytes that the propagator keeps for a variable, its watch lists included.
constexpr std::size_t kBytesPerVariable = 128;

using Outcome = DratChecker::Outcome;

std::string clause_text(const std::vector<std::int64_t>& clause) {
  constexpr std::size_t kShown = 12;
  std::string text;
  for (std::size_t i = 0; i < clause.size() && i < kShown; ++i) {
    text += fmt::format("{} ", clause[i]);
  }
  return text + (clause.size() > kShown ? fmt::format("... {} literals", clause.size()) : "0");
}

ProofReport unfinished(Outcome outcome) {
  return {ProofVerdict::kNotFinished,
          outcome == Outcome::kStopped ? "it was stopped" : "it needs more memory than it may use",
          {}};
}

ProofReport rejected(std::string reason) {
  return {ProofVerdict::kRejected, std::move(reason), {}};
}

ProofReport read_formula(DimacsReader& reader, DratChecker& checker) {
  std::vector<std::int64_t> clause;
  while (true) {
    const auto found = reader.next(clause);
    if (found == DimacsReader::Outcome::kMalformed) {
      return rejected("the formula, " + reader.problem());
    }
    if (found == DimacsReader::Outcome::kEnd) return {ProofVerdict::kAccepted, {}, {}};
    const auto outcome = checker.add_clause(clause);
    if (outcome != Outcome::kFine) return unfinished(outcome);
  }
}

ProofReport read_proof(DratReader& reader, DratChecker& checker) {
  DratStep step;
  while (true) {
    const auto found = reader.next(step);
    if (found == DratReader::Outcome::kMalformed) {
      return rejected(fmt::format("after step {}, at byte {}: {}", reader.steps(), reader.offset(),
                                  reader.problem()));
    }
    if (found == DratReader::Outcome::kEnd) break;
    const auto outcome =
        step.deletes ? checker.remove_clause(step.clause) : checker.add_lemma(step.clause);
    if (outcome == Outcome::kDoesNotFollow) {
      return rejected(fmt::format("step {} adds a clause that does not follow: {}", reader.steps(),
                                  clause_text(step.clause)));
    }
    if (outcome != Outcome::kFine) return unfinished(outcome);
  }
  if (!checker.refuted()) {
    return rejected(fmt::format("its {} steps reach no contradiction", reader.steps()));
  }
  return {ProofVerdict::kAccepted, {}, {}};
}

}  // namespace

using proof_literal::negated;

DratChecker::DratChecker(std::uint32_t variables, const ProofLimits& limits)
    : max_variable_(std::min(std::int64_t{variables} + limits.more_variables,
                             proof_literal::kMaxVariable - 1)),
      variables_with_room_(static_cast<std::int64_t>(limits.bytes / kBytesPerVariable)),
      clauses_(limits.bytes),
      propagator_(clauses_, limits.stop) {}

bool DratChecker::has_room(std::span<const std::int64_t> clause) const {
  return std::all_of(clause.begin(), clause.end(), [&](std::int64_t literal) {
    return std::abs(literal) <= variables_with_room_;
  });
}

bool DratChecker::normalize(std::span<const std::int64_t> clause) {
  clause_.clear();
  for (const auto literal : clause) {
    clause_.push_back(proof_literal::from_dimacs(literal));
    propagator_.resize(proof_literal::variable(clause_.back()));
  }
  sorted_ = clause_;
  std::sort(sorted_.begin(), sorted_.end());
  const auto complement = [](Code a, Code b) { return b == negated(a) && a < b; };
  if (std::adjacent_find(sorted_.begin(), sorted_.end(), complement) != sorted_.end()) return false;
  const auto repeated = std::unique(sorted_.begin(), sorted_.end());
  if (repeated != sorted_.end()) {
    sorted_.erase(repeated, sorted_.end());
    // The first literal stays the first.
    const auto first = std::find(sorted_.begin(), sorted_.end(), clause_.front());
    std::rotate(sorted_.begin(), first, first + 1);
    clause_ = sorted_;
  }
  return true;
}

/// Adds the present clause and assigns the literals that it forces.
DratChecker::Outcome DratChecker::hold() {
  const auto added = clauses_.add(clause_);
  if (!added) return Outcome::kNoRoom;
  for (const auto literal : clause_) {
    if (literal >= occurs_.size()) occurs_.resize(literal + 1U);
    occurs_[literal] = true;
  }
  refuted_ = !propagator_.attach(*added) || propagator_.propagate() != ProofClauses::kNone;
  return propagator_.stopped() ? Outcome::kStopped : Outcome::kFine;
}

DratChecker::Outcome DratChecker::add_clause(std::span<const std::int64_t> clause) {
  if (refuted_) return Outcome::kFine;
  if (!has_room(clause)) return Outcome::kNoRoom;
  if (!normalize(clause)) return Outcome::kFine;
  return hold();
}

DratChecker::Outcome DratChecker::add_lemma(std::span<const std::int64_t> clause) {
  ++statistics_.lemmas;
  if (refuted_) return Outcome::kFine;
  if (!has_room(clause)) return Outcome::kNoRoom;
  if (!normalize(clause)) return Outcome::kFine;
  const auto outcome = follows();
  return outcome == Outcome::kFine ? hold() : outcome;
}

DratChecker::Outcome DratChecker::remove_clause(std::span<const std::int64_t> clause) {
  ++statistics_.deletions;
  if (refuted_) return Outcome::kFine;
  if (!has_room(clause)) return Outcome::kNoRoom;
  if (!normalize(clause)) return Outcome::kFine;
  const auto found = clauses_.find(clause_);
  if (found == ProofClauses::kNone || propagator_.is_support(found)) {
    ++statistics_.ignored_deletions;
    return Outcome::kFine;
  }
  clauses_.remove(found);
  if (clauses_.is_sparse()) {
    clauses_.compact();
    propagator_.rebuild();
  }
  return Outcome::kFine;
}

/// Do the assignments lead to a conflict? Those made before `root` are permanent.
DratChecker::Outcome DratChecker::conflicts(std::size_t root) {
  const auto conflict = propagator_.propagate();
  if (propagator_.stopped()) return Outcome::kStopped;
  if (conflict == ProofClauses::kNone) return Outcome::kDoesNotFollow;
  propagator_.mark_core(conflict, root);
  return Outcome::kFine;
}

DratChecker::Outcome DratChecker::follows() {
  const auto mark = propagator_.mark();
  auto outcome = Outcome::kDoesNotFollow;
  for (const auto literal : clause_) {
    if (propagator_.is_true(literal)) outcome = Outcome::kFine;
  }
  if (outcome != Outcome::kFine) {
    for (const auto literal : clause_) {
      if (propagator_.is_open(literal)) propagator_.assign(negated(literal));
    }
    outcome = conflicts(mark);
    if (outcome == Outcome::kDoesNotFollow && !clause_.empty()) {
      ++statistics_.resolution_lemmas;
      outcome = follows_by_resolution(clause_.front(), mark);
    }
  }
  propagator_.backtrack(mark);
  return outcome;
}

/// The negation of the clause is assigned and led to no conflict.
DratChecker::Outcome DratChecker::follows_by_resolution(Code pivot, std::size_t root) {
  const auto complement = negated(pivot);
  if (complement >= occurs_.size() || !occurs_[complement]) return Outcome::kFine;
  for (Ref clause = clauses_.first(); clause != clauses_.end(); clause = clauses_.next(clause)) {
    if (clauses_.is_removed(clause)) continue;
    const auto literals = std::as_const(clauses_).literals(clause);
    if (std::find(literals.begin(), literals.end(), complement) == literals.end()) continue;
    const auto mark = propagator_.mark();
    bool satisfied = false;
    for (const auto literal : literals) {
      satisfied = satisfied || (literal != complement && propagator_.is_true(literal));
    }
    if (satisfied) continue;
    for (const auto literal : literals) {
      if (propagator_.is_open(literal)) propagator_.assign(negated(literal));
    }
    const auto outcome = conflicts(root);
    propagator_.backtrack(mark);
    if (outcome != Outcome::kFine) return outcome;
  }
  return Outcome::kFine;
}

ProofReport check_proof(std::istream& formula, std::istream& proof, DratFormat format,
                        const ProofLimits& limits) {
  DimacsReader dimacs(formula);
  if (!dimacs.read_header()) return rejected("the formula, " + dimacs.problem());
  DratChecker checker(static_cast<std::uint32_t>(dimacs.variables()), limits);
  auto report = read_formula(dimacs, checker);
  if (report.verdict == ProofVerdict::kAccepted) {
    DratReader reader(proof, format, checker.max_variable());
    report = read_proof(reader, checker);
  }
  report.statistics = checker.statistics();
  return report;
}

}  // namespace parallax::runtime
