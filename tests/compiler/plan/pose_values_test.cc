// Poses and transforms as values of a plan: those that are computed, and those that only the robot
// knows.
#include <doctest/doctest.h>

#include <fstream>
#include <iterator>

#include "compiler/builtins/builtin_call.h"
#include "tests/compiler/plan/plan_fixture.h"

namespace parallax::compiler {
namespace {

/// The plan signals exactly if the condition holds while it is unrolled.
bool holds(const std::string& condition) {
  const auto plan = unroll(prelude() + "(when " + condition + " (sig))");
  for (const auto& entry : plan.sink.sorted()) MESSAGE(entry.message);
  REQUIRE(plan.graph.has_value());
  return plan.events("+") == Strings{"Signal()", "DONE"};
}

/// Is the number near that value?
std::string near(const std::string& number, double value) {
  return fmt::format("(< (abs (- {} {})) 1e-9)", number, value);
}

/// The message of the plan's one error.
std::string refused(const std::string& text) {
  const auto plan = unroll(prelude() + text);
  CHECK(!plan.graph.has_value());
  REQUIRE(plan.sink.sorted().size() == 1);
  const auto entry = plan.sink.sorted().front();
  REQUIRE(entry.range.has_value());
  CHECK(entry.range->end > entry.range->begin);
  return entry.message;
}

bool says(const std::string& text, const std::string& part) {
  const auto message = refused(text);
  CAPTURE(message);
  return message.find(part) != std::string::npos;
}

std::string going_to(const std::string& pose) {
  return "(let ((?to " + pose + ")) (perform (a motion (type going) (target ?to))))";
}

constexpr const char* kTurned =
    "(cl-transforms:axis-angle->quaternion (cl-transforms:make-3d-vector 0 0 2) (/ pi 2))";

TEST_CASE("poses: the page names every function") {
  std::ifstream in(std::string(PARALLAX_SOURCE_DIR) + "/docs/reference/plan_language.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  for (const auto table :
       {pose_part_builtins(), transform_builtins(), frame_builtins(), robot_builtins()}) {
    for (const auto& entry : table) {
      CAPTURE(std::string(entry.builtin.name));
      CHECK(page.find(fmt::format("`{}`", entry.builtin.name)) != std::string::npos);
    }
  }
}

TEST_CASE("poses: parts come back, with any prefix") {
  CHECK(holds(near("(cl-transforms:x (cl-tf:make-3d-vector 1.5 2 3))", 1.5)));
  CHECK(
      holds(near("(y (origin (cl-tf2:make-pose (make-3d-vector 1 2 3) "
                 "(make-identity-rotation))))",
                 2)));
  CHECK(holds(near("(w (orientation *p1*))", 1)));
  CHECK(holds("(equal (cl-transforms-stamped:frame-id *p1*) \"map\")"));
  CHECK(holds("(= (stamp *p1*) 0)"));
  CHECK(
      holds("(equal (child-frame-id (make-transform-stamped \"map\" \"cup\" 0.0 "
            "(make-identity-vector) (make-identity-rotation))) \"cup\")"));
  CHECK(holds(near("(w (make-quaternion 0 0 0 2))", 2)));  // as made
  CHECK(
      holds(near("(w (orientation (make-pose (make-identity-vector) "
                 "(make-quaternion 0 0 0 2))))",
                 1)));  // a pose has a rotation
}

TEST_CASE("poses: copies with other parts") {
  CHECK(holds(near("(z (copy-3d-vector (make-3d-vector 1 2 3) :z 5))", 5)));
  CHECK(holds(near("(x (copy-3d-vector (make-3d-vector 1 2 3) :z 5))", 1)));
  CHECK(holds(near("(x (origin (copy-pose-stamped *p1* :origin (make-3d-vector 9 0 0))))", 9)));
  CHECK(holds("(= (stamp (copy-pose-stamped *p1* :stamp 4.0 :origin nil)) 4)"));
  CHECK(holds(near("(z (origin (cram-tf:translate-pose *p1* :z-offset 0.25)))", 0.25)));
  CHECK(
      holds(near("(x (rotate (orientation (cram-tf:rotate-pose *p1* :z (/ pi 2))) "
                 "(make-3d-vector 0 1 0)))",
                 -1)));
}

TEST_CASE("poses: arithmetic and composition") {
  CHECK(holds(near("(v-norm (v+ (make-3d-vector 1 0 0) (make-3d-vector 2 4 0)))", 5)));
  CHECK(holds(near("(x (v- (make-3d-vector 1 0 0)))", -1)));
  CHECK(holds(near("(v-dist (make-3d-vector 1 1 1) (make-3d-vector 1 1 3))", 2)));
  CHECK(holds(near("(y (v* (make-3d-vector 1 2 3) 1/2))", 1)));
  CHECK(holds(near("(z (cross-product (make-3d-vector 1 0 0) (make-3d-vector 0 1 0)))", 1)));
  CHECK(holds(near(fmt::format("(y (rotate {} (make-3d-vector 1 0 0)))", kTurned), 1)));
  CHECK(holds(near("(w (q* (euler->quaternion :ax 0.3) (q-inv (euler->quaternion :ax 0.3))))", 1)));
  CHECK(holds(near("(get-yaw (euler->quaternion :az 0.4))", 0.4)));
  CHECK(holds(near(fmt::format("(angle-between-quaternions (make-identity-rotation) {})", kTurned),
                   std::acos(0.0))));
  // Turned by 90 degrees and moved: the point (1 0 0) comes to (5 1 0).
  const std::string turn = fmt::format("(make-transform (make-3d-vector 5 0 0) {})", kTurned);
  CHECK(holds(near("(x (transform-point " + turn + " (make-3d-vector 1 0 0)))", 5)));
  CHECK(holds(near("(y (transform " + turn + " (make-3d-vector 1 0 0)))", 1)));
  CHECK(holds(near("(y (origin (transform " + turn + " (make-pose (make-3d-vector 1 0 0) " +
                       "(make-identity-rotation)))))",
                   1)));
  const std::string back = "(transform* " + turn + " (transform-inv " + turn + "))";
  CHECK(holds(near("(v-norm (translation " + back + "))", 0)));
  CHECK(holds(near("(x (origin (transform->pose (pose->transform *p2*))))", 1.5)));
}

TEST_CASE("poses: stamped transforms know their frames") {
  const std::string cup = "(pose-stamped->transform-stamped *p2* \"cup\")";  // map to cup
  const std::string lid =
      "(make-transform-stamped \"cup\" \"lid\" 1.0 (make-3d-vector 0 0 0.1) "
      "(make-identity-rotation))";
  const std::string both =
      "(cram-tf:multiply-transform-stampeds \"map\" \"lid\" " + cup + " " + lid;
  CHECK(holds("(equal (child-frame-id " + both + ")) \"lid\")"));
  CHECK(holds("(= (stamp " + both + ")) 0)"));
  CHECK(holds(near("(z (origin " + both + " :result-as-pose-or-transform :pose)))", 0.1)));
  CHECK(holds("(equal (frame-id (transform-stamped-inv " + cup + ")) \"cup\")"));
  CHECK(holds(near("(x (origin (strip-transform-stamped " + cup + ")))", 1.5)));
  CHECK(holds("(equal (frame-id (apply-transform " + cup + " " + lid + ")) \"map\")"));
  CHECK(says("(apply-transform " + lid + " " + cup + ")", "leads to `lid`, the second begins at"));
}

TEST_CASE("poses: what is computed names a region") {
  const auto plan = unroll(
      prelude() +
      going_to("(pose->pose-stamped cram-tf:*fixed-frame* (roslisp:ros-time) (transform->pose "
               "(transform* (pose->transform *p1*) (make-transform (make-3d-vector 1 0 0) "
               "(make-identity-rotation)))))"));
  CHECK(plan.codes().empty());
  REQUIRE(plan.graph.has_value());
  CHECK(plan.events("+") == Strings{"Go(r2)", "DONE"});
  // Equal numbers are one value, however they were come by.
  CHECK(holds("(equal *p1* (copy-pose-stamped *p2* :origin (make-3d-vector 0.5 0 0)))"));
}

TEST_CASE("poses: what only the robot knows is carried about, and asked of where it matters") {
  // Handed on, composed, kept in a designator that does not need it.
  const auto plan = unroll(prelude() + R"(
(let* ((?here (cram-tf:robot-current-pose))
       (?there (cram-tf:translate-pose ?here :x-offset (+ 0.1 (cl-transforms:x (cl-transforms:origin ?here)))))
       (?all (list ?here ?there)))
  (when ?there
    (perform (a motion (type signalling) (pose ?there) (poses ?all)))))
)");
  CHECK(plan.codes().empty());
  REQUIRE(plan.graph.has_value());
  CHECK(plan.events("+") == Strings{"Signal()", "DONE"});
  CHECK(says(going_to("(cram-tf:robot-current-pose)"),
             "a pose from `robot-current-pose`, which only the robot knows; write the pose"));
  CHECK(says(going_to("(transform->pose (transform* (lookup-transform *transformer* \"map\" "
                      "\"cup\") (make-identity-transform)))"),
             "from `lookup-transform`"));
  CHECK(says("(when (< (x (origin (robot-current-pose))) 1) (sig))",
             "which only the robot knows; ask the model"));
  CHECK(says("(when (equal (robot-current-pose) *p1*) (sig))", "which only the robot knows"));
  CHECK(holds("(not (eq (robot-current-pose) nil))"));
  // So is where an object lies that a perform has returned.
  const std::string found =
      "(let* ((?o (perform (an action (type detecting) (object (an object (type spoon)))))) (?at "
      "(desig:desig-prop-value ?o :pose))) ";
  CHECK(unroll(prelude() + found + "(perform (a motion (type signalling) (pose ?at))))")
            .codes()
            .empty());
  CHECK(says(found + "(perform (a motion (type going) (target ?at))))", "from `desig-prop-value`"));
  // Parts that a constructor was given come back.
  CHECK(holds(near("(x (make-3d-vector 1 (x (origin (robot-current-pose))) 3))", 1)));
  CHECK(
      holds("(equal (frame-id (make-pose-stamped \"map\" 0.0 (origin (robot-current-pose)) "
            "(make-identity-rotation))) \"map\")"));
}

TEST_CASE("poses: another frame than that of the regions is refused with the way") {
  const std::string other =
      "(make-pose-stamped \"base_footprint\" 0.0 (make-3d-vector 0.5 0 0) "
      "(make-identity-rotation))";
  CHECK(says(going_to(other), "a pose in the frame `base_footprint`; the regions are in `map`"));
  CHECK(says(going_to("(ensure-pose-in-frame " + other + " \"map\")"),
             "from `ensure-pose-in-frame`"));
  CHECK(says(going_to("(transform->pose (transform-inv (pose->transform *p1*)))"),
             "whose frame the plan does not say"));
  CHECK(unroll(prelude() + going_to("(ensure-pose-in-frame *p1* \"map\")")).codes().empty());
  CHECK(says(going_to("(pose->transform *p1*)"), "a transform, not a pose"));
}

TEST_CASE("poses: numbers that are none, and what has no direction") {
  for (const std::string text :
       {"(make-quaternion 0 0 0 0)", "(normalize-vector (make-3d-vector 0 0 0))",
        "(axis-angle->quaternion (make-3d-vector 0 0 0) 1)",
        "(make-pose (make-3d-vector 0 0 0) (make-quaternion 0 0 0 1e-9))"}) {
    CAPTURE(text);
    CHECK(says(text, "no direction"));
  }
  CHECK(says("(v* (make-3d-vector 1e300 0 0) 1e300)", "too large a number"));
  CHECK(says("(v-norm (make-3d-vector 1.7e308 1.7e308 1.7e308))", "too large a number"));
  CHECK(
      says("(let ((v (make-3d-vector 1e300 0 0))) (transform-point (make-transform "
           "(make-3d-vector 1.7e308 0 0) (make-identity-rotation)) (v* v 1.7e8)))",
           "too large a number"));
  CHECK(says("(rotate (make-quaternion 0 0 0 2) (make-3d-vector 1 0 0))", "`normalize` it first"));
  CHECK(says("(x *p1*)", "not a vector or a rotation"));
  CHECK(says("(origin (pose->transform *p1*))", "not a pose"));
  CHECK(says("(frame-id (make-identity-pose))", "not stamped"));
  CHECK(says("(copy-3d-vector (make-3d-vector 1 2 3) :q 1)", "not one of :x, :y, :z"));
  CHECK(says("(copy-3d-vector (make-3d-vector 1 2 3) :x)", "no value for `:x`"));
  CHECK(says("(transform* (make-identity-pose))", "`pose->transform` makes one of a pose"));
  CHECK(says("(list->pose '((1 2) (0 0 0 1)))", "three numbers and of four"));
}

TEST_CASE("poses: where a described location is, the robot knows") {
  const auto plan =
      unroll(prelude() +
             "(let ((at (desig:reference (desig:a location (on (desig:an object (name table)))))))"
             " (cl-transforms:y (cl-transforms:origin at)) (sig))");
  CHECK(plan.codes().empty());
  CHECK(plan.events("+") == Strings{"Signal()", "DONE"});
  CHECK(says("(< (y (origin (reference (a location (on (an object (name table))))))) 1)",
             "from `reference`, which only the robot knows"));
}

TEST_CASE("poses: long chains end, and come out the same twice") {
  const std::string chain =
      "(let ((tr (make-identity-transform)) (step (make-transform (make-3d-vector 0.001 0 0) "
      "(euler->quaternion :az 0.01)))) (dotimes (i 2000) (setf tr (transform* tr step))) " +
      going_to("(pose->pose-stamped \"map\" 0.0 (transform->pose tr))") + ")";
  const auto first = unroll(prelude() + chain);
  const auto second = unroll(prelude() + chain);
  REQUIRE(first.graph.has_value());
  CHECK(first.events("+") == second.events("+"));
  // A term that doubles with each step is shared, not copied; values beyond the limit are CPL051.
  const auto doubled = unroll(
      prelude() +
      "(let ((tr (pose->transform (robot-current-pose)))) (dotimes (i 200) (setf tr (transform* tr "
      "tr))) (sig))");
  CHECK(doubled.codes().empty());
  const auto endless = unroll(prelude() +
                              "(let ((v (make-3d-vector 0 0 0))) (dotimes (i 400000) (setf v (v+ v "
                              "(make-3d-vector 1 i 0)))) "
                              "(sig))");
  CHECK(endless.has("CPL051"));
}

}  // namespace
}  // namespace parallax::compiler
