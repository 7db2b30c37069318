#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "compiler/base/codes/names.h"
#include "compiler/lint/rules.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

namespace {

struct Hull {
  std::int64_t lower = 0;
  std::int64_t upper = 0;
};

std::optional<Hull> hull(SortDomains& domains, SortId sort) {
  std::optional<Hull> found;
  for (const auto& range : domains.ranges(sort)) {
    if (!found) found = Hull{range.lower, range.upper};
    found->lower = std::min(found->lower, range.lower);
    found->upper = std::max(found->upper, range.upper);
  }
  return found;
}

/// "1 to 4, 7"
std::string values(SortDomains& domains, SortId sort) {
  constexpr std::size_t kMostRanges = 4;
  std::string out;
  const auto& ranges = domains.ranges(sort);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (i != 0) out += ", ";
    if (i == kMostRanges) return out + "...";
    const auto& range = ranges[i];
    out += range.lower == range.upper ? fmt::format("{}", range.lower)
                                      : fmt::format("{} to {}", range.lower, range.upper);
  }
  return out;
}

/// "equal to 9" if no value of the hull compares so with `number`.
std::optional<std::string> never(const Hull& hull, CompareOp op, std::int64_t number,
                                 bool contained) {
  switch (op) {
    case CompareOp::kEqual:
    case CompareOp::kNotEqual:
      if (!contained) return fmt::format("{}", number);
      return std::nullopt;
    case CompareOp::kLess:
      if (hull.lower >= number) return fmt::format("below {}", number);
      return std::nullopt;
    case CompareOp::kLessEqual:
      if (hull.lower > number) return fmt::format("{} or below", number);
      return std::nullopt;
    case CompareOp::kGreater:
      if (hull.upper <= number) return fmt::format("above {}", number);
      return std::nullopt;
    case CompareOp::kGreaterEqual:
      if (hull.upper < number) return fmt::format("{} or above", number);
      return std::nullopt;
  }
  return std::nullopt;
}

/// Reports a comparison of a variable with a number. True if it did.
bool check_comparison(const LintContext& context, SortDomains& domains,
                      const TypedFormula& formula) {
  const auto& model = context.model();
  const bool turned = model.terms[formula.terms[0]].kind == TermKind::kInteger;
  const Term& variable = model.terms[formula.terms[turned ? 1 : 0]];
  const Term& number = model.terms[formula.terms[turned ? 0 : 1]];
  if (variable.kind != TermKind::kVariable || number.kind != TermKind::kInteger) return false;
  const auto sort = model.variables[variable.variable].sort;
  const auto bounds = hull(domains, sort);
  if (!model.sorts[sort].integer || !bounds) return false;
  const auto what = never(*bounds, turned ? mirrored(formula.compare) : formula.compare,
                          number.integer, domains.contains(sort, number.integer));
  if (!what) return false;
  context.sink()
      .warning(codes::kComparedOutsideRange, formula.source,
               model.variables[variable.variable].name, *what, model.sorts[sort].name,
               values(domains, sort))
      .note(domains.ranges(sort).front().declared, "the range is declared here");
  return true;
}

}  // namespace

void find_single_value_ranges(const LintContext& context) {
  const auto& model = context.model();
  SortDomains domains(model);
  for (std::size_t i = 0; i < model.sorts.size(); ++i) {
    const auto id = model.sorts.id_at(i);
    const auto& sort = model.sorts[id];
    // Every model of the 2005 reasoner had to give `offset` a range, used or not.
    const bool offset = context.built_in(sort.declared) && id != model.core.time;
    if (sort.ranges.empty() || (offset && model.trajectories.empty())) continue;
    const auto bounds = hull(domains, id);
    const auto& declared = sort.ranges.front().declared;
    if (bounds->lower != bounds->upper || context.built_in(declared)) continue;
    context.sink().warning(codes::kSingleValueRange, declared, sort.name, bounds->lower);
  }
}

void find_short_offset_ranges(const LintContext& context) {
  const auto& model = context.model();
  SortDomains domains(model);
  if (!model.core.time) return;
  const auto time = hull(domains, *model.core.time);
  if (!time) return;
  std::vector<SortId> reported;
  for (const auto& path : model.trajectories) {
    const Term& offset = model.terms[path.offset];
    if (offset.kind != TermKind::kVariable) continue;
    const auto sort = model.variables[offset.variable].sort;
    const auto bounds = hull(domains, sort);
    // Timepoints begin at 0, which grounding requires; other ranges are its business.
    if (!bounds || time->lower != 0 || bounds->upper >= time->upper) continue;
    if (std::find(reported.begin(), reported.end(), sort) != reported.end()) continue;
    reported.push_back(sort);
    context.sink()
        .warning(codes::kShortOffsetRange, domains.ranges(sort).front().declared,
                 model.sorts[sort].name, bounds->upper, time->upper)
        .note(path.source, "the trajectory stands here");
  }
}

void find_comparisons_outside_ranges(const LintContext& context) {
  const auto& model = context.model();
  SortDomains domains(model);
  context.for_each_root([&](TypedFormulaId root) {
    if (context.built_in(model.formulas[root].source)) return;
    bool reported = false;
    for_each_formula(model, root, [&](TypedFormulaId id) {
      const auto& formula = model.formulas[id];
      if (reported || formula.kind != FormulaKind::kCompare) return;
      reported = check_comparison(context, domains, formula);
    });
  });
}

}  // namespace parallax::compiler
