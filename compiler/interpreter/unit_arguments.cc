#include "compiler/interpreter/unit_arguments.h"

#include <fmt/core.h>

#include <algorithm>

namespace parallax::compiler {

std::variant<std::vector<ValueId>, std::string> unit_arguments(const PlanUnit& unit,
                                                               std::span<const ValueId> given,
                                                               ValueStore& values) {
  std::vector<ValueId> out;
  std::size_t next = 0;
  const auto is_key = [&](ValueId id, std::string_view name) {
    const auto& value = values[id];
    return value.kind == ValueKind::kSymbol && value.keyword && value.text == name;
  };
  std::size_t keys_from = given.size();
  for (const auto& parameter : unit.signature) {
    switch (parameter.kind) {
      case UnitParameter::Kind::kRequired:
        if (next == given.size()) return fmt::format("no value for `{}`", parameter.name);
        out.push_back(given[next++]);
        break;
      case UnitParameter::Kind::kOptional:
        out.push_back(next < given.size() ? given[next++] : parameter.default_value);
        break;
      case UnitParameter::Kind::kRest:
        out.push_back(
            values.list({given.begin() + static_cast<std::ptrdiff_t>(next), given.end()}));
        keys_from = next;
        next = given.size();
        break;
      case UnitParameter::Kind::kKey: {
        keys_from = std::min(keys_from, next);
        next = given.size();
        auto value = parameter.default_value;
        for (auto i = keys_from; i + 1 < given.size(); i += 2) {
          if (!is_key(given[i], parameter.keyword)) continue;
          value = given[i + 1];
          break;  // if a key is given twice, the first counts
        }
        out.push_back(value);
        break;
      }
    }
  }
  const bool has_keys =
      std::any_of(unit.signature.begin(), unit.signature.end(),
                  [](const UnitParameter& one) { return one.kind == UnitParameter::Kind::kKey; });
  if (!has_keys && !unit.other_keys) {
    if (next < given.size())
      return fmt::format("unexpected argument {}", values.print(given[next]));
    return out;
  }
  if (!has_keys) keys_from = next;
  for (auto i = keys_from; i < given.size(); i += 2) {
    const auto& key = values[given[i]];
    const bool keyed = key.kind == ValueKind::kSymbol && key.keyword && i + 1 < given.size();
    const bool known =
        keyed &&
        std::any_of(unit.signature.begin(), unit.signature.end(), [&](const UnitParameter& one) {
          return one.kind == UnitParameter::Kind::kKey && one.keyword == key.text;
        });
    if (known || (keyed && unit.other_keys)) continue;
    return fmt::format("unexpected argument {}", values.print(given[i]));
  }
  return out;
}

}  // namespace parallax::compiler
