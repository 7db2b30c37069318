// Proofs that a running plan asks of the rules in its files, with questions to the model.
//
// A proof is a Prolog search (prolog_search.cc). A goal that the rules leave to the model
// becomes a question: the formula of a query with each combination of constants for its free
// variables, as ways that may hold. Whoever explores the plan decides which way holds and runs
// the proof again from the beginning with the answers so far, so a proof is a function of its
// goal and of the answers and keeps no state between two questions. Lisp functions that rules
// call run on the plan's machine; they may ask and prove, but not perform. An error that such a
// function signals fails its goal; an error of ours, such as a function that we lack, ends
// everything: what cannot be computed must not look like a rule that does not hold.
//
// Cost: steps of a proof, ways of a question and the nesting of proofs are limited.

#include "compiler/interpreter/rule_proofs.h"

#include <fmt/core.h>

#include <utility>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/plans.h"
#include "compiler/interpreter/unit_arguments.h"

namespace parallax::compiler {

namespace {

constexpr std::int64_t kMaxProofSteps = 200'000;
constexpr std::size_t kMaxWays = 1000;
constexpr int kMaxProofDepth = 20;

}  // namespace

void RuleProofs::report(DatumId at, std::string_view what, std::string_view text) {
  sink_.error(codes::kPlanRule, data_.source(at), what, text);
}

bool RuleProofs::spend(DatumId at, bool exhausted) {
  if (!machine_.count_step()) {
    machine_.report_full(at);
    return false;
  }
  if (++spent_ <= kMaxProofSteps && !exhausted) return true;
  sink_.error(codes::kPlanRule, data_.source(at), data_.head(at).value_or("..."),
              fmt::format("the proof takes more than {} steps; does a rule ask for itself?",
                          kMaxProofSteps));
  return false;
}

void RuleProofs::unknown(std::string_view name, std::size_t arguments, DatumId at) {
  resolver_.unbound_query(name, arguments, data_.source(at))
      .note(
          "say in the binding file what it means, `query NAME (?a ...) ok: FORMULA @t`, or state "
          "it as facts in a `def-fact-group`");
}

bool RuleProofs::is_query(std::string_view name, std::size_t arguments) {
  return resolver_.find_query(name, arguments) != nullptr;
}

bool RuleProofs::knows(ValueId goal) {
  const auto items = values_.elements(goal);
  if (!items || items->empty()) return false;
  const auto& head = values_[items->front()];
  // A goal that is written into the designator has keywords, which no predicate is called by.
  if (head.kind != ValueKind::kSymbol || head.keyword) return false;
  const auto name = head.text;
  return is_query(name, items->size() - 1) || facts_.has(name, items->size() - 1);
}

/// `dTop` as plans write it, :d-top, where that leads back to it.
ValueId RuleProofs::lisp_name(const std::string& constant) {
  std::string out;
  for (const char c : constant) {
    if (base::is_upper(c) && !out.empty()) out += '-';
    out += c == '_' ? '-' : base::to_lower(c);
  }
  const auto back = resolver_.model_constant(out);
  return values_.keyword(back == constant ? out : constant);
}

std::optional<std::vector<ModelWay>> RuleProofs::ways(
    std::string_view name, std::span<const std::optional<ValueId>> arguments, DatumId at) {
  const auto* query = resolver_.find_query(name, arguments.size());
  const auto index = static_cast<std::size_t>(query - resolver_.queries().data());
  std::vector<ModelWay> out = {{}};
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i]) continue;
    const auto& constants = options_.query_candidates;
    // A variable about which the formula says nothing can be anything.
    const bool known = index < constants.size() && i < constants[index].size();
    const auto names = known ? constants[index][i] : std::vector<std::string>();
    if (names.empty()) {
      report(at, name,
             fmt::format("the formula of the query says nothing of {}, which is free here",
                         query->variables[i]));
      return std::nullopt;
    }
    std::vector<ModelWay> longer;
    for (const auto& way : out) {
      for (const auto& constant : names) {
        longer.push_back(way);
        longer.back().bound.push_back(lisp_name(constant));
        longer.back().name += (way.name.empty() ? "" : ", ") + constant;
      }
      if (longer.size() > kMaxWays) {
        report(at, name, fmt::format("its free variables have more than {} values", kMaxWays));
        return std::nullopt;
      }
    }
    out = std::move(longer);
  }
  for (auto& way : out) {
    if (!spend(at, false)) return std::nullopt;
    std::vector<ValueId> all;
    std::size_t next = 0;
    for (const auto& argument : arguments) all.push_back(argument ? *argument : way.bound[next++]);
    auto guard = resolver_.query_formula(*query, all, data_.source(at));
    if (!guard) return std::nullopt;
    way.guard = *std::move(guard);
  }
  return out;
}

