// Scenarios compared by value: every key counts, no way of writing does.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/config/load_limits.h"
#include "harness/config/settings_reader.h"
#include "tests/harness/config/scenario_text.h"
#include "tools/diff/gate.h"
#include "tools/diff/settings_difference.h"

namespace parallax::tools {
namespace {

using harness::ScenarioSettings;
using harness::YamlNode;
using harness::test::kScenario;
using harness::test::kWorld;
using harness::test::replaced;
using Path = std::vector<std::string>;

/// Sections that the scenario of the other tests does without.
constexpr const char* kMore = R"yaml(
name: fetch
events: {unobserved: [Go]}
criterion: {kind: clopper-pearson, confidence: 0.95, epsilon: 0.1, runs: 80, family: per-trace,
            sigma: rmse, extra_runs: 3, bonferroni: true}
compare: final
execution: open-loop
starts: uniform
until_covered: false
match: trace
search: {runs: 20, strategy: sobol}
limits: {max_runs: 400, max_traces: 3, max_lost_in_a_row: 2}
simulator: {engine: ode, act_timeout_s: 3, memory_mb: 1000}
start_weights: [{when: "HoldsAt(BoxIn(r1),0)", weight: 2}]
)yaml";

constexpr const char* kMoreWorld = R"yaml(
solver: {timestep_s: 0.001, erp: 0.3, resting_joints: false, max_contacts_per_side: 5}
places: {shelf: {at_m: [1, 0, 0], yaw_rad: 0.1}}
)yaml";

class Revisions {
 public:
  Revisions() { workspace_.write("world.yaml", std::string(kWorld) + kMoreWorld); }

  void write(const std::string& name, const std::string& text) { workspace_.write(name, text); }

  /// None if the scenario is rejected.
  std::optional<ScenarioSettings> load(const std::string& text) {
    base::SourceFiles files;
    base::DiagnosticSink sink;
    ScenarioSettings settings;
    const auto path = workspace_.write("one.yaml", text);
    const auto scenario =
        harness::load_scenario(path, files, sink, harness::LoadLimits{false, nullptr, &settings});
    if (!scenario) return std::nullopt;
    return settings;
  }

  std::vector<std::string> differences(const std::string& before, const std::string& after) {
    const auto a = load(before), b = load(after);
    REQUIRE(a);
    REQUIRE(b);
    std::vector<std::string> out;
    for (const auto& change : compare_settings(*a, *b)) out.push_back(change_text(change));
    return out;
  }

  /// Rules about the settings of two scenarios.
  RuleOutcome rule(const std::string& name, harness::GateRules::Demand demand,
                   const std::string& before, const std::string& after) {
    ModelDifference found;
    const auto a = load(before), b = load(after);
    REQUIRE(a);
    REQUIRE(b);
    found.settings = compare_settings(*a, *b);
    return setting_rule(found, {name, demand}).outcome;
  }

 private:
  harness::test::Workspace workspace_;
};

std::string whole() { return std::string(kScenario) + kMore; }

/// A scenario that lays one value over base.yaml.
std::string overlay(const Path& path, const std::string& value) {
  std::string out = "include: base.yaml\n";
  for (std::size_t i = 0; i < path.size(); ++i) {
    out +=
        fmt::format("{}\"{}\": {}", i == 0 ? "" : "{", path[i], i + 1 == path.size() ? value : "");
  }
  return out + std::string(path.size() - 1, '}') + '\n';
}

