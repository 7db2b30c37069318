#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "harness/region/area.h"
#include "harness/region/fluent_binding.h"

namespace parallax::harness {

/// One continuous dimension to draw: uniform on [lower, upper), or fixed where both are equal.
struct SampledDimension {
  std::string variable;
  Interval interval;
};

/// The start area of a body whose region has a shape on the plane of x and y.
struct StartArea {
  std::string body;
  std::shared_ptr<const Area> area;
  PlanePoint offset{};  // of the region's frame at a reset
  base::SourceRange source;
};

/// The cuboid of continuous states that a discrete state stands for, and what is cut out of it.
struct StartCuboid {
  std::vector<SampledDimension> dimensions;  // sorted by variable
  std::vector<StartArea> areas{};
};

/// Is the variable an angle? By its name: "box.yaw".
bool is_angle(std::string_view variable);

/// m and its inverse, from one binding per fluent symbol.
class StateMapping {
 public:
  StateMapping(RegionMap regions, std::vector<FluentBinding> bindings);
  const FluentBinding* find(std::string_view symbol) const;
  const RegionMap& regions() const { return regions_; }
  const std::vector<FluentBinding>& bindings() const { return bindings_; }

  /// Can every fluent of the model be read from a continuous state? Reports each symbol without a
  /// binding once, each binding with another number of arguments, and each argument that should
  /// name a region and does not. `blame` is the place that should have said it.
  base::Status check(const std::vector<GroundFluent>& fluents, base::SourceRange blame,
                     base::DiagnosticSink& sink) const;

  /// m: does the fluent hold in this continuous state? None if it is ignored on purpose.
  /// Errors: an unbound symbol or a region that does not exist is a contract violation, checked
  /// when the scenario is loaded; a variable that the state lacks makes the fluent false and is
  /// appended to `missing`.
  std::optional<Reading> read(const GroundFluent& fluent, const State& state,
                              std::set<std::string>* missing = nullptr) const;
  /// The same with kNeither as false.
  std::optional<bool> holds(const GroundFluent& fluent, const State& state,
                            std::set<std::string>* missing = nullptr) const;

  /// Bodies that are in none of the regions that the fluents of one symbol can name, although no
  /// `unless` or `only_if` takes them out: a state that no state of the model stands for, even
  /// where all these fluents are false. One text a body, "RobotAt(outside)".
  std::vector<std::string> outside(const std::vector<GroundFluent>& fluents,
                                   const State& state) const;
  /// "RobotAt(outside)" for a fluent that puts a body into a region; empty for others.
  std::string outside_text(const GroundFluent& fluent) const;

  /// Inverse of m for a start: the cuboid in which every fluent of `true_fluents` holds and every
  /// other one of `fluents` does not. `extra` gives the dimensions that no fluent bounds
  /// (scenario's `sampling`), narrowing where both speak. Reports kStartNotSampleable when the
  /// state has an empty cuboid or asks for what a reset cannot make (a flag that starts true).
  base::Result<StartCuboid> start_cuboid(const std::vector<GroundFluent>& fluents,
                                         const std::set<std::string>& true_fluents,
                                         const std::vector<SampledDimension>& extra,
                                         base::SourceRange blame, base::DiagnosticSink& sink) const;

  /// The cell of every variable that a discrete state pins to one region, by variable.
  std::map<std::string, Interval> cells(const std::vector<GroundFluent>& fluents,
                                        const std::set<std::string>& true_fluents) const;

  /// Which of `fluents` the state gets wrong, with every flag that the state lacks read as false,
  /// as after a reset. Empty for each state drawn from `start_cuboid`.
  std::vector<std::string> wrong_at_start(const std::vector<GroundFluent>& fluents,
                                          const std::set<std::string>& true_fluents,
                                          State start) const;

 private:
  RegionMap regions_;
  std::vector<FluentBinding> bindings_;  // sorted by symbol
};

}  // namespace parallax::harness
