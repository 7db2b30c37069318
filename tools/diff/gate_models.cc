#include <fmt/format.h>

#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/session/solver_session.h"
#include "tools/app/plan_reservations.h"
#include "tools/app/scenario_model.h"
#include "tools/app/trace_feed.h"
#include "tools/app/trace_writer.h"
#include "tools/diff/gate.h"

namespace parallax::tools {
namespace {

using compiler::FactKind;
using runtime::DifferenceAnswer;

constexpr std::size_t kMaxShownNames = 5;

std::string first_of(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < std::min(names.size(), kMaxShownNames); ++i) {
    out += (i == 0 ? "" : ", ") + names[i];
  }
  return names.size() <= kMaxShownNames
             ? out
             : out + fmt::format(" and {} more", names.size() - kMaxShownNames);
}

/// Traces that one side alone has.
RuleResult trace_rule(const ModelDifference& found, bool lost) {
  const char* name = lost ? "lost" : "gained";
  RuleResult out{fmt::format("models.{}_traces", name), RuleOutcome::kUndecided, {}};
  if (!found.traces) {
    out.words = "the traces were not compared";
    return out;
  }
  const auto& traces = *found.traces;
  const auto& side = lost ? traces.lost : traces.gained;
  const auto& kept = lost ? found.old_side : found.new_side;
  const auto horizon = lost ? found.old_horizon : found.new_horizon;
  const auto& unmatched = lost ? traces.vocabulary.only_first : traces.vocabulary.only_second;
  const auto& other = lost ? found.new_side : found.old_side;
  const auto& partial = kept.reservation.empty() ? other : kept;
  if (!partial.reservation.empty()) {
    // Either side may have traces that were not explored.
    out.words = fmt::format("the traces of {} are {}", partial.name, partial.reservation);
  } else if (side.answer == DifferenceAnswer::kFound) {
    out.outcome = RuleOutcome::kBroken;
    out.words =
        fmt::format("{} {} up to timepoint {}", count_text(side.count), name, traces.horizon);
    if (side.witness) out.witness = witness_text(found, lost);
  } else if (side.answer == DifferenceAnswer::kUnknown) {
    out.words = "a limit was reached before it was known";
  } else if (!unmatched.empty()) {
    out.words = fmt::format("none {} in what both have, but only {} has {}", name, kept.name,
                            first_of(unmatched));
  } else if (traces.horizon < horizon) {
    out.words = fmt::format("none {} up to timepoint {}, but {} goes on to {}", name,
                            traces.horizon, kept.name, horizon);
  } else {
    out.outcome = RuleOutcome::kKept;
    out.words = fmt::format("none {} up to timepoint {}", name, traces.horizon);
  }
  return out;
}

RuleResult fact_rule(const FactReport& report, FactKind kind, const char* name) {
  const auto text = to_text(report, kind, name, false);
  const auto head = text.substr(0, text.find('\n'));
  if (text.empty()) return {fmt::format("models.{}", name), RuleOutcome::kKept, "none changed"};
  return {fmt::format("models.{}", name), RuleOutcome::kBroken, head.substr(head.find(": ") + 2),
          text.substr(head.size() + 1)};
}

/// Does a revision have the property, and if not, how is it violated?
struct RevisionAnswer {
  compiler::Timepoint horizon = 0;
  /// Executions go on beyond the horizon, or beyond a form whose unrolling was cut: in words.
  std::string open;
  base::Known holds = base::Known::kUndecided;
  std::string why;      // where it is not known
  std::string witness;  // a violation
};

base::Result<RevisionAnswer> ask_property(const std::string& path, RevisionKind kind,
                                          const ModelOptions& with, const std::string& property,
                                          Context& context) {
  RevisionAnswer out;
  if (kind == RevisionKind::kArtifact) {
    out.why = fmt::format("{} is compiled, and properties are asked of texts", path);
    return out;
  }
  auto options = with;
  options.models.insert(options.models.begin(), path);
  options.property = property;
  const auto compilation = compile_models(options, context);
  if (!compilation) return context.sink().already_reported();
  out.horizon = compilation->model.horizon;
  runtime::SolverSession session(compilation->model, runtime::make_cadical_solver(&context.stop()));
  runtime::PlanEnumerator violations(session, {.order = runtime::TraceOrder::kAny});
  if (const auto violation = violations.next()) {
    out.holds = base::Known::kNo;
    out.witness = to_text(*violation);
    return out;
  }
  if (context.stopped() || violations.exploration() == runtime::Exploration::kStopped) {
    out.why = fmt::format("a limit was reached before it was known of {}", path);
    return out;
  }
  if (violations.exploration() == runtime::Exploration::kCompleteUpToBound) {
    const auto ends = open_end_texts(compilation->model, violations.open_ends());
    out.open = ends.empty() ? "executions go on beyond the horizon" : ends.front();
  }
  // A model without executions satisfies everything, which says nothing.
  const auto sink = context.sink();
  const auto empty =
      report_if_unsatisfiable(compilation->model, compilation->model.horizon, context);
  context.sink() = sink;
  auto reservations = reservations_of(compilation->plan);
  reservations.cut = !violations.open_ends().cuts.empty();
  if (empty == base::Known::kNo) {
    out.why = fmt::format("{} has no trace at all", path);
  } else if (reservations.any()) {
    out.why = fmt::format("{} has no violation, but that is {}", path, reservations.words());
  } else {
    out.holds = base::Known::kYes;
  }
  return out;
}

base::Result<RuleResult> property_rule(const GateInput& input, const std::string& property,
                                       Context& context) {
  const auto& with = input.models;
  const auto before = ask_property(input.old_path, input.old_kind,
                                   with.old_model.value_or(with.load.model), property, context);
  if (!before) return context.sink().already_reported();
  const auto after = ask_property(input.new_path, input.new_kind,
                                  with.new_model.value_or(with.load.model), property, context);
  if (!after) return context.sink().already_reported();
  RuleResult out{"models.properties", RuleOutcome::kKept, property + ": holds"};
  if (after->holds == base::Known::kYes && before->holds != base::Known::kNo) {
    // Executions that are not looked at any more may violate it.
    if (after->horizon < before->horizon) {
      out.outcome = RuleOutcome::kUndecided;
      out.words = fmt::format("{}: holds up to timepoint {}, but {} goes on to {}", property,
                              after->horizon, input.old_path, before->horizon);
    } else if (!after->open.empty() && before->open.empty()) {
      out.outcome = RuleOutcome::kUndecided;
      out.words = fmt::format(
          "{}: holds up to timepoint {}, but in {} not every execution ends by "
          "then, as in {}: {}",
          property, after->horizon, input.new_path, input.old_path, after->open);
    }
    return out;
  }
  if (after->holds == base::Known::kYes) {
    out.words = property + ": did not hold before";
    return out;
  }
  if (before->holds == base::Known::kNo) {
    out.words = property + ": did not hold before either";
  } else if (after->holds == base::Known::kUndecided) {
    out.outcome = RuleOutcome::kUndecided;
    out.words = property + ": " + after->why;
  } else if (before->holds == base::Known::kUndecided) {
    out.outcome = RuleOutcome::kUndecided;
    out.words = property + ": is violated now; " + before->why;
    out.witness = after->witness;
  } else {
    out.outcome = RuleOutcome::kBroken;
    out.words = property + ": is lost";
    out.witness = after->witness;
  }
  return out;
}

}  // namespace

