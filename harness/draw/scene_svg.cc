#include "harness/draw/scene_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace parallax::harness {
namespace {

constexpr double kMargin_m = 0.1;
constexpr double kGap_px = 30.0;   // between the views
constexpr double kHead_px = 64.0;  // for the title

struct Colour {
  const char* fill;
  const char* line;
  double opacity;
};

Colour colour_of(SceneKind kind) {
  switch (kind) {
    case SceneKind::kFurniture:
      return {"#e8e2d8", "#8c8272", 1.0};
    case SceneKind::kDrawer:
      return {"#d9b98a", "#7a5a2a", 0.85};
    case SceneKind::kRobot:
      return {"#9fbbd8", "#33567a", 0.75};
    case SceneKind::kGripper:
      return {"#4d7299", "#1d3550", 1.0};
    case SceneKind::kItem:
      return {"#d8604c", "#7c2517", 1.0};
  }
  return {"#ffffff", "#000000", 1.0};
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '"') {
      out += "&quot;";
    } else {
      out += c;
    }
  }
  return out;
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

/// One of the two views: which axes lie in the picture, and what is nearer.
class View {
 public:
  View(const SceneFrame& frame, bool from_above, double left_px, double scale)
      : frame_(frame), from_above_(from_above), left_px_(left_px), scale_(scale) {}

  double width_px() const { return scale_ * (frame_.high.x() - frame_.low.x()); }
  double height_px() const { return scale_ * (top() - bottom()); }

  Eigen::Vector2d pixel(const Eigen::Vector3d& p) const {
    const double up = from_above_ ? p.y() : p.z();
    return {left_px_ + scale_ * (p.x() - frame_.low.x()), kHead_px + scale_ * (top() - up)};
  }
  double nearness(const SceneBox& item) const {
    const Eigen::Vector3d half = 0.5 * item.box.R_WS.cwiseAbs() * item.box.size_m;
    return from_above_ ? item.box.p_WS.z() + half.z() : -(item.box.p_WS.y() - half.y());
  }

  std::string polygon(const SceneBox& item) const {
    std::vector<Eigen::Vector2d> corners;
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d sign(i % 2 == 0 ? 0.5 : -0.5, i / 2 % 2 == 0 ? 0.5 : -0.5,
                                 i / 4 == 0 ? 0.5 : -0.5);
      corners.push_back(pixel(item.box.p_WS + item.box.R_WS * sign.cwiseProduct(item.box.size_m)));
    }
    std::string points;
    for (const Eigen::Vector2d& p : hull(corners)) {
      points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", p.x(), p.y());
    }
    const Colour colour = colour_of(item.kind);
    return fmt::format(
        "<polygon points=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1\" "
        "fill-opacity=\"{}\"><title>{}</title></polygon>\n",
        points, colour.fill, colour.line, colour.opacity, escaped(item.body));
  }

  std::string boxes(const Scene& scene) const {
    std::vector<const SceneBox*> order;
    for (const SceneBox& item : scene.boxes) order.push_back(&item);
    std::stable_sort(order.begin(), order.end(), [this](const SceneBox* a, const SceneBox* b) {
      return nearness(*a) < nearness(*b);
    });
    std::string out;
    for (const SceneBox* item : order) out += polygon(*item);
    return out;
  }

 private:
  double top() const { return from_above_ ? frame_.high.y() : frame_.high.z(); }
  double bottom() const { return from_above_ ? frame_.low.y() : frame_.low.z(); }

  SceneFrame frame_;
  bool from_above_;
  double left_px_, scale_;
};

std::string region_outlines(const RegionMap& regions, const View& view) {
  std::string out;
  for (const Region& region : regions.regions()) {
    const auto &x = region.on(Axis::kX), &y = region.on(Axis::kY);
    if (!x || !y || !region.frame.empty()) continue;
    const Eigen::Vector2d a = view.pixel({x->lower, y->upper, 0.0});
    const Eigen::Vector2d b = view.pixel({x->upper, y->lower, 0.0});
    out += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
        "stroke=\"#2a7a3a\" stroke-dasharray=\"4 3\"/>\n",
        a.x(), a.y(), b.x() - a.x(), b.y() - a.y());
    out +=
        fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"10\" fill=\"#2a7a3a\">{}</text>\n",
                    a.x() + 2.0, a.y() - 3.0, escaped(region.name));
  }
  return out;
}

}  // namespace

SceneFrame frame_around(const Scene& scene) {
  SceneFrame frame;
  for (const SceneBox& item : scene.boxes) {
    const Eigen::Vector3d half = 0.5 * item.box.R_WS.cwiseAbs() * item.box.size_m;
    frame.low = frame.low.cwiseMin(item.box.p_WS - half);
    frame.high = frame.high.cwiseMax(item.box.p_WS + half);
  }
  frame.low -= kMargin_m * Eigen::Vector3d::Ones();
  frame.high += kMargin_m * Eigen::Vector3d::Ones();
  return frame;
}

std::string scene_svg(const Scene& scene, const SceneFrame& frame, const SvgOptions& options) {
  const View above(frame, true, kGap_px, options.pixels_per_m);
  const View side(frame, false, 2.0 * kGap_px + above.width_px(), options.pixels_per_m);
  const double width = 3.0 * kGap_px + 2.0 * above.width_px();
  const double height = kHead_px + kGap_px + std::max(above.height_px(), side.height_px());
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\" "
      "font-family=\"sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      width, height);
  out += fmt::format("<text x=\"{:.0f}\" y=\"24\" font-size=\"16\">{}</text>\n", kGap_px,
                     escaped(options.title));
  out += fmt::format("<text x=\"{:.0f}\" y=\"44\" font-size=\"12\" fill=\"#444\">{}</text>\n",
                     kGap_px, escaped(options.subtitle));
  out += above.boxes(scene);
  if (options.regions != nullptr) out += region_outlines(*options.regions, above);
  const Eigen::Vector2d a = side.pixel({frame.low.x(), 0.0, 0.0});
  const Eigen::Vector2d b = side.pixel({frame.high.x(), 0.0, 0.0});
  out += fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" "
      "stroke=\"#666\"/>\n",
      a.x(), a.y(), b.x(), b.y());
  out += side.boxes(scene);
  return out + "</svg>\n";
}

}  // namespace parallax::harness
