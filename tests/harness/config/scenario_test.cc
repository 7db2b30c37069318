#include "harness/config/scenario.h"

#include "harness/engine/engine_module.h"
#include "tests/harness/config/scenario_text.h"

namespace parallax::harness::test {
namespace {

TEST_CASE("a scenario is read with defaults, paths beside its file, and the world it includes") {
  Workspace workspace;
  const auto scenario = workspace.load(kScenario);
  REQUIRE_MESSAGE(scenario.has_value(), workspace.reports().front());
  REQUIRE(scenario->models.size() == 2);
  CHECK(scenario->models[0].text == (workspace.folder() / "domain.e").string());
  REQUIRE(scenario->plan.size() == 1);
  CHECK(scenario->plan[0].text == (workspace.folder() / "fetch.lisp").string());
  CHECK(scenario->horizon == 6);
  REQUIRE(scenario->constraints.size() == 1);
  // The range is the text without its quotes, so that an error inside it can be placed.
  CHECK(workspace.files.text(scenario->constraints[0].source) == "HoldsAt(BoxIn(r1),time)");
  CHECK(scenario->constraints[0].text == "HoldsAt(BoxIn(r1),time)");
  CHECK(scenario->criterion.kind == CriterionKind::kCleanRuns);
  CHECK(scenario->criterion.confidence_level == 0.99);
  CHECK(scenario->criterion.paper.preset == "paper-literal");
  CHECK(scenario->simulator.command.empty());
  CHECK(scenario->limits.max_runs == 0);  // as the criterion needs
  CHECK_FALSE(scenario->expect.has_value());
  CHECK(scenario->sampling_inset_m == 0.001);
  REQUIRE(scenario->sampling.size() == 2);
  CHECK(scenario->sampling[0].variable == "box.y");
  CHECK(scenario->sampling[0].interval.width() == 0.0);
  CHECK(scenario->sampling[1].interval.lower == -0.1);
}

TEST_CASE("bodies, joints, friction and robot arrive as they were written") {
  Workspace workspace;
  const auto scenario = workspace.load(kScenario);
  REQUIRE(scenario.has_value());
  const auto& world = scenario->world;
  REQUIRE(world.bodies.size() == 6);
  CHECK(world.bodies[0].name == "arm");  // sorted, whatever the order in the text
  CHECK(world.bodies[2].name == "box");
  CHECK(world.bodies[2].shapes[0].size_m == Eigen::Vector3d(0.07, 0.07, 0.07));
  CHECK(world.bodies[2].settable == std::vector<std::string>{"x", "y", "yaw"});
  REQUIRE(world.joints.size() == 5);
  CHECK(world.joints[0].name == "drive");
  CHECK(world.joints[0].parent.empty());
  CHECK(world.joints[3].axis_W == Eigen::Vector3d::UnitX());
  CHECK(world.joints[4].type == JointType::kFixed);
  CHECK(world.friction.pairs.at({"box", "pad"}) == 0.6);
  CHECK(world.robot.far_pad_body == "far");
}

TEST_CASE("what is written beside `include` is laid over it, map by map") {
  Workspace workspace;
  const auto scenario = workspace.load(
      replaced(kScenario, "{include: world.yaml}",
               "{include: world.yaml, friction: {box-pad: 0.0}, bodies: {box: {mass_kg: 0.5}}}"));
  REQUIRE(scenario.has_value());
  CHECK(scenario->world.friction.pairs.at({"box", "pad"}) == 0.0);
  CHECK(scenario->world.friction.fallback == 0.5);
  CHECK(scenario->world.bodies[2].mass_kg == 0.5);
  CHECK(scenario->world.bodies[2].material == "box");

  workspace.write("base.yaml", kScenario);
  const auto variant = workspace.load("include: base.yaml\nhorizon: 9\nlimits: {max_runs: 5}\n");
  REQUIRE(variant.has_value());
  CHECK(variant->horizon == 9);
  CHECK(variant->limits.max_runs == 5);
  CHECK(variant->actions.size() == 3);
}

TEST_CASE("mapping and actions refer to the parameters of their patterns") {
  Workspace workspace;
  auto text = replaced(kScenario, "Holding(): {flag: box.held}",
                       "\"Held(body)\": {flag: \"{body}.held\"}\n"
                       "  \"On( a , where )\": {inside: where, body: \"{a}\", only_if: box.held}\n"
                       "  Tired(): ignored");
  text = replaced(
      text, "PickUp(): {controller: picking-up, object: box}",
      "\"PickUp(arm, thing)\": {controller: picking-up, object: \"{thing}\", settle_s: 1}");
  const auto scenario = workspace.load(text);
  REQUIRE_MESSAGE(scenario.has_value(), workspace.reports().front());
  const auto* held = scenario->mapping->find("Held");
  REQUIRE(held != nullptr);
  CHECK(held->arity == 1);
  CHECK(std::get<FlagBinding>(held->condition).variable == "{0}.held");
  const auto& on = std::get<InsideBinding>(scenario->mapping->find("On")->condition);
  CHECK(on.region_argument == 1);
  CHECK(on.body == "{0}");
  CHECK(on.only_if == "box.held");
  CHECK(std::holds_alternative<IgnoredBinding>(scenario->mapping->find("Tired")->condition));
  CHECK(scenario->actions[1].event == "PickUp");
  CHECK(scenario->actions[1].arity == 2);
  CHECK(std::get<std::string>(scenario->actions[1].arguments.at("object")) == "{1}");
  CHECK(std::get<double>(scenario->actions[1].arguments.at("settle_s")) == 1.0);
  CHECK(std::get<double>(scenario->actions[2].arguments.at("target.x")) == 0.5);
  CHECK(scenario->actions[0].time_limit_s == 30.0);
}

TEST_CASE("criterion, simulator, limits and expectations are read in full") {
  Workspace workspace;
  const auto scenario = workspace.load(std::string(kScenario) + R"(name: all of it
criterion: {kind: paper, confidence: 0.95, preset: paper-repaired, sigma: rmse, bonferroni: true}
simulator: {command: [python3, sim.py], act_timeout_s: 4, recycle_after: 200, memory_mb: 512}
limits: {max_runs: 7, max_traces: 2, max_rejected_starts: 3, max_lost_in_a_row: 4}
expect: {verdict: discrepancy, iterations: 1, max_simulations: 20, fluents: [BoxIn(r1)]}
)");
  REQUIRE_MESSAGE(scenario.has_value(), workspace.reports().front());
  CHECK(scenario->title == "all of it");
  CHECK(scenario->criterion.kind == CriterionKind::kPaper);
  CHECK(scenario->criterion.confidence_level == 0.95);
  CHECK(scenario->criterion.paper.sigma == SigmaKind::kRmse);
  CHECK(scenario->criterion.paper.intercept == InterceptKind::kFree);
  CHECK(scenario->criterion.paper.bonferroni);
  CHECK(scenario->criterion.paper.preset == "custom, from paper-repaired");
  CHECK(scenario->simulator.command == std::vector<std::string>{"python3", "sim.py"});
  CHECK(scenario->simulator.act_timeout_s == 4.0);
  CHECK(scenario->simulator.memory_mb == 512);
  CHECK(scenario->limits.max_lost_in_a_row == 4);
  REQUIRE(scenario->expect.has_value());
  CHECK(scenario->expect->verdict == "discrepancy");
  CHECK(scenario->expect->fluents == std::vector<std::string>{"BoxIn(r1)"});
}

TEST_CASE("an engine is for the simulator and for its world, and one that is missing is refused") {
  Workspace workspace;
  for (const EngineKind engine : {EngineKind::kMujoco, EngineKind::kBullet}) {
    const std::string name(to_string(engine));
    for (const std::string& text :
         {"simulator: " + name + "\n", "simulator: {engine: " + name + ", memory_mb: 200}\n"}) {
      CAPTURE(text);
      const auto scenario = workspace.load(std::string(kScenario) + text);
      if (!has_engine(engine)) {
        CHECK_FALSE(scenario.has_value());
        CHECK(workspace.reports().front().find("E5145") != std::string::npos);
        CHECK(workspace.reports().front().find("lib" + name + "-dev") != std::string::npos);
        continue;
      }
      REQUIRE(scenario.has_value());
      CHECK(scenario->simulator.is_built_in());
      CHECK(scenario->simulator.engine == engine);
      CHECK(scenario->world.engine == engine);
    }
  }
  const auto usual = workspace.load(kScenario);
  REQUIRE(usual.has_value());
  CHECK(usual->world.engine == EngineKind::kOde);
}

TEST_CASE("a criterion may be named by one word") {
  Workspace workspace;
  const auto scenario = workspace.load(std::string(kScenario) + "criterion: paper\n");
  REQUIRE(scenario.has_value());
  CHECK(scenario->criterion.kind == CriterionKind::kPaper);
}

TEST_CASE("every criterion has a word, and readings of the paper's rule have theirs") {
  Workspace workspace;
  for (std::size_t i = 0; i < kCriterionWords.size(); ++i) {
    const auto scenario = workspace.load(std::string(kScenario) +
                                         "criterion: " + std::string(kCriterionWords[i]) + "\n");
    REQUIRE(scenario.has_value());
    CHECK(scenario->criterion.kind == static_cast<CriterionKind>(i));
  }
  const auto repaired = workspace.load(std::string(kScenario) + "criterion: paper-repaired\n");
  REQUIRE(repaired.has_value());
  CHECK(repaired->criterion.kind == CriterionKind::kPaper);
  CHECK(repaired->criterion.paper.preset == "paper-repaired");
  const auto fixed =
      workspace.load(std::string(kScenario) + "criterion: {kind: clopper-pearson, runs: 120}\n");
  REQUIRE(fixed.has_value());
  CHECK(fixed->criterion.runs == 120);
  CHECK_FALSE(workspace.load(std::string(kScenario) + "criterion: {kind: anytime, runs: 120}\n"));
}

TEST_CASE("the scenario is held against the ground model") {
  Workspace workspace;
  const auto scenario = workspace.load(kScenario);
  REQUIRE(scenario.has_value());
  base::DiagnosticSink& sink = workspace.sink;
  SUBCASE("which it fits") {
    CHECK(check_against_model(*scenario,
                              {"BoxIn(r1)", "BoxIn(r2)", "Holding()", "RobotIn(r1)", "RobotIn(r2)"},
                              {"Go(r1)", "Go(r2)", "PickUp()", "Place(r1)"}, sink)
              .has_value());
    CHECK(workspace.reports().empty());
  }
  SUBCASE("which has more than it maps") {
    CHECK_FALSE(check_against_model(*scenario, {"BoxAt(r1)", "BoxAt(r2)", "BoxIn(r3)"},
                                    {"Pickup()", "Go(r1,r2)", "Go(r2,r1)"}, sink)
                    .has_value());
    const auto reports = workspace.reports();
    // Each symbol once: fluent, region, event, arity; and symbols that nothing answers to as
    // warnings.
    REQUIRE(reports.size() == 8);
    CHECK(reports[0].find("E5303 at 10:1: fluent `BoxAt`") == 0);
    CHECK(reports[1].find("W5127 at 11:3: the model has no fluent `RobotIn`") == 0);
    CHECK(reports[2].find("E5305 at 12:3") == 0);
    CHECK(reports[3].find("W5127 at 13:3: the model has no fluent `Holding`") == 0);
    CHECK(reports[4] ==
          "E5118 at 14:1: the event `Pickup` has no action fix: replace `Pickup` with `PickUp`");
    CHECK(reports[5].find("E5123 at 15:3: the event `Go(r1,r2)` has 2 argument(s)") == 0);
    CHECK(reports[6].find("W5128 at 16:3: no event of the model is called `PickUp`") == 0);
    CHECK(reports[7].find("W5128 at 17:3") == 0);
  }
}

TEST_CASE("variables that depend on a fluent's arguments must be observed, each of them") {
  Workspace workspace;
  const auto text = replaced(kScenario, "Holding(): {flag: box.held}",
                             "\"Holding(item)\": {flag: \"{item}.hold\"}");
  const auto scenario = workspace.load(text);
  REQUIRE(scenario.has_value());
  const std::vector<std::string> events = {"Go(r1)", "PickUp()", "Place(r1)"};
  const std::vector<std::string> fluents = {"BoxIn(r1)", "Holding(box)", "Holding(cup)",
                                            "RobotIn(r1)"};
  SUBCASE("by the built-in simulator") {
    CHECK_FALSE(check_against_model(*scenario, fluents, events, workspace.sink).has_value());
    const auto reports = workspace.reports();
    REQUIRE(reports.size() == 1);  // only the first of several fluents of an entry
    CHECK(reports[0] ==
          "E5115 at 13:4: the simulator has no variable `box.hold` fix: replace "
          "`box.hold` with `box.held`");
  }
  SUBCASE("a body that does not exist") {
    const auto right = workspace.load(replaced(text, "{item}.hold", "{item}.held"));
    REQUIRE(right.has_value());
    CHECK_FALSE(check_against_model(*right, fluents, events, workspace.sink).has_value());
    const auto reports = workspace.reports();
    REQUIRE(reports.size() == 1);
    CHECK(reports[0].find("E5115 at 13:4: the simulator has no variable `cup.held`") == 0);
  }
  SUBCASE("by another simulator, as far as it says what it observes") {
    SimulatorInfo info{"other", "1", "bitwise", true, {}, {}, 0.01};
    std::vector<GroundFluent> ground;
    for (const auto& fluent : fluents) ground.push_back(ground_fluent(fluent));
    CHECK(check_against_simulator(*scenario, ground, info, workspace.sink).has_value());
    for (const auto& [name, unit] :
         std::vector<std::pair<std::string, std::string>>{{"box.held", "1"},
                                                          {"box.x", "m"},
                                                          {"box.y", "m"},
                                                          {"box.yaw", "rad"},
                                                          {"robot.x", "m"}}) {
      info.parameters.push_back({name, unit, true});
    }
    CHECK_FALSE(check_against_simulator(*scenario, ground, info, workspace.sink).has_value());
    CHECK(workspace.reports().size() == 1);
  }
}

TEST_CASE("a scenario in which no fluent of the model is compared is refused at its mapping") {
  Workspace workspace;
  auto text = replaced(kScenario, "Holding(): {flag: box.held}", "Holding(): ignored");
  const auto some = workspace.load(text);
  REQUIRE(some.has_value());
  const std::vector<std::string> events = {"Go(r1)", "PickUp()", "Place(r1)"};
  CHECK(check_against_model(*some, {"BoxIn(r1)", "Holding()"}, events, workspace.sink).has_value());
  workspace.sink = base::DiagnosticSink();
  CHECK_FALSE(check_against_model(*some, {"Holding()"}, events, workspace.sink).has_value());
  const auto reports = workspace.reports();
  REQUIRE_FALSE(reports.empty());
  CHECK(reports[0] == "E5306 at 10:1: no fluent of the model is compared");
}

TEST_CASE("a fluent that asks for every step is refused where last states are compared") {
  Workspace workspace;
  const auto text =
      replaced(kScenario, "{flag: box.held}", "{flag: box.held, compare: every-step}");
  const std::vector<std::string> fluents = {"BoxIn(r1)", "Holding()", "RobotIn(r1)"};
  const std::vector<std::string> events = {"Go(r1)", "PickUp()", "Place(r1)"};
  const auto steps = workspace.load(text);
  REQUIRE(steps.has_value());
  CHECK(check_against_model(*steps, fluents, events, workspace.sink).has_value());
  for (const std::string final : {"compare: final\n", "criterion: paper\n"}) {
    CAPTURE(final);
    workspace.sink = base::DiagnosticSink();
    const auto last = workspace.load(text + final);
    REQUIRE(last.has_value());
    CHECK_FALSE(check_against_model(*last, fluents, events, workspace.sink).has_value());
    const auto reports = workspace.reports();
    REQUIRE_FALSE(reports.empty());
    CHECK(reports[0] ==
          "E5137 at 13:3: `compare: every-step` of `Holding` has no effect: only last "
          "states are compared");
  }
}

TEST_CASE("densities that no household thing has are warned of where they stand") {
  Workspace workspace;
  CHECK(workspace.load(kScenario).has_value());
  CHECK(workspace.reports().empty());
  workspace.write("world.yaml", replaced(kWorld, "mass_kg: 0.3", "mass_kg: 30"));
  CHECK(workspace.load(kScenario).has_value());
  REQUIRE(workspace.reports().size() == 1);
  CAPTURE(workspace.reports()[0]);
  CHECK(workspace.reports()[0].find("W5136 at 8:46: bodies/box/mass_kg makes `box` a thing of "
                                    "8.746e+04 kg/m3: no household thing weighs so much") == 0);
}

TEST_CASE("the scenario is held against what the simulator says of itself") {
  Workspace workspace;
  const auto scenario = workspace.load(std::string(kScenario) + "simulator: {command: [other]}\n");
  REQUIRE(scenario.has_value());
  SimulatorInfo info{"other", "1", "bitwise", true, {}, {}, 0.01};
  CHECK(check_against_simulator(*scenario, {}, info, workspace.sink).has_value());  // says nothing
  info.parameters = {{"box.x", "m", true},
                     {"box.held", "1", false},
                     {"robot.x", "m", true},
                     {"box.y", "m", true},
                     {"box.yaw", "rad", false}};
  info.actions = {"going", "pickingup", "placing"};
  CHECK_FALSE(check_against_simulator(*scenario, {}, info, workspace.sink).has_value());
  const auto first = workspace.reports();
  REQUIRE(first.size() == 1);
  CHECK(first[0] == "E5116 at 18:52: the simulator cannot start with a chosen `box.yaw`");
  info.parameters.back().settable = true;
  workspace.sink = base::DiagnosticSink();
  CHECK_FALSE(check_against_simulator(*scenario, {}, info, workspace.sink).has_value());
  const auto second = workspace.reports();
  REQUIRE(second.size() == 1);
  CHECK(second[0].find("E5120 at 16:3: there is no controller `picking-up`") == 0);
}

}  // namespace
}  // namespace parallax::harness::test
