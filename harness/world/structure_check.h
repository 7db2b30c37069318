#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "harness/world/world_spec.h"

namespace parallax::harness {

inline constexpr double kMaxMass_kg = 1e6;      // what is heavier is a slip of the pen
inline constexpr double kMaxExtent_m = 1000.0;  // likewise of sizes and places

/// One thing wrong with a WorldSpec. `path` leads to it, names instead of indices:
/// "bodies/box/mass_kg", "joints/lift/parent", "robot/base_joint", "solver/timestep_s".
struct WorldProblem {
  std::string path;
  std::string message;     // "no body `palmm`"
  std::string suggestion;  // a name that exists, or empty
};

/// The problems that checks find, in the order in which they find them.
class ProblemList {
 public:
  ProblemList() = default;
  explicit ProblemList(std::vector<WorldProblem> found) : found_(std::move(found)) {}

  bool empty() const { return found_.empty(); }
  std::size_t size() const { return found_.size(); }
  std::vector<WorldProblem> take() { return std::move(found_); }

  void add(std::string path, std::string message, std::string suggestion = {});
  void require(bool good, const std::string& path, const char* message);
  void require_positive(const std::string& path, double value);
  void require_not_negative(const std::string& path, double value);
  /// `name` must be one of `names`; `kind` is what they name: "body".
  void require_name(const std::string& path, const std::vector<std::string>& names,
                    const std::string& kind, const std::string& name);

 private:
  std::vector<WorldProblem> found_;
};

/// The names of bodies, joints or places.
template <typename List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  for (const auto& item : list) names.push_back(item.name);
  return names;
}

/// Checks the parts of `spec` and how they hang together, and returns the problems in this order:
/// all that can be found without building it. Empty: `lay_out` takes it.
std::vector<WorldProblem> check_structure(const WorldSpec& spec);

/// Checks the roles of the parts of the robot on a line, or of the mobile one, if there is one.
/// Bodies and joints must be right.
void check_line_robot(const WorldSpec& spec, ProblemList& problems);
void check_mobile_robot(const WorldSpec& spec, ProblemList& problems);

}  // namespace parallax::harness
