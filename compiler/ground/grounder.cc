// The passes from a typed model to ground constraints; the table at the end lists them in order.
//
// Axioms are grounded in the order in which knowledge grows: those without time, those about
// single timepoints, the narrative with the states that it leads through, the effects of all
// other events, and then the rest, joined over the atoms that are still possible. Each pass
// makes the joins of later ones smaller. An axiom with one universal time variable is grounded
// once, at its earliest timepoint, and required at every one; it is expanded instead where it
// binds only when a scheduled event happens, or where a quantifier in it is empty. While an
// axiom that mentions effects is noted for completion its effects are opaque atoms. An axiom
// that is false is an error only if it is false without what is known of the model, so it is
// grounded once more with all atoms possible.
//
// Cost: that of the passes, each described in its file.

#include "compiler/ground/grounder.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "compiler/base/codes/grounding.h"
#include "compiler/formula/formula.h"
#include "compiler/ground/at_most_one.h"
#include "compiler/ground/check_grounding.h"
#include "compiler/ground/completion.h"
#include "compiler/ground/effect_constraints.h"
#include "compiler/ground/effects.h"
#include "compiler/ground/equal_bits.h"
#include "compiler/ground/expansion_size.h"
#include "compiler/ground/formula_grounder.h"
#include "compiler/ground/ground_model.h"
#include "compiler/ground/invariants.h"
#include "compiler/ground/meetings.h"
#include "compiler/ground/narrative.h"
#include "compiler/ground/opaque_effects.h"
#include "compiler/ground/possible_atoms.h"
#include "compiler/ground/shared_instances.h"
#include "compiler/ground/time_profile.h"
#include "compiler/sema/axiom_shapes.h"

namespace parallax::compiler {

namespace {

/// Grounds in the order in which knowledge grows: axioms that do not depend on time, axioms about
/// single timepoints, the narrative with the states it leads through, and then the rest, joined
/// over the atoms that are still possible. The passes stand in the table below.
class Grounder {
 public:
  /// `is_checked`: nothing is wanted but messages.
  Grounder(GroundModel& model, const GroundOptions& options, bool is_checked,
           base::DiagnosticSink& sink)
      : model_(model),
        typed_(model.typed()),
        options_(options),
        sink_(sink),
        grounder_(model, options, sink),
        possible_(model),
        rows_(model.fluents().size()),
        effects_(model, grounder_, rows_),
        completion_(model, options.meaning, options.lint),
        opaque_(model, rows_),
        standard_(options.meaning == Meaning::kStandard),
        relevance_(standard_ && options.relevance),
        is_checked_(is_checked),
        asserted_(typed_.axioms.size(), false) {
    for (const auto& axiom : typed_.axioms) {
      profiles_.push_back(time_profile(typed_, axiom.formula));
      // Axioms over effects wait for the effects.
      if (axiom.mentions_effects) profiles_.back().shape = TimeShape::kMixed;
    }
    bounds_have_changed();
    if (!standard_) model_.formulas().keep_complements();
  }

  static std::span<const Pass<Grounder>> passes();
  PassSize size() const {
    return {model_.atom_count(), model_.formulas().node_count(), model_.constraints().size(), 0};
  }
  std::string text(const base::SourceFiles* files) const {
    return ground_text(model_, rows_, files);
  }
  /// The last axiom's instances are charged to it when something else begins.
  void finish() { grounder_.start({}); }

 private:
  // --- the passes, in order ---

  void rigid_axioms() { assert_axioms(TimeShape::kRigid); }

  void predicate_tables() {
    tabulate_predicates(model_, completion_, drops_meetings(model_, options_), possible_);
    bounds_have_changed();
  }

  void fixed_axioms() { assert_axioms(TimeShape::kFixed); }

  void narrative() {
    Narrative narrative(model_, possible_, rows_, effects_, options_.keep_unreachable);
    // A formula may ask for the effects of an event that never happens.
    if (!something_mentions_effects()) narrative.schedule(completion_);
    bounds_have_changed();
    narrative.walk();
  }

