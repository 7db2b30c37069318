#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/json.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/explain/clause_text.h"
#include "runtime/explain/why.h"
#include "runtime/graph/model_traces.h"
#include "tools/app/explain.h"
#include "tools/app/explain_place.h"
#include "tools/app/trace_fact.h"

namespace parallax::tools {
namespace {

/// Tells a chain of facts in words, earliest first, each with the axiom that it rests on.
class WhyText {
 public:
  /// `model` outlives the object; `trace`: its number.
  WhyText(const compiler::CompiledModel& model, std::int64_t trace)
      : model_(model), trace_(trace), clauses_(model) {}

  /// `asked`: as it is in the trace; none: no clause mentions the atom.
  std::string text(const TraceFact& fact, std::optional<compiler::Literal> asked,
                   const std::vector<runtime::WhyStep>& steps) const;
  /// One object and a newline.
  std::string json(const TraceFact& fact, std::optional<compiler::Literal> asked,
                   const std::vector<runtime::WhyStep>& steps) const;

 private:
  std::string state(compiler::Literal literal) const;
  std::string when(compiler::Literal literal, std::optional<compiler::Timepoint> now) const;
  std::string reason(const runtime::WhyStep& step) const;
  std::string inertia(const runtime::WhyStep& step) const;
  std::string premises(const runtime::WhyStep& step) const;
  std::string line(const runtime::WhyStep& step) const;

