#include "compiler/plan/failure_classes.h"

#include <algorithm>
#include <span>
#include <utility>

namespace parallax::compiler {
namespace {

struct Entry {
  const char* name;
  const char* parent;  // null for the root
  const char* second_parent = nullptr;
};

constexpr Entry kLisp[] = {
    {"t", nullptr},
    {"condition", "t"},
    {"simple-condition", "condition"},
    {"serious-condition", "condition"},
    {"error", "serious-condition"},
    {"simple-error", "simple-condition", "error"},
    {"type-error", "error"},
    {"case-failure", "type-error"},
    {"program-error", "error"},
    {"arithmetic-error", "error"},
    {"division-by-zero", "arithmetic-error"},
};

/// cram_language, cram_designators, cram_executive, cram_common_failures.
constexpr Entry kCram[] = {
    {"plan-failure", "serious-condition"},
    {"simple-plan-failure", "simple-condition", "plan-failure"},
    {"composite-failure", "plan-failure"},
    {"common-lisp-error-envelope", "plan-failure"},
    {"designator-error", "simple-error"},
    {"designator-reference-failure", "simple-plan-failure", "designator-error"},
    {"designator-goal-parsing-failure", "simple-plan-failure", "designator-error"},
    {"low-level-failure", "simple-plan-failure"},
    {"actionlib-action-timed-out", "low-level-failure"},
    {"navigation-low-level-failure", "low-level-failure"},
    {"navigation-pose-unreachable", "navigation-low-level-failure"},
    {"navigation-goal-not-reached", "navigation-low-level-failure"},
    {"manipulation-low-level-failure", "low-level-failure"},
    {"manipulation-goal-not-reached", "manipulation-low-level-failure"},
    {"manipulation-pose-unreachable", "manipulation-low-level-failure"},
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
};

constexpr Entry kOnlyDevel[] = {
    {"gripper-low-level-failure", "low-level-failure"},
    {"environment-manipulation-goal-not-reached", "manipulation-low-level-failure"},
    {"perception-object-not-in-world", "perception-low-level-failure"},
    {"searching-failed", "high-level-failure"},
    {"fetching-failed", "high-level-failure"},
    {"delivering-failed", "high-level-failure"},
};

constexpr Entry kOnly2020[] = {
    {"gripper-low-level-failure", "manipulation-low-level-failure"},
};

}  // namespace

FailureClasses::FailureClasses(FailureTable table) {
  const auto own = table == FailureTable::kDevel ? std::span<const Entry>(kOnlyDevel)
                                                 : std::span<const Entry>(kOnly2020);
  for (const auto entries : {std::span<const Entry>(kLisp), std::span<const Entry>(kCram), own}) {
    for (const auto& entry : entries) {
      // A plan may define CRAM's classes anew, those of Lisp not.
      if (entries.data() == kLisp) added_.emplace(entry.name);
      auto& parents = parents_[entry.name];
      if (entry.parent != nullptr) parents.emplace_back(entry.parent);
      if (entry.second_parent != nullptr) parents.emplace_back(entry.second_parent);
    }
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
  for (const auto& parent : parents) {
    if (is_a(parent, name)) return false;
  }
  if (!added_.emplace(name).second) return false;
  parents_.insert_or_assign(std::string(name), std::move(parents));
  return true;
}

bool FailureClasses::is_a(std::string_view name, std::string_view ancestor) const {
  std::vector<std::string_view> open = {name};  // `add` lets no class be above itself
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

int FailureClasses::depth(std::string_view name) const {
  int depth = -1;
  std::set<std::string_view> level = {name};
  for (; !level.empty(); ++depth) {
    std::set<std::string_view> above;
    for (const auto one : level) {
      const auto found = parents_.find(one);
      if (found != parents_.end()) above.insert(found->second.begin(), found->second.end());
    }
    level = std::move(above);
  }
  return depth;
}

bool FailureClasses::cross(std::string_view one, std::string_view other) const {
  if (is_a(one, other) || is_a(other, one)) return false;
  return std::any_of(parents_.begin(), parents_.end(), [&](const auto& entry) {
    return is_a(entry.first, one) && is_a(entry.first, other);
  });
}

std::vector<std::string> FailureClasses::names() const {
  std::vector<std::string> out;
  for (const auto& [name, parents] : parents_) out.push_back(name);
  return out;
}

}  // namespace parallax::compiler
