#include <doctest/doctest.h>

#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {
namespace {

const char* const kLookFor = R"lisp(
(defparameter *work-pose* (make-pose-stamped "map" 0.0 (make-3d-vector 0.72 0.06 0)
                                             (make-identity-rotation)))
(defparameter *view-pose* (make-pose-stamped "map" 0.0 (make-3d-vector 1.46 0.10 0.9)
                                             (make-identity-rotation)))
(def-cram-function look-for (?what)
  (let ((?to *work-pose*)) (perform (a motion (type going) (pose ?to))))
  (let ((?at *view-pose*)) (perform (a motion (type looking) (pose ?at))))
  (perform (a motion (type detecting) (object (an object (type ?what))))))
(look-for :bowl)
)lisp";

TEST_CASE("unroller: drive, look, detect has three locations and four leaves") {
  const auto plan = unroll(kLookFor);
  REQUIRE(plan.graph.has_value());
  CHECK(plan.codes().empty());
  CHECK(plan.graph->locations.size() == 3);
  CHECK(plan.events("+++") == Strings{"Go(r1)", "LookAt(r2)", "Detect(bowl)", "DONE"});
  CHECK(plan.terminals() == Strings{"DONE", "FAILED(navigation-pose-unreachable)",
                                    "FAILED(perception-object-not-found)",
                                    "FAILED(ptu-goal-unreachable)"});
  CHECK(plan.walk("-") == "L0 FAILED(navigation-pose-unreachable)");
  CHECK(plan.walk("+-") == "L0 L1 FAILED(ptu-goal-unreachable)");
  CHECK(longest_path(*plan.graph) == 3);

  const auto& go = plan.graph->locations[LocationId(0)];
  CHECK(go.event_symbol == "Go");
  CHECK(go.event.text == "Go(r1)");
  CHECK(go.success.formula.text == "RobotAt(r1)");
  CHECK(go.success.time_offset == 1);
  CHECK(plan.files.text(go.success.source) == "RobotAt(region(?p))");
  CHECK(go.failure_class == "navigation-pose-unreachable");
  CHECK(std::get<double>(go.arguments.at("target.x")) == 0.72);
  CHECK(std::get<double>(go.arguments.at("target.y")) == 0.06);
  CHECK(std::get<double>(go.arguments.at("target.yaw")) == 0.0);

  const auto& detect = plan.graph->locations[LocationId(2)];
  CHECK(detect.success.formula.text == "exists i. TypeOf(i,bowl) & Visible(i)");
  CHECK(detect.success.time_offset == 0);
  REQUIRE(detect.result.has_value());
  CHECK(plan.graph->values[*detect.result].name == "?i1");
  CHECK(plan.graph->values[*detect.result].variable == "i");
  CHECK(std::get<std::string>(detect.arguments.at("object.type")) == "bowl");
}

TEST_CASE("unroller: a location knows its perform and the calls that lead to it") {
  const auto plan = unroll(kLookFor);
  REQUIRE(plan.graph.has_value());
  const auto& look = plan.graph->locations[LocationId(1)];
  CHECK(plan.files.place(look.source) == "plan.lisp:8");
  CHECK(plan.files.text(look.source) == "(perform (a motion (type looking) (pose ?at)))");
  REQUIRE(look.calls.size() == 1);
  CHECK(plan.files.text(look.calls[0]) == "(look-for :bowl)");
}

