#include "compiler/plan/plan_builtins.h"

#include "compiler/plan/builtin_call.h"

namespace parallax::compiler {
namespace {

const std::vector<BuiltinEntry>& table() {
  static const auto all = [] {
    std::vector<BuiltinEntry> out;
    for (const auto part :
         {number_builtins(), list_builtins(), pose_builtins(), designator_builtins()}) {
      out.insert(out.end(), part.begin(), part.end());
    }
    return out;
  }();
  return all;
}

}  // namespace

std::span<const PlanBuiltin> plan_builtins() {
  static const auto builtins = [] {
    std::vector<PlanBuiltin> out;
    for (const auto& entry : table()) out.push_back(entry.builtin);
    return out;
  }();
  return builtins;
}

std::optional<std::uint32_t> find_builtin(std::string_view name) {
  const auto& all = plan_builtins();
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) return i;
  }
  return std::nullopt;
}

BuiltinResult call_builtin(std::uint32_t builtin, std::span<const ValueId> arguments,
                           const FailureClasses& classes, std::int64_t location_samples,
                           DesignatorLinks& links, ValueStore& values) {
  return table()[builtin].function(
      BuiltinCall{arguments, classes, values, links, location_samples});
}

}  // namespace parallax::compiler
