#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <map>

#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/utf8.h"
#include "compiler/base/words.h"
#include "harness/campaign/start_words.h"
#include "harness/confidence/criterion.h"
#include "harness/confidence/family.h"
#include "harness/confidence/rounding.h"
#include "harness/report/discrepancy_summary.h"
#include "harness/report/opinion_words.h"
#include "harness/report/report.h"
#include "harness/report/report_words.h"
#include "harness/report/standing.h"
#include "harness/report/text_layout.h"

namespace parallax::harness {
namespace {

// A screen has some forty lines; what does not fit is in report.txt.
constexpr std::size_t kMaxEvents = 10, kMaxTraces = 6, kMaxNotes = 3, kMaxFurther = 3;

class Summary {
 public:
  Summary(const CampaignResult& result, const ReportStyle& style)
      : result_(result), style_(style), found_(headline_order(result)) {}

  std::string write() {
    headline();
    if (!found_.empty()) {
      out_ += discrepancy_summary(result_, *found_.front(), style_);
      further_discrepancies();
      out_ += '\n';
    }
    traces();
    paths();
    causes();
    shown();
    opinion();
    notes();
    context();
    pointers();
    return std::move(out_);
  }

 private:
  void line(std::string_view label, std::string_view text) {
    auto first = "  " + std::string(label) + ' ';
    first.resize(std::max(first.size(), kSummaryColumn), ' ');
    out_ += wrapped(first, text, kSummaryColumn);
  }

  /// Two lines of it.
  static std::string shortened(std::string text) {
    constexpr std::size_t kLongest = 160;
    if (base::count_code_points(text) <= kLongest) return text;
    auto end = text.rfind(' ', kLongest);
    if (end == std::string::npos) end = kLongest;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
    return text.substr(0, end) + " ...";
  }

  // The verdict in a sentence.

  void headline() {
    const auto word = headline_verdict(result_, style_.color);
    const bool differs = result_.verdict == CampaignVerdict::kDiscrepancy && !found_.empty();
    // The word carries its colour, of which the width knows nothing.
    const auto plain = headline_verdict(result_, false);
    std::string text, reason;
    if (differs) {
      auto told = discrepancy_headline(result_, *found_.front(),
                                       kReportColumns - base::count_code_points(plain) - 2);
      text = std::move(told.sentence);
      reason = std::move(told.reason);
    } else if (result_.traces.empty()) {
      text = result_.interrupted ? "it ended before anything was compared"
                                 : "no trace, so nothing was compared";
    } else if (result_.failed) {
      text = "an error ended the run";
    } else if (result_.interrupted) {
      text = "interrupted";
    } else if (result_.verdict == CampaignVerdict::kInconclusive) {
      text = why_inconclusive();
    } else if (result_.verdict == CampaignVerdict::kNoDiscrepancy) {
      text = in_states_text(result_);  // where the scenario leaves the others out
    }
    auto lines = wrapped(plain + (text.empty() ? "" : ": "), text, 2);
    out_ += lines.replace(0, plain.size(), word);
    if (!reason.empty()) line("reason", reason);
    if (differs) {
      // Without an opinion, the pointers below name the command that asks for one.
      const auto standing = standing_of(result_, *found_.front());
      if (standing.is != Standing::kNotAsked) line("standing", standing.words);
    }
    if (result_.traces.size() == 1) {
      line("claim", result_.claim.empty() ? result_.traces.front().claim : result_.claim);
    }
    out_ += '\n';
  }

