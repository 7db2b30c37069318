#include "compiler/builtins/plan_builtins.h"

#include <algorithm>
#include <unordered_map>

#include "compiler/builtins/builtin_call.h"
#include "compiler/builtins/unknown_values.h"

namespace parallax::compiler {
namespace {

const std::vector<BuiltinEntry>& table() {
  static const auto all = [] {
    std::vector<BuiltinEntry> out;
    for (const auto part :
         {number_builtins(), list_builtins(), sequence_builtins(), pattern_builtins(),
          type_builtins(), symbol_builtins(), designator_builtins(), pose_part_builtins(),
          transform_builtins(), frame_builtins(), robot_builtins(), cell_builtins()}) {
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
  static const auto by_name = [] {
    std::unordered_map<std::string_view, std::uint32_t> out;
    for (const auto& builtin : plan_builtins()) {
      out.emplace(builtin.name, static_cast<std::uint32_t>(out.size()));
    }
    return out;
  }();
  const auto found = by_name.find(name);
  if (found == by_name.end()) return std::nullopt;
  return found->second;
}

BuiltinResult call_builtin(std::uint32_t builtin, std::span<const ValueId> arguments,
                           const FailureClasses& classes, std::int64_t location_samples,
                           DesignatorLinks& links, ValueStore& values) {
  const auto& entry = table()[builtin];
  const auto name = entry.builtin.name;
  if (auto term = with_unknown(name, arguments, values)) return *std::move(term);
  const BuiltinCall call{arguments, classes, values, links, location_samples, name};
  const bool fluents = std::any_of(arguments.begin(), arguments.end(),
                                   [&](ValueId id) { return is_fluent(values[id]); });
  return fluents && takes_fluents(name) ? fluent_network(call) : entry.function(call);
}

}  // namespace parallax::compiler
