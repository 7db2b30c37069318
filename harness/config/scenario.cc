#include "harness/config/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <system_error>

#include "compiler/base/codes/scenarios.h"
#include "compiler/base/file_io.h"
#include "harness/config/load_limits.h"
#include "harness/config/sections.h"
#include "harness/config/settings_reader.h"
#include "harness/config/validate_list.h"
#include "harness/engine/world_check.h"
#include "harness/region/area.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {
namespace {

/// Regions where things are laid down at the start must have something below them.
void check_supported_starts(const Scenario& scenario, base::DiagnosticSink& sink) {
  const auto at = [](const Region& region, RegionAxis axis) -> std::optional<double> {
    const auto& start = region.start[static_cast<std::size_t>(axis)];
    if (!start && !region.on(axis)) return std::nullopt;
    return start ? start->midpoint() : region.on(axis)->midpoint();
  };
  std::vector<NamedPoint> points;
  for (const Region& region : scenario.mapping->regions().regions()) {
    const auto& bottom = region.start[static_cast<std::size_t>(RegionAxis::kBottom)];
    auto x = at(region, RegionAxis::kX), y = at(region, RegionAxis::kY);
    // The middle of a ring is not in the ring.
    if (const auto& shape = region.start_area ? region.start_area : region.area) {
      if (const auto point = shape->at(0.0, 0.5)) x = (*point)[0], y = (*point)[1];
    }
    if (!bottom || bottom->lower != bottom->upper || !x || !y) continue;
    const auto& o = region.frame_start;
    points.push_back({region.name, {*x + o[0], *y + o[1], bottom->lower + o[2]}});
  }
  if (points.empty()) return;
  for (const auto& name : unsupported_points(scenario.world, points)) {
    const Region* region = scenario.mapping->regions().find(name);
    sink.error(codes::kBadWorld, region->source, "regions/" + name,
               "nothing in the world is below the middle of its start");
  }
}

/// Regions where bodies come to lie must have something in them to lie on.
void check_supported_regions(const Scenario& scenario, base::DiagnosticSink& sink) {
  std::vector<NamedBox> boxes;
  for (const Region& region : scenario.mapping->regions().regions()) {
    const auto &x = region.on(RegionAxis::kX), &y = region.on(RegionAxis::kY),
               &z = region.on(RegionAxis::kBottom);
    if (!x || !y || !z || !region.frame.empty()) continue;
    boxes.push_back({region.name, {x->lower, y->lower, z->lower}, {x->upper, y->upper, z->upper}});
  }
  if (boxes.empty()) return;
  for (const auto& name : boxes_without_support(scenario.world, boxes)) {
    const Region* region = scenario.mapping->regions().find(name);
    sink.error(codes::kBadWorld, region->source, "regions/" + name,
               "nothing in the world reaches into it, so no body can come to lie there");
  }
}

/// The box that a region bounds, or in which its starts are drawn; none if a side is open.
std::optional<NamedBox> box_of(const Region& region, bool start) {
  const auto on = [&](RegionAxis axis) {
    const auto& narrow = region.start[static_cast<std::size_t>(axis)];
    return start && narrow ? narrow : region.on(axis);
  };
  const auto x = on(RegionAxis::kX), y = on(RegionAxis::kY), z = on(RegionAxis::kBottom);
  if (!x || !y || !z || !region.frame.empty()) return std::nullopt;
  return NamedBox{region.name, {x->lower, y->lower, z->lower}, {x->upper, y->upper, z->upper}};
}

/// Regions where no body's lowest point can be: below the floor, or inside furniture.
void check_free_regions(const Scenario& scenario, base::DiagnosticSink& sink) {
  std::vector<NamedBox> wholes, starts;
  const auto& regions = scenario.mapping->regions();
  for (const Region& region : regions.regions()) {
    const auto& bottom = region.on(RegionAxis::kBottom);
    if (bottom && region.frame.empty() && bottom->upper < 0.0) {
      sink.error(codes::kBadWorld, region.source, "regions/" + region.name,
                 fmt::format("lies below the floor: `{}` ends at {:g}",
                             to_string(RegionAxis::kBottom), bottom->upper));
      continue;
    }
    if (auto box = box_of(region, false)) wholes.push_back(*std::move(box));
    if (auto box = box_of(region, true)) starts.push_back(*std::move(box));
  }
  std::set<std::string> reported;
  for (const auto& [boxes, what] :
       {std::pair{&wholes, "lies"}, std::pair{&starts, "its start lies"}}) {
    for (const auto& buried : buried_boxes(scenario.world, *boxes)) {
      if (!reported.insert(buried.name).second) continue;
      sink.error(codes::kBadWorld, regions.find(buried.name)->source, "regions/" + buried.name,
                 fmt::format("{} inside `{}`", what, buried.body));
    }
  }
}

/// Whether the files of a plan's folder are read or not, they are what the scenario names.
void note_plan(const std::filesystem::path& path, base::SourceFiles& files) {
  files.note_input(path.string());
  std::error_code error;
  for (auto at = std::filesystem::directory_iterator(path, error);
       !error && at != std::filesystem::directory_iterator(); at.increment(error)) {
    const auto ending = at->path().extension();
    if (ending == ".lisp" || ending == ".asd") files.note_input(at->path().string());
  }
}

/// Keys that are easily written beside `world` instead of below it.
constexpr std::array<std::string_view, 12> kWorldKeys = {
    Key::kSdf,    Key::kUrdf,  Key::kMjcf,   Key::kModels,        Key::kBodies,   Key::kJoints,
    Key::kPlaces, Key::kRobot, Key::kSolver, Key::kFloorMaterial, Key::kFriction, Key::kPackages};

class ScenarioReader {
 public:
  ScenarioReader(const YamlNode& root, const base::PathGate& gate, const base::SourceFiles& files,
                 base::DiagnosticSink& sink)
      : fields_(root, "the scenario", sink), gate_(gate), files_(files), sink_(sink) {}