  void effects() {
    std::vector<const EffectAxiom*> constraints;
    for (const auto& effect : typed_.effects) {
      if (mentions_effects(typed_, effect.condition)) {
        constraints.push_back(&effect);
      } else if (!effects_.is_scheduled(effect)) {
        effects_.ground(effect);
      }
    }
    if (constraints.empty()) return;
    EffectConstraints(model_, grounder_, effects_, rows_, grounder_.possible(), sink_)
        .ground(constraints);
  }

  void reachability() {
    drop_unreachable(model_, possible_, rows_, options_.keep_unreachable);
    bounds_have_changed();
  }

  /// Instances that are left out because of them must not be those that they follow from: the
  /// axioms that have preconditions and exclusions are grounded before.
  void meetings() {
    grounder_.use_effects(rows_);
    for (std::size_t i = 0; i < typed_.axioms.size(); ++i) {
      if (asserted_[i] || profiles_[i].shape != TimeShape::kUniform) continue;
      if (!speaks_of_at_most(2, typed_.axioms[i])) continue;
      asserted_[i] = true;
      assert_axiom(typed_.axioms[i], profiles_[i]);
    }
    if (grounder_.failed()) return;
    groups_ = at_most_one_groups(model_, rows_);
    possible_.know_meetings(Meetings(model_, groups_));
    if (!something_mentions_effects()) {
      rows_.replace_always(rows_that_meet(rows_, possible_.meetings(), model_));
    }
    bounds_have_changed();
  }

  /// Does the premise have so many atoms of events and fluents?
  bool speaks_of_at_most(std::size_t count, const Axiom& axiom) const {
    auto body = axiom.formula;
    while (typed_.formulas[body].kind == FormulaKind::kForall) {
      body = typed_.formulas[body].children[0];
    }
    for (const auto& conjunct : conjuncts_of(typed_, body, true)) {
      if (conjunct.kind != Conjunct::Kind::kAtom) continue;
      const auto predicate = typed_.formulas[conjunct.formula].predicate;
      if (predicate != typed_.core.happens && predicate != typed_.core.holds_at) continue;
      if (count == 0) return false;
      --count;
    }
    return true;
  }

  void other_axioms() {
    grounder_.use_effects(rows_);
    assert_axioms(std::nullopt);
    if (!grounder_.failed()) report_shared_instances(model_, grounder_, sink_);
  }

  void completion() {
    completion_.report_loops(sink_);
    completion_.write(static_cast<std::size_t>(options_.max_instances), sink_);
  }
  void trajectories() { assert_trajectories(model_, rows_, grounder_, sink_); }
  void inertia() { assert_inertia(model_, rows_, options_); }
  void invariants() {
    const bool joins = drops_meetings(model_, options_);
    const auto clique = joins ? options_.least_clique : std::numeric_limits<std::size_t>::max();
    add_invariants(model_, rows_, groups_, possible_.meetings(), clique);
    add_equal_bits(model_, rows_);
    if (joins) join_exclusions(model_, clique);
  }

  /// In the 2005 reasoner's meaning an atom that stands in no formula is false.
  void unmentioned_atoms() {
    std::vector<FormulaId> asserted;
    for (const auto& constraint : model_.constraints()) asserted.push_back(constraint.formula);
    const auto mentioned = atoms_of(model_.formulas(), asserted);
    const auto origin = model_.add_origin({}, OriginKind::kUnmentioned);
    const auto deny = [&](FormulaId atom) {
      const auto variable = model_.formulas().variable(atom);
      if (!std::binary_search(mentioned.begin(), mentioned.end(), variable)) {
        model_.require(~atom, origin);
      }
    };
    for (Timepoint t = 0; t <= model_.horizon(); ++t) {
      for (std::uint32_t f = 0; f < model_.fluents().size(); ++f) {
        deny(model_.holds(f, t));
        if (model_.can_be_released(f)) deny(model_.released(f, t));
      }
      if (t == model_.horizon()) break;
      for (std::uint32_t e = 0; e < model_.events().size(); ++e) deny(model_.happens(e, t));
    }
    for (std::size_t i = 0; i < model_.atom_count(); ++i) {
      const auto variable = static_cast<std::int32_t>(i + 1);
      if (model_.atom(variable).kind != AtomKind::kPredicate) continue;
      deny(model_.formulas().atom(variable));
    }
  }

