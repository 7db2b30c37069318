#include "harness/robot/ode_simulator.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

#include "compiler/base/contract.h"
#include "harness/engine/physics_world.h"
#include "harness/engine/world_check.h"
#include "harness/robot/controller.h"
#include "harness/robot/motion_recorder.h"
#include "harness/world/angles.h"
#include "harness/world/arguments.h"
#include "harness/world/world_layout.h"

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
          heading_rad(R)};
}

void observe_arm(const MobileRobot& robot, const Arm& arm, State& out) {
  const std::string prefix = arm.spec().name + ".";
  const Eigen::Vector3d tool = arm.tool();
  out[prefix + "x"] = tool.x();
  out[prefix + "y"] = tool.y();
  out[prefix + "z"] = tool.z();
  out[prefix + "opening"] = arm.opening_m();
  out[prefix + "parked"] = robot.parked(arm);
  out[prefix + "open"] = robot.open(arm);
}

void observe_belief(const Perception& perception, BodyId id, const std::string& prefix,
                    State& out) {
  const auto seen = perception.believed(id);
  const Eigen::Vector3d p = seen.value_or(Eigen::Vector3d::Zero());
  out[prefix + "perceived"] = perception.belief(id).perceived;
  out[prefix + "seen.known"] = seen.has_value();
  out[prefix + "seen.x"] = p.x();
  out[prefix + "seen.y"] = p.y();
  out[prefix + "seen.z"] = p.z();
  out[prefix + "seen.yaw"] = seen ? perception.belief(id).yaw_rad : 0.0;
  out[prefix + "seen.bottom"] = perception.believed_bottom_m(id).value_or(0.0);
}

void observe_joint(const PhysicsWorld& world, const JointSpec& joint, double position, State& out) {
  const BodyId child = *world.layout().find_body(joint.child);
  const Eigen::Vector3d p = world.position(child);
  out[joint.name + ".q"] = position;
  out[joint.child + ".x"] = p.x();
  out[joint.child + ".y"] = p.y();
  out[joint.child + ".z"] = p.z();
  out[joint.child + ".yaw"] = heading_rad(world.rotation(child));
}

/// Adds to `out` what `observables` lists of a world with a mobile robot, but for the poses of free
/// bodies.
void observe_mobile(const PhysicsWorld& world, const MobileRobot& robot,
                    const Perception& perception, const GraspMonitor& grasp, State& out) {
  const PlanarPose pose = robot.base().pose();
  out["robot.x"] = pose.p.x();
  out["robot.y"] = pose.p.y();
  out["robot.yaw"] = pose.yaw_rad;
  out["robot.lift"] = robot.lift_m();
  out["robot.looking_at"] = perception.gaze();
  for (const Arm& arm : robot.arms()) observe_arm(robot, arm, out);
  const WorldLayout& layout = world.layout();
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    if (!layout.is_free[i]) continue;
    const BodyId id = layout.bodies.id_at(i);
    const std::string prefix = layout.bodies[id].name + ".";
    out[prefix + "bottom"] = world.bounds(id).low.z();
    out[prefix + "mass"] = world.mass_kg(id);
    for (const Arm& arm : robot.arms()) {
      out[prefix + "held_by." + arm.spec().name] = grasp.held_by(arm.gripper(), id);
    }
    observe_belief(perception, id, prefix, out);
  }
  for (const SliderId id : observed_sliders(layout, robot.spec())) {
    observe_joint(world, layout.sliders[id], world.slider_position_m(id), out);
  }
}

}  // namespace

struct OdeSimulator::Impl {
  enum class Condition : std::uint8_t { kFresh, kReady, kLost };

  explicit Impl(const WorldSpec& world_spec)
      : spec(checked(world_spec)), owned(make_world(spec)), grasp(spec, world), grips(spec, world) {
    if (spec.mobile) {
      mobile.emplace(spec, world);
      perception.emplace(world, *mobile);
    } else if (!spec.robot.base_body.empty()) {
      line.emplace(spec, world);
    }
    motion.emplace(spec, world, grasp, mobile ? &*mobile : nullptr,
                   perception ? &*perception : nullptr);
  }

