#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/words.h"
#include "harness/campaign/result_json.h"
#include "harness/campaign/sample_record.h"
#include "harness/campaign/start_words.h"
#include "harness/confidence/clean_runs.h"
#include "harness/confidence/criterion.h"
#include "harness/confidence/family.h"
#include "harness/confidence/rounding.h"
#include "harness/report/opinion_words.h"
#include "harness/report/report.h"
#include "harness/report/report_words.h"
#include "harness/report/standing.h"
#include "harness/report/start_lines.h"
#include "harness/report/text_layout.h"

namespace parallax::harness {
namespace {

class TextReport {
 public:
  TextReport(const CampaignResult& result, const ReportStyle& style)
      : result_(result), style_(style) {}

  std::string write() {
    head();
    for (const auto& trace : result_.traces) one_trace(trace);
    foot();
    return std::move(out_);
  }

 private:
  std::string verdict(CampaignVerdict verdict) const { return verdict_word(verdict, style_.color); }

  void line(std::string_view label, std::string_view text, std::size_t indent = 2) {
    out_ += labelled(label, text, indent);
  }

  void head() {
    out_ += fmt::format("scenario {}\n", base::printable(result_.scenario));
    if (!result_.title.empty()) line("about", result_.title);
    const auto& simulator = result_.simulator;
    auto text = simulator.name.empty() ? std::string("none was started")
                                       : fmt::format("{} {}", simulator.name, simulator.version);
    if (simulator.timestep_s > 0.0) {
      text += fmt::format(", steps of {:.6g} ms", 1000.0 * simulator.timestep_s);
    }
    line("simulator", text);
    if (!result_.arms.empty()) line("arms", result_.arms);
    line("seed", fmt::format("{}", result_.seed));
    line("criterion", criterion_text(result_.criterion, result_.spending));
    line("source", source_of(result_.criterion.kind));
    if (result_.execution == Execution::kClosedLoop) {
      line("execution", "closed-loop: the plan goes on by what the simulator reports");
    }
    compared();
  }

  /// Lists the compared fluents by when they are compared, and the ignored ones with the reason.
  void compared() {
    using How = ComparedFluents::How;
    for (const auto& [how, label] : {std::pair{How::kEveryStep, "every step"},
                                     {How::kAtTheEnd, "only the end"},
                                     {How::kAtTheStart, "at the start"}}) {
      std::vector<std::string> names;
      for (const auto& entry : result_.compared) {
        if (entry.how == how) names.push_back(entry.fluent);
      }
      if (!names.empty()) line(label, fmt::format("{}", fmt::join(names, ", ")));
    }
    std::vector<std::pair<std::string, std::string>> ignored;  // why, names; in order
    for (const auto& entry : result_.compared) {
      if (entry.how != How::kIgnored) continue;
      const auto same = std::find_if(ignored.begin(), ignored.end(),
                                     [&](const auto& known) { return known.first == entry.why; });
      if (same != ignored.end()) {
        same->second += ", " + entry.fluent;
      } else {
        ignored.emplace_back(entry.why, entry.fluent);
      }
    }
    for (const auto& [why, names] : ignored) {
      line("not compared", why.empty() ? names : fmt::format("{}: {}", names, why));
    }
  }