  void read(Scenario& scenario) {
    fields_.belongs(Key::kWorld, kWorldKeys);
    fields_.only(kScenarioKeys);
    const auto* execution = fields_.find(Key::kExecution);
    if (execution != nullptr) {
      fields_.word(Key::kExecution, kExecutions, scenario.execution);
      scenario.execution_source = execution->range;
    }
    fields_.word(Key::kStarts, kStartsWords, scenario.starts);
    fields_.boolean(Key::kUntilCovered, scenario.until_covered);
    if (const auto* node = fields_.find(Key::kStartWeights)) {
      scenario.start_weights = read_start_weights(*node, sink_);
      scenario.start_weights_source = node->range;
    }
    read_initial(scenario);
    static constexpr std::array<std::string_view, 2> kMatches = {"model", "trace"};
    if (fields_.choice(Key::kMatch, "value of " + key_text(Key::kMatch), kMatches, 0) ==
        std::size_t{1}) {
      scenario.match_model = false;
    }
    scenario.compare = read_comparison(fields_);
    if (const auto* node = fields_.find(Key::kSearch)) scenario.search = read_search(*node, sink_);
    fields_.text(Key::kName, scenario.title);
    read_problem(scenario);
    read_simulation(scenario);
    read_meaning(scenario);
    if (const auto* node = fields_.find(Key::kCriterion)) {
      scenario.criterion = read_criterion(*node, sink_);
    } else {
      scenario.criterion.paper = paper_literal();
    }
    ReadLog::fallback(fields_.node(), Key::kCompare,
                      std::string(to_string(comparison_by(scenario.criterion))));
    if (const auto* node = fields_.find(Key::kLimits)) scenario.limits = read_limits(*node, sink_);
    // An empty one takes back what an included file expects.
    if (const auto* node = fields_.find(Key::kExpect);
        node != nullptr && node->kind != YamlNode::Kind::kNull) {
      const auto errors_before = sink_.error_count();
      scenario.expect = read_expectation(*node, sink_);
      if (sink_.error_count() == errors_before) check_expectation(scenario, sink_);
    }
  }

  std::vector<LocatedText> read_validate() {
    const auto* node = fields_.find(Key::kValidate);
    if (node == nullptr) return {};
    auto out = located_texts(*node, Key::kValidate, sink_);
    for (auto& other : out) resolve(other, false);
    return out;
  }

