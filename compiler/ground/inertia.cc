#include <array>
#include <vector>

#include "compiler/ground/effects.h"

namespace parallax::compiler {
namespace {

/// Per fluent, for one timepoint t: what initiates, terminates and releases it.
using Triggers = std::array<std::vector<FormulaId>, 3>;

class InertiaWriter {
 public:
  InertiaWriter(GroundModel& model, const EffectRows& rows)
      : model_(model), typed_(model.typed()), rows_(rows) {
    for (std::size_t i = 0; i < typed_.symbols.size(); ++i) {
      const auto& symbol = typed_.symbols[typed_.symbols.id_at(i)];
      origins_.push_back(symbol.kind == SymbolKind::kFluent
                             ? model.add_origin(symbol.declared, "frame axiom")
                             : 0);
    }
  }

  void write() {
    for (std::uint32_t f = 0; f < model_.fluents().size(); ++f) assert_start(f);
    for (Timepoint t = 0; t < model_.horizon(); ++t) {
      std::vector<Triggers> triggers(model_.fluents().size());
      for (const auto& row : rows_.at(t)) {
        const auto trigger =
            model_.formulas().conjunction(model_.happens(row.event, t), row.condition);
        triggers[row.fluent][static_cast<std::size_t>(row.kind)].push_back(trigger);
        assert_effect(row, t, trigger);
      }
      for (std::uint32_t f = 0; f < triggers.size(); ++f) assert_frame(f, t, triggers[f]);
    }
  }

 private:
  const Symbol& symbol_of(std::uint32_t fluent) const {
    return typed_.symbols[model_.terms()[model_.fluents()[fluent]].symbol];
  }
  std::uint32_t origin_of(std::uint32_t fluent) const {
    return origins_[model_.terms()[model_.fluents()[fluent]].symbol.index()];
  }

  /// Inertia holds from the start unless the model says otherwise; a noninertial fluent is released
  /// at every timepoint.
  void assert_start(std::uint32_t fluent) {
    const auto& symbol = symbol_of(fluent);
    const auto origin = origin_of(fluent);
    if (symbol.noninertial) {
      for (Timepoint t = 0; t <= model_.horizon(); ++t) {
        model_.require(model_.released(fluent, t), origin);
      }
    } else if (!symbol.manual_release) {
      model_.require(~model_.released(fluent, 0), origin);
    }
  }

  /// DEC9 to DEC12.
  void assert_effect(const EffectRow& row, Timepoint t, FormulaId trigger) {
    auto& formulas = model_.formulas();
    const auto released = model_.released(row.fluent, t + 1);
    if (row.kind == EffectKind::kReleases) {
      model_.require(formulas.implication(trigger, released), row.origin);
      return;
    }
    const auto after = model_.holds(row.fluent, t + 1);
    const bool up = row.kind == EffectKind::kInitiates;
    model_.require(formulas.implication(trigger, up ? after : ~after), row.origin);
    model_.require(formulas.implication(trigger, ~released), row.origin);
  }

  /// DEC5 to DEC8: nothing changes unless a row says so.
  void assert_frame(std::uint32_t f, Timepoint t, const Triggers& triggers) {
    if (symbol_of(f).noninertial) return;
    auto& formulas = model_.formulas();
    const auto origin = origin_of(f);
    const auto any = [&](EffectKind kind) {
      return formulas.disjunction(triggers[static_cast<std::size_t>(kind)]);
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
  const EffectRows& rows_;
  std::vector<std::uint32_t> origins_;  // by symbol
};

}  // namespace

void assert_inertia(GroundModel& model, const EffectRows& rows) {
  InertiaWriter(model, rows).write();
}

}  // namespace parallax::compiler
