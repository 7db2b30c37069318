// Edits of a plan's text: the intended part changes, and nothing else.

#include "compiler/repair/plan_edit.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace parallax::test {
namespace {

using compiler::DatumId;
using compiler::PlanEdit;
using compiler::PlanText;

const std::string kPlan =
    ";; Takes a box away.\n"
    "(defparameter *away* (make-pose 1 2))\n"
    "\n"
    "(defun open-up (?drawer)\n"
    "  (exe:perform (desig:an action (type opening) (object (desig:an object (name ?drawer))))))\n"
    "\n"
    "(def-cram-function fetch (?box)\n"
    "  (dolist (?drawer '(:d-top :d-low))\n"
    "    (open-up ?drawer)  ; may stick\n"
    "    ;; What is open is closed again.\n"
    "    (exe:perform (desig:an action (type closing)\n"
    "                           (object (desig:an object (name ?drawer))))))\n"
    "  (exe:perform (desig:an action (type picking-up) (object ?box)))\n"
    "  (exe:perform (desig:a motion (type going) (target *away*))))\n"
    "\n"
    "(fetch :box)\n";

struct Text {
  base::SourceFiles files;
  base::FileId file = files.add("p.lisp", kPlan);
  PlanText plan = *PlanText::read(files, std::span(&file, 1));

  DatumId form(const std::string& text) const {
    const auto begin = kPlan.find(text);
    REQUIRE(begin != std::string::npos);
    std::size_t end = begin, open = 0;
    do {
      if (kPlan[end] == '(') ++open;
      if (kPlan[end] == ')') --open;
      ++end;
    } while (open > 0);
    return *plan.form_at(
        {file, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)});
  }
  std::string edited(const PlanEdit& edit) const {
    return compiler::changed_text(kPlan, file, compiler::plan_changes(plan, {edit}));
  }
  /// The plan with one part replaced.
  static std::string with(const std::string& from, const std::string& to) {
    auto out = kPlan;
    const auto at = out.find(from);
    REQUIRE(at != std::string::npos);
    return out.replace(at, from.size(), to);
  }
};

const std::string kPick = "(exe:perform (desig:an action (type picking-up) (object ?box)))";
const std::string kGo = "(exe:perform (desig:a motion (type going) (target *away*)))";

TEST_CASE("an insertion stands on a line of its own in front of the statement") {
  const Text text;
  PlanEdit edit;
  edit.at = text.form(kGo);
  edit.action = "(park)";
  CHECK(text.edited(edit) == Text::with(kGo, "(park)\n  " + kGo));
  edit.condition = compiler::plan_condition("DrawerOpen(dTop)", true);
  CHECK(text.edited(edit) ==
        Text::with(kGo, "(when (holds '(drawer-open d-top))\n    (park))\n  " + kGo));
}

TEST_CASE("an action that is too long for a line is broken between parts of its designator") {
  const Text text;
  PlanEdit edit;
  edit.at = text.form(kGo);
  edit.action =
      "(exe:perform (desig:an action (type closing) (arm left) (object (desig:an object (type "
      "container) (name the-one-below-the-counter)))))";
  CHECK(
      text.edited(edit) ==
      Text::with(kGo,
                 "(exe:perform (desig:an action (type closing) (arm left)\n"
                 "                                (object (desig:an object (type container) (name "
                 "the-one-below-the-counter)))))\n  " +
                     kGo));
}