  std::string why_inconclusive() const {
    if (!result_.repetition.holds()) {
      return "a clean simulation is not clean when it is repeated, so runs may affect each other";
    }
    const auto open = std::count_if(
        result_.traces.begin(), result_.traces.end(),
        [](const auto& trace) { return trace.verdict == CampaignVerdict::kInconclusive; });
    if (open == 0) return "nothing differs so far, and there are more traces than a limit admits";
    const auto undecided = std::count_if(result_.traces.begin(), result_.traces.end(),
                                         [](const auto& trace) { return !trace.is_decided; });
    const auto& first = result_.traces.front();
    if (std::any_of(result_.traces.begin(), result_.traces.end(),
                    [](const auto& trace) { return trace.began_elsewhere; })) {
      return "the simulator does not begin where it is told to (see the note)";
    }
    if (undecided == 0) {
      return fmt::format("no discrepancy found {}", in_states_text(result_));
    }
    if (auto text = ran_out_text(result_); !text.empty()) return text;
    if (first.loop && first.loop->unfinished > 0) {
      return fmt::format(
          "{} (of the first: {})",
          base::counted(first.loop->unfinished, "run did not end", "runs did not end"),
          first.loop->why_unfinished);
    }
    if (first.loop && first.loop->cover && first.loop->cover->end == CoverResult::End::kRunLimit) {
      return fmt::format("max_runs came before what was not shown is rarer than {}",
                         percent_up(first.loop->cover->epsilon));
    }
    if (first.loop) return "there were fewer runs than the criterion asks for";
    return fmt::format(
        "{} of {} had fewer runs than the criterion asks for", undecided,
        base::counted(static_cast<std::int64_t>(result_.traces.size()), "trace", "traces"));
  }

  /// With --keep-going: a line each.
  void further_discrepancies() {
    for (std::size_t i = 1; i < found_.size() && i <= kMaxFurther; ++i) {
      const bool in_doubt = standing_of(result_, *found_[i]).is == Standing::kInDoubt;
      line(fmt::format("{}.{}", found_[i]->trace, found_[i]->sample),
           (in_doubt ? "in doubt: " : "") + discrepancy_sentence(result_, *found_[i]));
    }
    if (found_.size() > 1 + kMaxFurther) {
      line("", fmt::format("and {} more discrepancies", found_.size() - 1 - kMaxFurther));
    }
  }

  // How often, and what is claimed.

  static std::string bound_of(const TraceResult& trace) {
    if (trace.verdict == CampaignVerdict::kDiscrepancy) return {};
    return trace.certified_epsilon < 1.0
               ? fmt::format("p < {} with {} confidence", percent_up(trace.certified_epsilon),
                             level_text(trace.certified_level))
               : std::string("nothing certified");
  }

  static std::string runs_of(const TraceResult& trace) {
    auto text = fmt::format("{} clean of {}", trace.clean, trace.simulations);
    if (trace.lost > 0) text += fmt::format(", {} lost", trace.lost);
    return text;
  }

  void traces() {
    tell_traces();
    std::vector<LossCount> losses;
    for (const auto& trace : result_.traces) add_losses(trace.losses, losses);
    if (!losses.empty()) line("lost", loss_words(losses));
  }

  void tell_traces() {
    const auto& all = result_.traces;
    if (all.size() == 1) {
      const auto& trace = all.front();
      if (trace.search) line("searched", search_text(*trace.search, trace.trace->number));
      if (trace.law) {
        if (const auto refused = trace.law->refused_text(); !refused.empty()) {
          line("refused", refused);
        }
      }
      if (!trace.starts.is_single()) line("starts", tried_text(trace.starts));
      for (const auto& text : failing_states(trace.starts)) line("fails", text);
      line("runs", runs_of(trace) +
                       (trace.rejected > 0 ? fmt::format("; {} drawn again", trace.rejected) : ""));
      if (result_.discrepancies.empty() && !trace.loop && trace.trace->event_count() > 0) {
        line("events", events_of(trace));
      }
    }
    if (all.size() < 2) return;
    // Where there are many, those that are not clean are what is looked for.
    const auto is_clean = [](const TraceResult* one) {
      return one->verdict == CampaignVerdict::kNoDiscrepancy;
    };
    std::vector<const TraceResult*> shown;
    for (const auto& trace : all) shown.push_back(&trace);
    std::stable_partition(shown.begin(), shown.end(), std::not_fn(is_clean));
    shown.resize(std::min(shown.size(), kMaxTraces));
    std::sort(shown.begin(), shown.end(),
              [](const auto* a, const auto* b) { return a->trace->number < b->trace->number; });
    std::vector<std::vector<std::string>> rows;
    for (const auto* trace : shown) {
      rows.push_back({fmt::format("trace {}", trace->trace->number),
                      verdict_word(trace->verdict, false), runs_of(*trace), bound_of(*trace)});
    }
    const auto left_out = all.size() - shown.size();
    out_ += table(rows, 2);
    if (left_out > 0) out_ += fmt::format("  and {} more traces\n", left_out);
    if (!result_.claim.empty()) {
      line("claim", result_.claim);
    } else if (result_.verdict == CampaignVerdict::kNoDiscrepancy) {
      line("claim",
           "each holds for its trace alone: that all of them hold together is less certain");
    }
  }

