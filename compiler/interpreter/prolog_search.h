#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/builtins/designator_links.h"
#include "compiler/interpreter/fact_base.h"
#include "compiler/interpreter/prolog_terms.h"
#include "compiler/plan/formula_tree.h"

namespace parallax::compiler {

/// One way in which the model can answer a goal: what must hold, and what its free variables stand
/// for then, in the order of the arguments.
struct ModelWay {
  FormulaTree guard;
  std::string name;
  std::vector<ValueId> bound;
  bool elsewhere = false;  // another order of the answers takes it: here it can only not hold
};

/// Question that only the model can answer. The answer is 0 if none of the ways holds, else the
/// number of one that does, counted from 1. Without ways: other answers cover all that could follow
/// from these.
struct ProofQuestion {
  std::vector<ModelWay> ways;
};
struct ProofSolved {
  PrologTermId goal;  // as it was proved
};
struct ProofNone {};  // no (further) solution
struct ProofFailed {
  ValueId failure;
};                     // a function of the plan failed
struct ProofError {};  // reported
using ProofStop = std::variant<ProofSolved, ProofNone, ProofQuestion, ProofFailed, ProofError>;

/// The answers so far, in the order of the questions. A proof is run again from its start with one
/// answer more: it asks the same questions again, since it depends on nothing else.
struct ProofAnswers {
  std::span<const std::uint32_t> given;
  std::size_t next = 0;
  std::map<std::string, bool, std::less<>> known;  // by formula: its value according to the answers

  /// The formula's value according to the answers; none: they do not tell.
  std::optional<bool> said(const FormulaTree& guard) const;
  /// The answer to the question; none: it was not given yet. What is known is not asked again.
  std::optional<std::uint32_t> take(std::span<const ModelWay> ways);
};

/// The plan and the model as a proof sees them.
class ProofWorld {
 public:
  ProofWorld() = default;
  ProofWorld(const ProofWorld&) = delete;
  ProofWorld& operator=(const ProofWorld&) = delete;
  virtual ~ProofWorld() = default;
  /// Is it a query of the binding table?
  virtual bool is_query(std::string_view name, std::size_t arguments) = 0;
  /// The ways in which it can hold, free variables being those without value; none: reported.
  virtual std::optional<std::vector<ModelWay>> ways(
      std::string_view name, std::span<const std::optional<ValueId>> arguments, DatumId at) = 0;
  /// A function of the plan or a built-in; the value is the goal of ProofSolved.
  struct Value {
    ValueId value;
  };
  struct LispError {};
  using Computed = std::variant<Value, LispError, ProofQuestion, ProofFailed, ProofError>;
  virtual Computed call(const std::string& function, const std::vector<ValueId>& arguments,
                        DatumId at, ProofAnswers& answers) = 0;
  virtual DesignatorLinks& links() = 0;
  /// No predicate of this name; reports it.
  virtual void unknown(std::string_view name, std::size_t arguments, DatumId at) = 0;
  virtual void report(DatumId at, std::string_view what, std::string_view text) = 0;
  /// Counts a step; false beyond the limit, or if the terms are exhausted, reported.
  virtual bool spend(DatumId at, bool exhausted) = 0;
};

/// Proves goals by the clauses of a plan, depth first and in written order, as CRAM's Prolog does:
/// control (`and`, `or`, `not`, `->`, `once`, `cut` ...), the predicates of prolog_goals.cc,
/// queries of the binding table, then clauses. No recursion; the cost is bounded by `spend`.
class ProofSearch {
 public:
  ProofSearch(const FactBase& facts, ProofWorld& of_plan, ValueStore& store, ProofAnswers& answers)
      : terms(store), values(store), world(of_plan), facts_(facts), answers_(answers) {}

  /// The first solution of the goal, which stands at `at`.
  ProofStop first(PrologTermId goal, DatumId at);

  TermStore terms;
  ValueStore& values;
  ProofWorld& world;
  /// The designator whose type was asked for and fits: some rule speaks of it.
  std::optional<ValueId> fits;

  enum class Step : std::uint8_t { kTrue, kFalse, kStop };
  using Arguments = std::vector<PrologTermId>;
  Step stop(ProofStop why) {
    stopped_ = std::move(why);
    return Step::kStop;
  }
  Step wrong(DatumId at, std::string_view what, std::string_view text) {
    world.report(at, what, text);
    return stop(ProofError{});
  }
  static Step truth(bool value) { return value ? Step::kTrue : Step::kFalse; }
  /// The goal goes on with any element of the list that unifies with the pattern.
  Step any_of(PrologTermId pattern, PrologTermId list);
  Step call(const std::string& function, const Arguments& arguments, DatumId at, ValueId& out);
  DatumId at() const { return at_; }
  /// The outermost clause by which the goal was proved.
  std::optional<DatumId> last_clause() const { return clause_; }

