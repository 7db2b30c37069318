// A gate over two folders.
//
// Each scenario, each model of a manifest, and each that nothing reads, is read as far as needed to
// know which files belong to it, wherever these lie. That is done in the old folder; in the new one
// only where one of these files differs, as equal texts name equal files. Only there are the two
// revisions compiled and compared. Cost: reading what belongs to the old scenarios and models, and
// one comparison for each that changed.

#include "tools/diff/tree_gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/file_names.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/words.h"
#include "tools/diff/gate_tree.h"
#include "tools/diff/manifest_gate.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

bool is_plan(RevisionKind kind) {
  return kind == RevisionKind::kPlan || kind == RevisionKind::kBinding;
}

/// Compares what is at one place of both folders.
std::vector<RuleResult> rules_at(const std::string& name, const GateTree& before,
                                 const GateTree& after, const harness::GateRules& rules,
                                 const GateInput& folders, GateReport& all, Context& context) {
  Context own(context.form(), context.stop());
  auto input = folders;
  input.old_path = before.path_of(name).string();
  input.new_path = after.path_of(name).string();
  input.old_kind = *before.kind_at(name);
  input.new_kind = *after.kind_at(name);
  std::vector<RuleResult> out;
  const bool are_rates =
      input.old_kind == RevisionKind::kRates && input.new_kind == RevisionKind::kRates;
  const bool are_plans = input.old_kind == input.new_kind && is_plan(input.old_kind);
  if (!are_rates && !are_plans && (!has_traces(input.old_kind) || !has_traces(input.new_kind))) {
    out.push_back({name, RuleOutcome::kUndecided, "it is no model on both sides"});
    return out;
  }
  auto report = hold_gate(input, rules, own);
  if (!report) {
    const auto said = own.sink().sorted();
    out.push_back({name, RuleOutcome::kUndecided,
                   "it cannot be compared: " +
                       (said.empty() ? std::string("it was stopped") : said.front().message)});
    return out;
  }
  for (auto& rule : report->rules) {
    // Evidence is shown in any case.
    if (rule.outcome == RuleOutcome::kKept && !rule.rerun && !are_rates) continue;
    rule.rule = fmt::format("{}: {}", name, rule.rule);
    out.push_back(std::move(rule));
  }
  for (const auto& remark : report->remarks) all.remarks.push_back(name + ": " + remark);
  if (out.empty()) {
    out.push_back({name, RuleOutcome::kKept,
                   fmt::format("it changed, and {} kept",
                               report->rules.size() == 1
                                   ? "the rule is"
                                   : fmt::format("all {} rules are", report->rules.size()))});
  }
  return out;
}

std::set<std::string> manifests_of(const GateTree& before, const GateTree& after) {
  auto out = before.manifests();
  out.insert(after.manifests().begin(), after.manifests().end());
  return out;
}

/// Results of rates that both folders have and that differ: they share the error of a gate.
std::size_t count_changed_rates(const GateTree& before, const GateTree& after, SameFiles& same) {
  std::size_t out = 0;
  for (const auto& [name, kind] : before.subjects()) {
    const bool is_pair = kind == RevisionKind::kRates && after.kind_at(name) == kind;
    out += is_pair && !same.all({name}) ? 1 : 0;
  }
  return out;
}

/// Where each of two folders has what a command names from the current one: a command that is
/// started in one of them is started at the same place of the other.
void add_command_folders(const fs::path& before, const fs::path& after, ModelDiffOptions& options) {
  const auto here = base::real_path(".");
  const bool in_old = base::lies_below(here, before), in_new = base::lies_below(here, after);
  // Where one folder lies in the other, both hold what lies in the inner one.
  const bool old_is_inner = base::lies_below(before, after);
  const auto& anchor = in_old && (!in_new || old_is_inner) ? before : after;
  const auto side = [&](const fs::path& root) {
    CommandFolder out{root, {}, {before, after}};
    const bool is_above = base::lies_below(anchor, here);
    if (in_old || in_new || is_above) {
      out.current.push_back((root / here.lexically_relative(anchor)).lexically_normal());
    }
    if (!in_old && !in_new) out.current.push_back(here);
    return out;
  };
  options.old_commands = side(before);
  options.new_commands = side(after);
}

}  // namespace

bool is_tree(const std::string& path) {
  std::error_code error;
  return fs::is_directory(path, error) && !is_run_folder(path);
}

