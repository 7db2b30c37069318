// A robot behind ROS 1: a real master, a node with an action server and topics, on the loopback.

#include <nlohmann/json.hpp>

#include "tests/tools/adapters/python_fixture.h"

namespace parallax::test {
namespace {

constexpr const char* kModules =
    "import rospy, actionlib, rosmaster, move_base_msgs.msg, std_srvs.srv, rosgraph_msgs.msg";

/// The Python that has ROS; empty, and said so, where none has.
std::string python_with_ros() {
  for (const auto* python : {"python3", "/usr/bin/python3"}) {
    if (run_process({"sh", "-c", std::string(python) + " -c '" + kModules + "'"}).code == 0) {
      return python;
    }
  }
  std::cout << "SKIPPED: there is no rospy, actionlib or rosmaster\n";
  return {};
}

struct RosRun {
  ProcessResult result;
  nlohmann::json document;
};

/// `parallax COMMAND ...` beside a master and the robot.
RosRun with_robot(const CliFixture& cli, const std::string& python,
                  std::vector<std::string> command) {
  const std::string folder = std::string(PARALLAX_PYTHON_ADAPTER) + "/examples/ros1/";
  command.insert(command.begin(), {python, "-B", folder + "with_robot.py", PARALLAX_PROGRAM});
  ProcessOptions options;
  options.folder = cli.folder().string();
  RosRun run{run_process(command, options), {}};
  if (nlohmann::json::accept(run.result.out)) run.document = nlohmann::json::parse(run.result.out);
  return run;
}

TEST_CASE("a robot that speaks ROS 1 keeps the protocol, and its runs are judged") {
  const auto python = python_with_ros();
  if (python.empty()) return;
  const CliFixture cli;
  const std::string adapter =
      std::string(PARALLAX_PYTHON_ADAPTER) + "/examples/ros1/robot_adapter.py";
  const auto checked =
      with_robot(cli, python, {"adapter-check", "--json", "--", python, "-B", adapter});
  CAPTURE(checked.result.out);
  CAPTURE(checked.result.err);
  CHECK(checked.result.code == 0);
  CHECK(checked.document.at("claims").at("several_jobs").get<std::string>().starts_with("no"));
  CHECK(checked.document.at("measured").at("largest_start_deviation") == 0.0);

  cli.write("ros.e",
            "sort region\nregion near, far\nfluent In(region)\nevent Go(region)\n"
            "[time] {region} HoldsAt(In(region),time).\n"
            "[region1,region2,time] HoldsAt(In(region1),time) & HoldsAt(In(region2),time) -> "
            "region1=region2.\n"
            "[region,time] Initiates(Go(region),In(region),time).\n"
            "[region1,region2,time] region1!=region2 -> Terminates(Go(region1),In(region2),time).\n"
            "HoldsAt(In(near),0).\nHappens(Go(far),0).\n!Happens(Go(near),0).\n");
  const auto scenario = [&](const char* target) {
    cli.write("ros.yaml",
              "model: ros.e\nhorizon: 1\nconstraints: [\"HoldsAt(In(far),time)\"]\nsimulator: "
              "{command: [" +
                  python + ", -B, " + adapter +
                  "]}\nregions: {cells: {near: {x: [0, 1]}, far: {x: [1, 4]}}}\n"
                  "mapping: {In(region): {inside: region, body: robot}}\n"
                  "actions: {Go(region): {controller: drive, target.x: " +
                  target + "}}\n");
    return with_robot(cli, python, {"rates", "ros.yaml", "--runs", "4", "--jobs", "1", "--json"});
  };
  const auto clean = scenario("1.5");
  CAPTURE(clean.result.out);
  CAPTURE(clean.result.err);
  CHECK(clean.result.code == 0);
  CHECK(clean.document.at("traces").at(0).at("runs") == 4);
  CHECK(clean.document.at("traces").at(0).at("any").at("count") == 0);
  // It stops short of the border, and the model says that it arrives beyond.
  const auto wrong = scenario("0.8");
  CAPTURE(wrong.result.err);
  CHECK(wrong.document.at("traces").at(0).at("any").at("count") == 4);
  // What the server aborts is an observation, with its reason.
  const auto aborted = with_robot(
      cli, python,
      {"adapter-check", "--act", "drive target.x=3.5", "--json", "--", python, "-B", adapter});
  // The wall is where it is whatever the seed, which counts against the noise that it claims.
  CHECK(aborted.result.out.find("drive failed") != std::string::npos);
}

TEST_CASE("no master is a loss, not an observation") {
  const auto python = python_with_ros();
  if (python.empty()) return;
  const CliFixture cli;
  const std::string adapter =
      std::string(PARALLAX_PYTHON_ADAPTER) + "/examples/ros1/robot_adapter.py";
  const auto result = cli.parallax({"adapter-check", "--request-limit", "3", "--", "env",
                                    "ROS_MASTER_URI=http://127.0.0.1:1", "ROS_IP=127.0.0.1", python,
                                    "-B", adapter});
  CAPTURE(result.out);
  CHECK(result.code == 1);
  CHECK(result.out.find("fault: handshake: ") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
