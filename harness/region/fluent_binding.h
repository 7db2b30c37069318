#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/region/region.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// A ground fluent as the model prints it, "RobotIn(r1)", taken apart.
struct GroundFluent {
  std::string text;
  std::string symbol;
  std::vector<std::string> arguments;
};
/// Inverse of printing without blanks; nested terms stay one argument.
GroundFluent ground_fluent(std::string_view text);

/// "{0}.held" with the fluent's arguments put in. A number beyond the last one stays as it is.
std::string with_arguments(std::string_view pattern, const GroundFluent& fluent);

/// The truth of a fluent in a continuous state.
enum class Reading : std::uint8_t { kFails, kHolds, kNeither };

/// Fluent F(.., r, ..) holds iff `body` lies in region r: argument number `region_argument` names
/// the region. `unless` / `only_if` are boolean variables that must be false / true besides.
/// `upright` asks for the orientation, too: a carton that lies on its side is not placed.
struct InsideBinding {
  std::string body;  // "box" reads box.x, box.y, ...; "{0}" stands for argument 0
  std::size_t region_argument = 0;
  std::optional<std::string> unless;  // "box.held"
  std::optional<std::string> only_if;
  bool drawn = true;  // false: a reset puts the body there by itself, nothing is drawn
  /// So far [rad] the body may lean, or the fluent does not hold: "body.roll" and "body.pitch" say.
  std::optional<double> upright{};
  std::vector<std::string> upright_except{};  // regions in which it may lie

  /// The region that the fluent names; null if there is none of this name.
  const Region* region_of(const GroundFluent& fluent, const RegionMap& regions) const;
  /// The body's position in the frame of the region that the fluent names. None if there is no such
  /// region, or if the state lacks a variable.
  std::optional<Point> point_of(const GroundFluent& fluent, const State& state,
                                const RegionMap& regions) const;
  /// Do `unless` and `only_if` let the fluent hold?
  bool flags_allow(const GroundFluent& fluent, const State& state,
                   std::set<std::string>* missing) const;
};

/// Fluent holds iff a boolean variable is true; "{0}.held" takes argument 0 of the fluent.
struct FlagBinding {
  std::string variable;
  bool at_start = false;  // its value after a reset
  /// A start sets the variable to what the fluent is to be. None: the scenario does not say; it is
  /// so where every variable of the simulator is such a one.
  std::optional<bool> drawn = {};
};

/// Fluent holds iff a variable lies in one interval, and does not iff it lies in the other one:
/// between the two it does neither, which is no state of the model ("a drawer half open").
struct RangeBinding {
  std::string variable;
  Interval holds, fails;
  double at_start = 0.0;
};

/// Fluent holds iff a variable has this text; "{0}" stands for argument 0. Empty after a reset.
struct EqualsBinding {
  std::string variable;
  std::string text;
};

/// Fluent holds iff a variable began on one side of a border: above it, or at or below it. A start
/// draws the variable on the side that the fluent asks for; later nothing is compared.
struct BorderBinding {
  std::string variable;  // "{0}.x"
  double border = 0.0;
  bool above = true;
  std::vector<std::string> only{};  // first arguments for which it can hold; empty: all

  bool concerns(const GroundFluent& fluent) const;
  Interval side(bool wanted) const;
};

/// Said on purpose: this fluent has no continuous meaning and is not compared.
struct IgnoredBinding {
  std::string why;  // in the scenario's words; may be empty
};

/// The meaning of a fluent symbol in the continuous world. Regions are those of the mapping, which
/// was checked against the model's fluents.
struct FluentBinding {
  std::string fluent;  // symbol name, "RobotIn"
  std::size_t arity = 0;
  std::variant<InsideBinding, FlagBinding, RangeBinding, EqualsBinding, BorderBinding,
               IgnoredBinding>
      condition;
  base::SourceRange source;
  /// Compared at the start and at the end only, also where other fluents are at every step.
  bool at_rest_only = false;
  /// Said of the fluent itself: an error where only last states are compared.
  bool asks_for_every_step = false;

  /// None if the fluent is ignored on purpose.
  std::optional<Reading> read(const GroundFluent& ground, const State& state,
                              const RegionMap& regions, std::set<std::string>* missing) const;
  /// The variables that the fluent is read from.
  std::vector<std::string> variables(const GroundFluent& ground, const RegionMap& regions) const;
  /// Those of them that do not depend on the fluent's arguments.
  std::vector<std::string> constant_variables(const RegionMap& regions) const;
  /// Why a reset cannot make the fluent hold, or not hold, as `wanted`; none: it can, as far as
  /// what is not drawn goes.
  std::optional<std::string> reset_conflict(const GroundFluent& ground, bool wanted) const;
  /// Adds what a reset gives the variables of the fluent that are not drawn, where `state` has no
  /// value for them.
  void add_reset_values(const GroundFluent& ground, const RegionMap& regions, State& state) const;

  /// It is about the start alone, and not compared later.
  bool at_start_only() const { return std::holds_alternative<BorderBinding>(condition); }
  bool is_ignored() const { return std::holds_alternative<IgnoredBinding>(condition); }
  /// The binding that puts a body into a region; null if the fluent is about something else.
  const InsideBinding* inside() const { return std::get_if<InsideBinding>(&condition); }
};

}  // namespace parallax::harness
