#include <fmt/format.h>

#include <algorithm>

#include "tools/page/markup.h"
#include "tools/page/sections.h"

namespace parallax::tools {

namespace {

constexpr std::size_t kMostStates = 50;

/// Those with a discrepancy first.
std::string states_table(const PageData& page, const PageTrace& trace) {
  auto states = trace.states;
  std::stable_sort(states.begin(), states.end(), [](const PageState& a, const PageState& b) {
    return a.discrepancies > 0 && b.discrepancies == 0;
  });
  auto out = fmt::format(
      "<h3>{}: {} of {} initial states simulated</h3>\n<div class=\"scroll\" tabindex=\"0\" "
      "role=\"group\" aria-label=\"Initial states of {}\"><table><thead><tr><th "
      "scope=\"col\">State</th><th scope=\"col\">Holds there, not in all</th><th "
      "scope=\"col\">Clean</th><th scope=\"col\">Lost</th><th scope=\"col\">Discrepancies</th>"
      "</tr></thead><tbody>\n",
      stream_name(page, trace), states.size(), html(trace.all_states), stream_name(page, trace));
  for (std::size_t i = 0; i < states.size() && i < kMostStates; ++i) {
    const auto& state = states[i];
    out += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{}</td><td class=\"num\">{}</td><td "
        "class=\"num\">{}</td><td class=\"num\">{}</td></tr>\n",
        state.number, html_words(state.holds), state.clean, state.lost,
        state.discrepancies == 0 ? "0" : fmt::format("<b>{}</b>", state.discrepancies));
  }
  out += "</tbody></table></div>\n";
  if (states.size() > kMostStates) {
    out +=
        fmt::format("<p>{} further states are in report.json.</p>\n", states.size() - kMostStates);
  }
  return out;
}

}  // namespace

std::string start_section(const PageData& page) {
  std::string out;
  for (const auto& trace : page.traces) {
    if (!trace.states.empty()) out += states_table(page, trace);
  }
  return out.empty() ? out : section_of("states", "Initial states", out);
}

}  // namespace parallax::tools
