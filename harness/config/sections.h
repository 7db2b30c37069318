#pragma once

// Only harness/config/*.cc include this header.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/config/keys.h"
#include "harness/config/scenario.h"
#include "harness/config/yaml_fields.h"
#include "harness/world/world_spec.h"

namespace parallax::harness {

/// The outermost keys of a scenario.
inline constexpr std::array<std::string_view, 26> kScenarioKeys = {
    Key::kInclude,     Key::kName,      Key::kModel,    Key::kPlan,         Key::kBind,
    Key::kConstraints, Key::kHorizon,   Key::kEvents,   Key::kWorld,        Key::kRegions,
    Key::kMapping,     Key::kActions,   Key::kSampling, Key::kCriterion,    Key::kCompare,
    Key::kExecution,   Key::kStarts,    Key::kInitial,  Key::kStartWeights, Key::kUntilCovered,
    Key::kMatch,       Key::kSimulator, Key::kLimits,   Key::kSearch,       Key::kExpect,
    Key::kValidate};

inline constexpr std::int64_t kMaxHorizon = 1'000'000;  // of scenarios and cases alike

/// Ids become file names and are typed in shells: what is wrong with this one, or nothing.
std::string id_problem(std::string_view id);

/// The text, or list of texts, under a key.
std::vector<LocatedText> located_texts(const YamlNode& node, std::string_view key,
                                       base::DiagnosticSink& sink);

/// Each reads one section of a scenario, reporting at its keys; what is wrong keeps its default.

/// `world`: solver, friction, floor, bodies, joints, robot (docs/reference/scenario.md).
WorldSpec read_world(const YamlNode& node, EngineKind engine, base::DiagnosticSink& sink);

/// Puts what the `sdf`, `urdf` or `mjcf` of `world` says under the other keys of `world`, each
/// value with its place in that file. False after an error was reported.
bool add_imported(YamlNode& root, const base::PathGate& gate, base::SourceFiles& files,
                  base::DiagnosticSink& sink, const std::atomic<bool>* stop = nullptr);

/// Reports kLimitReached for a file that could not be read because the program is to end, in place
/// of an error about the file.
bool tell_if_stopped(const std::atomic<bool>* stop, const base::SourceRange& place,
                     base::DiagnosticSink& sink);

/// Replaces every `mesh` of a body of `world` by `hull: [CORNER, ...]`: the corners of the convex
/// hull of the file's contents. False after an error was reported.
bool add_meshes(YamlNode& root, const base::PathGate& gate, base::SourceFiles& files,
                base::DiagnosticSink& sink, const std::atomic<bool>* stop = nullptr);

/// One family of `regions`, as written.
struct RegionSection {
  std::string name;  // empty: the only one
  std::vector<Region> regions;
  bool gaps_allowed = false;
  std::vector<std::string> functions;
};

/// The world that regions are in.
struct RegionWorld {
  const WorldSpec& spec;
  bool is_external = false;  // of another simulator
};

/// `regions`: `cells` of one family, or `sets` of families. Frames are looked up in `world`; where
/// the world is another simulator's, that one may know more bodies.
std::vector<RegionSection> read_regions(const YamlNode& node, const RegionWorld& world,
                                        base::DiagnosticSink& sink);

/// `mapping`: one binding per fluent symbol.
std::vector<FluentBinding> read_mapping(const YamlNode& node, base::DiagnosticSink& sink);

/// `actions`, sorted by event. With `built_in` the controllers and their arguments are checked.
std::vector<ActionBinding> read_actions(const YamlNode& node, bool built_in,
                                        base::DiagnosticSink& sink);

/// Keys of a map that gives a shape on the plane of x and y.
inline constexpr std::array<std::string_view, 5> kAreaKeys = {Key::kBox, Key::kDisc, Key::kPolygon,
                                                              Key::kRing, Key::kUnion};
/// The value of the key; null where a variant has taken it back (`normal:`).
const YamlNode* given(const YamlFields& fields, std::string_view key);
/// A list of x and y [m].
std::optional<PlanePoint> read_point(const YamlNode& node, std::string_view name,
                                     base::DiagnosticSink& sink);
/// The one shape among the fields, a union or another; null: there is none, which was reported.
std::shared_ptr<const Area> read_area(const YamlFields& fields);

/// One value of `sampling`: a number, a pair, or a law.
struct SampledValue {
  Interval interval;                  // in which it lies, but that of a formula
  std::optional<Distribution> law;    // none: uniform, or fixed
  std::optional<Expression> formula;  // then it is not drawn
  std::optional<Interval> within;     // of a formula
};
std::optional<SampledValue> read_sampled_value(const YamlEntry& entry, base::DiagnosticSink& sink);
/// Reads the keys of `sampling` besides `variables`, and sorts the formulas. They can name the
/// values that a reset gives the bodies of the world.
void read_law(const YamlFields& fields, const WorldSpec& world, SamplingLaw& law,
              base::DiagnosticSink& sink);
/// Checks the names in formulas and conditions: each must be a parameter, a variable of the
/// simulator, or a variable of a body that stands in the world. The result of a formula must be
/// settable.
void check_law(const Scenario& scenario, const std::vector<Parameter>& parameters,
               base::DiagnosticSink& sink);

/// `sampling`: inset and the dimensions that no fluent bounds, sorted by variable.
void read_sampling(const YamlNode& node, Scenario& scenario, base::DiagnosticSink& sink);

/// `start_weights`, in their order.
std::vector<StartWeight> read_start_weights(const YamlNode& node, base::DiagnosticSink& sink);

/// `compare`, of a scenario or of one fluent; none: it is not said.
std::optional<Comparison> read_comparison(const YamlFields& fields);

inline constexpr std::int64_t kMaxRuns = 1'000'000;
inline constexpr NumberBounds kTimeout{0.0, 86400.0, true, false};  // [s]

SearchSpec read_search(const YamlNode& node, base::DiagnosticSink& sink);
CriterionSpec read_criterion(const YamlNode& node, base::DiagnosticSink& sink);
SimulatorSpec read_simulator(const YamlNode& node, base::DiagnosticSink& sink);
Limits read_limits(const YamlNode& node, base::DiagnosticSink& sink);
Expectation read_expectation(const YamlNode& node, base::DiagnosticSink& sink);

/// Reports where limits and criterion, or the expectations among themselves, leave no result that
/// is as expected.
void check_expectation(const Scenario& scenario, base::DiagnosticSink& sink);

/// The names that the actions give their controllers must be names of the world: those that are
/// the same whatever the event, or, with `events`, those that depend on its arguments. Reports each
/// value once, with the near name.
void check_action_names(const Scenario& scenario, const std::vector<GroundFluent>& events,
                        base::DiagnosticSink& sink);

/// Warns of speeds at which something moves farther in a step than a shape is thick.
void check_step_lengths(const Scenario& scenario, base::DiagnosticSink& sink);

/// The intervals of `range` mappings must lie within the stops of the joints that they are about.
void check_ranges(const Scenario& scenario, const std::vector<GroundFluent>& fluents,
                  base::DiagnosticSink& sink);

/// Every mapped variable must be one of `parameters`, every sampled one settable besides.
base::Status check_variables(const Scenario& scenario, const std::vector<Parameter>& parameters,
                             base::DiagnosticSink& sink);

/// "RobotIn(region)" taken apart; parameters are distinct words.
struct SymbolPattern {
  std::string symbol;
  std::vector<std::string> parameters;
};
/// None, and kBadPattern: the key is no such thing.
std::optional<SymbolPattern> read_pattern(const YamlEntry& entry, base::DiagnosticSink& sink);

/// "{region}.x" -> "{0}.x"; reports a name in braces that is no parameter of the pattern.
std::string with_positions(const std::string& text, const SymbolPattern& pattern,
                           base::SourceRange range, base::DiagnosticSink& sink);

// Parts of the section `world`, each reporting at its keys.

void read_vector(const YamlFields& fields, std::string_view key, Eigen::Vector3d& out);
BodySpec read_body(const YamlEntry& entry, base::DiagnosticSink& sink);
HandleSpec read_handle(const YamlNode& node, base::DiagnosticSink& sink);
PlaceSpec read_place(const YamlEntry& entry, base::DiagnosticSink& sink);
/// A robot on a line, or, with `arms`, a mobile one.
void read_robot(const YamlNode& node, WorldSpec& world, base::DiagnosticSink& sink);

}  // namespace parallax::harness
