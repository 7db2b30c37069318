#include <fmt/format.h>

#include "compiler/base/words.h"
#include "tools/page/markup.h"
#include "tools/page/sections.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kMostInFull = 12;  // timelines with all of their fluents

/// One cell for each stretch of equal values, marked where the other side says otherwise; a stretch
/// ends at the parting.
std::string stretches(const std::string& values, const std::string& other,
                      std::optional<std::size_t> parting) {
  const auto differs = [&](std::size_t t) {
    return values[t] != other[t] && values[t] != '-' && other[t] != '-';
  };
  std::string out;
  for (std::size_t begin = 0; begin < values.size();) {
    auto end = begin + 1;
    while (end < values.size() && values[end] == values[begin] && end != parting &&
           differs(end) == differs(begin)) {
      ++end;
    }
    const char value = values[begin];
    const char* word = value == '1'   ? "true"
                       : value == '0' ? "false"
                       : value == 'n' ? "neither"
                                      : "?";
    out += fmt::format("<td class=\"v{}{}{}\" colspan=\"{}\">{}</td>", value == '-' ? 'x' : value,
                       begin == parting ? " p" : "", differs(begin) ? " d" : "", end - begin, word);
    begin = end;
  }
  return out;
}

std::string heading(const PageTimeline& timeline) {
  std::string out =
      "<thead><tr><th scope=\"col\">Fluent</th><th scope=\"col\"></th>"
      "<th scope=\"col\">start</th>";
  for (std::size_t i = 0; i < timeline.steps.size(); ++i) {
    const auto& step = timeline.steps[i];
    const bool parts = timeline.parting == i + 1;
    const bool failed = !step.outcome.empty() && step.outcome != "ok";
    out += fmt::format("<th scope=\"col\" class=\"ev{}{}\"><span>{} {}{}</span></th>",
                       parts ? " p" : "", failed && parts ? " failed" : "", i,
                       html_short(step.event), failed ? " failed" : "");
  }
  return out + "</tr></thead>\n";
}

std::string row_html(const TimelineRow& row, const PageTimeline& timeline) {
  const bool is_first = row.role == TimelineRow::Role::kFirst;
  const bool follows = row.role == TimelineRow::Role::kFollows;
  const auto classes = std::string(is_first  ? "first"
                                   : follows ? "follows"
                                             : "") +
                       (row.changes ? "" : " steady");
  const auto name =
      html_short(row.fluent) + (is_first  ? " <span class=\"tag bad\">differs first</span>"
                                : follows ? " <span class=\"tag\">consequence</span>"
                                          : "");
  const auto no_world = row.observed.find_first_not_of('-') == std::string::npos;
  if (row.predicted == row.observed || no_world) {
    return fmt::format(
        "<tr class=\"{}\"><th scope=\"row\">{}</th><td class=\"who\">{}</td>{}</tr>\n", classes,
        name, no_world ? "predicted" : "both",
        stretches(row.predicted, row.observed, timeline.parting));
  }
  return fmt::format(
      "<tr class=\"{0}\"><th scope=\"row\" rowspan=\"2\">{1}</th><td "
      "class=\"who\">predicted</td>{2}"
      "</tr>\n<tr class=\"{0} world\"><td class=\"who\">observed</td>{3}</tr>\n",
      classes, name, stretches(row.predicted, row.observed, timeline.parting),
      stretches(row.observed, row.predicted, timeline.parting));
}

}  // namespace

std::string timeline_section(const PageData& page) {
  std::string out;
  for (std::size_t i = 0; i < page.timelines.size(); ++i) {
    const auto& timeline = page.timelines[i];
    if (timeline.rows.empty()) continue;
    const auto name = sample_name(timeline.trace, timeline.sample);
    std::size_t steady = 0;
    std::string rows;
    for (const auto& row : timeline.rows) {
      if (!row.changes) ++steady;
      if (row.changes || i < kMostInFull) rows += row_html(row, timeline);
    }
    const bool is_open = i == 0 || timeline.verdict == PageVerdict::kDiscrepancy;
    out += fmt::format(
        "<details class=\"timeline\"{}><summary>Simulation {} <span class=\"tag {}\">{}</span>{}"
        "</summary>\n",
        is_open && i < 4 ? " open" : "", name, verdict_class(to_string(timeline.verdict)),
        to_string(timeline.verdict),
        timeline.verdict == PageVerdict::kDiscrepancy ? "" : " to compare with");
    if (steady > 0 && i < kMostInFull) {
      out += fmt::format(
          "<input type=\"checkbox\" class=\"all\" id=\"all-{0}\"><label for=\"all-{0}\">Show also "
          "{1} that {2} not change</label>\n",
          i, steady == 1 ? "the fluent" : fmt::format("the {} fluents", steady),
          base::agreed(steady, "does", "do"));
    }
    out += fmt::format(
        "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"Timeline of simulation "
        "{}\"><table class=\"tl\">\n{}<tbody>\n{}</tbody></table></div></details>\n",
        name, heading(timeline), rows);
  }
  if (out.empty()) return out;
  if (page.timelines_left_out > 0) {
    out += fmt::format("<p>{} further timelines are left out.</p>\n", page.timelines_left_out);
  }
  return section_of("timeline", "Timeline: predicted and observed",
                    "<p>Fluents after each event. Where model and world agree there is one line "
                    "(both); the thick border is the first difference.</p>\n" +
                        out);
}

}  // namespace parallax::tools
