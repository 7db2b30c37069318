// `parallax new`: the project that it creates runs; nothing is replaced.

#include <sys/stat.h>

#include <filesystem>

#include "harness/engine/engine_module.h"
#include "harness/import/import.h"
#include "harness/import/mesh.h"
#include "tests/support/deep.h"
#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

TEST_CASE("every scenario that it makes is clean, and runs to a verdict") {
  const CliFixture cli;
  for (const auto* world : {"line", "room", "kitchen"}) {
    CAPTURE(world);
    const std::string name = std::string("my-") + world;
    const auto made = cli.parallax({"new", name, "--world", world});
    CAPTURE(made.err);
    CHECK(made.code == 0);
    CHECK(made.err.empty());
    const auto scenario = name + "/scenario.yaml";
    CHECK(made.out.find("parallax run " + scenario) != std::string::npos);
    const auto checked = cli.parallax({"check", scenario});
    CHECK(checked.code == 0);
    CHECK(checked.err == "no errors\n");
    for (const auto* model : {"domain.e", "start.e"}) {
      CHECK(cli.parallax({"fmt", "--check", name + "/" + model}).code == 0);
    }
    const auto run = json_of(cli, {"run", scenario, "--out", name + "/out", "--jobs", "2"});
    CHECK(run.at("verdict") == "no-discrepancy");
    for (const auto& [file, text] : files_below(cli.folder() / name)) {
      if (file.starts_with("out/")) continue;
      CAPTURE(file);
      CHECK(text.find("@NAME@") == std::string::npos);
    }
  }
}

TEST_CASE("a mistake in what it makes is found: the place at the border of a region") {
  const CliFixture cli;
  CHECK(cli.parallax({"new", "edge"}).code == 0);
  cli.replace("edge/plan.lisp", "(make-3d-vector 0.5 0 0)", "(make-3d-vector 0.99 0 0)");
  CHECK(json_of(cli, {"run", "edge/scenario.yaml", "--out", "out"}, 1).at("verdict") ==
        "discrepancy");
}

TEST_CASE("the same name and options make the same files, and what is there stays") {
  const CliFixture cli;
  const auto made = json_of(cli, {"new", "fetch", "--world", "room", "--robot", "mobile"});
  CHECK(made.at("files").size() == 8);
  CHECK(made.at("robot") == "mobile");
  const auto first = files_below(cli.folder() / "fetch");
  CHECK(first.size() == 8);
  cli.write("fetch/plan.lisp", "mine\n");
  const auto again = cli.parallax({"new", "fetch"});
  CHECK(again.code == 2);
  CHECK(again.err.find("it is there already") != std::string::npos);
  CHECK(cli.read("fetch/plan.lisp") == "mine\n");
  cli.write("file", "mine\n");
  std::filesystem::create_directory(cli.folder() / "empty");
  std::filesystem::create_symlink("nowhere", cli.folder() / "link");
  for (const auto* taken : {"file", "empty", "link"}) {
    CAPTURE(taken);
    CHECK(cli.parallax({"new", taken}).code == 2);
  }
  CHECK(cli.read("file") == "mine\n");
  CHECK(std::filesystem::is_empty(cli.folder() / "empty"));
  CHECK(cli.parallax({"new", "sub/"}).code == 0);
  CHECK(cli.parallax({"new", "sub/fetch", "--world", "room"}).code == 0);
  CHECK(files_below(cli.folder() / "sub/fetch") == first);
}

