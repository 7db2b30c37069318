#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "harness/engine/geometry_check.h"
#include "harness/engine/ode_world.h"
#include "harness/engine/solid_boxes.h"
#include "harness/engine/sweep.h"

namespace parallax::harness {
namespace {

bool can_set_any(const BodySpec& body, std::initializer_list<std::string_view> items) {
  return std::any_of(items.begin(), items.end(),
                     [&](std::string_view item) { return body.can_set(item); });
}

/// Bodies that every start puts at the same place can be held against each other beforehand.
class OverlapChecker {
 public:
  OverlapChecker(const WorldSpec& spec, std::vector<WorldProblem>& problems)
      : spec_(spec), problems_(problems), world_(spec), layout_(world_.layout()) {
    for (std::size_t i = 0; i < layout_.bodies.size(); ++i) {
      elsewhere_.push_back(chosen(i, {"x", "y", "z", "bottom", "yaw"}));
    }
  }

  void run() {
    for (std::size_t i = 0; i < layout_.bodies.size(); ++i) {
      if (!layout_.link_of[i]) {
        check_twins(i);
      } else if (!elsewhere_[i]) {
        check_against(i, elsewhere_);
      } else if (!chosen(i, {"z", "bottom"})) {
        check_against(i, BodyMask(layout_.bodies.size(), true));  // the floor is left
      }
    }
  }

 private:
  const BodySpec& body(std::size_t i) const { return layout_.bodies[layout_.bodies.id_at(i)]; }

  /// May a start choose one of these of the body, or of what it hangs on?
  bool chosen(std::size_t i, std::initializer_list<std::string_view> items) const {
    if (!layout_.link_of[i]) return false;
    for (std::size_t k = 0; k < layout_.bodies.size(); ++k) {
      const bool together =
          k == i || (!layout_.is_free[i] && layout_.assembly_of[k] == layout_.assembly_of[i]);
      if (together && can_set_any(body(k), items)) return true;
    }
    return false;
  }

  void check_against(std::size_t i, BodyMask ignored) {
    BodyMask self(layout_.bodies.size(), false);
    self[i] = true;
    for (std::size_t k = 0; k < layout_.bodies.size(); ++k) {
      const bool together = !layout_.is_free[i] && layout_.link_of[k] &&
                            layout_.assembly_of[k] == layout_.assembly_of[i];
      if (together) ignored[k] = true;
    }
    const Sweep sweep(world_, self, ignored, spec_.solver.start_penetration_m);
    const Eigen::Vector3d none = Eigen::Vector3d::Zero();
    const auto hit = sweep.along(none, none, 1.0);
    if (!hit || !reported_.insert(std::minmax(hit->part, hit->obstacle)).second) return;
    problems_.push_back(
        {"bodies/" + hit->part, fmt::format("overlaps `{}` at every start", hit->obstacle), {}});
  }

  /// Furniture may reach into furniture; two pieces at one place are one too many.
  void check_twins(std::size_t i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (layout_.link_of[k] || !covers(body(k), body(i)) || !covers(body(i), body(k))) continue;
      problems_.push_back({"bodies/" + body(i).name,
                           fmt::format("occupies the same place as `{}`", body(k).name),
                           {}});
      return;
    }
  }

  /// Is every box of `inner` inside a box of `outer`?
  bool covers(const BodySpec& outer, const BodySpec& inner) const {
    const auto outer_boxes = solid_boxes(outer), inner_boxes = solid_boxes(inner);
    return !inner_boxes.empty() &&
           std::all_of(inner_boxes.begin(), inner_boxes.end(), [&](const SolidBox& box) {
             return std::any_of(outer_boxes.begin(), outer_boxes.end(),
                                [&](const SolidBox& other) { return other.contains(box); });
           });
  }

  const WorldSpec& spec_;
  std::vector<WorldProblem>& problems_;
  OdeWorld world_;
  const WorldLayout& layout_;
  BodyMask elsewhere_;  // those whose place a start may choose
  std::set<std::pair<std::string, std::string>> reported_;
};

}  // namespace

void check_overlaps(const WorldSpec& spec, std::vector<WorldProblem>& problems) {
  if (!spec.bodies.empty()) OverlapChecker(spec, problems).run();
}

}  // namespace parallax::harness
