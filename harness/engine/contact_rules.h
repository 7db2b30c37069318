#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/engine/physics_world.h"

namespace parallax::harness {

/// The role of a shape for the bodies that touch it. kPart: part of the robot.
enum class ShapeRole : std::uint8_t { kWorld, kFree, kNearPad, kFarPad, kPart };

/// The properties of a body, or of the floor, that contacts depend on.
struct ContactSide {
  std::optional<BodyId> body;  // none: the floor
  std::uint32_t assembly = 0;
  std::vector<std::uint32_t> apart{};  // WorldLayout::apart_of
  std::uint32_t material = 0;
  ShapeRole role = ShapeRole::kWorld;
  std::uint32_t gripper = 0;  // of a pad
};

/// Who collides with whom, how rough a pair is, and what a touch says; the same for every engine.
class ContactRules {
 public:
  ContactRules(const WorldSpec& spec, const WorldLayout& layout);

  const ContactSide& floor() const { return floor_; }
  const ContactSide& of(BodyId id) const { return sides_[id.index()]; }
  double friction(const ContactSide& a, const ContactSide& b) const {
    return friction_[a.material * material_count_ + b.material];
  }
  static bool never_collide(const ContactSide& a, const ContactSide& b) {
    return (a.assembly != 0 && a.assembly == b.assembly) || share_word(a.apart, b.apart);
  }
  bool is_robot(const ContactSide& side) const {
    return robot_assembly_ != 0 && side.assembly == robot_assembly_;
  }
  /// Records the touch of two bodies in contact.
  static void note(const ContactSide& a, const ContactSide& b, std::vector<Touch>& touches);

 private:
  ContactSide floor_;
  std::vector<ContactSide> sides_;  // by BodyId
  std::uint32_t material_count_ = 0;
  std::vector<double> friction_;      // (material_count x material_count)
  std::uint32_t robot_assembly_ = 0;  // 0: no robot
};

/// The name of the body, or "floor".
std::string name_of(const WorldLayout& layout, const ContactSide& side);

/// The overlap of two of them, by sorted names.
Overlap overlap_of(const WorldLayout& layout, const ContactSide& a, const ContactSide& b,
                   double depth_m);

}  // namespace parallax::harness
