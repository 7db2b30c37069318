#include "harness/draw/difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "harness/draw/failure_marks.h"

namespace parallax::harness {
namespace {

constexpr double kHeldWithin_m = 0.3;  // of the hand

class Differences {
 public:
  Differences(const StateMapping& mapping, const WorldSpec& spec, const Scene& before,
              Picture& picture)
      : mapping_(mapping), spec_(spec), before_(before), picture_(picture) {}

  void add(const ShownDifference& difference) {
    const GroundFluent fluent = ground_fluent(difference.fluent);
    const FluentBinding* binding = mapping_.find(fluent.symbol);
    if (binding == nullptr) return;
    if (const auto* inside = std::get_if<InsideBinding>(&binding->condition)) {
      add_inside(fluent, *inside, difference);
    } else if (const auto* flag = std::get_if<FlagBinding>(&binding->condition)) {
      add_flag(fluent, with_arguments(flag->variable, fluent), difference);
    } else if (const auto* range = std::get_if<RangeBinding>(&binding->condition)) {
      add_joint(with_arguments(range->variable, fluent));
    }
  }

  void finish() {
    auto& action = picture_.action;
    for (auto* names : {&action.differing, &action.predicted_regions}) {
      std::sort(names->begin(), names->end());
      names->erase(std::unique(names->begin(), names->end()), names->end());
    }
    if (!action.predicted.boxes.empty() || !action.predicted_regions.empty()) {
      action.notes.emplace_back("violet dashes: where the model says that it is");
    }
    if (!action.differing.empty()) action.notes.emplace_back("red outline: where it is");
  }

 private:
  /// The body that a variable is about: "box" of "box.held"; empty: none that is drawn.
  std::string body_of(const std::string& name) const {
    const auto body = name == "robot" ? base_body(spec_) : name;
    return origin_of(picture_.scene, body) ? body : std::string();
  }

  void add_inside(const GroundFluent& fluent, const InsideBinding& inside,
                  const ShownDifference& difference) {
    const auto body = body_of(with_arguments(inside.body, fluent));
    if (body.empty()) return;
    auto& action = picture_.action;
    action.differing.push_back(body);
    const Region* region = inside.region_of(fluent, mapping_.regions());
    if (!difference.predicted || region == nullptr) return;
    const Eigen::Vector3d here = *origin_of(picture_.scene, body);
    if (body == base_body(spec_) && action.goal) {
      add_shifted(picture_.scene, body, action.goal->to_W - here);
    }
    if (!region->frame.empty()) return;
    action.predicted_regions.push_back(region->name);
    Eigen::Vector3d near = here;
    for (const RegionAxis axis : {RegionAxis::kX, RegionAxis::kY}) {
      const auto i = static_cast<Eigen::Index>(axis);
      const auto& interval = region->on(axis);
      if (interval) near[i] = std::clamp(here[i], interval->lower, interval->upper);
    }
    const double off_m = (near - here).norm();
    if (off_m == 0.0) return;
    action.measures.push_back(
        {near, here, fmt::format("`{}` {} outside `{}`", body, length_text(off_m), region->name)});
  }

  void add_flag(const GroundFluent& fluent, const std::string& variable,
                const ShownDifference& difference) {
    const auto body = body_of(variable.substr(0, variable.find('.')));
    if (body.empty() || body == base_body(spec_)) return;
    picture_.action.differing.push_back(body);
    if (!difference.predicted) return;
    std::string arm;
    for (const SceneArm& shown : picture_.scene.arms) {
      const auto& given = fluent.arguments;
      if (std::find(given.begin(), given.end(), shown.name) != given.end()) arm = shown.name;
    }
    const auto hand = hand_of(picture_.scene, spec_, arm);
    const auto hand_before = hand_of(before_, spec_, arm);
    const auto item_before = origin_of(before_, body);
    if (!hand || !hand_before || !item_before) return;
    // As it hung before, or between the pads.
    const bool was_held = (*item_before - *hand_before).norm() < kHeldWithin_m;
    add_shifted(before_, body, *hand - (was_held ? *hand_before : *item_before));
  }

  void add_joint(const std::string& variable) {
    const auto name = variable.substr(0, variable.find('.'));
    for (const JointSpec& joint : spec_.joints) {
      if (joint.name == name && origin_of(picture_.scene, joint.child)) {
        picture_.action.differing.push_back(joint.child);
      }
    }
  }

  /// The body where the model says that it is.
  void add_shifted(const Scene& scene, const std::string& body, Eigen::Vector3d shift) {
    auto& predicted = picture_.action.predicted.boxes;
    if (body == base_body(spec_)) shift.z() = 0.0;
    for (SceneBox box : scene.boxes) {
      if (box.body != body) continue;
      box.box.p_WS += shift;
      box.origin_W += shift;
      predicted.push_back(std::move(box));
    }
  }

  const StateMapping& mapping_;
  const WorldSpec& spec_;
  const Scene& before_;
  Picture& picture_;
};

}  // namespace

void add_differences(const StateMapping& mapping, const WorldSpec& spec,
                     const std::vector<ShownDifference>& differences, const Scene& before,
                     Picture& picture) {
  Differences all(mapping, spec, before, picture);
  for (const ShownDifference& difference : differences) all.add(difference);
  all.finish();
}

}  // namespace parallax::harness
