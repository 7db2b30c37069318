#include "tools/diff/gate.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/json.h"
#include "compiler/base/markdown.h"
#include "compiler/base/words.h"
#include "tools/diff/trace_set.h"

namespace parallax::tools {
namespace {

using compiler::FactKind;
using Rules = base::Result<std::vector<RuleResult>>;

Rules gate_plans(const GateInput& input, const harness::GateRules::Plans& rules, Context& context) {
  auto before = load_plan_revision(input.old_path, input.old_kind, context);
  auto after = load_plan_revision(input.new_path, input.new_kind, context);
  if (!before || !after) return context.sink().already_reported();
  compiler::drop_equal_order(before->facts, after->facts);
  const auto report = compare(before->facts, after->facts);
  std::vector<RuleResult> out;
  const auto add = [&](bool forbidden, const char* name, FactKind kind) {
    if (!forbidden) return;
    const auto text = to_text(report, kind, name, false);
    const bool same = text.empty();
    const auto head = text.substr(0, text.find('\n'));
    out.push_back({fmt::format("plans.{}", name), same ? RuleOutcome::kKept : RuleOutcome::kBroken,
                   same ? "none changed" : head, same ? "" : text.substr(head.size() + 1)});
  };
  add(rules.forms, "forms", FactKind::kAxiom);
  add(rules.order, "order", FactKind::kDeclaration);
  return out;
}

/// Compares lists of traces that may be incomplete: that one lacks a trace is known only if it is
/// complete.
RuleResult set_rule(const char* name, const TraceSet& in, const TraceSet& other) {
  const auto only = only_in(in, other);
  RuleResult out{fmt::format("traces.{}", name), RuleOutcome::kKept, fmt::format("none {}", name)};
  if (only.witness) {
    out.words = fmt::format("{} {}", only.count, name);
    out.outcome = other.complete ? RuleOutcome::kBroken : RuleOutcome::kUndecided;
    if (!other.complete) out.words += fmt::format(", but {} is not known to be whole", other.name);
    out.witness = to_text(*only.witness);
  } else if (!in.complete) {
    out.outcome = RuleOutcome::kUndecided;
    out.words += fmt::format(", but {} is not known to be whole", in.name);
  }
  return out;
}

Rules gate_trace_files(const GateInput& input, const harness::GateRules::Traces& rules,
                       Context& context) {
  const auto before = load_trace_set(input.old_path, context);
  const auto after = load_trace_set(input.new_path, context);
  if (!before || !after) return context.sink().already_reported();
  std::vector<RuleResult> out;
  if (rules.lost) out.push_back(set_rule("lost", *before, *after));
  if (rules.gained) out.push_back(set_rule("gained", *after, *before));
  return out;
}

std::string indented_lines(const std::string& text) {
  std::string out = "      ";
  for (std::size_t i = 0; i < text.size(); ++i) {
    out += text[i];
    if (text[i] == '\n' && i + 1 < text.size()) out += "      ";
  }
  if (!out.ends_with('\n')) out += '\n';
  return out;
}

/// "1 of 3 rules is broken, 1 not decidable"
std::string gate_summary(const GateReport& report) {
  const auto broken = report.count(RuleOutcome::kBroken);
  const auto open = report.count(RuleOutcome::kUndecided);
  if (report.rules.empty()) return "nothing changed that a rule is about";
  if (broken + open == 0) {
    return report.rules.size() == 1 ? "the rule is kept"
                                    : fmt::format("all {} rules are kept", report.rules.size());
  }
  std::string out;
  if (broken > 0) {
    out = fmt::format("{} of {} rules {} broken", broken, report.rules.size(),
                      base::agreed(broken, "is", "are"));
  }
  if (open > 0) {
    out += fmt::format("{}{} {} not decidable{}", out.empty() ? "" : ", ", open,
                       base::agreed(open, "is", "are"),
                       report.undecided_passes ? ", which passes" : "");
  }
  return out;
}

}  // namespace

std::string_view to_string(RuleOutcome outcome) {
  static constexpr std::string_view kWords[] = {"kept", "broken", "not decidable"};
  return kWords[static_cast<std::size_t>(outcome)];
}

std::size_t GateReport::count(RuleOutcome outcome) const {
  return static_cast<std::size_t>(std::count_if(
      rules.begin(), rules.end(), [&](const RuleResult& rule) { return rule.outcome == outcome; }));
}

bool GateReport::passes() const {
  return count(RuleOutcome::kBroken) == 0 &&
         (undecided_passes || count(RuleOutcome::kUndecided) == 0);
}

base::Result<GateReport> hold_gate(const GateInput& input, const harness::GateRules& rules,
                                   Context& context) {
  auto& sink = context.sink();
  GateReport report;
  report.old_name = input.old_path;
  report.new_name = input.new_path;
  report.undecided_passes = rules.undecided_passes;
  const auto none = [&](const char* what) {
    return sink.error(codes::kNoGateRules, rules.source, what);
  };
  const auto done = [&](Rules found) -> base::Result<GateReport> {
    if (!found) return sink.already_reported();
    report.rules = *std::move(found);
    judge_reruns(report.rules);
    return std::move(report);
  };
  if (has_traces(input.old_kind)) {
    if (!rules.models) return none("models");
    report.kind = "model";
    auto own = input;
    if (input.old_kind == RevisionKind::kScenario && input.new_kind == RevisionKind::kScenario) {
      add_scenario_folders(input.old_path, input.new_path, own.models);
    }
    return done(gate_models(own, *rules.models, report, context));
  }
  if (input.old_kind == RevisionKind::kTraces) {
    if (!rules.traces) return none("trace files");
    report.kind = "traces";
    return done(gate_trace_files(input, *rules.traces, context));
  }
  if (input.old_kind == RevisionKind::kRun) {
    if (!rules.runs) return none("runs");
    report.kind = "run";
    return done(gate_runs(input, *rules.runs, report, context));
  }
  if (input.old_kind == RevisionKind::kRates) {
    if (!rules.rates) return none("rates");
    report.kind = "rates";
    return done(gate_rates(input, *rules.rates, context));
  }
  if (!rules.plans) return none("plans");
  report.kind = "plan";
  return done(gate_plans(input, *rules.plans, context));
}

std::string gate_text(const GateReport& report) {
  std::string out;
  for (const auto& rule : report.rules) {
    out += fmt::format("{:<14} {}: {}\n", to_string(rule.outcome), rule.rule, rule.words);
    if (!rule.witness.empty()) out += indented_lines(rule.witness);
  }
  for (const auto& remark : report.remarks) out += remark + '\n';
  return out +
         fmt::format("gate {}: {}\n", report.passes() ? "passed" : "failed", gate_summary(report));
}

std::string gate_json(const GateReport& report) {
  nlohmann::ordered_json out = {{"passed", report.passes()},
                                {"rules", nlohmann::ordered_json::array()}};
  for (const auto& rule : report.rules) {
    nlohmann::ordered_json json = {{"rule", rule.rule},
                                   {"outcome", to_string(rule.outcome)},
                                   {"words", rule.words},
                                   {"witness", rule.witness}};
    if (rule.rerun) json["rerun"] = base::parse_ordered_json(rerun_json(*rule.rerun));
    out["rules"].push_back(std::move(json));
  }
  out["remarks"] = report.remarks;
  return base::json_text(out);
}

std::string gate_markdown(const GateReport& report, const std::string& picture) {
  using base::markdown_text;
  auto out =
      fmt::format("{}\n### Gate {}: {}\n\n{} to {}\n\n| | rule | |\n|---|---|---|\n", kGateMark,
                  report.passes() ? "passed" : "failed", markdown_text(gate_summary(report)),
                  markdown_text(base::printable(report.old_name)),
                  markdown_text(base::printable(report.new_name)));
  for (const auto& rule : report.rules) {
    const bool is_kept = rule.outcome == RuleOutcome::kKept;
    out += fmt::format("| {0}{1}{0} | {2} | {3} |\n", is_kept ? "" : "**", to_string(rule.outcome),
                       markdown_text(rule.rule), markdown_text(rule.words));
  }
  for (const auto& rule : report.rules) {
    if (rule.witness.empty()) continue;
    out += fmt::format("\n{}:\n\n{}", markdown_text(rule.rule), base::markdown_block(rule.witness));
  }
  if (!picture.empty()) {
    out += fmt::format("\n![where model and simulation part](<{}>)\n", picture);
  }
  if (!report.remarks.empty()) out += '\n';
  for (const auto& remark : report.remarks) out += fmt::format("- {}\n", markdown_text(remark));
  return out;
}

}  // namespace parallax::tools
