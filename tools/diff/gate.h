#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/config/gate_rules.h"
#include "tools/diff/model_difference.h"
#include "tools/diff/rate_change.h"
#include "tools/diff/rates_revision.h"
#include "tools/diff/rerun.h"
#include "tools/diff/revision.h"

namespace parallax::tools {

/// "kept", "broken", "not decidable"
std::string_view to_string(RuleOutcome outcome);

/// Result of one rule.
struct RuleResult {
  std::string rule;  // "models.lost_traces"
  RuleOutcome outcome = RuleOutcome::kKept;
  std::string words;         // one line
  std::string witness = {};  // lines; may be empty
  /// The runs that a rule demanded, where something changed.
  std::shared_ptr<const RerunEvidence> rerun = nullptr;
};

/// A discrepancy of a run folder that can be drawn.
struct DrawnWitness {
  std::string folder, sample;  // "out/new", "1.4"
  std::int64_t timepoint = 0;  // behind the event at which it parts
};

struct GateReport {
  std::string kind;  // "model", "plan", "traces", "run", "rates"
  std::string old_name, new_name;
  bool undecided_passes = false;
  std::vector<RuleResult> rules;
  std::vector<std::string> remarks;  // about all of them
  std::optional<DrawnWitness> drawn;

  std::size_t count(RuleOutcome outcome) const;
  bool passes() const;
};

/// Two revisions, and how to compare them.
struct GateInput {
  std::string old_path, new_path;
  RevisionKind old_kind = RevisionKind::kModel, new_kind = RevisionKind::kModel;
  ModelDiffOptions models;
  Rerunner* rerunner = nullptr;  // null: nothing is run
  std::size_t results = 1;       // of rates that are compared, and share the error
};

/// Checks the change from one revision to the other against the rules. Reports what loading them
/// reports, and kNoGateRules where the rules have no section for revisions of this kind.
base::Result<GateReport> hold_gate(const GateInput& input, const harness::GateRules& rules,
                                   Context& context);

// Its parts, a section of the rules each.
base::Result<std::vector<RuleResult>> gate_models(const GateInput& input,
                                                  const harness::GateRules::Models& rules,
                                                  GateReport& report, Context& context);
/// Is the rule about such a change?
bool is_about(const harness::GateRules::SettingRule& rule, const SettingChange& change);
/// A rule about the settings of two scenarios; of two models, about their horizons.
RuleResult setting_rule(const ModelDifference& found, const harness::GateRules::SettingRule& rule);
/// Facts that changed, a line each: those of a world that is a model, or those of model, plan,
/// binding table and constraints.
std::vector<std::string> changed_facts(const ModelDifference& found, bool of_world);
/// `physics: rerun` of two scenarios: runs both where anything changed that their simulations
/// depend on.
RuleResult rerun_rule(const ModelDifference& found, const GateInput& input,
                      const harness::GateRules::Rerun& rule, Context& context);
/// The same for the scenarios of two run folders, by the texts that the runs kept.
RuleResult kept_rerun_rule(const std::string& old_folder, const std::string& new_folder,
                           const GateInput& input, const harness::GateRules::Rerun& rule,
                           Context& context);
/// Judges the evidence of all rules that demand runs. They share the error, so that a gate is
/// broken by chance with a probability of at most 1 - confidence.
void judge_reruns(std::vector<RuleResult>& rules);
base::Result<std::vector<RuleResult>> gate_runs(const GateInput& input,
                                                const harness::GateRules::Runs& rules,
                                                GateReport& report, Context& context);
base::Result<std::vector<RuleResult>> gate_rates(const GateInput& input,
                                                 const harness::GateRules::Rates& rules,
                                                 Context& context);
/// The rules about rates, for results that were read. The probability that any of them is broken
/// although nothing changed is at most 1 - confidence: rules, traces and causes share that error,
/// and so do `results` pairs of results.
std::vector<RuleResult> hold_rates(const RatesRevision& before, const RatesRevision& after,
                                   const harness::GateRules::Rates& rules, std::size_t results = 1);

std::string gate_text(const GateReport& report);
/// {"passed": false, "rules": [{"rule", "outcome", "words", "witness", "rerun"}], "remarks": [...]}
std::string gate_json(const GateReport& report);

/// First line of a gate's Markdown, so that a newer one may take its place.
inline constexpr const char* kGateMark = "<!-- parallax gate -->";
/// `picture`: a file to show, relative to the Markdown; may be empty.
std::string gate_markdown(const GateReport& report, const std::string& picture);

}  // namespace parallax::tools
