#include <fmt/format.h>

#include <utility>

#include "compiler/base/codes/scenarios.h"
#include "harness/config/sections.h"
#include "harness/region/area.h"

namespace parallax::harness {
namespace {

constexpr std::size_t kMaxCorners = 200;  // of a polygon, which costs their square
constexpr std::size_t kMaxShapes = 100;   // of a union
constexpr NumberBounds kCoordinate{-1e6, 1e6, false, false};  // [m]
constexpr NumberBounds kRadius{0.0, 1e6, true, false};        // [m]
constexpr NumberBounds kInnerRadius{0.0, 1e6, false, false};  // [m]

std::optional<PlaneShape> read_round(const YamlNode& node, std::string_view key,
                                     base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  YamlFields fields(node, key_text(key), sink);
  RingShape shape;
  if (const auto* at = fields.require(Key::kAtM)) {
    if (const auto point = read_point(*at, key_text(Key::kAtM), sink)) shape.at = *point;
  }
  if (key == Key::kDisc) {
    fields.only({Key::kAtM, Key::kRadiusM});
    if (fields.require(Key::kRadiusM)) fields.number(Key::kRadiusM, kRadius, shape.outer_m);
  } else {
    fields.only({Key::kAtM, Key::kInnerM, Key::kOuterM});
    if (fields.require(Key::kInnerM)) fields.number(Key::kInnerM, kInnerRadius, shape.inner_m);
    if (fields.require(Key::kOuterM)) fields.number(Key::kOuterM, kRadius, shape.outer_m);
  }
  if (sink.error_count() != errors_before) return std::nullopt;
  return shape;
}

std::optional<PlaneShape> read_polygon(const YamlNode& node, base::DiagnosticSink& sink) {
  if (!node.is_list()) {
    sink.error(codes::kWrongYamlKind, node.range, key_text(Key::kPolygon), describe(node),
               "a list of corners");
    return std::nullopt;
  }
  if (node.items.size() > kMaxCorners) {
    sink.error(codes::kYamlOutOfBounds, node.range, key_text(Key::kPolygon),
               fmt::format("{} corners", node.items.size()),
               fmt::format("of at most {}", kMaxCorners));
    return std::nullopt;
  }
  PolygonShape shape;
  for (const auto& item : node.items) {
    const auto corner = read_point(item, "a corner of " + key_text(Key::kPolygon), sink);
    if (!corner) return std::nullopt;
    shape.corners.push_back(*corner);
  }
  return shape;
}

std::optional<PlaneShape> read_box(const YamlNode& node, base::DiagnosticSink& sink) {
  YamlFields fields(node, key_text(Key::kBox), sink);
  const auto x_key = to_string(RegionAxis::kX), y_key = to_string(RegionAxis::kY);
  fields.only({x_key, y_key});
  const auto* x = fields.require(x_key);
  const auto* y = fields.require(y_key);
  if (x == nullptr || y == nullptr) return std::nullopt;
  const auto xs = read_interval(*x, key_text(x_key), sink);
  const auto ys = read_interval(*y, key_text(y_key), sink);
  if (!xs || !ys) return std::nullopt;
  for (const auto& [node_of, interval] : {std::pair{x, *xs}, {y, *ys}}) {
    if (interval.lower < interval.upper) continue;
    sink.error(codes::kReversedSampling, node_of->range, key_text(Key::kBox), interval.lower,
               interval.upper);
    return std::nullopt;
  }
  return PolygonShape{{{xs->lower, ys->lower},
                       {xs->upper, ys->lower},
                       {xs->upper, ys->upper},
                       {xs->lower, ys->upper}}};
}

/// Adds the one shape of the map, or those of its union. False: it was reported.
bool read_shapes(const YamlFields& fields, std::vector<PlaneShape>& shapes) {
  auto& sink = fields.sink();
  const YamlNode* found = nullptr;
  std::string_view key;
  for (const auto one : kAreaKeys) {
    const auto* node = given(fields, one);
    if (node == nullptr) continue;
    if (found != nullptr) {
      sink.error(codes::kYamlOutOfBounds, node->range, key_text(one),
                 "given besides " + key_text(key), "alone, or in a " + key_text(Key::kUnion));
      return false;
    }
    found = node;
    key = one;
  }
  if (found == nullptr) {
    sink.error(codes::kMissingKey, fields.node().range, fields.what(), Key::kDisc);
    return false;
  }
  if (key == Key::kUnion) {
    if (!found->is_list() || found->items.empty()) {
      sink.error(codes::kWrongYamlKind, found->range, key_text(key), describe(*found),
                 "a list of shapes");
      return false;
    }
    for (const auto& item : found->items) {
      YamlFields inner(item, "a shape of " + key_text(key), sink);
      if (!item.is_map()) return false;
      inner.only(kAreaKeys);
      if (!read_shapes(inner, shapes)) return false;
    }
    return true;
  }
  auto shape = key == Key::kPolygon ? read_polygon(*found, sink)
               : key == Key::kBox   ? read_box(*found, sink)
                                    : read_round(*found, key, sink);
  if (!shape) return false;
  if (const auto fault = fault_of(*shape); !fault.empty()) {
    sink.error(codes::kBadArea, found->range, key_text(key), fault);
    return false;
  }
  if (shapes.size() == kMaxShapes) {
    sink.error(codes::kBadArea, found->range, "the area",
               fmt::format("has more than {} shapes", kMaxShapes));
    return false;
  }
  shapes.push_back(*std::move(shape));
  return true;
}

}  // namespace

std::optional<PlanePoint> read_point(const YamlNode& node, std::string_view name,
                                     base::DiagnosticSink& sink) {
  if (!node.is_list() || node.items.size() != 2) {
    sink.error(codes::kWrongYamlKind, node.range, name, describe(node), "a list of x and y");
    return std::nullopt;
  }
  const auto x = read_number(node.items[0], name, kCoordinate, sink);
  const auto y = read_number(node.items[1], name, kCoordinate, sink);
  if (!x || !y) return std::nullopt;
  return PlanePoint{*x, *y};
}

const YamlNode* given(const YamlFields& fields, std::string_view key) {
  const auto* node = fields.find(key);
  return node == nullptr || node->kind == YamlNode::Kind::kNull ? nullptr : node;
}

std::shared_ptr<const Area> read_area(const YamlFields& fields) {
  std::vector<PlaneShape> shapes;
  if (!read_shapes(fields, shapes)) return nullptr;
  return std::make_shared<const Area>(std::move(shapes));
}

}  // namespace parallax::harness
