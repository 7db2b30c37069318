#pragma once

#include <functional>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/interpreter/datum.h"
#include "tests/support/interpreter/world.h"

namespace parallax::test {

/// One pick: among the objects that a perform could return, or whose turn it is.
struct Pick {
  std::size_t chosen = 0;
  std::size_t choices = 0;
};

struct Ending {
  enum class Kind { kDone, kFailed, kHit, kBeyond };
  Kind kind = Kind::kDone;
  std::string text;  // kHit: the trace's key; kFailed: the class
};

/// Variables that a body sees, innermost last.
struct Scope {
  std::map<std::string, PlanItem> variables;
  std::map<std::string, const Datum*> functions;  // flet and labels: (name parameters body...)
  std::shared_ptr<Scope> functions_scope;         // the scope that these functions see
  std::shared_ptr<Scope> outer;
};
using ScopePtr = std::shared_ptr<Scope>;

/// One execution of a plan. Failures look for a handler before anything is unwound, as conditions
/// of Lisp do, but a task is left before the handlers around it are asked; jumps are C++
/// exceptions, so clean-ups run on their way.
class Evaluator {
 public:
  /// `program` and `world` outlive the evaluator. Picks beyond the given ones are the first choice.
  Evaluator(const std::vector<Datum>& program, World& world, int horizon, std::vector<Pick> picks,
            bool by_turns);
  Ending run();
  const std::vector<Pick>& picks() const { return picks_; }

 private:
  struct Block {
    std::string name;
    int id = 0;
  };

  struct Handler {
    const std::vector<Datum>* clauses = nullptr;  // ((class (e) body...) ...)
    bool task = false;                            // none: a task begins here
    ScopePtr scope;
    int id = 0;
    std::vector<Block> blocks;
  };

  struct Branch;
  struct Branches;
  struct Way;
  struct Place {
    std::vector<Handler> handlers;
    std::vector<Block> blocks;
    std::vector<std::pair<std::string, PlanItem>> specials;
    std::size_t task_specials = 0;
  };

  Ending ended(Ending ending) const;
  std::size_t pick(std::size_t choices);
  PlanItem taking_turns(const Datum& form, const ScopePtr& scope, bool pursue);
  PlanItem turns_of(Branches& all);
  void start(Branches& all, const Datum& form, const ScopePtr& scope);
  void resume(Branch& branch);
  void note(Branches& all, Branch& branch) const;
  void end_all(Branches& all);
  void yield(Branch& branch);
  void wait_for_turn(bool asks = false);
  Place place() const;
  void restore(const Place& place);
  PlanItem eval(const Datum& form, const ScopePtr& scope);
  PlanItem body(const std::vector<Datum>& forms, std::size_t from, const ScopePtr& scope);
  PlanItem list_form(const Datum& form, const ScopePtr& scope);
  bool control(const Datum& form, const ScopePtr& scope, PlanItem& out);
  bool binding(const Datum& form, const ScopePtr& scope, PlanItem& out);
  bool loops(const Datum& form, const ScopePtr& scope, PlanItem& out);
  bool failures(const Datum& form, const ScopePtr& scope, PlanItem& out);
  bool acting(const Datum& form, const ScopePtr& scope, PlanItem& out);
  PlanItem call(const Datum& form, const ScopePtr& scope);
  PlanItem builtin(const std::string& name, const std::vector<PlanItem>& arguments);
  PlanItem apply(const std::vector<Datum>& parameters, const std::vector<Datum>& forms,
                 std::size_t from, const std::vector<PlanItem>& arguments, const ScopePtr& outer,
                 const std::string& name);
  PlanItem in_task(const std::function<PlanItem()>& run);
  PlanItem rebinding(const std::function<PlanItem()>& run);
  PlanItem in_block(const std::string& name, const std::function<PlanItem()>& run);
  PlanItem loop_form(const Datum& form, const ScopePtr& scope);
  PlanItem handling(const std::vector<Datum>& clauses, const Datum& form, std::size_t from,
                    const ScopePtr& scope);
  PlanItem attempt(const Datum& form, const ScopePtr& scope);
  PlanItem cleaned_up(const Datum& form, const ScopePtr& scope);
  PlanItem designator(const Datum& form, const ScopePtr& scope);
  PlanItem designator_value(const Datum& datum, const ScopePtr& scope);
  PlanItem perform(const PlanItem& what);
  [[noreturn]] void signal(const std::string& failure);
  const Datum& clause_called(const std::vector<Datum>& clauses, const std::string& name) const;
  bool below(std::string failure, const std::string& ancestor) const;
  void set(const Datum& place, PlanItem value, const ScopePtr& scope);
  PlanItem* find(const std::string& name, const ScopePtr& scope);

  World& world_;
  int horizon_;
  std::vector<Pick> picks_;
  std::size_t next_pick_ = 0;
  int time_ = 0;
  int steps_ = 0;
  std::string key_;
  ScopePtr globals_;
  std::map<std::string, const Datum*> functions_;
  std::map<std::string, std::string> parents_;  // of failure classes
  std::vector<const Datum*> main_;
  std::vector<Handler> handlers_;                           // active ones, innermost last
  std::vector<std::pair<std::string, PlanItem>> specials_;  // rebound by `let`, innermost last
  std::size_t task_specials_ = 0;                           // where those of this task begin
  std::vector<Block> blocks_;  // of the function that runs, innermost last
  int next_id_ = 0;
  bool by_turns_ = false;
  Branch* running_ = nullptr;  // none: not in a branch
};

}  // namespace parallax::test
