#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <istream>
#include <span>
#include <string>
#include <vector>

#include "runtime/proof/proof_clauses.h"
#include "runtime/proof/proof_reader.h"

namespace parallax::runtime {

struct ProofLimits {
  std::size_t bytes = std::size_t{4} << 30U;  // for the clauses held at one time, and for variables
  /// Variables that a proof may use beyond those of the formula.
  std::uint32_t more_variables = 1U << 16U;
  const std::atomic<bool>* stop = nullptr;  // raised to end the check early
};

struct ProofStatistics {
  std::int64_t lemmas = 0;             // clauses that were added and checked
  std::int64_t resolution_lemmas = 0;  // among them those that needed RAT
  std::int64_t deletions = 0;
  std::int64_t ignored_deletions = 0;  // of clauses that are not there, or that support a literal
};

/// Checks a DRAT refutation forwards, one step at a time (Wetzler, Heule and Hunt 2014).
///
/// A clause may be added if the negation of all its literals leads to a conflict by unit
/// propagation (RUP), or if that is so for its resolvents on its first literal with every clause
/// that has the complement (RAT). Deleting a clause that supports an assigned literal is ignored,
/// as is usual: more clauses refute no less, and the clauses that a step is checked against are
/// always those that are held. Literals are in DIMACS convention. Cost of a RUP step: its
/// propagation; a RAT step looks at every clause once more, unless the complement of its first
/// literal never occurred.
class DratChecker {
 public:
  /// `variables`: of the formula.
  DratChecker(std::uint32_t variables, const ProofLimits& limits);

  enum class Outcome : std::uint8_t {
    kFine,
    kDoesNotFollow,
    kNoRoom,  // beyond limits.bytes
    kStopped
  };
  /// Adds a clause of the formula. Literals are of its variables.
  Outcome add_clause(std::span<const std::int64_t> clause);
  /// Checks a clause and adds it. The first literal is the one to resolve on.
  Outcome add_lemma(std::span<const std::int64_t> clause);
  Outcome remove_clause(std::span<const std::int64_t> clause);

  /// True once a contradiction was reached: then every further step is right.
  bool refuted() const { return refuted_; }
  /// The largest variable that a clause may have.
  std::int64_t max_variable() const { return max_variable_; }
  const ProofStatistics& statistics() const { return statistics_; }

 private:
  using Code = proof_literal::Code;
  using Ref = ProofClauses::Ref;

  /// False: the clause has a literal and its complement.
  bool normalize(std::span<const std::int64_t> clause);
  Outcome hold();
  Outcome follows();
  Outcome follows_by_resolution(Code pivot, std::size_t root);
  Outcome conflicts(std::size_t root);
  bool has_room(std::span<const std::int64_t> clause) const;

  std::int64_t max_variable_, variables_with_room_;
  ProofClauses clauses_;
  ProofPropagator propagator_;
  bool refuted_ = false;
  std::vector<Code> clause_;  // the one in work: distinct literals, in the order given
  std::vector<Code> sorted_;
  std::vector<bool> occurs_;  // by literal: in some clause that was ever held
  ProofStatistics statistics_;
};

enum class ProofVerdict : std::uint8_t {
  kAccepted,    // the formula has no model
  kRejected,    // a step does not follow, or something is malformed, or no contradiction is reached
  kNotFinished  // stopped, or beyond the limits
};

struct ProofReport {
  ProofVerdict verdict = ProofVerdict::kRejected;
  std::string reason;  // empty if accepted: "step 17 adds a clause that does not follow: 3 -5 0"
  ProofStatistics statistics;
};

/// Does the DRAT proof show that the DIMACS formula has no model? Both are read to their end: the
/// steps after a contradiction still have to be well-formed. Time is the cost of the steps; memory
/// is the clauses held at one time.
ProofReport check_proof(std::istream& formula, std::istream& proof, DratFormat format,
                        const ProofLimits& limits = {});

}  // namespace parallax::runtime