const char* const kFetchSpoon = R"lisp(
(def-cram-function fetch-spoon ()
  (let ((?spoon nil))
    (dolist (?d '(:top-drawer :middle-drawer :low-drawer))
      (perform (an action (type opening) (arm left) (object (an object (name ?d)))))
      (perform (a motion (type looking) (target (a location (in (an object (name ?d)))))))
      (with-failure-handling
          ((perception-low-level-failure (e) (ros-warn (demo) "~a" e) (return)))
        (setf ?spoon (perform (a motion (type detecting) (object (an object (type spoon)))))))
      (when ?spoon (return))
      (perform (an action (type closing) (arm left) (object (an object (name ?d))))))
    (unless ?spoon (fail 'object-nowhere-to-be-found))
    (with-retry-counters ((tries 1))
      (with-failure-handling
          ((manipulation-low-level-failure (e) (do-retry tries (retry))))
        (perform (an action (type picking-up) (arm left) (object ?spoon)))))
    ?spoon))
)lisp";

TEST_CASE("unroller: search the drawers, retry the pick once") {
  UnrollOptions options;
  options.constants = {"topDrawer", "middleDrawer", "lowDrawer", "spoon", "left"};
  const auto plan = unroll(kFetchSpoon, options);
  CHECK(plan.codes().empty());
  REQUIRE(plan.graph.has_value());
  // Found in the first drawer, first pick fails, second works.
  CHECK(plan.events("+++-+") == Strings{"OpenDrawer(topDrawer)", "LookAt(topDrawer)",
                                        "Detect(spoon)", "PickUp(left,?i1)", "PickUp(left,?i1)",
                                        "DONE"});
  // A third pick never exists.
  CHECK(plan.events("+++--").back() == "FAILED(manipulation-pose-unreachable)");
  // Not in the first drawer: it is closed and the next one is searched.
  CHECK(plan.events("++-+++++") == Strings{"OpenDrawer(topDrawer)", "LookAt(topDrawer)",
                                           "Detect(spoon)", "CloseDrawer(topDrawer)",
                                           "OpenDrawer(middleDrawer)", "LookAt(middleDrawer)",
                                           "Detect(spoon)", "PickUp(left,?i1)", "DONE"});
  CHECK(plan.events("++-+++-+++-+").back() == "FAILED(object-nowhere-to-be-found)");
  // 4 events a drawer, and 2 picks of whatever was found: the rest of the plan knows no more of it.
  CHECK(plan.graph->locations.size() == 3 * 4 + 2);
  CHECK(plan.graph->values.size() == 1);
}

const char* const kManyStances = R"lisp(
(defun look-from-many (?d)
  (dolist (?p *stances*)
    (perform (a motion (type going) (pose ?p)))
    (perform (a motion (type looking) (target (a location (in (an object (name ?d)))))))
    (with-failure-handling ((perception-low-level-failure (e) (return)))
      (let ((?o (perform (a motion (type detecting) (object (an object (type spoon)))))))
        (perform (an action (type picking-up) (arm left) (object ?o)))
        (return-from look-from-many ?o)))))
(look-from-many 'drawer)
)lisp";

TEST_CASE("unroller: several stances in one region, with their own poses") {
  const auto plan = unroll("(defparameter *stances* (list " + pose_at(0.2) + pose_at(0.4) +
                           pose_at(0.6) + "))" + kManyStances);
  CHECK(plan.codes().empty());
  REQUIRE(plan.graph.has_value());
  CHECK(plan.graph->locations.size() == 12);
  CHECK(plan.events("++++").back() == "DONE");
  CHECK(plan.events("++-++-++-") == Strings{"Go(r1)", "LookAt(drawer)", "Detect(spoon)", "Go(r1)",
                                            "LookAt(drawer)", "Detect(spoon)", "Go(r1)",
                                            "LookAt(drawer)", "Detect(spoon)", "DONE"});
  std::vector<double> x;
  for (const auto& location : plan.graph->locations) {
    if (location.event_symbol == "Go")
      x.push_back(std::get<double>(location.arguments.at("target.x")));
  }
  CHECK(x == std::vector<double>{0.2, 0.4, 0.6});
}

TEST_CASE("unroller: the two-region plan with prefixes, tags and logging") {
  const auto plan = unroll(R"lisp(
(in-package :demo)
(defparameter *pick* (cl-tf:make-pose-stamped "map" 0.0 (cl-tf:make-3d-vector 1.5 0 0)
                                              (cl-tf:make-identity-rotation)))
(defparameter *place* (cl-tf:make-pose-stamped "map" 0.0 (cl-tf:make-3d-vector 0.5 0 0)
                                               (cl-tf:make-quaternion 0 0 1 1)))
(cpl:def-cram-function fetch-box (&key (arm :left))
  "Fetches the box."
  (declare (ignorable arm))
  (roslisp:ros-info (demo) "going to ~a" *pick*)
  (let* ((?arm arm) (?there *pick*) (?box (desig:an object (name box))))
    (exe:perform (desig:a motion (type going) (target (desig:a location (pose ?there)))))
    (exe:perform (desig:an action (type picking-up) (arm ?arm) (object ?box)))
    (exe:perform (desig:an action (type placing) (arm ?arm) (object ?box)
                           (target (desig:a location (pose *place*)))))))
(cram-language:top-level (with-tags (fetch-box)))
)lisp");
  CHECK(plan.codes().empty());
  REQUIRE(plan.graph.has_value());
  CHECK(plan.events("+++") ==
        Strings{"Go(r2)", "PickUp(left,box)", "PlaceAt(left,box,r1)", "DONE"});
  const auto& place = plan.graph->locations[LocationId(2)];
  CHECK(place.success.formula.text == "ItemAt(box,r1)");
  CHECK(std::get<std::string>(place.arguments.at("object")) == "box");
  CHECK(std::get<std::string>(place.arguments.at("arm")) == "left");
  CHECK(std::get<double>(place.arguments.at("target.x")) == 0.5);
  CHECK(std::get<double>(place.arguments.at("target.yaw")) == doctest::Approx(std::acos(0.0)));
}

}  // namespace
}  // namespace parallax::compiler
