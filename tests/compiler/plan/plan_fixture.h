#pragma once

#include <doctest/doctest.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/interpreter/unroller.h"
#include "compiler/lisp/lisp_reader.h"
#include "compiler/plan/plan_binding.h"
#include "compiler/plan/plan_graph.h"

namespace parallax::compiler {

/// Regions along x: r1 = [0, 1), r2 = [1, 2].
class LineLocator final : public PoseLocator {
 public:
  std::optional<std::string> region_of(std::string_view /*function*/,
                                       const PlanPose& pose) const override {
    if (pose.x_m >= 0.0 && pose.x_m < 1.0) return "r1";
    if (pose.x_m >= 1.0 && pose.x_m <= 2.0) return "r2";
    return std::nullopt;
  }
  std::optional<Nearest> nearest(std::string_view /*function*/,
                                 const PlanPose& pose) const override {
    if (pose.x_m < 0.0) return Nearest{"r1", -pose.x_m};
    return Nearest{"r2", pose.x_m - 2.0};
  }
};

inline constexpr std::string_view kBinding = R"(; what the designators mean
motion going     (:target ?p)    -> Go(region(?p))              ok: RobotAt(region(?p)) @t+1
                                    else navigation-pose-unreachable
motion looking   (:target ?p)    -> LookAt(gaze(?p))            ok: LookingAt(gaze(?p)) @t+1
                                    else ptu-goal-unreachable
motion detecting (:object type ?y) -> Detect(?y)                ok: exists i. TypeOf(i,?y) & Visible(i) @t
                                    returns i ; else perception-object-not-found
action picking-up (:arm ?a :object ?o) -> PickUp(?a,?o)         ok: Holding(?a,?o) @t+1
                                    else manipulation-pose-unreachable
action placing (:arm :object :target)  -> PlaceAt(?a,?o,place(?p)) ok: ItemAt(?o,place) @t+1
                                    else manipulation-goal-not-reached
action opening|accessing (:object name ?d) -> OpenDrawer(?d)    ok: Open(?d) @t+1
                                    else manipulation-goal-not-reached
action closing|sealing (:object name ?d) -> CloseDrawer(?d)     ok: !Open(?d) @t+1
                                    else manipulation-goal-not-reached
motion signalling -> Signal() ok: Signalled() @t+1
action navigating = going ; action turning-towards = looking ; action detecting = motion detecting
)";

/// One unrolled plan with everything that is needed to look at it.
struct Unrolled {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  std::optional<PlanGraph> graph;

  std::string target(const PlanTarget& where) const { return to_string(*graph, where, files); }
  /// "L0 L1 DONE": the way from the entry that takes these outcomes.
  std::string walk(std::string_view outcomes) const;
  /// The events along that way.
  std::vector<std::string> events(std::string_view outcomes) const;
  std::vector<std::string> terminals() const;
  std::vector<std::string> codes() const;
  bool has(std::string_view code) const {
    const auto all = codes();
    return std::find(all.begin(), all.end(), code) != all.end();
  }
};

inline std::string Unrolled::walk(std::string_view outcomes) const {
  std::string out = target(graph->entry);
  PlanTarget where = graph->entry;
  for (const char outcome : outcomes) {
    const bool first = outcome == '+';
    if (const auto* location = std::get_if<LocationId>(&where)) {
      const auto& at = graph->locations[*location];
      where = first ? at.on_success : at.on_failure;
    } else if (const auto* branch = std::get_if<BranchId>(&where)) {
      where = first ? graph->branches[*branch].if_true : graph->branches[*branch].if_false;
    } else {
      return out + " (over)";
    }
    out += " " + target(where);
  }
  return out;
}

inline std::vector<std::string> Unrolled::events(std::string_view outcomes) const {
  std::vector<std::string> out;
  PlanTarget where = graph->entry;
  for (const char outcome : outcomes) {
    const bool first = outcome == '+';
    if (const auto* location = std::get_if<LocationId>(&where)) {
      const auto& at = graph->locations[*location];
      out.push_back(at.event.text);
      where = first ? at.on_success : at.on_failure;
    } else if (const auto* branch = std::get_if<BranchId>(&where)) {
      where = first ? graph->branches[*branch].if_true : graph->branches[*branch].if_false;
    }
  }
  out.push_back(target(where));
  return out;
}

inline std::vector<std::string> Unrolled::terminals() const {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < graph->terminals.size(); ++i) {
    out.push_back(target(graph->terminals.id_at(i)));
  }
  std::sort(out.begin(), out.end());
  return out;
}

inline std::vector<std::string> Unrolled::codes() const {
  std::vector<std::string> out;
  for (const auto& entry : sink.sorted()) out.emplace_back(base::info(entry.code).id);
  return out;
}

inline Unrolled unroll(std::string_view plan, const UnrollOptions& options = {},
                       std::string_view binding_text = kBinding) {
  Unrolled out;
  const auto file = out.files.add("plan.lisp", std::string(plan));
  const auto bind = out.files.add("plan.bind", std::string(binding_text));
  const auto binding = parse_plan_binding(out.files, bind, out.sink);
  if (!binding) return out;
  auto graph =
      unroll_plan(out.files, std::span(&file, 1), *binding, LineLocator(), options, out.sink);
  if (graph) out.graph = std::move(*graph);
  return out;
}

/// A pose in the plan's own words.
inline std::string pose_at(double x_m) {
  return fmt::format(
      "(make-pose-stamped \"map\" 0.0 (make-3d-vector {} 0 0) (make-identity-rotation))", x_m);
}

/// Definitions of *p1 (in r1) and *p2* (in r2), and shorthands go1, go2, pick, sig.
inline std::string prelude() {
  return "(defparameter *p1* " + pose_at(0.5) + ")(defparameter *p2* " + pose_at(1.5) + ")" +
         R"(
(defun go1 () (perform (a motion (type going) (target *p1*))))
(defun go2 () (perform (a motion (type going) (target *p2*))))
(defun pick () (perform (an action (type picking-up) (arm left) (object (an object (name box))))))
(defun sig () (perform (a motion (type signalling))))
)";
}

/// The plan after the prelude, unrolled without a word.
inline Unrolled with_prelude(std::string_view text) {
  auto plan = unroll(prelude() + std::string(text));
  CHECK(plan.codes().empty());
  REQUIRE(plan.graph.has_value());
  return plan;
}

using Strings = std::vector<std::string>;

}  // namespace parallax::compiler
