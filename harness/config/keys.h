#pragma once

// Only harness/config/*.cc include this header.

#include <string>
#include <string_view>

namespace parallax::harness {

/// Every key of scenario files and suite manifests (docs/scenario_format.md, docs/suite_format.md),
/// written here alone: what reads a key, what refuses others and what speaks of it in a message say
/// the same word, and a misspelt one does not compile. Region axes are keys under their own names
/// (`to_string`).
struct Key {
  static constexpr std::string_view kAbove = "above";
  static constexpr std::string_view kActTimeoutS = "act_timeout_s";
  static constexpr std::string_view kActions = "actions";
  static constexpr std::string_view kApproach = "approach";
  static constexpr std::string_view kArms = "arms";
  static constexpr std::string_view kAtM = "at_m";
  static constexpr std::string_view kAtStart = "at_start";
  static constexpr std::string_view kAxis = "axis";
  static constexpr std::string_view kBase = "base";
  static constexpr std::string_view kBaseBody = "base_body";
  static constexpr std::string_view kBaseJoint = "base_joint";
  static constexpr std::string_view kBetween = "between";
  static constexpr std::string_view kBiasM = "bias_m";
  static constexpr std::string_view kBiasRad = "bias_rad";
  static constexpr std::string_view kBind = "bind";
  static constexpr std::string_view kBodies = "bodies";
  static constexpr std::string_view kBody = "body";
  static constexpr std::string_view kBonferroni = "bonferroni";
  static constexpr std::string_view kCamera = "camera";
  static constexpr std::string_view kCarryM = "carry_m";
  static constexpr std::string_view kCases = "cases";
  static constexpr std::string_view kCells = "cells";
  static constexpr std::string_view kCfm = "cfm";
  static constexpr std::string_view kChild = "child";
  static constexpr std::string_view kCloseTimeoutS = "close_timeout_s";
  static constexpr std::string_view kCollides = "collides";
  static constexpr std::string_view kCommand = "command";
  static constexpr std::string_view kCompare = "compare";
  static constexpr std::string_view kExecution = "execution";
  static constexpr std::string_view kStarts = "starts";
  static constexpr std::string_view kStartWeights = "start_weights";
  static constexpr std::string_view kUntilCovered = "until_covered";
  static constexpr std::string_view kWhen = "when";
  static constexpr std::string_view kWeight = "weight";
  static constexpr std::string_view kComplete = "complete";
  static constexpr std::string_view kConfidence = "confidence";
  static constexpr std::string_view kConfusionRate = "confusion_rate";
  static constexpr std::string_view kConstraints = "constraints";
  static constexpr std::string_view kContactCfm = "contact_cfm";
  static constexpr std::string_view kContactErp = "contact_erp";
  static constexpr std::string_view kController = "controller";
  static constexpr std::string_view kCriterion = "criterion";
  static constexpr std::string_view kDefault = "default";
  static constexpr std::string_view kDefaults = "defaults";
  static constexpr std::string_view kDetection = "detection";
  static constexpr std::string_view kDiameterM = "diameter_m";
  static constexpr std::string_view kDrawn = "drawn";
  static constexpr std::string_view kEffortN = "effort_n";
  static constexpr std::string_view kEpsilon = "epsilon";
  static constexpr std::string_view kEquals = "equals";
  static constexpr std::string_view kErp = "erp";
  static constexpr std::string_view kEvents = "events";
  static constexpr std::string_view kExemptInherited = "exempt_inherited";
  static constexpr std::string_view kExpect = "expect";
  static constexpr std::string_view kExtraRuns = "extra_runs";
  static constexpr std::string_view kFails = "fails";
  static constexpr std::string_view kFarPadBody = "far_pad_body";
  static constexpr std::string_view kFast = "fast";
  static constexpr std::string_view kFingerJoint = "finger_joint";
  static constexpr std::string_view kFlag = "flag";
  static constexpr std::string_view kFloorMaterial = "floor_material";
  static constexpr std::string_view kFluents = "fluents";
  static constexpr std::string_view kFor = "for";
  static constexpr std::string_view kFrame = "frame";
  static constexpr std::string_view kFriction = "friction";
  static constexpr std::string_view kFromPlan = "from_plan";
  static constexpr std::string_view kGaps = "gaps";
  static constexpr std::string_view kGolden = "golden";
  static constexpr std::string_view kGrasp = "grasp";
  static constexpr std::string_view kGravity = "gravity";
  static constexpr std::string_view kGripForceN = "grip_force_n";
  static constexpr std::string_view kHalfAngleRad = "half_angle_rad";
  static constexpr std::string_view kHandle = "handle";
  static constexpr std::string_view kHeightM = "height_m";
  static constexpr std::string_view kHeldAfterS = "held_after_s";
  static constexpr std::string_view kHeldClearanceM = "held_clearance_m";
  static constexpr std::string_view kHelloTimeoutS = "hello_timeout_s";
  static constexpr std::string_view kHolds = "holds";
  static constexpr std::string_view kHorizon = "horizon";
  static constexpr std::string_view kId = "id";
  static constexpr std::string_view kIgnored = "ignored";
  static constexpr std::string_view kInclude = "include";
  static constexpr std::string_view kInsetM = "inset_m";
  static constexpr std::string_view kInside = "inside";
  static constexpr std::string_view kIntercept = "intercept";
  static constexpr std::string_view kInterval = "interval";
  static constexpr std::string_view kIterations = "iterations";
  static constexpr std::string_view kJoint = "joint";
  static constexpr std::string_view kJoints = "joints";
  static constexpr std::string_view kKind = "kind";
  static constexpr std::string_view kLiftJoint = "lift_joint";
  static constexpr std::string_view kLimits = "limits";
  static constexpr std::string_view kMapping = "mapping";
  static constexpr std::string_view kMassKg = "mass_kg";
  static constexpr std::string_view kMatch = "match";
  static constexpr std::string_view kMaterial = "material";
  static constexpr std::string_view kMaxContactsPerPair = "max_contacts_per_pair";
  static constexpr std::string_view kMaxCorrectingVelocityMS = "max_correcting_velocity_m_s";
  static constexpr std::string_view kMaxForceN = "max_force_n";
  static constexpr std::string_view kMaxLostInARow = "max_lost_in_a_row";
  static constexpr std::string_view kMaxPanRad = "max_pan_rad";
  static constexpr std::string_view kMaxRejectedStarts = "max_rejected_starts";
  static constexpr std::string_view kMaxRuns = "max_runs";
  static constexpr std::string_view kMaxSimulations = "max_simulations";
  static constexpr std::string_view kMaxTorqueNm = "max_torque_nm";
  static constexpr std::string_view kMaxTraces = "max_traces";
  static constexpr std::string_view kMaxPerforms = "max_performs";
  static constexpr std::string_view kMaxSimulatedS = "max_simulated_s";
  static constexpr std::string_view kMemoryMb = "memory_mb";
  static constexpr std::string_view kMinRealTimeFactor = "min_real_time_factor";
  static constexpr std::string_view kMissRate = "miss_rate";
  static constexpr std::string_view kModel = "model";
  static constexpr std::string_view kName = "name";
  static constexpr std::string_view kNearPadBody = "near_pad_body";
  static constexpr std::string_view kNoiseM = "noise_m";
  static constexpr std::string_view kNoiseRad = "noise_rad";
  static constexpr std::string_view kObserveTimeoutS = "observe_timeout_s";
  static constexpr std::string_view kOnly = "only";
  static constexpr std::string_view kOnlyIf = "only_if";
  static constexpr std::string_view kOpeningM = "opening_m";
  static constexpr std::string_view kPalmBody = "palm_body";
  static constexpr std::string_view kParent = "parent";
  static constexpr std::string_view kPlaces = "places";
  static constexpr std::string_view kPlan = "plan";
  static constexpr std::string_view kPositionM = "position_m";
  static constexpr std::string_view kPreset = "preset";
  static constexpr std::string_view kRange = "range";
  static constexpr std::string_view kRangeM = "range_m";
  static constexpr std::string_view kRate = "rate";
  static constexpr std::string_view kReachJoint = "reach_joint";
  static constexpr std::string_view kReachM = "reach_m";
  static constexpr std::string_view kRecycleAfter = "recycle_after";
  static constexpr std::string_view kRegions = "regions";
  static constexpr std::string_view kReliefAmplitudeM = "relief_amplitude_m";
  static constexpr std::string_view kReliefWavelengthM = "relief_wavelength_m";
  static constexpr std::string_view kResetTimeoutS = "reset_timeout_s";
  static constexpr std::string_view kRing = "ring";
  static constexpr std::string_view kRobot = "robot";
  static constexpr std::string_view kRoot = "root";
  static constexpr std::string_view kRuns = "runs";
  static constexpr std::string_view kSampling = "sampling";
  static constexpr std::string_view kSets = "sets";
  static constexpr std::string_view kSettable = "settable";
  static constexpr std::string_view kShapes = "shapes";
  static constexpr std::string_view kShoulderM = "shoulder_m";
  static constexpr std::string_view kSides = "sides";
  static constexpr std::string_view kSigma = "sigma";
  static constexpr std::string_view kSimulator = "simulator";
  static constexpr std::string_view kSizeM = "size_m";
  static constexpr std::string_view kSleepAfterS = "sleep_after_s";
  static constexpr std::string_view kSleepAngularRadS = "sleep_angular_rad_s";
  static constexpr std::string_view kSleepLinearMS = "sleep_linear_m_s";
  static constexpr std::string_view kSolver = "solver";
  static constexpr std::string_view kStart = "start";
  static constexpr std::string_view kStartPenetrationM = "start_penetration_m";
  static constexpr std::string_view kSurfaceLayerM = "surface_layer_m";
  static constexpr std::string_view kText = "text";
  static constexpr std::string_view kTiltRad = "tilt_rad";
  static constexpr std::string_view kTimeLimitS = "time_limit_s";
  static constexpr std::string_view kTimeS = "time_s";
  static constexpr std::string_view kTimestepS = "timestep_s";
  static constexpr std::string_view kToleranceM = "tolerance_m";
  static constexpr std::string_view kTorso = "torso";
  static constexpr std::string_view kTrace = "trace";
  static constexpr std::string_view kTraces = "traces";
  static constexpr std::string_view kType = "type";
  static constexpr std::string_view kUnless = "unless";
  static constexpr std::string_view kUpTo = "up_to";
  static constexpr std::string_view kUpright = "upright";
  static constexpr std::string_view kUprightExcept = "upright_except";
  static constexpr std::string_view kUnobserved = "unobserved";
  static constexpr std::string_view kVariables = "variables";
  static constexpr std::string_view kVerdict = "verdict";
  static constexpr std::string_view kWallM = "wall_m";
  static constexpr std::string_view kWidthM = "width_m";
  static constexpr std::string_view kWorld = "world";
  static constexpr std::string_view kWristRad = "wrist_rad";
  static constexpr std::string_view kYawRad = "yaw_rad";
};

/// A key as messages show it: "`frame`".
inline std::string key_text(std::string_view key) { return '`' + std::string(key) + '`'; }

}  // namespace parallax::harness
