#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/robot/mobile_controller.h"

namespace parallax::harness {
namespace {

/// Brings the tool to where it is carried.
class Park final : public MobileController {
 public:
  Park(const ControlContext& context, const Arguments& arguments)
      : MobileController(context, arguments) {
    add_tool_path("parking", [this] { return robot().carry_point(arm()); });
    add_pause("settling", number("settle_s"));
  }

 private:
  Outcome judge(std::string_view) override {
    if (robot().parked(arm())) return {};
    const double error_m = (arm().tool() - robot().carry_point(arm())).norm();
    return failed(kGoalNotReached,
                  fmt::format("the tool is {} from where it is carried", metres(error_m)));
  }
};

class MoveTorso final : public MobileController {
 public:
  MoveTorso(const ControlContext& context, const Arguments& arguments)
      : MobileController(context, arguments), height_m_(height()) {
    if (std::isnan(height_m_)) {
      refuse_with(kGoalNotReached, "neither a place nor height_m is given");
      return;
    }
    if (!robot().lift_allowed(height_m_)) {
      refuse_with(kGoalNotReached, fmt::format("the torso does not go to {}", metres(height_m_)));
      return;
    }
    const Motion motion{number("max_speed_m_s"), 0.2, 0.001, 10.0};
    add(
        "lifting",
        [this, motion] {
          robot().lift_to(height_m_, motion);
          return patience_s(height_m_ - robot().lift_m(), motion);
        },
        [this] { return robot().torso_at_rest(); });
  }

 private:
  Outcome judge(std::string_view) override {
    const double error_m = std::abs(robot().lift_m() - height_m_);
    if (error_m <= kTorsoTolerance_m) return {};
    return failed(kGoalNotReached, fmt::format("the torso stopped {} away", metres(error_m)));
  }

  double height() const {
    const double given_m = number("height_m");
    const PlaceSpec* place = arguments().place("place");
    return std::isnan(given_m) && place != nullptr ? place->p_FP.z() : given_m;
  }

  double height_m_;
};

/// Opens the gripper wide; what it held falls.
class OpenGripper final : public MobileController {
 public:
  OpenGripper(const ControlContext& context, const Arguments& arguments)
      : MobileController(context, arguments) {
    add_opening([this] { return arm().spec().opening_m; });
    add_pause("settling", number("settle_s"));
  }

 private:
  Outcome judge(std::string_view) override {
    if (robot().open(arm())) return {};
    return failed(kGoalNotReached, "the gripper did not open");
  }
};

/// Squeezes what is held with another force.
class Regrip final : public MobileController {
 public:
  Regrip(const ControlContext& context, const Arguments& arguments)
      : MobileController(context, arguments) {
    const std::uint32_t gripper = arm().gripper();
    if (!context.grasp.held_body(gripper)) {
      refuse_with(kGraspFailed, "nothing is held");
      return;
    }
    add_squeeze(number("effort_n"), number("hold_s"),
                [this, gripper] { return is_holding(gripper); });
  }

 private:
  bool is_holding(std::uint32_t gripper) const {
    return context().grasp.held_body(gripper).has_value();
  }

  Outcome judge(std::string_view) override {
    if (is_holding(arm().gripper())) return {};
    return failed(kGraspFailed, "it was lost");
  }
};

/// Turns the camera to a place. The neck is no body: it is there at once.
class Look final : public MobileController {
 public:
  Look(const ControlContext& context, const Arguments& arguments)
      : MobileController(context, arguments) {
    const PlaceSpec* place = arguments.place("place");
    if (place == nullptr && std::isnan(number("target.x"))) {
      refuse_with(kLookingFailed, "neither a place nor a target is given");
      return;
    }
    const PlaceSpec there = place != nullptr ? *place : PlaceSpec{"", "", target_point(), 0.0};
    if (const auto limit = perception().look_at(there)) {
      refuse_with(kLookingFailed,
                  fmt::format("`{}` asks for {}, beyond the neck's", there.name, *limit));
      return;
    }
    add_pause("looking", number("settle_s"));
  }

