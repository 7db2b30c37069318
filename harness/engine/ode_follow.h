#pragma once

#include <Eigen/Core>
#include <vector>

#include "harness/engine/ode_engine.h"

namespace parallax::harness {

/// The joints of a world that follow others, and the forces that keep them at it.
class Followers {
 public:
  /// The joints of the engine are there, its bodies where they are by default.
  explicit Followers(OdeWorld::Engine& engine);

  bool any() const { return !pairs_.empty(); }
  void reset();
  /// Call it before a step is solved for the first time.
  void begin_step();
  /// Adds the forces of the couplings. Call it before each solution of the step.
  void push();
  /// Corrects the forces by what a solution came to. Returns whether the step has to be solved
  /// again with them.
  bool correct();

 private:
  struct Moved {
    dxJoint* joint = nullptr;
    bool slides = true;
    HingeId hinge;  // means nothing where it slides
  };
  struct Pair {
    Moved leader, follower;
    double ratio = 1.0;
    double inertia = 1.0;      // that the force of the coupling moves, about [kg or kg m^2]
    double wanted_rate = 0.0;  // of the follower beyond that of its leader, to make up for an error
  };

  Moved moved(const std::string& name, double& inertia) const;
  double position(const Moved& moved) const;
  static double rate(const Moved& moved);
  static void add_force(const Moved& moved, double force);
  void forget_compliance();

  OdeWorld::Engine& engine_;
  std::vector<Pair> pairs_;
  Eigen::VectorXd forces_, forces_before_, lags_before_;  // by pair
  Eigen::MatrixXd force_for_lag_;                         // (pair x pair)
  int round_ = 0;
};

}  // namespace parallax::harness
