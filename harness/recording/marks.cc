#include "harness/recording/marks.h"

#include <algorithm>
#include <set>
#include <utility>

namespace parallax::harness {

std::vector<Mark> marks_of(const Recording& recording) {
  std::vector<Mark> out;
  for (const auto& event : recording.events) {
    out.push_back({event.begin_s, event.name + " begins", false});
    const bool fine = event.status == "ok";
    auto text = event.name + " ends: " + event.status;
    if (!event.reason.empty()) text += ", " + event.reason;
    out.push_back({event.end_s, std::move(text), !fine});
  }
  const auto& scene = recording.scene;
  const auto moving = scene.moving();
  std::set<std::pair<std::size_t, std::size_t>> held;  // gripper, body
  for (Playback at(recording); at.next();) {
    // Those that the frame tells alone: there may be very many others.
    auto slots = at.cursor().gripped();
    const auto order = [&](std::size_t slot) {
      return std::pair(slot % scene.grippers.size(), slot / scene.grippers.size());
    };
    std::sort(slots.begin(), slots.end(),
              [&](std::size_t a, std::size_t b) { return order(a) < order(b); });
    for (const auto slot : slots) {
      const auto [gripper, index] = order(slot);
      const auto body = moving[index];
      const bool holds = (at.cursor().grips()[slot] & kGripHeld) != 0;
      const std::pair grip(gripper, body);
      if (holds == held.contains(grip)) continue;
      out.push_back(
          {at.time_s(),
           scene.grippers[gripper] + (holds ? " holds " : " lets go of ") + scene.bodies[body].name,
           false});
      if (holds) {
        held.insert(grip);
      } else {
        held.erase(grip);
      }
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Mark& a, const Mark& b) { return a.time_s < b.time_s; });
  return out;
}

}  // namespace parallax::harness