  const compiler::CompiledModel& model_;
  std::int64_t trace_;
  runtime::ClauseText clauses_;
};

using compiler::AtomKind;
using compiler::Literal;
using nlohmann::ordered_json;
using runtime::WhyKind;
using runtime::WhyStep;

constexpr std::size_t kShownEvents = 4;

const char* kind_word(WhyKind kind) {
  switch (kind) {
    case WhyKind::kStated:
      return "stated";
    case WhyKind::kEffect:
      return "effect";
    case WhyKind::kInertia:
      return "inertia";
    case WhyKind::kAxiom:
      return "axiom";
    case WhyKind::kCompletion:
      return "completion";
    case WhyKind::kForced:
      return "forced";
    case WhyKind::kChosen:
      return "chosen";
    case WhyKind::kUndecided:
      return "undecided";
  }
  return "";
}

/// `Filled(cup) holds`, `Pour(cup) does not happen`.
std::string WhyText::state(Literal literal) const {
  const auto atom = model_.atom(literal.var());
  const bool is = literal.is_positive();
  switch (atom.kind) {
    case AtomKind::kHoldsAt:
      return atom.name + (is ? " holds" : " does not hold");
    case AtomKind::kHappens:
      return atom.name + (is ? " happens" : " does not happen");
    case AtomKind::kReleasedAt:
      return atom.name + (is ? " is released from inertia" : " is subject to inertia");
    case AtomKind::kLocation:
      return (is ? "the plan is at " : "the plan is not at ") + printed(atom);
    case AtomKind::kHit:
      return is ? "the state constraints hold" : "the state constraints do not hold";
    case AtomKind::kRunning:
      return is ? "the plan goes on" : "the plan has ended";
    case AtomKind::kSucceeded:
      return "the perform at " + printed(atom) + (is ? " succeeded" : " did not succeed");
    case AtomKind::kResult:
      return "the perform before " + std::string(is ? "returned " : "did not return ") +
             printed(atom);
    case AtomKind::kRegister:
      return std::string(is ? "the plan knows " : "the plan does not know ") + printed(atom);
    case AtomKind::kPredicate:
    case AtomKind::kAuxiliary:
    case AtomKind::kUnused:
      break;
  }
  return atom.name + (is ? " is true" : " is false");
}

std::string WhyText::when(Literal literal, std::optional<compiler::Timepoint> now) const {
  const auto time = model_.atom(literal.var()).time;
  if (!time || time == now) return state(literal);
  return fmt::format("{} at {}", state(literal), *time);
}

std::string WhyText::premises(const WhyStep& step) const {
  std::string out;
  for (std::size_t i = 0; i < step.premises.size(); ++i) {
    if (i > 0) out += i + 1 == step.premises.size() ? " and " : ", ";
    out += when(step.premises[i], std::nullopt);
  }
  return out;
}

std::string WhyText::inertia(const WhyStep& step) const {
  const auto atom = model_.atom(step.fact.var());
  const bool holds = step.fact.is_positive();
  auto out = fmt::format("as it {} since {}", holds ? "has" : "has not", step.since);
  std::string others;
  for (const auto premise : step.premises) {
    const auto other = model_.atom(premise.var());
    if (other.kind == AtomKind::kHoldsAt && other.name == atom.name) continue;
    others += (others.empty() ? "" : ", ") + when(premise, std::nullopt);
  }
  if (!others.empty()) out += ", because " + others;
  std::set<std::string> absent;
  for (const auto literal : step.absent) absent.insert(model_.atom(literal.var()).name);
  if (absent.empty()) {
    if (others.empty()) out += holds ? ": no event can end it" : ": no event can begin it";
    return out;
  }
  std::string names;
  for (const auto& name : absent) names += (names.empty() ? "" : " nor ") + name;
  if (absent.size() > kShownEvents) {
    return out + fmt::format(": none of the {} events that could {} it happened", absent.size(),
                             holds ? "end" : "begin");
  }
  return out + (absent.size() == 1 ? ": " + names + " did not happen"
                                   : ": neither " + names + " happened");
}

std::string WhyText::reason(const WhyStep& step) const {
  switch (step.kind) {
    case WhyKind::kStated:
      return "stated";
    case WhyKind::kEffect:
    case WhyKind::kAxiom:
      return "because " + premises(step);
    case WhyKind::kInertia:
      return inertia(step);
    case WhyKind::kCompletion:
      return step.premises.empty() ? "nothing could bring it about"
                                   : "nothing else could be the reason, as " + premises(step);
    case WhyKind::kForced:
      return "open so far, but what comes later admits nothing else";
    case WhyKind::kChosen:
      return (step.premises.empty() ? "" : "as " + premises(step) + ", ") +
             std::string("the model leaves it open; this trace has it so");
    case WhyKind::kUndecided:
      return "open so far; stopped before it was known whether what comes later admits anything "
             "else";
  }
  return {};
}

std::string WhyText::line(const WhyStep& step) const {
  const auto time = model_.atom(step.fact.var()).time;
  const auto head = time ? fmt::format("{:>4}  ", *time) : std::string("      ");
  auto out = fmt::format("{}{}: {}\n", head, state(step.fact), reason(step));
  const auto note = [&](const compiler::Origin& origin, const char* word) {
    const auto place = place_text(origin);
    out += fmt::format("          {}{}{}\n", word, place.empty() ? "" : place + "  ",
                       axiom_text(origin));
  };
  if (step.origin) note(model_.origins[*step.origin], "");
  for (const auto clause : step.also) {
    out += "          also: " + clauses_.clause(clause) + '\n';
    note(model_.origins[model_.clause_origins[clause]], "  ");
  }
  return out;
}

std::string WhyText::text(const TraceFact& fact, std::optional<Literal> asked,
                          const std::vector<WhyStep>& steps) const {
  if (!asked) {
    return fmt::format("{} is false in trace {} and in every other: nothing can make it true.\n",
                       fact.name, trace_);
  }
  auto out = fmt::format("{} in trace {}:\n", when(*asked, std::nullopt), trace_);
  for (const auto& step : steps) out += line(step);
  return out;
}

std::string WhyText::json(const TraceFact& fact, std::optional<Literal> asked,
                          const std::vector<WhyStep>& steps) const {
  const auto place = [](const compiler::Origin& origin) {
    return ordered_json{{"file", origin.place.file},
                        {"line", origin.place.begin.line},
                        {"what", to_string(origin.kind)},
                        {"text", origin.text}};
  };
  const auto names = [&](const std::vector<Literal>& literals) {
    auto list = ordered_json::array();
    for (const auto literal : literals) list.push_back(clauses_.literal(literal));
    return list;
  };
  auto list = ordered_json::array();
  for (const auto& step : steps) {
    ordered_json entry = {{"fact", clauses_.literal(step.fact)}, {"why", kind_word(step.kind)}};
    if (step.kind == WhyKind::kInertia) entry["since"] = step.since;
    if (step.origin) entry["axiom"] = place(model_.origins[*step.origin]);
    entry["premises"] = names(step.premises);
    if (!step.absent.empty()) entry["absent"] = names(step.absent);
    auto also = ordered_json::array();
    for (const auto clause : step.also) {
      auto other = place(model_.origins[model_.clause_origins[clause]]);
      other["instance"] = clauses_.clause(clause);
      also.push_back(std::move(other));
    }
    if (!also.empty()) entry["also"] = std::move(also);
    list.push_back(std::move(entry));
  }
  ordered_json document = {{"status", "ok"}, {"trace", trace_}};
  document["fact"] = asked ? clauses_.literal(*asked) : "!" + fact.name;
  document["steps"] = std::move(list);
  return base::json_text(document) + '\n';
}

using compiler::AtomKind;
using compiler::Literal;
using runtime::WhyStep;

/// A trace with a valuation of every variable.
struct ValuedTrace {
  compiler::Timepoint length = 0;
  std::vector<bool> values;
};

/// A trace by its number; else how many there are, in digits.
struct Found {
  std::optional<runtime::Trace> trace;
  std::string count;
};

Found find_planned(const compiler::CompiledModel& model, std::int64_t number,
                   const Context& context) {
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()));
  runtime::PlanEnumerator enumerator(session);
  Found found;
  std::int64_t count = 0;
  for (; count < number; ++count) {
    found.trace = enumerator.next();
    if (!found.trace) break;
  }
  found.count = std::to_string(count);
  return found;
}

