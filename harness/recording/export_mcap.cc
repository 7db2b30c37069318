#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/base/json.h"
#include "harness/recording/export_recording.h"
#include "harness/recording/marks.h"
#include "harness/recording/mcap_writer.h"

namespace parallax::harness {
namespace {

using OrderedMcapJson = nlohmann::ordered_json;

constexpr const char* kWorldFrame = "world";

// JSON schemas of the types that are used, after foxglove.dev/docs: names decide what a viewer
// makes of a message, properties how it reads them.
OrderedMcapJson object_schema(OrderedMcapJson properties) {
  return {{"type", "object"}, {"properties", std::move(properties)}};
}
OrderedMcapJson list_schema(OrderedMcapJson items) {
  return {{"type", "array"}, {"items", std::move(items)}};
}
OrderedMcapJson plain_schema(const char* type) { return {{"type", type}}; }
OrderedMcapJson numbers_schema(std::initializer_list<const char*> names) {
  OrderedMcapJson out = OrderedMcapJson::object();
  for (const auto* name : names) out[name] = plain_schema("number");
  return object_schema(std::move(out));
}
OrderedMcapJson time_schema(const char* title) {
  auto out =
      object_schema({{"sec", {{"type", "integer"}, {"minimum", 0}}},
                     {"nsec", {{"type", "integer"}, {"minimum", 0}, {"maximum", 999999999}}}});
  out["title"] = title;
  return out;
}
OrderedMcapJson pose_schema() {
  return object_schema({{"position", numbers_schema({"x", "y", "z"})},
                        {"orientation", numbers_schema({"x", "y", "z", "w"})}});
}

std::string schema_text(const char* title, OrderedMcapJson properties) {
  auto out = object_schema(std::move(properties));
  out["title"] = title;
  return base::json_text(out);
}

std::string transforms_schema() {
  const auto transform = object_schema({{"timestamp", time_schema("time")},
                                        {"parent_frame_id", plain_schema("string")},
                                        {"child_frame_id", plain_schema("string")},
                                        {"translation", numbers_schema({"x", "y", "z"})},
                                        {"rotation", numbers_schema({"x", "y", "z", "w"})}});
  return schema_text("foxglove.FrameTransforms", {{"transforms", list_schema(transform)}});
}

std::string scene_schema() {
  const auto colour = numbers_schema({"r", "g", "b", "a"});
  const auto size = numbers_schema({"x", "y", "z"});
  const auto solid = object_schema({{"pose", pose_schema()}, {"size", size}, {"color", colour}});
  auto cylinder = solid;
  cylinder["properties"]["bottom_scale"] = plain_schema("number");
  cylinder["properties"]["top_scale"] = plain_schema("number");
  const auto triangles = object_schema({{"pose", pose_schema()},
                                        {"points", list_schema(numbers_schema({"x", "y", "z"}))},
                                        {"color", colour},
                                        {"colors", list_schema(colour)},
                                        {"indices", list_schema(plain_schema("integer"))}});
  const auto anything = list_schema(plain_schema("object"));
  const auto entity = object_schema({{"timestamp", time_schema("time")},
                                     {"frame_id", plain_schema("string")},
                                     {"id", plain_schema("string")},
                                     {"lifetime", time_schema("duration")},
                                     {"frame_locked", plain_schema("boolean")},
                                     {"metadata", anything},
                                     {"arrows", anything},
                                     {"cubes", list_schema(solid)},
                                     {"spheres", list_schema(solid)},
                                     {"cylinders", list_schema(cylinder)},
                                     {"lines", anything},
                                     {"triangles", list_schema(triangles)},
                                     {"texts", anything},
                                     {"models", anything}});
  const auto deletion = object_schema({{"timestamp", time_schema("time")},
                                       {"type", plain_schema("integer")},
                                       {"id", plain_schema("string")}});
  return schema_text("foxglove.SceneUpdate",
                     {{"deletions", list_schema(deletion)}, {"entities", list_schema(entity)}});
}

std::string log_schema() {
  return schema_text("foxglove.Log", {{"timestamp", time_schema("time")},
                                      {"level", plain_schema("integer")},
                                      {"message", plain_schema("string")},
                                      {"name", plain_schema("string")},
                                      {"file", plain_schema("string")},
                                      {"line", plain_schema("integer")}});
}

std::uint64_t nanoseconds(double time_s) {
  return static_cast<std::uint64_t>(std::llround(std::max(time_s, 0.0) * 1e6)) * 1000U;
}

OrderedMcapJson time_json(std::uint64_t time_ns) {
  return {{"sec", time_ns / 1'000'000'000U}, {"nsec", time_ns % 1'000'000'000U}};
}

OrderedMcapJson point_json(const std::array<double, 3>& p) {
  return {{"x", p[0]}, {"y", p[1]}, {"z", p[2]}};
}
OrderedMcapJson turn_json(const std::array<double, 4>& q) {
  return {{"x", q[1]}, {"y", q[2]}, {"z", q[3]}, {"w", q[0]}};
}

OrderedMcapJson colour_json(const RecordedBody& body) {
  std::string text = body.colour;
  if (text.empty()) {
    switch (body.kind) {
      case BodyKind::kFurniture:
        text = "#c8c4bc";
        break;
      case BodyKind::kDrawer:
        text = "#b08d57";
        break;
      case BodyKind::kRobot:
        text = "#4a6fa5";
        break;
      case BodyKind::kGripper:
        text = "#27405f";
        break;
      case BodyKind::kItem:
        text = "#d1495b";
        break;
      case BodyKind::kCamera:
        text = "#e0b000";
        break;
    }
  }
  const auto part = [&](std::size_t at) {
    return std::stoi(text.substr(at, 2), nullptr, 16) / 255.0;
  };
  return {{"r", part(1)}, {"g", part(3)}, {"b", part(5)}, {"a", 1.0}};
}

/// The primitives of a shape; a capsule is a cylinder between two spheres.
void add_shape(const RecordedShape& shape, const OrderedMcapJson& colour, OrderedMcapJson& entity) {
  const auto solid = [&](const Pose& pose, double x, double y, double z) {
    return OrderedMcapJson{
        {"pose", {{"position", point_json(pose.p)}, {"orientation", turn_json(pose.q)}}},
        {"size", {{"x", x}, {"y", y}, {"z", z}}},
        {"color", colour}};
  };
  const double width = 2.0 * shape.size[0];
  switch (shape.kind) {
    case ShapeKind::kBox:
      entity["cubes"].push_back(solid(shape.pose, shape.size[0], shape.size[1], shape.size[2]));
      return;
    case ShapeKind::kSphere:
      entity["spheres"].push_back(solid(shape.pose, width, width, width));
      return;
    case ShapeKind::kCapsule:
      for (const double end : {-0.5, 0.5}) {
        const Pose cap{point_of(shape.pose, {0.0, 0.0, end * shape.size[1]}), shape.pose.q};
        entity["spheres"].push_back(solid(cap, width, width, width));
      }
      break;
    case ShapeKind::kHull: {
      auto points = OrderedMcapJson::array(), indices = OrderedMcapJson::array();
      for (const auto& corner : shape.corners) points.push_back(point_json(corner));
      for (const auto& face : shape.faces) {
        for (const auto corner : face) indices.push_back(corner);
      }
      entity["triangles"].push_back(
          {{"pose",
            {{"position", point_json(shape.pose.p)}, {"orientation", turn_json(shape.pose.q)}}},
           {"points", std::move(points)},
           {"color", colour},
           {"colors", OrderedMcapJson::array()},
           {"indices", std::move(indices)}});
      return;
    }
    case ShapeKind::kCylinder:
      break;
  }
  auto cylinder = solid(shape.pose, width, width, shape.size[1]);
  cylinder["bottom_scale"] = 1.0;
  cylinder["top_scale"] = 1.0;
  entity["cylinders"].push_back(std::move(cylinder));
}

OrderedMcapJson entity_json(const RecordedBody& body) {
  OrderedMcapJson out{
      {"timestamp", time_json(0)}, {"frame_id", body.moves ? body.name : std::string(kWorldFrame)},
      {"id", body.name},           {"lifetime", time_json(0)},
      {"frame_locked", true},      {"metadata", OrderedMcapJson::array()}};
  for (const auto* name :
       {"arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts", "models"}) {
    out[name] = OrderedMcapJson::array();
  }
  const auto colour = colour_json(body);
  for (auto shape : body.shapes) {
    if (!body.moves) shape.pose = composed(body.pose, shape.pose);
    add_shape(shape, colour, out);
  }
  return out;
}

OrderedMcapJson transform_json(std::uint64_t time_ns, const std::string& parent,
                               const std::string& child, const Pose& pose) {
  return {{"timestamp", time_json(time_ns)},
          {"parent_frame_id", parent},
          {"child_frame_id", child},
          {"translation", point_json(pose.p)},
          {"rotation", turn_json(pose.q)}};
}

struct Message {
  std::uint64_t time_ns = 0;
  std::uint16_t topic = 0;
  std::string text;
};

void add_scene(const Recording& recording, std::uint16_t topic, std::vector<Message>& out) {
  OrderedMcapJson entities = OrderedMcapJson::array();
  for (const auto& body : recording.scene.bodies) {
    if (!body.shapes.empty()) entities.push_back(entity_json(body));
  }
  const OrderedMcapJson update{{"deletions", OrderedMcapJson::array()},
                               {"entities", std::move(entities)}};
  out.push_back({0, topic, base::json_text(update)});
}

void add_motion(const Recording& recording, std::uint16_t topic, std::vector<Message>& out) {
  const auto& bodies = recording.scene.bodies;
  const auto moving = recording.scene.moving();
  const auto tell = [&](std::uint64_t time_ns, OrderedMcapJson transforms) {
    if (transforms.empty()) return;
    out.push_back(
        {time_ns, topic, base::json_text(OrderedMcapJson{{"transforms", std::move(transforms)}})});
  };
  OrderedMcapJson hanging = OrderedMcapJson::array();
  for (const auto& body : bodies) {
    if (body.on) hanging.push_back(transform_json(0, bodies[*body.on].name, body.name, body.pose));
  }
  tell(0, std::move(hanging));
  const auto interval_ns = nanoseconds(recording.interval_s);
  std::vector<Pose> before(moving.size());
  std::vector<std::uint64_t> told_ns(moving.size(), 0);
  bool first = true;
  for (Playback at(recording); at.next(); first = false) {
    const auto now_ns = nanoseconds(at.time_s());
    OrderedMcapJson rested = OrderedMcapJson::array(), moved = OrderedMcapJson::array();
    const auto rest_ns = now_ns > interval_ns ? now_ns - interval_ns : 0;
    for (const auto index : at.cursor().moved()) {
      const auto& name = bodies[moving[index]].name;
      // A viewer goes on evenly from one transform to the next; what stood still says so.
      if (!first && rest_ns > told_ns[index]) {
        rested.push_back(transform_json(rest_ns, kWorldFrame, name, before[index]));
      }
      before[index] = at.pose_of(moving[index]);
      told_ns[index] = now_ns;
      moved.push_back(transform_json(now_ns, kWorldFrame, name, before[index]));
    }
    tell(rest_ns, std::move(rested));
    tell(now_ns, std::move(moved));
  }
}

void add_marks(const Recording& recording, std::uint16_t topic, std::vector<Message>& out) {
  constexpr int kInfo = 2, kWarning = 3;
  for (const auto& mark : marks_of(recording)) {
    const auto time_ns = nanoseconds(mark.time_s);
    const OrderedMcapJson log{{"timestamp", time_json(time_ns)},
                              {"level", mark.is_trouble ? kWarning : kInfo},
                              {"message", mark.text},
                              {"name", "parallax"},
                              {"file", ""},
                              {"line", 0}};
    out.push_back({time_ns, topic, base::json_text(log)});
  }
}

void add_observations(const Recording& recording, std::uint16_t topic, std::vector<Message>& out) {
  for (std::size_t i = 0; i < recording.observations.size(); ++i) {
    const double time_s =
        i == 0 || i > recording.events.size() ? 0.0 : recording.events[i - 1].end_s;
    OrderedMcapJson::object_t values;
    for (const auto& [name, value] : recording.observations[i]) {
      values.push_back(
          {name, std::visit([](const auto& plain) { return OrderedMcapJson(plain); }, value)});
    }
    out.push_back(
        {nanoseconds(time_s), topic, base::json_text(OrderedMcapJson(std::move(values)))});
  }
}

}  // namespace

std::string mcap_of(const Recording& recording) {
  McapWriter writer;
  const auto scene = writer.add_topic("/scene", "foxglove.SceneUpdate", scene_schema());
  const auto motion = writer.add_topic("/tf", "foxglove.FrameTransforms", transforms_schema());
  const auto events = writer.add_topic("/events", "foxglove.Log", log_schema());
  const auto observed =
      writer.add_topic("/observations", "parallax.Observation",
                       schema_text("parallax.Observation", OrderedMcapJson::object()));
  std::vector<Message> messages;
  add_scene(recording, scene, messages);
  add_motion(recording, motion, messages);
  add_marks(recording, events, messages);
  add_observations(recording, observed, messages);
  std::stable_sort(messages.begin(), messages.end(),
                   [](const Message& a, const Message& b) { return a.time_ns < b.time_ns; });
  for (const auto& message : messages) writer.add(message.topic, message.time_ns, message.text);
  return writer.finish();
}

}  // namespace parallax::harness
