#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

/// The truth of a trace told forwards: every literal that is true in it is derived by one clause
/// from literals derived before it, or is a choice that the earlier literals leave open.
///
/// Time goes by stages: the states of a timepoint, then its events. A clause takes part from the
/// stage of its latest atom on, so that nothing is derived from the future. Within a stage effects
/// come first, then inertia, then stated facts, then the other axioms, then completion; literals
/// that are still open are chosen as the trace has them. Linear in the clauses.
class Derivation {
 public:
  static constexpr std::size_t kChosen = SIZE_MAX;

  /// `values`: by variable - 1, a valuation of the clauses up to timepoint `n`. `model` outlives
  /// the object.
  Derivation(const compiler::CompiledModel& model, compiler::Timepoint n, std::vector<bool> values);

  bool is_true(compiler::Literal literal) const {
    return values_[static_cast<std::size_t>(literal.var()) - 1] == literal.is_positive();
  }
  /// Was the literal derived or chosen? Auxiliaries need not be.
  bool is_known(compiler::Literal literal) const { return known(literal) > 0; }
  /// The clause that derived a literal, or kChosen.
  std::size_t reason(std::int32_t variable) const {
    return reasons_[static_cast<std::size_t>(variable) - 1];
  }
  /// The place in the order of derivation.
  std::size_t rank(std::int32_t variable) const {
    return ranks_[static_cast<std::size_t>(variable) - 1];
  }
  /// Further clauses that force the literal by facts known before its stage: their other literals
  /// are false and were so earlier. Definitions are not among them.
  std::vector<std::size_t> other_reasons(compiler::Literal literal) const;
  /// The clauses with this literal whose other literals are false and were known to be so before
  /// `rank`.
  std::vector<std::size_t> supports(compiler::Literal literal, std::size_t rank) const;
  /// The choices made before the literal, as the trace has them.
  std::vector<compiler::Literal> choices_before(compiler::Literal literal) const;

 private:
  /// 1: derived; -1: its complement; 0: neither.
  int known(compiler::Literal literal) const {
    const int value = derived_[static_cast<std::size_t>(literal.var()) - 1];
    return literal.is_positive() ? value : -value;
  }
  void find_stages();
  void sort_clauses();
  void index_occurrences();
  void run();
  void activate(std::size_t clause);
  void fire(std::size_t clause);
  void derive(compiler::Literal literal, std::size_t reason);
  void propagate();
  void choose(std::uint32_t stage);

  static constexpr std::uint32_t kNoStage = UINT32_MAX;

  const compiler::CompiledModel& model_;
  compiler::Timepoint n_;
  std::vector<bool> values_;
  std::vector<std::uint32_t> stages_;  // by variable - 1; kNoStage: auxiliaries and the unused
  std::vector<std::size_t> schedule_;  // clauses by stage and kind
  std::vector<std::uint32_t> clause_stages_;
  std::vector<std::uint8_t> phases_;                   // by clause
  std::vector<std::vector<std::int32_t>> choices_at_;  // by stage: variables
  std::vector<std::size_t> first_,
      occurrences_;                  // by literal: clauses that contain it
  std::vector<std::uint32_t> open_;  // by clause: literals not known to be false
  std::vector<bool> active_;
  std::vector<std::int8_t> derived_;
  std::vector<std::size_t> reasons_, ranks_;
  std::vector<compiler::Literal> order_;  // by rank
  std::size_t head_ = 0;
};

enum class WhyKind : std::uint8_t {
  kStated,      // an axiom says so outright
  kEffect,      // an event brought it about (effect or trajectory axiom)
  kInertia,     // it was so before, and nothing changed it
  kAxiom,       // it follows from an axiom and other facts
  kCompletion,  // a completed predicate: nothing else could be a reason for it
  kForced,      // open at its time, but what comes later admits no other value
  kChosen,      // the model leaves it open; this trace has it so
  kUndecided    // forced or chosen: the solver was stopped
};

/// One fact of a chain, and its premises.
struct WhyStep {
  compiler::Literal fact;
  WhyKind kind;
  std::optional<std::uint32_t> origin;      // the axiom; none for choices
  std::vector<compiler::Literal> premises;  // facts that are told before this one
  /// Inertia: the timepoint since which the fact has been so without a break; it is told for that
  /// timepoint as a premise.
  compiler::Timepoint since = 0;
  /// Inertia: what would have changed it and did not happen.
  std::vector<compiler::Literal> absent;
  /// Clauses of effects that would have brought it about as well.
  std::vector<std::size_t> also;
};

struct WhyOptions {
  bool alternatives = false;  // tell the premises of `also` as well
  const std::atomic<bool>* stop = nullptr;
};

/// The chain of facts behind one that is true in a trace: earliest first, the fact itself last,
/// each once, premises before conclusions. `values` as for Derivation, `fact` is true in it.
std::vector<WhyStep> explain_fact(const compiler::CompiledModel& model, compiler::Timepoint n,
                                  const std::vector<bool>& values, compiler::Literal fact,
                                  const WhyOptions& options = {});

}  // namespace parallax::runtime
