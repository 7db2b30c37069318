#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "harness/import/description.h"
#include "harness/import/mjcf_model.h"

namespace parallax::harness {

/// A link of `links`, as far as it matters what it collides with.
struct MjcfSide {
  std::size_t link = 0;
  std::uint32_t body = 0;                                    // of the model
  std::vector<std::pair<std::int32_t, std::int32_t>> masks;  // of its shapes: type, affinity
};

/// Says by LinkDescription::apart which links MuJoCo keeps apart, as far as such words can: those
/// that are excluded, or that no bits bring together. What is left of it is added to `left_out`, as
/// are collisions of parts that hang together by joints, which our engines leave out.
void set_apart(const MjcfModel& model, const std::vector<MjcfSide>& sides,
               const std::vector<MjcfSide>& floor, std::vector<LinkDescription>& links,
               LeftOutList& left_out);

}  // namespace parallax::harness