/// Another value of the same kind; none for texts.
std::optional<std::string> another(const std::string& value) {
  if (value == "true") return "false";
  if (value == "false") return "true";
  if (value.starts_with('[') && value.size() > 2 && !value.starts_with("[[")) {
    const auto end = value.find_first_of(",]");
    const auto first = another(value.substr(1, end - 1));
    return first ? std::optional("[" + *first + value.substr(end)) : std::nullopt;
  }
  double number = 0.0;
  const auto* end = value.data() + value.size();
  const auto [rest, error] = std::from_chars(value.data(), end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  if (value.find('.') == value.npos && number != 0.0) return fmt::format("{}", number + 1.0);
  return fmt::format("{}", number * 0.9998 + 0.00001);
}

YamlNode scalar(const std::string& text) {
  YamlNode out;
  out.kind = YamlNode::Kind::kScalar;
  out.text = text;
  return out;
}

/// A tree that says this value at the path alone.
YamlNode tree(const Path& path, const std::string& value) {
  auto out = scalar(value);
  for (auto key = path.rbegin(); key != path.rend(); ++key) {
    YamlNode map;
    if (key->starts_with('[')) {
      map.kind = YamlNode::Kind::kList;
      map.items.push_back(std::move(out));
    } else {
      map.kind = YamlNode::Kind::kMap;
      map.entries.push_back({*key, {}, std::move(out)});
    }
    out = std::move(map);
  }
  return out;
}

TEST_CASE("a key that the reader admits is compared") {
  Revisions revisions;
  const auto settings = revisions.load(whole());
  REQUIRE(settings);
  base::SourceFiles files;
  files.add("tree.yaml", "");
  const harness::ReadLog nothing_known;
  const std::set<std::string> elsewhere = {
      "include", "model", "plan", "bind", "constraints", "simulator.model", "events.include"};
  std::size_t keys = 0;
  for (const auto& known : settings->known) {
    for (const auto& key : known.keys) {
      auto path = known.path;
      path.push_back(key);
      CAPTURE(harness::path_text(path));
      CHECK(!harness::effects_of(path).empty());
      if (elsewhere.contains(harness::path_text(path))) continue;  // compared as texts
      const auto side = [&](const char* value) {
        return harness::settings_of(tree(path, value), nothing_known, files);
      };
      const auto changes = compare_settings(side("1"), side("2"));
      REQUIRE(changes.size() == 1);
      CHECK(changes.front().path == path);
      ++keys;
    }
  }
  CHECK(keys > 150);
}

TEST_CASE("another value is one difference with the path to it") {
  Revisions revisions;
  revisions.write("base.yaml", whole());
  const auto base = revisions.load("include: base.yaml\n");
  REQUIRE(base);
  std::size_t accepted = 0;
  for (const auto& setting : base->all) {
    const bool in_list = std::any_of(setting.path.begin(), setting.path.end(),
                                     [](const auto& key) { return key.starts_with('['); });
    const auto value = another(setting.value);
    if (in_list || !value) continue;
    CAPTURE(harness::path_text(setting.path));
    CAPTURE(*value);
    const auto changed = revisions.load(overlay(setting.path, *value));
    if (!changed) continue;  // the reader refuses it
    ++accepted;
    const auto changes = compare_settings(*base, *changed);
    REQUIRE(changes.size() == 1);
    CHECK(changes.front().path == setting.path);
  }
  CHECK(accepted > 60);
}

TEST_CASE("a default that is written out is no difference") {
  Revisions revisions;
  revisions.write("base.yaml", whole());
  const auto base = revisions.load("include: base.yaml\n");
  REQUIRE(base);
  std::size_t accepted = 0;
  for (const auto& setting : base->all) {
    if (setting.given) continue;
    CAPTURE(harness::path_text(setting.path));
    const auto same = revisions.load(overlay(setting.path, setting.value));
    if (!same) continue;
    ++accepted;
    const auto changes = compare_settings(*base, *same);
    CHECK_MESSAGE(changes.empty(), (changes.empty() ? "" : change_text(changes.front())));
  }
  CHECK(accepted > 40);
}

TEST_CASE("sections that are left out have their defaults") {
  Revisions revisions;
  const std::string text = kScenario;
  using Lines = std::vector<std::string>;
  CHECK(revisions.differences(text, text + "limits: {max_runs: 0}\n").empty());
  CHECK(revisions.differences(text, text + "criterion: clean-runs\n").empty());
  CHECK(revisions.differences(text, text + "simulator: ode\n").empty());
  CHECK(revisions.differences(text, text + "compare: every-step\n").empty());
  CHECK(revisions.differences(text, text + "limits: {max_runs: 500}\n") ==
        Lines{"limits.max_runs 0 (default) -> 500"});
  CHECK(revisions.differences(text + "limits: {max_runs: 500}\n", text) ==
        Lines{"limits.max_runs 500 -> 0 (default)"});
}

TEST_CASE("what is written in another way is no difference") {
  Revisions revisions;
  const auto before = whole();
  CHECK(revisions.differences(before, "# a comment\n" + before + "# another\n").empty());
  CHECK(
      revisions.differences(before, replaced(before, "horizon: 6\n", "") + "horizon: 6\n").empty());
  CHECK(revisions.differences(before, replaced(before, "[-0.1, 0.1]", "[-1e-1, +0.10]")).empty());
  revisions.write("limits.yaml", "limits: {max_lost_in_a_row: 2, max_traces: 3, max_runs: 400}\n");
  CHECK(revisions
            .differences(before, "include: limits.yaml\n" +
                                     replaced(before,
                                              "limits: {max_runs: 400, max_traces: 3, "
                                              "max_lost_in_a_row: 2}\n",
                                              ""))
            .empty());
  CHECK(revisions
            .differences(before, replaced(before, "world: {include: world.yaml}",
                                          "world:\n  # the robot\n  include: world.yaml"))
            .empty());
  const std::string plain = kScenario;
  CHECK(revisions.differences(plain + "search: 40\n", plain + "search: {runs: 40}\n").empty());
  CHECK(revisions
            .differences(plain + "criterion: anytime\n", plain + "criterion: {kind: 'anytime'}\n")
            .empty());
}

TEST_CASE("what a region, a mapping or a body comes to be is shown at its key") {
  Revisions revisions;
  const auto before = whole();
  using Lines = std::vector<std::string>;
  CHECK(revisions.differences(before, replaced(before, "r2: {x: [1, 2]}", "r2: {x: [1, 2.5]}")) ==
        Lines{"regions.cells.r2.x [1, 2] -> [1, 2.5]"});
  CHECK(revisions.differences(before, replaced(before, "{flag: box.held}", "ignored")) ==
        Lines{"mapping.Holding() ignored", "mapping.Holding().flag box.held"});
  CHECK(revisions.differences(
            before, replaced(before, "world: {include: world.yaml}",
                             "world: {include: world.yaml, bodies: {cup: {size_m: [0.1, 0.1, "
                             "0.1], position_m: [3, 0, 0.05], material: box}}}")) ==
        Lines{"world.bodies.cup material: box, position_m: [3, 0, 0.05], size_m: [0.1, 0.1, "
              "0.1]"});
  // Why a fluent is ignored is words; that it is, is judgement.
  const auto ignored = replaced(before, "{flag: box.held}", "ignored");
  const auto a = revisions.load(ignored),
             b = revisions.load(replaced(before, "{flag: box.held}", "{ignored: not seen}"));
  REQUIRE(a);
  REQUIRE(b);
  const auto changes = compare_settings(*a, *b);
  REQUIRE(changes.size() == 1);
  CHECK(changes.front().effects == std::vector{harness::Effect::kWords});
}

TEST_CASE("what a mesh holds is compared, not the name of its file") {
  Revisions revisions;
  const auto corners = [](const char* height) {
    return std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 ") + height +
           "\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  };
  revisions.write("old.obj", corners("1"));
  revisions.write("same.obj", corners("1.0"));
  revisions.write("new.obj", corners("2"));
  const auto with = [](const char* file) {
    return replaced(whole(), "world: {include: world.yaml}",
                    std::string("world: {include: world.yaml, bodies: {wedge: {mesh: ") + file +
                        ", position_m: [4, 0, 0.1], material: box}}}");
  };
  if (!revisions.load(with("old.obj"))) return;  // built without the reader of meshes
  CHECK(revisions.differences(with("old.obj"), with("same.obj")).empty());
  const auto changed = revisions.differences(with("old.obj"), with("new.obj"));
  REQUIRE(changed.size() == 1);
  CHECK(changed.front().starts_with("world.bodies.wedge.hull [["));
}

TEST_CASE("rules about settings") {
  using Demand = harness::GateRules::Demand;
  constexpr auto kKept = RuleOutcome::kKept, kBroken = RuleOutcome::kBroken,
                 kOpen = RuleOutcome::kUndecided;
  Revisions revisions;
  const auto before = whole();
  const auto held = [&](const char* name, Demand demand, const std::string& from,
                        const std::string& to) {
    return revisions.rule(name, demand, before, replaced(before, from, to));
  };
  const auto forbidden = Demand::kForbidden;
  const std::string cap = "act_timeout_s: 3";
  CHECK(held("settings", forbidden, cap, "act_timeout_s: 4") == kBroken);
  CHECK(held("physics", forbidden, cap, "act_timeout_s: 4") == kBroken);
  CHECK(held("simulator", forbidden, cap, "act_timeout_s: 4") == kBroken);
  CHECK(held("world", forbidden, cap, "act_timeout_s: 4") == kKept);
  CHECK(held("claim", forbidden, cap, "act_timeout_s: 4") == kKept);
  CHECK(held("settings", forbidden, "name: fetch", "name: bring") == kKept);
  CHECK(held("starts", forbidden, "x: [1, 2]", "x: [1, 3]") == kBroken);
  CHECK(held("judgement", forbidden, "x: [1, 2]", "x: [1, 3]") == kBroken);
  CHECK(held("horizon", Demand::kNotShorter, "horizon: 6", "horizon: 7") == kKept);
  CHECK(held("horizon", Demand::kNotShorter, "horizon: 6", "horizon: 5") == kBroken);
  CHECK(held("regions", Demand::kNotWider, "x: [1, 2]", "x: [1, 1.5]") == kKept);
  CHECK(held("regions", Demand::kNotWider, "x: [1, 2]", "x: [1, 2.5]") == kBroken);
  CHECK(held("regions", Demand::kNotWider, "r2: {x: [1, 2]}", "r2: {x: [1, 2]}, r3: {x: [2, 3]}") ==
        kBroken);
  CHECK(held("criterion", Demand::kNotWeaker, "epsilon: 0.1", "epsilon: 0.05") == kKept);
  CHECK(held("criterion", Demand::kNotWeaker, "epsilon: 0.1", "epsilon: 0.2") == kBroken);
  CHECK(held("criterion", Demand::kNotWeaker, "confidence: 0.95", "confidence: 0.9") == kBroken);
  CHECK(held("criterion", Demand::kNotWeaker, "sigma: rmse", "sigma: sse") == kOpen);
}

}  // namespace
}  // namespace parallax::tools