 private:
  /// `start_weights` alone means `initial: weights`.
  void read_initial(Scenario& scenario) {
    const auto* weights = fields_.find(Key::kStartWeights);
    const auto* initial = fields_.find(Key::kInitial);
    if (weights != nullptr) scenario.initial = Initial::kWeights;
    if (!fields_.word(Key::kInitial, kInitialWords, scenario.initial)) return;
    scenario.initial_source = initial->range;
    const bool by_weights = scenario.initial == Initial::kWeights;
    if (by_weights && weights == nullptr) {
      sink_.error(codes::kMissingKey, initial->range, "`initial: weights`", Key::kStartWeights);
    } else if (!by_weights && weights != nullptr) {
      sink_.error(codes::kYamlOutOfBounds, initial->range, key_text(Key::kInitial),
                  fmt::format("`{}`", to_string(scenario.initial)),
                  "`weights` where `start_weights` are given");
    }
    if (scenario.initial == Initial::kFirst && scenario.execution == Execution::kClosedLoop) {
      sink_.error(codes::kYamlOutOfBounds, initial->range, key_text(Key::kInitial), "`first`",
                  "`all` or `weights` in closed loop");
    }
  }

  /// model, plan, bind, constraints, horizon: what the compiler reads.
  void read_problem(Scenario& scenario) {
    if (const auto* node = fields_.require(Key::kModel)) {
      scenario.models = located_texts(*node, Key::kModel, sink_);
      for (auto& model : scenario.models) resolve(model, false);
    }
    if (const auto* node = fields_.find(Key::kPlan)) {
      scenario.plan = located_texts(*node, Key::kPlan, sink_);
      for (auto& plan : scenario.plan) resolve(plan, true);
    }
    scenario.bind = optional_path(Key::kBind);
    const auto* plan = fields_.find(Key::kPlan);
    const auto* bind = fields_.find(Key::kBind);
    if ((plan == nullptr) != (bind == nullptr)) {
      sink_.error(codes::kMissingKey, (plan != nullptr ? plan : bind)->range, "the scenario",
                  plan != nullptr ? Key::kBind : Key::kPlan);
    }
    if (const auto* node = fields_.find(Key::kConstraints)) {
      scenario.constraints = located_texts(*node, Key::kConstraints, sink_);
    }
    if (const auto* node = fields_.find(Key::kEvents)) {
      YamlFields events(*node, key_text(Key::kEvents), sink_);
      events.only({Key::kUnobserved});
      events.may_be_absent();
      events.texts(Key::kUnobserved, scenario.unobserved);
    }
    if (fields_.require(Key::kHorizon) != nullptr) {
      std::int64_t horizon = 0;
      fields_.integer(Key::kHorizon, 1, kMaxHorizon, horizon);
      scenario.horizon = static_cast<std::int32_t>(horizon);
    }
  }

  void read_simulation(Scenario& scenario) {
    const auto errors_before = sink_.error_count();
    if (const auto* node = fields_.find(Key::kSimulator)) {
      scenario.simulator = read_simulator(*node, sink_);
    } else {
      scenario.simulator.source = fields_.node().range;
    }
    // If the kind of simulator is not known, nothing that it needs is asked for.
    const bool unknown = sink_.error_count() != errors_before;
    for (auto& model : scenario.simulator.models) resolve(model, false);
    // Another simulator has a world of its own; the built-in one needs ours.
    const bool built_in = !unknown && scenario.simulator.is_built_in();
    const auto* world = fields_.find(Key::kWorld);
    if (world == nullptr && built_in && fields_.node().is_map()) {
      auto error =
          sink_.error(codes::kMissingKey, fields_.node().range, "the scenario", Key::kWorld);
      if (fields_.find(Key::kSimulator) == nullptr) {
        error.note(
            "if the world is a model, `simulator: {model: FILE}` names it; then `world`, "
            "`actions`, "
            "`regions` and `mapping` may be left out");
      }
    }
    if (world != nullptr) {
      scenario.world =
          read_world(*world, unknown ? EngineKind::kOde : scenario.simulator.engine, sink_);
      if (const auto* bodies = world->find(Key::kBodies)) {
        for (const auto& body : bodies->value.entries) {
          scenario.body_sources.emplace(body.key, body.key_range);
        }
      }
    }
    // In a discrete world the names of the model suffice; the scenario need not give any.
    by_name_ = unknown || !scenario.simulator.models.empty();
    scenario.actions_source = scenario.simulator.source;
    if (const auto* node = needed(Key::kActions)) {
      scenario.actions = read_actions(*node, built_in, sink_);
      scenario.actions_source = key_range(Key::kActions);
    }
  }