TEST_CASE("names and places that will not do are one message") {
  const CliFixture cli;
  for (const auto* name :
       {"", ".", "..", "/", "1st", "-x", "a b", "a\nb", "fetch.yaml", "\xff", "a\"b"}) {
    CAPTURE(name);
    const auto result = cli.parallax({"new", "--", name});
    CAPTURE(result.err);
    CHECK(result.code == 2);
    CHECK(result.err.find("error[E0007]") != std::string::npos);
  }
  CHECK(cli.parallax({"new", std::string(65, 'a')}).code == 2);
  CHECK(cli.parallax({"new"}).code == 2);
  CHECK(cli.parallax({"new", "x", "--world", "garage"}).code == 2);
  const auto odd = cli.parallax({"new", "x", "--world", "kitchen", "--robot", "line"});
  CHECK(odd.code == 2);
  CHECK(odd.err.find("there is no world `kitchen` for the robot `line`") != std::string::npos);
  const auto nowhere = cli.parallax({"new", "no/such/folder"});
  CHECK(nowhere.code == 2);
  CHECK(nowhere.err.find("error[E0005]") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(cli.folder() / "x"));
  // Where nobody may write, not even a privileged user.
  const auto closed = cli.parallax({"new", "/proc/self/x"});
  CHECK(closed.code == 2);
  CHECK(closed.err.find("error[E0005]") != std::string::npos);
}

std::string link(const std::string& name, double mass_kg, const std::string& size,
                 const std::string& middle, const std::string& mesh = {}) {
  const std::string form =
      mesh.empty() ? "<box size='" + size + "'/>" : "<mesh filename='" + mesh + "'/>";
  return "<link name='" + name + "'><inertial><origin xyz='" + middle + "'/><mass value='" +
         std::to_string(mass_kg) +
         "'/><inertia ixx='0.01' iyy='0.01' izz='0.01' ixy='0' ixz='0' iyz='0'/></inertial>"
         "<collision><origin xyz='" +
         middle + "'/><geometry>" + form + "</geometry></collision></link>\n";
}

std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& at, const std::string& axis, const std::string& limit,
                  const std::string& type = "revolute", const std::string& more = {}) {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + at + "'/><axis xyz='" + axis +
         "'/><limit velocity='2' " + limit + "/>" + more + "</joint>\n";
}

/// An arm of six joints, some of which turn more than once, with a gripper whose fingers move
/// alike.
std::string arm_description(const std::string& mimic) {
  const std::string turns = "lower='-6.28' upper='6.28' effort='150'",
                    wrist = "lower='-3.1' upper='3.1' effort='30'",
                    way = "lower='0' upper='0.04' effort='60'";
  return "<robot name='arm'>\n" +
         link("stand", 8, "", "0 0 0.05", "package://arm_parts/meshes/stand.obj") +
         link("turret", 3, "0.1 0.1 0.1", "0 0 0.05") +
         link("upper", 3, "0.08 0.08 0.35", "0 0 0.175") +
         link("fore", 2, "0.07 0.07 0.3", "0 0 0.15") +
         link("knuckle", 0.8, "0.06 0.06 0.08", "0 0 0.04") +
         link("wrist", 0.5, "0.05 0.05 0.06", "0 0 0.03") +
         link("flange", 0.3, "0.06 0.06 0.02", "0 0 0.01") +
         link("hand", 0.5, "0.06 0.16 0.04", "0 0 0.02") +
         link("left", 0.1, "0.02 0.012 0.05", "0 0.006 0.025") +
         link("right", 0.1, "0.02 0.012 0.05", "0 -0.006 0.025") +
         joint("pan", "stand", "turret", "0 0 0.1", "0 0 1", turns) +
         joint("lift", "turret", "upper", "0 0 0.1", "0 1 0", turns) +
         joint("elbow", "upper", "fore", "0 0 0.35", "0 1 0", turns) +
         joint("pitch", "fore", "knuckle", "0 0 0.3", "0 1 0", turns) +
         joint("lean", "knuckle", "wrist", "0 0 0.08", "1 0 0", wrist) +
         joint("roll", "wrist", "flange", "0 0 0.06", "0 0 1", "effort='30'", "continuous") +
         joint("mount", "flange", "hand", "0 0 0.02", "1 0 0", "effort='0'", "fixed") +
         joint("finger_left", "hand", "left", "0 0 0.04", "0 1 0", way, "prismatic") +
         joint("finger_right", "hand", "right", "0 0 0.04", "0 -1 0", way, "prismatic", mimic) +
         "</robot>\n";
}