  // --- when they apply ---

  bool uses_relevance() const { return relevance_; }
  bool looks_for_meetings() const { return drops_meetings(model_, options_); }
  bool has_trajectories() const { return !typed_.trajectories.empty(); }
  bool looks_for_invariants() const {
    return is_grounded() && standard_ && options_.templates && options_.invariants;
  }
  bool denies_unmentioned() const { return is_grounded() && !standard_; }
  bool is_grounded() const { return !is_checked_; }

  // --- what they share ---

  /// Joins that were planned over the earlier bounds are planned anew.
  void bounds_have_changed() {
    if (relevance_) grounder_.use_possible(&possible_);
  }

  bool something_mentions_effects() const {
    const auto in_condition = [&](const auto& axiom) {
      return mentions_effects(typed_, axiom.condition);
    };
    return std::any_of(typed_.axioms.begin(), typed_.axioms.end(),
                       [](const Axiom& axiom) { return axiom.mentions_effects; }) ||
           std::any_of(typed_.effects.begin(), typed_.effects.end(), in_condition) ||
           std::any_of(typed_.trajectories.begin(), typed_.trajectories.end(), in_condition);
  }

  /// The axioms of this shape; without one, all that are left.
  void assert_axioms(std::optional<TimeShape> shape) {
    for (std::size_t i = 0; i < typed_.axioms.size(); ++i) {
      if (asserted_[i] || (shape && profiles_[i].shape != *shape)) continue;
      asserted_[i] = true;
      assert_axiom(typed_.axioms[i], profiles_[i]);
    }
  }

  /// Does the axiom only bind when a scheduled event happens? Then it is expanded there.
  bool waits_for_scheduled_event(const Axiom& axiom) const {
    if (grounder_.possible() == nullptr) return false;
    auto body = axiom.formula;
    while (typed_.formulas[body].kind == FormulaKind::kForall) {
      body = typed_.formulas[body].children[0];
    }
    const auto conjuncts = conjuncts_of(typed_, body, true);
    return std::any_of(conjuncts.begin(), conjuncts.end(), [&](const Conjunct& conjunct) {
      if (conjunct.kind != Conjunct::Kind::kAtom) return false;
      const auto& atom = typed_.formulas[conjunct.formula];
      if (atom.predicate != typed_.core.happens) return false;
      const auto& event = typed_.terms[atom.terms[0]];
      return event.kind == TermKind::kApply ? possible_.is_scheduled(event.symbol)
                                            : possible_.all_events_scheduled();
    });
  }

  void assert_axiom(const Axiom& axiom, const TimeProfile& profile) {
    const bool always = profile.shape == TimeShape::kUniform && standard_ && options_.templates &&
                        !waits_for_scheduled_event(axiom) &&
                        !has_empty_quantifier(typed_, model_.universe(), axiom.formula);
    const bool opaque = standard_ && axiom.mentions_effects && completion_.has_completions();
    grounder_.start(axiom.source);
    if (opaque) {
      grounder_.use_effect_atoms(
          [this](EffectKind kind, std::uint32_t event, std::uint32_t fluent, Timepoint t) {
            return opaque_.atom({kind, event, fluent, t});
          });
    }
    const auto formula = always ? ground_for_every_timepoint(axiom, profile) : ground_once(axiom);
    grounder_.use_effect_atoms(nullptr);
    if (grounder_.failed()) return;
    if (!formula) {
      if (!axiom.is_foundation) {
        report_silent(axiom);
      }
      return;
    }
    const auto said = opaque ? opaque_.resolved(*formula) : *formula;
    if (said == model_.formulas().falsity() && report_false(axiom)) return;
    const auto origin = model_.add_origin(axiom.source, OriginKind::kAxiom);
    if (always) {
      model_.require_always(said, origin, profile.width);
    } else {
      model_.require(said, origin);
    }
    // The encoder of 2005 takes no axiom about effects for a reason.
    if (standard_ ? defines_by_effects(typed_, axiom) : axiom.mentions_effects) return;
    const auto width = always ? profile.width : Constraint::kOnce;
    if (!completion_.note(axiom, *formula, width, opaque ? &opaque_ : nullptr)) {
      sink_.warning(codes::kNamedCompletion, axiom.source);
    }
  }

