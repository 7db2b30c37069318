#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/geometry_proof/branch_and_bound.h"
#include "harness/geometry_proof/second_evaluation.h"

namespace parallax::harness {

/// One action of a trace as it is carried out.
struct ProofAction {
  std::string event;       // "Go(bTable)"
  std::string controller;  // "drive"
  State arguments;
};

/// One test of one action, ready to be decided.
class ActionTest {
 public:
  /// Everything that is referred to outlives the test.
  ActionTest(const WorldSpec& spec, const WorldLayout& layout, const StartCuboid& region,
             KnownState state)
      : state_(std::move(state)), scene_(spec, layout, region, state_) {}
  ActionTest(const ActionTest&) = delete;
  ActionTest& operator=(const ActionTest&) = delete;

  const KnownState& state() const { return state_; }
  const ProofScene& scene() const { return scene_; }
  const GeometricCheck& check() const { return *check_; }
  /// Adds an assumption of this test, in words.
  void assume(std::string what) { state_.assumed.push_back(std::move(what)); }
  const SecondEvaluation& second() const { return *second_; }
  void set(std::unique_ptr<GeometricCheck> check, std::unique_ptr<SecondEvaluation> second) {
    check_ = std::move(check);
    second_ = std::move(second);
  }

 private:
  KnownState state_;
  ProofScene scene_;
  std::unique_ptr<GeometricCheck> check_;
  std::unique_ptr<SecondEvaluation> second_;
};

/// An action of a trace: tests of its controller that are pure geometry given the start, or why
/// there are none.
struct ProvableAction {
  std::size_t number = 0;  // of the event, from 0
  std::string event, controller;
  std::vector<std::unique_ptr<ActionTest>> tests;
  std::string left_to_simulation;  // why; empty if there are tests
};

/// The actions of a trace from `region`, in order. What is proved of an action holds if those
/// before it succeed: KnownState::assumed says how far that is used. `spec` and `layout` outlive
/// the result.
std::vector<ProvableAction> provable_actions(const WorldSpec& spec, const WorldLayout& layout,
                                             const StartCuboid& region,
                                             const std::vector<ProofAction>& actions,
                                             const ProofAssumptions& assumptions);

}  // namespace parallax::harness
