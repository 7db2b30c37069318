#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "compiler/base/contract.h"
#include "harness/report/run_report.h"
#include "tools/diff/gate.h"
#include "tools/diff/kept_difference.h"
#include "tools/diff/textconv.h"

namespace parallax::tools {
namespace {

using compiler::FactKind;

/// A discrepancy as it is known again in another run: by the events of its trace and its cause.
struct FoundDiscrepancy {
  std::string events, cause;
  std::string sample;  // "1.4"
  std::int64_t timepoint = 0;
  std::string words, replay;
};

struct RunSummary {
  std::string name, verdict;
  bool stopped = false;                       // not all traces were examined
  std::string judged_by;                      // what decides on discrepancies
  std::string compared;                       // "Open(..) every-step, Parked() ignored"
  std::map<std::string, std::string> begins;  // initial states by events
  std::map<std::string, std::string> traces;  // verdicts by events
  std::vector<FoundDiscrepancy> discrepancies;
};

RunSummary summary_of(const std::string& name, const harness::RunReport& report) {
  RunSummary out;
  out.name = name;
  out.verdict = report.verdict;
  out.stopped = report.exploration == "stopped" || report.interrupted.value_or(false);
  out.judged_by = fmt::format("{}\n{}\n{}\n{}", report.comparison, report.execution,
                              report.criterion, report.simulator_name);
  std::map<std::int64_t, std::string> events;
  out.compared = report.compared;
  for (const auto& trace : *report.traces) {
    const auto text = fmt::format("{}", fmt::join(trace.events, " "));
    events[trace.number] = text;
    const auto all = trace.starts ? trace.starts->all : std::optional<std::int64_t>(1);
    out.begins[text] = all == 1 ? fmt::format("{}", fmt::join(trace.initial_state, " "))
                       : all    ? fmt::format("{} states", *all)
                                : std::string("more states than are listed");
    out.traces[text] = trace.verdict;
  }
  if (!report.discrepancies) return out;
  for (const auto& one : *report.discrepancies) {
    out.discrepancies.push_back({events[one.found.trace], one.found.cause.text, one.id(),
                                 one.found.first_divergence, one.words, one.replay});
  }
  return out;
}

/// A run is named by its folder or the report in it.
std::string folder_of(const std::string& path) {
  const std::filesystem::path file(path);
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) return path;
  return file.has_parent_path() ? file.parent_path().string() : ".";
}

bool has(const RunSummary& run, const FoundDiscrepancy& found) {
  for (const auto& one : run.discrepancies) {
    if (one.events == found.events && one.cause == found.cause) return true;
  }
  return false;
}

std::string trace_name(const std::string& events) {
  return events.empty() ? "the trace without events" : fmt::format("the trace {}", events);
}

/// Why it is not known that the newer run has no further discrepancy; empty: it is known as far as
/// the older run looked.
std::string unseen(const RunSummary& before, const RunSummary& after, const std::string& others) {
  if (!others.empty()) return others;
  for (const auto& [events, verdict] : before.traces) {
    const auto now = after.traces.find(events);
    if (now == after.traces.end()) {
      if (after.stopped) {
        return fmt::format("{} was stopped before {}", after.name, trace_name(events));
      }
    } else if (now->second == "inconclusive" && verdict != "inconclusive") {
      return fmt::format("{} is inconclusive on {}", after.name, trace_name(events));
    }
  }
  for (const auto& [events, verdict] : after.traces) {
    if (verdict == "inconclusive" && !before.traces.contains(events)) {
      return fmt::format("{} is inconclusive on {}", after.name, trace_name(events));
    }
  }
  return {};
}

/// Why the newer run may show less although nothing is better: it compares otherwise, or begins
/// elsewhere. Empty: it does not.
std::string other_runs(const RunSummary& before, const RunSummary& after,
                       const std::string& old_folder, const std::string& new_folder,
                       const Context& context) {
  if (before.judged_by != after.judged_by) {
    return "the runs were not judged alike: comparison, execution, criterion or simulator differ";
  }
  if (before.compared != after.compared) {
    return fmt::format("another comparison: {} compares {}; {} compares {}", before.name,
                       before.compared, after.name, after.compared);
  }
  for (const auto& [events, begin] : before.begins) {
    const auto now = after.begins.find(events);
    if (now == after.begins.end() || now->second == begin) continue;
    return fmt::format("{} begins in other initial states ({}, now {})", trace_name(events), begin,
                       now->second);
  }
  const KeptPair pair(old_folder, new_folder, context);
  const auto found = pair.refused().empty() ? pair.compare(context) : std::nullopt;
  if (!found || !found->settings) {
    return fmt::format("it is not known whether both begin and are judged alike: {}",
                       pair.refused().empty() ? "the texts that they kept cannot be read any more"
                                              : pair.refused());
  }
  for (const auto& change : *found->settings) {
    const auto has = [&](harness::Effect effect) {
      return std::find(change.effects.begin(), change.effects.end(), effect) !=
             change.effects.end();
    };
    if (has(harness::Effect::kJudgement)) {
      return "another comparison: " + change_text(change);
    }
    if (has(harness::Effect::kStarts)) return "other starts: " + change_text(change);
  }
  return {};
}

RuleResult discrepancy_rule(const RunSummary& before, const RunSummary& after,
                            const std::string& others, GateReport& report) {
  RuleResult out{"runs.gained_discrepancies", RuleOutcome::kKept, {}};
  std::size_t gained = 0;
  for (const auto& found : after.discrepancies) {
    if (has(before, found)) continue;
    if (gained++ == 0) report.drawn = {folder_of(after.name), found.sample, found.timepoint};
    out.witness += fmt::format("{}: {}\n  {}\n", found.sample, found.words, found.replay);
  }
  if (gained > 0) {
    out.outcome = RuleOutcome::kBroken;
    out.words = fmt::format("{} gained", gained);
    return out;
  }
  out.words = "none gained";
  if (auto why = unseen(before, after, others); !why.empty()) {
    out.outcome = RuleOutcome::kUndecided;
    out.words = std::move(why);
  }
  return out;
}

RuleResult run_trace_rule(const RunSummary& before, const RunSummary& after) {
  RuleResult out{"runs.lost_traces", RuleOutcome::kKept, {}};
  std::size_t lost = 0;
  for (const auto& [events, verdict] : before.traces) {
    if (after.traces.contains(events)) continue;
    ++lost;
    out.witness += trace_name(events) + '\n';
  }
  if (lost == 0) {
    out.words = before.stopped ? "none of those that were simulated" : "none lost";
  } else if (after.stopped) {
    out.outcome = RuleOutcome::kUndecided;
    out.words =
        fmt::format("{} missing, but {} was stopped before all were explored", lost, after.name);
  } else {
    out.outcome = RuleOutcome::kBroken;
    out.words = fmt::format("{} lost", lost);
  }
  return out;
}

RuleResult verdict_rule(const RunSummary& before, const RunSummary& after,
                        const std::string& others) {
  RuleResult out{"runs.worse_verdict", RuleOutcome::kKept,
                 before.verdict == after.verdict
                     ? fmt::format("{} as before", after.verdict)
                     : fmt::format("{}, before {}", after.verdict, before.verdict)};
  if (before.verdict == "discrepancy") return out;
  if (after.verdict != "discrepancy" && !others.empty()) {
    out.outcome = RuleOutcome::kUndecided;
    out.words += "; " + others;
    return out;
  }
  if (after.verdict == before.verdict) return out;
  if (after.verdict == "discrepancy") out.outcome = RuleOutcome::kBroken;
  if (after.verdict == "inconclusive") out.outcome = RuleOutcome::kUndecided;
  return out;
}

}  // namespace

