#include <vector>

#include "compiler/ground/effects.h"

namespace parallax::compiler {
namespace {

/// Writes the axioms of each fluent once for all timepoints, or timepoint by timepoint if some
/// event changes it at single timepoints only.
class InertiaWriter {
 public:
  InertiaWriter(GroundModel& model, const EffectRows& rows, bool templates)
      : model_(model), rows_(rows), templates_(templates) {
    const auto& symbols = model.typed().symbols;
    for (std::size_t i = 0; i < symbols.size(); ++i) {
      const auto& symbol = symbols[symbols.id_at(i)];
      origins_.push_back(symbol.kind == SymbolKind::kFluent
                             ? model.add_origin(symbol.declared, "frame axiom")
                             : 0);
    }
  }

  void write() {
    if (model_.horizon() > 0) {
      for (const auto& row : rows_.always()) assert_effect(row, 0, true);
    }
    for (const auto& [t, rows] : rows_.single()) {
      for (const auto& row : rows) assert_effect(row, t, false);
    }
    for (std::uint32_t f = 0; f < model_.fluents().size(); ++f) {
      if (!model_.may_hold(f) && !model_.can_be_released(f)) continue;
      assert_start(f);
      if (model_.fluent_symbol(f).noninertial || model_.horizon() == 0) continue;
      if (templates_ && rows_.is_uniform(f)) {
        assert_frame(f, 0, true);
        continue;
      }
      for (Timepoint t = 0; t < model_.horizon(); ++t) assert_frame(f, t, false);
    }
  }

 private:
  std::uint32_t origin_of(std::uint32_t fluent) const {
    return origins_[model_.terms()[model_.fluents()[fluent]].symbol.index()];
  }
  void require(FormulaId formula, std::uint32_t origin, bool always) {
    if (!always) return model_.require(formula, origin);
    if (templates_) return model_.require_always(formula, origin, 1);
    for (Timepoint t = 0; t < model_.horizon(); ++t) {
      model_.require(model_.shifted(formula, t), origin);
    }
  }

  /// Inertia holds from the start unless the model says otherwise; a noninertial fluent is released
  /// at every timepoint.
  void assert_start(std::uint32_t fluent) {
    const auto& symbol = model_.fluent_symbol(fluent);
    const auto origin = origin_of(fluent);
    const auto released = model_.released(fluent, 0);
    if (symbol.noninertial && templates_) {
      model_.require_always(released, origin, 0);
    } else if (symbol.noninertial) {
      for (Timepoint t = 0; t <= model_.horizon(); ++t) {
        model_.require(model_.released(fluent, t), origin);
      }
    } else if (!symbol.manual_release) {
      model_.require(~released, origin);
    }
  }

  /// DEC9 to DEC12.
  void assert_effect(const EffectRow& row, Timepoint t, bool always) {
    auto& formulas = model_.formulas();
    const auto trigger = formulas.conjunction(model_.happens(row.event, t), row.condition);
    const auto released = model_.released(row.fluent, t + 1);
    if (row.kind == EffectKind::kReleases) {
      require(formulas.implication(trigger, released), row.origin, always);
      return;
    }
    const auto after = model_.holds(row.fluent, t + 1);
    const bool up = row.kind == EffectKind::kInitiates;
    require(formulas.implication(trigger, up ? after : ~after), row.origin, always);
    require(formulas.implication(trigger, ~released), row.origin, always);
  }

  /// DEC5 to DEC8: nothing changes unless a row says so.
  void assert_frame(std::uint32_t f, Timepoint t, bool always) {
    auto& formulas = model_.formulas();
    const auto origin = origin_of(f);
    const auto initiated = rows_.changed(EffectKind::kInitiates, f, t, model_);
    const auto terminated = rows_.changed(EffectKind::kTerminates, f, t, model_);
    const auto releases = rows_.changed(EffectKind::kReleases, f, t, model_);
    const auto before = model_.holds(f, t);
    const auto after = model_.holds(f, t + 1);
    const auto released_before = model_.released(f, t);
    const auto released_after = model_.released(f, t + 1);
    require(formulas.disjunction({~before, after, released_after, terminated}), origin, always);
    require(formulas.disjunction({before, ~after, released_after, initiated}), origin, always);
    require(formulas.disjunction({~released_before, released_after, initiated, terminated}), origin,
            always);
    require(formulas.disjunction({released_before, ~released_after, releases}), origin, always);
  }

  GroundModel& model_;
  const EffectRows& rows_;
  bool templates_;
  std::vector<std::uint32_t> origins_;  // by symbol
};

}  // namespace

void assert_inertia(GroundModel& model, const EffectRows& rows, bool templates) {
  InertiaWriter(model, rows, templates).write();
}

}  // namespace parallax::compiler