base::Result<std::vector<RuleResult>> gate_models(const GateInput& input,
                                                  const harness::GateRules::Models& rules,
                                                  GateReport& report, Context& context) {
  auto options = input.models;
  options.facts = true;
  options.traces = rules.lost_traces || rules.gained_traces;
  const auto found = compare_models(input.old_path, input.old_kind, input.new_path, input.new_kind,
                                    options, context);
  if (!found) return context.sink().already_reported();
  report.remarks = found->remarks;
  const auto facts = found->report();
  std::vector<RuleResult> out;
  if (rules.lost_traces) out.push_back(trace_rule(*found, true));
  if (rules.gained_traces) out.push_back(trace_rule(*found, false));
  if (rules.declarations) out.push_back(fact_rule(facts, FactKind::kDeclaration, "declarations"));
  if (rules.axioms) out.push_back(fact_rule(facts, FactKind::kAxiom, "axioms"));
  for (const auto& rule : rules.settings) out.push_back(setting_rule(*found, rule));
  if (rules.rerun) out.push_back(rerun_rule(*found, input, *rules.rerun, context));
  for (const auto& property : rules.properties) {
    auto rule = property_rule(input, property.text, context);
    if (!rule) return context.sink().already_reported();
    out.push_back(*std::move(rule));
  }
  return out;
}

}  // namespace parallax::tools
