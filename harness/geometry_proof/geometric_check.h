#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/geometry_proof/proof_scene.h"

namespace parallax::harness {

/// The verdict on a box of starts: the check passes everywhere in it, refuses everywhere in it, or
/// is undecided.
enum class BoxVerdict : std::uint8_t { kSafe, kRefuted, kOpen };
std::string_view to_string(BoxVerdict verdict);  // "safe", "refuted", "open"

/// How far the engine may take shapes to be nearer or farther than they are: it widens edges by a
/// millionth of their length, and rounds.
inline constexpr double kEngineRoom_m = 1e-5;

/// The subject of a proof: one test of a controller.
struct CheckedTest {
  std::string controller;  // "drive"
  std::string function;    // "Drive::is_blocked"
  std::string source;      // "harness/robot/mobile_drive.cc"
  std::string refusal;     // beginning of the controller's reason
  std::string statement;   // the question, in words
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
    /// Do the open questions lack knowledge, not smaller boxes? Then they will not be decided
    /// anywhere in this one.
    bool is_hopeless = false;
    std::string culprit = {};  // "`base` would meet `drawer_mid`"

    /// A question passes where `margin` is positive and is refused where it is negative, but for
    /// `room`. False: it is refused everywhere, and so is the box.
    bool settle(std::uint32_t question, const AffineForm& margin, double room,
                const std::string& refused_as);
  };
  virtual Finding examine(std::span<const Bounds1> box,
                          std::span<const std::uint32_t> questions) const = 0;
};

/// Questions of one box that are open because shapes come near to each other, by the room between
/// them: the least room says what is to be halved.
class OpenRooms {
 public:
  /// `finding` outlives it.
  explicit OpenRooms(GeometricCheck::Finding& finding) : finding_(finding) {}
  /// Is it the least so far? `may_be_hit`: a room below zero would be a refusal.
  bool add(const AffineForm& room, bool may_be_hit);
  /// The verdict, if there is no open question; else what sways it, and whether boxes can help.
  void close();

 private:
  GeometricCheck::Finding& finding_;
  std::optional<AffineForm> least_;
  bool any_blurred_ = false, any_may_refute_ = false;
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
