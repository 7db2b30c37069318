#include "harness/draw/scene_view.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/xml_text.h"
#include "harness/draw/shown_text.h"

namespace parallax::harness {
namespace {

constexpr double kFont_px = 10.0;
constexpr double kHeight_px = kFont_px + 1.0;
constexpr double kNear_px = 3.0, kStep_px = 10.0;
constexpr int kRings = 16;
constexpr std::size_t kLongestLabel = 60;  // characters

/// Lower left corners of a text of this size inside the named rectangle, the best first.
std::vector<Eigen::Vector2d> inside(const Rectangle& named, const Eigen::Vector2d& size) {
  if ((named.size().array() < size.array() + 4.0).any()) return {};
  const double left = named.low.x() + 2.0, right = named.high.x() - size.x() - 2.0;
  const double upper = named.low.y() + size.y() + 1.0, lower = named.high.y() - 3.0;
  const double x = 0.5 * (left + right), y = 0.5 * (upper + lower);
  return {{left, upper}, {left, lower}, {right, lower}, {right, upper}, {x, y}, {x, lower}};
}

/// The same round it, `gap` away.
std::vector<Eigen::Vector2d> outside(const Rectangle& named, const Eigen::Vector2d& size,
                                     double gap) {
  const double right = named.high.x() + gap, left = named.low.x() - gap - size.x();
  const double below = named.high.y() + gap + size.y(), above = named.low.y() - gap;
  const double x = 0.5 * (named.low.x() + named.high.x() - size.x());
  const double y = 0.5 * (named.low.y() + named.high.y() + size.y());
  return {{right, y},     {left, y},      {x, below},    {x, above},
          {right, above}, {right, below}, {left, below}, {left, above}};
}

constexpr const char* kRegionColour = "#1d6b2c";

const char* fill_colour(SceneKind kind) {
  switch (kind) {
    case SceneKind::kFurniture:
      return "#eeeae2";
    case SceneKind::kDrawer:
      return "#e6d0ae";
    case SceneKind::kRobot:
      return "#bcd0e4";
    case SceneKind::kGripper:
      return "#4d7299";
    case SceneKind::kItem:
      return "#d8604c";
  }
  return "#ffffff";
}

/// Regions of the world's frame, as far as they lie in the picture.
bool is_drawn(const Region& region, const SceneFrame& frame) {
  if (!region.frame.empty()) return false;
  const auto &x = region.on(RegionAxis::kX), &y = region.on(RegionAxis::kY);
  const auto meets = [](const std::optional<Interval>& interval, double low, double high) {
    return !interval || (interval->lower < high && low < interval->upper);
  };
  return (x || y) && meets(x, frame.low.x(), frame.high.x()) &&
         meets(y, frame.low.y(), frame.high.y());
}

Rectangle rectangle_of(const Region& region, const Projection& projection) {
  const SceneFrame& frame = projection.frame();
  const auto &x = region.on(RegionAxis::kX), &y = region.on(RegionAxis::kY);
  return {projection.pixel({x ? x->lower : frame.low.x(), y ? y->upper : frame.high.y(), 0.0}),
          projection.pixel({x ? x->upper : frame.high.x(), y ? y->lower : frame.low.y(), 0.0})};
}

}  // namespace

bool LabelLayout::is_free(const Rectangle& box, bool strict) const {
  const auto meets = [&](const Rectangle& other) { return box.meets(other); };
  return area_.holds(box) && std::none_of(texts_.begin(), texts_.end(), meets) &&
         !(strict && std::any_of(avoided_.begin(), avoided_.end(), meets));
}

std::string LabelLayout::place(const std::string& name, const char* colour,
                               const Rectangle& named) {
  const auto text = shown_text(name, kLongestLabel);
  const Eigen::Vector2d size(text_width_px(text, kFont_px), kHeight_px);
  auto corners = inside(named, size);
  for (int ring = 0; ring < kRings; ++ring) {
    const auto more = outside(named, size, kNear_px + kStep_px * ring);
    corners.insert(corners.end(), more.begin(), more.end());
  }
  for (const bool strict : {true, false}) {
    for (const Eigen::Vector2d& corner : corners) {
      const Rectangle box{{corner.x(), corner.y() - size.y()}, {corner.x() + size.x(), corner.y()}};
      if (!is_free(box, strict)) continue;
      texts_.push_back(box);
      const Eigen::Vector2d end = box.low.cwiseMax(named.low.cwiseMin(box.high));
      const Eigen::Vector2d start = named.low.cwiseMax(end.cwiseMin(named.high));
      std::string out;
      if ((start - end).norm() > kNear_px + kStep_px) {
        out = fmt::format(
            "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
            "stroke-width=\"0.6\"/>\n",
            start.x(), start.y(), end.x(), end.y(), colour);
      }
      return out + fmt::format(
                       "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:g}\" fill=\"{}\" "
                       "stroke=\"white\" stroke-width=\"2.5\" stroke-opacity=\"0.8\" "
                       "paint-order=\"stroke\">{}</text>\n",
                       box.low.x(), box.high.y() - 2.0, kFont_px, colour, base::xml_escaped(text));
    }
  }
  return {};
}

const char* line_colour(SceneKind kind) {
  switch (kind) {
    case SceneKind::kFurniture:
      return "#6e6453";
    case SceneKind::kDrawer:
      return "#7a5a2a";
    case SceneKind::kRobot:
      return "#33567a";
    case SceneKind::kGripper:
      return "#1d3550";
    case SceneKind::kItem:
      return "#7c2517";
  }
  return "#000000";
}

SceneView::SceneView(const Projection& projection, const Scene& scene,
                     const std::set<std::string>* bright)
    : projection_(projection), scene_(scene), bright_(bright), labels_(projection.area()) {
  for (const SceneBox& item : scene.boxes) {
    const auto outline = projection_.outline(item.box);
    if (outline.empty()) continue;
    order_.push_back(&item);
    Body& body = bodies_[item.body];
    body.kind = item.kind;
    body.points.insert(body.points.end(), outline.begin(), outline.end());
  }
  std::stable_sort(order_.begin(), order_.end(), [this](const SceneBox* a, const SceneBox* b) {
    return projection_.nearness(a->box) < projection_.nearness(b->box);
  });
}

std::string SceneView::polygon(const SceneBox& item) const {
  return fmt::format(
      "<polygon points=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1\"{}>"
      "<title>{}</title></polygon>\n",
      point_list(projection_.outline(item.box)), fill_colour(item.kind), line_colour(item.kind),
      is_faint(item.body) ? " opacity=\"0.45\"" : "", shown_in_full(item.body));
}

std::string SceneView::covered() const {
  std::vector<Rectangle> places;
  for (const SceneBox* item : order_) places.push_back(around(projection_.outline(item->box)));
  std::string out;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    bool is_covered = false;
    for (std::size_t later = i + 1; later < order_.size() && !is_covered; ++later) {
      is_covered = order_[later]->body != order_[i]->body && places[later].meets(places[i]);
    }
    if (!is_covered || is_faint(order_[i]->body)) continue;
    out += fmt::format(
        "<polyline class=\"covered\" points=\"{}\" fill=\"none\" stroke=\"{}\" "
        "stroke-width=\"0.8\" stroke-dasharray=\"1.5 2\"/>\n",
        point_list(closed(projection_.outline(order_[i]->box))), line_colour(order_[i]->kind));
  }
  return out;
}

