// The world of scenarios/two_regions in forty lines: a point on a line instead of physics. It lets
// the box slip by up to 2 cm when it is picked up, which at the edge of a region is too much.

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "parallax/parallax.h"

namespace px = parallax::api;

class Line final : public px::Simulator {
 public:
  px::SimulatorInfo info() override {
    px::SimulatorInfo out;
    out.name = "line";
    out.version = "1";
    out.variables = {{"robot.x", "m", true},
                     {"box.x", "m", true},
                     {"box.y", "m", true},
                     {"box.yaw", "rad", true},
                     {"box.held", "1", false}};
    out.actions = {"going", "picking-up", "placing"};
    out.timestep_s = 0.1;
    out.repeats_bitwise = true;
    return out;
  }

  px::Outcome reset(const px::Values& start, std::uint64_t) override {
    const auto from = [&](const char* name, double usual) {
      const auto found = start.find(name);
      const double* value = found == start.end() ? nullptr : std::get_if<double>(&found->second);
      return value == nullptr ? usual : *value;
    };
    robot_ = from("robot.x", 0.5);
    box_ = from("box.x", 1.5);
    held_ = false;
    return {};
  }

  px::Outcome act(std::string_view action, const px::Values& arguments, double) override {
    if (action == "going") {
      robot_ = std::get<double>(arguments.at("target.x"));
      return {.sim_time_s = 1.0};
    }
    if (action == "picking-up") {
      if (std::abs(box_ - robot_) > 0.6) return {px::Status::kFailed, "out of reach"};
      slip_ = 0.02 * std::sin(40.0 * box_);
      held_ = true;
      return {.sim_time_s = 1.0};
    }
    if (!held_) return {px::Status::kFailed, "nothing is held"};
    box_ = std::get<double>(arguments.at("target.x")) + slip_;
    held_ = false;
    return {.sim_time_s = 1.0};
  }

  px::Values observe() override {
    return {{"robot.x", robot_},
            {"box.x", box_},
            {"box.y", 0.0},
            {"box.yaw", 0.0},
            {"box.held", held_}};
  }

 private:
  double robot_ = 0.5, box_ = 1.5, slip_ = 0.0;
  bool held_ = false;
};

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("usage: line_world SCENARIO.yaml FOLDER\n", stderr), 2;
  try {
    const px::Run run =
        px::run(argv[1], {.folder = argv[2], .simulator = [] { return std::make_unique<Line>(); }});
    std::puts(run.verdict == px::Verdict::kDiscrepancy ? "discrepancy" : run.claim.c_str());
    for (const px::Discrepancy& found : run.discrepancies) {
      std::printf("trace %d, simulation %d, timepoint %d: %s\n", static_cast<int>(found.trace),
                  static_cast<int>(found.sample), found.timepoint, found.cause.c_str());
    }
    return run.verdict == px::Verdict::kDiscrepancy ? 1 : 0;
  } catch (const px::Failure& failure) {
    return std::fputs(failure.what(), stderr), 3;
  }
}
