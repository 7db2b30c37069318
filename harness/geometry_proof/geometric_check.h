#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/geometry_proof/proof_scene.h"

namespace parallax::harness {

/// Of a box of starts: the check passes everywhere in it, refuses everywhere in it, or either.
enum class BoxVerdict : std::uint8_t { kSafe, kRefuted, kOpen };
std::string_view to_string(BoxVerdict verdict);  // "safe", "refuted", "open"

/// How far the engine may take shapes to be nearer or farther than they are: it widens edges by a
/// millionth of their length, and rounds.
inline constexpr double kEngineRoom_m = 1e-5;

/// What a proof is about: one test of a controller.
struct CheckedTest {
  std::string controller;  // "drive"
  std::string function;    // "Drive::is_blocked"
  std::string source;      // "harness/robot/mobile_drive.cc"
  std::string refusal;     // what the controller's reason begins with
  std::string statement;   // what it asks, in words
  bool is_at_once = true;  // asked before the action takes any time
};

/// A test of a controller as a function of the start, decided for whole boxes.
class GeometricCheck {
 public:
  virtual ~GeometricCheck() = default;
  virtual const CheckedTest& test() const = 0;

  /// Parts of the question that are decided one by one: what is clear in a box is clear in all
  /// boxes within it.
  virtual std::vector<std::uint32_t> questions() const = 0;

  struct Finding {
    BoxVerdict verdict = BoxVerdict::kOpen;
    std::vector<std::uint32_t> open = {};  // questions that are left
    std::vector<double> influence = {};    // of each variable on what is open
    /// What is open is so for want of knowledge, not of boxes: it will not be decided anywhere in
    /// this one.
    bool is_hopeless = false;
    std::string culprit = {};  // "`base` would meet `drawer_mid`"
  };
  virtual Finding examine(std::span<const Bounds1> box,
                          std::span<const std::uint32_t> questions) const = 0;
};

/// `Drive::is_blocked`: everything that moves swept along the straight way and turned at the goal.
/// `scene` outlives the check and knows of all bodies; `target` as target_of says.
std::unique_ptr<GeometricCheck> make_drive_check(const ProofScene& scene, const KnownPoint& target,
                                                 double yaw_rad, double sweep_step_m);

/// `require_reach` of points that stay where they are; `test` says of what.
std::unique_ptr<GeometricCheck> make_reach_check(const ProofScene& scene, CheckedTest test,
                                                 std::size_t arm, std::vector<KnownPoint> points);

/// `Perception::look_at`.
std::unique_ptr<GeometricCheck> make_gaze_check(const ProofScene& scene, const KnownPoint& place);

}  // namespace parallax::harness