std::string SceneView::arms() const {
  std::string out;
  for (const SceneArm& arm : scene_.arms) {
    const Eigen::Vector2d a = projection_.pixel(arm.from_W), b = projection_.pixel(arm.to_W);
    out += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#33567a\" "
        "stroke-width=\"4\" stroke-opacity=\"0.5\" stroke-linecap=\"round\"><title>{}</title>"
        "</line>\n",
        a.x(), a.y(), b.x(), b.y(), shown_in_full(arm.name));
  }
  return out;
}

std::string SceneView::bodies() const {
  std::string out;
  for (const SceneBox* item : order_) out += polygon(*item);
  return out + covered() + arms();
}

std::string SceneView::floor() const {
  if (projection_.kind() == ViewKind::kAbove) return {};
  const SceneFrame& frame = projection_.frame();
  const Eigen::Vector2d a = projection_.pixel({frame.low.x(), frame.low.y(), 0.0});
  const Eigen::Vector2d b = projection_.pixel({frame.high.x(), frame.high.y(), 0.0});
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#666\"/>\n", a.x(),
      a.y(), b.x(), b.y());
}

std::string SceneView::regions(const RegionMap& regions) const {
  std::string out;
  for (const Region& region : regions.regions()) {
    if (!is_drawn(region, projection_.frame())) continue;
    const Rectangle box = rectangle_of(region, projection_);
    out += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
        "stroke=\"#2a7a3a\" stroke-dasharray=\"6 3\"/>\n",
        box.low.x(), box.low.y(), box.size().x(), box.size().y());
  }
  return out;
}