// --- functions ----------------------------------------------------------------------------------

ProofWorld::Computed RuleProofs::truth_of(const StopQuestion& question, ProofAnswers& answers) {
  auto guard = guard_of_(question);
  if (!guard) return ProofError{};
  const ModelWay way{*std::move(guard), {}, {}};
  const auto answer = answers.take(std::span(&way, 1));
  if (!answer) return ProofQuestion{{way}};
  return Value{values_.boolean(*answer != 0)};
}

/// In CRAM an error in a Lisp function fails the goal. Here only those do that the plan itself
/// signals: what we cannot compute must not look like a rule that does not hold.
ProofWorld::Computed RuleProofs::wrong_arguments(std::string_view function, std::string_view text,
                                                 DatumId at) {
  sink_.error(codes::kPlanArguments, data_.source(at), function, text);
  return ProofError{};
}

ProofWorld::Computed RuleProofs::call(const std::string& function,
                                      const std::vector<ValueId>& arguments, DatumId at,
                                      ProofAnswers& answers) {
  const auto unit = code_.functions.find(function);
  if (unit == code_.functions.end()) return call_builtin_named(function, arguments, at, answers);
  auto bound = unit_arguments(code_.units[unit->second], arguments, values_);
  if (const auto* text = std::get_if<std::string>(&bound)) {
    return wrong_arguments(code_.units[unit->second].name, *text, at);
  }
  return run(unit->second, std::get<std::vector<ValueId>>(bound), at, answers);
}

ProofWorld::Computed RuleProofs::call_builtin_named(const std::string& function,
                                                    const std::vector<ValueId>& arguments,
                                                    DatumId at, ProofAnswers& answers) {
  // Another package may define a function of that name.
  const auto prefix = function.rfind(':');
  const auto name = prefix == std::string::npos ? function : function.substr(prefix + 1);
  const auto builtin = name.starts_with('%') ? std::nullopt : find_builtin(name);
  if (!builtin) {
    sink_.error(codes::kUnknownPlanForm, data_.source(at), function)
        .note("a rule calls functions of the plan's files and the static functions of the subset");
    return ProofError{};
  }
  const auto& entry = plan_builtins()[*builtin];
  if (arguments.size() < entry.min_arguments || arguments.size() > entry.max_arguments) {
    return wrong_arguments(function, fmt::format("{} arguments", arguments.size()), at);
  }
  const auto result = call_builtin(*builtin, arguments, code_.classes,
                                   options_.limits.location_samples, links_, values_);
  machine_.note_doubt(at);
  if (const auto* value = std::get_if<ValueId>(&result)) return Value{*value};
  if (const auto* equality = std::get_if<ModelEquality>(&result)) {
    return truth_of(StopQuestion{*equality, at}, answers);
  }
  const auto& failure = std::get<BuiltinFailure>(result);
  if (failure.kind == BuiltinError::kRaise) return LispError{};
  machine_.report(failure, *builtin, at);
  return ProofError{};
}

