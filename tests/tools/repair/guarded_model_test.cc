// An edit that is switched on in the guarded model, and the same edit made in the text, are one.

#include "compiler/repair/guarded_model.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/repair/edit_text.h"
#include "compiler/sema/check.h"
#include "runtime/compare/trace_difference.h"
#include "tools/repair/domain_model.h"

namespace parallax::tools {
namespace {

using compiler::Edit;

constexpr const char* kModel = R"(
sort drawer
drawer top, low
fluent Open(drawer)
fluent Parked()
sort part
part bolt
fluent Held(part,drawer)
event Pull(drawer)
event Park()
[drawer,time]
  HoldsAt(Parked(),time) & !HoldsAt(Open(drawer),time) -> Initiates(Pull(drawer),Open(drawer),time).
[drawer,time] Terminates(Pull(drawer),Parked(),time).
[drawer,time] Happens(Pull(drawer),time) -> !HoldsAt(Open(drawer),time).
[time] Initiates(Park(),Parked(),time).
)";

std::string switched(const std::string& guarded, std::size_t edits,
                     const std::set<std::size_t>& on) {
  auto out = guarded;
  for (std::size_t i = 0; i < edits; ++i) {
    out += (on.contains(i) ? "" : "!") + compiler::edit_predicate(i) + "().\n";
  }
  return out;
}

/// Doors are places, and only they are open or not: of another place `Open(place)` has no instance.
constexpr const char* kSubsort = R"(
sort place
sort door: place
place hall
door front, back
fluent At(place)
fluent Open(door)
fluent Lit(place)
event Go(place)
[place,time] HoldsAt(Lit(place),time) -> Initiates(Go(place),At(place),time).
[place,time] HoldsAt(Open(place),time) -> Terminates(Go(place),Lit(place),time).
)";

TEST_CASE("a switched condition about things of a subsort leaves other things alone") {
  DomainModel domain;
  base::DiagnosticSink sink;
  auto ast =
      compiler::load_model_text(domain.files.add("m.e", kSubsort), ".", {}, domain.files, sink);
  REQUIRE(ast);
  domain.ast = *std::move(ast);
  compiler::CheckOptions check;
  check.time_lower = 0;
  check.time_upper = 1;
  auto typed = compiler::check_model(domain.ast, domain.files, sink, check);
  REQUIRE(typed);
  domain.forms = compiler::axiom_forms(domain.ast, domain.files);
  using Literal = compiler::ConditionLiteral;
  const auto about = [](const char* fluent, bool negated) {
    return Literal{Literal::Kind::kFluent,
                   negated,
                   fluent,
                   {{compiler::LiteralArgument::Kind::kVariable, "place"}}};
  };
  std::vector<Edit> edits;
  const auto edit = [&](Edit::Kind kind, std::vector<std::size_t> axioms) -> Edit& {
    auto& out = edits.emplace_back();
    out.kind = kind;
    out.axioms = std::move(axioms);
    out.event = "Go";
    return out;
  };
  for (const bool negated : {false, true}) {
    edit(Edit::Kind::kNarrow, {0}).literal = about("Open", negated);
    auto& event = edit(Edit::Kind::kNarrowEvent, {0, 1});
    event.variables = {"place"};
    event.literal = about("Lit", false);
    event.or_else = about("Open", negated);
    auto& replace = edit(Edit::Kind::kReplace, {0});
    replace.node = domain.forms[0].conjuncts.front();
    replace.literal = about("Open", negated);
    replace.text = compiler::print(*replace.literal, "time", {});
  }
  edit(Edit::Kind::kDropCondition, {1}).node = domain.forms[1].conjuncts.front();
  const compiler::EditText texts(domain.ast, domain.files, domain.forms, edits);
  const auto guarded =
      compiler::guarded_text(domain.ast, *typed, domain.files, domain.forms, edits);
  const Context context;
  const auto same = [&](const std::string& a, const std::string& b) {
    std::string why;
    const auto first = compile_text(a, 1, context, why);
    CAPTURE(why);
    REQUIRE(first);
    const auto second = compile_text(b, 1, context, why);
    REQUIRE(second);
    const auto difference = runtime::compare_traces(*first, *second, {});
    CHECK(difference.lost.answer == runtime::DifferenceAnswer::kNone);
    CHECK(difference.gained.answer == runtime::DifferenceAnswer::kNone);
  };
  same(switched(guarded, edits.size(), {}), kSubsort);
  for (std::size_t i = 0; i < edits.size(); ++i) {
    CAPTURE(texts.words({i}));
    same(switched(guarded, edits.size(), {i}),
         compiler::flat_text(domain.ast, domain.files, texts.changes({i})));
  }
}