std::string SceneView::region(const Region& region, const char* colour) const {
  if (!is_drawn(region, projection_.frame())) return {};
  const Rectangle box = rectangle_of(region, projection_);
  return fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
      "stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"7 4\"/>\n",
      box.low.x(), box.low.y(), box.size().x(), box.size().y(), colour);
}

std::string SceneView::region_names(const RegionMap& regions) {
  std::string out;
  for (const Region& region : regions.regions()) {
    if (!is_drawn(region, projection_.frame())) continue;
    out += labels_.place(region.name, kRegionColour, rectangle_of(region, projection_));
  }
  return out;
}

std::string SceneView::body_names(const std::vector<std::string>& warned) {
  for (const auto& [name, body] : bodies_) {
    if (body.kind == SceneKind::kItem || body.kind == SceneKind::kGripper) {
      labels_.avoid(around(body.points));
    }
  }
  std::string out;
  for (const std::string& name : warned) {
    const auto found = bodies_.find(name);
    if (found == bodies_.end()) continue;
    out += labels_.place(name, kWarningColour, around(found->second.points));
  }
  const auto is_warned = [&](const std::string& name) {
    return std::find(warned.begin(), warned.end(), name) != warned.end();
  };
  for (const SceneKind kind :
       {SceneKind::kItem, SceneKind::kDrawer, SceneKind::kRobot, SceneKind::kFurniture}) {
    for (const auto& [name, body] : bodies_) {
      if (body.kind != kind || is_warned(name)) continue;
      if (kind == SceneKind::kRobot && name != scene_.base) continue;
      out += labels_.place(name, line_colour(kind), around(body.points));
    }
  }
  for (const SceneArm& arm : scene_.arms) {
    const Eigen::Vector2d hand = projection_.pixel(arm.to_W);
    out += labels_.place(arm.name, line_colour(SceneKind::kGripper),
                         {hand.array() - 8.0, hand.array() + 8.0});
  }
  return out;
}

std::string SceneView::axes() const {
  constexpr double kLength_px = 22.0;
  const Rectangle area = projection_.area();
  const double x = area.low.x() + 2.0, y = area.high.y() + kLength_px + 10.0;
  return fmt::format(
      "<path d=\"M{0:.1f} {2:.1f}V{1:.1f}H{3:.1f}\" fill=\"none\" stroke=\"#444\"/>\n"
      "<text x=\"{4:.1f}\" y=\"{5:.1f}\" font-size=\"10\" fill=\"#444\">{9}</text>\n"
      "<text x=\"{6:.1f}\" y=\"{7:.1f}\" font-size=\"10\" fill=\"#444\">{8}</text>\n",
      x, y, y - kLength_px, x + kLength_px, x + kLength_px + 4.0, y + 3.0, x + 4.0,
      y - kLength_px + 6.0, projection_.kind() == ViewKind::kAbove ? 'y' : 'z',
      projection_.kind() == ViewKind::kFront ? 'y' : 'x');
}

}  // namespace parallax::harness
