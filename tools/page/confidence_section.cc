#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/base/words.h"
#include "harness/confidence/clean_runs.h"
#include "harness/confidence/rounding.h"
#include "tools/page/markup.h"
#include "tools/page/plot.h"
#include "tools/page/sections.h"

namespace parallax::tools {
namespace {

constexpr double kWide = 420.0, kHigh = 260.0;
constexpr std::size_t kMostPlots = 12;

struct Curve {
  std::vector<std::pair<std::int64_t, double>> bounds;  // after so many runs
  std::int64_t runs = 0, failures = 0;
  std::int64_t aside = 0, unfinished = 0, open = 0;  // not counted; not known
};

/// The criterion with the share of the error that the trace may spend.
harness::CriterionSpec asked_of(const PageData& page, const PageTrace& trace) {
  auto spec = page.asked;
  spec.confidence_level = page.confidence;
  spec.epsilon = page.epsilon;
  spec.share = trace.error_share;
  return spec;
}

/// The bound after each finished run with a drawn start, in order, or after a selection of many:
/// counted as the run itself does.
Curve curve_of(const PageData& page, const PageTrace& trace) {
  Curve curve;
  std::vector<bool> failed;
  for (const auto& sample : page.samples) {
    if (sample.trace != trace.number) continue;
    if (sample.origin != SampleOrigin::kDrawn) {
      curve.aside += sample.origin == SampleOrigin::kFurther ? 0 : 1;
      continue;
    }
    if (sample.verdict == PageVerdict::kNotJudged) {
      ++curve.open;
      continue;
    }
    if (sample.unfinished && sample.verdict == PageVerdict::kClean) {
      ++curve.unfinished;
      continue;
    }
    failed.push_back(sample.verdict != PageVerdict::kClean);
  }
  curve.runs = static_cast<std::int64_t>(failed.size());
  const double confidence = asked_of(page, trace).trace_level();
  const std::int64_t stride = std::max<std::int64_t>(1, curve.runs / 120);
  for (std::int64_t i = 1; i <= curve.runs; ++i) {
    curve.failures += failed[static_cast<std::size_t>(i - 1)] ? 1 : 0;
    if (i % stride != 0 && i != curve.runs && !failed[static_cast<std::size_t>(i - 1)]) continue;
    curve.bounds.emplace_back(i, curve.failures == 0
                                     ? harness::bound_after(i, confidence)
                                     : harness::mixture_upper(curve.failures, i, confidence));
  }
  return curve;
}

std::string plot(const PageData& page, const PageTrace& trace, const Curve& curve) {
  const auto asked = asked_of(page, trace);
  const auto planned = harness::planned_runs(asked);
  const auto needed =
      planned > 0 ? planned : harness::runs_needed(asked.trace_level(), page.epsilon);
  const double most = static_cast<double>(std::max({curve.runs, needed, std::int64_t{2}})) * 1.08;
  double least = page.epsilon;
  for (const auto& [runs, bound] : curve.bounds) least = std::min(least, bound);
  const PlotAxis x{0.0, most, 56.0, kWide - 14.0};
  const PlotAxis y{std::log10(least) - 0.15, 0.0, kHigh - 42.0, 16.0};
  const auto at = [&](double bound) { return y.at(std::log10(std::max(bound, 1e-12))); };
  auto out = fmt::format(
      "<svg class=\"plot confidence\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Bound on the "
      "discrepancy probability against the number of runs: {}\">\n<g class=\"axis\">",
      px(kWide), px(kHigh), stream_name(page, trace));
  for (const double share : {1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0001}) {
    if (std::log10(share) < y.low) break;
    out += line(x.from, at(share), x.to, at(share), "grid") +
           label(x.from - 6, at(share) + 4, "end", percent(share));
  }
  for (const double runs : ticks(0.0, most, 6)) {
    if (runs != std::round(runs)) continue;
    out += line(x.at(runs), y.from, x.at(runs), y.from + 4, "tick") +
           label(x.at(runs), y.from + 16, "middle", number(runs, 7));
  }
  out += label(0.5 * (x.from + x.to), kHigh - 6, "middle name", "runs") + "</g>\n";
  const auto path = [&](const std::vector<std::pair<std::int64_t, double>>& points,
                        std::string_view classes) {
    std::string d;
    for (const auto& [runs, bound] : points) {
      d += (d.empty() ? "M" : "L") + px(x.at(static_cast<double>(runs))) + ' ' + px(at(bound));
    }
    return d.empty() ? d : fmt::format("<path class=\"{}\" d=\"{}\"/>\n", classes, d);
  };
  std::vector<std::pair<std::int64_t, double>> ideal;
  for (std::int64_t i = 0; i <= 60; ++i) {
    const auto runs = std::max<std::int64_t>(1, std::llround(static_cast<double>(i) * most / 60.0));
    ideal.emplace_back(runs, harness::bound_after(runs, asked.trace_level()));
  }
  out += path(ideal, "curve ideal");
  out += line(x.from, at(page.epsilon), x.to, at(page.epsilon), "goal") +
         label(x.from + 4, at(page.epsilon) - 5, "goal-name",
               fmt::format("to be excluded: {}", harness::percent_up(page.epsilon)));
  out += path(curve.bounds, curve.failures > 0 ? "curve bad" : "curve clean");
  if (trace.paper_stopped_at) {
    const double at_x = x.at(static_cast<double>(*trace.paper_stopped_at));
    out += line(at_x, y.from, at_x, y.to, "paper") +
           label(at_x + 4, y.to + 10, "paper-name",
                 fmt::format("paper&#39;s rule: {} runs", *trace.paper_stopped_at));
  }
  if (!curve.bounds.empty()) {
    const auto& [runs, bound] = curve.bounds.back();
    const double at_x = x.at(static_cast<double>(runs)), at_y = at(bound);
    const bool right = at_x > 0.6 * kWide;
    out +=
        fmt::format("<circle class=\"stop\" cx=\"{}\" cy=\"{}\" r=\"4.5\"/>", px(at_x), px(at_y)) +
        label(at_x + (right ? -8 : 8), at_y < y.to + 20 ? at_y + 18 : at_y - 9,
              right ? "end stop-name" : "stop-name",
              fmt::format("stop after {}: {}", runs, harness::percent_up(bound)));
  }
  return out + "</svg>\n";
}

}  // namespace

namespace {

/// Explains the counts of the curve and the certificate of the report.
std::string caption(const PageData& page, const PageTrace& trace, const Curve& curve) {
  auto out = fmt::format("{}: {}, {} not clean. ", stream_name(page, trace),
                         base::counted(curve.runs, "run"), curve.failures);
  if (curve.aside > 0) {
    out +=
        fmt::format("Not counted: {} with starts that were chosen or searched for. ", curve.aside);
  }
  if (curve.unfinished > 0) {
    out += fmt::format(
        "Nothing is claimed: {} did not end. ",
        curve.unfinished == 1 ? "an execution" : fmt::format("{} executions", curve.unfinished));
  } else if (curve.open > 0) {
    out += fmt::format("{} are not judged one by one, so there is no curve. ", curve.open);
  }
  if (trace.certified_confidence > 0.0 && curve.unfinished == 0) {
    out += trace.certified_epsilon < 1.0
               ? fmt::format("Certified with {} confidence: fewer than {} of the runs. ",
                             harness::level_text(trace.certified_confidence),
                             harness::percent_up(trace.certified_epsilon))
               : "Nothing is certified. ";
  }
  if (page.closed_loop) return out;
  const auto variant =
      trace.paper_variant.empty() ? std::string() : " (" + html_short(trace.paper_variant) + ")";
  out += trace.paper_stopped_at ? fmt::format("The paper&#39;s rule would stop after {}{}.",
                                              *trace.paper_stopped_at, variant)
                                : "The paper&#39;s rule was not satisfied" + variant + ".";
  return out;
}

}  // namespace

std::string confidence_section(const PageData& page) {
  std::string out;
  std::size_t shown = 0, left_out = 0;
  for (const auto& trace : page.traces) {
    const auto curve = curve_of(page, trace);
    if (curve.runs + curve.open + curve.unfinished == 0) continue;
    if (++shown > kMostPlots) {
      ++left_out;
      continue;
    }
    const bool has_curve = curve.open == 0 && curve.unfinished == 0;
    out += "<figure><figcaption>" + caption(page, trace, curve) + "</figcaption>" +
           (has_curve ? plot(page, trace, curve) : "") + "</figure>\n";
  }
  if (out.empty()) return out;
  auto text = fmt::format(
      "<p>The bound on how many of the runs give a discrepancy, which holds whenever one looks: "
      "with "
      "{} confidence, and with {} from the first run on that is not clean. The thin curve is what "
      "clean runs alone would give.</p>\n<div class=\"panels\">\n{}</div>\n",
      harness::level_text(page.confidence),
      harness::level_text(std::max(0.0, 1.0 - 2.0 * (1.0 - page.confidence))), out);
  if (left_out > 0) text += fmt::format("<p>{} further traces are left out.</p>\n", left_out);
  return section_of("confidence", "Confidence", text);
}

}  // namespace parallax::tools
