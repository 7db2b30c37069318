#pragma once

#include <string>
#include <vector>

#include "harness/kinematics/serial_chain.h"
#include "harness/world/structure_check.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {

/// The joints of an arm, and what hangs on them, at the default placement. The frame R of the chain
/// is that of the body which the first joint hangs on; the axes of the tool are the palm's.
struct ChainArm {
  SerialChain chain;
  BodyId root, palm;
  std::vector<int> hangs_on;      // by body: the last joint of the chain that moves it; -1: none
  std::vector<ChainMass> masses;  // by joint
  std::vector<double> strengths;  // by joint: what its motor gives [Nm or N]
};

/// `arm` must pass check_chain.
ChainArm chain_arm(const WorldSpec& spec, const WorldLayout& layout, const ArmSpec& arm);

/// Checks the chain of an arm: joints that do not hang on each other, motors that could not hold it
/// as it is placed, a `carry_m` that it cannot bring its tool to. Bodies, joints and the other
/// parts of the arm must be right.
void check_chain(const WorldSpec& spec, const WorldLayout& layout, const ArmSpec& arm,
                 ProblemList& problems);

/// Summarizes which arms are kinematic chains and which are gantries, and whether the base is held
/// upright: "left: chain of 6 joints, right: palm on a gantry, base on springs". Empty without a
/// mobile robot.
std::string arms_text(const WorldSpec& spec);

/// Fills in what follows from the chains of arms: shoulders (a point of the first joint's axis),
/// reaches (the most that the joints could give, were they stretched), and, where none is given
/// (NaN), the place where the tool is carried: where the world has it by default.
/// Does nothing for chains whose joints or bodies are not there.
void complete_chains(WorldSpec& spec);

}  // namespace parallax::harness
