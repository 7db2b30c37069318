#include "tools/learn/learned_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "compiler/base/ground_name.h"
#include "compiler/syntax/formatter.h"
#include "runtime/enumerate/path_admission.h"
#include "runtime/session/solver_session.h"
#include "tools/repair/domain_model.h"

namespace parallax::tools {

using compiler::AtomKind;
using compiler::Literal;
using compiler::Timepoint;
using runtime::SolveStatus;

namespace {

/// Asks a model without a plan whether it admits the course of a run.
class RunAdmission {
 public:
  RunAdmission(const compiler::CompiledModel& model, const std::set<std::string>& forbidden,
               const Context& context)
      : session_(model, runtime::make_cadical_solver(&context.stop())),
        index_(model),
        forbidden_(forbidden),
        undemanded_(runtime::undemanded_events(model)) {
    for (const auto& event : model.events) {
      if (event.slot) all_.push_back(*event.slot);
    }
  }

  /// The first timepoint that it cannot reach like that; none: it admits the whole run.
  std::optional<std::size_t> parting(const Evidence& run) {
    const auto last = run.steps.size();
    if (goes(run, last)) return std::nullopt;
    for (std::size_t t = 0; t < last; ++t) {
      if (!goes(run, t)) return t;
    }
    return last;
  }

 private:
  bool goes(const Evidence& run, std::size_t t) {
    std::vector<Literal> facts;
    if (!add_states(run, t, facts)) return false;
    for (std::size_t i = 0; i < t; ++i) {
      if (!add_step(run, i, facts)) return false;
    }
    return session_.solve(static_cast<Timepoint>(t), facts) != SolveStatus::kUnsatisfiable;
  }

  bool add_states(const Evidence& run, std::size_t t, std::vector<Literal>& facts) const {
    for (std::size_t i = 0; i <= t; ++i) {
      for (const auto& [fluent, holds] : run.states[i]) {
        const auto literal = index_.find(AtomKind::kHoldsAt, fluent, static_cast<Timepoint>(i));
        if (!literal && holds) return false;
        if (literal) facts.push_back(holds ? *literal : ~*literal);
      }
    }
    return true;
  }

  bool add_step(const Evidence& run, std::size_t i, std::vector<Literal>& facts) const {
    const auto& step = run.steps[i];
    const auto t = static_cast<Timepoint>(i);
    const bool refused = step.failed && says_not_possible(step.reason) &&
                         forbidden_.contains(base::symbol_of(step.event));
    const auto happens = index_.find(AtomKind::kHappens, step.event, t);
    if (!happens && !refused) return false;
    if (happens) facts.push_back(refused ? ~*happens : *happens);
    // Executed plans may have further events that the model demands; traces have none.
    for (const auto slot : run.executed ? undemanded_ : all_) {
      const auto literal = Literal::positive(session_.model().variable(slot, t));
      if (!happens || literal != *happens) facts.push_back(~literal);
    }
    return true;
  }

  runtime::SolverSession session_;
  compiler::AtomIndex index_;
  const std::set<std::string>& forbidden_;
  std::vector<std::uint32_t> undemanded_, all_;  // slots of events
};

}  // namespace

std::string named_runs(const std::vector<std::string>& runs) {
  constexpr std::size_t kNamed = 4;
  std::string out = runs.size() == 1 ? "run " : "runs ";
  for (std::size_t i = 0; i < std::min(runs.size(), kNamed); ++i) {
    out += (i == 0 ? "" : ", ") + runs[i];
  }
  if (runs.size() > kNamed) out += fmt::format(" and {} more", runs.size() - kNamed);
  return out;
}

std::string learned_text(const std::string& heading, const std::string& states,
                         const LearnedEffects& effects, const LearnVocabulary& vocabulary,
                         const std::string& start) {
  auto text = heading + "\n" + states;
  std::optional<std::size_t> event;
  for (const auto& rule : effects.rules) {
    if (event != rule.event) text += "\n";
    event = rule.event;
    text +=
        print(rule, vocabulary) +
        (rule.kind == RuleKind::kTies ? "\n; One chance decides both, as in " : "\n; Taught by ") +
        named_runs(rule.taught_by);
    if (!rule.held_by.empty()) text += "; held back by " + named_runs(rule.held_by);
    text += ".\n";
  }
  if (!effects.settled.empty()) {
    text += "\n; What was left open is so when the event happens; nothing else changes it.\n";
  }
  for (const auto fluent : effects.settled) text += print_settled(fluent, vocabulary);
  if (!start.empty()) text += "\n; The start.\n" + start;
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto file = files.add("learned.e", text);
  auto formatted = compiler::format_text(file, files, sink);
  return formatted ? *std::move(formatted) : text;
}

RunsCheck check_runs(const std::string& text, const std::vector<Evidence>& runs,
                     const std::vector<LearnedRule>& rules, const LearnVocabulary& vocabulary,
                     const Context& context) {
  RunsCheck out;
  std::size_t horizon = 1;
  for (const auto& run : runs) {
    horizon = std::max(horizon, run.steps.size());
    out.runs += run.runs();
  }
  const auto model = compile_text(text, static_cast<std::int64_t>(horizon), context, out.wrong);
  if (!model) return out;
  std::set<std::string> forbidden;
  for (const auto& rule : rules) {
    if (rule.kind == RuleKind::kForbids) forbidden.insert(vocabulary.symbols()[rule.event].name);
  }
  RunAdmission admission(*model, forbidden, context);
  for (const auto& run : runs) {
    if (context.stopped()) break;
    if (const auto t = admission.parting(run)) {
      if (out.first.empty()) out.first = fmt::format("run {} at {}", run.ids.front(), *t);
    } else {
      out.admitted += run.runs();
    }
  }
  return out;
}

}  // namespace parallax::tools
