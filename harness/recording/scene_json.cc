#include "harness/recording/scene_json.h"

#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "compiler/base/json.h"
#include "compiler/base/word_table.h"

namespace parallax::harness {
namespace {

using SceneJson = nlohmann::json;
using OrderedSceneJson = nlohmann::ordered_json;

constexpr std::size_t kMostBodies = 10'000, kMostShapes = 100'000, kMostGrippers = 64;
constexpr std::size_t kMostCorners = 256, kMostFaces = 512;
constexpr auto kShapeKindWords =
    base::word_table<ShapeKind>("box", "sphere", "cylinder", "capsule", "hull");
constexpr auto kBodyKindWords =
    base::word_table<BodyKind>("furniture", "drawer", "robot", "gripper", "item", "camera");

/// How many numbers say how large it is.
std::size_t size_count(ShapeKind kind) {
  return kind == ShapeKind::kBox ? 3 : kind == ShapeKind::kSphere ? 1 : 2;
}

OrderedSceneJson pose_json(const Pose& pose) {
  auto out = OrderedSceneJson(pose.p);
  if (pose.q != Pose().q) {
    for (const double x : pose.q) out.push_back(x);
  }
  return out;
}

OrderedSceneJson shape_json(const RecordedShape& shape) {
  OrderedSceneJson out = OrderedSceneJson::object();
  auto& numbers = out[std::string(kShapeKindWords.of(shape.kind))] = OrderedSceneJson::array();
  if (shape.kind == ShapeKind::kHull) {
    numbers = shape.corners;
    out["faces"] = shape.faces;
  } else {
    for (std::size_t i = 0; i < size_count(shape.kind); ++i) numbers.push_back(shape.size[i]);
  }
  if (shape.pose != Pose()) out["pose"] = pose_json(shape.pose);
  return out;
}

OrderedSceneJson body_json(const RecordedBody& body) {
  OrderedSceneJson out{{"name", body.name}, {"kind", kBodyKindWords.of(body.kind)}};
  if (!body.colour.empty()) out["colour"] = body.colour;
  if (body.moves) out["moves"] = true;
  if (body.on) out["on"] = *body.on;
  if (body.pose != Pose()) out["pose"] = pose_json(body.pose);
  auto& shapes = out["shapes"] = OrderedSceneJson::array();
  for (const auto& shape : body.shapes) shapes.push_back(shape_json(shape));
  return out;
}

/// Reads a scene and keeps the first thing that is wrong.
class SceneReader {
 public:
  explicit SceneReader(std::string& why) : why_(why) { why_.clear(); }

  std::optional<RecordedScene> read(const SceneJson& json) {
    RecordedScene scene;
    read_bodies(json, scene);
    if (why_.empty()) read_grippers(json, scene);
    if (why_.empty()) read_arms(json, scene);
    if (why_.empty()) read_camera(json, scene);
    if (!why_.empty()) return std::nullopt;
    return scene;
  }

 private:
  void fail(std::string why) {
    if (why_.empty()) why_ = std::move(why);
  }

  /// `from` to `to` finite numbers below `limit`.
  std::vector<double> numbers(const SceneJson& json, std::size_t from, std::size_t to,
                              const std::string& what, double limit = 1e6) {
    std::vector<double> out;
    if (!json.is_array() || json.size() < from || json.size() > to) {
      fail(what + " is no list of " + std::to_string(to) + " numbers");
      return std::vector<double>(to, 0.0);
    }
    for (const auto& item : json) {
      const auto number = base::json_as<double>(item);
      if (!number || !(std::abs(*number) <= limit)) fail(what + " has what is no number");
      out.push_back(number.value_or(0.0));
    }
    return out;
  }

  Pose pose(const SceneJson* json, const std::string& what) {
    Pose out;
    if (json == nullptr) return out;
    const auto all = numbers(*json, 3, 7, "the pose of " + what);
    std::copy_n(all.begin(), 3, out.p.begin());
    if (all.size() == 3 || !why_.empty()) return out;
    if (all.size() != 7) {
      fail("the pose of " + what + " has neither three nor seven numbers");
      return out;
    }
    std::copy_n(all.begin() + 3, 4, out.q.begin());
    double norm = 0.0;
    for (const double x : out.q) norm += x * x;
    if (std::abs(norm - 1.0) > 0.02) fail("the turn of " + what + " is no unit quaternion");
    return out;
  }

