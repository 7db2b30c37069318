#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "harness/world/structure_check.h"

namespace parallax::harness {

/// Everything wrong with `spec`: its structure, and then what cannot work whatever the start, which
/// takes building it. Empty: make_world takes it.
std::vector<WorldProblem> check_world(const WorldSpec& spec);

/// Bodies that overlap, or reach into the floor, whatever start is drawn; furniture that stands
/// where other furniture is. The rest of `spec` is right.
void check_overlaps(const WorldSpec& spec, ProblemList& problems);

struct NamedPoint {
  std::string name;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  // [m]
};

/// Which points nothing but the robot and free bodies touches: what is put there falls. `spec` must
/// pass check_world.
std::vector<std::string> unsupported_points(const WorldSpec& spec,
                                            const std::vector<NamedPoint>& points);

/// A part of the world in which the lowest point of a body is to come to rest [m].
struct NamedBox {
  std::string name;
  Eigen::Vector3d low_W = Eigen::Vector3d::Zero(), high_W = Eigen::Vector3d::Zero();
};

/// The names of the boxes in which nothing can ever come to rest: they hold no part of a body that
/// is not free, however far the drawers are pulled out, and are too high for a stack of all free
/// bodies on the floor. `spec` must pass check_world.
std::vector<std::string> boxes_without_support(const WorldSpec& spec,
                                               const std::vector<NamedBox>& boxes);

/// A box that lies so deep in something fixed that the lowest point of no body can be in it.
struct BuriedBox {
  std::string name, body;
};
/// Only those that one box of a body swallows are found.
std::vector<BuriedBox> buried_boxes(const WorldSpec& spec, const std::vector<NamedBox>& boxes);

}  // namespace parallax::harness
