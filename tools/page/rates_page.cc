#include "tools/page/rates_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "compiler/base/utf8.h"
#include "compiler/base/words.h"
#include "harness/campaign/run_setup.h"
#include "harness/cause/failure_rule.h"
#include "harness/confidence/clean_runs.h"
#include "harness/confidence/rounding.h"
#include "harness/report/report.h"
#include "tools/page/markup.h"
#include "tools/page/plot.h"
#include "tools/page/sections.h"
#include "tools/page/write_page.h"

namespace parallax::tools {
namespace {

using harness::CauseRate;
using harness::SampleRow;
using harness::TraceRates;

constexpr std::size_t kMostCauses = 12, kMostRatedTraces = 40;
constexpr double kRowHigh = 26.0, kSettleWide = 460.0, kSettleHigh = 270.0, kLineHigh = 15.0;

std::string path_of(const std::vector<std::pair<double, double>>& points,
                    std::string_view classes) {
  std::string d;
  for (const auto& [x, y] : points) d += (d.empty() ? "M" : "L") + px(x) + ' ' + px(y);
  return d.empty() ? d : fmt::format("<path class=\"{}\" d=\"{}\"/>\n", classes, d);
}

std::string dot(double x, double y) {
  return fmt::format("<circle class=\"stop\" cx=\"{}\" cy=\"{}\" r=\"4\"/>", px(x), px(y));
}

/// An interval with a bar at both ends and a dot where the rate is.
std::string whisker(double low, double high, double at, double y) {
  return path_of({{low, y}, {high, y}}, "curve bad") + line(low, y - 4, low, y + 4, "border") +
         line(high, y - 4, high, y + 4, "border") + dot(at, y);
}

std::string count_text(const CauseRate& rate, std::int64_t runs) {
  return fmt::format("{} of {}", rate.count, runs);
}

/// A name in lines that fit into the plot; at most three.
std::vector<std::string> name_lines(const std::string& name) {
  constexpr std::size_t kLineLength = 54, kLines = 3;
  std::vector<std::string> out;
  for (std::string_view rest = name; !rest.empty() && out.size() < kLines;) {
    auto end = std::min(rest.size(), kLineLength);
    if (end < rest.size()) {
      const auto space = rest.rfind(' ', end);
      if (space != rest.npos && space > kLineLength / 2) end = space;
      while (end < rest.size() && base::continues_code_point(rest[end])) ++end;
    }
    out.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(rest.size(), rest.find_first_not_of(' ', end)));
    if (!rest.empty() && out.size() == kLines) out.back() += " \xE2\x80\xA6";
  }
  return out;
}

/// One line for each cause: its rate and interval. As wide as a narrow screen, where it is shown at
/// its own size.
std::string causes_plot(const TraceRates& trace) {
  std::vector<const CauseRate*> rows = {&trace.any};
  for (const auto& rate : trace.causes) {
    if (rows.size() <= kMostCauses) rows.push_back(&rate);
  }
  double most = 0.05;
  for (const auto* rate : rows) most = std::max(most, rate->upper);
  const PlotAxis x{0.0, std::min(1.0, 1.05 * most), 16.0, kSettleWide - 90.0};
  std::string whiskers;
  double y = 26.0;
  for (const auto* rate : rows) {
    const auto name = rate == &trace.any ? std::string("any discrepancy") : rate->cause;
    for (const auto& words : name_lines(name)) {
      whiskers += label(x.from, y, "name", html_short(words));
      y += kLineHigh;
    }
    whiskers += whisker(x.at(rate->lower), x.at(rate->upper), x.at(rate->rate), y);
    whiskers += label(x.at(rate->upper) + 8.0, y + 4.0, "", count_text(*rate, trace.runs));
    y += 2.0 * kRowHigh - kLineHigh;
  }
  const double bottom = y - 6.0;
  auto out = fmt::format(
      "<svg class=\"plot causes\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"How often each "
      "cause comes in trace {}\">\n",
      px(kSettleWide), px(bottom + 40.0), trace.number);
  for (const double share : ticks(0.0, x.high, 5)) {
    out += line(x.at(share), 8.0, x.at(share), bottom, "grid") +
           label(x.at(share), bottom + 16.0, "middle", percent(share));
  }
  return out + whiskers +
         label(0.5 * (x.from + x.to), bottom + 34.0, "middle name", "share of the runs") +
         "</svg>\n";
}

bool failed(const SampleRow& row) { return std::string_view(row.outcome) == "discrepancy"; }
bool was_lost(const SampleRow& row) { return std::string_view(row.outcome) == "lost"; }

/// The rate after each run, and the anytime-valid bound.
std::string settling_plot(const TraceRates& trace, const std::vector<const SampleRow*>& rows,
                          double confidence) {
  const auto runs = std::ssize(rows);
  if (runs < 2) return {};
  const PlotAxis x{0.0, 1.02 * static_cast<double>(runs), 56.0, kSettleWide - 14.0};
  const PlotAxis y{0.0, 1.0, kSettleHigh - 42.0, 14.0};
  std::vector<std::pair<double, double>> rate, bound;
  std::int64_t failures = 0, lost = 0;
  double last_bound = 1.0;
  const std::int64_t stride = std::max<std::int64_t>(1, runs / 150);
  for (std::int64_t i = 1; i <= runs; ++i) {
    const auto& row = *rows[static_cast<std::size_t>(i - 1)];
    failures += failed(row) ? 1 : 0;
    lost += was_lost(row) ? 1 : 0;
    if (i % stride != 0 && i != runs) continue;
    last_bound = harness::mixture_upper(failures + lost, i, confidence);
    const double at = x.at(static_cast<double>(i));
    if (lost < i) {
      rate.emplace_back(at, y.at(static_cast<double>(failures) / static_cast<double>(i - lost)));
    }
    bound.emplace_back(at, y.at(last_bound));
  }
  auto out = fmt::format(
      "<svg class=\"plot settling\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Rate and bound "
      "of trace {} against the number of runs\">\n",
      px(kSettleWide), px(kSettleHigh), trace.number);
  for (const double share : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    out += line(x.from, y.at(share), x.to, y.at(share), "grid") +
           label(x.from - 6.0, y.at(share) + 4.0, "end", percent(share));
  }
  for (const double count : ticks(0.0, x.high, 6)) {
    if (count != std::round(count)) continue;
    out += line(x.at(count), y.from, x.at(count), y.from + 4.0, "tick") +
           label(x.at(count), y.from + 16.0, "middle", number(count, 7));
  }
  out += label(0.5 * (x.from + x.to), kSettleHigh - 6.0, "middle name", "runs");
  out += path_of(bound, "curve ideal") + path_of(rate, "curve bad");
  if (rate.empty()) return out + "</svg>\n";
  return out + dot(rate.back().first, rate.back().second) + "</svg>\n";
}

double start_number(const harness::State& state, const std::string& name) {
  const auto found = state.find(name);
  if (found == state.end()) return 0.0;
  if (const auto* flag = std::get_if<bool>(&found->second)) return *flag ? 1.0 : 0.0;
  if (const auto* whole = std::get_if<std::int64_t>(&found->second)) {
    return static_cast<double>(*whole);
  }
  const auto* value = std::get_if<double>(&found->second);
  return value == nullptr ? 0.0 : *value;
}

/// Numbers of the starts that differ between runs.
std::vector<std::string> drawn_variables(const std::vector<const SampleRow*>& rows) {
  std::set<std::string> out;
  for (const auto* row : rows) {
    for (const auto& [name, value] : row->start) {
      if (std::holds_alternative<std::string>(value)) continue;
      const double here = start_number(row->start, name);
      if (here != start_number(rows.front()->start, name)) out.insert(name);
    }
  }
  return {out.begin(), out.end()};
}

/// The rate in ten equal parts of a variable's range, with intervals, and the border.
std::string variable_plot(const std::vector<const SampleRow*>& rows, const std::string& variable,
                          const harness::Border& border, double confidence) {
  constexpr std::size_t kParts = 10;
  double low = start_number(rows.front()->start, variable), high = low;
  for (const auto* row : rows) {
    low = std::min(low, start_number(row->start, variable));
    high = std::max(high, start_number(row->start, variable));
  }
  std::array<CauseRate, kParts> rates;
  std::array<std::int64_t, kParts> runs{}, lost{};
  for (const auto* row : rows) {
    const double share = (start_number(row->start, variable) - low) / (high - low);
    const auto part = std::min(kParts - 1, static_cast<std::size_t>(share * kParts));
    ++(was_lost(*row) ? lost : runs)[part];
    if (failed(*row)) ++rates[part].count;
  }
  const PlotAxis x{low, high, 56.0, kSettleWide - 14.0};
  const PlotAxis y{0.0, 1.0, kSettleHigh - 42.0, 14.0};
  auto out = fmt::format(
      "<svg class=\"plot variable\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Rate against "
      "{}\">\n",
      px(kSettleWide), px(kSettleHigh), html_short(variable));
  const double at = x.at(std::clamp(border.value, low, high));
  out += fmt::format("<rect class=\"fails\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n",
                     px(border.above ? at : x.from), px(y.to),
                     px(border.above ? x.to - at : at - x.from), px(y.from - y.to));
  out += line(at, y.from, at, y.to, "border");
  for (const double share : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    out += line(x.from, y.at(share), x.to, y.at(share), "grid") +
           label(x.from - 6.0, y.at(share) + 4.0, "end", percent(share));
  }
  for (const double value : ticks(low, high, 6)) {
    out += line(x.at(value), y.from, x.at(value), y.from + 4.0, "tick") +
           label(x.at(value), y.from + 16.0, "middle", number(value));
  }
  for (std::size_t part = 0; part < kParts; ++part) {
    if (runs[part] == 0) continue;
    auto& rate = rates[part];
    harness::set_interval(rate, runs[part], lost[part], confidence);
    const double middle = x.at(low + (static_cast<double>(part) + 0.5) / kParts * (high - low));
    out += path_of({{middle, y.at(rate.lower)}, {middle, y.at(rate.upper)}}, "curve bad") +
           dot(middle, y.at(rate.rate));
  }
  return out +
         label(0.5 * (x.from + x.to), kSettleHigh - 6.0, "middle name", html_short(variable)) +
         "</svg>\n";
}

std::string decisive_part(const std::vector<const SampleRow*>& rows, double confidence) {
  const auto variables = rows.empty() ? std::vector<std::string>() : drawn_variables(rows);
  std::vector<harness::CauseRun> runs;
  for (const auto* row : rows) {
    if (was_lost(*row)) continue;
    auto& run = runs.emplace_back();
    run.failed = failed(*row);
    for (const auto& name : variables) run.start.push_back(start_number(row->start, name));
  }
  const auto rule = variables.empty() ? std::nullopt : harness::failure_rule(runs);
  if (!rule) {
    return "<p>No variable of the start tells failing runs from clean ones, as far as these runs "
           "show.</p>\n";
  }
  std::string words;
  for (const auto& border : rule->borders) {
    words += fmt::format("{}{} {} {}", words.empty() ? "" : " and ",
                         html_short(variables[border.parameter]), border.above ? "&gt;" : "&le;",
                         number(border.value));
  }
  std::string out;
  for (const auto& border : rule->borders) {
    out += fmt::format(
        "<figure><figcaption>Share of discrepancies in ten parts of <b>{}</b>, with intervals; "
        "tinted: where runs fail.</figcaption>{}</figure>\n",
        html_short(variables[border.parameter]),
        variable_plot(rows, variables[border.parameter], border, confidence));
  }
  return fmt::format(
             "<p>{}: {} of {} discrepancies and {} of {} clean runs begin there.</p>\n<div "
             "class=\"panels\">\n",
             words, rule->failures_inside, rule->failures, rule->clean_inside, rule->clean) +
         out + "</div>\n";
}

std::string causes_table(const TraceRates& trace) {
  std::string out =
      "<div class=\"scroll\"><table><thead><tr><th>cause</th><th class=\"num\">runs</th><th "
      "class=\"num\">share</th><th class=\"num\">interval</th><th class=\"num\">first in "
      "sample</th><th>in the simulator&#39;s words</th></tr></thead><tbody>\n";
  const auto row = [&](const CauseRate& rate, const std::string& name) {
    out += fmt::format(
        "<tr><th scope=\"row\">{}</th><td class=\"num\">{}</td><td class=\"num\">{}</td><td "
        "class=\"num\">{}</td><td class=\"num\">{}</td><td>{}</td></tr>\n",
        name, count_text(rate, trace.runs), harness::percent_about(rate.rate),
        harness::percent_interval(rate.lower, rate.upper),
        rate.example > 0 ? std::to_string(rate.example) : std::string(), html_short(rate.reason));
  };
  row(trace.any, "any discrepancy");
  for (const auto& rate : trace.causes) row(rate, html_short(rate.cause));
  return out + "</tbody></table></div>\n";
}

std::string trace_part(const TraceRates& trace, const std::vector<const SampleRow*>& rows,
                       const harness::RatesResult& result) {
  const double confidence = result.confidence;
  std::string body = fmt::format("<p><code>{}</code></p>\n<p>{} runs, {} starts rejected, {} lost.",
                                 html_short(trace.trace), trace.runs, trace.rejected, trace.lost);
  if (trace.unseen > 0) body += " " + html_short(harness::unseen_text(trace.unseen)) + ".";
  body +=
      "</p>\n<div class=\"panels\"><figure><figcaption>How often each cause is the first to lead "
      "away from what is "
      "predicted, with ";
  body += fmt::format("{} intervals ({})</figcaption>{}</figure></div>\n",
                      harness::level_text(confidence), harness::interval_name(result),
                      causes_plot(trace));
  if (trace.causes.size() > kMostCauses) {
    body += fmt::format("<p>{} rarer causes are in the table alone.</p>\n",
                        trace.causes.size() - kMostCauses);
  }
  const auto settling = settling_plot(trace, rows, confidence);
  if (!settling.empty()) {
    body +=
        "<div class=\"panels\"><figure><figcaption>Share of discrepancies after so many runs; "
        "thin: the bound above it that holds, with the same confidence, whenever one "
        "looks, and takes lost runs for discrepancies</figcaption>" +
        settling + "</figure></div>\n";
  }
  body += decisive_part(rows, confidence) + causes_table(trace);
  return section_of(fmt::format("trace-{}", trace.number), fmt::format("Trace {}", trace.number),
                    body);
}

}  // namespace