Found find_trace(const compiler::CompiledModel& model, std::int64_t number,
                 const Context& context) {
  if (model.has_constraints) return find_planned(model, number, context);
  runtime::TraceQuery query;
  query.wanted = number;
  query.stop = &context.stop();
  runtime::ModelTraces traces(model, query);
  traces.seek(static_cast<long>(number - 1));
  Found found;
  found.trace = traces.next();
  query.wanted = 0;
  if (!found.trace) found.count = runtime::count_traces(model, query).count.get_str();
  return found;
}

/// Every atom as the trace has it; what it does not show is the solver's choice.
std::optional<ValuedTrace> value(const compiler::CompiledModel& model, const runtime::Trace& trace,
                                 const Context& context) {
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()));
  std::vector<Literal> assumptions;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    const auto& [kind, time] = std::tie(atom.kind, atom.time);
    const auto t = time.value_or(0) + (kind == AtomKind::kHappens ? 1 : 0);
    if (t > trace.length()) return;
    const auto say = [&](bool is_true) {
      assumptions.push_back(is_true ? atom.literal() : ~atom.literal());
    };
    if (kind == AtomKind::kPredicate && !time) say(runtime::contains(trace.predicates, atom.name));
    if (!time) return;
    const auto& point = trace.points[static_cast<std::size_t>(*time)];
    if (kind == AtomKind::kHoldsAt) say(runtime::contains(point.holds, atom.fluent()));
    if (kind == AtomKind::kHappens) say(runtime::contains(point.happens, atom.event()));
    if (kind == AtomKind::kReleasedAt) say(runtime::contains(point.released, atom.fluent()));
  });
  if (session.solve(trace.length(), assumptions) != runtime::SolveStatus::kSatisfiable) {
    return std::nullopt;
  }
  ValuedTrace valued{trace.length(), {}};
  for (std::int32_t v = 1; v <= model.variable_count(); ++v) {
    valued.values.push_back(session.value(Literal::positive(v)));
  }
  return valued;
}

base::Result<ValuedTrace> load_trace(const compiler::CompiledModel& model, std::int64_t number,
                                     Context& context) {
  const auto found = find_trace(model, number, context);
  const auto valued = found.trace ? value(model, *found.trace, context) : std::nullopt;
  if (valued) return *valued;
  if (context.stopped()) {
    return context.sink().error_about(base::DiagnosticCode::kExplanationCutShort, "",
                                      fmt::format("trace {} was not reached", number));
  }
  return context.sink().error_about(
      base::DiagnosticCode::kNoSuchTrace, "--trace", number,
      found.count == "0" ? "the model has none" : fmt::format("the model has {}", found.count));
}

/// The last timepoint at which the atom of a fact can be.
bool is_within(const TraceFact& fact, compiler::Timepoint length) {
  return fact.time.value_or(0) + (fact.kind == AtomKind::kHappens ? 1 : 0) <= length;
}

}  // namespace

int explain_why(const compiler::CompiledModel& model, const WhyCommand& command, Context& context) {
  const auto fact = parse_fact(command.fact, model, context);
  if (!fact) return 0;
  const auto trace = load_trace(model, command.trace, context);
  if (!trace) return 0;
  if (!is_within(*fact, trace->length)) {
    context.sink().error_about(
        base::DiagnosticCode::kNoSuchFact, "--why", command.fact,
        fmt::format("trace {} ends at {}{}", command.trace, trace->length,
                    fact->kind == AtomKind::kHappens ? ", where nothing happens any more" : ""));
    return 0;
  }
  WhyText text(model, command.trace);
  std::vector<WhyStep> steps;
  std::optional<Literal> asked;
  if (fact->atom) {
    const bool holds = trace->values[static_cast<std::size_t>(fact->atom->var()) - 1];
    asked = holds ? *fact->atom : ~*fact->atom;
    runtime::WhyOptions options;
    options.alternatives = command.all;
    options.stop = &context.stop();
    steps = runtime::explain_fact(model, trace->length, trace->values, *asked, options);
  }
  if (context.form().json) {
    context.document(text.json(*fact, asked, steps));
  } else {
    context.result(text.text(*fact, asked, steps));
  }
  const bool undecided = std::any_of(steps.begin(), steps.end(), [](const WhyStep& step) {
    return step.kind == runtime::WhyKind::kUndecided;
  });
  if (undecided) {
    context.sink().error_about(base::DiagnosticCode::kExplanationCutShort, "",
                               "whether every choice is one is not known");
  }
  return 0;
}

}  // namespace parallax::tools
