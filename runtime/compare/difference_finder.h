#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/compare/circuit.h"
#include "runtime/compare/refutation.h"
#include "runtime/session/solver_session.h"
#include "runtime/trace/trace.h"

namespace parallax::runtime {

using compiler::AtomKind;
using compiler::CompiledModel;
using compiler::Literal;
using compiler::Timepoint;

/// An observable atom of a name that both models have. Without a literal it is false in every trace
/// of that model; one of the two has one.
struct SharedAtom {
  AtomKind kind = AtomKind::kHoldsAt;  // or kHappens
  std::uint32_t name = 0;              // index into SharedVocabulary::names
  Timepoint time = 0;
  std::optional<Literal> first, second;
  /// The least horizon at which it exists.
  Timepoint needed_horizon() const { return time + (kind == AtomKind::kHappens ? 1 : 0); }
};

/// Vocabulary on which two models of one horizon can be compared: the ground fluents and events
/// that both have.
struct SharedVocabulary {
  std::vector<std::string> names;
  std::vector<SharedAtom> shared;  // by timepoint, fluents before events, in the first's order
  std::vector<std::string> only_first, only_second;  // names, sorted
  std::size_t fluents = 0, events = 0;               // that both have
  bool is_same() const { return only_first.empty() && only_second.empty(); }
};

/// Both models have the horizon `n` or a later one. Log-linear in names, linear in atoms.
SharedVocabulary shared_vocabulary(const CompiledModel& first, const CompiledModel& second,
                                   Timepoint n);

/// The same vocabulary with the two sides exchanged.
SharedVocabulary exchanged(const SharedVocabulary& vocabulary);

/// The model with the horizon `n`, at most its own: later clauses and timepoints are left out.
/// Sections, which describe how a file is written, are not kept.
CompiledModel truncated(const CompiledModel& model, Timepoint n);

/// By variable - 1: is it among the shared atoms on which the models are compared?
std::vector<bool> observed_in(const CompiledModel& model, const SharedVocabulary& vocabulary,
                              std::optional<Literal> SharedAtom::*side);

/// Definitions of the variables on one side of the vocabulary by the shared atoms.
std::shared_ptr<const Definitions> definitions_for(const CompiledModel& model,
                                                   const SharedVocabulary& vocabulary,
                                                   std::optional<Literal> SharedAtom::*side,
                                                   const std::atomic<bool>* stop);

enum class DifferenceAnswer : std::uint8_t {
  kFound,
  kNone,
  kUnknown  // stopped, or given up at a limit
};

/// Searches for traces of the first model that are, on what both models observe, no traces of the
/// second: valuations of the first that violate some clause of the second, whose other variables
/// are replaced by their definitions. Where those leave nothing open, one solver call answers.
/// Otherwise the values that save a trace in the second model are learned one by one, as in
/// counterexample-guided solving of formulas with one alternation of quantifiers (Janota and
/// Marques-Silva 2011). Every answer is checked with the second model as it is.
class DifferenceFinder {
 public:
  /// The first model has the horizon of the vocabulary, the second that one or an earlier one; both
  /// outlive the finder, `stop` may be null. `max_refinements`: values that are learned; then as
  /// many single traces, then it gives up.
  DifferenceFinder(const CompiledModel& first, const CompiledModel& second,
                   const SharedVocabulary& vocabulary, std::size_t max_refinements,
                   const std::atomic<bool>* stop);
  /// The same with what `definitions_for` gives, so that several finders share it.
  DifferenceFinder(const CompiledModel& first, std::shared_ptr<const Definitions> of_first,
                   const CompiledModel& second, std::shared_ptr<const Definitions> of_second,
                   const SharedVocabulary& vocabulary, std::size_t max_refinements,
                   const std::atomic<bool>* stop);
  DifferenceFinder(const DifferenceFinder&) = delete;
  DifferenceFinder& operator=(const DifferenceFinder&) = delete;

  /// Is there a trace of the first model that is, up to the horizon of the second, none of the
  /// second?
  DifferenceAnswer find();
  /// Is there one that the second rules out by an earlier timepoint? What its clauses up to then
  /// leave open may be determined by later ones, so this may be kUnknown; ask a finder for the
  /// truncated second model then.
  DifferenceAnswer find(Timepoint by);
  /// find() with fewer than `events` shared events before the horizon of the second.
  DifferenceAnswer find_with_fewer(std::size_t events);

  // After kFound, until the next call:

  /// The trace, over the names of the first model.
  const Trace& trace() const { return trace_; }
  /// The earliest timepoint by which the second model rules it out.
  Timepoint excluded_by() const { return excluded_by_; }
  /// The shared observables up to then as literals of the second model.
  std::vector<Literal> observation() const;
  /// The first atom of the trace up to then that no trace of the second model has.
  std::optional<SharedAtom> impossible() const;
  std::size_t events_before(Timepoint t) const;
  /// find(), for a trace that is only to be blocked, not described.
  DifferenceAnswer find_any();
  /// Excludes traces with the same shared observables from all further answers.
  void block();

  /// No variable of the second model is left open by the observables: one call answers.
  bool is_determined() const { return second_definitions_->free.empty(); }
  std::size_t refinements() const { return refinements_; }
  std::int64_t solve_calls() const { return solver_->solve_calls() + verifier_.solve_calls(); }

 private:
  void add_first();
  void prepare_refutation();
  void block(Timepoint up_to);
  DifferenceAnswer search(std::optional<Literal> assumption, bool describes);
  SolveStatus solve(Timepoint by, std::optional<Literal> assumption);
  SolveStatus verify(Timepoint by);
  bool is_true(const SharedAtom& atom) const;
  std::vector<Literal> observation(Timepoint by) const;
  std::optional<SharedAtom> impossible(Timepoint by) const;
  DifferenceAnswer describe_found(Timepoint by);

  const CompiledModel& first_;
  const CompiledModel& second_;
  const SharedVocabulary vocabulary_;
  const Symbols symbols_;
  const std::size_t max_refinements_;
  std::unique_ptr<SatSolver> solver_;
  Circuit circuit_;
  const std::shared_ptr<const Definitions> first_definitions_, second_definitions_;
  std::optional<MappedModel> mapped_first_;
  ClauseSet asserted_;
  std::optional<Refutation> refutation_;
  std::optional<EventCounter> counter_;
  SolverSession verifier_;
  std::size_t refinements_ = 0;

  std::vector<bool> found_;  // by shared atom
  Trace trace_;
  Timepoint excluded_by_ = 0;
};

}  // namespace parallax::runtime
