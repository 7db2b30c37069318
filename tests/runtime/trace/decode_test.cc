#include <doctest/doctest.h>

#include "runtime/trace/trace.h"

namespace parallax::test {
namespace {

using compiler::AtomKind;
using compiler::PlanChoiceId;
using compiler::PlanStepId;

/// A plan of one step; atoms of its control at timepoint 0 are true.
compiler::CompiledModel one_step() {
  compiler::CompiledModel model;
  model.horizon = 1;
  model.plan = {{"Go(r1)", {}, {}, {}, {}}};
  return model;
}

runtime::Trace decoded(const compiler::CompiledModel& model) {
  return runtime::decode_trace(model, runtime::symbols_of(model), 1,
                               [](compiler::Literal) { return true; });
}

TEST_CASE("a choice that is taken at a timepoint does not hide the step that is performed there") {
  auto model = one_step();
  model.fixed = {{AtomKind::kLocation, "", 0, PlanStepId(0)},
                 {AtomKind::kLocation, "", 0, PlanChoiceId(0)}};
  CHECK(decoded(model).points[0].plan_step == 0);
  std::swap(model.fixed[0], model.fixed[1]);
  CHECK(decoded(model).points[0].plan_step == 0);
}

TEST_CASE("a trace shows what a perform returned and what the plan still knows of it") {
  auto model = one_step();
  model.fixed = {{AtomKind::kSucceeded, "", 1, PlanStepId(0)},
                 {AtomKind::kResult, "", 1, compiler::ReturnedObject{"cup1"}},
                 {AtomKind::kRegister, "", 1, compiler::RegisterValue{"?x", "cup1"}}};
  const auto trace = decoded(model);
  CHECK(trace.points[0].succeeded);
  CHECK(trace.points[0].returned == "cup1");
  CHECK(trace.points[1].registers == std::map<std::string, std::string>{{"?x", "cup1"}});
}

TEST_CASE("a step beyond the plan is none") {
  auto model = one_step();
  model.fixed = {{AtomKind::kLocation, "", 0, PlanStepId(1)}};
  CHECK_FALSE(decoded(model).points[0].plan_step);
}

}  // namespace
}  // namespace parallax::test
