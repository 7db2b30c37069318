#include "compiler/ground/effects.h"

#include <algorithm>
#include <array>

namespace parallax::compiler {
namespace {

/// Per fluent, for one timepoint t: what initiates, terminates and releases it.
struct Triggers {
  std::array<std::vector<FormulaId>, 3> by_kind;
};

class EffectWriter {
 public:
  EffectWriter(GroundModel& model, FormulaGrounder& grounder)
      : model_(model), typed_(model.typed()), grounder_(grounder) {
    for (const auto& effect : typed_.effects) {
      effect_origins_.push_back(model.add_origin(effect.source, "effect axiom"));
    }
    for (std::size_t i = 0; i < typed_.symbols.size(); ++i) {
      const auto& symbol = typed_.symbols[typed_.symbols.id_at(i)];
      frame_origins_.push_back(symbol.kind == SymbolKind::kFluent
                                   ? model.add_origin(symbol.declared, "frame axiom")
                                   : 0);
    }
  }

  void write() {
    for (std::uint32_t f = 0; f < model_.fluents().size(); ++f) assert_start(f);
    for (Timepoint t = 0; t < model_.horizon(); ++t) {
      std::vector<Triggers> triggers(model_.fluents().size());
      for (std::size_t i = 0; i < typed_.effects.size(); ++i) {
        grounder_.start(typed_.effects[i].source);
        expand(typed_.effects[i], effect_origins_[i], t, triggers);
        if (grounder_.failed()) return;
      }
      for (std::uint32_t f = 0; f < triggers.size(); ++f) assert_frame(f, t, triggers[f]);
    }
  }

 private:
  const Symbol& symbol_of(std::uint32_t fluent) const {
    return typed_.symbols[model_.terms()[model_.fluents()[fluent]].symbol];
  }
  std::uint32_t frame_origin(std::uint32_t fluent) const {
    return frame_origins_[model_.terms()[model_.fluents()[fluent]].symbol.index()];
  }

  /// Inertia holds from the start unless the model says otherwise; a noninertial fluent is released
  /// at every timepoint.
  void assert_start(std::uint32_t fluent) {
    const auto& symbol = symbol_of(fluent);
    const auto origin = frame_origin(fluent);
    if (symbol.noninertial) {
      for (Timepoint t = 0; t <= model_.horizon(); ++t) {
        model_.require(model_.released(fluent, t), origin);
      }
    } else if (!symbol.manual_release) {
      model_.require(~model_.released(fluent, 0), origin);
    }
  }

  /// All instances of one effect axiom at timepoint t.
  void expand(const EffectAxiom& effect, std::uint32_t origin, Timepoint t,
              std::vector<Triggers>& triggers) {
    const auto& time_term = typed_.terms[effect.time];
    const auto now = model_.terms().integer(t);
    std::vector<VariableId> open;
    for (const auto variable : effect.variables) {
      if (time_term.kind == TermKind::kVariable && variable == time_term.variable) {
        grounder_.bind(variable, now);
      } else {
        open.push_back(variable);
      }
    }
    std::vector<std::size_t> odometer(open.size(), 0);
    for (const auto variable : open) {
      const auto& domain = model_.universe().domain(typed_.variables[variable].sort);
      if (domain.empty()) return;
      grounder_.bind(variable, domain[0]);
    }
    do {
      if (!grounder_.spend(1)) return;
      instance(effect, origin, now, t, triggers);
    } while (!grounder_.failed() && advance(open, odometer));
  }

  bool advance(const std::vector<VariableId>& variables, std::vector<std::size_t>& odometer) {
    for (std::size_t i = variables.size(); i-- > 0;) {
      const auto& domain = model_.universe().domain(typed_.variables[variables[i]].sort);
      if (++odometer[i] < domain.size()) {
        grounder_.bind(variables[i], domain[odometer[i]]);
        return true;
      }
      odometer[i] = 0;
      grounder_.bind(variables[i], domain[0]);
    }
    return false;
  }

  void instance(const EffectAxiom& effect, std::uint32_t origin, GroundTermId now, Timepoint t,
                std::vector<Triggers>& triggers) {
    if (grounder_.term(effect.time) != now) return;
    const auto event = grounder_.term(effect.event);
    const auto fluent = grounder_.term(effect.fluent);
    if (!event || !fluent) return;
    const auto e = model_.event_number(*event);
    const auto f = model_.fluent_number(*fluent);
    if (!e || !f) return;
    const auto condition = grounder_.ground(effect.condition);
    if (!condition) return;
    auto& formulas = model_.formulas();
    const auto trigger = formulas.conjunction(model_.happens(*e, t), *condition);
    if (trigger == formulas.falsity()) return;
    triggers[*f].by_kind[static_cast<std::size_t>(effect.kind)].push_back(trigger);
    assert_effect(effect.kind, *f, t, trigger, origin);
  }

  /// DEC9 to DEC12.
  void assert_effect(EffectKind kind, std::uint32_t f, Timepoint t, FormulaId trigger,
                     std::uint32_t origin) {
    auto& formulas = model_.formulas();
    const auto released = model_.released(f, t + 1);
    if (kind == EffectKind::kReleases) {
      model_.require(formulas.implication(trigger, released), origin);
      return;
    }
    const auto after = model_.holds(f, t + 1);
    const bool up = kind == EffectKind::kInitiates;
    model_.require(formulas.implication(trigger, up ? after : ~after), origin);
    model_.require(formulas.implication(trigger, ~released), origin);
  }

  /// DEC5 to DEC8: nothing changes unless a row says so.
  void assert_frame(std::uint32_t f, Timepoint t, const Triggers& triggers) {
    if (symbol_of(f).noninertial) return;
    auto& formulas = model_.formulas();
    const auto origin = frame_origin(f);
    const auto any = [&](EffectKind kind) {
      return formulas.disjunction(triggers.by_kind[static_cast<std::size_t>(kind)]);
    };
    const auto initiated = any(EffectKind::kInitiates);
    const auto terminated = any(EffectKind::kTerminates);
    const auto releases = any(EffectKind::kReleases);
    const auto before = model_.holds(f, t);
    const auto after = model_.holds(f, t + 1);
    const auto released_before = model_.released(f, t);
    const auto released_after = model_.released(f, t + 1);
    model_.require(formulas.disjunction({~before, after, released_after, terminated}), origin);
    model_.require(formulas.disjunction({before, ~after, released_after, initiated}), origin);
    model_.require(formulas.disjunction({~released_before, released_after, initiated, terminated}),
                   origin);
    model_.require(formulas.disjunction({released_before, ~released_after, releases}), origin);
  }

  GroundModel& model_;
  const TypedModel& typed_;
  FormulaGrounder& grounder_;
  std::vector<std::uint32_t> effect_origins_;
  std::vector<std::uint32_t> frame_origins_;  // by symbol
};

}  // namespace

void assert_effects(GroundModel& model, FormulaGrounder& grounder) {
  EffectWriter(model, grounder).write();
}

}  // namespace parallax::compiler
