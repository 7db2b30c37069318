#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "harness/confidence/clean_runs.h"
#include "harness/confidence/rounding.h"
#include "tools/page/markup.h"
#include "tools/page/sections.h"
#include "tools/page/write_page.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kMostEvents = 60;   // of a trace that is named
constexpr std::size_t kMostTraces = 500;  // rows

/// Identifies a trace regardless of its number: by its events and, where several have the same, its
/// start.
std::string key_of(const PageTrace& trace, bool with_start) {
  std::string out;
  for (const auto& step : trace.steps) out += step.event + ';';
  if (!with_start) return out;
  out += '|';
  for (const auto& fluent : trace.initial_state) out += fluent + ';';
  return out;
}

/// The events for which some run has several traces, which begin in different states.
std::set<std::string> ambiguous_events(const std::vector<PageData>& pages) {
  std::set<std::string> out;
  for (const auto& page : pages) {
    std::set<std::string> seen;
    for (const auto& trace : page.traces) {
      auto key = key_of(trace, false);
      if (!seen.insert(key).second) out.insert(std::move(key));
    }
  }
  return out;
}

/// Fluents that hold at the start of a trace and not at that of every other one with its events.
std::string start_of(const PageTrace& trace, const std::vector<PageData>& pages) {
  const auto events = key_of(trace, false);
  std::map<std::string, std::size_t> counts;
  std::size_t traces = 0;
  for (const auto& page : pages) {
    for (const auto& other : page.traces) {
      if (key_of(other, false) != events) continue;
      ++traces;
      for (const auto& fluent : other.initial_state) ++counts[fluent];
    }
  }
  constexpr std::size_t kMost = 8;
  std::string out;
  std::size_t shown = 0;
  for (const auto& fluent : trace.initial_state) {
    if (counts[fluent] == traces) continue;
    if (++shown <= kMost) out += (shown > 1 ? ", " : "") + html_short(fluent);
  }
  if (shown > kMost) out += ", &hellip;";
  return shown > 0 ? out : "none of what others begin with";
}

std::string events_of(const PageTrace& trace) {
  std::string out;
  for (std::size_t i = 0; i < trace.steps.size() && i < kMostEvents; ++i) {
    out += (i > 0 ? ", " : "") + html_short(trace.steps[i].event);
  }
  return trace.steps.size() > kMostEvents ? out + ", &hellip;" : out;
}

/// The share of simulations that were not clean, with an interval that holds whatever ended the
/// run: most end at their first discrepancy, so their number is not fixed.
std::string rate_of(std::int64_t bad, std::int64_t runs) {
  if (runs <= 0) return "no simulations";
  const auto k = static_cast<double>(bad), n = static_cast<double>(runs);
  constexpr double kOneSided = 0.975;
  const double lower = 1.0 - harness::mixture_upper(runs - bad, runs, kOneSided);
  const double upper = harness::mixture_upper(bad, runs, kOneSided);
  return fmt::format("{} of {} ({}; {})", bad, runs, harness::percent_about(k / n),
                     harness::percent_interval(lower, upper));
}

std::string column_heads(const std::vector<PageData>& pages) {
  std::string out;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    out += fmt::format("<th scope=\"col\">{}{}</th>", html_short(pages[i].folder),
                       i == 0 ? " (first)" : "");
  }
  return out + "</tr></thead><tbody>\n";
}

template <typename Cell>
std::string row(const std::string& name, const std::vector<PageData>& pages, const Cell& cell) {
  auto out = "<tr><th scope=\"row\">" + name + "</th>";
  for (const auto& page : pages) out += "<td>" + cell(page) + "</td>";
  return out + "</tr>\n";
}

std::string table_of(const std::string& label, const std::string& head, const std::string& rows) {
  return "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"" + label +
         "\"><table class=\"compare\"><thead><tr>" + head + rows + "</tbody></table></div>\n";
}

std::string verdict_cell(const std::string& verdict) {
  return fmt::format("<span class=\"tag {}\">{}</span>", verdict_class(verdict),
                     verdict.empty() ? "no verdict" : html_short(verdict));
}