  bool can(const ControllerSpec& controller) const {
    return controller.robot == RobotKind::kLine ? line.has_value() : mobile.has_value();
  }
  void reset_robot(std::uint64_t seed) {
    grasp.reset();
    grips.reset();
    if (line) line->reset();
    if (mobile) mobile->reset();
    if (perception) perception->reset(seed);
  }
  void drive_motors() {
    if (line) line->drive_motors();
    if (mobile) mobile->drive_motors();
  }
  /// The demands on the grippers for the step that was made.
  const std::vector<GripDemand>& demands() {
    demands_made.clear();
    if (line) {
      const double level =
          line->asked_acceleration(LineAxis::kBase) + line->asked_acceleration(LineAxis::kReach);
      demands_made.push_back({line->squeeze_n(), level, line->asked_acceleration(LineAxis::kLift)});
    }
    if (!mobile) return demands_made;
    for (const Arm& arm : mobile->arms()) {
      GripDemand& demand = demands_made.emplace_back();
      demand.squeeze_n = arm.squeeze_n();
      if (demand.squeeze_n <= 0.0) continue;
      const AskedAcceleration asked = mobile->asked_acceleration(arm);
      demand.level_m_s2 = asked.level;
      demand.upright_m_s2 = asked.upright;
    }
    return demands_made;
  }
  void brake_all() {
    if (line) line->brake_all();
    if (mobile) mobile->brake_all();
  }

  WorldSpec spec;
  std::unique_ptr<PhysicsWorld> owned;
  PhysicsWorld& world = *owned;
  GraspMonitor grasp;
  GripWatch grips;
  std::vector<GripDemand> demands_made;  // kept to save allocations
  std::optional<LineRobot> line;
  std::optional<MobileRobot> mobile;
  std::optional<Perception> perception;
  std::optional<MotionRecorder> motion;  // of all those before it
  Condition condition = Condition::kFresh;
  Watcher watcher = nullptr;
  void* watcher_context = nullptr;
};

OdeSimulator::OdeSimulator(const WorldSpec& spec) : impl_(std::make_unique<Impl>(spec)) {}
OdeSimulator::~OdeSimulator() = default;

const PhysicsWorld& OdeSimulator::world() const { return impl_->world; }
std::optional<Gaze> OdeSimulator::gaze() const {
  return impl_->perception ? impl_->perception->line_of_sight() : std::nullopt;
}
const StepStatistics& OdeSimulator::statistics() const { return impl_->world.statistics(); }
const GripWatch& OdeSimulator::grips() const { return impl_->grips; }
void OdeSimulator::measure_times(bool on) { impl_->world.measure_times(on); }

void OdeSimulator::watch(Watcher watcher, void* context) {
  impl_->watcher = watcher;
  impl_->watcher_context = context;
}

void OdeSimulator::record_motion(double interval_s) { impl_->motion->set_interval(interval_s); }

SimulatorInfo OdeSimulator::info() {
  SimulatorInfo info;
  EngineName engine = impl_->world.engine();
  info.name = std::move(engine.name);
  info.version = std::move(engine.version);
  info.determinism = "bitwise";
  info.seeds = true;
  info.parameters = observables(impl_->spec);
  for (const ControllerSpec& spec : controllers()) {
    if (impl_->can(spec)) info.actions.emplace_back(spec.name);
  }
  info.timestep_s = impl_->spec.solver.timestep_s;
  info.scene = impl_->motion->scene();
  return info;
}

Outcome OdeSimulator::reset(const State& initial, std::uint64_t seed) {
  impl_->condition = Impl::Condition::kFresh;
  const StartState start = read_start_state(impl_->spec, impl_->world.layout(), initial);
  if (start.status != SimStatus::kOk) return {start.status, start.reason, 0.0, {}};

  const std::optional<Overlap> overlap = impl_->world.reset(start.placements, seed);
  impl_->reset_robot(seed);
  if (overlap) {
    return {SimStatus::kInvalidStart,
            fmt::format("`{}` overlaps `{}` by {:.1f} mm", overlap->first, overlap->second,
                        millimetres(overlap->depth_m)),
            0.0,
            {{"depth", overlap->depth_m}}};
  }
  impl_->condition = Impl::Condition::kReady;
  impl_->motion->begin();
  Outcome outcome;
  outcome.motion = impl_->motion->take();
  return outcome;
}

