#include "harness/engine/solid_boxes.h"

#include <Eigen/Geometry>

namespace parallax::harness {
namespace {

constexpr double kRounding_m = 1e-9;

Eigen::Matrix3d turn(double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

}  // namespace

bool SolidBox::contains(const Eigen::Vector3d& p_W) const {
  const Eigen::Vector3d p_S = turn(yaw_rad).transpose() * (p_W - p_WS);
  return (p_S.cwiseAbs().array() <= 0.5 * size_m.array() + kRounding_m).all();
}

bool SolidBox::contains(const SolidBox& other) const {
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                               (corner & 4) != 0 ? 0.5 : -0.5);
    const Eigen::Vector3d p_S = sign.cwiseProduct(other.size_m);
    if (!contains(Eigen::Vector3d(other.p_WS + turn(other.yaw_rad) * p_S))) return false;
  }
  return true;
}

std::vector<SolidBox> solid_boxes(const BodySpec& body) {
  std::vector<SolidBox> boxes;
  if (!body.collides) return boxes;
  for (const BoxShape& shape : body.shapes) {
    boxes.push_back(
        {shape.size_m, body.p_WB + turn(body.yaw_rad) * shape.p_BS, body.yaw_rad + shape.yaw_rad});
  }
  return boxes;
}

}  // namespace parallax::harness
