#include <sys/stat.h>

#include "harness/config/scenario.h"
#include "tests/harness/config/scenario_text.h"

namespace parallax::harness::test {
namespace {

/// One change to a sound scenario and the one report that it must give.
struct Case {
  std::string from, to, report;
};

void check_each(const std::vector<Case>& cases) {
  Workspace workspace;
  for (const auto& one : cases) {
    CAPTURE(one.to);
    CHECK_FALSE(workspace.load(replaced(kScenario, one.from, one.to)).has_value());
    const auto reports = workspace.reports();
    REQUIRE(reports.size() == 1);
    CHECK(reports[0].substr(0, one.report.size()) == one.report);
    CHECK(workspace.sink.exit_code() == 3);
  }
}

TEST_CASE("keys and values of the scenario itself") {
  check_each({
      {"horizon: 6", "horizn: 6\nhorizon: 6",
       "E5102 at 6:1: `horizn` is not a key of the scenario fix: replace `horizn` with `horizon`"},
      {"horizon: 6", "horizon: 6\nhorizon: 7", "E5103 at 7:1: the key `horizon` is given twice"},
      {"horizon: 6\n", "", "E5106 at 1:1: the scenario lacks the key `horizon`"},
      {"horizon: 6", "horizon: six", "E5107 at 6:10: `horizon` is `six`, not an integer"},
      {"horizon: 6", "horizon: 0", "E5109 at 6:10: `horizon` is 0, but must be from 1 to"},
      {"horizon: 6", "horizon: \"6\"", "E5107 at 6:11: `horizon` is `6`, not an integer"},
      {"horizon: 6", "horizon: 99999999999999999999", "E5107 at 6:10"},
      {"model: [domain.e, start.e]", "model: [domain.e, strat.e]", "E0001 at 1:19: cannot open"},
      {"model: [domain.e, start.e]", "model: []", "E5107 at 1:1: `model` is empty"},
      {"plan: fetch.lisp\n", "", "E5106 at 2:7: the scenario lacks the key `plan`"},
      {"{include: world.yaml}", "{include: wrld.yaml}", "E0001 at 7:18: cannot open the file"},
      {"{include: world.yaml}", "[1, 2]", "E5107 at 7:1: `world` is a list, not a map"},
      {"world: {include: world.yaml}\n", "", "E5106 at 1:1: the scenario lacks the key `world`"},
  });
}

TEST_CASE("regions, mapping and sampling") {
  check_each({
      {"r2: {x: [1, 2]}", "r2: {x: [2, 1]}",
       "E5201 at 9:28: region `r2`: the x bounds are reversed"},
      {"r2: {x: [1, 2]}", "r2: {x: [1.5, 2]}", "E5205 at "},
      {"r2: {x: [1, 2]}", "r2: {x: [1, .inf]}", "E5108 at 9:40: `.inf` is not a finite number"},
      {"r2: {x: [1, 2]}", "r2: {x: [1, NaN]}", "E5108 at 9:40: `NaN` is not a finite number"},
      {"r2: {x: [1, 2]}", "r2: {x: [1, 1e999]}", "E5108 at 9:40"},
      {"r2: {x: [1, 2]}", "r2: {x: [1, 0x2]}", "E5107 at 9:40"},
      {"r2: {x: [1, 2]}", "r2: {x: 1}", "E5107 at 9:36: `x` of the region `r2` is `1`, not a list"},
      {"r2: {x: [1, 2]}", "r2: {X: [1, 2]}", "E5102 at 9:33: `X` is not a key of the region `r2`"},
      {"  cells: {r1", "  gaps: alowed\n  cells: {r1",
       "E5111 at 9:9: `alowed` is not a known value of `gaps` fix: replace `alowed` with "
       "`allowed`"},
      {"inside: region, body: robot", "inside: regio, body: robot",
       "E5113 at 11:29: `regio` is not a parameter of `RobotIn` fix: replace `regio` with "
       "`region`"},
      {"inside: region, body: robot", "inside: region, body: robto",
       "E5115 at 11:3: the simulator has no variable `robto.x` fix: replace `robto.x` with "
       "`robot.x`"},
      {"inside: region, body: robot", "inside: region", "E5106 at 11:3"},
      {"unless: box.held", "unless: bx.held", "E5115 at 12:3"},
      {"unless: box.held", "unles: box.held", "E5102 at 12:46"},
      {"flag: box.held", "flag: \"{box.held\"",
       "E5133 at 13:22: a `{` in `{box.held` has no partner"},
      {"flag: box.held", "flag: \"box}.held\"", "E5133 at 13:22: a `}` in `box}.held` has no"},
      {"flag: box.held", "flag: \"{box{x}.held\"", "E5133 at 13:22: a `{` in"},
      {"body: robot}", "body: \"{region\"}", "E5133 at 11:44: a `{` in `{region` has no partner"},
      {"Holding(): {flag: box.held}", "Holding(: {flag: box.held}", "E5112 at 13:3"},
      {"Holding(): {flag: box.held}", "\"BoxIn(x)\": {flag: box.held}", "E5103 at 13:4"},
      {"Holding(): {flag: box.held}", "Holding(): ignore", "E5107 at 13:14"},
      {"body: robot}", "body: robot, upright: 2}", "E5109 at 11:59: `upright` is 2, but must be"},
      {"max_speed_m_s: 0.6", "grip_force_n: 0.6", "E5121 at 15:35"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: [0.1, -0.1]",
       "E5125 at 18:52: `box.yaw` is reversed: 0.1 is above -0.1"},
      {"box.yaw: [-0.1, 0.1]", "box.roll: [-0.1, 0.1]",
       "E5116 at 18:52: the simulator cannot start with a chosen `box.roll`"},
      {"box.yaw: [-0.1, 0.1]", "bax.yaw: 0", "E5115 at 18:5"},
      {"inset_m: 0.001", "inset_m: -1", "E5109 at 18:21: `inset_m` is -1, but must be at least 0"},
  });
}

TEST_CASE("laws of the sampling, each error at its word") {
  check_each({
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {normal: {mean: 0, sd: 0.0}}",
       "E5109 at 18:84: `sd` is 0.0, but must be above 0"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {normal: {mean: .nan, sd: 1}}",
       "E5108 at 18:77: `.nan` is not a finite number"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {normal: {mean: 0}}",
       "E5106 at 18:62: `normal` lacks the key `sd`"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {normal: {mean: 0, sd: 1}, within: [0.2, 0.1]}",
       "E5125 at 18:88: `within` is reversed: 0.2 is above 0.1"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {normal: {mean: 0, sd: 1}, within: [50, 60]}",
       "E5152 at 18:88: `box.yaw` is normal with mean 0 and sd 1, which has no mass in 50 to 60"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {triangular: [0, 2, 1]}",
       "E5125 at 18:78: `triangular` is reversed: 2 is above 1"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {triangular: [0, 1]}",
       "E5107 at 18:62: `triangular` is a list, not a list of lower bound, mode and upper bound"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {choice: {}}",
       "E5107 at 18:62: `choice` is an empty map, not a map from values to their weights"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {choice: {0.1: 1, 0.2: -1}}",
       "E5109 at 18:84: the weight of 0.2 is -1, but must be above 0"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {choice: {0.1: 1, 0.10: 1}}",
       "E5103 at 18:79: the key `0.10` is given twice"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {choice: {a: 1}}",
       "E5107 at 18:71: a value of `choice` is `a`, not a number"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {choice: {0.1: 1}, within: [0.2, 0.3]}",
       "E5152 at 18:80: `box.yaw` is 0.1 (100 %), which has no mass in 0.2 to 0.3"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {uniform: [1, 0]}",
       "E5125 at 18:62: `uniform` is reversed"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {unifrom: [0, 1]}",
       "E5102 at 18:62: `unifrom` is not a key of the law of `box.yaw` fix: replace `unifrom` with "
       "`uniform`"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {uniform: [0, 1], choice: {1: 1}}",
       "E5109 at 18:79: `choice` is given besides `uniform`, but must be alone"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {formula: \"box.x + \"}",
       "E5150 at 18:78: the formula cannot be read: it ends where a value is wanted"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {formula: \"0.1 * bax.x\"}",
       "E5115 at 18:78: the simulator has no variable `bax.x` fix: replace `bax.x` with `box.x`"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {formula: \"2 * box.yaw\"}",
       "E5150 at 18:76: the formula cannot be read: `box.yaw` needs its own value"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {formula: \"box.x < 1\"}",
       "E5150 at 18:72: the formula cannot be read: it is true or false, where a number is wanted"},
      {"box.yaw: [-0.1, 0.1]}", "box.yaw: [-0.1, 0.1]}, require: [\"box.x < 1.5 +\"]",
       "E5150 at 18:98: the formula cannot be read"},
      {"box.yaw: [-0.1, 0.1]}", "box.yaw: [-0.1, 0.1]}, require: [\"box.x + 1\"]",
       "E5150 at 18:86: the formula cannot be read: it is a number, where a condition is wanted"},
      {"box.yaw: [-0.1, 0.1]}", "box.yaw: [-0.1, 0.1]}, require: [\"box.x < rbot.x\"]",
       "E5115 at 18:94: the simulator has no variable `rbot.x` fix: replace `rbot.x` with "
       "`robot.x`"},
      {"box.yaw: [-0.1, 0.1]}",
       "box.yaw: [-0.1, 0.1]}, areas: {box: {disc: {at_m: [0, 0], radius_m: 0}}}",
       "E5109 at 18:120: `radius_m` is 0, but must be above 0"},
      {"box.yaw: [-0.1, 0.1]}",
       "box.yaw: [-0.1, 0.1]}, areas: {box: {disc: {at_m: [0, .inf], radius_m: 1}}}",
       "E5108 at 18:106: `.inf` is not a finite number"},
      {"box.yaw: [-0.1, 0.1]}",
       "box.yaw: [-0.1, 0.1]}, areas: {box: {ring: {at_m: [0, 0], inner_m: 2, outer_m: 1}}}",
       "E5154 at 18:89: `ring` goes from 2 to 1 m"},
      {"box.yaw: [-0.1, 0.1]}",
       "box.yaw: [-0.1, 0.1]}, areas: {box: {polygon: [[0, 0], [1, 1], [1, 0], [0, 1]]}}",
       "E5154 at 18:89: `polygon` crosses or touches itself"},
      {"box.yaw: [-0.1, 0.1]}", "box.yaw: [-0.1, 0.1]}, areas: {box: {polygon: [[0, 0], [1, 1]]}}",
       "E5154 at 18:89: `polygon` has 2 corners"},
      {"box.yaw: [-0.1, 0.1]}", "box.yaw: [-0.1, 0.1]}, areas: {box: {union: []}}",
       "E5107 at 18:89: `union` is"},
      {"box.yaw: [-0.1, 0.1]}",
       "box.yaw: [-0.1, 0.1]}, areas: {bx: {disc: {at_m: [0, 0], radius_m: 1}}}",
       "E5115 at 18:83: the simulator has no variable `bx.x` fix: replace `bx.x` with `box.x`"},
      {"box.yaw: [-0.1, 0.1]}",
       "box.yaw: [-0.1, 0.1]}, areas: {box: {half_planes: [{of: robot, towards: [0, 0]}]}}",
       "E5109 at 18:115: `towards` is (0, 0), but must be a direction"},
      {"box.yaw: [-0.1, 0.1]}", "box.yaw: [-0.1, 0.1]}, parameters: {robot.x: [0, 1]}",
       "E5109 at 18:88: `robot.x` of `parameters` is a variable of the simulator, but must be "
       "under `variables`"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {normal: {mean: 1e308, sd: 1}}",
       "E5109 at 18:77: `mean` is 1e308, but must be at least -1000000000000 and at most"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {triangular: [-1e300, 0, 1]}",
       "E5109 at 18:75: `triangular` is -1e300, but must be"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {choice: {0.1: 1e300}}",
       "E5109 at 18:76: the weight of 0.1 is 1e300, but must be"},
      {"box.yaw: [-0.1, 0.1]", "box.yaw: {choice: 1}",
       "E5107 at 18:70: `choice` is `1`, not a map from values to their weights"},
  });
}

TEST_CASE("actions, criterion, simulator, limits and expectations") {
  check_each({
      {"{controller: picking-up, object: box}", "{object: box}",
       "E5119 at 16:3: the action of `PickUp()` names no controller"},
      {"controller: picking-up", "controller: picking-upp",
       "E5120 at 16:26: there is no controller `picking-upp` fix: replace `picking-upp` with "
       "`picking-up`"},
      {"max_speed_m_s: 0.6", "max_sped_m_s: 0.6",
       "E5121 at 15:35: the controller `going` takes no argument `max_sped_m_s`"},
      {"max_speed_m_s: 0.6", "max_speed_m_s: fast", "E5107 at 15:50"},
      {"max_speed_m_s: 0.6", "max_speed_m_s: .nan", "E5108 at 15:50"},
      {"object: box}", "object: \"{thing}\"}", "E5113 at 16:47"},
      {"time_limit_s: 30", "time_limit_s: 0", "E5109 at 15:69"},
      {"horizon: 6", "horizon: 6\ncriterion: clean-run",
       "E5111 at 7:12: `clean-run` is not a known criterion fix: replace `clean-run` with "
       "`clean-runs`"},
      {"horizon: 6", "horizon: 6\ncriterion: {epsilon: 1.0}",
       "E5109 at 7:22: `epsilon` is 1.0, but must be above 0 and below 1"},
      {"horizon: 6", "horizon: 6\nsimulator: odee", "E5111 at 7:12"},
      {"horizon: 6", "horizon: 6\nsimulator: {engine: mujocoo}",
       "E5111 at 7:21: `mujocoo` is not a known engine fix: replace `mujocoo` with `mujoco`"},
      {"horizon: 6", "horizon: 6\nsimulator: {engine: [ode]}", "E5107 at 7:13"},
      {"horizon: 6", "horizon: 6\nsimulator: {engine: ode, command: [a]}", "E5102 at 7:26"},
      {"horizon: 6", "horizon: 6\nsimulator: {command: []}", "E5107 at 7:13"},
      {"horizon: 6", "horizon: 6\nlimits: {max_runs: 1000000000000}", "E5109 at 7:20"},
      {"horizon: 6", "horizon: 6\nexpect: {verdict: discrepant}", "E5111 at 7:19"},
  });
}

TEST_CASE("the world: structure by the reader, meaning by the world's own check, at its own file") {
  Workspace workspace;
  struct WorldCase {
    std::string from, to, report;
  };
  for (const auto& one : std::vector<WorldCase>{
           {"mass_kg: 30", "mass_kg: -30", "E5109 at 2:44: `mass_kg` is -30"},
           {"size_m: [0.5, 0.4, 0.3]", "size_m: [0.5, 0.4]", "E5107 at 2:10"},
           {"size_m: [0.5, 0.4, 0.3]", "size_m: [0, 0.4, 0.3]", "E5126 at 2:"},
           {"child: base", "child: bas", "E5126 at 11:33"},
           {"base_joint: drive", "base_joint: driv", "E5126 at 16:21"},
           {"box-pad: 0.6", "box-pda: 0.6",
            "E5111 at 18:26: `pda` is not a known material (a key is `default` or two of them, as "
            "`pad-box`) fix: replace `pda` with `pad`"},
           {"axis: x", "axis: w", "E5111 at 11:45: `w` is not a known axis"},
           {"type: fixed", "type: ball", "E5111 at 14:16"},
           {"type: fixed", "type: hinge", "E5106 at 14:3: the joint `weld` lacks the key `at_m`"},
           {"{type: fixed,", "{type: hinge, at_m: [0, 0, 0], range_m: [0, 1],",
            "E5102 at 14:40: `range_m` is not a key of the joint `weld`: it belongs to sliders"},
           {"{parent: base, child: arm,", "{damping_nm_s: 1, parent: base, child: arm,",
            "E5102 at 12:25: `damping_nm_s` is not a key of the joint `reach`: it belongs to "
            "hinges"},
           {"{type: fixed,", "{type: hinge, at_m: [0, 0, 0], range_rad: [0, 14],",
            "E5126 at 14:40: joints/weld/range_rad: goes beyond 13 rad, about two turns"},
           {"size_m: [0.07, 0.07, 0.07]", "sphere: {radius_m: -1}", "E5109 at 8:28"},
           {"size_m: [0.07, 0.07, 0.07]", "cylinder: {radius_m: 1}",
            "E5106 at 8:9: `cylinder` lacks the key `length_m`"},
           {"size_m: [0.07, 0.07, 0.07]", "size_m: [1, 1, 1], sphere: {radius_m: 1}",
            "E5102 at 8:28: `sphere` is not a key of the body `box`, which has another form"},
           {"mass_kg: 0.3,", "mass_kg: 0.3, inertia: {moments_kg_m2: [1, 1, 9, 0, 0, 0]},",
            "E5126 at 8:"},
           {"far_pad_body: far}", "far_pad_body: far, grip_force_n: 21}", "E5126 at 17:"},
           {"mass_kg: 30", "mas_kg: 30", "E5102 at 2:35: `mas_kg` is not a key of the body `base`"},
       }) {
    CAPTURE(one.to);
    workspace.write("world.yaml", replaced(kWorld, one.from, one.to));
    CHECK_FALSE(workspace.load(kScenario).has_value());
    const auto diagnostics = workspace.sink.sorted();
    REQUIRE(diagnostics.size() >= 1);
    CHECK(workspace.reports()[0].substr(0, one.report.size()) == one.report);
    REQUIRE(diagnostics[0].range.has_value());
    CHECK(workspace.files[diagnostics[0].range->file].name().ends_with("world.yaml"));
  }
}

TEST_CASE("several errors are reported in one run") {
  Workspace workspace;
  auto text = replaced(kScenario, "horizon: 6", "horizon: x");
  text = replaced(text, "controller: going", "controller: gong");
  text = replaced(text, "flag: box.held", "flg: box.held");
  CHECK_FALSE(workspace.load(text).has_value());
  CHECK(workspace.reports().size() >= 3);
}

TEST_CASE("features of YAML that hide or multiply what is written are refused") {
  Workspace workspace;
  struct Feature {
    std::string line, report;
  };
  for (const auto& feature : std::vector<Feature>{
           {"horizon: &h 6", "E5104 at 6:10: anchors"},
           {"horizon: !!int 6", "E5104 at 6:10: tags"},
           {"horizon: 6\nlimits: !!binary aGk=", "E5104 at 7:9: tags"},
           {"horizon: 6\n---\na: 1", "E5104 at 8:1: further documents"},
           {"horizon: 6\n<<: {a: 1}", "E5104 at 7:1: merge keys"},
           {"horizon: 6\n? [a, b]\n: c", "E5101 at 7:3: "},
           {"horizon: [6", "E5101 at "},
           {"horizon: 6\n\tname: x", "E5101 at "},
       }) {
    CAPTURE(feature.line);
    CHECK_FALSE(workspace.load(replaced(kScenario, "horizon: 6", feature.line)).has_value());
    REQUIRE_FALSE(workspace.reports().empty());
    CHECK(workspace.reports()[0].substr(0, feature.report.size()) == feature.report);
  }
  CHECK_FALSE(workspace.load("a: &x [1]\nb: *x\n").has_value());
  CHECK(workspace.reports()[0].find("E5104 at 1:4: anchors") == 0);
  CHECK(workspace.reports()[1].find("E5104 at 2:4: aliases") == 0);
  CHECK_FALSE(workspace.load(std::string(kScenario) + "---\na: 1\n").has_value());
  CHECK(workspace.reports()[0].find("E5104 at 20:1: further documents") == 0);
}

TEST_CASE("hostile texts are refused quickly with one report") {
  const auto nested = [](int depth, const std::string& open) {
    std::string text;
    for (int i = 0; i < depth; ++i) text += open;
    return text;
  };
  std::string aliases = "a0: &a0 [x]\n";
  for (int i = 1; i <= 10; ++i) {
    const auto before = "*a" + std::to_string(i - 1);
    aliases += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + before + ", " +
               before + ", " + before + "]\n";
  }
  std::string keys;
  for (int i = 0; i < 60000; ++i) keys += "k" + std::to_string(i) + ": 1\n";
  struct Hostile {
    std::string text, code;
  };
  const std::vector<Hostile> cases = {
      {nested(100000, "["), "E5105"},
      {nested(100000, "{a: "), "E5105"},
      {nested(100000, "- "), "E5105"},
      {"a: " + nested(65, "[") + nested(65, "]"), "E5105"},
      {"a: " + std::string(10'000'000, 'x'), "E0004"},
      {"a: " + std::string(1'000'000, 'x'), "E5102"},
      {std::string(1'000'000, 'x') + ": 1", "E5101"},
      {std::string(500'000, '"'), "E5104"},
      {nested(200000, "? "), "E5105"},
      {aliases, "E5104"},
      {keys, "E5102"},
      {std::string("a: \0b", 5), "E0006"},
      {"a: \xff\xfe", "E0006"},
      {"", "E5107"},
      {"- a\n- b\n", "E5107"},
  };
  Workspace workspace;
  for (const auto& hostile : cases) {
    CAPTURE(hostile.text.substr(0, 20));
    CHECK_FALSE(workspace.load(hostile.text).has_value());
    REQUIRE_FALSE(workspace.reports().empty());
    CHECK(workspace.reports()[0].substr(0, 5) == hostile.code);
    for (const auto& d : workspace.sink.sorted()) {
      CHECK(base::to_text(d, workspace.files, {}).size() < 4'000'000);
    }
  }
}

TEST_CASE("a path to what cannot be read is an error at its place") {
  Workspace workspace;
  REQUIRE(::mkfifo((workspace.folder() / "pipe").c_str(), 0600) == 0);
  std::filesystem::create_directory(workspace.folder() / "folder");
  std::filesystem::create_symlink("loop", workspace.folder() / "loop");
  const std::string long_name(300, 'x');
  const std::vector<std::pair<std::string, std::string>> places = {
      {"model: [domain.e, start.e]", "model: [domain.e, NAME]"},
      {"plan: fetch.lisp", "plan: NAME"},
      {"bind: robot.bind", "bind: NAME"},
      {"world: {include: world.yaml}", "world: {include: NAME}"}};
  for (const auto& [from, to] : places) {
    for (const std::string name : {"pipe", "folder", "loop", "none", long_name.c_str()}) {
      if (name == "folder" && from.starts_with("plan")) continue;  // a plan may be one
      CAPTURE(from);
      CAPTURE(name);
      workspace.sink = base::DiagnosticSink();
      const auto text = replaced(kScenario, from, replaced(to, "NAME", name));
      CHECK_FALSE(workspace.load(text).has_value());
      const auto reports = workspace.reports();
      REQUIRE(reports.size() == 1);
      const bool is_there = name == "pipe" || name == "folder";
      const auto* code = is_there ? "E0003 at " : name == "none" ? "E0001 at " : "E0002 at ";
      CHECK(reports[0].starts_with(code));
      CHECK(workspace.sink.exit_code() == 3);
    }
  }
}

TEST_CASE("files that are missing, folders, FIFOs and rings of includes") {
  Workspace workspace;
  CHECK_FALSE(
      load_scenario(workspace.folder() / "none.yaml", workspace.files, workspace.sink).has_value());
  CHECK(workspace.reports()[0].find("E0001") == 0);
  CHECK(workspace.sink.exit_code() == 2);
  workspace.sink = base::DiagnosticSink();
  CHECK_FALSE(load_scenario(workspace.folder(), workspace.files, workspace.sink).has_value());
  CHECK(workspace.reports()[0].find("E0003") == 0);
  workspace.sink = base::DiagnosticSink();
  const auto fifo = workspace.folder() / "fifo";
  REQUIRE(::mkfifo(fifo.c_str(), 0600) == 0);
  CHECK_FALSE(load_scenario(fifo, workspace.files, workspace.sink).has_value());
  CHECK(workspace.reports()[0].find("E0003") == 0);

  workspace.write("a.yaml", "include: b.yaml\n");
  workspace.write("b.yaml", "limits: {include: a.yaml}\n");
  CHECK_FALSE(workspace.load("include: a.yaml\n").has_value());
  CHECK(workspace.reports()[0].find("E5110 at 1:19: `a.yaml` is included by itself") == 0);

  for (int i = 0; i < 10; ++i) {
    const auto next = "d" + std::to_string(i + 1) + ".yaml";
    workspace.write("d" + std::to_string(i) + ".yaml", "include: [" + next + ", " + next + "]\n");
  }
  workspace.write("d10.yaml", "{}\n");
  CHECK_FALSE(workspace.load("include: d0.yaml\n").has_value());
  CHECK(workspace.reports()[0].find("E5129") == 0);

  CHECK_FALSE(workspace.load("include: []\n").has_value());
  CHECK_FALSE(workspace.load("include: {a: 1}\n").has_value());
  workspace.write("list.yaml", "[1]\n");
  CHECK_FALSE(workspace.load("include: list.yaml\n").has_value());
  CHECK(workspace.reports()[0].find("E5107 at 1:10") == 0);
}

TEST_CASE("line ends and a byte order mark do not matter") {
  Workspace workspace;
  std::string crlf;
  for (const char c : std::string(kScenario))
    crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  CHECK(workspace.load(crlf).has_value());
  CHECK(workspace.load("\xEF\xBB\xBF" + std::string(kScenario)).has_value());
  const std::string text = kScenario;
  CHECK(workspace.load(text.substr(0, text.size() - 1)).has_value());
  // Places are right in both.
  CHECK_FALSE(workspace.load(replaced(crlf, "horizon: 6", "horizon: x")).has_value());
  CHECK(workspace.reports()[0].find("E5107 at 6:10") == 0);
}

}  // namespace
}  // namespace parallax::harness::test