/// A function of the plan, which may ask the model but not perform.
ProofWorld::Computed RuleProofs::run(std::uint32_t unit, const std::vector<ValueId>& arguments,
                                     DatumId at, ProofAnswers& answers) {
  auto state = machine_.computation(unit, arguments, links_);
  for (;;) {
    const auto stop = machine_.run(state);
    // Its changes stay, however it ends.
    links_.chains = state.links.chains;
    links_.heap = state.links.heap;
    links_.next = std::max(links_.next, state.links.next);
    if (std::holds_alternative<StopDone>(stop)) return Value{state.stack.back()};
    if (const auto* question = std::get_if<StopQuestion>(&stop)) {
      auto answer = truth_of(*question, answers);
      if (!std::holds_alternative<Value>(answer)) return answer;
      state.stack.push_back(std::get<Value>(answer).value);
      continue;
    }
    if (const auto* proof = std::get_if<StopProof>(&stop)) {
      auto solved = solve(*proof, answers);
      if (auto* asked = std::get_if<ProofQuestion>(&solved)) return std::move(*asked);
      if (const auto* failed = std::get_if<ProofFailed>(&solved)) return *failed;
      if (std::holds_alternative<ProofError>(solved)) return ProofError{};
      state.links.chains = links_.chains;
      state.links.heap = links_.heap;
      state.links.next = links_.next;
      state.stack.push_back(std::get<ProofValue>(solved).value);
      continue;
    }
    if (const auto* failed = std::get_if<StopFailed>(&stop)) {
      if (code_.classes.is_a(failed->failure_class, "error")) return LispError{};
      return ProofFailed{values_.failure(failed->failure_class)};
    }
    if (const auto* perform = std::get_if<StopPerform>(&stop)) {
      sink_
          .error(codes::kUnsupportedPlanForm, data_.source(perform->form), "perform",
                 "a function that a rule calls cannot perform")
          .note(data_.source(at), "it is called here");
    } else if (const auto* bound = std::get_if<StopBound>(&stop)) {
      report(at, code_.units[unit].name,
             fmt::format("`{}` does not end in the function that the rule calls", bound->form));
    }
    return ProofError{};
  }
}

// --- proofs -------------------------------------------------------------------------------------

RuleProofs::Grounding RuleProofs::plan_call(ValueId solution, DatumId at) {
  const auto parts = values_.elements(solution);
  const bool called =
      parts && !parts->empty() && values_.kind(parts->front()) == ValueKind::kSymbol;
  if (!called) {
    report(at, kGroundingRule, "its solution is (function argument...)");
    return ProofError{};
  }
  const auto& name = values_[parts->front()].text;
  const auto found = code_.functions.find(name);
  if (found == code_.functions.end()) {
    report(at, kGroundingRule,
           fmt::format("the plan has no function `{}` to carry out the action", name));
    return ProofError{};
  }
  const auto& unit = code_.units[found->second];
  if (unit.top_level) {
    report(at, kGroundingRule,
           fmt::format("`{}` is a `def-top-level-cram-function`, which no plan calls", name));
    return ProofError{};
  }
  std::vector<ValueId> given(parts->begin() + 1, parts->end());
  // Rules of today say (function designator), and the function gets its properties by key. Those of
  // old name the arguments one by one.
  const bool positional =
      !unit.signature.empty() && unit.signature.front().kind == UnitParameter::Kind::kRequired;
  const bool resolved = given.size() == 1 &&
                        values_.kind(given.front()) == ValueKind::kDesignator &&
                        values_[given.front()].designator == DesignatorKind::kAction;
  if (resolved && !positional) {
    const auto designator = given.front();
    given.clear();
    const auto keys = values_[designator].keys;
    for (const auto& [key, value] : keys) {
      given.push_back(values_.keyword(key));
      given.push_back(value);
    }
  }
  auto bound = unit_arguments(unit, given, values_);
  if (const auto* text = std::get_if<std::string>(&bound)) {
    sink_.error(codes::kPlanArguments, data_.source(at), unit.name, *text)
        .note(data_.source(unit.source), "defined here");
    return ProofError{};
  }
  return PlanCall{found->second, std::get<std::vector<ValueId>>(std::move(bound)), links_};
}

