// A client of libparallax whose functions throw wherever they are called: callbacks SCENARIO.yaml
// MODEL.e FOLDER. Says what does not hold, and "all hold" otherwise.

#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

#include "parallax/parallax.h"

namespace px = parallax::api;

namespace {

int faults = 0;
void check(bool holds, const char* what) {
  if (holds) return;
  std::printf("does not hold: %s\n", what);
  ++faults;
}

/// An exception that only this program knows.
struct Own : std::runtime_error {
  using std::runtime_error::runtime_error;
};

enum class At { kNowhere, kInfo, kReset, kAct, kObserve, kActNoException };

/// The callback that throws, and in which simulation.
struct Plan {
  At at = At::kNowhere;
  int simulation = 3;
};

/// A box that lands where it is put.
class Exact final : public px::Simulator {
 public:
  explicit Exact(Plan plan) : plan_(plan) {}

  px::SimulatorInfo info() override {
    if (plan_.at == At::kInfo) throw Own("thrown by info");
    px::SimulatorInfo out;
    out.name = "exact";
    out.version = "1";
    for (const char* name : {"robot.x", "box.x", "box.y"})
      out.variables.push_back({name, "m", true});
    out.variables.push_back({"box.yaw", "rad", true});
    out.variables.push_back({"box.held", "1", false});
    out.actions = {"going", "picking-up", "placing"};
    out.timestep_s = 0.1;
    return out;
  }
  px::Outcome reset(const px::Values& start, std::uint64_t) override {
    ++simulation_;
    go_wrong(At::kReset, "thrown by reset");
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
    go_wrong(At::kAct, "thrown by act");
    if (plan_.at == At::kActNoException && simulation_ == plan_.simulation) throw 42;
    if (action == "going") {
      robot_ = std::get<double>(arguments.at("target.x"));
    } else if (action == "picking-up") {
      held_ = true;
    } else {
      box_ = std::get<double>(arguments.at("target.x"));
      held_ = false;
    }
    return {.sim_time_s = 1.0};
  }
  px::Values observe() override {
    go_wrong(At::kObserve, "thrown by observe");
    return {{"robot.x", robot_},
            {"box.x", box_},
            {"box.y", 0.0},
            {"box.yaw", 0.0},
            {"box.held", held_}};
  }

 private:
  void go_wrong(At at, const char* text) const {
    if (plan_.at == at && simulation_ == plan_.simulation) throw Own(text);
  }
  Plan plan_;
  int simulation_ = 0;
  double robot_ = 0.5, box_ = 1.5;
  bool held_ = false;
};

px::RunOptions with(const std::string& folder, Plan plan) {
  px::RunOptions out;
  out.folder = folder;
  out.simulator = [plan] { return std::make_unique<Exact>(plan); };
  return out;
}

/// Runs it, and says whether exactly this comes out of it.
template <typename Thrown>
bool throws(const std::string& scenario, const px::RunOptions& options, const std::string& text) {
  try {
    px::run(scenario, options);
  } catch (const Thrown& thrown) {
    return std::string(thrown.what()).find(text) != std::string::npos;
  } catch (...) {
    return false;
  }
  return false;
}

void simulators_throw(const std::string& scenario, const std::string& folder) {
  const struct {
    At at;
    const char* text;
  } cases[] = {{At::kReset, "thrown by reset"},
               {At::kAct, "thrown by act"},
               {At::kObserve, "thrown by observe"},
               {At::kActNoException, "no std::exception"}};
  for (const auto& one : cases) {
    const auto run = px::run(scenario, with(folder + "/" + one.text, {one.at}));
    check(run.lost == 1, one.text);
    check(run.report_json.find(one.text) != std::string::npos, "a loss has the exception's text");
    check(run.verdict == px::Verdict::kNoDiscrepancy, "the others go on");
  }
  check(throws<Own>(scenario, with(folder + "/info", {At::kInfo}), "thrown by info"),
        "what info throws reaches the caller as it is");
}

void factories_throw(const std::string& scenario, const std::string& folder) {
  auto options = with(folder + "/none", {});
  options.simulator = []() -> std::unique_ptr<px::Simulator> { return nullptr; };
  check(throws<px::Failure>(scenario, options, "made no simulator"), "a factory that makes none");
  options.simulator = []() -> std::unique_ptr<px::Simulator> {
    throw Own("thrown by the factory");
  };
  check(throws<Own>(scenario, options, "thrown by the factory"), "a factory that throws");
}

void progress_throws(const std::string& scenario, const std::string& folder) {
  auto options = with(folder + "/progress", {});
  int told = 0;
  options.progress = [&](const px::Progress& now) {
    ++told;
    if (now.done == 7) throw Own("thrown by progress");
  };
  check(throws<Own>(scenario, options, "thrown by progress"), "what progress throws");
  check(told >= 7, "progress was told before");
  options.progress = {};
  options.resume = true;
  const auto run = px::run(scenario, options);
  check(run.verdict == px::Verdict::kNoDiscrepancy, "resumed after a throw");
  check(run.scenario_hash.size() == 32, "the hash of the scenario");
  options.folder += " again";
  options.resume = false;
  check(px::run(scenario, options).scenario_hash == run.scenario_hash, "the same hash again");
}

void takers_throw(const std::string& file) {
  const auto model = px::Model::load({.files = {file}});
  bool reached = false;
  try {
    model.traces(0, [](const px::Trace&) -> bool { throw Own("thrown by the taker"); });
  } catch (const Own&) {
    reached = true;
  }
  check(reached, "what the taker of traces throws");
  int taken = 0;
  model.traces(1, [&](const px::Trace&) { return ++taken > 0; });
  check(taken == 1, "the model is as good as before");
  bool refused = false;
  try {
    model.traces(1, {});
  } catch (const px::Failure&) {
    refused = true;
  }
  check(refused, "nobody to take the traces");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return std::fputs("usage: callbacks SCENARIO.yaml MODEL.e FOLDER\n", stderr), 2;
  const std::string scenario = argv[1], folder = argv[3];
  check(px::version() == PARALLAX_VERSION, "the version");
  simulators_throw(scenario, folder);
  factories_throw(scenario, folder);
  progress_throws(scenario, folder);
  takers_throw(argv[2]);
  if (faults == 0) std::puts("all hold");
  return faults == 0 ? 0 : 1;
}