base::Result<std::vector<RuleResult>> gate_runs(const GateInput& input,
                                                const harness::GateRules::Runs& rules,
                                                GateReport& report, Context& context) {
  const auto old_report = load_run_report(input.old_path, context);
  const auto new_report = load_run_report(input.new_path, context);
  if (!old_report || !new_report) return context.sink().already_reported();
  const auto old_run = harness::read_run_report(*old_report);
  const auto new_run = harness::read_run_report(*new_report);
  PARALLAX_REQUIRE(old_run && new_run, "a report that was loaded can be read");
  const auto before = summary_of(input.old_path, *old_run);
  const auto after = summary_of(input.new_path, *new_run);
  const auto others =
      rules.gained_discrepancies || rules.worse_verdict
          ? other_runs(before, after, folder_of(input.old_path), folder_of(input.new_path), context)
          : std::string();
  std::vector<RuleResult> out;
  if (rules.gained_discrepancies) out.push_back(discrepancy_rule(before, after, others, report));
  if (rules.lost_traces) out.push_back(run_trace_rule(before, after));
  if (rules.worse_verdict) out.push_back(verdict_rule(before, after, others));
  if (rules.rerun) {
    out.push_back(kept_rerun_rule(folder_of(input.old_path), folder_of(input.new_path), input,
                                  *rules.rerun, context));
  }
  if (!rules.settings) return out;
  const auto old_facts = load_run_facts(input.old_path, context);
  const auto new_facts = load_run_facts(input.new_path, context);
  if (!old_facts || !new_facts) return context.sink().already_reported();
  const auto facts = compare(*old_facts, *new_facts);
  const auto text = to_text(facts, FactKind::kDeclaration, "settings", false);
  const auto head = text.substr(0, text.find('\n'));
  if (text.empty()) {
    out.push_back({"runs.settings", RuleOutcome::kKept, "none changed"});
  } else {
    out.push_back({"runs.settings", RuleOutcome::kBroken, head.substr(head.find(": ") + 2),
                   text.substr(head.size() + 1)});
  }
  return out;
}

}  // namespace parallax::tools