 private:
  Outcome judge(std::string_view) override { return {}; }
};

/// Looks for the bodies of a kind where the camera points. What is not seen is not perceived.
class Detect final : public MobileController {
 public:
  Detect(const ControlContext& context, const Arguments& arguments)
      : MobileController(context, arguments) {
    add_pause("looking", number("settle_s"));
  }

 private:
  Outcome judge(std::string_view) override {
    const std::string kind = *arguments().text("kind");
    const int points = static_cast<int>(number("points"));
    const int needed = static_cast<int>(number("points_needed"));
    int best = 0;
    std::string hidden_by, overlooked;
    bool found = false;
    for (const BodyId id : perception().bodies_of_kind(kind)) {
      const Sighting sighting = perception().sight(id, points);
      best = std::max(best, sighting.seen);
      if (!sighting.hidden_by.empty()) hidden_by = sighting.hidden_by;
      const bool missed = sighting.seen >= needed && perception().errors().missed();
      if (missed) overlooked = name_of(id);
      if (sighting.seen < needed || missed) {
        perception().unsee(id);
        continue;
      }
      perception().believe(id, sighting);
      found = true;
    }
    if (!found) found = confuse(kind, points, needed);
    const State margins{{"points", static_cast<double>(best - needed)}};
    if (found) return {SimStatus::kOk, {}, 0.0, margins, first_perceived(kind)};
    if (!overlooked.empty()) {
      return failed(kObjectNotFound, fmt::format("`{}` is in sight and was missed", overlooked),
                    margins);
    }
    std::string text =
        fmt::format("{} of {} points of a `{}` in sight, {} needed", best, points, kind, needed);
    if (!hidden_by.empty()) text += fmt::format("; `{}` is in the way", hidden_by);
    return failed(kObjectNotFound, text, margins);
  }

  /// Is something else in sight taken for the first body of the kind?
  bool confuse(const std::string& kind, int points, int needed) {
    const auto wanted = perception().bodies_of_kind(kind);
    const WorldLayout& layout = world().layout();
    if (wanted.empty() || robot().spec().camera.detection.confusion_rate == 0.0) return false;
    for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
      const BodyId id = layout.bodies.id_at(i);
      if (!layout.is_free[i] || layout.bodies[id].kind_name() == kind) continue;
      const Sighting sighting = perception().sight(id, points);
      if (sighting.seen < needed || !perception().errors().confused()) continue;
      perception().believe(id, sighting, wanted.front());
      return true;
    }
    return false;
  }

  /// The first of the kind that this look found.
  std::string first_perceived(const std::string& kind) {
    for (const BodyId id : perception().bodies_of_kind(kind)) {
      if (perception().belief(id).perceived) return context().world.layout().bodies[id].name;
    }
    return {};
  }
};

}  // namespace

std::unique_ptr<Controller> make_park(const ControlContext& context, const Arguments& arguments) {
  return std::make_unique<Park>(context, arguments);
}
std::unique_ptr<Controller> make_move_torso(const ControlContext& context,
                                            const Arguments& arguments) {
  return std::make_unique<MoveTorso>(context, arguments);
}
std::unique_ptr<Controller> make_open_gripper(const ControlContext& context,
                                              const Arguments& arguments) {
  return std::make_unique<OpenGripper>(context, arguments);
}
std::unique_ptr<Controller> make_regrip(const ControlContext& context, const Arguments& arguments) {
  return std::make_unique<Regrip>(context, arguments);
}

std::unique_ptr<Controller> make_look(const ControlContext& context, const Arguments& arguments) {
  return std::make_unique<Look>(context, arguments);
}

std::unique_ptr<Controller> make_detect(const ControlContext& context, const Arguments& arguments) {
  return std::make_unique<Detect>(context, arguments);
}

}  // namespace parallax::harness
