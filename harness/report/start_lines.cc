#include "harness/report/start_lines.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "compiler/base/words.h"
#include "harness/campaign/sample_record.h"
#include "harness/campaign/start_words.h"
#include "harness/confidence/rounding.h"
#include "harness/report/report_words.h"
#include "harness/report/text_layout.h"

namespace parallax::harness {
namespace {

/// A table whose first row stands beside a label, in two blanks.
std::string labelled_table(std::string_view label,
                           const std::vector<std::vector<std::string>>& rows) {
  if (rows.empty()) return {};
  return table(rows, kReportLabels).replace(2, label.size(), label);
}

/// The share of each cell that starts are drawn from, where that is not the whole cell: the claim
/// is about no more.
std::string share_lines(const TraceResult& trace) {
  std::vector<std::vector<std::string>> rows;
  for (const StartShare& share : trace.start_shares) {
    if (share.share == 1.0 && share.fixed.empty()) continue;  // the whole cell
    std::vector<std::string> parts;
    for (const auto& axis : share.axes) {
      if (axis.drawn == axis.whole) continue;
      parts.push_back(fmt::format("{} {:.4g} of {:.4g}", axis.axis, axis.drawn, axis.whole));
    }
    if (!share.fixed.empty()) {
      parts.push_back("fixed " + fmt::format("{}", fmt::join(share.fixed, " ")));
    }
    rows.push_back({fmt::format("{} in {}", share.body, share.region), percent_down(share.share),
                    fmt::format("{}", fmt::join(parts, ", "))});
  }
  return labelled_table("of the cells", rows);
}

}  // namespace

std::string start_lines(const TraceResult& trace) {
  std::string out;
  if (const auto holds = trace.trace->holds(0); !holds.empty()) {
    out += labelled("start state", fmt::format("{}", fmt::join(holds, ", ")));
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& [variable, interval] : trace.start_region) {
    // A world that is a model has the fluents themselves for variables.
    if (trace.trace->symbols->fluent(variable)) continue;
    rows.push_back({variable, interval.lower == interval.upper
                                  ? fmt::format("{}", interval.lower)
                                  : fmt::format("{} to {}", interval.lower, interval.upper)});
  }
  if (rows.empty()) return out;
  if (!trace.starts.is_single() && trace.starts.law != Initial::kFirst) {
    out += labelled("",
                    "that is the first initial state, and below is where its starts lie; others "
                    "have cells of their own");
  }
  out += labelled_table("start region", rows);
  if (!trace.left_out.empty()) {
    out += labelled("left out", trace.left_out + ", where no start is drawn");
  }
  return out + share_lines(trace);
}

std::string initial_state_lines(std::string_view label, const StartResult& starts) {
  constexpr std::size_t kMostRows = 24;
  auto out = labelled(label, tried_text(starts));
  std::vector<std::vector<std::string>> rows;
  for (const auto& [number, counts] : starts.states) {
    if (rows.size() == kMostRows) break;
    rows.push_back(
        {fmt::format("{}", number),
         fmt::format("{} clean, {} lost, {} not", counts.clean, counts.lost, counts.discrepancies),
         counts.text});
  }
  if (rows.empty()) return out;
  out += table(rows, kReportLabels);
  if (starts.states.size() > rows.size()) {
    out += labelled("", fmt::format("and {} more", starts.states.size() - rows.size()));
  }
  return out;
}

std::string law_lines(const LawResult& law) {
  auto out = labelled("start law", law.text());
  if (const auto refused = law.refused_text(); !refused.empty())
    out += labelled("refused", refused);
  return out;
}

std::string execution_paths(const LoopResult& loop) {
  const auto guided = loop.guided
                          ? fmt::format(", but in {} chosen",
                                        base::counted(*loop.guided, "execution", "executions"))
                          : std::string();
  auto out = labelled(
      "start states",
      fmt::format("{}, each {}{}", loop.initial_states,
                  loop.has_weights ? "as likely as its weight" : "equally likely", guided));
  constexpr std::size_t kMaxPaths = 5;
  for (std::size_t i = 0; i < loop.paths.size() && i < kMaxPaths; ++i) {
    const auto& path = loop.paths[i];
    std::vector<std::string> steps;
    for (std::size_t t = 0; t < path.events.size(); ++t) {
      const bool ok = path.outcomes[t] == "ok";
      steps.push_back(ok ? path.events[t]
                         : fmt::format("{} ({})", path.events[t], path.outcomes[t]));
    }
    out += labelled(
        "path", fmt::format("{}, such as 1.{}: {}; {}", base::counted(path.runs, "run", "runs"),
                            path.example, fmt::join(steps, ", "), end_of(path.end, path.detail)));
  }
  if (loop.paths.size() > kMaxPaths) {
    out += labelled("path", fmt::format("and {} others", loop.paths.size() - kMaxPaths));
  }
  return out;
}

}  // namespace parallax::harness
