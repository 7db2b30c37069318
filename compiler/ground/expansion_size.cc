#include "compiler/ground/expansion_size.h"

#include <limits>

namespace parallax::compiler {
namespace {

constexpr auto kGreatest = std::numeric_limits<std::uint64_t>::max();

std::uint64_t times(std::uint64_t a, std::uint64_t b) {
  std::uint64_t product = 0;
  return __builtin_mul_overflow(a, b, &product) ? kGreatest : product;
}

std::uint64_t plus(std::uint64_t a, std::uint64_t b) {
  return a > kGreatest - b ? kGreatest : a + b;
}

std::uint64_t domain_product(const TypedModel& model, const Universe& universe,
                             const std::vector<VariableId>& variables) {
  std::uint64_t product = 1;
  for (const auto variable : variables) {
    product = times(product, universe.domain(model.variables[variable].sort).size());
  }
  return product;
}

}  // namespace

std::uint64_t expansion_size(const TypedModel& model, const Universe& universe,
                             TypedFormulaId formula) {
  // Iterative: a formula may be as deep as the parser allows.
  struct Visit {
    TypedFormulaId formula;
    std::uint64_t factor;
  };
  std::vector<Visit> open = {{formula, 1}};
  std::uint64_t size = 0;
  while (!open.empty()) {
    const auto [id, factor] = open.back();
    open.pop_back();
    const auto& node = model.formulas[id];
    const auto inner = times(factor, domain_product(model, universe, node.variables));
    if (node.kind == FormulaKind::kAtom || node.kind == FormulaKind::kCompare) {
      size = plus(size, inner);
    }
    for (const auto child : node.children) open.push_back({child, inner});
  }
  return size;
}

bool has_empty_quantifier(const TypedModel& model, const Universe& universe,
                          TypedFormulaId formula) {
  std::vector<TypedFormulaId> open = {formula};
  while (!open.empty()) {
    const auto& node = model.formulas[open.back()];
    open.pop_back();
    if (domain_product(model, universe, node.variables) == 0) return true;
    open.insert(open.end(), node.children.begin(), node.children.end());
  }
  return false;
}

std::uint64_t expansion_size(const TypedModel& model, const Universe& universe,
                             TypedFormulaId condition, const std::vector<VariableId>& variables) {
  return times(domain_product(model, universe, variables),
               plus(expansion_size(model, universe, condition), 1));
}

}  // namespace parallax::compiler
