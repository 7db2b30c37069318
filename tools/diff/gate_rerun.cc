// The rule of a gate that demands runs where the physics of a scenario changed.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>

#include "compiler/base/words.h"
#include "harness/confidence/rounding.h"
#include "tools/diff/gate.h"
#include "tools/diff/kept_difference.h"

namespace parallax::tools {
namespace {

bool is_answered(const RuleResult& rule) { return rule.rerun && rule.rerun->problem.empty(); }

/// How the rates of one trace changed, and its causes of today below.
std::string trace_text(const RevisionRates& old, const RevisionRates& now,
                       const std::string& words) {
  auto out = fmt::format("{}: {}\n", old.events, words);
  for (const auto& cause : now.causes) {
    if (cause.count == 0) continue;
    out +=
        fmt::format("  {}: {} before, {} now\n", cause.text, times(old, cause.text), cause.count);
  }
  return out;
}

/// `error`: shared by the traces of all rules, which are `traces`.
void judge(RuleResult& rule, double error, std::size_t traces) {
  const auto& evidence = *rule.rerun;
  const auto& worse = evidence.rule.worse;
  std::size_t broken = 0, open = 0;
  std::string lines, only;
  for (const auto& old : evidence.before.traces) {
    const auto& now = *rates_for(evidence.after, old.events);
    const auto change = change_of(evidence.before, evidence.after, old, now);
    std::string words;
    const auto outcome = weigh_change(change, worse, {error, traces}, words);
    broken += outcome == RuleOutcome::kBroken ? 1 : 0;
    open += outcome == RuleOutcome::kUndecided ? 1 : 0;
    only = words;
    lines += trace_text(old, now, words);
  }
  const auto all = evidence.before.traces.size();
  rule.outcome = broken > 0 ? RuleOutcome::kBroken
                 : open > 0 ? RuleOutcome::kUndecided
                            : RuleOutcome::kKept;
  std::string words = only;
  if (all > 1 && broken > 0) {
    words = fmt::format("{} of {} rates are worse", broken, all);
  } else if (all > 1 && open > 0) {
    words = fmt::format("{} of {} rates are not known to be worse by less than {}", open, all,
                        harness::percent_up(worse.margin));
  } else if (all > 1) {
    words =
        fmt::format("{} rates, none worse by {} or more", all, harness::percent_up(worse.margin));
  }
  rule.words = fmt::format("{}; {}; {} of each trace, old and new, with seed {}", evidence.changes,
                           words, base::counted(evidence.rule.runs, "run"), evidence.rule.seed);
  rule.witness = evidence.listed + lines;
}

/// The changes of settings that have one of these effects.
std::vector<SettingChange> with_effects(const ModelDifference& found,
                                        std::initializer_list<harness::Effect> wanted) {
  std::vector<SettingChange> out;
  for (const auto& change : *found.settings) {
    const auto& effects = change.effects;
    const bool has_one = std::any_of(wanted.begin(), wanted.end(), [&](harness::Effect effect) {
      return std::find(effects.begin(), effects.end(), effect) != effects.end();
    });
    if (has_one) out.push_back(change);
  }
  return out;
}

std::string paths_of(const std::vector<SettingChange>& changes) {
  std::vector<std::string> paths;
  for (const auto& change : changes) paths.push_back(harness::path_text(change.path));
  return fmt::format("{}", fmt::join(paths, ", "));
}

/// Changes of all else that a simulation depends on: model, plan, binding table, constraints and
/// horizon. Appends them to the words and lines of the rule, which is then broken.
void add_predicted(const ModelDifference& found, RuleResult& out) {
  const auto facts = changed_facts(found, false);
  const auto settings = with_effects(found, {harness::Effect::kTraces});
  std::string words;
  if (!facts.empty()) {
    words = fmt::format("{} of model, plan and binding table changed",
                        base::counted(std::ssize(facts), "fact"));
  }
  for (const auto& change : settings) {
    words += (words.empty() ? "" : "; ") + change_text(change);
  }
  if (words.empty()) return;
  out.words = out.outcome == RuleOutcome::kBroken ? out.words + "; " + words : words;
  out.outcome = RuleOutcome::kBroken;
  out.witness += settings_text(settings, false) + fmt::format("{}", fmt::join(facts, ""));
}

RuleResult run_both(const ModelDifference& found, const RerunSide& before, const RerunSide& after,
                    const GateInput& input, const harness::GateRules::Rerun& rule,
                    const Context& context) {
  auto out = setting_rule(found, {"physics", harness::GateRules::Demand::kForbidden});
  if (!found.settings) return out;
  add_predicted(found, out);
  const auto judged = with_effects(found, {harness::Effect::kStarts, harness::Effect::kJudgement});
  if (out.outcome != RuleOutcome::kBroken) {
    out.words += judged.empty()
                     ? ", neither physics nor model, plan or binding table"
                     : fmt::format(
                           ", neither physics nor model, plan or binding table; starts or "
                           "judgement did, which this rule does not weigh: {}",
                           paths_of(judged));
    return out;
  }
  auto evidence = std::make_shared<RerunEvidence>();
  evidence->rule = rule;
  evidence->changes = out.words;
  evidence->listed = out.witness;
  if (!judged.empty()) {
    evidence->problem = fmt::format(
        "another comparison, or other starts: {} changed as well, so that worse and better runs "
        "would say nothing of the rest",
        paths_of(judged));
  } else if (input.rerunner == nullptr) {
    evidence->problem = "nothing can be run here";
  } else {
    input.rerunner->run(before, after, context, *evidence);
  }
  out.outcome = RuleOutcome::kUndecided;
  out.words = fmt::format("{}; {}", evidence->changes, evidence->problem);
  out.rerun = std::move(evidence);
  return out;
}

}  // namespace

RuleResult rerun_rule(const ModelDifference& found, const GateInput& input,
                      const harness::GateRules::Rerun& rule, Context& context) {
  return run_both(found, {input.old_path, input.old_path, input.models.old_commands, false},
                  {input.new_path, input.new_path, input.models.new_commands, false}, input, rule,
                  context);
}

RuleResult kept_rerun_rule(const std::string& old_folder, const std::string& new_folder,
                           const GateInput& input, const harness::GateRules::Rerun& rule,
                           Context& context) {
  const KeptPair pair(old_folder, new_folder, context);
  const auto found = pair.refused().empty() ? pair.compare(context) : std::nullopt;
  if (!found) {
    return {"runs.physics", RuleOutcome::kUndecided,
            pair.refused().empty() ? "the texts that the runs kept cannot be read any more"
                                   : pair.refused()};
  }
  auto out =
      run_both(*found, {pair.before().string(), old_folder, std::nullopt, true},
               {pair.after().string(), new_folder, std::nullopt, true}, input, rule, context);
  out.rule = "runs.physics";
  return out;
}

void judge_reruns(std::vector<RuleResult>& rules) {
  std::size_t traces = 0;
  for (const auto& rule : rules) {
    if (is_answered(rule)) traces += rule.rerun->before.traces.size();
  }
  for (auto& rule : rules) {
    if (is_answered(rule)) judge(rule, 1.0 - rule.rerun->rule.worse.confidence, traces);
  }
}

}  // namespace parallax::tools