  void one_trace(const TraceResult& trace) {
    if (trace.loop) {
      out_ += fmt::format("\nexecutions: {}\n", verdict(trace.verdict));
      out_ += execution_paths(*trace.loop);
    } else {
      out_ += fmt::format("\ntrace {}: {}\n", trace.trace->number, verdict(trace.verdict));
      events(trace);
      out_ += start_lines(trace);
    }
    if (!trace.starts.is_single()) {
      out_ += initial_state_lines(trace.loop ? "tried" : "start states", trace.starts);
    }
    if (trace.search) line("searched", search_text(*trace.search, trace.trace->number));
    if (trace.law) out_ += law_lines(*trace.law);
    auto runs = fmt::format("{} ({} clean", trace.simulations, trace.clean);
    if (trace.admitted > 0) {
      runs += fmt::format(", {} of them otherwise, as the model admits", trace.admitted);
    }
    if (trace.lost > 0) runs += fmt::format(", {} lost", trace.lost);
    if (trace.loop && trace.loop->unfinished > 0) {
      runs += fmt::format(", {} not ended", trace.loop->unfinished);
    }
    runs += ')';
    if (trace.rejected > 0) {
      runs += fmt::format("; {} drawn again", base::counted(trace.rejected, "invalid start was",
                                                            "invalid starts were"));
    }
    line("simulations", runs);
    for (const auto& lost : trace.losses) {
      line("lost", fmt::format("{}: {}, first in {}.{}", base::counted(lost.count, "run", "runs"),
                               lost.kind, trace.trace->number, lost.example));
    }
    line("claimed", trace.claim);
    if (trace.loop) {
      certified(trace);
    } else {
      figures(trace);
    }
    if (trace.loop) causes(*trace.loop);
    if (trace.loop && trace.loop->cover) shown(*trace.loop->cover);
    for (const auto& caveat : trace.caveats) line("note", caveat);
    for (const auto& found : result_.discrepancies) {
      if (found.trace == trace.trace->number) discrepancy(found, trace);
    }
  }

  void events(const TraceResult& trace) {
    if (trace.trace->event_count() == 0)
      return line("events", "none: the start itself is compared");
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < trace.trace->event_count(); ++i) {
      rows.push_back({fmt::format("{}", i), trace.trace->event(i), trace.trace->plan[i].source});
    }
    auto text = table(rows, kReportLabels);
    text.replace(0, 8, "  events");
    out_ += text;
  }

  void causes(const LoopResult& loop) {
    for (const auto& rate : loop.causes) {
      line("cause",
           fmt::format("{}: {}, first in 1.{}", rate.cause, rate_words(loop, rate), rate.example));
    }
  }

  void shown(const CoverResult& cover) {
    line("shown", cover_text(cover));
    items("not shown", cover.left);
    items("impossible", cover.unreachable);
  }
  void items(std::string_view label, const std::vector<CoverItem>& items) {
    constexpr std::size_t kMaxItems = 50;
    for (std::size_t i = 0; i < items.size() && i < kMaxItems; ++i) {
      line(label, fmt::format("{}  {}", items[i].place, items[i].what));
    }
    if (items.size() > kMaxItems) line(label, fmt::format("{} more", items.size() - kMaxItems));
  }

  void certified(const TraceResult& trace) {
    if (trace.verdict != CampaignVerdict::kDiscrepancy) {
      line("certified",
           trace.certified_epsilon < 1.0
               ? fmt::format("with {} confidence p < {}", level_text(trace.certified_level),
                             percent_up(trace.certified_epsilon))
               : std::string("nothing"));
    }
  }

  /// Both confidence figures side by side: what is certified, and what the paper's rule says.
  void figures(const TraceResult& trace) {
    certified(trace);
    if (trace.admitted > 0) {
      return line("paper's rule", "not evaluated: it supposes a single end state");
    }
    const auto paper = trace.paper_stopped_at
                           ? fmt::format("satisfied after {} ({}) [not a probability of error]",
                                         base::counted(*trace.paper_stopped_at, "run", "runs"),
                                         trace.paper_variant)
                           : fmt::format("not satisfied within {} ({})",
                                         base::counted(trace.clean, "clean run", "clean runs"),
                                         trace.paper_variant);
    line("paper's rule", paper);
    if (style_.figures && trace.paper_figures) regression(*trace.paper_figures);
  }

