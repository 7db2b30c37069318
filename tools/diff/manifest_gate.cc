// The cases of manifests in a gate over two folders.
#include "tools/diff/manifest_gate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "compiler/base/file_io.h"
#include "compiler/base/sha256.h"
#include "compiler/base/words.h"
#include "harness/config/scenario_settings.h"
#include "tools/diff/settings_difference.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;
using harness::ManifestCase;

std::string names_from(const std::vector<harness::LocatedText>& paths, const fs::path& manifest) {
  std::vector<std::string> out;
  for (const auto& path : paths) {
    out.push_back(fs::path(path.text).lexically_relative(manifest.parent_path()).generic_string());
  }
  return fmt::format("{}", fmt::join(out, ", "));
}

/// The name and contents of a golden file: another content is another expectation.
std::string golden_text(const std::string& path, const fs::path& manifest) {
  base::DiagnosticSink unread;
  const auto text = base::read_file(path, unread);
  return fmt::format("{} ({})",
                     fs::path(path).lexically_relative(manifest.parent_path()).generic_string(),
                     text ? "SHA-256 " + base::sha256_hex(*text).substr(0, 16) : "not there");
}

/// All that the case says, as settings below the keys of a scenario that mean the same.
harness::ScenarioSettings settings_of_case(const ManifestCase& one, const fs::path& manifest) {
  harness::ScenarioSettings out;
  const auto add = [&](std::vector<std::string> path, std::string value) {
    harness::insert(out,
                    {std::move(path), std::move(value), std::nullopt, true, manifest.string(), 0});
  };
  const auto texts_of = [](const std::vector<harness::LocatedText>& list) {
    std::vector<std::string> texts;
    for (const auto& text : list) texts.push_back(text.text);
    return fmt::format("{}", fmt::join(texts, "; "));
  };
  add({"model", one.id}, names_from(one.models, manifest));
  if (one.horizon) add({"horizon", one.id}, std::to_string(*one.horizon));
  if (!one.constraints.empty()) add({"constraints", one.id}, texts_of(one.constraints));
  add({"limits", one.id, "time_s"}, fmt::format("{}", one.time_limit_s));
  if (one.memory_limit_mb) {
    add({"limits", one.id, "memory_mb"}, std::to_string(*one.memory_limit_mb));
  }
  const auto& expect = one.expect;
  if (expect.traces) add({"expect", one.id, "traces"}, std::to_string(*expect.traces));
  if (!expect.complete) add({"expect", one.id, "complete"}, "false");
  if (expect.golden) add({"expect", one.id, "golden"}, golden_text(expect.golden->text, manifest));
  if (!expect.holds.empty()) add({"expect", one.id, "holds"}, texts_of(expect.holds));
  if (!expect.violated.empty()) add({"expect", one.id, "violated"}, texts_of(expect.violated));
  return out;
}

/// The case's models as one model.
ModelOptions options_of(const ManifestCase& one, const ModelOptions& with) {
  auto out = with;
  for (std::size_t i = 1; i < one.models.size(); ++i) out.models.push_back(one.models[i].text);
  if (one.horizon) out.horizon = *one.horizon;
  return out;
}

bool is_one_file(const ManifestCase& one) { return one.models.size() == 1 && !one.horizon; }

class ManifestGate {
 public:
  ManifestGate(const std::string& name, const GateTree& before, const GateTree& after,
               const harness::GateRules& rules, const GateInput& folders, SameFiles& same,
               GateReport& out, Context& context)
      : name_(name),
        before_(before),
        after_(after),
        rules_(rules),
        folders_(folders),
        same_(same),
        out_(out),
        context_(context) {}

  void run() {
    const auto old_cases = before_.manifest(name_), new_cases = after_.manifest(name_);
    for (const auto& one : old_cases->cases) {
      const auto now = std::find_if(new_cases->cases.begin(), new_cases->cases.end(),
                                    [&](const ManifestCase& other) { return other.id == one.id; });
      if (now == new_cases->cases.end()) {
        add({name_of(one), RuleOutcome::kUndecided,
             "the case is gone: nothing is left to compare"});
      } else {
        compare(one, *now);
      }
    }
    for (const auto& one : new_cases->cases) {
      const bool is_new = std::none_of(old_cases->cases.begin(), old_cases->cases.end(),
                                       [&](const auto& other) { return other.id == one.id; });
      if (is_new) out_.remarks.push_back(name_of(one) + " is new");
    }
  }

 private:
  std::string name_of(const ManifestCase& one) const { return name_ + ':' + one.id; }
  void add(RuleResult rule) { out_.rules.push_back(std::move(rule)); }