  std::optional<FormulaId> ground_once(const Axiom& axiom) {
    grounder_.read_whole_axiom(true);
    const auto formula = grounder_.ground(axiom.formula);
    grounder_.read_whole_axiom(false);
    return formula;
  }

  std::optional<FormulaId> ground_for_every_timepoint(const Axiom& axiom,
                                                      const TimeProfile& profile) {
    if (profile.width > model_.horizon()) return std::nullopt;
    possible_.set_timeless(true);
    grounder_.bind(profile.variable, model_.terms().integer(profile.back));
    const auto formula = grounder_.ground(axiom.formula);
    grounder_.unbind(profile.variable);
    possible_.set_timeless(false);
    return formula;
  }

  /// True: an axiom that is false is not asserted.
  bool report_false(const Axiom& axiom) {
    if (!standard_) {
      sink_.warning(codes::kFalseFormulaDropped, axiom.source);
      return true;
    }
    if (!is_false_whatever_happens(axiom)) return false;
    sink_.error(codes::kFormulaIsFalse, axiom.source);
    return true;
  }

  void report_silent(const Axiom& axiom) {
    auto error = sink_.error(codes::kNothingToSay, axiom.source, model_.horizon());
    if (!has_event_at(axiom.formula, model_.horizon())) return;
    error.help(fmt::format(
        "No event happens at the last timepoint, {0}, because nothing follows it: let time go "
        "on with `range time 0 {1}` or --horizon {1}, or let the event happen earlier.",
        model_.horizon(), model_.horizon() + 1));
  }

  bool has_event_at(TypedFormulaId root, Timepoint timepoint) const {
    std::vector<TypedFormulaId> visit = {root};
    while (!visit.empty()) {
      const auto& formula = typed_.formulas[visit.back()];
      visit.pop_back();
      visit.insert(visit.end(), formula.children.begin(), formula.children.end());
      if (formula.kind != FormulaKind::kAtom || formula.predicate != typed_.core.happens) continue;
      const auto& time = typed_.terms[formula.terms[1]];
      if (time.kind == TermKind::kInteger && time.integer == timepoint) return true;
    }
    return false;
  }

  /// False in itself, or only with the facts already known about the model?
  bool is_false_whatever_happens(const Axiom& axiom) {
    if (grounder_.possible() == nullptr) return true;
    const auto size = expansion_size(typed_, model_.universe(), axiom.formula);
    if (size > static_cast<std::uint64_t>(options_.max_instances)) return false;  // cannot tell
    grounder_.use_possible(nullptr);
    grounder_.start(axiom.source);
    const auto formula = grounder_.ground(axiom.formula);
    grounder_.use_possible(&possible_);
    return !grounder_.failed() && formula && *formula == model_.formulas().falsity();
  }