  /// b, sigma and interval of each final parameter, for a check by hand.
  void regression(const PaperFigures& figures) {
    const auto& verdict = figures.verdict;
    if (verdict.intervals.empty()) return line("regression", verdict.why_not);
    line("regression",
         fmt::format("s = {} runs, {} = {:.6f}", figures.runs,
                     result_.criterion.paper.interval == IntervalKind::kMean ? "Z" : "t",
                     verdict.z));
    const bool has_intercept = result_.criterion.paper.intercept != InterceptKind::kNone;
    for (const auto& one : verdict.intervals) {
      std::vector<std::string> b;
      for (std::size_t i = 0; i < figures.x_names.size(); ++i) {
        if (figures.x_range[i].width() <= 0.0) continue;
        b.push_back(fmt::format("{} {:.6g}", figures.x_names[i], one.coefficients[i]));
      }
      if (has_intercept) b.push_back(fmt::format("1 {:.6g}", one.intercept));
      line(
          one.name,
          fmt::format("{} {} cell {}, sigma {:.6g}, b: {}", interval_text(one.lower, one.upper),
                      one.inside ? "inside" : "not inside",
                      interval_text(one.cell.lower, one.cell.upper), one.sigma, fmt::join(b, ", ")),
          4);
    }
    if (!verdict.exempt.empty()) {
      line("exempt", fmt::format("{}", fmt::join(verdict.exempt, ", ")), 4);
    }
  }

  static std::string interval_text(double lower, double upper) {
    return fmt::format("[{:.6g}, {:.6g}]", lower, upper);
  }

  void discrepancy(const Discrepancy& found, const TraceResult& trace) {
    const auto id = fmt::format("{}.{}", found.trace, found.sample);
    out_ += fmt::format("\n  {} in simulation {}, seed {}, {}\n",
                        painted("discrepancy", "1;31", style_.color), id, found.seed,
                        confirmation(found));
    line("standing", standing_of(result_, found).words, 4);
    line("cause", cause(found), 4);
    if (found.path) return path_discrepancy(found);
    const bool on_the_way =
        found.first_divergence < static_cast<std::int64_t>(trace.trace->event_count());
    if (on_the_way) parting(found, trace);
    if (found.kind == DiscrepancyKind::kTransient) {
      line("transient", "it ends as predicted, having differed on the way", 4);
    }
    std::vector<std::vector<std::string>> rows = {{"fluent", "timepoint", "predicted", "observed"}};
    const bool every_step = result_.comparison == Comparison::kEveryStep;
    if (every_step && on_the_way) {
      for (const auto& fluent : found.first) rows.push_back(row(fluent));
    }
    for (const auto& fluent : found.fluents) rows.push_back(row(fluent));
    out_ += table(rows, 4);
    unusual_outcomes(found, trace);
    line("start", values(found.record.initial), 4);
    line("end", values(found.end), 4);
    replay(found);
  }

  /// Lists the steps of an executed plan, and marks the first event that the model cannot follow.
  void path_discrepancy(const Discrepancy& found) {
    const auto& path = *found.record.path;
    const auto& differs = *found.path;
    std::vector<std::vector<std::string>> steps;
    for (std::size_t i = 0; i < found.record.outcomes.size(); ++i) {
      const auto& step = path.steps[i];
      steps.push_back({static_cast<std::int64_t>(i) == differs.event ? "*" : "",
                       fmt::format("{}", i),
                       step.object.empty() ? step.event : step.event + " = " + step.object,
                       step.source, step.succeeded ? "ok" : step.condition});
    }
    out_ += table(steps, 4);
    line("path ends", end_of(path.end, path.detail), 4);
    const auto event = static_cast<std::size_t>(differs.event);
    if (differs.event >= 0) {
      const auto& step = path.steps[event];
      const auto at = fmt::format("event {}, {}{}", differs.event, step.event,
                                  step.source.empty() ? "" : fmt::format(" ({})", step.source));
      line("the model",
           differs.impossible ? fmt::format("has no such event after these: {}", at)
           : differs.outcome
               ? fmt::format("has no such outcome: {}, {}", at,
                             !step.succeeded ? "which cannot fail there"
                             : step.object.empty()
                                 ? "which cannot succeed there"
                                 : fmt::format("which cannot find {} there", step.object))
               : fmt::format("has no such state after {}", at),
           4);
      const auto& outcome = found.record.outcomes[event];
      if (outcome.status != SimStatus::kOk && !outcome.reason.empty()) {
        line("reason", outcome.reason, 4);
      }
    }
    if (found.kind == DiscrepancyKind::kTransient) {
      line("transient", "it has these events, outcomes and the last state", 4);
    }
    if (differs.together) line("together", "each of these is possible, all of them are not", 4);
    std::vector<std::vector<std::string>> rows = {{"fluent", "timepoint", "predicted", "observed"}};
    for (const auto& fluent : found.first) rows.push_back(row(fluent));
    if (rows.size() > 1) out_ += table(rows, 4);
    line("start", values(found.record.initial), 4);
    line("end", values(found.end), 4);
    replay(found);
  }