TEST_CASE("every edit of a model, switched on and written") {
  DomainModel domain;
  base::DiagnosticSink sink;
  auto ast =
      compiler::load_model_text(domain.files.add("m.e", kModel), ".", {}, domain.files, sink);
  REQUIRE(ast);
  domain.ast = *std::move(ast);
  compiler::CheckOptions check;
  check.time_lower = 0;
  check.time_upper = 1;
  auto typed = compiler::check_model(domain.ast, domain.files, sink, check);
  REQUIRE(typed);
  domain.forms = compiler::axiom_forms(domain.ast, domain.files);
  compiler::EditScope scope;
  scope.open_outcomes = true;
  scope.steps.push_back({"Pull(top)",
                         true,
                         true,
                         {{"Open(top)", false}, {"Open(low)", false}, {"Parked()", true}},
                         {{"Open(top)", false}, {"Parked()", true}},
                         {{"Park()", 1, {"Open(top)"}}, {"Pull(low)", 2, {"Open(top)"}}}});
  // Two fluents that have to do with each other changed at once.
  scope.steps.push_back({"Park()",
                         false,
                         false,
                         {{"Held(bolt,low)", true}, {"Open(low)", false}, {"Open(top)", false}},
                         {{"Held(bolt,low)", false}, {"Open(low)", true}},
                         {}});
  const auto edits = compiler::edits_in_scope(domain.ast, *typed, domain.forms, scope);
  const compiler::EditText texts(domain.ast, domain.files, domain.forms, edits);
  const auto guarded =
      compiler::guarded_text(domain.ast, *typed, domain.files, domain.forms, edits);
  const Context context;
  const auto same = [&](const std::string& a, const std::string& b) {
    std::string why;
    const auto first = compile_text(a, 2, context, why);
    CAPTURE(why);
    REQUIRE(first);
    const auto second = compile_text(b, 2, context, why);
    REQUIRE(second);
    const auto difference = runtime::compare_traces(*first, *second, {});
    CHECK(difference.lost.answer == runtime::DifferenceAnswer::kNone);
    CHECK(difference.gained.answer == runtime::DifferenceAnswer::kNone);
  };
  same(switched(guarded, edits.size(), {}), kModel);
  std::set<Edit::Kind> kinds;
  std::size_t conditions = 0;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    std::vector<std::size_t> set = {i};
    if (edits[i].kind == Edit::Kind::kAddCondition) {
      if (++conditions % 5 != 0) continue;  // they are many, and alike
      set.insert(set.begin(), edits[i].of);
    }
    kinds.insert(edits[i].kind);
    CAPTURE(texts.words(set));
    same(switched(guarded, edits.size(), {set.begin(), set.end()}),
         compiler::flat_text(domain.ast, domain.files, texts.changes(set)));
  }
  CHECK(kinds.size() == 10);
  // Without contradictions only events that the world refused, and that can happen, are left open,
  // if asked for.
  const auto opened = [&](bool refused, bool not_possible) {
    scope.open_outcomes = false;
    scope.open_refused = refused;
    scope.steps.front().not_possible = not_possible;
    const auto others = compiler::edits_in_scope(domain.ast, *typed, domain.forms, scope);
    return std::count_if(others.begin(), others.end(),
                         [](const Edit& edit) { return edit.kind == Edit::Kind::kOpenEvent; });
  };
  CHECK(opened(true, false) == 1);
  CHECK(opened(true, true) == 0);
  CHECK(opened(false, false) == 0);
  const auto bundle = std::find_if(edits.begin(), edits.end(), [](const auto& edit) {
    return edit.text ==
           "Terminates(Park(),Held(part,drawer),time) & "
           "Initiates(Park(),Open(drawer),time)";
  });
  REQUIRE(bundle != edits.end());
  CHECK(compiler::print(bundle->given.front(), "time", {}) == "HoldsAt(Held(part,drawer),time)");
}

}  // namespace
}  // namespace parallax::tools