  GroundModel& model_;
  const TypedModel& typed_;
  const GroundOptions& options_;
  base::DiagnosticSink& sink_;
  FormulaGrounder grounder_;
  PossibleAtoms possible_;
  EffectRows rows_;
  EffectGrounder effects_;
  CompletionWriter completion_;
  OpaqueEffects opaque_;
  std::vector<FluentGroup> groups_;  // known since `meetings`
  bool standard_, relevance_, is_checked_;
  std::vector<TimeProfile> profiles_;  // by axiom
  std::vector<bool> asserted_;         // by axiom
};

std::span<const Pass<Grounder>> Grounder::passes() {
  using G = Grounder;
  static constexpr std::array<Pass<G>, 13> kPasses = {{
      {{"rigid-axioms", "axioms in which no timepoint stands"},
       &G::rigid_axioms,
       &G::text,
       &G::uses_relevance},
      {{"predicate-tables", "which atoms of user predicates may be true"},
       &G::predicate_tables,
       &G::text,
       &G::uses_relevance},
      {{"fixed-axioms", "axioms about single timepoints"},
       &G::fixed_axioms,
       &G::text,
       &G::uses_relevance},
      {{"narrative", "events at known timepoints, their effects, which fluents may hold when"},
       &G::narrative,
       &G::text,
       &G::uses_relevance},
      {{"effects", "rows of the effect axioms of all other events"}, &G::effects, &G::text},
      {{"reachability", "what no effect can bring about is left out"},
       &G::reachability,
       &G::text,
       &G::uses_relevance},
      {{"meetings",
        "preconditions and exclusions; which fluents cannot hold when an event happens"},
       &G::meetings,
       &G::text,
       &G::looks_for_meetings},
      {{"axioms", "axioms that are left: about every timepoint, or about effects"},
       &G::other_axioms,
       &G::text},
      {{"completion", "completed atoms without a reason are false"}, &G::completion, &G::text},
      {{"trajectories", "DEC3 and DEC4"}, &G::trajectories, &G::text, &G::has_trajectories},
      {{"inertia", "DEC5 to DEC12 over the rows"}, &G::inertia, &G::text, &G::is_grounded},
      {{"invariants",
        "groups of fluents of which at most one, or exactly one, holds; atoms that always agree"},
       &G::invariants,
       &G::text,
       &G::looks_for_invariants},
      {{"unmentioned-atoms", "atoms in no formula are false (--compat decreasoner)"},
       &G::unmentioned_atoms,
       &G::text,
       &G::denies_unmentioned},
  }};
  return kPasses;
}

}  // namespace

std::vector<PassInfo> ground_passes() { return infos_of(Grounder::passes()); }

namespace {

base::Result<GroundModel> run_grounder(const TypedModel& typed, const GroundOptions& options,
                                       bool is_checked, base::DiagnosticSink& sink, PassLog* log) {
  const auto errors_before = sink.error_count();
  for (const auto& formula : typed.formulas) {
    if (formula.kind != FormulaKind::kAggregate || options.meaning == Meaning::kStandard) continue;
    return sink.error(codes::kAggregateOldMeaning, formula.source);
  }
  if (typed.options.founded && options.meaning != Meaning::kStandard) {
    return sink.error(codes::kFoundedOldMeaning, *typed.options.founded);
  }
  GroundTermStore terms;
  auto universe = Universe::make(typed, options, terms, sink);
  if (!universe) return sink.already_reported();
  GroundModel model(typed, std::move(terms), *std::move(universe));
  Grounder grounder(model, options, is_checked, sink);
  run_passes(Grounder::passes(), grounder, log);
  grounder.finish();
  if (sink.error_count() != errors_before) return sink.already_reported();
  return model;
}

}  // namespace

base::Result<GroundModel> ground_model(const TypedModel& typed, const GroundOptions& options,
                                       base::DiagnosticSink& sink, PassLog* log) {
  return run_grounder(typed, options, false, sink, log);
}

base::Status check_grounding(const TypedModel& typed, const GroundOptions& options,
                             base::DiagnosticSink& sink) {
  if (!run_grounder(typed, options, true, sink, nullptr)) return sink.already_reported();
  return base::Unit{};
}

}  // namespace parallax::compiler
