#pragma once

#include <string>
#include <string_view>

#include "harness/recording/recording.h"

namespace parallax::harness {

/// `time,body,x,y,z,qw,qx,qy,qz,event` (RFC 4180): a row for each body that moved in a frame, all
/// of them at first, and one for each beginning, end and grip, with `event` alone. Sorted by time.
std::string csv_of(const Recording& recording);

/// The bodies as foxglove.SceneUpdate on /scene, their motion as foxglove.FrameTransforms on /tf,
/// events and grips as foxglove.Log on /events, and observed variables as JSON on /observations.
/// Simulated time, from 0.
std::string mcap_of(const Recording& recording);

/// Whether a file that begins like this is an earlier one of these exports.
bool is_motion_csv(std::string_view head);
bool is_motion_mcap(std::string_view head);

}  // namespace parallax::harness
