#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "harness/world/controller_table.h"
#include "harness/world/simulator.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {

/// The arguments of one action, checked against the controller's table.
class Arguments {
 public:
  /// A message instead if an argument is unknown, missing, of the wrong kind or not finite.
  static std::variant<Arguments, std::string> check(const ControllerSpec& spec, const State& given,
                                                    const WorldLayout& layout);

  /// `name` must be in the table; its fallback (possibly NaN) unless given.
  double number(std::string_view name) const;
  /// None unless given.
  std::optional<BodyId> body(std::string_view name) const;

 private:
  explicit Arguments(const ControllerSpec& spec) : spec_(&spec) {}
  const ControllerSpec* spec_;  // of the static table
  std::map<std::string, double, std::less<>> numbers_;
  std::map<std::string, BodyId, std::less<>> bodies_;
};

/// A number whether it was written as 1 or as 1.0.
std::optional<double> as_number(const Value& value);

}  // namespace parallax::harness