  void compare(const ManifestCase& one, const ManifestCase& now) {
    ModelDifference said;
    said.settings = compare_settings(settings_of_case(one, before_.path_of(name_)),
                                     settings_of_case(now, after_.path_of(name_)));
    const bool are_files =
        is_one_file(one) && is_one_file(now) &&
        before_.name_of(one.models.front().text) == after_.name_of(now.models.front().text);
    const auto rules_before = out_.rules.size();
    if (!are_files) compare_models_of(one, now, *said.settings);
    if (said.settings->empty()) return;
    std::vector<std::string> unheld;
    for (const auto& rule : rules_.models->settings) {
      auto result = setting_rule(said, rule);
      if (result.outcome == RuleOutcome::kKept) continue;
      result.rule = fmt::format("{}: {}", name_of(one), result.rule);
      add(std::move(result));
    }
    for (const auto& change : *said.settings) {
      const auto& rules = rules_.models->settings;
      const bool is_held = std::any_of(rules.begin(), rules.end(),
                                       [&](const auto& rule) { return is_about(rule, change); });
      if (!is_held) unheld.push_back(change_text(change));
    }
    if (!unheld.empty()) {
      out_.remarks.push_back(
          fmt::format("{}: no rule is about {}", name_of(one), fmt::join(unheld, "; ")));
    }
    if (out_.rules.size() == rules_before) {
      add({name_of(one), RuleOutcome::kKept, "it changed, and no rule is broken"});
    }
  }

  void compare_models_of(const ManifestCase& one, const ManifestCase& now,
                         const std::vector<SettingChange>& changes) {
    const auto old_inputs = before_.inputs_of_models(one.models, before_.path_of(name_));
    const auto new_inputs = after_.inputs_of_models(now.models, after_.path_of(name_));
    const bool is_said_otherwise =
        std::any_of(changes.begin(), changes.end(), [](const SettingChange& change) {
          return change.path.front() == "model" || change.path.front() == "horizon";
        });
    const bool is_same = old_inputs.is_read && new_inputs.is_read && !is_said_otherwise &&
                         same_.all(old_inputs.names) && same_.all(new_inputs.names);
    if (is_same) return;
    for (const auto* inputs : {&old_inputs, &new_inputs}) {
      if (inputs->foreign.empty()) continue;
      return add({name_of(one), RuleOutcome::kUndecided,
                  fmt::format("{} is looked up from the current folder, for both sides the same",
                              inputs->foreign)});
    }
    auto input = folders_;
    input.old_path = one.models.front().text;
    input.new_path = now.models.front().text;
    const auto old_kind = kind_of(input.old_path), new_kind = kind_of(input.new_path);
    const bool are_models = old_kind && new_kind && has_traces(*old_kind) && has_traces(*new_kind);
    if (!are_models) {
      return add({name_of(one), RuleOutcome::kUndecided, "it is no model on both sides"});
    }
    // The horizon of a case replaces that of a scenario for its properties and traces alone.
    const bool is_replaced = *old_kind == RevisionKind::kScenario && (one.horizon || now.horizon);
    if (is_replaced) {
      return add({name_of(one), RuleOutcome::kUndecided,
                  "a scenario with a horizon of the case is not compared"});
    }
    input.old_kind = *old_kind;
    input.new_kind = *new_kind;
    input.models.old_model = options_of(one, folders_.models.load.model);
    input.models.new_model = options_of(now, folders_.models.load.model);
    auto rules = rules_;
    rules.models->settings.clear();
    rules.models->rerun.reset();
    Context own(context_.form(), context_.stop());
    auto report = hold_gate(input, rules, own);
    if (!report) {
      const auto told = own.sink().sorted();
      return add({name_of(one), RuleOutcome::kUndecided,
                  "it cannot be compared: " +
                      (told.empty() ? std::string("it was stopped") : told.front().message)});
    }
    bool all_kept = true;
    for (auto& rule : report->rules) {
      if (rule.outcome == RuleOutcome::kKept) continue;
      all_kept = false;
      rule.rule = fmt::format("{}: {}", name_of(one), rule.rule);
      add(std::move(rule));
    }
    for (const auto& remark : report->remarks) {
      out_.remarks.push_back(name_of(one) + ": " + remark);
    }
    if (all_kept && changes.empty()) {
      add({name_of(one), RuleOutcome::kKept,
           fmt::format("its models changed, and {} about them kept",
                       base::counted(std::ssize(report->rules), "rule is", "rules are"))});
    }
  }

  const std::string& name_;
  const GateTree& before_;
  const GateTree& after_;
  const harness::GateRules& rules_;
  const GateInput& folders_;
  SameFiles& same_;
  GateReport& out_;
  Context& context_;
};

}  // namespace

void hold_manifest(const std::string& name, const GateTree& before, const GateTree& after,
                   const harness::GateRules& rules, const GateInput& folders, SameFiles& same,
                   GateReport& out, Context& context) {
  ManifestGate(name, before, after, rules, folders, same, out, context).run();
}

}  // namespace parallax::tools