  void read_meaning(Scenario& scenario) {
    const auto* regions = needed(Key::kRegions);
    const auto* mapping = needed(Key::kMapping);
    const auto errors_before = sink_.error_count();
    scenario.regions_source = scenario.mapping_source = scenario.simulator.source;
    std::vector<RegionSection> sections;
    if (regions != nullptr) {
      sections = read_regions(*regions, {scenario.world, !scenario.simulator.is_built_in()}, sink_);
      scenario.regions_source = key_range(Key::kRegions);
    }
    const bool regions_read = sink_.error_count() == errors_before;
    std::vector<FluentBinding> bindings;
    if (mapping != nullptr) {
      bindings = read_mapping(*mapping, sink_);
      scenario.mapping_source = key_range(Key::kMapping);
    }
    scenario.sampling_source = scenario.regions_source;
    if (const auto* node = fields_.find(Key::kSampling)) {
      scenario.sampling_source = key_range(Key::kSampling);
      read_sampling(*node, scenario, sink_);
    }
    if (!regions_read) return;  // a region without its bounds would be reported once more
    std::vector<RegionFamily> families;
    std::map<std::string, base::SourceRange> seen;
    for (auto& section : sections) {
      for (const auto& region : section.regions) {
        const auto [twin, fresh] = seen.emplace(region.name, region.source);
        if (fresh || section.name.empty()) continue;
        sink_.error(codes::kRegionDuplicate, region.source, region.name)
            .note(twin->second, "the first definition is here");
      }
      auto set = RegionSet::make(section.regions, section.gaps_allowed, sink_);
      if (set) families.push_back({section.name, *std::move(set), std::move(section.functions)});
    }
    if (sink_.error_count() != errors_before) return;
    if (families.empty()) {
      if (by_name_) scenario.mapping.emplace(RegionMap(RegionSet()), std::move(bindings));
      return;
    }
    scenario.mapping.emplace(RegionMap(std::move(families)), std::move(bindings));
  }

  const YamlNode* needed(std::string_view key) const {
    return by_name_ ? fields_.find(key) : fields_.require(key);
  }
  base::SourceRange key_range(std::string_view key) const {
    return fields_.node().find(key)->key_range;
  }

  /// A text, or a list of texts.
  std::optional<LocatedText> optional_path(std::string_view key) {
    const auto* node = fields_.find(key);
    if (node == nullptr) return std::nullopt;
    auto text = read_text(*node, fmt::format("`{}`", key), sink_);
    if (!text) return std::nullopt;
    LocatedText path{std::move(*text), node->range};
    resolve(path, false);
    return path;
  }

  /// Resolves a path relative to its file, and reports at the key if nothing is there.
  void resolve(LocatedText& path, bool or_folder) {
    const auto resolved = path_beside(path.source, path.text, files_);
    // For a path outside the gate, not even its existence is told.
    if (gate_.check(resolved, path.source, sink_)) {
      (void)base::check_file(resolved, path.source, sink_, or_folder);
    }
    path.text = resolved.string();
  }

  YamlFields fields_;
  const base::PathGate& gate_;
  const base::SourceFiles& files_;
  base::DiagnosticSink& sink_;
  bool by_name_ = false;  // the simulator is a model, or not known
};

}  // namespace

std::vector<LocatedText> located_texts(const YamlNode& node, std::string_view key,
                                       base::DiagnosticSink& sink) {
  const auto items = node.is_list() ? node.items : std::vector<YamlNode>{node};
  std::vector<LocatedText> out;
  for (const auto& item : items) {
    auto text = read_text(item, key_text(key), sink);
    if (text) out.push_back({std::move(*text), item.range});
  }
  if (items.empty()) {
    sink.error(codes::kWrongYamlKind, node.range, key_text(key), "empty", "a list of texts");
  }
  return out;
}

