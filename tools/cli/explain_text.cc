#include "tools/cli/explain_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/json.h"
#include "compiler/base/word_table.h"
#include "compiler/base/words.h"
#include "harness/report/text_layout.h"

namespace parallax::tools {

std::string origin_place(const compiler::Origin& origin) {
  if (origin.place.file.empty()) return {};
  return base::printable(origin.place.file) + ':' + std::to_string(origin.place.begin.line);
}

std::string axiom_text(const compiler::Origin& origin) {
  if (origin.kind == compiler::OriginKind::kFrameAxiom) return "inertia of " + origin.text;
  return origin.text.empty() ? std::string(to_string(origin.kind)) : origin.text;
}

namespace {

using nlohmann::ordered_json;
using runtime::ProofVerdict;

constexpr std::size_t kShownInstances = 6;  // of one axiom, in text

bool is_smallest(const runtime::MinimalSets& found) {
  return found.proven && (found.sets.empty() || found.lower_bound == 0 ||
                          found.sets.front().size() <= found.lower_bound);
}

/// Tells what is known of the sets that are not shown.
std::string claim(const runtime::MinimalSets& found, const SetOptions& options) {
  if (options.all) {
    return found.proven ? "these are all minimal sets" : "stopped: there may be further sets";
  }
  if (found.proven && !is_smallest(found)) {
    return fmt::format("none of its axioms can go; a smallest set has {}", found.lower_bound);
  }
  if (found.proven) return "no fewer axioms do";
  return fmt::format("stopped: fewer may do, but at least {}",
                     std::max<std::size_t>(found.lower_bound, 1));
}

constexpr auto kProofVerdictWords =
    base::word_table<ProofVerdict>("checked", "not accepted", "not checked");

/// The observations that the sets contradict.
std::string observed_text(const ObservedRun* run, bool verbose = true) {
  std::string out;
  if (run == nullptr) return out;
  for (std::size_t i = verbose ? 0 : run->shown_from; i < run->lines.size(); ++i) {
    out += "  observed: " + base::printable(run->lines[i]) + '\n';
  }
  return out;
}

std::string proof_words(const Contradiction& set) {
  return set.no_proof.empty() ? fmt::format("proof {}", kProofVerdictWords.of(set.proof))
                              : set.no_proof;
}

/// An instance on a line of its own.
std::string shortened(const std::string& instance) {
  constexpr std::size_t kMost = 160;
  if (instance.size() <= kMost) return instance;
  const auto end = instance.rfind(' ', kMost);
  return instance.substr(0, end == std::string::npos ? kMost : end) + " ...";
}

}  // namespace

std::string contradiction_head(const runtime::MinimalSets& found, const SetOptions& options,
                               const ObservedRun* run, bool verbose) {
  return fmt::format("The model has no trace{}; {} of axioms that contradict {} ({}):\n{}",
                     run != nullptr ? " in which this happens" : "",
                     base::counted(found.sets.size(), "minimal set"),
                     run != nullptr ? "it" : "each other", claim(found, options),
                     observed_text(run, verbose));
}

std::string contradiction_text(const compiler::CompiledModel& model, std::size_t number,
                               const Contradiction& set, Instances shown,
                               const std::string& words) {
  auto out = fmt::format("set {}: {} ({}{})\n", number, base::counted(set.axioms.size(), "axiom"),
                         proof_words(set),
                         set.instances_minimal ? "" : "; instances not minimal: stopped");
  if (!words.empty()) out += harness::wrapped("  ", words, 2);
  for (const auto& axiom : set.axioms) {
    const auto& origin = model.origins[axiom.origin];
    const auto place = origin_place(origin);
    out += fmt::format("  {}{}\n", place.empty() ? "" : place + "  ", axiom_text(origin));
    if (shown == Instances::kNone) continue;
    const auto& instances = axiom.instances;
    for (std::size_t i = 0; i < instances.size() && i < kShownInstances; ++i) {
      const auto text = shown == Instances::kShort ? shortened(instances[i]) : instances[i];
      out += "      " + text + '\n';
    }
    if (instances.size() > kShownInstances) {
      out += fmt::format("      ... and {}\n",
                         base::counted(instances.size() - kShownInstances, "further instance"));
    }
  }
  return out;
}

std::string run_words_text(const RecordedDiscrepancy& found, const std::string& words) {
  auto out = harness::wrapped("", words, 0);
  if (!found.parting) return out;
  const auto more = consequence_words(found.path, *found.parting);
  if (!more.empty()) out += harness::wrapped("", more, 0);
  return out + '\n';
}

namespace {

ordered_json contradictions_document(const compiler::CompiledModel& model,
                                     const runtime::MinimalSets& found, const SetOptions& options,
                                     const ObservedRun* run,
                                     const std::vector<Contradiction>& sets) {
  ordered_json document = {{"status", "ok"},
                           {"satisfiable", false},
                           {"smallest", !options.all && is_smallest(found)},
                           {"complete", options.all && found.proven}};
  if (run != nullptr) document["observed"] = run->lines;
  auto list = ordered_json::array();
  for (const auto& set : sets) {
    auto axioms = ordered_json::array();
    for (const auto& axiom : set.axioms) {
      const auto& origin = model.origins[axiom.origin];
      axioms.push_back({{"file", origin.place.file},
                        {"line", origin.place.begin.line},
                        {"column", origin.place.begin.column},
                        {"what", to_string(origin.kind)},
                        {"text", origin.text},
                        {"instances", axiom.instances}});
    }
    list.push_back({{"size", set.axioms.size()},
                    {"proof", set.no_proof.empty() ? kProofVerdictWords.of(set.proof) : "none"},
                    {"instances_minimal", set.instances_minimal},
                    {"axioms", std::move(axioms)}});
    if (!set.no_proof.empty()) list.back()["no_proof"] = set.no_proof;
  }
  document["sets"] = std::move(list);
  return document;
}

ordered_json rule_json(const harness::FailureRule& rule,
                       const std::vector<std::string>& parameters) {
  auto borders = ordered_json::array();
  for (const auto& border : rule.borders) {
    borders.push_back({{"parameter", parameters[border.parameter]},
                       {"side", border.above ? "above" : "at-most"},
                       {"value", border.value}});
  }
  return {{"borders", std::move(borders)},
          {"text", harness::rule_text(rule.borders, parameters)},
          {"failures_inside", rule.failures_inside},
          {"failures", rule.failures},
          {"clean_inside", rule.clean_inside},
          {"clean", rule.clean},
          {"accuracy", rule.accuracy}};
}

ordered_json state_rule_json(const harness::StateRule& rule) {
  auto literals = ordered_json::array();
  for (const auto& [fluent, value] : rule.literals) {
    literals.push_back({{"fluent", fluent}, {"value", value}});
  }
  return {{"literals", std::move(literals)},         {"text", harness::state_words(rule)},
          {"failures_inside", rule.failures_inside}, {"failures", rule.failures},
          {"clean_inside", rule.clean_inside},       {"clean", rule.clean}};
}

constexpr auto kRoleWords =
    base::word_table<Difference::Role>("first", "follows", "same-action", "further");

}  // namespace

std::string contradictions_json(const compiler::CompiledModel& model,
                                const runtime::MinimalSets& found, const SetOptions& options,
                                const ObservedRun* run, const std::vector<Contradiction>& sets) {
  return base::json_text(contradictions_document(model, found, options, run, sets)) + '\n';
}

std::string run_contradictions_json(const RecordedDiscrepancy& found,
                                    const runtime::MinimalSets& sets_found,
                                    const SetOptions& options, const ObservedRun& run,
                                    const std::vector<Contradiction>& sets,
                                    const std::vector<std::string>& words,
                                    const CauseEvidence& cause) {
  auto document =
      contradictions_document(found.loaded.compilation.model, sets_found, options, &run, sets);
  for (std::size_t i = 0; i < words.size(); ++i) document["sets"][i]["words"] = words[i];
  document["sample"] = fmt::format("{}.{}", found.path.id.trace, found.path.id.sample);
  document["timepoint"] = found.parting->after;
  auto differences = ordered_json::array();
  for (const auto& difference : found.parting->differences) {
    differences.push_back({{"fluent", difference.name},
                           {"timepoint", found.parting->after},
                           {"predicted", !difference.observed},
                           {"observed", difference.observed},
                           {"role", kRoleWords.of(difference.role)}});
  }
  document["differences"] = std::move(differences);
  const auto& finding = cause.finding;
  document["cause"] = to_string(finding.kind);
  document["cause_words"] = cause.words();
  if (finding.where) document["where"] = state_rule_json(*finding.where);
  if (finding.rule) document["rule"] = rule_json(*finding.rule, cause.parameters);
  for (const auto& border : finding.borders) {
    document["borders"].push_back(
        {{"parameter", border.parameter}, {"fails_at", border.fails}, {"not_at", border.other}});
  }
  document["evidence"] = {{"runs", finding.runs},
                          {"failures", finding.failures},
                          {"contradictory_starts", finding.contradictory_starts},
                          {"otherwise", cause.otherwise},
                          {"further", cause.further}};
  const auto add = [&](const char* name, const std::optional<harness::Persistence>& seen) {
    if (!seen) return;
    document["evidence"][name] = {{"runs", seen->runs}, {"failures", seen->failures}};
  };
  add("other_seeds", finding.other_seeds);
  add("half_step", finding.half_step);
  return base::json_text(document) + '\n';
}

std::string where_text(const CauseEvidence& cause) {
  const auto where = cause.where();
  return where.empty() ? where : harness::wrapped("", where, 0);
}

std::string cause_text(const CauseEvidence& cause) {
  auto out = cause.words();
  if (cause.otherwise > 0) {
    out += fmt::format(" {} went otherwise and {} left out.", base::counted(cause.otherwise, "run"),
                       base::agreed(cause.otherwise, "is", "are"));
  }
  if (cause.further > 0) {
    out += fmt::format(" {} made for this.",
                       base::counted(cause.further, "further run was", "further runs were"));
  }
  if (!cause.not_made.empty()) out += fmt::format(" No further runs: {}.", cause.not_made);
  return harness::wrapped("", out, 0);
}

std::string no_contradiction_text(const compiler::CompiledModel& model, const ObservedRun* run) {
  if (run != nullptr) return "The model admits what was observed.\n" + observed_text(run);
  return fmt::format(
      "The model has a trace up to timepoint {}: its axioms do not contradict each other.\n",
      model.horizon);
}

std::string no_contradiction_json() {
  return "{\"status\":\"ok\",\"satisfiable\":true,\"sets\":[]}\n";
}

}  // namespace parallax::tools
