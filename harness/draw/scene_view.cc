#include "harness/draw/scene_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "compiler/base/xml_text.h"

namespace parallax::harness {
namespace {

constexpr double kFont_px = 10.0;
constexpr double kCharacter_px = 0.6 * kFont_px;  // of a sans-serif font, on average
constexpr const char* kRegionColour = "#1d6b2c";
constexpr const char* kItemColour = "#7c2517";

struct Colour {
  const char* fill;
  const char* line;
  double opacity;
};

/// Furniture lets drawers and what lies in them shine through.
Colour colour_of(SceneKind kind) {
  switch (kind) {
    case SceneKind::kFurniture:
      return {"#e8e2d8", "#8c8272", 0.6};
    case SceneKind::kDrawer:
      return {"#d9b98a", "#7a5a2a", 0.6};
    case SceneKind::kRobot:
      return {"#9fbbd8", "#33567a", 0.7};
    case SceneKind::kGripper:
      return {"#4d7299", "#1d3550", 1.0};
    case SceneKind::kItem:
      return {"#d8604c", "#7c2517", 1.0};
  }
  return {"#ffffff", "#000000", 1.0};
}

/// Convex hull, counter-clockwise (Andrew 1979).
std::vector<Eigen::Vector2d> hull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  const auto left_turn = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                            const Eigen::Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()) > 0.0;
  };
  std::vector<Eigen::Vector2d> out;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = out.size();
    for (const Eigen::Vector2d& p : points) {
      while (out.size() >= base + 2 && !left_turn(out[out.size() - 2], out.back(), p)) {
        out.pop_back();
      }
      out.push_back(p);
    }
    out.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return out;
}

/// Bytes that continue a character of UTF-8 take no room.
double text_width_px(const std::string& text) {
  const auto characters = std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  });
  return kCharacter_px * static_cast<double>(characters);
}

}  // namespace

Eigen::Vector2d SceneView::pixel(const Eigen::Vector3d& p_W) const {
  const double right = std::clamp(p_W.x(), frame_.low.x(), frame_.high.x());
  const double up = std::clamp(kind_ == ViewKind::kAbove ? p_W.y() : p_W.z(), bottom(), top());
  return {left_px_ + px_per_m_ * (right - frame_.low.x()), top_px_ + px_per_m_ * (top() - up)};
}

std::vector<Eigen::Vector2d> SceneView::outline(const Probe& box) const {
  std::vector<Eigen::Vector2d> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d sign(i % 2 == 0 ? 0.5 : -0.5, i / 2 % 2 == 0 ? 0.5 : -0.5,
                               i / 4 == 0 ? 0.5 : -0.5);
    corners.push_back(pixel(box.p_WS + box.R_WS * sign.cwiseProduct(box.size_m)));
  }
  return hull(corners);
}

double SceneView::nearness(const SceneBox& item) const {
  const Eigen::Vector3d half = 0.5 * item.box.R_WS.cwiseAbs() * item.box.size_m;
  return kind_ == ViewKind::kAbove ? item.box.p_WS.z() + half.z() : -(item.box.p_WS.y() - half.y());
}

std::string SceneView::polygon(const SceneBox& item) const {
  std::string points;
  for (const Eigen::Vector2d& p : outline(item.box)) {
    points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", p.x(), p.y());
  }
  const Colour colour = colour_of(item.kind);
  return fmt::format(
      "<polygon points=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1\" "
      "fill-opacity=\"{}\"><title>{}</title></polygon>\n",
      points, colour.fill, colour.line, colour.opacity, base::xml_escaped(item.body));
}

std::string SceneView::scene(const Scene& scene) const {
  std::vector<const SceneBox*> order;
  for (const SceneBox& item : scene.boxes) order.push_back(&item);
  std::stable_sort(order.begin(), order.end(), [this](const SceneBox* a, const SceneBox* b) {
    return nearness(*a) < nearness(*b);
  });
  std::string out;
  for (const SceneBox* item : order) out += polygon(*item);
  for (const SceneArm& arm : scene.arms) {
    const Eigen::Vector2d a = pixel(arm.from_W), b = pixel(arm.to_W);
    out += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#33567a\" "
        "stroke-width=\"4\" stroke-opacity=\"0.5\" stroke-linecap=\"round\"><title>{}</title>"
        "</line>\n",
        a.x(), a.y(), b.x(), b.y(), base::xml_escaped(arm.name));
  }
  return out;
}