TEST_CASE("a guard, a retry and a handler go around a statement and move its further lines") {
  const Text text;
  const auto close =
      "(exe:perform (desig:an action (type closing)\n"
      "                           (object (desig:an object (name ?drawer)))))";
  PlanEdit edit;
  edit.kind = PlanEdit::Kind::kGuard;
  edit.at = text.form(close);
  edit.condition = compiler::plan_condition("Locked()", false);
  CHECK(text.edited(edit) ==
        Text::with(close,
                   "(unless (holds '(locked))\n"
                   "      (exe:perform (desig:an action (type closing)\n"
                   "                             (object (desig:an object (name ?drawer))))))"));
  edit.kind = PlanEdit::Kind::kRetry;
  edit.at = text.form(kPick);
  edit.failure = "gripper-low-level-failure";
  CHECK(text.edited(edit) ==
        Text::with(kPick,
                   "(with-retry-counters ((tries 3))\n"
                   "    (with-failure-handling\n"
                   "        ((gripper-low-level-failure (e) (do-retry tries (retry))))\n"
                   "      " +
                       kPick + "))"));
  edit.kind = PlanEdit::Kind::kHandle;
  CHECK(text.edited(edit) == Text::with(kPick,
                                        "(with-failure-handling\n"
                                        "      ((gripper-low-level-failure (e) (return)))\n"
                                        "    " +
                                            kPick + ")"));
}

TEST_CASE("a moved statement leaves its comment and no empty line") {
  const Text text;
  PlanEdit edit;
  edit.kind = PlanEdit::Kind::kMove;
  edit.at = text.form("(dolist");
  edit.moved = text.form(kPick);
  auto expected = Text::with("\n  " + kPick, "");
  expected.replace(expected.find("(dolist"), 7, kPick + "\n  (dolist");
  CHECK(text.edited(edit) == expected);
  // Behind a comment the line goes, not the comment's end.
  edit.at = text.form("(open-up ?drawer)  ;");
  edit.moved = text.form("(exe:perform (desig:an action (type closing)");
  const auto moved = text.edited(edit);
  CHECK(moved.find("    ;; What is open is closed again.\n") != std::string::npos);
  CHECK(moved.find("(name ?drawer)))))\n    (open-up ?drawer)  ; may stick\n") !=
        std::string::npos);
}

TEST_CASE(
    "what can be done at a place: variables that cannot be read there get the plan's values") {
  const Text text;
  std::set<std::string> found;
  for (const auto& action : text.plan.actions_for(text.form(kGo))) found.insert(action.text);
  CHECK(found.contains("(open-up :d-top)"));
  CHECK(found.contains(
      "(exe:perform (desig:an action (type closing) (object (desig:an object (name :d-low)))))"));
  CHECK(found.contains(kPick));
  for (const auto& action : found) CHECK(action.find("?drawer") == std::string::npos);
  // Inside the loop the variable itself can be read. The plan does not call itself.
  found.clear();
  for (const auto& action : text.plan.actions_for(text.form("(open-up ?drawer)  ;"))) {
    found.insert(action.text);
  }
  CHECK(found.contains("(open-up ?drawer)"));
  CHECK_FALSE(found.contains("(fetch :box)"));
}

TEST_CASE("the guarded plan says all edits, and where each of them stands") {
  const Text text;
  std::vector<PlanEdit> edits(3);
  edits[0].at = edits[1].at = text.form(kGo);
  edits[0].action = "(park)";
  edits[1].kind = PlanEdit::Kind::kHandle;
  edits[1].failure = "plan-failure";
  edits[2].kind = PlanEdit::Kind::kMove;
  edits[2].at = text.form(kGo);
  edits[2].moved = text.form(kPick);
  const auto guarded = compiler::guarded_plan(text.plan, edits);
  const auto& plan = guarded.files.at("p.lisp");
  CHECK(plan.find("(when (holds '(plan-edit0)) (park)\n)") != std::string::npos);
  CHECK(plan.find("(when (holds '(plan-edit1)) (return))") != std::string::npos);
  CHECK(plan.find("(unless (holds '(plan-edit2)) " + kPick) != std::string::npos);
  REQUIRE(guarded.parts[0].size() == 1);
  const auto& part = guarded.parts[0].front();
  CHECK(plan.substr(part.begin, part.end - part.begin).find("(park)") != std::string::npos);
  CHECK(std::count(plan.begin(), plan.end(), '(') == std::count(plan.begin(), plan.end(), ')'));
}

}  // namespace
}  // namespace parallax::test