RuleProofs::Grounding RuleProofs::ground(const StopPerform& perform, const DesignatorLinks& links,
                                         std::span<const std::uint32_t> given) {
  links_ = links;
  spent_ = 0;
  ProofAnswers answers{given, 0, {}};
  ProofSearch search(facts_, *this, values_, answers);
  const auto solution = search.terms.variable();
  const auto goal = search.terms.list({search.terms.atom(values_.symbol(kGroundingRule)),
                                       search.terms.atom(perform.designator), solution});
  auto stop = search.first(goal, perform.form);
  if (auto* question = std::get_if<ProofQuestion>(&stop)) return std::move(*question);
  if (const auto* failed = std::get_if<ProofFailed>(&stop)) return *failed;
  if (std::holds_alternative<ProofError>(stop)) return ProofError{};
  if (std::holds_alternative<ProofNone>(stop)) return NoPlanCall{search.fits == perform.designator};
  const auto value = search.terms.value(solution);
  const auto at = search.last_clause().value_or(perform.form);
  if (!value) {
    report(at, kGroundingRule, "its solution has a variable that nothing binds");
    return ProofError{};
  }
  return plan_call(*value, at);
}

RuleProofs::Proof RuleProofs::solve(const StopProof& proof, ProofAnswers& answers) {
  if (depth_ >= kMaxProofDepth) {
    report(proof.form, "prolog", "the goal asks for itself in a function that it calls");
    return ProofError{};
  }
  ++depth_;
  ProofSearch search(facts_, *this, values_, answers);
  std::map<std::string, PrologTermId> variables;
  auto goal = search.terms.from_data(proof.goal, variables);
  std::vector<PrologTermId> bindings;
  for (const auto& [name, variable] : variables) {
    bindings.push_back(search.terms.pair(search.terms.atom(values_.symbol(name)), variable));
  }
  const auto pattern = search.terms.list(bindings);
  auto result = pattern;
  if (proof.all) {
    result = search.terms.variable();
    goal = search.terms.list({search.terms.atom(values_.symbol("findall")), pattern, goal, result});
  }
  auto stop = search.first(goal, proof.form);
  --depth_;
  if (auto* question = std::get_if<ProofQuestion>(&stop)) return std::move(*question);
  if (const auto* failed = std::get_if<ProofFailed>(&stop)) return *failed;
  if (std::holds_alternative<ProofError>(stop)) return ProofError{};
  if (std::holds_alternative<ProofNone>(stop)) return ProofValue{values_.nil(), links_};
  if (proof.all) {
    const auto list = search.terms.value(result);
    if (list) return ProofValue{*list, links_};
    report(proof.form, "force-ll", "a solution leaves a variable free");
    return ProofError{};
  }
  // Free variables of a solution have no binding in it.
  std::vector<ValueId> known;
  for (const auto& [name, variable] : variables) {
    if (const auto value = search.terms.value(variable)) {
      known.push_back(values_.cons(values_.symbol(name), *value));
    }
  }
  compiler::Value further;
  further.kind = ValueKind::kFurther;
  const auto rest = variables.empty() ? values_.nil() : values_.intern(std::move(further));
  return ProofValue{values_.cons(values_.list(known), rest), links_};
}

RuleProofs::Proof RuleProofs::prove(const StopProof& proof, const DesignatorLinks& links,
                                    std::span<const std::uint32_t> given) {
  links_ = links;
  spent_ = 0;
  depth_ = 0;
  ProofAnswers answers{given, 0, {}};
  return solve(proof, answers);
}

}  // namespace parallax::compiler
