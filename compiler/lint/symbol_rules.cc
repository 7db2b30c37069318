#include <vector>

#include "compiler/base/codes/names.h"
#include "compiler/lint/rules.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

namespace {

/// Visits the inertial fluents of the user's texts that no trajectory determines.
template <typename Visit>
void for_each_inertial_fluent(const LintContext& context, const Visit& visit) {
  const auto& symbols = context.model().symbols;
  for (std::size_t i = 0; i < symbols.size(); ++i) {
    const auto id = symbols.id_at(i);
    const auto& symbol = symbols[id];
    const bool inertial = symbol.kind == SymbolKind::kFluent && !symbol.noninertial &&
                          !symbol.manual_release && !context.is_target(id);
    if (!inertial || context.built_in(symbol.declared)) continue;
    // A released fluent changes without an event of these two kinds.
    if (context.affected(id, EffectKind::kReleases)) continue;
    visit(id, context.affected(id, EffectKind::kInitiates),
          context.affected(id, EffectKind::kTerminates));
  }
}

/// By sort: does anything depend on it?
class SortUse {
 public:
  explicit SortUse(const LintContext& context)
      : context_(context), model_(context.model()), domains_(model_), used_(model_.sorts.size()) {
    mark_direct();
    spread();
  }
  bool used(SortId sort) const { return used_[sort.index()]; }
  bool has_elements(SortId sort) { return domains_.has_elements(sort); }

 private:
  void mark_direct() {
    for (const auto& symbol : model_.symbols) {
      for (const auto sort : symbol.arguments) used_[sort.index()] = true;
      if (symbol.result) used_[symbol.result->index()] = true;
    }
    for (std::size_t i = 0; i < used_.size(); ++i) {
      if (context_.has_variable(model_.sorts.id_at(i))) used_[i] = true;
    }
    for (std::size_t i = 0; i < model_.objects.size(); ++i) {
      const auto id = model_.objects.id_at(i);
      if (!context_.mentioned(id)) continue;
      for (const auto sort : model_.objects[id].sorts) used_[sort.index()] = true;
    }
  }

  /// A sort above a used one orders the model; one below a used one feeds it, if it has elements.
  void spread() {
    bool again = true;
    while (again) {
      again = false;
      for (std::size_t i = 0; i < used_.size(); ++i) {
        const auto sort = model_.sorts.id_at(i);
        for (const auto parent : model_.sorts[sort].parents) {
          if (context_.built_in(model_.sorts[parent].declared)) continue;
          const bool feeds = used(parent) && !used(sort) && domains_.has_elements(sort);
          const bool orders = used(sort) && !used(parent);
          if (!feeds && !orders) continue;
          used_[feeds ? i : parent.index()] = true;
          again = true;
        }
      }
    }
  }

  const LintContext& context_;
  const TypedModel& model_;
  SortDomains domains_;
  std::vector<bool> used_;
};

}  // namespace

void find_fluents_without_effects(const LintContext& context) {
  for_each_inertial_fluent(context, [&](SymbolId id, bool initiated, bool terminated) {
    if (initiated || terminated) return;
    const auto& symbol = context.model().symbols[id];
    context.sink().warning(codes::kFluentWithoutEffects, symbol.declared, symbol.name);
  });
}

void find_fluents_that_change_one_way(const LintContext& context) {
  for_each_inertial_fluent(context, [&](SymbolId id, bool initiated, bool terminated) {
    if (initiated == terminated) return;
    const auto& symbol = context.model().symbols[id];
    context.sink().warning(codes::kFluentOneWay, symbol.declared, symbol.name,
                           initiated ? "begin" : "end", initiated ? "terminates" : "initiates");
  });
}

void find_events_without_effect(const LintContext& context) {
  const auto& symbols = context.model().symbols;
  for (std::size_t i = 0; i < symbols.size(); ++i) {
    const auto id = symbols.id_at(i);
    const auto& symbol = symbols[id];
    if (symbol.kind != SymbolKind::kEvent || context.built_in(symbol.declared)) continue;
    if (context.mentioned(id) || context.has_effect(id)) continue;
    context.sink().warning(codes::kEventWithoutEffect, symbol.declared, symbol.name);
  }
}

void find_unused_sorts(const LintContext& context) {
  const SortUse use(context);
  const auto& sorts = context.model().sorts;
  for (std::size_t i = 0; i < sorts.size(); ++i) {
    const auto& sort = sorts[sorts.id_at(i)];
    if (use.used(sorts.id_at(i)) || context.built_in(sort.declared)) continue;
    context.sink().warning(codes::kUnusedSort, sort.declared, sort.name);
  }
}

void find_empty_sorts(const LintContext& context) {
  SortUse use(context);
  const auto& sorts = context.model().sorts;
  for (std::size_t i = 0; i < sorts.size(); ++i) {
    const auto id = sorts.id_at(i);
    const auto& sort = sorts[id];
    // An integer sort without a range is an error where it is used.
    if (sort.integer || context.built_in(sort.declared)) continue;
    if (!use.used(id) || use.has_elements(id)) continue;
    context.sink().warning(codes::kEmptySort, sort.declared, sort.name);
  }
}

}  // namespace parallax::compiler