  static std::string events_of(const TraceResult& trace) {
    std::vector<std::string> events;
    for (std::size_t i = 0; i < trace.trace->event_count(); ++i) {
      if (i == kMaxEvents) {
        events.push_back(fmt::format("{} more", trace.trace->event_count() - i));
        break;
      }
      events.push_back(trace.trace->event(i));
    }
    return fmt::format("{}", fmt::join(events, ", "));
  }

  void paths() {
    if (result_.traces.empty() || !result_.traces.front().loop) return;
    const auto& loop = *result_.traces.front().loop;
    std::map<std::string, std::int64_t> ends;
    for (const auto& path : loop.paths) ends[end_of(path.end, path.detail)] += path.runs;
    std::vector<std::string> parts;
    for (const auto& [end, runs] : ends) {
      parts.push_back(fmt::format("{} in {}", end, base::counted(runs, "run", "runs")));
    }
    line("paths",
         fmt::format("{} from {}: {}",
                     base::counted(static_cast<std::int64_t>(loop.paths.size()), "way", "ways"),
                     base::counted(loop.initial_states, "start state", "start states"),
                     fmt::join(parts, "; ")));
  }

  /// Reports the items shown by runs that go on until everything was shown.
  void shown() {
    if (result_.traces.empty() || !result_.traces.front().loop) return;
    const auto& cover = result_.traces.front().loop->cover;
    if (!cover) return;
    line("shown", cover_text(*cover));
    const auto& left = cover->left;
    for (std::size_t i = 0; i < left.size() && i <= kMaxFurther; ++i) {
      line("not shown", fmt::format("{}  {}", left[i].place, left[i].what));
    }
    if (left.size() > kMaxFurther + 1) {
      line("not shown", fmt::format("{} more", left.size() - kMaxFurther - 1));
    }
  }

  /// Reports how often each cause led executed plans away from the model, with --keep-going.
  void causes() {
    if (result_.traces.empty() || !result_.traces.front().loop) return;
    const auto& loop = *result_.traces.front().loop;
    for (std::size_t i = 0; i < loop.causes.size() && i <= kMaxFurther; ++i) {
      const auto& rate = loop.causes[i];
      line("cause", fmt::format("{}: {}", rate.cause, rate_words(loop, rate)));
    }
    if (loop.causes.size() > kMaxFurther + 1) {
      line("cause", fmt::format("{} more", loop.causes.size() - kMaxFurther - 1));
    }
  }

  /// Lists the caveats of the claims, which must not be left to the long report alone.
  void notes() {
    std::map<std::string, std::vector<std::string>> traces_of;
    std::vector<std::string> order;
    for (const auto& trace : result_.traces) {
      for (const auto& caveat : trace.caveats) {
        auto& list = traces_of[caveat];
        if (list.empty()) order.push_back(caveat);
        list.push_back(fmt::format("{}", trace.trace->number));
      }
    }
    for (std::size_t i = 0; i < order.size() && i < kMaxNotes; ++i) {
      const auto& list = traces_of[order[i]];
      const bool some = list.size() < result_.traces.size();
      auto text = some ? fmt::format("trace {}: {}", fmt::join(list, ", "), order[i]) : order[i];
      line("note", shortened(std::move(text)));
    }
    if (order.size() > kMaxNotes) line("note", fmt::format("{} more", order.size() - kMaxNotes));
    const auto& bounds = result_.bounds;
    for (std::size_t i = 0; i < bounds.size() && i < kMaxNotes; ++i) {
      line("bound", shortened(bounds[i]));
    }
    if (bounds.size() > kMaxNotes) line("bound", fmt::format("{} more", bounds.size() - kMaxNotes));
  }

