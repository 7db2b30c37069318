#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "compiler/base/diagnostic_codes.h"
#include "harness/config/world_sections.h"

namespace parallax::harness {
namespace {

using base::DiagnosticCode;

BoxShape read_shape(const YamlNode& node, std::string what, base::DiagnosticSink& sink) {
  BoxShape shape;
  YamlFields fields(node, std::move(what), sink);
  fields.only({"size_m", "at_m", "yaw_rad"});
  fields.require("size_m");
  read_vector(fields, "size_m", shape.size_m);
  read_vector(fields, "at_m", shape.p_BS);
  fields.number("yaw_rad", kAnyNumber, shape.yaw_rad);
  return shape;
}

/// A bowl: a bottom and a ring of walls, its origin in the middle of its height.
void read_ring(const YamlNode& node, BodySpec& body, base::DiagnosticSink& sink) {
  YamlFields fields(node, fmt::format("`ring` of the body `{}`", body.name), sink);
  fields.only({"diameter_m", "height_m", "wall_m", "sides"});
  double diameter_m = 0.0, height_m = 0.0, wall_m = 0.0;
  std::int64_t sides = 12;
  for (const char* key : {"diameter_m", "height_m", "wall_m"}) fields.require(key);
  fields.number("diameter_m", kPositive, diameter_m);
  fields.number("height_m", kPositive, height_m);
  fields.number("wall_m", kPositive, wall_m);
  fields.integer("sides", 4, 64, sides);
  if (!(diameter_m > 2.0 * wall_m && height_m > wall_m)) {
    sink.error(DiagnosticCode::kYamlOutOfBounds, node.range, fields.what(), "all wall",
               "wider and higher than its walls");
    return;
  }
  const double radius_m = 0.5 * (diameter_m - wall_m);
  const auto count = static_cast<double>(sides);
  const double length_m = 2.0 * 0.5 * diameter_m * std::tan(std::numbers::pi / count);
  const double bottom_m = diameter_m * std::numbers::sqrt2 / 2.0 - wall_m;
  body.shapes.push_back(
      {{bottom_m, bottom_m, wall_m}, {0.0, 0.0, -0.5 * (height_m - wall_m)}, 0.0});
  for (std::int64_t side = 0; side < sides; ++side) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(side) / count;
    body.shapes.push_back({{wall_m, length_m, height_m},
                           {radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0},
                           angle});
  }
}

/// One box, or a list of them under `shapes`, or a ring of them.
void read_shapes(const YamlFields& fields, BodySpec& body) {
  const auto* list = fields.find("shapes");
  const auto* ring = fields.find("ring");
  if (list == nullptr && ring == nullptr) {
    if (fields.require("size_m") == nullptr) return;
    BoxShape shape;
    read_vector(fields, "size_m", shape.size_m);
    body.shapes.push_back(shape);
    return;
  }
  for (const char* other : {"size_m", list != nullptr ? "ring" : "size_m"}) {
    const auto* extra = fields.find(other);
    if (extra == nullptr) continue;
    fields.sink().error(DiagnosticCode::kUnknownKey, extra->range, other,
                        fields.what() + ", which has `shapes` or `ring`");
    return;
  }
  if (ring != nullptr) {
    read_ring(*ring, body, fields.sink());
    return;
  }
  if (!list->is_list()) {
    fields.sink().error(DiagnosticCode::kWrongYamlKind, list->range, "`shapes`", describe(*list),
                        "a list of boxes");
    return;
  }
  for (const auto& item : list->items) {
    body.shapes.push_back(read_shape(item, "a shape of " + fields.what(), fields.sink()));
  }
}

GraspSpec read_grasp(const YamlNode& node, std::string what, base::DiagnosticSink& sink) {
  static constexpr std::array<std::string_view, 2> kFrames = {"robot", "body"};
  static constexpr std::array<std::string_view, 2> kApproaches = {"level", "above"};
  GraspSpec grasp;
  YamlFields fields(node, std::move(what), sink);
  fields.only({"at_m", "frame", "wrist_rad", "approach", "width_m", "effort_n"});
  fields.require("width_m");
  read_vector(fields, "at_m", grasp.p_BG);
  if (const auto frame = fields.choice("frame", "frame of a grasp", kFrames)) {
    grasp.follows_body = *frame == 1;
  }
  grasp.from_above =
      fields.choice("approach", "approach of a grasp", kApproaches) == std::size_t{1};
  fields.number("wrist_rad", kAnyNumber, grasp.wrist_rad);
  fields.number("width_m", kPositive, grasp.width_m);
  fields.number("effort_n", kPositive, grasp.effort_n);
  return grasp;
}

}  // namespace

void read_vector(const YamlFields& fields, std::string_view key, Eigen::Vector3d& out) {
  if (const auto values = fields.numbers(key, 3)) {
    out = Eigen::Vector3d((*values)[0], (*values)[1], (*values)[2]);
  }
}

BodySpec read_body(const YamlEntry& entry, base::DiagnosticSink& sink) {
  BodySpec body;
  body.name = entry.key;
  YamlFields fields(entry.value, fmt::format("the body `{}`", entry.key), sink);
  fields.only({"size_m", "shapes", "ring", "mass_kg", "material", "position_m", "yaw_rad",
               "gravity", "collides", "settable", "kind", "grasp"});
  read_shapes(fields, body);
  fields.number("mass_kg", kNotNegative, body.mass_kg);
  fields.text("material", body.material);
  read_vector(fields, "position_m", body.p_WB);
  fields.number("yaw_rad", kAnyNumber, body.yaw_rad);
  fields.boolean("gravity", body.gravity);
  fields.boolean("collides", body.collides);
  fields.texts("settable", body.settable);
  fields.text("kind", body.kind);
  if (const auto* grasp = fields.find("grasp")) {
    body.grasp = read_grasp(*grasp, fmt::format("`grasp` of the body `{}`", entry.key), sink);
  }
  return body;
}

HandleSpec read_handle(const YamlNode& node, base::DiagnosticSink& sink) {
  HandleSpec handle;
  YamlFields fields(node, "`handle`", sink);
  fields.only({"at_m", "approach", "wrist_rad", "width_m"});
  fields.require("at_m");
  read_vector(fields, "at_m", handle.p_CH);
  read_vector(fields, "approach", handle.approach);
  fields.number("wrist_rad", kAnyNumber, handle.wrist_rad);
  fields.number("width_m", kPositive, handle.width_m);
  if (handle.approach.norm() < 1e-9) {
    sink.error(DiagnosticCode::kYamlOutOfBounds, node.range, "`approach`", "without a direction",
               "a vector with a length");
  }
  return handle;
}

PlaceSpec read_place(const YamlEntry& entry, base::DiagnosticSink& sink) {
  PlaceSpec place;
  place.name = entry.key;
  YamlFields fields(entry.value, fmt::format("the place `{}`", entry.key), sink);
  fields.only({"frame", "at_m", "yaw_rad"});
  fields.require("at_m");
  fields.text("frame", place.frame);
  read_vector(fields, "at_m", place.p_FP);
  fields.number("yaw_rad", kAnyNumber, place.yaw_rad);
  return place;
}

}  // namespace parallax::harness