  std::string text(const SceneJson& json, const char* name, const std::string& what) {
    const auto* member = base::json_member(json, name);
    const auto value = member == nullptr ? std::nullopt : base::json_as<std::string>(*member);
    if (!value) fail("`" + std::string(name) + "` of " + what + " is missing or no text");
    return value.value_or("");
  }

  std::size_t number_of_body(const SceneJson& json, const char* name, std::size_t bodies,
                             const std::string& what) {
    const auto* member = base::json_member(json, name);
    const auto value = member == nullptr ? std::nullopt : base::json_as<std::int64_t>(*member);
    if (value && *value >= 0 && static_cast<std::uint64_t>(*value) < bodies) {
      return static_cast<std::size_t>(*value);
    }
    fail("`" + std::string(name) + "` of " + what + " is not the number of a body");
    return 0;
  }

  void read_bodies(const SceneJson& json, RecordedScene& scene) {
    const auto* bodies = base::json_member(json, "bodies");
    if (bodies == nullptr || !bodies->is_array()) return fail("`bodies` is missing or no list");
    if (bodies->size() > kMostBodies) return fail("there are more than 10000 bodies");
    std::set<std::string> names;
    for (const auto& item : *bodies) {
      const auto what = "body " + std::to_string(scene.bodies.size());
      if (!item.is_object()) return fail(what + " is no object");
      RecordedBody body;
      body.name = text(item, "name", what);
      if (!names.insert(body.name).second) fail("two bodies are called `" + body.name + "`");
      read_body(item, "`" + body.name + "`", bodies->size(), body);
      if (!why_.empty()) return;
      scene.bodies.push_back(std::move(body));
    }
    for (const auto& body : scene.bodies) {
      if (!body.on) continue;
      const auto& carrier = scene.bodies[*body.on];
      if (!carrier.moves || carrier.on)
        fail("`" + body.name + "` hangs on what does not move itself");
    }
  }

  void read_body(const SceneJson& json, const std::string& what, std::size_t bodies,
                 RecordedBody& body) {
    if (const auto* kind = base::json_member(json, "kind")) {
      const auto known = kBodyKindWords.find(base::json_as<std::string>(*kind).value_or(""));
      if (!known) fail(what + " is of no kind that there is");
      body.kind = known.value_or(body.kind);
    }
    if (json.contains("colour")) body.colour = text(json, "colour", what);
    if (!body.colour.empty() && !is_colour(body.colour))
      fail("the colour of " + what + " is not #rrggbb");
    if (const auto* moves = base::json_member(json, "moves")) {
      if (!moves->is_boolean()) return fail("`moves` of " + what + " is neither true nor false");
      body.moves = moves->get<bool>();
    }
    if (json.contains("on")) {
      body.on = number_of_body(json, "on", bodies, what);
      if (!body.moves) fail(what + " hangs on another and does not move");
    }
    body.pose = pose(base::json_member(json, "pose"), what);
    read_shapes(json, what, body);
  }

  static bool is_colour(std::string_view text) {
    return text.size() == 7 && text.front() == '#' &&
           text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string_view::npos;
  }

  void read_shapes(const SceneJson& json, const std::string& what, RecordedBody& body) {
    const auto* shapes = base::json_member(json, "shapes");
    if (shapes == nullptr) return;
    if (!shapes->is_array()) return fail("`shapes` of " + what + " is no list");
    shapes_ += shapes->size();
    if (shapes_ > kMostShapes) return fail("there are more than 100000 shapes");
    for (const auto& item : *shapes) {
      RecordedShape shape;
      const SceneJson* size = nullptr;
      for (const auto kind : {ShapeKind::kHull, ShapeKind::kBox, ShapeKind::kSphere,
                              ShapeKind::kCylinder, ShapeKind::kCapsule}) {
        if (const auto* found = base::json_member(item, kShapeKindWords.of(kind).data())) {
          size = found;
          shape.kind = kind;
        }
      }
      if (size != nullptr && shape.kind == ShapeKind::kHull) {
        read_hull(item, *size, what, shape);
        shape.pose = pose(base::json_member(item, "pose"), "a shape of " + what);
        if (!why_.empty()) return;
        body.shapes.push_back(std::move(shape));
        continue;
      }
      if (size == nullptr) {
        return fail("a shape of " + what + " is neither box, sphere, cylinder, capsule nor hull");
      }
      const auto count = size_count(shape.kind);
      const auto all = numbers(*size, count, count, "the size of a shape of " + what);
      for (std::size_t i = 0; i < count && why_.empty(); ++i) {
        shape.size[i] = all[i];
        if (all[i] < 0.0) fail("the size of a shape of " + what + " is negative");
      }
      shape.pose = pose(base::json_member(item, "pose"), "a shape of " + what);
      if (!why_.empty()) return;
      body.shapes.push_back(shape);
    }
  }