std::string overview(const std::vector<PageData>& pages) {
  std::string rows;
  rows += row("Verdict", pages, [](const PageData& page) {
    if (!is_in_doubt(page)) return verdict_cell(page.verdict);
    return "<span class=\"tag open\">" + std::string(headline_word(harness::Standing::kInDoubt)) +
           "</span>";
  });
  rows += row("What parted", pages, [](const PageData& page) {
    const auto* told = told_discrepancy(page);
    return told == nullptr ? std::string("nothing")
                           : html_words(told->words + " (" + told->standing.words + ")");
  });
  rows += row("Scenario", pages, [](const PageData& page) { return html_short(page.scenario); });
  rows += row("Traces", pages, [](const PageData& page) {
    if (page.closed_loop) return std::string("executions of the plan");
    return fmt::format("{} ({})", page.traces.size(), html_short(page.exploration));
  });
  rows += row("Not clean, with 95 % interval", pages, [](const PageData& page) {
    std::int64_t runs = 0, clean = 0;
    for (const auto& trace : page.traces) runs += trace.simulations, clean += trace.clean;
    return page.running ? std::string("not finished") : rate_of(runs - clean, runs);
  });
  rows += row("Claim", pages, [](const PageData& page) {
    constexpr std::size_t kMost = 3;
    const auto claims = claims_of(page);
    std::string out;
    for (std::size_t i = 0; i < claims.size() && i < kMost; ++i) {
      out += (i > 0 ? "<br>" : "") + claims[i];
    }
    if (claims.size() > kMost) out += fmt::format("<br>{} more", claims.size() - kMost);
    return out;
  });
  rows += row("Criterion", pages, [](const PageData& page) { return html_short(page.criterion); });
  rows += row("Seed", pages, [](const PageData& page) { return std::to_string(page.seed); });
  for (const auto& group : {"performs", "branches", "handlers", "axioms"}) {
    const bool is_known = std::any_of(pages.begin(), pages.end(), [&](const PageData& page) {
      return std::any_of(page.coverage.begin(), page.coverage.end(),
                         [&](const auto& share) { return share[0] == group; });
    });
    if (!is_known) continue;
    rows += row(fmt::format("Covered: {}", group), pages, [&](const PageData& page) {
      for (const auto& share : page.coverage) {
        if (share[0] == group) return share[1] + " of " + share[2];
      }
      return std::string("not known");
    });
  }
  return section_of(
      "overview", "Verdicts and rates",
      table_of("Verdicts and rates", "<th scope=\"col\"></th>" + column_heads(pages), rows));
}

/// Every trace that some run has, with its result in each run.
std::string traces(const std::vector<PageData>& pages) {
  const auto ambiguous = ambiguous_events(pages);
  const auto is_ambiguous = [&](const PageTrace& trace) {
    return ambiguous.contains(key_of(trace, false));
  };
  std::vector<std::string> order;
  std::map<std::string, std::vector<const PageTrace*>> by_key;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    for (const auto& trace : pages[i].traces) {
      const auto key = key_of(trace, is_ambiguous(trace));
      auto& found = by_key[key];
      if (found.empty()) {
        found.resize(pages.size());
        order.push_back(key);
      }
      if (found[i] == nullptr) found[i] = &trace;
    }
  }
  std::size_t gained = 0, lost = 0, both = 0;
  std::string rows;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto& found = by_key[order[i]];
    const bool in_first = found.front() != nullptr;
    const bool in_all =
        std::all_of(found.begin(), found.end(), [](auto* one) { return one != nullptr; });
    ++(in_all ? both : in_first ? lost : gained);
    if (i >= kMostTraces) continue;
    const auto* any =
        *std::find_if(found.begin(), found.end(), [](auto* one) { return one != nullptr; });
    auto name = any->steps.empty() ? "executions of the plan" : events_of(*any);
    if (is_ambiguous(*any)) name += "<br>from " + start_of(*any, pages);
    rows += fmt::format("<tr class=\"{0}\"><td>{0}</td><th scope=\"row\">{1}</th>",
                        in_all     ? "kept"
                        : in_first ? "lost"
                                   : "gained",
                        name);
    for (const auto* trace : found) {
      rows += "<td>";
      if (trace == nullptr) {
        rows += "none";
      } else {
        rows += verdict_cell(trace->verdict) + " " +
                rate_of(trace->simulations - trace->clean, trace->simulations);
      }
      rows += "</td>";
    }
    rows += "</tr>\n";
  }
  if (rows.empty()) return {};
  auto text = fmt::format(
      "<p>Traces that were simulated: {} in all runs, {} lost (the first has them), {} gained. A "
      "run "
      "that ends at a discrepancy simulates none behind it.</p>\n",
      both, lost, gained);
  if (order.size() > kMostTraces) {
    text += fmt::format("<p>{} further ones are left out.</p>\n", order.size() - kMostTraces);
  }
  return section_of(
      "traces", "Traces lost and gained",
      text + table_of("Traces",
                      "<th scope=\"col\"></th><th scope=\"col\">Events</th>" + column_heads(pages),
                      rows));
}

