#include "harness/world/arguments.h"

#include <algorithm>
#include <cmath>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

const ArgumentSpec* find_argument(const ControllerSpec& spec, std::string_view name) {
  const auto found = std::find_if(spec.arguments.begin(), spec.arguments.end(),
                                  [&](const ArgumentSpec& one) { return one.name == name; });
  return found == spec.arguments.end() ? nullptr : &*found;
}

std::string quoted(std::string_view name) { return "`" + std::string(name) + "`"; }

}  // namespace

std::optional<double> as_number(const Value& value) {
  if (const double* number = std::get_if<double>(&value)) return *number;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  return std::nullopt;
}

std::variant<Arguments, std::string> Arguments::check(const ControllerSpec& spec,
                                                      const State& given,
                                                      const WorldLayout& layout) {
  Arguments arguments(spec);
  for (const auto& [name, value] : given) {
    const ArgumentSpec* known = find_argument(spec, name);
    if (known == nullptr) return quoted(spec.name) + " takes no argument " + quoted(name);
    if (known->unit == "body") {
      const auto* text = std::get_if<std::string>(&value);
      const auto body = text == nullptr ? std::nullopt : layout.find_body(*text);
      if (!body || !layout.is_free[body->index()]) {
        return "argument " + quoted(name) + " does not name a free body";
      }
      arguments.bodies_.emplace(name, *body);
      continue;
    }
    const std::optional<double> number = as_number(value);
    if (!number || !std::isfinite(*number)) {
      return "argument " + quoted(name) + " is not a finite number";
    }
    if (known->positive && *number <= 0.0) return "argument " + quoted(name) + " is not positive";
    arguments.numbers_.emplace(name, *number);
  }
  for (const ArgumentSpec& one : spec.arguments) {
    if (!one.required || given.find(one.name) != given.end()) continue;
    return quoted(spec.name) + " needs the argument " + quoted(one.name);
  }
  return arguments;
}

double Arguments::number(std::string_view name) const {
  if (const auto found = numbers_.find(name); found != numbers_.end()) return found->second;
  const ArgumentSpec* known = find_argument(*spec_, name);
  PARALLAX_REQUIRE(known != nullptr, "an argument of the controller's table");
  return known->fallback;
}

std::optional<BodyId> Arguments::body(std::string_view name) const {
  const auto found = bodies_.find(name);
  if (found == bodies_.end()) return std::nullopt;
  return found->second;
}

}  // namespace parallax::harness
