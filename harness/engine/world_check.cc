#include "harness/engine/world_check.h"

#include "harness/engine/geometry_check.h"

namespace parallax::harness {

std::vector<WorldProblem> check_world(const WorldSpec& spec) {
  std::vector<WorldProblem> problems = check_structure(spec);
  if (problems.empty()) check_geometry(spec, problems);
  if (problems.empty()) check_grippers(spec, problems);
  if (problems.empty()) check_overlaps(spec, problems);
  return problems;
}

}  // namespace parallax::harness
