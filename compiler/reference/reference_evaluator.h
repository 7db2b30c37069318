#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/known.h"
#include "compiler/reference/expanded_model.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// A rule that a valuation breaks.
struct ReferenceFinding {
  enum class Rule : std::uint8_t {
    kAxiom,            // index: conjunct
    kNoninertial,      // a noninertial fluent is not released
    kReleasedAtStart,  // a fluent with inertia is
    kFrame,            // DEC5 to DEC8
    kEffect,           // DEC9 to DEC12; index: row of (fluent, timepoint)
    kTrajectory,       // DEC3 or DEC4; index: path
    kCompletion,       // index: completed atom
    kFounded,          // its reasons go in a circle; index: completed atom
    kCircularEffects   // some effect depends on its own absence
  };
  Rule rule = Rule::kAxiom;
  int dec = 0;  // the number of the DEC axiom
  std::size_t index = 0;
  std::uint32_t fluent = 0;
  std::int64_t timepoint = 0;
};

/// One look at an expanded model under one assignment of its atoms. What needs a timepoint after
/// `last` is left out.
class ReferenceSearch {
 public:
  using Values = std::vector<std::uint8_t>;
  ReferenceSearch(const TypedModel& model, const ExpandedModel& expanded, const Values& values,
                  std::int64_t last);

  /// Ends at `limit` findings, or when more than `max_reasons` formulas were evaluated to find
  /// reasons of completed atoms.
  void run(std::size_t limit, std::int64_t max_reasons);
  const std::vector<ReferenceFinding>& found() const { return found_; }
  /// Effect axioms with an instance whose event happened while its condition held, as indices into
  /// the typed model's.
  std::set<std::size_t> fired_effects() const;
  bool finished() const { return finished_; }

 private:
  using Truth = base::Truth;
  using Rule = ReferenceFinding::Rule;

  bool full() const { return found_.size() >= limit_; }
  void note(const ReferenceFinding& finding) {
    if (!full()) found_.push_back(finding);
  }
  bool is_true(std::uint32_t atom) const { return values_[atom] != 0; }
  Truth value(const ReferenceFormula& formula) const;
  /// The least effects of the rows, where conditions read the effects that they deny from `absent`,
  /// and atoms that count for them from `values`: rows are added until nothing new follows.
  Values least_effects(const Values& values, const Values& absent) const;
  /// Does an event change the fluent this way at t?
  Truth changed(EffectKind kind, std::uint32_t fluent, std::int64_t t) const;
  Truth fires(const ExpandedModel::EffectRow& row, std::int64_t t) const;

  void check_axioms();
  void check_releases();
  void check_frame(std::uint32_t fluent, std::int64_t t);
  void check_effects(std::uint32_t fluent, std::int64_t t);
  void check_path(std::size_t index);
  void check_completion(std::int64_t max_reasons);
  bool has_reason(const ExpandedModel::Completed& completed, Values& changed) const;
  void check_founded(std::int64_t max_reasons);

  const TypedModel& model_;
  const ExpandedModel& expanded_;
  const Values& values_;
  std::int64_t last_ = 0;
  Values effects_;  // as ExpandedModel numbers them
  bool circular_ = false;
  std::size_t limit_ = 0;
  std::vector<ReferenceFinding> found_;
  bool finished_ = true;
};

/// The true atoms of a trace: by timepoint for the event calculus, without for user predicates.
/// `holds.size() - 1` is the trace's last timepoint; before the model's horizon, only axioms about
/// these timepoints alone are checked.
struct Valuation {
  std::vector<std::set<std::string>> holds, happens, released;
  std::set<std::string> predicates;
};

/// By atom of the expanded model, of those it has so far: is it true? A trace may be shorter.
std::vector<std::uint8_t> atom_values(const ExpandedModel& expanded, const Valuation& valuation);

/// Something that a valuation gets wrong.
struct Violation {
  base::SourceRange source;  // the axiom, effect axiom, completion, or fluent declaration
  std::string what;          // "axiom", "DEC9 for Lit()", "completion of Happens(Go(r1),2)", ...
  std::int64_t timepoint = 0;
  std::string text;  // all of it on one line, with the atoms that decide
};

struct ReferenceReport {
  std::vector<Violation> violations;
  bool finished = true;  // false: given up, there may be more
};

struct ReferenceLimits {
  std::int64_t max_instances = 5'000'000;   // ground terms, instances and their parts together
  std::int64_t max_reasons = 50'000'000;    // formulas evaluated by one check
  const std::atomic<bool>* stop = nullptr;  // raised to end the expansion early
};

/// Evaluates a typed model on a valuation, slowly and obviously: every instance of every formula is
/// written out once (ExpandedModel), then formulas, DEC3 to DEC12 of Mueller 2006 as they are
/// printed there, and completion are evaluated one after the other. Shares nothing with grounder
/// and encoder; it is their oracle. Always the standard meaning.
///
/// Completion is pointwise circumscription: a true atom of a completed predicate has a reason if
/// some axiom of the label becomes false where that atom alone does, with all effects as they are.
/// A definition over effects is no reason. With `option founded on` a reason only counts once the
/// completed atoms that it asks for, itself or by way of effects, have one.
///
/// Cost: the instances of the model for construction; per check the atoms of these instances, and
/// for every true completed atom those of the instances that mention it, once for each round of
/// derivations where they are founded.
class ReferenceEvaluator {
 public:
  /// By atom: is it true? Numbered as ExpandedModel says; `atom_count()` of them.
  using Values = std::vector<std::uint8_t>;

  /// `model` outlives the evaluator.
  explicit ReferenceEvaluator(const TypedModel& model, const ReferenceLimits& limits = {});
  ReferenceEvaluator(const ReferenceEvaluator&) = delete;
  ReferenceEvaluator& operator=(const ReferenceEvaluator&) = delete;

  /// Why the model cannot be evaluated, if it is too large; then the functions below are not to be
  /// called.
  std::optional<std::string> refusal() const;
  /// The first violation; none if the valuation is a trace of the model (or the check was given
  /// up, see `violations`).
  std::optional<Violation> check(const Valuation& valuation) const;
  /// At most `limit` violations: axioms in source order, then inertia and effects by timepoint,
  /// then trajectories, then completion.
  ReferenceReport violations(const Valuation& valuation, std::size_t limit) const;

  /// The same for brute force: all atoms as one array, a yes or no for an answer. Atoms of
  /// predicates that no formula mentions have no number; any value of theirs is fine unless the
  /// predicate is completed.
  bool accepts(const Values& values) const;
  Values values_of(const Valuation& valuation) const { return atom_values(expanded_, valuation); }
  const TypedModel& model() const { return model_; }
  const ExpandedModel& expanded() const { return expanded_; }

  const std::vector<std::string>& fluents() const { return expanded_.fluents(); }
  const std::vector<std::string>& events() const { return expanded_.events(); }
  std::int64_t horizon() const { return expanded_.horizon(); }
  /// Axioms all of whose instances name what does not exist.
  std::vector<base::SourceRange> silent_axioms() const;

 private:
  Violation describe(const ReferenceFinding& finding, const Values& values) const;
  std::string deciding_atoms(FormulaTrees::Node node, const Values& values) const;
  void note_strange_atoms(const Valuation& valuation, std::size_t limit,
                          std::vector<Violation>& out) const;

  const TypedModel& model_;
  ReferenceLimits limits_;
  ReferenceBudget budget_;
  ExpandedModel expanded_;
};

}  // namespace parallax::compiler
