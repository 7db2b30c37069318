#pragma once

#include <string>

#include "tests/tools/two_models.h"

namespace parallax::test {

/// Opening succeeds unless the drawer sticks; whether it does, nothing shows.
inline const std::string kSticks =
    "load domain.e\nfluent Sticks()\n"
    "[drawer,time] !HoldsAt(Sticks(),time) -> Initiates(OpenDrawer(drawer),Open(drawer),time).\n";
/// The same, anew at every timepoint.
inline const std::string kSticksAtTimes = kSticks + "noninertial Sticks\n";

/// Parks if it has to; opens the drawer, if that fails once more; closes it if it is open.
inline const std::string kPlan = R"((def-cram-function open-it ()
  (unless (holds '(parked)) (perform (an action (type parking-arms))))
  (with-retry-counters ((tries 1))
    (with-failure-handling
        ((manipulation-low-level-failure (e) (do-retry tries (retry)) (return nil)))
      (perform (an action (type opening) (object (an object (name top)))))))
  (when (holds (list 'open 'top))
    (perform (an action (type closing) (object (an object (name top)))))))
(open-it)
)";

/// A scenario with this model, plan and world, executed in closed loop.
inline std::string executed(const TwoModels& cli, const std::string& model, const std::string& plan,
                            const std::string& world, const std::string& more = "") {
  cli.write("two/model.e", model);
  cli.write("two/plan.lisp", plan);
  cli.write("two/world.e", world);
  cli.write("two/own.yaml",
            "include: common.yaml\nsimulator: {model: world.e}\nexecution: closed-loop\n"
            "model: [model.e, start.e]\nplan: plan.lisp\n" +
                more);
  return "two/own.yaml";
}

/// A folder for such plans: the drawer is shut at first, a plan can ask whether it is open, and the
/// mapping covers sticking and parking.
class ExecutedRuns : public TwoModels {
 public:
  ExecutedRuns() {
    write("two/start.e", "[drawer] !HoldsAt(Open(drawer),0).\n");
    write("two/robot.bind", read("two/robot.bind") + "query open (?d) ok: Open(?d) @t\n");
  }
  std::string scenario(const std::string& model, const std::string& plan, const std::string& world,
                       const std::string& more = "") const {
    return executed(
        *this, model, plan, world,
        "mapping: {Sticks(): ignored, Parked(): {flag: \"Parked()\", drawn: true}}\n" + more);
  }
};

}  // namespace parallax::test
