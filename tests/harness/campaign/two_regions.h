#pragma once

// A scripted world of two regions on a line, which the campaign tests run instead of physics.

#include <doctest/doctest.h>
#include <stdlib.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "compiler/base/hash.h"
#include "harness/campaign/campaign.h"
#include "harness/sampling/sampler.h"
#include "tests/harness/campaign/named_trace.h"

namespace parallax::harness::test {

/// A folder that goes away with the object.
class TempFolder {
 public:
  explicit TempFolder(
      const std::filesystem::path& parent = std::filesystem::temp_directory_path()) {
    auto pattern = (parent / "parallax-XXXXXX").string();
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    path_ = pattern;
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline std::string slurp(const std::filesystem::path& path) {
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

/// Codes of the reports in order of place, without the code `but_for` that the test provokes on the
/// way.
inline std::vector<std::string> codes(const base::DiagnosticSink& sink,
                                      std::string_view but_for = {}) {
  std::vector<std::string> out;
  for (const auto& entry : sink.sorted()) {
    if (base::info(entry.code).id != but_for) out.emplace_back(base::info(entry.code).id);
  }
  return out;
}

inline base::Diagnostic first_error(const base::DiagnosticSink& sink) {
  for (const auto& entry : sink.sorted()) {
    if (base::info(entry.code).severity == base::Severity::kError) return entry;
  }
  FAIL("no error was reported");
  return sink.sorted().front();
}

/// These tests end their traces early on purpose.
inline constexpr std::string_view kLowLimit = "W7009";

inline constexpr const char* kScenarioText = R"(model: domain.e
horizon: 4
simulator: {command: [scripted]}
regions: {cells: {r1: {x: [0, 1]}, r2: {x: [1, 2]}}}
mapping:
  RobotIn(region): {inside: region, body: robot}
  BoxIn(region): {inside: region, body: box, unless: box.held}
  Holding(): {flag: box.held}
actions:
  Go(region): {controller: going, time_limit_s: 30}
  PickUp(): {controller: picking-up, object: box}
  Place(): {controller: placing, object: box}
)";

/// Departures of the scripted world from the model. Predicates look at the drawn start.
struct Script {
  using OfStart = std::function<bool(const State&)>;
  static bool never(const State&) { return false; }
  OfStart drops = never;                    // the box stays where it was
  OfStart invalid = never;                  // the start interpenetrates
  std::string loss = "numbers blew up";     // why
  OfStart loses = never;                    // the simulator is lost in the second action
  OfStart wobbles = never;                  // the robot passes through r1 before it picks up
  std::chrono::milliseconds drop_delay{0};  // runs that drop the box take so much longer
  bool deterministic = true;
  std::string determinism = "bitwise";  // its promises about itself and seeds
  bool seeds = true;
  double start_shift_m = 0.0;  // the robot starts so much off
  bool hides_box = false;      // observations lack box.x
  bool box_settable = true;    // reset takes box.x
  std::string refuses;         // an action that it does not know
  std::string start_failure;   // says this instead of hello
  std::atomic<int>* resets = nullptr;
  std::function<void()> on_act = [] {};
  std::function<void()> on_info = [] {};
};

inline double number(const State& state, const std::string& name) {
  return std::get<double>(state.at(name));
}

/// Starts at which the scripted worker drops the box if a test says so.
inline bool box_far(const State& start) { return number(start, "box.x") > 1.9; }

class ScriptedSimulator final : public Simulator {
 public:
  explicit ScriptedSimulator(const Script& script) : script_(script) {}

  SimulatorInfo info() override {
    script_.on_info();
    if (!script_.start_failure.empty()) return {"", script_.start_failure, "", false, {}, {}, 0.0};
    return {
        "scripted",
        "1",
        script_.determinism,
        script_.seeds,
        {{"box.held", "1", false}, {"box.x", "m", script_.box_settable}, {"robot.x", "m", true}},
        {"going", "picking-up", "placing"},
        0.002};
  }

  Outcome reset(const State& initial, std::uint64_t seed) override {
    if (script_.resets != nullptr) ++*script_.resets;
    initial_ = initial;
    seed_ = seed;
    acts_ = 0;
    held_ = false;
    robot_m_ = number(initial, "robot.x") + script_.start_shift_m;
    box_m_ = number(initial, "box.x");
    if (script_.invalid(initial)) {
      return {SimStatus::kInvalidStart, "box and robot overlap by 3 mm", 0.0, {}};
    }
    return {};
  }

  Outcome act(std::string_view action, const State& arguments, double) override {
    script_.on_act();
    ++acts_;
    if (action == script_.refuses) return {SimStatus::kUnsupported, "no such action", 0.0, {}};
    if (acts_ == 2 && script_.loses(initial_)) return {SimStatus::kLost, script_.loss, 0.0, {}};
    const bool drops = script_.drops(initial_);
    if (drops && acts_ == 1) std::this_thread::sleep_for(script_.drop_delay);
    if (action == "going") robot_m_ = number(arguments, "target.x");
    if (action == "picking-up") {
      held_ = !drops;
      if (script_.wobbles(initial_)) robot_m_ = 0.25;
      if (drops) return {SimStatus::kFailed, "slipped", 1.5, {}};
    }
    // Where the box is put down depends on the start, as it does in a world with physics.
    if (action == "placing" && held_) {
      held_ = false;
      box_m_ = 0.4 + 0.1 * number(initial_, "box.x");
    }
    return {SimStatus::kOk, "", 0.5, {}};
  }

  State observe() override {
    static std::atomic<int> calls = 0;
    const double noise_m = script_.deterministic ? 0.0 : 1e-9 * ++calls;
    State state = {{"robot.x", robot_m_ + noise_m}, {"box.held", held_}};
    if (!script_.hides_box) state["box.x"] = held_ ? robot_m_ : box_m_;
    state["digest"] = std::to_string(seed_) + "/" + std::to_string(acts_);
    return state;
  }

 private:
  Script script_;
  State initial_;
  std::uint64_t seed_ = 0;
  int acts_ = 0;
  bool held_ = false;
  double robot_m_ = 0.0, box_m_ = 0.0;
};

/// Openness of the model, and its answers to questions.
struct Openness {
  bool initial_states = false, outcomes = false;
  bool is_stopped = false;  // the search ends before it is at its end, and decides nothing more
  /// Judges the last state of a question.
  std::function<bool(const std::map<std::string, bool>&)> admits =
      [](const std::map<std::string, bool>&) { return false; };
  std::vector<std::size_t>* asked = nullptr;  // fluents by timepoint, of the last question
};

/// Traces of one plan: fetch the box from r2 to r1. They differ in their key only.
class ListFeed final : public TraceFeed {
 public:
  explicit ListFeed(std::int64_t count, Openness openness = {})
      : count_(count), openness_(std::move(openness)) {}
  base::Result<std::optional<CampaignTrace>> next() override {
    if (given_ == count_) return std::optional<CampaignTrace>();
    auto out = trace(++given_);
    if (openness_.initial_states) out.other_initial_states = base::Known::kYes;
    if (openness_.outcomes) out.other_outcomes = base::Known::kYes;
    return std::optional<CampaignTrace>(std::move(out));
  }
  base::Known admits(const CampaignTrace& trace,
                     const std::vector<std::map<compiler::FluentId, bool>>& observed) override {
    CHECK(trace.number <= given_);
    REQUIRE(observed.size() == trace.points.size());
    if (openness_.asked != nullptr) {
      openness_.asked->clear();
      for (const auto& state : observed) openness_.asked->push_back(state.size());
    }
    if (openness_.is_stopped) return base::Known::kUndecided;
    std::map<std::string, bool> by_name;
    for (const auto& [id, holds] : observed.back()) by_name[trace.symbols->name(id)] = holds;
    return openness_.admits(by_name) ? base::Known::kYes : base::Known::kNo;
  }
  std::string exploration() const override {
    return openness_.is_stopped ? "stopped" : "all traces explored";
  }
  runtime::Symbols symbols() const override { return table(); }

  static CampaignTrace trace(std::int64_t number) {
    return named_trace(number, "fetch " + std::to_string(number),
                       {{"BoxIn(r2)", "RobotIn(r1)"},
                        {"BoxIn(r2)", "RobotIn(r2)"},
                        {"Holding()", "RobotIn(r2)"},
                        {"Holding()", "RobotIn(r1)"},
                        {"BoxIn(r1)", "RobotIn(r1)"}},
                       {{"Go(r2)", {"fetch.lisp:2", {{"target.x", 1.25}}}},
                        {"PickUp()", {"fetch.lisp:3", {}}},
                        {"Go(r1)", {"fetch.lisp:4", {{"target.x", 0.5}}}},
                        {"Place()", {"fetch.lisp:5", {}}}},
                       table());
  }

 private:
  std::int64_t count_;
  Openness openness_;
  std::int64_t given_ = 0;
  /// A symbol table whose ids are not in order of the names, as models need not be.
  static Table table() {
    return table_of({"RobotIn(r1)", "RobotIn(r2)", "BoxIn(r1)", "BoxIn(r2)", "Holding()"});
  }
};

/// One campaign in a folder of its own, with everything that it needs.
struct Bench {
  TempFolder folder;
  base::SourceFiles files;
  base::DiagnosticSink sink;
  Scenario scenario;
  Script script;
  CampaignOptions options;
  std::int64_t traces = 1;
  Openness openness;
  std::atomic<int> simulators = 0;  // made so far

  explicit Bench(const std::string& text = kScenarioText) {
    folder.write("domain.e", "sort region\n");
    auto loaded = load_scenario(folder.write("scenario.yaml", text), files, sink);
    REQUIRE(loaded.has_value());
    scenario = std::move(*loaded);
    scenario.name = "scenario.yaml";  // not the folder, which is another one in every run
    options.run_dir = folder.path() / "run";
    options.scenario_hash = "5ce0";
    options.tool_version = "0.1.0";
  }

  base::Result<CampaignResult> run() {
    ListFeed feed(traces, openness);
    const auto factory = [this] {
      ++simulators;
      return std::make_unique<ScriptedSimulator>(script);
    };
    return run_campaign(scenario, feed, factory, options, files, sink);
  }

  std::filesystem::path journal() const { return options.run_dir / "journal.ndjson"; }
};

/// The built-in simulator has bodies, to which arguments are held.
inline void pretend_built_in(Scenario& scenario) {
  scenario.simulator.command.clear();
  BodySpec box;
  box.name = "box";
  box.shapes = {{{0.1, 0.1, 0.1}, {0.0, 0.0, 0.0}, 0.0}};
  box.mass_kg = 0.3;
  scenario.world.bodies.push_back(box);
}

/// The start of a sample, drawn without the campaign.
inline State drawn_start(const Bench& bench, std::int64_t trace, std::int64_t sample,
                         std::int64_t attempt = 0) {
  StartCuboid cuboid{{{"box.x", {1.0, 2.0, false}}, {"robot.x", {0.0, 1.0, false}}}};
  base::DiagnosticSink sink;
  const auto sampler = Sampler::make(cuboid, bench.scenario.sampling_inset_m, {}, sink);
  REQUIRE(sampler.has_value());
  const auto key = base::fnv1a64(ListFeed::trace(trace).key);
  return sampler->draw({bench.options.seed, key, DrawPhase::kCertify,
                        static_cast<std::uint64_t>(sample), static_cast<std::uint64_t>(attempt)});
}

}  // namespace parallax::harness::test
