#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "harness/campaign/start_words.h"
#include "harness/confidence/family.h"
#include "harness/confidence/rounding.h"
#include "tools/page/gather.h"

namespace parallax::tools {

std::string sample_name(std::int64_t trace, std::int64_t sample) {
  return fmt::format("{}.{}", trace, sample);
}

namespace {

PagePath path_of(const harness::PathCount& path) {
  constexpr std::size_t kMostSteps = 60;
  PagePath out;
  const auto &events = path.events, &outcomes = path.outcomes;
  for (std::size_t i = 0; i < events.size() && i < kMostSteps; ++i) {
    out.steps += (i > 0 ? ", " : "") + events[i];
    if (i < outcomes.size() && outcomes[i] != "ok") out.steps += ": " + outcomes[i];
  }
  if (events.size() > kMostSteps) out.steps += ", ...";
  out.end = std::string(to_string(path.end)) + (path.detail.empty() ? "" : ": " + path.detail);
  out.simulations = path.runs;
  out.example = path.example;
  return out;
}

/// "12 of 14 behaviours shown; each of the others comes in fewer than 5 % of executions"
std::string covered_text(const harness::ReportedCover& cover) {
  auto out = fmt::format("{} of {} behaviours of plan and model shown", cover.shown, cover.items);
  if (cover.shown < cover.items && cover.bound < 1.0) {
    out += fmt::format("; each of the others comes in fewer than {} of executions ({} confidence)",
                       harness::percent_up(cover.bound), harness::level_text(cover.confidence));
  }
  const bool is_open = cover.shown < cover.items && !cover.end.empty();
  return is_open ? out + "; ended by: " + cover.end : out;
}

PageTrace trace_of(harness::ReportedTrace& reported) {
  PageTrace out;
  out.number = reported.number;
  out.verdict = std::move(reported.verdict);
  out.claim = std::move(reported.claim);
  out.caveats = std::move(reported.caveats);
  out.simulations = reported.simulations.value_or(0);
  out.clean = reported.clean.value_or(0);
  out.lost = reported.lost.value_or(0);
  out.losses = std::move(reported.losses);
  out.certified_confidence = reported.confidence.value_or(0.0);
  out.certified_epsilon = reported.epsilon.value_or(1.0);
  const double share = reported.error_share.value_or(1.0);
  if (share > 0.0 && share <= 1.0) out.error_share = std::max(share, 1e-6);
  out.paper_variant = std::move(reported.paper_variant);
  out.paper_stopped_at = reported.paper_stopped_at;
  out.not_covered = std::move(reported.not_covered);
  out.initial_state = std::move(reported.initial_state);
  out.chosen_starts = reported.chosen_starts.value_or(0);
  out.unfinished = reported.unfinished.value_or(0);
  if (reported.cover) out.covered = covered_text(*reported.cover);
  for (const auto& path : reported.paths) out.paths.push_back(path_of(path));
  reported.sources.resize(reported.events.size());
  for (std::size_t i = 0; i < reported.events.size(); ++i) {
    out.steps.push_back({reported.events[i], reported.sources[i], {}, {}, {}});
  }
  if (reported.starts) {
    const auto& starts = *reported.starts;
    out.all_states = harness::states_text(starts);
    for (const auto& [number, counts] : starts.states) {
      out.states.push_back({number, counts.text, counts.clean, counts.lost, counts.discrepancies});
    }
  }
  for (const auto& cause : reported.causes) {
    out.causes.push_back({cause.cause, cause.count, cause.rate, cause.lower, cause.upper});
  }
  return out;
}

std::optional<harness::SpendingRule> spending_of(
    const std::optional<harness::ReportedFamily>& family) {
  if (!family) return std::nullopt;
  const auto traces = family->traces.value_or(0);
  constexpr std::int64_t kMost = 1'000'000;
  return harness::SpendingRule(traces > 0 ? std::optional(std::min(traces, kMost)) : std::nullopt);
}

void add_criterion(harness::CriterionSpec spec,
                   const std::optional<harness::SpendingRule>& spending, PageData& page) {
  spec.confidence_level = std::clamp(spec.confidence_level, 0.01, 1.0 - 1e-9);
  spec.epsilon = std::clamp(spec.epsilon, 1e-9, 1.0 - 1e-9);
  page.criterion = harness::criterion_text(spec, spending);
  page.confidence = spec.confidence_level;
  page.epsilon = spec.epsilon;
  page.is_paper = spec.kind == harness::CriterionKind::kPaper;
  page.asked = std::move(spec);
}

}  // namespace

bool add_report(const std::string& text, PageData& page) {
  auto report = harness::read_run_report(text);
  if (!report || !report->traces) return false;
  page.scenario = report->scenario;
  page.verdict = report->verdict;
  page.seed = report->seed.value_or(0);
  page.simulations = report->simulations.value_or(0);
  page.tool_version = report->tool_version;
  page.exploration = report->exploration;
  page.bounds = report->bounds;
  page.ignored = report->ignored;
  page.interrupted = report->interrupted.value_or(false);
  page.closed_loop = report->execution == to_string(harness::Execution::kClosedLoop);
  if (!report->simulator.empty()) {
    page.simulator = report->simulator_name + ' ' + report->simulator_version;
  }
  if (report->criterion_spec) {
    add_criterion(*report->criterion_spec, spending_of(report->family), page);
  }
  if (report->family) page.claim = report->family->claim;
  for (auto& trace : *report->traces) page.traces.push_back(trace_of(trace));
  if (report->discrepancies) page.discrepancies = *std::move(report->discrepancies);
  for (const auto& share : report->coverage) {
    page.coverage.push_back(
        {share.group, std::to_string(share.covered), std::to_string(share.all)});
  }
  if (report->opinion) {
    page.opinion_of = report->opinion->other;
    page.opinion_sentences = report->opinion->sentences;
  }
  if (page.interrupted) {
    page.banners.push_back("The run was interrupted: what is claimed is what it had come to.");
  }
  return true;
}

}  // namespace parallax::tools