  /// Not wrapped: the command is to be copied.
  void replay(const Discrepancy& found) {
    out_ += fmt::format("    {:<{}}{}\n", "replay", kReportLabels - 4,
                        base::printable(replay_command(result_.replay_folder, found)));
  }

  static std::string cause(const Discrepancy& found) {
    const auto &text = found.cause.text, &reason = found.cause.reason;
    const auto colon = reason.find(':');
    return colon == std::string::npos ? text : text + reason.substr(colon);
  }

  static std::string values(const State& state) {
    std::vector<std::string> parts;
    for (const auto& [name, value] : state) {
      const auto* number = std::get_if<double>(&value);
      parts.push_back(fmt::format(
          "{} = {}", name, number != nullptr ? fmt::format("{}", *number) : exact_text(value)));
    }
    return fmt::format("{}", fmt::join(parts, ", "));
  }

  static std::vector<std::string> row(const DivergingFluent& fluent) {
    return {fluent.fluent, fmt::format("{}", fluent.timepoint), fluent.predicted ? "true" : "false",
            fluent.observed ? "true" : "false"};
  }

  /// Where the run left the trace, if that was before the end.
  void parting(const Discrepancy& found, const TraceResult& trace) {
    const auto t = static_cast<std::size_t>(found.first_divergence);
    std::vector<std::string> parts;
    for (const auto& fluent : found.first) {
      parts.push_back(
          fmt::format("{} is {} instead of {}", fluent.fluent, fluent.observed, fluent.predicted));
    }
    line("first seen",
         fmt::format("at timepoint {}, after {}: {}", t,
                     t > 0 ? event_at(*trace.trace, t - 1) : "reset", fmt::join(parts, ", ")),
         4);
  }

  /// Lists actions that ended otherwise than the model says; predicted failures are not among them.
  void unusual_outcomes(const Discrepancy& found, const TraceResult& trace) {
    const auto& outcomes = found.record.outcomes;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      const auto& outcome = outcomes[i];
      const auto& point = trace.trace->points[i];
      const bool fails = point.plan_step && !point.succeeded;  // as the model has it
      const bool went_well = outcome.status == SimStatus::kOk;
      const bool as_predicted = fails ? outcome.status == SimStatus::kFailed : went_well;
      if (as_predicted) continue;
      const auto reason = went_well                ? "though the model lets it fail"
                          : outcome.reason.empty() ? "no reason given"
                                                   : outcome.reason;
      // The event of that timepoint was the first to begin in a state that is not the trace's.
      const bool follows = static_cast<std::int64_t>(i) >= found.first_divergence;
      line("action",
           fmt::format("event {}, {}, {} after {:.3f} s{} {}{}", i, trace.trace->event(i),
                       to_string(outcome.status), outcome.sim_time_s, went_well ? "," : ":", reason,
                       follows ? " (follows from what differed before)" : ""),
           4);
    }
  }

