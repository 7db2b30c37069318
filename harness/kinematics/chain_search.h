#pragma once

#include <functional>
#include <vector>

#include "harness/kinematics/chain_way.h"

namespace parallax::harness {

struct ChainSearchOptions {
  double step = 0.05;  // between postures that are asked about [rad or m]
  double grow = 0.4;   // of a tree at a time
  int rounds = 400;    // after which it is given up
};

/// May the joints be there?
using PostureTest = std::function<bool(const JointVector&)>;

/// Postures from `start` to `goal`, both included, between which all joints may swing evenly: two
/// trees grow towards each other through places that are spread evenly over the ranges, always the
/// same ones (RRT-Connect, Kuffner and LaValle 2000); corners that can be cut are. Empty: none was
/// found. Cost: a test for each step of each branch, up to some ten thousand.
std::vector<JointVector> search_swings(const SerialChain& chain, const JointVector& start,
                                       const JointVector& goal, const PostureTest& test,
                                       const ChainSearchOptions& options = {});

}  // namespace parallax::harness