  // The subject of the report.

  void context() {
    auto text = result_.scenario;
    if (!result_.title.empty()) text += ": " + result_.title;
    line("scenario", text);
    const auto& simulator = result_.simulator;
    text = base::counted(result_.simulations, "simulation", "simulations");
    if (result_.execution == Execution::kOpenLoop) {
      text += fmt::format(
          " of {} ({})",
          base::counted(static_cast<std::int64_t>(result_.traces.size()), "trace", "traces"),
          exploration_text(result_));
    } else {
      text += " in closed loop";
    }
    if (!simulator.name.empty()) {  // empty: none could be started
      text += fmt::format(", {} {}", simulator.name, simulator.version);
    }
    text += fmt::format(", seed {}, {}", result_.seed,
                        result_.comparison == Comparison::kFinal ? "compared at the end"
                                                                 : "compared at every step");
    line("made", text);
    std::vector<std::string> ignored;
    for (const auto& entry : result_.compared) {
      if (entry.how == ComparedFluents::How::kIgnored) ignored.push_back(entry.fluent);
    }
    if (!ignored.empty())
      line("without", fmt::format("{}: not compared", fmt::join(ignored, ", ")));
    line("criterion", criterion_text(result_.criterion, result_.spending));
    if (!result_.kinds.empty()) line("workers", kinds_text(result_.kinds));
    if (!result_.coverage.empty()) line("covered", coverage_shares_text(result_));
  }

  void opinion() {
    if (!result_.second_opinion) return;
    const auto sentences = opinion_sentences(*result_.second_opinion);
    for (std::size_t i = 0; i < sentences.size(); ++i) {
      line(i == 0 ? name_of_other() : "", sentences[i]);
    }
  }
  std::string name_of_other() const {
    const auto& other = result_.second_opinion->other;
    return "in " + other.substr(0, other.find(' '));
  }

  /// Not wrapped: commands are to be copied.
  void pointers() {
    if (!result_.journal_open) return;
    const auto folder = shell_word(result_.replay_folder);
    std::vector<std::string> commands = {fmt::format("parallax report {}", folder)};
    if (!found_.empty()) {
      const auto& found = *found_.front();
      // Without a simulation the commands take the run's first discrepancy.
      const auto which = &found == &result_.discrepancies.front()
                             ? std::string()
                             : fmt::format(" --sample {}.{}", found.trace, found.sample);
      commands.push_back(replay_command(result_.replay_folder, found));
      commands.push_back(fmt::format("parallax confirm {}{}", folder, which));
      commands.push_back(fmt::format("parallax explain {}{}", folder, which));
      commands.push_back(fmt::format("parallax repair {}", folder));
    } else if (result_.interrupted && !result_.failed) {
      commands.push_back(
          fmt::format("parallax run {} --resume --out {}", shell_word(result_.scenario), folder));
    }
    for (std::size_t i = 0; i < commands.size(); ++i) {
      out_ += fmt::format("  {:<{}}{}\n", i == 0 ? "next" : "", kSummaryColumn - 2,
                          base::printable(commands[i]));
    }
  }

  const CampaignResult& result_;
  const ReportStyle& style_;
  std::vector<const Discrepancy*> found_;  // the one of the headline in front
  std::string out_;
};

}  // namespace

std::string campaign_summary(const CampaignResult& result, const ReportStyle& style) {
  return Summary(result, style).write();
}

}  // namespace parallax::harness
