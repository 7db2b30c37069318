#include <fmt/format.h>

#include <cmath>
#include <set>

#include "harness/report/text_layout.h"
#include "tools/page/markup.h"
#include "tools/page/plot.h"
#include "tools/page/sections.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kMostRows = 20'000;
constexpr std::size_t kMostPoints = 60'000;  // of ways in the data block

std::string sample_row(const PageData& page, const PageSample& sample) {
  const bool is_own = sample.origin != SampleOrigin::kFurther;
  return fmt::format(
      "<tr><th scope=\"row\">{}</th><td class=\"{}\">{}</td><td>{}</td><td>{}</td><td "
      "class=\"num\">{}</td>"
      "<td class=\"num\">{}</td><td class=\"num\">{}</td><td><code>{}</code></td></tr>\n",
      sample_name(sample.trace, sample.sample), verdict_class(to_string(sample.verdict)),
      sample.unfinished && sample.verdict == PageVerdict::kClean ? "did not end"
                                                                 : to_string(sample.verdict),
      to_string(sample.origin), html_short(sample.cause), sample.events, number(sample.sim_time_s),
      sample.seed, html_short(is_own ? replay_words(page, sample.trace, sample.sample) : ""));
}

}  // namespace

std::string samples_section(const PageData& page) {
  if (page.samples.empty()) return {};
  std::set<std::string> causes;
  for (const auto& sample : page.samples) {
    if (!sample.cause.empty() && causes.size() < 100) causes.insert(sample.cause);
  }
  std::string options = "<option value=\"\">any</option>";
  for (const auto* verdict : {"clean", "discrepancy", "lost", "not judged", "did not end"}) {
    options += fmt::format("<option>{}</option>", verdict);
  }
  std::string cause_options = "<option value=\"\">any</option>";
  for (const auto& cause : causes) cause_options += "<option>" + html_short(cause) + "</option>";
  std::string rows;
  for (std::size_t i = 0; i < page.samples.size() && i < kMostRows; ++i) {
    rows += sample_row(page, page.samples[i]);
  }
  auto out = fmt::format(
      "<div class=\"controls\" hidden><label>Verdict <select id=\"by-verdict\">{}</select></label> "
      "<label>Cause <select id=\"by-cause\">{}</select></label> <label>Text <input type=\"search\" "
      "id=\"by-text\"></label> <span id=\"row-count\" aria-live=\"polite\"></span></div>\n"
      "<div class=\"scroll tall\" tabindex=\"0\" role=\"group\" aria-label=\"Simulations\">"
      "<table id=\"samples-table\"><thead><tr><th scope=\"col\">Simulation</th><th "
      "scope=\"col\">Verdict</th><th scope=\"col\">Start</th><th scope=\"col\">Cause</th><th "
      "scope=\"col\">Events</th><th "
      "scope=\"col\">Simulated&nbsp;s</th><th scope=\"col\">Seed</th><th scope=\"col\">Repeat "
      "it</th>"
      "</tr></thead><tbody>\n{}</tbody></table></div>\n",
      options, cause_options, rows);
  if (page.samples.size() > kMostRows) {
    out += fmt::format("<p>{} further simulations are in the journal.</p>\n",
                       page.samples.size() - kMostRows);
  }
  return section_of("samples", "Simulations", out);
}

std::string coverage_section(const PageData& page) {
  if (page.coverage.empty()) return {};
  std::string rows;
  for (const auto& [group, covered, all] : page.coverage) {
    rows += fmt::format(
        "<tr><th scope=\"row\">{0}</th><td class=\"num\">{1} of {2}</td><td><progress "
        "value=\"{1}\" "
        "max=\"{2}\" aria-label=\"{0} covered\"></progress></td></tr>\n",
        html_short(group), covered, all == "0" ? "1" : all);
  }
  return section_of(
      "coverage", "Coverage",
      "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"Coverage\"><table "
      "class=\"coverage\"><thead><tr><th scope=\"col\">Of the plan and the model</th><th "
      "scope=\"col\">Gone "
      "through</th><th scope=\"col\">Share</th></tr></thead><tbody>\n" +
          rows + "</tbody></table></div>\n<p>Each of them with its count:</p>\n" +
          command_box("parallax coverage " + harness::shell_word(page.folder)));
}

