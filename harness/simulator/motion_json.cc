#include "harness/simulator/motion_json.h"

#include <string>
#include <utility>

#include "harness/recording/bytes.h"

namespace parallax::harness {
namespace {

using Json = nlohmann::json;

/// The pose of a body as a list of three or seven numbers.
std::optional<Pose> pose_of(const Json& json) {
  if (!json.is_array() || (json.size() != 3 && json.size() != 7)) return std::nullopt;
  Pose pose;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const auto number = base::json_as<double>(json[i]);
    if (!number) return std::nullopt;
    (i < 3 ? pose.p[i] : pose.q[i - 3]) = *number;
  }
  return pose;
}

/// Reads a frame. Returns its fault; empty: none.
std::string read_frame(const Json& json, PlainFrame& frame) {
  const Json* time = base::json_member(json, "t");
  const auto number = time == nullptr ? std::nullopt : base::json_as<double>(*time);
  if (!number) return "`t` of a frame is missing or no number";
  frame.time_s = *number;
  if (const Json* poses = base::json_member(json, "bodies")) {
    if (!poses->is_object()) return "`bodies` of a frame is no object";
    for (const auto& [name, value] : poses->items()) {
      const auto pose = pose_of(value);
      if (!pose) return "the pose of `" + name + "` is no list of 3 or 7 numbers";
      frame.poses.emplace_back(name, *pose);
    }
  }
  const Json* held = base::json_member(json, "held");
  if (held == nullptr) return {};
  if (!held->is_object()) return "`held` of a frame is no object";
  frame.held.emplace();
  for (const auto& [name, value] : held->items()) {
    const auto gripper = base::json_as<std::string>(value);
    if (!gripper) return "what holds `" + name + "` is no name";
    frame.held->emplace_back(name, *gripper);
  }
  return {};
}

}  // namespace

void read_motion(const nlohmann::json& result, OutcomeReply& reply) {
  auto& motion = reply.outcome.motion;
  if (const Json* packed = base::json_member(result, "motion")) {
    const auto text = base::json_as<std::string>(*packed);
    auto bytes = text ? from_base64(*text) : std::nullopt;
    if (!bytes) {
      motion.fault = "`motion` is no text in base64";
      return;
    }
    motion.frames = *std::move(bytes);
  }
  if (const Json* fault = base::json_member(result, "motion_fault")) {
    motion.fault = base::json_as<std::string>(*fault).value_or("`motion_fault` is no text");
  }
  const Json* poses = base::json_member(result, "poses");
  if (poses == nullptr) return;
  if (!poses->is_array()) {
    motion.fault = "`poses` is no list of frames";
    return;
  }
  for (const Json& item : *poses) {
    PlainFrame frame;
    auto why = read_frame(item, frame);
    if (!why.empty()) {
      motion.fault = std::move(why);
      return;
    }
    reply.frames.push_back(std::move(frame));
  }
}

}  // namespace parallax::harness
