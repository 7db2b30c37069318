#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "harness/region/state_mapping.h"

namespace parallax::harness {

/// Values of the variables that a mapping asks for, by number; none: not reported.
using ReportedValues = std::vector<std::optional<Value>>;

/// How far a reported value may be from the real one: it may be any value up to so far away.
struct ReadingTolerance {
  double m = 0.0;    // places and heights, along each axis of the region's frame, and joints
  double rad = 0.0;  // yaw, roll, pitch
  bool is_exact() const { return m <= 0.0 && rad <= 0.0; }
};

/// The state of the compared fluents in a partial observation.
struct SeenState {
  std::vector<std::int8_t> fluents;  // by number: 1 holds, -1 does not, 0 is not known or ignored
  /// Fluents that neither hold nor do not, and bodies in none of their regions: a state that no
  /// state of a model stands for. Numbers of fluents; texts as of StateMapping::outside.
  std::vector<std::size_t> neither;
  std::vector<std::string> outside;
  /// Bodies so near a border that several regions are possible: at least one fluent of each list
  /// holds. Numbers of fluents, ascending.
  std::vector<std::vector<std::size_t>> one_of;
  /// A fluent would be read differently if a value differed by no more than the tolerance.
  bool near_border = false;
  bool in_no_state() const { return !neither.empty() || !outside.empty(); }
};

/// m, prepared for many observations that may be partial: a fluent is known where all that it is
/// read from is reported, or a flag that is reported rules it out. Where everything is reported it
/// says what StateMapping::read and StateMapping::outside say.
class ObservationReader {
 public:
  enum class Kind : std::uint8_t { kNumber, kFlag, kText };

  /// `mapping` was checked against the fluents and outlives the reader.
  ObservationReader(const StateMapping& mapping, const std::vector<GroundFluent>& fluents);

  const std::vector<std::string>& variables() const { return variables_; }
  std::optional<std::size_t> variable(std::string_view name) const;
  /// The type required of the variable: a number, a flag (also 0 and 1) or a text.
  Kind kind(std::size_t variable) const { return kinds_[variable]; }
  bool fits(std::size_t variable, const Value& value) const;
  /// The variables that a fluent is read from.
  const std::vector<std::size_t>& variables_of(std::size_t fluent) const {
    return readers_[fluent].variables;
  }
  /// `at_rest`: also the fluents that are compared at rest only. A fluent that holds for some of
  /// the values within the tolerance and not for others is unknown. Linear in the fluents.
  void read(const ReportedValues& values, bool at_rest, SeenState& out,
            const ReadingTolerance& tolerance = {}) const;

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  struct FluentReader {
    const FluentBinding* binding = nullptr;
    std::vector<std::size_t> variables;
    const Region* region = nullptr;
    std::array<std::size_t, kRegionAxes.size()> axes{};  // kNone: not needed
    std::array<std::size_t, 4> frame{};                  // x, y, z, yaw; kNone: not needed
    std::size_t roll = kNone, pitch = kNone;             // where the body has to be upright
    double upright_rad = 0.0;
    std::size_t unless = kNone, only_if = kNone, variable = kNone;
    std::string text;
  };
  /// A body that one symbol puts into regions.
  struct Body {
    std::string outside;
    bool at_rest_only = true;
    std::vector<std::size_t> fluents;
  };

  std::size_t add(const std::string& name, Kind kind, FluentReader& reader);
  void prepare(const InsideBinding& kind, const GroundFluent& fluent, FluentReader& reader);
  void prepare(const FlagBinding& kind, const GroundFluent& fluent, FluentReader& reader);
  void prepare(const RangeBinding& kind, const GroundFluent& fluent, FluentReader& reader);
  void prepare(const EqualsBinding& kind, const GroundFluent& fluent, FluentReader& reader);
  void prepare(const BorderBinding& kind, const GroundFluent& fluent, FluentReader& reader);
  void prepare(const IgnoredBinding& kind, const GroundFluent& fluent, FluentReader& reader);
  std::int8_t allowed(const FluentReader& reader, const ReportedValues& values) const;
  std::int8_t inside(const FluentReader& reader, const ReportedValues& values,
                     const ReadingTolerance& tolerance, bool& near) const;
  static std::int8_t upright(const FluentReader& reader, const ReportedValues& values,
                             double tolerance_rad, bool& near);
  void read_bodies(const ReportedValues& values, bool at_rest, const std::vector<bool>& near,
                   SeenState& out) const;

  const StateMapping& mapping_;
  std::vector<std::string> variables_;
  std::vector<Kind> kinds_;
  std::unordered_map<std::string, std::size_t> numbers_;  // for look-up only
  std::vector<FluentReader> readers_;
  std::vector<Body> bodies_;
};

}  // namespace parallax::harness