base::Result<GateReport> hold_tree_gate(const GateInput& folders, const harness::GateRules& rules,
                                        Context& context) {
  if (!rules.models && !rules.rates && !rules.plans) {
    return context.sink().error(codes::kNoGateRules, rules.source, "models");
  }
  const auto &old_folder = folders.old_path, &new_folder = folders.new_path;
  auto input = folders;
  auto& options = input.models;
  if (!options.old_commands || !options.new_commands) {
    add_command_folders(base::real_path(old_folder), base::real_path(new_folder), options);
  }
  auto old_load = options.load, new_load = options.load;
  old_load.commands = options.old_commands;
  new_load.commands = options.new_commands;
  SameFiles same(base::absolute_name(old_folder), base::absolute_name(new_folder));
  const GateTree before(old_folder, old_load, rules, same, nullptr, context);
  const GateTree after(new_folder, new_load, rules, same, &before, context);
  input.results = count_changed_rates(before, after, same);
  GateReport out;
  out.kind = "tree";
  out.old_name = old_folder;
  out.new_name = new_folder;
  out.undecided_passes = rules.undecided_passes;
  std::int64_t untouched = 0, untouched_plans = 0;
  std::set<std::string> subjects, broken = before.broken(), added;
  for (const auto* tree : {&before, &after}) {
    for (const auto& [name, kind] : tree->subjects()) subjects.insert(name);
    broken.insert(tree->broken().begin(), tree->broken().end());
  }
  for (const auto& name : broken) {
    const bool in_old = before.broken().contains(name), in_new = after.broken().contains(name);
    out.rules.push_back({name, RuleOutcome::kUndecided,
                         in_old && in_new ? "it cannot be read on either side"
                         : in_old         ? "it cannot be read on the old side"
                                          : "it cannot be read on the new side"});
  }
  if (subjects.empty() && broken.empty() && manifests_of(before, after).empty()) {
    out.rules.push_back({rules.models  ? "models"
                         : rules.plans ? "plans"
                                       : "rates",
                         RuleOutcome::kUndecided,
                         fmt::format("neither folder has {}: nothing can be compared",
                                     rules.models  ? "a scenario or a model"
                                     : rules.plans ? "a plan or a binding table"
                                                   : "a result of `rates --json`")});
  }
  for (const auto& name : subjects) {
    if (broken.contains(name)) continue;
    if (!after.kind_at(name)) {
      out.rules.push_back(
          {name, RuleOutcome::kUndecided, "it is gone: nothing is left to compare"});
      continue;
    }
    const auto& new_inputs = after.inputs_of(name);
    if (!before.kind_at(name)) {
      added.insert(name);
      if (!new_inputs.is_read) {
        out.rules.push_back({name, RuleOutcome::kUndecided, "it is new, and cannot be read"});
      }
      continue;
    }
    const auto& old_inputs = before.inputs_of(name);
    if (!old_inputs.foreign.empty() || !new_inputs.foreign.empty()) {
      out.rules.push_back(
          {name, RuleOutcome::kUndecided,
           fmt::format("{} is looked up from the current folder, for both sides the same: name it "
                       "from the folder of the file that loads it",
                       old_inputs.foreign.empty() ? new_inputs.foreign : old_inputs.foreign)});
      continue;
    }
    if (old_inputs.is_read && new_inputs.is_read &&
        old_inputs.command_hash == new_inputs.command_hash && same.all(old_inputs.names) &&
        same.all(new_inputs.names)) {
      const auto kind = *before.kind_at(name);
      untouched += has_traces(kind) ? 1 : 0;
      untouched_plans += is_plan(kind) ? 1 : 0;
      continue;
    }
    auto found = rules_at(name, before, after, rules, input, out, context);
    std::move(found.begin(), found.end(), std::back_inserter(out.rules));
  }
  for (const auto& name : manifests_of(before, after)) {
    if (broken.contains(name)) continue;
    if (!after.manifest(name)) {
      out.rules.push_back({name, RuleOutcome::kUndecided,
                           after.kind_at(name) ? "it is no manifest any more"
                                               : "it is gone: nothing is left to compare"});
    } else if (!before.manifest(name)) {
      if (!before.kind_at(name)) added.insert(name);
    } else {
      hold_manifest(name, before, after, rules, input, same, out, context);
    }
  }
  judge_reruns(out.rules);
  for (const auto& name : added) out.remarks.push_back(name + " is new");
  if (untouched > 0) {
    out.remarks.push_back(
        fmt::format("no file of {} changed",
                    base::counted(untouched, "scenario or model", "scenarios and models")));
  }
  if (untouched_plans > 0) {
    out.remarks.push_back(fmt::format(
        "no file of {} changed",
        base::counted(untouched_plans, "plan or binding table", "plans and binding tables")));
  }
  return out;
}

}  // namespace parallax::tools
