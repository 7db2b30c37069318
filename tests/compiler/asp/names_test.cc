#include "compiler/asp/term_writer.h"
#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

using compiler::AspNames;

TEST_CASE("names become identifiers with a small letter, and no two things share one") {
  const CheckedText checked(
      "sort box\nbox Step, Box, Not\nfluent Box_(box)\nevent _Go(box)\nrange time 0 1\n");
  REQUIRE_MESSAGE(checked.model, checked.text());
  const auto& model = *checked.model;
  AspNames names(model);
  CHECK(names.sort(*model.find_sort("box")) == "box");
  CHECK(names.symbol(*model.find_symbol("Box_")) == "box_");
  CHECK(names.object(*model.find_object("Box")) == "box__");   // the sort and the fluent came first
  CHECK(names.object(*model.find_object("Step")) == "step_");  // a predicate of the program
  CHECK(names.object(*model.find_object("Not")) == "not_");    // clingo's own word
  CHECK(names.symbol(*model.find_symbol("_Go")) == "_go");
  CHECK(names.symbol(*model.core.holds_at) == "holds_at");
}

TEST_CASE("a fresh name is an identifier and is given once") {
  const CheckedText checked("fluent F()\nrange time 0 1\n");
  REQUIRE_MESSAGE(checked.model, checked.text());
  AspNames names(*checked.model);
  CHECK(names.fresh("reason") == "reason");
  CHECK(names.fresh("reason") == "reason_");
  CHECK(names.fresh("1st-try") == "x1st_try");
  CHECK(names.fresh("") == "x");
}

TEST_CASE("what clingo prints is read back in the model's spelling") {
  const CheckedText checked(
      "sort box\nbox Red\nsort n: integer\nrange n 1 3\nfluent On(box,n)\nfluent Idle()\n"
      "range time 0 1\n");
  REQUIRE_MESSAGE(checked.model, checked.text());
  const AspNames names(*checked.model);
  CHECK(names.original("on(red,3)") == "On(Red,3)");
  CHECK(names.original("idle") == "Idle()");
  CHECK(names.original("unheard_of(red)") == "unheard_of(Red)");
}

}  // namespace
}  // namespace parallax::test
