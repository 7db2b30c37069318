// A robot behind ROS 1: a real master, a node with an action server and topics, on the loopback.

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "tests/tools/adapters/python_fixture.h"

namespace parallax::test {
namespace {

constexpr const char* kModules =
    "import rospy, actionlib, rosmaster, tf2_ros, move_base_msgs.msg, std_srvs.srv, "
    "rosgraph_msgs.msg";

/// The Python that has ROS; empty, and said so, where none has.
std::string python_with_ros() {
  for (const auto* python : {"python3", "/usr/bin/python3"}) {
    if (run_process({"sh", "-c", std::string(python) + " -c '" + kModules + "'"}).code == 0) {
      return python;
    }
  }
  std::cout << "SKIPPED: there is no rospy, actionlib, rosmaster or tf2_ros\n";
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
  // An abort by the server is an observation, with its reason.
  const auto aborted = with_robot(
      cli, python,
      {"adapter-check", "--act", "drive target.x=3.5", "--json", "--", python, "-B", adapter});
  // The wall is where it is whatever the seed, which counts against the noise that it claims.
  CHECK(aborted.result.out.find("drive failed") != std::string::npos);
}

TEST_CASE(
    "frames of tf are observed as they are now, through links that move and links that do not") {
  const auto python = python_with_ros();
  if (python.empty()) return;
  const CliFixture cli;
  const std::string folder = std::string(PARALLAX_PYTHON_ADAPTER) + "/examples/ros1/";
  std::string requests = "{\"id\":1,\"method\":\"hello\",\"params\":{\"protocol\":[1]}}\n";
  // Simulated time stands still between two starts: they differ in nothing that has a time.
  for (const auto* x : {"-2.5", "2", "0.25"}) {
    requests += std::string(R"({"id":2,"method":"reset","params":{"seed":7,"state":{"robot.x":)") +
                x + "}}}\n" + R"({"id":3,"method":"observe"})" + "\n";
  }
  requests += std::string(R"({"id":4,"method":"act","params":{"action":"drive",)") +
              R"("args":{"target.x":1.5},"sim_time_limit":30}})" + "\n" +
              R"({"id":5,"method":"observe"})" + "\n";
  cli.write("requests", requests);
  ProcessOptions options;
  options.folder = cli.folder().string();
  const auto result = run_process({python, "-B", folder + "with_robot.py", "sh", "-c",
                                   python + " -B " + folder + "robot_adapter.py < requests"},
                                  options);
  CAPTURE(result.out);
  CAPTURE(result.err);
  std::istringstream lines(result.out);
  std::vector<double> places;
  for (std::string line; std::getline(lines, line);) {
    REQUIRE(nlohmann::json::accept(line));
    const auto reply = nlohmann::json::parse(line).at("result");
    if (!reply.contains("state")) continue;
    const auto& state = reply.at("state");
    places.push_back(state.at("robot.x").get<double>());
    CHECK(state.at("hand.x").get<double>() == doctest::Approx(places.back() + 0.3));
    CHECK(state.at("hand.y").get<double>() == doctest::Approx(0.1));
    CHECK(state.at("hand.z").get<double>() == doctest::Approx(0.5));
    CHECK(state.at("hand.yaw").get<double>() == doctest::Approx(0.25));
  }
  REQUIRE(places.size() == 4);
  CHECK(places[0] == -2.5);
  CHECK(places[1] == 2.0);
  CHECK(places[2] == 0.25);
  CHECK(std::abs(places[3] - 1.5) < 0.1);
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
