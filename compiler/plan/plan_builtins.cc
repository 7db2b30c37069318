#include "compiler/plan/plan_builtins.h"

#include "compiler/plan/builtin_call.h"
#include "compiler/plan/unknown_values.h"

namespace parallax::compiler {
namespace {

const std::vector<BuiltinEntry>& table() {
  static const auto all = [] {
    std::vector<BuiltinEntry> out;
    for (const auto part :
         {number_builtins(), list_builtins(), designator_builtins(), pose_part_builtins(),
          transform_builtins(), frame_builtins(), robot_builtins()}) {
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
  const auto& entry = table()[builtin];
  const auto name = entry.builtin.name;
  if (auto term = with_unknown(name, arguments, values)) return *std::move(term);
  return entry.function(BuiltinCall{arguments, classes, values, links, location_samples, name});
}

}  // namespace parallax::compiler
