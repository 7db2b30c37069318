#include "compiler/plan/failure_classes.h"

#include <utility>

namespace parallax::compiler {
namespace {

struct Entry {
  const char* name;
  const char* parent;  // null for the root
};

constexpr Entry kBuiltIn[] = {
    {"t", nullptr},
    {"condition", "t"},
    {"serious-condition", "condition"},
    {"error", "serious-condition"},
    {"simple-error", "error"},
    {"type-error", "error"},
    {"case-failure", "type-error"},
    {"plan-failure", "serious-condition"},
    {"composite-failure", "plan-failure"},
    {"simple-plan-failure", "plan-failure"},
    {"low-level-failure", "simple-plan-failure"},
    {"actionlib-action-timed-out", "low-level-failure"},
    {"navigation-low-level-failure", "low-level-failure"},
    {"navigation-pose-unreachable", "navigation-low-level-failure"},
    {"navigation-goal-not-reached", "navigation-low-level-failure"},
    {"manipulation-low-level-failure", "low-level-failure"},
    {"manipulation-goal-not-reached", "manipulation-low-level-failure"},
    {"manipulation-pose-unreachable", "manipulation-low-level-failure"},
    {"gripper-low-level-failure", "manipulation-low-level-failure"},
    {"gripper-closed-completely", "gripper-low-level-failure"},
    {"gripper-goal-not-reached", "gripper-low-level-failure"},
    {"torso-low-level-failure", "manipulation-low-level-failure"},
    {"torso-goal-unreachable", "torso-low-level-failure"},
    {"torso-goal-not-reached", "torso-low-level-failure"},
    {"perception-low-level-failure", "low-level-failure"},
    {"perception-object-not-found", "perception-low-level-failure"},
    {"ptu-low-level-failure", "low-level-failure"},
    {"ptu-goal-unreachable", "ptu-low-level-failure"},
    {"ptu-goal-not-reached", "ptu-low-level-failure"},
    {"high-level-failure", "simple-plan-failure"},
    {"navigation-high-level-failure", "high-level-failure"},
    {"navigation-goal-in-collision", "navigation-high-level-failure"},
    {"looking-high-level-failure", "high-level-failure"},
    {"object-unreachable", "high-level-failure"},
    {"manipulation-goal-in-collision", "high-level-failure"},
    {"object-unfetchable", "high-level-failure"},
    {"object-undeliverable", "high-level-failure"},
    {"object-nowhere-to-be-found", "high-level-failure"},
    {"environment-unreachable", "high-level-failure"},
    {"environment-manipulation-impossible", "high-level-failure"},
    {"designator-error", "simple-plan-failure"},
    {"designator-reference-failure", "designator-error"},
};

}  // namespace

FailureClasses::FailureClasses() {
  for (const auto& entry : kBuiltIn) {
    std::vector<std::string> parents;
    if (entry.parent != nullptr) parents.emplace_back(entry.parent);
    parents_.emplace(entry.name, std::move(parents));
  }
}

bool FailureClasses::knows(std::string_view name) const { return canonical(name).has_value(); }

std::optional<std::string> FailureClasses::canonical(std::string_view name) const {
  if (name == "perception-object-unfound") name = "perception-object-not-found";
  const auto found = parents_.find(name);
  if (found == parents_.end()) return std::nullopt;
  return found->first;
}

bool FailureClasses::add(std::string_view name, std::vector<std::string> parents) {
  if (knows(name)) return false;
  return parents_.emplace(name, std::move(parents)).second;
}

bool FailureClasses::is_a(std::string_view name, std::string_view ancestor) const {
  std::vector<std::string_view> open = {name};  // a class is added after its parents: no cycles
  while (!open.empty()) {
    const auto current = open.back();
    open.pop_back();
    if (current == ancestor) return true;
    const auto found = parents_.find(current);
    if (found == parents_.end()) continue;
    for (const auto& parent : found->second) open.push_back(parent);
  }
  return false;
}

std::vector<std::string> FailureClasses::names() const {
  std::vector<std::string> out;
  for (const auto& [name, parents] : parents_) out.push_back(name);
  return out;
}

}  // namespace parallax::compiler