  void foot() {
    out_ += fmt::format("\nverdict: {}\n", headline_verdict(result_, style_.color));
    if (result_.execution == Execution::kOpenLoop) {
      line("traces", fmt::format("{}, {}", result_.traces.size(), exploration_text(result_)));
    }
    for (const auto& bound : result_.bounds) line("bound", bound);
    line("simulations", fmt::format("{}", result_.simulations));
    if (!result_.kinds.empty()) line("workers", kinds_text(result_.kinds));
    if (!result_.coverage.empty()) {
      line("covered",
           fmt::format("{}; `parallax coverage {}` names the rest", coverage_shares_text(result_),
                       shell_word(result_.replay_folder)));
    }
    if (result_.second_opinion) {
      out_ += fmt::format("\nsecond opinion of {}\n", result_.second_opinion->other);
      for (const auto& sentence : opinion_sentences(*result_.second_opinion)) line("", sentence);
      out_ += '\n';
    }
    if (result_.traces.empty() && !result_.interrupted) {
      line("note", "no trace, so nothing was compared");
    }
    if (!result_.claim.empty()) line("claimed", result_.claim);
    if (result_.traces.size() > 1 && result_.criterion.family == Family::kPerTrace &&
        result_.verdict == CampaignVerdict::kNoDiscrepancy) {
      line("note",
           "each claim holds for its trace alone; that all of them hold together is less "
           "certain");
    }
    if (result_.failed) {
      line("note", "an error ended the run; what was finished before it is above");
    } else if (result_.interrupted) {
      line("note", fmt::format("interrupted; `--resume --out {}` continues",
                               shell_word(result_.replay_folder)));
    }
  }

  const CampaignResult& result_;
  const ReportStyle& style_;
  std::string out_;
};

}  // namespace

std::string replay_command(const std::string& run_dir, const Discrepancy& found) {
  return fmt::format("parallax replay {} --sample {}.{}", shell_word(run_dir), found.trace,
                     found.sample);
}

std::string campaign_text(const CampaignResult& result, const ReportStyle& style) {
  return TextReport(result, style).write();
}

int exit_code(const CampaignResult& result) {
  if (result.verdict == CampaignVerdict::kNoDiscrepancy) return 0;
  return result.verdict == CampaignVerdict::kDiscrepancy ? 1 : 4;
}

namespace {
constexpr std::string_view kOtherArithmetic =
    "it was recorded on a processor that calculates differently (other results of the mathematical "
    "library in their last digits), so that a difference is to be expected here";
constexpr std::string_view kOtherBuild =
    "it was recorded by another build of the program or of a library that it loads";
}  // namespace

std::string replay_text(const ReplayResult& result, const ReportStyle& style) {
  const auto paint = [&](std::string_view text, const char* color) {
    return style.color ? fmt::format("\x1b[{}m{}\x1b[0m", color, text) : std::string(text);
  };
  const auto head =
      fmt::format("simulation {}.{}, seed {}: ", result.id.trace, result.id.sample, result.seed);
  switch (result.outcome) {
    case ReplayOutcome::kIdentical:
      return head + paint("identical", "1;32") +
             fmt::format(", {} {} compared bit for bit{}\n", result.timepoints,
                         base::agreed(result.timepoints, "observation", "observations"),
                         result.digest.empty() ? "" : ", digest " + result.digest);
    case ReplayOutcome::kCannot:
      return head + paint("cannot be repeated", "1;33") + '\n' + wrapped("  ", result.reason, 2);
    case ReplayOutcome::kDiffers:
      break;
  }
  const auto& difference = *result.difference;
  return head + paint("differs", "1;31") +
         fmt::format(" first at timepoint {} in {}\n", difference.timepoint, difference.variable) +
         table({{"recorded", difference.recorded}, {"repeated", difference.repeated}}, 2) +
         (result.machine.arithmetic ? wrapped("  note      ", kOtherArithmetic, 12) : "") +
         (result.machine.build ? wrapped("  note      ", kOtherBuild, 12) : "");
}

}  // namespace parallax::harness