std::string blame_section(const PageData& page, const SourceLinks& links) {
  std::string out;
  if (page.blame) {
    const auto& blame = *page.blame;
    const auto cause = blame.cause.empty()
                           ? std::string()
                           : "<p><b>Kind of cause:</b> " + html_words(blame.cause) + "</p>\n";
    // Where runs contradict each other, no axiom has to change at once.
    if (blame.cause_first) out += cause;
    if (!blame.where.empty()) out += "<p class=\"lead\">" + html_words(blame.where) + "</p>\n";
    out += "<p class=\"lead\">" + html_words(blame.words) + "</p>\n";
    if (!blame.more.empty()) out += "<p>" + html_words(blame.more) + "</p>\n";
    if (!blame.cause_first) out += cause;
    if (!blame.axioms.empty()) {
      out += "<h3>Axioms that contradict what was observed</h3>\n<ul class=\"axioms\">\n";
      for (const auto& axiom : blame.axioms) {
        out += fmt::format("<li><pre>{}</pre> {}</li>\n",
                           coloured(axiom.text.substr(0, 2000), "a.e"), links.link(axiom.place));
      }
      out += "</ul>\n";
    }
  } else if (!page.discrepancies.empty()) {
    out +=
        "<p>Which axioms say otherwise, and whether it is chance or a part of the start "
        "region, is told by this command; a report made afterwards shows it:</p>\n" +
        command_box("parallax explain " + harness::shell_word(page.folder));
  }
  for (const auto& finding : page.findings) {
    out += "<h3>Simulation " + html_short(finding.sample) +
           " repeated, and its start moved</h3>\n<ul>";
    for (const auto& sentence : finding.sentences) out += "<li>" + html_words(sentence) + "</li>\n";
    out += "</ul>\n";
  }
  if (!page.discrepancies.empty() && page.findings.empty()) {
    out +=
        "<p>Whether it happens again with other seeds and half the step, and which parameters of "
        "the start it takes:</p>\n" +
        command_box("parallax confirm " + harness::shell_word(page.folder));
  }
  if (!page.proposals.empty()) out += "<h3>Proposed repairs</h3>\n";
  for (const auto& note : page.repair_notes) out += "<p>" + html_words(note) + "</p>\n";
  for (std::size_t i = 0; i < page.proposals.size(); ++i) {
    const auto& proposal = page.proposals[i];
    std::string patch, facts, tied;
    for (const auto& fact : proposal.facts) facts += "<p>" + html_words(fact) + "</p>";
    for (const auto number : proposal.tied) {
      tied += (tied.empty() ? "" : ", ") + std::to_string(number);
    }
    for (std::size_t begin = 0; begin < proposal.patch.size();) {
      const auto end = std::min(proposal.patch.find('\n', begin), proposal.patch.size());
      const auto text = proposal.patch.substr(begin, end - begin);
      const char* mark = text.starts_with('+') ? "add" : text.starts_with('-') ? "cut" : "same";
      patch += fmt::format("<span class=\"{}\">{}</span>\n", mark, html(text));
      begin = end + 1;
    }
    out += fmt::format(
        "<details{}><summary>{}. {}{}{}{}</summary>{}<pre class=\"patch\" "
        "tabindex=\"0\">{}</pre></details>\n",
        i == 0 ? " open" : "", i + 1, html_words(proposal.words),
        proposal.changes.empty() || proposal.changes == "model"
            ? ""
            : " <span class=\"tag\">of the " + html_short(proposal.changes) + "</span>",
        proposal.tied.empty() ? "" : " <span class=\"tag\">tied with " + tied + "</span>",
        proposal.precaution ? " <span class=\"tag\">precaution</span>" : "", facts, patch);
  }
  if (!page.repair_words.empty()) out += "<pre>" + html_lines(page.repair_words) + "</pre>\n";
  if (!page.discrepancies.empty() && !page.repair_was_asked) {
    out += "<p>Changes of the model that admit everything seen:</p>\n" +
           command_box("parallax repair " + harness::shell_word(page.folder));
  }
  return out.empty() ? out : section_of("blame", "Why, and what to change", out);
}

std::string data_block(const PageData& page) {
  if (page.samples.empty()) return {};
  std::size_t points = 0;
  const auto place = [](const std::array<float, 2>& at) {
    if (!std::isfinite(at[0]) || !std::isfinite(at[1])) return std::string("[0,0]");
    return fmt::format("[{:.4g},{:.4g}]", at[0], at[1]);
  };
  const auto plotted = plotted_variables(page);
  const bool has_starts = plotted.samples.size() > kMostDots;  // for the canvas
  std::string out = "{\"bodies\":[";
  for (std::size_t i = 0; i < page.bodies.size(); ++i) {
    out += (i > 0 ? "," : "") + json_word(page.bodies[i].substr(0, 200));
  }
  out += "],\"samples\":[";
  bool is_first = true;
  for (std::size_t i = 0; i < page.samples.size() && i < kMostRows; ++i) {
    const auto& sample = page.samples[i];
    out += fmt::format("{}[\"{}\",{},{},[", is_first ? "" : ",\n",
                       sample_name(sample.trace, sample.sample), static_cast<int>(sample.verdict),
                       json_word(sample.cause.substr(0, 200)));
    is_first = false;
    for (std::size_t body = 0; body < sample.ways.size(); ++body) {
      const auto& way = sample.ways[body];
      out += body > 0 ? ",[" : "[";
      const bool whole = points + way.size() <= kMostPoints ||
                         (sample.verdict == PageVerdict::kDiscrepancy && points < 2 * kMostPoints);
      for (std::size_t t = 0; t < way.size(); ++t) {
        const bool is_end = t == 0 || t + 1 == way.size();
        if (!is_end && (!whole || way[t] == way[t - 1])) continue;
        out += (t > 0 ? "," : "") + place(way[t]);
        ++points;
      }
      out += "]";
    }
    out += fmt::format("],{}", static_cast<int>(sample.origin));
    if (has_starts) {
      out += ",[";
      for (std::size_t k = 0; k < plotted.chosen.size(); ++k) {
        const double value = sample.start[plotted.chosen[k]];
        out += (k > 0 ? "," : "") +
               (std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string("null"));
      }
      out += ']';
    }
    out += ']';
  }
  return "<script type=\"application/json\" id=\"data\">" + out + "]}</script>\n";
}

}  // namespace parallax::tools
