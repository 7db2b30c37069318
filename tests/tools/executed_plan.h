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

}  // namespace parallax::test
