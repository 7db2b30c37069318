#include <fmt/format.h>

#include <string_view>

#include "compiler/base/shown_text.h"
#include "harness/recording/export_recording.h"
#include "harness/recording/marks.h"

namespace parallax::harness {
namespace {

constexpr std::string_view kMotionCsvHead = "time,body,x,y,z,qw,qx,qy,qz,event\r\n";

}  // namespace

bool is_motion_csv(std::string_view head) { return head.starts_with(kMotionCsvHead); }

std::string csv_of(const Recording& recording) {
  std::string out(kMotionCsvHead);
  const auto marks = marks_of(recording);
  std::size_t marked = 0;
  const auto mark_to = [&](double time_s) {
    // Half a step of time is no difference.
    for (; marked < marks.size() && marks[marked].time_s < time_s + 0.5 * kFrameTime_s; ++marked) {
      out += fmt::format("{:.3f},,,,,,,,,{}\r\n", marks[marked].time_s,
                         base::csv_cell(marks[marked].text));
    }
  };
  const auto& bodies = recording.scene.bodies;
  const auto moving = recording.scene.moving();
  std::vector<std::vector<std::size_t>> with(bodies.size());  // what goes with a moving body
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].moves) with[bodies[i].on.value_or(i)].push_back(i);
  }
  for (Playback at(recording); at.next();) {
    mark_to(at.time_s());
    for (const auto moved : at.cursor().moved()) {
      for (const auto body : with[moving[moved]]) {
        const auto pose = at.pose_of(body);
        out += fmt::format("{:.3f},{},{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f},{:.6f},\r\n",
                           at.time_s(), base::csv_cell(bodies[body].name), pose.p[0], pose.p[1],
                           pose.p[2], pose.q[0], pose.q[1], pose.q[2], pose.q[3]);
      }
    }
  }
  mark_to(1e18);
  return out;
}

}  // namespace parallax::harness
