#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "compiler/base/ascii.h"
#include "compiler/base/words.h"
#include "harness/report/report_words.h"
#include "harness/report/text_layout.h"
#include "tools/page/markup.h"
#include "tools/page/sections.h"

namespace parallax::tools {

std::string section_of(std::string_view id, std::string_view heading, std::string_view body) {
  return fmt::format(
      "<section id=\"{0}\" aria-labelledby=\"{0}-h\">\n<h2 "
      "id=\"{0}-h\">{1}</h2>\n{2}</section>\n\n",
      id, heading, body);
}

std::string command_box(std::string_view command) {
  return fmt::format("<code class=\"command\">{}</code>\n", html_short(command));
}

const char* verdict_class(std::string_view verdict) {
  if (verdict == "no-discrepancy" || verdict == "clean" || verdict == "ok") return "clean";
  if (verdict == "discrepancy" || verdict == "failed") return "bad";
  return verdict == "lost" ? "lost" : "open";
}

std::string replay_words(const PageData& page, std::int64_t trace, std::int64_t sample) {
  return fmt::format("parallax replay {} --sample {}", harness::shell_word(page.folder),
                     sample_name(trace, sample));
}

const harness::ReportedDiscrepancy* told_discrepancy(const PageData& page) {
  if (page.discrepancies.empty()) return nullptr;
  const auto found =
      std::find_if(page.discrepancies.begin(), page.discrepancies.end(),
                   [](const auto& one) { return one.standing.is != harness::Standing::kInDoubt; });
  return found == page.discrepancies.end() ? &page.discrepancies.front() : &*found;
}

bool is_in_doubt(const PageData& page) {
  const auto* told = told_discrepancy(page);
  return told != nullptr && told->standing.is == harness::Standing::kInDoubt;
}

namespace {

std::string verdict_title(const PageData& page) {
  if (page.verdict == "no-discrepancy") return "No discrepancy found";
  if (page.verdict == "discrepancy") {
    const auto* told = told_discrepancy(page);
    if (told == nullptr) return "Discrepancy";
    std::string title(harness::headline_word(told->standing.is));
    title.front() = 'D';
    return title;
  }
  if (page.verdict == "inconclusive") return "Inconclusive";
  return page.running ? "Not finished" : "No verdict";
}

/// The discrepancy between model and world, with its standing.
std::string discrepancy_lead(const harness::ReportedDiscrepancy& found) {
  auto out = "<p class=\"lead\">" + html_words(found.words) + ".</p>\n";
  auto words = found.standing.words;
  if (words.empty()) return out;
  words.front() = base::to_upper(words.front());
  return out + "<p class=\"standing\">" + html_words(words) + ".</p>\n";
}

std::string fact(std::string_view name, std::string_view value) {
  if (value.empty()) return {};
  return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, html_short(value));
}

std::string differences_table(const harness::Discrepancy& found) {
  const auto in_first = [&](const harness::DivergingFluent& one) {
    return std::any_of(found.first.begin(), found.first.end(),
                       [&](const auto& other) { return other.fluent == one.fluent; });
  };
  const auto row = [](const harness::DivergingFluent& one, bool follows) {
    return fmt::format(
        "<tr{}><th scope=\"row\">{}{}</th><td data-label=\"Predicted\">{}</td>"
        "<td data-label=\"Observed\">{}</td><td class=\"num\" data-label=\"At\">{}</td>"
        "<td data-label=\"Measured\">{}</td></tr>\n",
        follows ? " class=\"follows\"" : "", follows ? "then " : "", html_short(one.fluent),
        one.predicted, one.observed, one.timepoint, html_short(one.measured));
  };
  std::string rows;
  for (const auto& one : found.first) rows += row(one, false);
  for (const auto& one : found.fluents) {
    if (!in_first(one)) rows += row(one, true);
  }
  if (rows.empty()) return {};
  return "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"What differs\">"
         "<table class=\"flow\"><caption>What differs; consequences below the first "
         "difference</caption>"
         "<thead><tr><th scope=\"col\">Fluent</th><th scope=\"col\">Predicted</th>"
         "<th scope=\"col\">Observed</th><th scope=\"col\">At</th>"
         "<th scope=\"col\">Measured</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

const PageTimeline* timeline_of(const PageData& page, const harness::Discrepancy& found) {
  for (const auto& timeline : page.timelines) {
    if (timeline.trace == found.trace && timeline.sample == found.sample) return &timeline;
  }
  return nullptr;
}

/// The event at which they part: the one that ends at the first difference, or as `cause` names it.
std::optional<std::size_t> parting_step(const harness::Discrepancy& found,
                                        const std::vector<PageStep>& steps) {
  if (found.path && found.path->event >= 0) {
    return static_cast<std::size_t>(found.path->event);
  }
  const auto name = found.cause.text.substr(0, found.cause.text.find(": "));
  for (auto i = static_cast<std::size_t>(std::max<std::int64_t>(found.first_divergence, 1) - 1);
       i < steps.size(); ++i) {
    if (steps[i].event == name) return i;
  }
  return std::nullopt;
}

/// A value of the start as text.
struct ValueText {
  std::string operator()(double value) const { return std::isnan(value) ? "null" : number(value); }
  std::string operator()(std::int64_t value) const { return number(static_cast<double>(value)); }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(const std::string& value) const { return value; }
};

std::string start_table(const harness::Discrepancy& found) {
  if (found.record.initial.empty()) return {};
  std::string out =
      "<details><summary>Start state of this simulation</summary><dl class=\"facts\">\n";
  for (const auto& [name, value] : found.record.initial) {
    out += fact(html_short(name), std::visit(ValueText(), value));
  }
  return out + "</dl></details>\n";
}

/// Events in order; with `marked` the one where model and world part.
std::string steps_table(const std::vector<PageStep>& steps, std::optional<std::size_t> marked,
                        const SourceLinks& links) {
  const bool simulated = std::any_of(steps.begin(), steps.end(),
                                     [](const PageStep& step) { return !step.outcome.empty(); });
  std::string out =
      "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"Events\"><table "
      "class=\"flow\">"
      "<thead><tr><th scope=\"col\">#</th><th scope=\"col\">Event</th><th scope=\"col\">Plan</th>"
      "<th scope=\"col\">Axioms</th>";
  out += simulated ? "<th scope=\"col\">Outcome</th><th scope=\"col\">Took</th>" : "";
  out += "</tr></thead><tbody>\n";
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto& step = steps[i];
    const bool later = marked && i > *marked;
    out += fmt::format(
        "<tr{}><td class=\"num\" data-label=\"#\">{}</td><th scope=\"row\">{}{}</th><td "
        "data-label=\"Plan\">{}</td><td data-label=\"Axioms\">",
        marked == i ? " class=\"parts\""
        : later     ? " class=\"follows\""
                    : "",
        i, html_short(step.event),
        marked == i ? " <span class=\"tag bad\">they part here</span>" : "",
        links.link(step.source));
    constexpr std::size_t kMostAxioms = 8;
    const auto& axioms = links.axioms_of(step.event);
    for (std::size_t k = 0; k < axioms.size() && k < kMostAxioms; ++k) {
      out += (k > 0 ? ", " : "") + links.link(axioms[k].place);
    }
    if (axioms.size() > kMostAxioms) out += fmt::format(", {} more", axioms.size() - kMostAxioms);
    out += "</td>";
    if (simulated) {
      out += fmt::format(
          "<td data-label=\"Outcome\"><span class=\"{}\">{}</span>{}{}</td><td class=\"num\" "
          "data-label=\"Took\">{}</td>",
          // Only the marked step is coloured: the model allows other failures, or they are
          // consequences.
          step.outcome == "ok" || marked == i ? verdict_class(step.outcome) : "open",
          html_short(step.outcome), step.reason.empty() ? "" : ": ", html_words(step.reason),
          step.sim_time_s ? number(*step.sim_time_s) + " s" : "");
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string axioms_of_step(const PageStep& step, const SourceLinks& links) {
  const auto& axioms = links.axioms_of(step.event);
  if (axioms.empty()) return {};
  std::string out = "<figure class=\"excerpt\"><figcaption>What the model says of " +
                    html_short(step.event) + "</figcaption><pre>";
  for (const auto& axiom : axioms) {
    const auto shown = axiom.text.substr(0, 400);
    out += "<span class=\"l\">" + coloured(shown, "axiom.e") + "  <i>" + links.link(axiom.place) +
           "</i></span>\n";
  }
  return out + "</pre></figure>\n";
}

}  // namespace

std::string stream_name(const PageData& page, const PageTrace& trace) {
  return page.closed_loop ? "Executions" : fmt::format("Trace {}", trace.number);
}

std::string rule_html(const PageRule& rule) {
  std::string out;
  for (const auto& border : rule.borders) {
    out += fmt::format("{}<code>{} {} {}</code>", out.empty() ? "" : " and ",
                       html_short(border.variable), border.above ? "&gt;" : "&le;",
                       number(border.value, 6));
  }
  return out;
}

std::vector<std::string> claims_of(const PageData& page) {
  // The trace of the first discrepancy comes first.
  const auto rank = [&](const PageTrace& trace) {
    if (!page.discrepancies.empty() && trace.number == page.discrepancies.front().found.trace)
      return 0;
    return trace.verdict == page.verdict ? 1 : 2;
  };
  std::vector<std::string> out;
  if (!page.claim.empty()) {
    constexpr std::size_t kLongest = 1000;  // its names are not a stranger's
    const auto whose = page.traces.size() == 1 ? stream_name(page, page.traces.front())
                                               : std::string("All traces");
    out.push_back("<b>" + whose + ":</b> " + html(page.claim.substr(0, kLongest)) + '.');
    if (page.traces.size() == 1) return out;
  }
  for (const int wanted : {0, 1, 2}) {
    for (const auto& trace : page.traces) {
      if (trace.claim.empty() || rank(trace) != wanted) continue;
      out.push_back("<b>" + stream_name(page, trace) + ":</b> " + html_words(trace.claim) + '.');
    }
  }
  return out;
}

std::string verdict_section(const PageData& page) {
  std::string out = fmt::format(
      "<header class=\"top {}\">\n<p class=\"kicker\">parallax report &middot; "
      "{}</p>\n<h1>{}</h1>\n",
      is_in_doubt(page) ? "open" : verdict_class(page.verdict), html_short(page.scenario),
      verdict_title(page));
  const auto* told = told_discrepancy(page);
  if (told != nullptr) out += discrepancy_lead(*told);
  // It is a rule of the first one.
  if (page.rule && told == page.discrepancies.data()) {
    const auto& rule = *page.rule;
    out += fmt::format(
        "<p class=\"lead\">It happens where {}: {} of {} simulations there, and {} of {} "
        "elsewhere.</p>\n",
        rule_html(rule), rule.failures_inside, rule.failures_inside + rule.clean_inside,
        rule.failures - rule.failures_inside,
        rule.failures + rule.clean - rule.failures_inside - rule.clean_inside);
  }
  constexpr std::size_t kMostClaims = 3;
  const auto claims = claims_of(page);
  for (std::size_t i = 0; i < claims.size() && i < kMostClaims; ++i) {
    out += "<p class=\"claim\">" + claims[i] + "</p>\n";
  }
  if (claims.size() > kMostClaims) {
    out += fmt::format(
        "<p class=\"claim\">Claims of {} further traces: <a href=\"#traces\">traces</a>.</p>\n",
        claims.size() - kMostClaims);
  }
  out += "<dl class=\"facts\">\n" + fact("Scenario", page.scenario);
  if (page.closed_loop) {
    out += fact("Simulations", fmt::format("{}, executions of the plan", page.simulations));
    for (const auto& trace : page.traces) out += fact("Shown", trace.covered);
  } else {
    out += fact("Simulations", fmt::format("{}, of {}", page.simulations,
                                           base::counted(std::ssize(page.traces), "trace")));
    out +=
        fact("Explored", page.exploration == "stopped" ? "stopped before all traces were explored"
                                                       : page.exploration);
  }
  for (const auto& bound : page.bounds) out += fact("Left out", bound);
  if (!page.ignored.empty()) {
    out += fact("Not compared", fmt::format("{}", fmt::join(page.ignored, ", ")));
  }
  std::vector<harness::LossCount> losses;
  for (const auto& trace : page.traces) harness::add_losses(trace.losses, losses);
  if (!losses.empty()) {
    out += "<div><dt>Lost</dt><dd>" + html_words(harness::loss_words(losses)) + "</dd></div>\n";
  }
  out += fact("Criterion", page.criterion) + fact("Simulator", page.simulator) +
         fact("Seed", std::to_string(page.seed)) + fact("Run folder", page.folder);
  out += "</dl>\n</header>\n\n";
  for (const auto& banner : page.banners) {
    out += "<p class=\"banner\" role=\"note\">" +
           html(banner.size() > 3000 ? banner.substr(0, 3000) : banner) + "</p>\n";
  }
  return out;
}

std::string discrepancy_section(const PageData& page, const SourceLinks& links) {
  constexpr std::size_t kMost = 20;
  std::string out;
  for (std::size_t i = 0; i < page.discrepancies.size() && i < kMost; ++i) {
    const auto& reported = page.discrepancies[i];
    const auto& found = reported.found;
    const auto* timeline = timeline_of(page, found);
    std::vector<PageStep> steps = timeline != nullptr ? timeline->steps : std::vector<PageStep>();
    for (const auto& trace : page.traces) {
      if (steps.empty() && trace.number == found.trace) steps = trace.steps;
    }
    const auto marked = parting_step(found, steps);
    out += fmt::format("<article><h3>Simulation {}</h3>\n", reported.id());
    if (&reported != told_discrepancy(page)) out += discrepancy_lead(reported);
    if (!found.cause.reason.empty()) {
      out += "<p>The simulator says: " + html_words(found.cause.reason) + ".</p>\n";
    }
    out += steps_table(steps, marked, links);
    out += differences_table(found);
    if (marked && *marked < steps.size()) {
      out += links.excerpt(steps[*marked].source, 2) + axioms_of_step(steps[*marked], links);
    }
    out += start_table(found);
    out += "<p>Repeat it to the bit:</p>\n" +
           command_box(replay_words(page, found.trace, found.sample)) + "</article>\n";
  }
  if (page.discrepancies.size() > kMost) {
    out += fmt::format("<p>{} further discrepancies are in the table of simulations.</p>\n",
                       page.discrepancies.size() - kMost);
  }
  return out.empty() ? out : section_of("discrepancy", "Where they part", out);
}

namespace {

/// The ways that executions of the plan went, as far as the report tells them apart.
std::string paths_table(const PageData& page, const PageTrace& trace) {
  constexpr std::size_t kMostWays = 200;
  if (trace.paths.empty()) return {};
  std::string rows;
  for (std::size_t i = 0; i < trace.paths.size() && i < kMostWays; ++i) {
    const auto& path = trace.paths[i];
    rows += fmt::format(
        "<tr><td class=\"num\">{}</td><td>{}</td><td>{}</td><td><code>{}</code></td></tr>\n",
        path.simulations, html_short(path.steps), html_short(path.end),
        html_short(replay_words(page, trace.number, path.example)));
  }
  auto out =
      "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"Ways of "
      "executions\"><table>"
      "<caption>Ways that executions went; without a word an event succeeded</caption><thead><tr>"
      "<th scope=\"col\">Executions</th><th scope=\"col\">Events</th><th scope=\"col\">End</th>"
      "<th scope=\"col\">Repeat the first</th></tr></thead><tbody>\n" +
      rows + "</tbody></table></div>\n";
  if (trace.paths.size() > kMostWays) {
    out +=
        fmt::format("<p>{} further ones are in report.json.</p>\n", trace.paths.size() - kMostWays);
  }
  return out;
}

}  // namespace

std::string traces_section(const PageData& page, const SourceLinks& links) {
  constexpr std::size_t kMostInFull = 60, kMost = 2000, kOpen = 2;
  std::string out;
  for (std::size_t i = 0; i < page.traces.size() && i < kMost; ++i) {
    const auto& trace = page.traces[i];
    out += fmt::format(
        "<details{}><summary>{} <span class=\"tag {}\">{}</span> {} simulations, {} "
        "clean{}</summary>\n",
        i < kOpen ? " open" : "", stream_name(page, trace), verdict_class(trace.verdict),
        trace.verdict.empty() ? "not judged" : html_short(trace.verdict), trace.simulations,
        trace.clean, trace.lost > 0 ? fmt::format(", {} lost", trace.lost) : "");
    if (!trace.losses.empty()) {
      out +=
          "<p class=\"caveat\">Lost: " + html_words(harness::loss_words(trace.losses)) + ".</p>\n";
    }
    if (!trace.claim.empty()) out += "<p class=\"claim\">" + html_words(trace.claim) + ".</p>\n";
    for (const auto& caveat : trace.caveats) {
      out += "<p class=\"caveat\">" + html_short(caveat) + ".</p>\n";
    }
    out += paths_table(page, trace);
    if (i < kMostInFull && !trace.steps.empty()) out += steps_table(trace.steps, {}, links);
    out += "</details>\n";
  }
  if (page.traces.size() > kMost) {
    out +=
        fmt::format("<p>{} further traces are in report.json.</p>\n", page.traces.size() - kMost);
  }
  const auto* heading = page.closed_loop ? "Executions and what is claimed of them"
                                         : "Traces and what is claimed of them";
  return out.empty() ? out : section_of("traces", heading, out);
}

}  // namespace parallax::tools
