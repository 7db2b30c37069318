#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/draw/scene.h"

namespace parallax::harness {

/// Adds the places of the base, the hands, drawers and items as the next points of their tracks.
/// All scenes are of one world. A robot without arms has one hand, in the middle of its pads.
void extend_tracks(const Scene& scene, const std::string& base, std::vector<SceneTrack>& tracks);

double length_m(const SceneTrack& track);

/// Without the points that lie nearer than `tolerance_m` to the line through those that stay
/// (Douglas and Peucker 1973). O(n^2) at worst.
std::vector<Eigen::Vector3d> simplified(const std::vector<Eigen::Vector3d>& points,
                                        double tolerance_m);

/// Index of the moment, one for each point, at which the drawer or item of the longest way had done
/// half of it; of the longest hand's way where none has moved by more than `moved_m`. Nothing where
/// no hand has, either.
std::optional<std::size_t> half_way(const std::vector<SceneTrack>& tracks, double moved_m);

/// The boxes of `scene` that in `later` are farther away than `moved_m`, with the arms that are.
Scene elsewhere(const Scene& scene, const Scene& later, double moved_m);

}  // namespace parallax::harness