Outcome OdeSimulator::act(std::string_view action, const State& arguments,
                          double sim_time_limit_s) {
  PARALLAX_REQUIRE(impl_->condition != Impl::Condition::kFresh, "a successful reset before act");
  if (impl_->condition == Impl::Condition::kLost) {
    return {SimStatus::kLost, "the state of the world has exploded", 0.0, {}};
  }
  const ControllerSpec* spec = find_controller(action);
  if (spec == nullptr || !impl_->can(*spec)) {
    return {SimStatus::kUnsupported, fmt::format("no action `{}`", action), 0.0, {}};
  }
  const auto checked_arguments =
      Arguments::check(*spec, arguments, impl_->spec, impl_->world.layout());
  if (const auto* message = std::get_if<std::string>(&checked_arguments)) {
    return {SimStatus::kUnsupported, *message, 0.0, {}};
  }
  impl_->world.enter_thread();
  impl_->grips.begin_act();
  const ControlContext context{impl_->spec,
                               impl_->world,
                               impl_->grasp,
                               impl_->line ? &*impl_->line : nullptr,
                               impl_->mobile ? &*impl_->mobile : nullptr,
                               impl_->perception ? &*impl_->perception : nullptr};
  const std::unique_ptr<Controller> controller =
      find_factory(action)(context, std::get<Arguments>(checked_arguments));

  const double timestep_s = impl_->world.timestep_s();
  double time_s = 0.0;
  for (std::int64_t steps = 1;; ++steps) {
    if (std::optional<Outcome> outcome = controller->tick(time_s)) {
      impl_->grips.end_act();
      outcome->sim_time_s = time_s;
      outcome->motion = impl_->motion->take();
      return *std::move(outcome);
    }
    if (!(static_cast<double>(steps) * timestep_s <= sim_time_limit_s)) break;
    impl_->drive_motors();
    if (!impl_->world.step()) {
      impl_->condition = Impl::Condition::kLost;
      Outcome outcome{SimStatus::kLost, "the state of the world has exploded", time_s, {}};
      outcome.motion = impl_->motion->take();
      return outcome;
    }
    impl_->grasp.update();
    impl_->grips.update(impl_->demands());
    impl_->motion->step();
    time_s = static_cast<double>(steps) * timestep_s;
    if (impl_->watcher != nullptr) impl_->watcher(impl_->watcher_context, time_s, *this);
  }
  impl_->brake_all();  // takes effect in the next action
  impl_->grips.end_act();
  Outcome outcome{SimStatus::kTruncated,
                  fmt::format("`{}` took longer than {} s", action, sim_time_limit_s),
                  time_s,
                  {}};
  outcome.motion = impl_->motion->take();
  return outcome;
}

State OdeSimulator::state() const {
  PARALLAX_REQUIRE(impl_->condition != Impl::Condition::kFresh,
                   "a successful reset before observe");
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
  if (impl_->line) {
    state["robot.x"] = impl_->line->base_x_m();
    state["tool.x"] = impl_->line->tool().x();
    state["tool.z"] = impl_->line->tool().z();
    state["opening"] = impl_->line->opening_m();
  }
  if (impl_->mobile) {
    observe_mobile(impl_->world, *impl_->mobile, *impl_->perception, impl_->grasp, state);
  }
  for (std::size_t i = 0; i < layout.hinges.size(); ++i) {
    const HingeId id = layout.hinges.id_at(i);
    observe_joint(impl_->world, layout.hinges[id], impl_->world.hinge_angle_rad(id), state);
  }
  state["digest"] = fmt::format("{:016x}", impl_->world.digest());
  return state;
}

}  // namespace parallax::harness