  void read_hull(const SceneJson& json, const SceneJson& corners, const std::string& what,
                 RecordedShape& shape) {
    const auto* faces = base::json_member(json, "faces");
    if (faces == nullptr || !faces->is_array() || faces->empty() || faces->size() > kMostFaces ||
        !corners.is_array() || corners.size() < 4 || corners.size() > kMostCorners) {
      return fail("a hull of " + what + " has not 4 to 256 corners and up to 512 `faces`");
    }
    shape.kind = ShapeKind::kHull;
    for (const auto& item : corners) {
      const auto corner = numbers(item, 3, 3, "a corner of " + what);
      if (!why_.empty()) return;
      shape.corners.push_back({corner[0], corner[1], corner[2]});
    }
    for (const auto& item : *faces) {
      if (!item.is_array() || item.size() != 3)
        return fail("a face of " + what + " is no triangle");
      auto& face = shape.faces.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) {
        const auto corner = base::json_as<std::int64_t>(item[i]);
        if (!corner || *corner < 0 || *corner >= static_cast<std::int64_t>(corners.size())) {
          return fail("a face of " + what + " has no such corner");
        }
        face[i] = static_cast<std::uint32_t>(*corner);
      }
    }
  }

  void read_grippers(const SceneJson& json, RecordedScene& scene) {
    const auto* grippers = base::json_member(json, "grippers");
    if (grippers == nullptr) return;
    if (!grippers->is_array() || grippers->size() > kMostGrippers) {
      return fail("`grippers` is no list of at most 64 names");
    }
    for (const auto& item : *grippers) {
      const auto name = base::json_as<std::string>(item);
      if (!name) return fail("`grippers` has what is no name");
      scene.grippers.push_back(*name);
    }
  }

  void read_arms(const SceneJson& json, RecordedScene& scene) {
    const auto* arms = base::json_member(json, "arms");
    if (arms == nullptr) return;
    if (!arms->is_array() || arms->size() > kMostGrippers) {
      return fail("`arms` is no list of at most 64");
    }
    for (const auto& item : *arms) {
      RecordedArm arm;
      arm.name = text(item, "name", "an arm");
      const auto what = "the arm `" + arm.name + "`";
      arm.from = number_of_body(item, "from", scene.bodies.size(), what);
      arm.to = number_of_body(item, "to", scene.bodies.size(), what);
      arm.shoulder = pose(base::json_member(item, "shoulder"), what).p;
      if (const auto* reach = base::json_member(item, "reach")) {
        const auto both = numbers(*reach, 2, 2, "the reach of " + what);
        arm.min_reach_m = both[0];
        arm.max_reach_m = both.size() > 1 ? both[1] : 0.0;
      }
      if (!why_.empty()) return;
      scene.arms.push_back(std::move(arm));
    }
  }

  void read_camera(const SceneJson& json, RecordedScene& scene) {
    const auto* camera = base::json_member(json, "camera");
    if (camera == nullptr) return;
    const auto all = numbers(*camera, 3, 3, "`camera`");
    if (why_.empty()) scene.camera = RecordedCone{all[0], all[1], all[2]};
  }

  std::string& why_;
  std::size_t shapes_ = 0;
};

}  // namespace

std::string scene_text(const RecordedScene& scene) {
  OrderedSceneJson out = OrderedSceneJson::object();
  auto& bodies = out["bodies"] = OrderedSceneJson::array();
  for (const auto& body : scene.bodies) bodies.push_back(body_json(body));
  if (!scene.grippers.empty()) out["grippers"] = scene.grippers;
  for (const auto& arm : scene.arms) {
    out["arms"].push_back(OrderedSceneJson{{"name", arm.name},
                                           {"from", arm.from},
                                           {"shoulder", arm.shoulder},
                                           {"to", arm.to},
                                           {"reach", {arm.min_reach_m, arm.max_reach_m}}});
  }
  if (scene.camera) {
    out["camera"] = {scene.camera->half_angle_rad, scene.camera->min_range_m,
                     scene.camera->max_range_m};
  }
  return base::json_text(out);
}

std::optional<RecordedScene> scene_from_text(std::string_view text, std::string& why) {
  const auto json = base::parse_json(text);
  if (!json.is_discarded()) return SceneReader(why).read(json);
  why = "it is not JSON";
  return std::nullopt;
}

}  // namespace parallax::harness