constexpr const char* kBoxMesh =
    "v -0.1 -0.1 -0.05\nv 0.1 -0.1 -0.05\nv 0.1 0.1 -0.05\nv -0.1 0.1 -0.05\n"
    "v -0.1 -0.1 0.05\nv 0.1 -0.1 0.05\nv 0.1 0.1 0.05\nv -0.1 0.1 0.05\n"
    "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\n"
    "f 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";

TEST_CASE("the arm of a robot description carries a box in every engine, as it was made") {
  const CliFixture cli;
  if (!harness::reads_urdf() || !harness::reads_meshes()) return;
  std::filesystem::create_directories(cli.folder() / "arm_parts/urdf");
  std::filesystem::create_directories(cli.folder() / "arm_parts/meshes");
  cli.write("arm_parts/meshes/stand.obj", kBoxMesh);
  // With fingers that are coupled in the file, and with fingers that are guessed to be.
  for (const bool is_coupled : {true, false}) {
    CAPTURE(is_coupled);
    const std::string name = is_coupled ? "one" : "two";
    cli.write("arm_parts/urdf/arm.urdf",
              arm_description(is_coupled ? "<mimic joint='finger_left'/>" : ""));
    const auto made = cli.parallax({"new", name, "--robot", "arm_parts/urdf/arm.urdf"});
    CAPTURE(made.err);
    REQUIRE(made.code == 0);
    CHECK(cli.read(name + "/robot/arm_parts/meshes/stand.obj") == kBoxMesh);
    const auto scenario = name + "/scenario.yaml";
    const auto checked = cli.parallax({"check", scenario});
    CAPTURE(checked.err);
    CHECK(checked.code == 0);
    for (const auto& [file, text] : files_below(cli.folder() / name)) {
      CAPTURE(file);
      for (const auto* mark : {"@NAME@", "@X", "@TOP", "@LEFT", "@BOX"}) {
        CHECK(text.find(mark) == std::string::npos);
      }
    }
    cli.replace(scenario, "epsilon: 0.1", "epsilon: 0.5");
    const auto plain = cli.read(scenario);
    for (const auto kind : harness::engines_here()) {
      // Bullet takes long: one of both by default.
      if (kind == harness::EngineKind::kBullet && !is_coupled && !is_deep()) continue;
      const std::string engine(to_string(kind));
      cli.write(scenario, plain + "simulator: " + engine + "\n");
      CAPTURE(engine);
      const auto run = json_of(cli, {"run", scenario, "--out", name + "/" + engine, "--jobs", "2"});
      CHECK(run.at("verdict") == "no-discrepancy");
    }
  }
}

TEST_CASE("a robot that no arm is found in, and what is no robot, are one message") {
  const CliFixture cli;
  if (!harness::reads_urdf()) return;
  cli.write("cart.urdf", "<robot name='r'>" + link("a", 1, "0.1 0.1 0.1", "0 0 0") + "</robot>");
  cli.write("world.urdf", "<sdf version='1.9'/>");
  cli.write("odd.urdf", "<robot name='r'><link name='a'>");
  for (const auto& [file, said] : std::vector<std::pair<std::string, std::string>>{
           {"cart.urdf", "no arm with a gripper of two fingers"},
           {"world.urdf", "it is no robot description in URDF"},
           {"odd.urdf", "error[E5143]"},
           {"none.urdf", "there is no regular file `none.urdf`"}}) {
    CAPTURE(file);
    const auto result = cli.parallax({"new", "x", "--robot", file});
    CHECK(result.code == 3);
    CHECK(result.err.find(said) != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(cli.folder() / "x"));
  }
  for (const auto* package : {"parts", "=parts", "parts="}) {
    CHECK(cli.parallax({"new", "x", "--robot", "cart.urdf", "--package", package}).code == 2);
  }
  CHECK(cli.parallax({"new", "x", "--robot", "cart.urdf", "--world", "room"}).code == 2);
  CHECK(cli.parallax({"new", "x", "--robot", "wheels"}).code == 2);
}

}  // namespace
}  // namespace parallax::test