std::string rates_page(const harness::RatesResult& result,
                       const std::vector<harness::SampleRow>& rows) {
  std::int64_t runs = 0, failures = 0;
  for (const auto& trace : result.traces) {
    runs += trace.runs;
    failures += trace.any.count;
  }
  auto body = fmt::format(
      "<header class=\"top {}\"><p class=\"kicker\">parallax rates: {}</p><h1>{} of {} runs give a "
      "discrepancy</h1><p>{}, seed {}, {} compared{}</p></header>\n<main id=\"main\">\n",
      failures > 0 ? "bad" : "clean", html_short(result.scenario), failures, runs,
      base::counted(std::ssize(result.traces), "trace"), result.seed,
      result.comparison == harness::Comparison::kFinal ? "last states" : "every step",
      result.complete ? "" : "; stopped before all runs were made");
  for (std::size_t i = 0; i < result.traces.size() && i < kMostRatedTraces; ++i) {
    const auto& trace = result.traces[i];
    std::vector<const SampleRow*> own;
    for (const auto& row : rows) {
      if (row.trace == trace.number) own.push_back(&row);
    }
    body += trace_part(trace, own, result);
  }
  if (result.traces.size() > kMostRatedTraces) {
    body += fmt::format("<p>{} further traces are left out.</p>\n",
                        result.traces.size() - kMostRatedTraces);
  }
  return html_document("parallax rates: " + result.scenario, body + "</main>\n");
}

}  // namespace parallax::tools
