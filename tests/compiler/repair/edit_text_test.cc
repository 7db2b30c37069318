// Edits as changes of a text: they leave the rest alone, and the new formula has the intended
// meaning.

#include "compiler/repair/edit_text.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "compiler/repair/guarded_model.h"
#include "compiler/sema/check.h"

namespace parallax::compiler {
namespace {

constexpr const char* kModel = R"(; A drawer, and an arm.
sort drawer
drawer top, low
fluent Open(drawer)
fluent Parked()
event Pull(drawer)
event Park()

; Pulling needs a parked arm.
[drawer,time]
  HoldsAt(Parked(),time) & ; parked
  !HoldsAt(Open(drawer),time) ->
    Initiates(Pull(drawer),Open(drawer),time).
[time] Initiates(Park(),Parked(),time).  ; what parking is for
(HoldsAt(Parked(),0) | HoldsAt(Open(top),0)).
[drawer,time] (HoldsAt(Open(drawer),time) | HoldsAt(Parked(),time)) -> Terminates(Pull(drawer),Parked(),time).
)";

struct Parsed {
  base::SourceFiles files;
  ModelAst ast;
  std::vector<AxiomForm> forms;
  std::optional<TypedModel> typed;

  Parsed() {
    base::DiagnosticSink sink;
    auto loaded = load_model_text(files.add("m.e", kModel), ".", {}, files, sink);
    REQUIRE(loaded);
    ast = *std::move(loaded);
    forms = axiom_forms(ast, files);
    CheckOptions check;
    check.time_lower = 0;
    check.time_upper = 2;
    auto checked = check_model(ast, files, sink, check);
    REQUIRE(checked);
    typed = *std::move(checked);
  }
  std::string after(const Edit& edit) const {
    const std::vector<Edit> edits = {edit};
    const EditText text(ast, files, forms, edits);
    const auto changes = text.changes({0});
    return changed_text(kModel, ast.ast(ast.order.back()).file(), changes);
  }
};

Edit narrow(std::size_t axiom, const std::string& fluent, std::vector<LiteralArgument> arguments) {
  Edit edit;
  edit.axioms = {axiom};
  edit.literal = {ConditionLiteral::Kind::kFluent, true, fluent, std::move(arguments)};
  return edit;
}

std::string without(const std::string& text, const std::string& part) {
  auto out = text;
  REQUIRE(out.find(part) != std::string::npos);
  return out.erase(out.find(part), part.size());
}

TEST_CASE("the forms of a model: effects, and nothing that is none") {
  const Parsed model;
  REQUIRE(model.forms.size() == 3);
  CHECK(model.forms[0].event_symbol == "Pull");
  CHECK(model.forms[0].conjuncts.size() == 2);
  CHECK(model.forms[1].event_symbol == "Park");
  CHECK_FALSE(model.forms[1].condition);
  CHECK(model.forms[2].time == "time");
}

TEST_CASE("a condition goes behind the others, on a line where they have lines") {
  const Parsed model;
  const std::string added = " &\n  !HoldsAt(Open(top),time)";
  const auto text = model.after(narrow(0, "Open", {{LiteralArgument::Kind::kConstant, "top"}}));
  CHECK(without(text, added) == kModel);
  CHECK(text.find("!HoldsAt(Open(drawer),time)" + added + " ->") != std::string::npos);
}

TEST_CASE("the first condition brings its arrow, and a disjunction its parentheses") {
  const Parsed model;
  const auto first = model.after(narrow(1, "Open", {{LiteralArgument::Kind::kSome, "drawer"}}));
  CHECK(without(first, "!({drawer} HoldsAt(Open(drawer),time)) -> ") == kModel);
  const auto second = model.after(narrow(2, "Parked", {}));
  CHECK(second.find("| HoldsAt(Parked(),time)) &\n  !HoldsAt(Parked(),time) -> Term") !=
        std::string::npos);
}

TEST_CASE("a condition and an axiom go with what belongs to them alone") {
  const Parsed model;
  Edit edit;
  edit.kind = Edit::Kind::kDropCondition;
  edit.axioms = {0};
  edit.node = model.forms[0].conjuncts[1];
  CHECK(model.after(edit).find("HoldsAt(Parked(),time) ->\n    Initiates(Pull") !=
        std::string::npos);
  edit.node = model.forms[2].conjuncts[0];
  edit.axioms = {2};
  CHECK(model.after(edit).find("[drawer,time] Terminates(Pull(drawer),Parked(),time).") !=
        std::string::npos);
  edit.kind = Edit::Kind::kDropAxiom;
  edit.axioms = {1};
  // The comment behind it is somebody's; the line stays.
  CHECK(without(kModel, "[time] Initiates(Park(),Parked(),time).") == model.after(edit));
}

TEST_CASE("a new axiom stands behind the last one of its event") {
  const Parsed model;
  Edit edit;
  edit.kind = Edit::Kind::kAddEffect;
  edit.event = "Park";
  edit.text = "Terminates(Park(),Open(drawer),time)";
  edit.variables = {"drawer"};
  const auto text = model.after(edit);
  CHECK(without(text, "\n[drawer,time] Terminates(Park(),Open(drawer),time).") == kModel);
}

TEST_CASE("literals: variables, constants, one of them; equations; not the calculus itself") {
  const Parsed model;
  const std::vector<SortedVariable> variables = {{"drawer", *model.typed->find_sort("drawer")}};
  std::vector<std::string> texts;
  for (const auto& literal : condition_literals(*model.typed, variables, 100)) {
    texts.push_back(print(literal, "time", {"drawer", "time"}));
  }
  for (const std::string wanted :
       {"HoldsAt(Open(drawer),time)", "!HoldsAt(Open(top),time)", "drawer!=low",
        "!({drawer1} HoldsAt(Open(drawer1),time))", "!HoldsAt(Parked(),time)"}) {
    CAPTURE(wanted);
    CHECK(std::count(texts.begin(), texts.end(), wanted) == 1);
  }
  CHECK(texts.size() == 14);
}

TEST_CASE("patterns of atoms") {
  CHECK(matches("F(a,b)", "F(a,b)"));
  CHECK(matches("F(a,b)", "F(*,b)"));
  CHECK(matches("F(g(a,c),b)", "F(*,b)"));
  CHECK_FALSE(matches("F(a,c)", "F(*,b)"));
  CHECK_FALSE(matches("F(a)", "F(a,*)"));
  CHECK(arguments_of("G(f(a,b),c)") == std::vector<std::string>{"f(a,b)", "c"});
  CHECK(arguments_of("G()").empty());
}

}  // namespace
}  // namespace parallax::compiler
