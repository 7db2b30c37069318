#include <fmt/format.h>

#include "tools/page/markup.h"
#include "tools/page/sections.h"

namespace parallax::tools {
namespace {

std::string ledger_table(std::string_view caption, std::string_view head, const std::string& rows) {
  if (rows.empty()) return {};
  return fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"{0}\"><table>"
      "<caption>{0}</caption><thead><tr>{1}</tr></thead><tbody>\n{2}</tbody></table></div>\n",
      caption, head, rows);
}

std::string tagged(bool is_bad, std::string_view text) {
  return fmt::format("<span class=\"tag {}\">{}</span>", is_bad ? "bad" : "open", html_short(text));
}

std::string known_rows(const PageLedger& ledger) {
  std::string out;
  for (const auto& row : ledger.rows) {
    out += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td></tr>\n",
                       row.id.empty() ? "none" : html_short(row.id), tagged(row.is_wrong, row.is),
                       html_short(row.words));
  }
  return out;
}

std::string property_rows(const PageLedger& ledger) {
  std::string out;
  for (const auto& property : ledger.properties) {
    std::string rests;
    for (const auto& words : property.rests_on) rests += "<li>" + html_short(words) + "</li>";
    if (property.asks_for_review) rests += "<li><strong>to be reviewed by people</strong></li>";
    out += fmt::format(
        "<tr><th scope=\"row\"><code>{}</code></th><td><span class=\"tag {}\">{}</span></td>"
        "<td>{}</td></tr>\n",
        html_short(property.formula),
        !property.holds            ? "bad"
        : property.asks_for_review ? "open"
                                   : "clean",
        html_short(property.answer),
        rests.empty() ? "no known discrepancy" : "<ul>" + rests + "</ul>");
  }
  return out;
}

}  // namespace

std::string ledger_section(const PageData& page) {
  if (!page.ledger) return {};
  const auto& ledger = *page.ledger;
  auto out = fmt::format("<p>Held against <code>{}</code>.</p>\n", html_short(ledger.file));
  out += ledger_table("What the run shows",
                      "<th scope=\"col\">Entry</th><th scope=\"col\">Is</th>"
                      "<th scope=\"col\">What was seen</th>",
                      known_rows(ledger));
  if (ledger.rows.empty()) out += "<p>The run shows no discrepancy.</p>\n";
  for (const auto& words : ledger.gone) {
    out += "<p class=\"caveat\">" + html_short(words) + ".</p>\n";
  }
  out +=
      ledger_table("Properties of the scenario, and known discrepancies that executions go through",
                   "<th scope=\"col\">Property</th><th scope=\"col\">In the model</th>"
                   "<th scope=\"col\">Rests on</th>",
                   property_rows(ledger));
  return section_of("ledger", "Known discrepancies", out);
}

std::string opinion_section(const PageData& page) {
  if (page.opinion_sentences.empty()) return {};
  auto out = "<p>The same starts, simulated by " + html_short(page.opinion_of) + ":</p>\n<ul>\n";
  for (const auto& sentence : page.opinion_sentences) {
    out += "<li>" + html_short(sentence) + ".</li>\n";
  }
  return section_of("opinion", "Second opinion", out + "</ul>\n");
}

}  // namespace parallax::tools