std::string SceneView::floor() const {
  if (kind_ == ViewKind::kAbove) return {};
  const Eigen::Vector2d a = pixel({frame_.low.x(), 0.0, 0.0});
  const Eigen::Vector2d b = pixel({frame_.high.x(), 0.0, 0.0});
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#666\"/>\n", a.x(),
      a.y(), b.x(), b.y());
}

std::string SceneView::label(const std::string& text, const char* colour,
                             const std::vector<Eigen::Vector2d>& places) {
  const double width = text_width_px(text);
  std::vector<Label> boxes;
  for (const Eigen::Vector2d& place : places) {
    const double x = std::max(left_px_, std::min(place.x(), left_px_ + width_px() - width));
    const double y = std::clamp(place.y(), top_px_ + kFont_px, bottom_px() - 2.0);
    boxes.push_back({{x, y - kFont_px + 1.0}, {x + width, y + 2.0}});
  }
  const auto is_free = [this](const Label& box) {
    return std::none_of(labels_.begin(), labels_.end(), [&](const Label& other) {
      return (box.low.array() < other.high.array()).all() &&
             (other.low.array() < box.high.array()).all();
    });
  };
  const auto found = std::find_if(boxes.begin(), boxes.end(), is_free);
  const Label& box = found == boxes.end() ? boxes.front() : *found;
  labels_.push_back(box);
  return fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:g}\" fill=\"{}\" stroke=\"white\" "
      "stroke-width=\"2.5\" stroke-opacity=\"0.8\" paint-order=\"stroke\">{}</text>\n",
      box.low.x(), box.high.y() - 2.0, kFont_px, colour, base::xml_escaped(text));
}

std::string SceneView::regions(const RegionMap& regions) {
  std::string out;
  for (const Region& region : regions.regions()) {
    const auto &x = region.on(Axis::kX), &y = region.on(Axis::kY);
    if ((!x && !y) || !region.frame.empty()) continue;
    const Eigen::Vector2d a = pixel({x ? x->lower : frame_.low.x(), y ? y->upper : top(), 0.0});
    const Eigen::Vector2d b = pixel({x ? x->upper : frame_.high.x(), y ? y->lower : bottom(), 0.0});
    out += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
        "stroke=\"#2a7a3a\" stroke-dasharray=\"4 3\"/>\n",
        a.x(), a.y(), b.x() - a.x(), b.y() - a.y());
    out += label(region.name, kRegionColour,
                 {{a.x() + 2.0, a.y() + kFont_px},
                  {a.x() + 2.0, b.y() - 3.0},
                  {a.x() + 2.0, a.y() - 3.0},
                  {b.x() + 3.0, a.y() + kFont_px}});
  }
  return out;
}

std::string SceneView::item_names(const Scene& scene) {
  std::map<std::string, std::vector<Eigen::Vector2d>> corners;
  for (const SceneBox& item : scene.boxes) {
    if (item.kind != SceneKind::kItem) continue;
    const auto of_box = outline(item.box);
    auto& all = corners[item.body];
    all.insert(all.end(), of_box.begin(), of_box.end());
  }
  std::string out;
  for (const auto& [name, points] : corners) {
    Eigen::Vector2d low = points.front(), high = points.front();
    for (const Eigen::Vector2d& p : points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const double middle = 0.5 * (low.y() + high.y()) + 3.0;
    const double width = text_width_px(name);
    out += label(name, kItemColour,
                 {{high.x() + 3.0, middle},
                  {low.x() - width - 3.0, middle},
                  {low.x(), high.y() + kFont_px},
                  {low.x(), low.y() - 3.0},
                  {high.x() + 3.0, middle + kFont_px + 2.0},
                  {high.x() + 3.0, middle - kFont_px - 2.0}});
  }
  return out;
}

std::string SceneView::axes() const {
  constexpr double kLength_px = 22.0;
  const double x = left_px_ + 2.0, y = bottom_px() + kLength_px + 10.0;
  return fmt::format(
      "<path d=\"M{0:.1f} {2:.1f}V{1:.1f}H{3:.1f}\" fill=\"none\" stroke=\"#444\"/>\n"
      "<text x=\"{4:.1f}\" y=\"{5:.1f}\" font-size=\"10\" fill=\"#444\">x</text>\n"
      "<text x=\"{6:.1f}\" y=\"{7:.1f}\" font-size=\"10\" fill=\"#444\">{8}</text>\n",
      x, y, y - kLength_px, x + kLength_px, x + kLength_px + 4.0, y + 3.0, x + 4.0,
      y - kLength_px + 6.0, kind_ == ViewKind::kAbove ? 'y' : 'z');
}

}  // namespace parallax::harness
