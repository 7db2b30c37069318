#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

struct GroundTermTag {
  static constexpr bool kOrdered = true;  // order of first construction
};
using GroundTermId = base::Id<GroundTermTag>;

/// A variable-free term: a constant, an integer, or a constructor over ground terms. The arguments
/// lie in the store.
struct GroundTerm {
  TermKind kind = TermKind::kInteger;  // kObject, kInteger or kApply
  ObjectId object;
  SymbolId symbol;
  std::uint32_t first_argument = 0, argument_count = 0;
  std::int64_t integer = 0;
};

/// Hash-consed ground terms: equal terms have equal ids (unique names).
class GroundTermStore {
 public:
  GroundTermStore();
  GroundTermId object(ObjectId id);
  GroundTermId integer(std::int64_t value);
  GroundTermId apply(SymbolId symbol, std::span<const GroundTermId> arguments);
  const GroundTerm& operator[](GroundTermId id) const { return terms_[id.index()]; }
  /// Valid until the next construction.
  std::span<const GroundTermId> arguments(GroundTermId id) const {
    const auto& term = terms_[id.index()];
    return std::span(pool_).subspan(term.first_argument, term.argument_count);
  }
  std::size_t size() const { return terms_.size(); }
  /// Printed without blanks, `On(cup1,table)`, `F()`, `3`.
  std::string text(GroundTermId id, const TypedModel& model) const;

 private:
  GroundTermId intern(const GroundTerm& term, std::span<const GroundTermId> arguments);
  bool equal(const GroundTerm& a, const GroundTerm& b,
             std::span<const GroundTermId> arguments) const;
  void grow();

  std::vector<GroundTerm> terms_;
  std::vector<GroundTermId> pool_;
  std::vector<std::uint32_t> table_;  // open addressing: index + 1; 0 means empty
};

/// The standard meaning (Mueller 2006), or that of the Discrete Event Calculus Reasoner 1.0 where
/// the two differ: an atom that no formula mentions is false; a formula that is false whatever
/// happens is left out; a quantifier whose instances all lie beyond the horizon is empty; a fact is
/// no reason for an atom that rules give reasons for.
enum class Meaning : std::uint8_t { kStandard, kDecreasoner };

struct GroundOptions {
  Meaning meaning = Meaning::kStandard;
  std::int64_t max_domain = 200'000;        // ground terms of one sort
  std::int64_t max_instances = 3'000'000;   // instances of one axiom
  const std::atomic<bool>* stop = nullptr;  // raised to end grounding early
  /// Off: every instance at every timepoint, from whole sorts. The models are the same.
  bool templates = true;  // say once what holds at every timepoint
  bool relevance = true;  // leave out what no trace can reach
  /// Up to this many HoldsAt atoms, fluents that are always false stay in the model
  /// (possible_atoms.h).
  std::size_t keep_unreachable = 100'000;
  /// Add constraints that follow by induction (compiler/ground/invariants.h); needs `templates`.
  bool invariants = true;
  /// Up to this many pairs of an event and a fluent every instance stays in the model, and
  /// exclusions are pairs (meetings.h); with more, least_clique counts. Needs `relevance` and
  /// `invariants`.
  std::size_t keep_meetings = 30'000;
  /// With this many atoms or more, that at most one is true is said by blocks (at_most_one.h).
  std::size_t least_clique = 9;
  bool lint = false;  // also report completed atoms that are reasons of each other
};

/// The domain of every sort as ground terms, in the order that fixes all numbering: subsorts in
/// order of declaration, own constants, ranges; reified sorts by constructor, then by arguments.
class Universe {
 public:
  /// Reports kDomainTooLarge at the sort, kTimeMustStartAtZero, kNoTimepoints.
  static base::Result<Universe> make(const TypedModel& model, const GroundOptions& options,
                                     GroundTermStore& terms, base::DiagnosticSink& sink);
  const std::vector<GroundTermId>& domain(SortId sort) const { return domains_[sort.index()]; }
  /// Is the term a member of the sort? Integer sorts without a range take every integer.
  bool contains(SortId sort, GroundTermId term, const GroundTermStore& terms) const;
  /// The last timepoint.
  std::int32_t horizon() const { return horizon_; }

 private:
  bool add_domain(SortId sort, const TypedModel& model, const GroundOptions& options,
                  GroundTermStore& terms, base::DiagnosticSink& sink);
  bool add_constructors(SortId sort, const TypedModel& model, const GroundOptions& options,
                        GroundTermStore& terms, base::DiagnosticSink& sink);
  std::vector<std::vector<GroundTermId>> domains_;   // by sort
  std::vector<std::vector<std::uint32_t>> members_;  // by sort: sorted term indices
  std::vector<bool> unbounded_;                      // by sort: integers without a range
  std::vector<std::uint8_t> state_;                  // by sort: untouched, in work, done
  std::int32_t horizon_ = 0;
};

}  // namespace parallax::compiler