std::string causes(const std::vector<PageData>& pages) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<std::string>> cells;
  const auto cell = [&](const std::string& cause, std::size_t i) -> std::string& {
    auto& row = cells[cause];
    if (row.empty()) {
      row.resize(pages.size());
      order.push_back(cause);
    }
    return row[i];
  };
  for (std::size_t i = 0; i < pages.size(); ++i) {
    for (const auto& found : pages[i].discrepancies) {
      auto& text = cell(found.found.cause.text, i);
      text += (text.empty() ? "simulation " : ", ") + found.id();
    }
    for (const auto& trace : pages[i].traces) {
      for (const auto& cause : trace.causes) {
        cell(cause.cause, i) =
            fmt::format("{} ({}; {})", cause.count, harness::percent_about(cause.rate),
                        harness::percent_interval(cause.lower, cause.upper));
      }
    }
  }
  if (order.empty()) return {};
  std::string rows;
  for (const auto& cause : order) {
    rows += "<tr><th scope=\"row\">" + html_short(cause) + "</th>";
    for (const auto& text : cells[cause]) rows += "<td>" + (text.empty() ? "none" : text) + "</td>";
    rows += "</tr>\n";
  }
  return section_of("causes", "Causes of discrepancies",
                    table_of("Causes", "<th scope=\"col\">Cause</th>" + column_heads(pages), rows));
}

/// The changes of the scenarios, as `parallax diff` words them.
std::string changed(const std::vector<PageData>& pages, const std::vector<std::string>& changes) {
  constexpr std::size_t kMostBytes = 20'000;
  std::string out;
  for (std::size_t i = 0; i < changes.size() && i + 1 < pages.size(); ++i) {
    if (changes[i].empty()) continue;
    auto text = changes[i];
    if (text.size() > kMostBytes) text = text.substr(0, text.rfind('\n', kMostBytes)) + "\n...\n";
    out += fmt::format("<h3>{}</h3>\n<pre>{}</pre>\n", html_short(pages[i + 1].folder),
                       html_lines(text));
  }
  if (out.empty()) return {};
  return section_of("changed", "What changed in the scenario",
                    fmt::format("<p>Against {}.</p>\n", html_short(pages.front().folder)) + out);
}

}  // namespace

std::string comparison_page(const std::vector<PageData>& pages,
                            const std::vector<std::string>& changes) {
  const bool agree = std::all_of(pages.begin(), pages.end(), [&](const PageData& page) {
    return page.verdict == pages.front().verdict;
  });
  auto body = fmt::format(
      "<header class=\"top {}\"><p class=\"kicker\">parallax report &middot; comparison</p>\n"
      "<h1>{} runs, {}</h1></header>\n",
      agree ? verdict_class(pages.front().verdict) : "open", pages.size(),
      agree ? "the same verdict" : "different verdicts");
  for (const auto& page : pages) {
    for (const auto& banner : page.banners) {
      body += "<p class=\"banner\" role=\"note\"><b>" + html_short(page.folder) + ":</b> " +
              html(banner.substr(0, 3000)) + "</p>\n";
    }
  }
  body += "<main id=\"main\">\n" + overview(pages) + changed(pages, changes) + traces(pages) +
          causes(pages) + "</main>\n" +
          "<footer><p>Made by parallax from what the runs recorded.</p></footer>\n";
  return html_document("parallax: comparison of runs", body, {});
}

}  // namespace parallax::tools
