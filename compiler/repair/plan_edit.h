#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/repair/axiom_form.h"
#include "compiler/repair/plan_text.h"

namespace parallax::compiler {

/// One change of a plan's text.
struct PlanEdit {
  enum class Kind : std::uint8_t {
    kInsert,  // `action` in front of the statement `at`
    kMove,    // the statement `moved` goes in front of `at`
    kGuard,   // `at` is done only where `condition` holds
    kRetry,   // `at` is tried again where it fails with `failure`
    kHandle,  // ... the plan goes on behind it
  };
  Kind kind = Kind::kInsert;
  DatumId at;
  std::string action;     // on one line
  std::string condition;  // kInsert: nothing is done elsewhere; may be empty
  std::optional<DatumId> moved;
  std::string failure;  // a failure class
  int oddity = 0;       // less is tried first
};

/// How often kRetry tries again.
inline constexpr int kPlanRetries = 3;

/// The edits as changes of the texts: comments and layout stay.
std::vector<TextChange> plan_changes(const PlanText& plan, const std::vector<PlanEdit>& edits);

/// A sentence without its period: "`(perform ...)` is inserted in front of `(park-arms)`
/// (plan2.lisp:59)".
std::string plan_edit_words(const PlanText& plan, const PlanEdit& edit);

/// Takes a statement or a clause away together with the blanks in front of it.
TextChange statement_dropped(const PlanText& plan, DatumId form);
/// The form as written, on one line and not too long, with its place.
std::string form_words(const PlanText& plan, DatumId form);

/// A plan that has all edits in it, each behind a question of its own: edit number i is made where
/// the fluent plan_edit_fluent(i) holds. Conditions of insertions are left out.
struct GuardedPlan {
  struct Part {
    std::string file;
    std::size_t begin = 0, end = 0;  // in the guarded text
  };
  std::map<std::string, std::string> files;  // by name
  std::vector<std::vector<Part>> parts;      // by edit
};
GuardedPlan guarded_plan(const PlanText& plan, const std::vector<PlanEdit>& edits);
std::string plan_edit_fluent(std::size_t edit);  // "PlanEdit7"

/// How a plan writes the name of a fluent or constant: `DrawerOpen` is `drawer-open`.
std::string plan_name(const std::string& model_name);
/// `(holds '(drawer-open d-mid))` for "DrawerOpen(dMid)"; `(not ...)` where it does not hold.
std::string plan_condition(const std::string& fluent, bool holds);

}  // namespace parallax::compiler
