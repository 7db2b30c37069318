#include "compiler/ground/grounder.h"

#include <algorithm>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/formula/formula.h"
#include "compiler/ground/completion.h"
#include "compiler/ground/effects.h"
#include "compiler/ground/expansion_size.h"
#include "compiler/ground/formula_grounder.h"
#include "compiler/ground/invariants.h"
#include "compiler/ground/narrative.h"
#include "compiler/ground/possible_atoms.h"
#include "compiler/ground/rigid.h"
#include "compiler/ground/time_profile.h"

namespace parallax::compiler {

using base::DiagnosticCode;

namespace {

/// Grounds in the order in which knowledge grows: what does not depend on time, what is said of
/// single timepoints, the narrative with the states it leads through, and then the rest, joined
/// over what is still possible.
class Grounder {
 public:
  Grounder(GroundModel& model, const GroundOptions& options, base::DiagnosticSink& sink)
      : model_(model),
        typed_(model.typed()),
        options_(options),
        sink_(sink),
        grounder_(model, options, sink),
        possible_(model),
        rows_(model.fluents().size()),
        effects_(model, grounder_, rows_),
        completion_(model, options.meaning) {
    for (const auto& axiom : typed_.axioms)
      profiles_.push_back(time_profile(typed_, axiom.formula));
  }

  void run() {
    standard_ = options_.meaning == Meaning::kStandard;
    relevance_ = standard_ && options_.relevance;
    if (!relevance_) {
      for (const auto& effect : typed_.effects) effects_.ground(effect);
      grounder_.use_effects(rows_);
      assert_axioms([](const TimeProfile&) { return true; });
      return finish();
    }
    grounder_.use_possible(&possible_);
    assert_axioms([](const TimeProfile& p) { return p.shape == TimeShape::kRigid; });
    tabulate_predicates(model_, completion_, possible_);
    grounder_.use_possible(&possible_);
    assert_axioms([](const TimeProfile& p) { return p.shape == TimeShape::kFixed; });
    Narrative narrative(model_, possible_, rows_, effects_, options_.keep_unreachable);
    // A formula may ask for the effects of an event that never happens.
    if (!some_axiom_mentions_effects()) narrative.schedule(completion_);
    grounder_.use_possible(&possible_);
    narrative.walk();
    for (const auto& effect : typed_.effects) {
      if (!effects_.is_scheduled(effect)) effects_.ground(effect);
    }
    drop_unreachable(model_, possible_, rows_, options_.keep_unreachable);
    grounder_.use_possible(&possible_);
    grounder_.use_effects(rows_);
    assert_axioms([](const TimeProfile& p) {
      return p.shape == TimeShape::kUniform || p.shape == TimeShape::kMixed;
    });
    finish();
  }

 private:
  void finish() {
    completion_.write();
    assert_trajectories(model_, rows_, grounder_);
    assert_inertia(model_, rows_, standard_ && options_.templates);
    if (standard_ && options_.templates && options_.invariants) add_invariants(model_, rows_);
    if (!standard_) deny_unmentioned();
    grounder_.start({});  // charges what the last axiom took
  }

  bool some_axiom_mentions_effects() const {
    return std::any_of(typed_.axioms.begin(), typed_.axioms.end(),
                       [](const Axiom& axiom) { return axiom.mentions_effects; });
  }

  template <typename Wanted>
  void assert_axioms(const Wanted& wanted) {
    for (std::size_t i = 0; i < typed_.axioms.size(); ++i) {
      auto profile = profiles_[i];
      // Axioms over effects wait for the effects.
      if (typed_.axioms[i].mentions_effects) profile.shape = TimeShape::kMixed;
      if (wanted(profile)) assert_axiom(typed_.axioms[i], profile);
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
    grounder_.start(axiom.source);
    const bool always = profile.shape == TimeShape::kUniform && standard_ && options_.templates &&
                        !waits_for_scheduled_event(axiom) &&
                        !has_empty_quantifier(typed_, model_.universe(), axiom.formula);
    std::optional<FormulaId> formula;
    if (!always) {
      formula = grounder_.ground(axiom.formula);
    } else if (profile.width <= model_.horizon()) {
      possible_.set_timeless(true);
      grounder_.bind(profile.variable, model_.terms().integer(profile.back));
      formula = grounder_.ground(axiom.formula);
      grounder_.unbind(profile.variable);
      possible_.set_timeless(false);
    }
    if (grounder_.failed()) return;
    const auto falsity = model_.formulas().falsity();
    if (!formula) {
      sink_.error(DiagnosticCode::kNothingToSay, axiom.source, model_.horizon());
    } else if (*formula == falsity && !standard_) {
      sink_.warning(DiagnosticCode::kFalseFormulaDropped, axiom.source);
    } else if (*formula == falsity && is_false_whatever_happens(axiom)) {
      sink_.error(DiagnosticCode::kFormulaIsFalse, axiom.source);
    } else {
      const auto origin = model_.add_origin(axiom.source, OriginKind::kAxiom);
      if (always) {
        model_.require_always(*formula, origin, profile.width);
      } else {
        model_.require(*formula, origin);
      }
      // A definition over effects (ECCausal, Clipped) says what happens, it is no reason for it.
      if (axiom.mentions_effects) return;
      completion_.note(axiom.label, *formula, always ? profile.width : Constraint::kOnce);
    }
  }

  /// False in itself, or only with what is already known of the model?
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

  /// In the 2005 reasoner's meaning an atom that stands in no formula is false.
  void deny_unmentioned() {
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

  GroundModel& model_;
  const TypedModel& typed_;
  const GroundOptions& options_;
  base::DiagnosticSink& sink_;
  FormulaGrounder grounder_;
  PossibleAtoms possible_;
  EffectRows rows_;
  EffectGrounder effects_;
  CompletionWriter completion_;
  std::vector<TimeProfile> profiles_;  // by axiom
  bool standard_ = true, relevance_ = true;
};

}  // namespace

base::Result<GroundModel> ground_model(const TypedModel& typed, const GroundOptions& options,
                                       base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  GroundTermStore terms;
  auto universe = Universe::make(typed, options, terms, sink);
  if (!universe) return sink.already_reported();
  GroundModel model(typed, std::move(terms), *std::move(universe));
  Grounder(model, options, sink).run();
  if (sink.error_count() != errors_before) return sink.already_reported();
  return model;
}

}  // namespace parallax::compiler
