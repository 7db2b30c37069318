#include "harness/draw/projection.h"

#include <fmt/format.h>

#include <algorithm>

namespace parallax::harness {

Rectangle around(const std::vector<Eigen::Vector2d>& points) {
  Rectangle out;
  if (!points.empty()) out = {points.front(), points.front()};
  for (const Eigen::Vector2d& p : points) out = {out.low.cwiseMin(p), out.high.cwiseMax(p)};
  return out;
}

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

std::vector<Eigen::Vector2d> closed(std::vector<Eigen::Vector2d> points) {
  if (!points.empty()) points.push_back(points.front());
  return points;
}

std::string point_list(const std::vector<Eigen::Vector2d>& points) {
  std::string out;
  for (const Eigen::Vector2d& p : points) {
    out += fmt::format("{}{:.1f},{:.1f}", out.empty() ? "" : " ", p.x(), p.y());
  }
  return out;
}

Eigen::Vector2d Projection::pixel(const Eigen::Vector3d& p_W) const {
  const double right = std::clamp(p_W.x(), frame_.low.x(), frame_.high.x());
  const double up = std::clamp(kind_ == ViewKind::kAbove ? p_W.y() : p_W.z(), bottom_m(), top_m());
  return {left_px_ + px_per_m_ * (right - frame_.low.x()), top_px_ + px_per_m_ * (top_m() - up)};
}

std::vector<Eigen::Vector2d> Projection::pixels(
    const std::vector<Eigen::Vector3d>& points_W) const {
  std::vector<Eigen::Vector2d> out;
  out.reserve(points_W.size());
  for (const Eigen::Vector3d& p : points_W) out.push_back(pixel(p));
  return out;
}

std::vector<Eigen::Vector2d> Projection::outline(const Probe& box) const {
  std::vector<Eigen::Vector2d> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d sign(i % 2 == 0 ? 0.5 : -0.5, i / 2 % 2 == 0 ? 0.5 : -0.5,
                               i / 4 == 0 ? 0.5 : -0.5);
    corners.push_back(pixel(box.p_WS + box.R_WS * sign.cwiseProduct(box.size_m)));
  }
  return hull(corners);
}

double Projection::nearness(const Probe& box) const {
  const Eigen::Vector3d half = 0.5 * box.R_WS.cwiseAbs() * box.size_m;
  return kind_ == ViewKind::kAbove ? box.p_WS.z() + half.z() : half.y() - box.p_WS.y();
}

}  // namespace parallax::harness