base::Result<Scenario> load_scenario(const std::filesystem::path& path, base::SourceFiles& files,
                                     base::DiagnosticSink& sink, bool allow_outside) {
  return load_scenario(path, files, sink, LoadLimits{allow_outside, nullptr, nullptr});
}

base::Result<Scenario> load_scenario(const std::filesystem::path& path, base::SourceFiles& files,
                                     base::DiagnosticSink& sink, const LoadLimits& limits) {
  const auto errors_before = sink.error_count();
  base::PathGate gate(limits.allow_outside, &files);
  gate.admit_beside(path);
  Scenario scenario;
  scenario.file = path;
  scenario.name = path.string();
  // Files are registered in order of loading, so the next one is the scenario itself.
  scenario.source = base::FileId(static_cast<std::uint32_t>(files.size()));
  auto root = load_yaml(path, gate, files, sink);
  if (!root || !add_imported(*root, gate, files, sink, limits.stop) ||
      !add_meshes(*root, gate, files, sink, limits.stop)) {
    return sink.already_reported();
  }
  ReadLog log;
  if (limits.settings != nullptr) log.attach(*root);
  ScenarioReader reader(*root, gate, files, sink);
  reader.read(scenario);
  for (const auto& other : reader.read_validate()) files.note_input(other.text);
  if (limits.settings != nullptr) *limits.settings = settings_of(*root, log, files);
  for (const auto& model : scenario.models) files.note_input(model.text);
  for (const auto& model : scenario.simulator.models) files.note_input(model.text);
  for (const auto& plan : scenario.plan) note_plan(plan.text, files);
  if (scenario.bind) files.note_input(scenario.bind->text);
  // Another simulator's variables are known only after it has been started.
  const bool built_in = scenario.simulator.is_built_in();
  if (built_in && scenario.mapping && sink.error_count() == errors_before) {
    const auto parameters = observables(scenario.world);
    if (!check_variables(scenario, parameters, sink)) return sink.already_reported();
    check_action_names(scenario, {}, sink);
    if (sink.error_count() == errors_before) check_step_lengths(scenario, sink);
    if (sink.error_count() == errors_before) check_free_regions(scenario, sink);
    if (sink.error_count() == errors_before) check_supported_starts(scenario, sink);
    if (sink.error_count() == errors_before) check_supported_regions(scenario, sink);
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return scenario;
}

base::Result<std::vector<LocatedText>> scenarios_to_validate(const std::filesystem::path& scenario,
                                                             base::SourceFiles& files,
                                                             base::DiagnosticSink& sink,
                                                             bool allow_outside) {
  const auto errors_before = sink.error_count();
  base::PathGate gate(allow_outside, &files);
  gate.admit_beside(scenario);
  const auto root = load_yaml(scenario, gate, files, sink);
  if (!root) return sink.already_reported();
  auto out = ScenarioReader(*root, gate, files, sink).read_validate();
  if (sink.error_count() != errors_before) return sink.already_reported();
  return out;
}

base::Result<WorldSpec> load_world(const std::filesystem::path& path, base::SourceFiles& files,
                                   base::DiagnosticSink& sink, bool allow_outside) {
  const auto errors_before = sink.error_count();
  base::PathGate gate(allow_outside, &files);
  gate.admit_beside(path);
  auto world_node = load_yaml(path, gate, files, sink);
  if (!world_node) return sink.already_reported();
  // As in a scenario, so that what lies below `world` there may lie here.
  YamlNode root;
  root.kind = YamlNode::Kind::kMap;
  root.range = world_node->range;
  root.entries.push_back({std::string(Key::kWorld), world_node->range, *std::move(world_node)});
  if (!add_imported(root, gate, files, sink) || !add_meshes(root, gate, files, sink)) {
    return sink.already_reported();
  }
  WorldSpec world = read_world(root.entries.front().value, EngineKind::kOde, sink);
  if (sink.error_count() != errors_before) return sink.already_reported();
  return world;
}

}  // namespace parallax::harness
