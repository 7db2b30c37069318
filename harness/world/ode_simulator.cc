#include "harness/world/ode_simulator.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "compiler/base/contract.h"
#include "harness/world/arguments.h"
#include "harness/world/controller.h"
#include "harness/world/ode_process.h"
#include "harness/world/start_state.h"
#include "harness/world/world_check.h"

namespace parallax::harness {
namespace {

double millimetres(double value_m) { return value_m * 1e3; }

const WorldSpec& checked(const WorldSpec& spec) {
  PARALLAX_REQUIRE(check_world(spec).empty(), "a world that passed check_world");
  return spec;
}

/// Turn about x, then y, then z [rad] that makes up R_WB: the usual roll, pitch, yaw.
struct RollPitchYaw {
  double roll_rad, pitch_rad, yaw_rad;
};

RollPitchYaw roll_pitch_yaw(const Eigen::Matrix3d& R) {
  return {std::atan2(R(2, 1), R(2, 2)), std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))),
          std::atan2(R(1, 0), R(0, 0))};
}

}  // namespace

struct OdeSimulator::Impl {
  enum class Phase : std::uint8_t { kFresh, kReady, kLost };

  explicit Impl(const WorldSpec& world_spec)
      : spec(checked(world_spec)), world(spec), grasp(spec, world) {
    if (!spec.robot.base_body.empty()) robot.emplace(spec, world);
  }

  WorldSpec spec;
  OdeWorld world;
  GraspMonitor grasp;
  std::optional<Robot> robot;
  Phase phase = Phase::kFresh;
  Watcher watcher = nullptr;
  void* watcher_context = nullptr;
};

OdeSimulator::OdeSimulator(const WorldSpec& spec) : impl_(std::make_unique<Impl>(spec)) {}
OdeSimulator::~OdeSimulator() = default;

const OdeWorld& OdeSimulator::world() const { return impl_->world; }
const StepStatistics& OdeSimulator::statistics() const { return impl_->world.statistics(); }
void OdeSimulator::measure_times(bool on) { impl_->world.measure_times(on); }

void OdeSimulator::watch(Watcher watcher, void* context) {
  impl_->watcher = watcher;
  impl_->watcher_context = context;
}

SimulatorInfo OdeSimulator::info() {
  SimulatorInfo info;
  info.name = "ode";
  info.version = ode_version();
  info.determinism = "bitwise";
  info.seeds = true;
  info.parameters = observables(impl_->spec);
  if (impl_->robot) {
    for (const ControllerSpec& spec : controllers()) info.actions.emplace_back(spec.name);
  }
  info.timestep_s = impl_->spec.solver.timestep_s;
  return info;
}

Outcome OdeSimulator::reset(const State& initial, std::uint64_t seed) {
  impl_->phase = Impl::Phase::kFresh;
  const StartState start = read_start_state(impl_->spec, impl_->world.layout(), initial);
  if (start.status != SimStatus::kOk) return {start.status, start.reason, 0.0, {}};

  const std::optional<Overlap> overlap = impl_->world.reset(start.placements, seed);
  impl_->grasp.reset();
  if (impl_->robot) impl_->robot->reset();
  if (overlap) {
    return {SimStatus::kInvalidStart,
            fmt::format("`{}` overlaps `{}` by {:.1f} mm", overlap->first, overlap->second,
                        millimetres(overlap->depth_m)),
            0.0,
            {{"depth", overlap->depth_m}}};
  }
  impl_->phase = Impl::Phase::kReady;
  return {};
}

Outcome OdeSimulator::act(std::string_view action, const State& arguments,
                          double sim_time_limit_s) {
  PARALLAX_REQUIRE(impl_->phase != Impl::Phase::kFresh, "a successful reset before act");
  if (impl_->phase == Impl::Phase::kLost) {
    return {SimStatus::kLost, "the state of the world has exploded", 0.0, {}};
  }
  const ControllerSpec* spec = find_controller(action);
  if (spec == nullptr || !impl_->robot) {
    return {SimStatus::kUnsupported, fmt::format("no action `{}`", action), 0.0, {}};
  }
  const auto checked_arguments = Arguments::check(*spec, arguments, impl_->world.layout());
  if (const auto* message = std::get_if<std::string>(&checked_arguments)) {
    return {SimStatus::kUnsupported, *message, 0.0, {}};
  }
  enter_ode();
  const ControlContext context{*impl_->robot, impl_->grasp, impl_->world, impl_->spec.robot};
  const std::unique_ptr<Controller> controller =
      find_factory(action)(context, std::get<Arguments>(checked_arguments));

  const double timestep_s = impl_->world.timestep_s();
  double time_s = 0.0;
  for (std::int64_t steps = 1;; ++steps) {
    if (std::optional<Outcome> outcome = controller->tick(time_s)) {
      outcome->sim_time_s = time_s;
      return *std::move(outcome);
    }
    if (!(static_cast<double>(steps) * timestep_s <= sim_time_limit_s)) break;
    impl_->robot->drive_motors();
    if (!impl_->world.step()) {
      impl_->phase = Impl::Phase::kLost;
      return {SimStatus::kLost, "the state of the world has exploded", time_s, {}};
    }
    impl_->grasp.update();
    time_s = static_cast<double>(steps) * timestep_s;
    if (impl_->watcher != nullptr) impl_->watcher(impl_->watcher_context, time_s, *this);
  }
  impl_->robot->brake_all();  // takes effect in the next action
  return {SimStatus::kTruncated,
          fmt::format("`{}` took longer than {} s", action, sim_time_limit_s),
          time_s,
          {}};
}

State OdeSimulator::state() const {
  PARALLAX_REQUIRE(impl_->phase != Impl::Phase::kFresh, "a successful reset before observe");
  const WorldLayout& layout = impl_->world.layout();
  State state;
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    if (!layout.is_free[i]) continue;
    const BodyId id = layout.bodies.id_at(i);
    const std::string prefix = layout.bodies[id].name + ".";
    const Eigen::Vector3d p_WB = impl_->world.position(id);
    const RollPitchYaw turn = roll_pitch_yaw(impl_->world.rotation(id));
    state[prefix + "x"] = p_WB.x();
    state[prefix + "y"] = p_WB.y();
    state[prefix + "z"] = p_WB.z();
    state[prefix + "roll"] = turn.roll_rad;
    state[prefix + "pitch"] = turn.pitch_rad;
    state[prefix + "yaw"] = turn.yaw_rad;
    state[prefix + "held"] = impl_->grasp.held(id);
  }
  if (impl_->robot) {
    state["robot.x"] = impl_->robot->base_x_m();
    state["tool.x"] = impl_->robot->tool().x();
    state["tool.z"] = impl_->robot->tool().z();
    state["opening"] = impl_->robot->opening_m();
  }
  state["digest"] = fmt::format("{:016x}", impl_->world.digest());
  return state;
}

}  // namespace parallax::harness