 private:
  /// A goal still to be proved, in a linked list; 0 is its end.
  struct Goal {
    enum class Kind : std::uint8_t { kProve, kCut, kSoftCut, kCollect, kFail };
    Kind kind = Kind::kProve;
    PrologTermId term;
    std::uint32_t next = 0;
    std::uint32_t number = 0;  // kProve: where `cut` cuts to; cuts: the choice; kCollect: which
    DatumId at;
  };
  /// Alternative to try when the current way has failed.
  struct Choice {
    enum class Kind : std::uint8_t {
      kClauses,
      kOr,
      kResume,
      kMember,
      kCollected,
      kModel,
      kModelInOrder
    };
    Kind kind = Kind::kResume;
    bool dead = false;
    std::size_t trail = 0;
    PrologTermId term;       // kClauses, kModel: the goal; kOr, kMember: what is left of the list
    PrologTermId pattern;    // kMember
    std::uint32_t next = 0;  // the goals behind it
    // kOr: where `cut` cuts to; kClauses, kModelInOrder: the next one; kCollected: which
    std::uint32_t number = 0;
    DatumId at;
    std::vector<std::string> used;             // kModel: the ways taken before
    std::vector<std::vector<ValueId>> chains;  // kModel: the links when the first was taken
  };
  struct Collector {
    std::string kind;  // findall, bagof, setof
    PrologTermId pattern;
    PrologTermId result;
    std::vector<PrologTermId> items;
  };
  using Control = Step (ProofSearch::*)(const Goal&, const Arguments&);
  static const std::map<std::string_view, Control>& controls();

  std::uint32_t goal(Goal::Kind kind, PrologTermId term, std::uint32_t next, std::uint32_t number,
                     DatumId at);
  std::uint32_t sequence(const Arguments& goals, std::uint32_t next, std::uint32_t number,
                         DatumId at);
  std::uint32_t height() const { return static_cast<std::uint32_t>(choices_.size()); }
  Choice& choose(Choice::Kind kind, PrologTermId term, std::uint32_t next, std::uint32_t number,
                 DatumId at);
  bool backtrack();
  Step resume(const Choice& choice);
  Step execute(const Goal& goal);
  Step prove(const Goal& goal);
  Step try_clauses(PrologTermId term, std::uint32_t from, std::uint32_t next, DatumId at);
  Step try_or(PrologTermId alternatives, std::uint32_t next, std::uint32_t number, DatumId at);
  Step try_member(PrologTermId pattern, PrologTermId list, std::uint32_t next, DatumId at);
  /// A goal that the model answers: its free arguments and the ways in which it can hold.
  struct Query {
    Arguments free;
    std::vector<ModelWay> ways;
  };
  std::optional<Query> query(PrologTermId term, DatumId at);
  Step hold(const Query& query, std::size_t way, std::uint32_t next);
  Step ask(PrologTermId term, const Choice* before, std::uint32_t next, DatumId at);
  Step ask_in_order(PrologTermId term, std::uint32_t from, std::uint32_t next, DatumId at);
  bool collects() const;
  Step collected(std::uint32_t which, std::uint32_t next);

  Step control_and(const Goal& goal, const Arguments& args);
  Step control_or(const Goal& goal, const Arguments& args);
  Step control_not(const Goal& goal, const Arguments& args);
  Step control_if(const Goal& goal, const Arguments& args);
  Step control_soft_if(const Goal& goal, const Arguments& args);
  Step control_once(const Goal& goal, const Arguments& args);
  Step control_cut(const Goal& goal, const Arguments& args);
  Step control_forall(const Goal& goal, const Arguments& args);
  Step control_collect(const Goal& goal, const Arguments& args);
  Step choice_of(const Goal& goal, const Arguments& args, Goal::Kind cut);

  const FactBase& facts_;
  ProofAnswers& answers_;
  std::vector<Goal> goals_ = {Goal{}};
  std::vector<Choice> choices_;
  std::vector<Collector> collectors_;
  std::uint32_t current_ = 0;
  DatumId at_;
  PrologTermId wanted_;
  std::optional<DatumId> clause_;
  ProofStop stopped_ = ProofNone{};
};

/// The predicates that are neither control nor clauses; null: none of this name.
using GoalFunction = ProofSearch::Step (*)(ProofSearch&, const ProofSearch::Arguments&);
struct GoalEntry {
  std::string_view name;
  std::size_t min_arguments = 0;
  std::size_t max_arguments = 0;
  GoalFunction function = nullptr;
};
const GoalEntry* find_goal(std::string_view name);

}  // namespace parallax::compiler
