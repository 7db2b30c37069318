#include "harness/geometry_proof/trace_proof.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <utility>
#include <variant>

namespace parallax::harness {
namespace {

/// What an action is examined with.
struct ActionInput {
  const WorldSpec& spec;
  const WorldLayout& layout;
  const StartCuboid& region;
  const Arguments& arguments;
  const KnownState& state;
};

std::unique_ptr<ActionTest> test_of(const ActionInput& in) {
  return std::make_unique<ActionTest>(in.spec, in.layout, in.region, in.state);
}

void add_drive(const ActionInput& in, ProvableAction& action) {
  const PlaceSpec* place = in.arguments.place("place");
  const auto target = target_of(in.layout, in.state, in.arguments);
  const double given = in.arguments.number("target.yaw");
  if (!target || (place == nullptr && (std::isnan(in.arguments.number("target.x")) ||
                                       std::isnan(in.arguments.number("target.y"))))) {
    action.left_to_simulation = "where it leads does not follow from the start";
    return;
  }
  if (std::isnan(given) && place == nullptr) {
    action.left_to_simulation = "its heading at the goal is the one that it begins with";
    return;
  }
  auto test = test_of(in);
  if (!test->scene().unknown().empty()) {
    action.left_to_simulation = fmt::format("the actions before it leave open where {} may be",
                                            fmt::join(test->scene().unknown(), ", "));
    return;
  }
  test->set_check(make_drive_check(test->scene(), *target,
                                   std::isnan(given) ? place->yaw_rad : given,
                                   in.arguments.number("sweep_step_m")));
  action.tests.push_back(std::move(test));
}

void add_tests(const ActionInput& in, std::string_view controller, ProvableAction& action) {
  if (controller == "drive") return add_drive(in, action);
  action.left_to_simulation = "no test of its controller is decided by the start alone";
}

}  // namespace

std::vector<ProvableAction> provable_actions(const WorldSpec& spec, const WorldLayout& layout,
                                             const StartCuboid& region,
                                             const std::vector<ProofAction>& actions,
                                             const ProofAssumptions& assumptions) {
  std::vector<ProvableAction> all;
  KnownState state = state_at_start(spec, layout, region);
  std::string lost;  // why nothing is known any more
  for (std::size_t i = 0; i < actions.size(); ++i) {
    ProvableAction action{i, actions[i].event, actions[i].controller, {}, lost};
    const ControllerSpec* controller = find_controller(actions[i].controller);
    if (lost.empty() && controller == nullptr) {
      lost = action.left_to_simulation = fmt::format("no controller `{}`", actions[i].controller);
    }
    if (lost.empty() && !spec.mobile) {
      lost = action.left_to_simulation = "the world has no mobile robot";
    }
    if (lost.empty()) {
      const auto checked = Arguments::check(*controller, actions[i].arguments, spec, layout);
      if (const auto* message = std::get_if<std::string>(&checked)) {
        lost = action.left_to_simulation = *message;
      } else {
        const Arguments& arguments = std::get<Arguments>(checked);
        add_tests({spec, layout, region, arguments, state}, controller->name, action);
        if (const auto why = assume_success(spec, layout, actions[i].event, *controller, arguments,
                                            assumptions, state)) {
          lost = *why;
        }
      }
    }
    all.push_back(std::move(action));
  }
  return all;
}

}  // namespace parallax::harness
