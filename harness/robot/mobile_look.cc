#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/robot/mobile_controller.h"

namespace parallax::harness {
namespace {

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
    std::string hidden_by;
    bool found = false;
    for (const BodyId id : perception().bodies_of_kind(kind)) {
      const Sighting sighting = perception().sight(id, points);
      best = std::max(best, sighting.seen);
      if (!sighting.hidden_by.empty()) hidden_by = sighting.hidden_by;
      if (sighting.seen < needed) {
        perception().unsee(id);
        continue;
      }
      perception().believe(id, sighting);
      found = true;
    }
    const State margins{{"points", static_cast<double>(best - needed)}};
    if (found) return {SimStatus::kOk, {}, 0.0, margins};
    std::string text =
        fmt::format("{} of {} points of a `{}` in sight, {} needed", best, points, kind, needed);
    if (!hidden_by.empty()) text += fmt::format("; `{}` is in the way", hidden_by);
    return failed(kObjectNotFound, text, margins);
  }
};

}  // namespace

std::unique_ptr<Controller> make_look(const ControlContext& context, const Arguments& arguments) {
  return std::make_unique<Look>(context, arguments);
}

std::unique_ptr<Controller> make_detect(const ControlContext& context, const Arguments& arguments) {
  return std::make_unique<Detect>(context, arguments);
}

}  // namespace parallax::harness
