#include "tools/page/history_page.h"

#include <fmt/format.h>

#include <set>

#include "compiler/base/words.h"
#include "harness/confidence/rounding.h"
#include "tools/history/change_points.h"
#include "tools/page/markup.h"
#include "tools/page/plot.h"
#include "tools/page/sections.h"
#include "tools/page/write_page.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kMostLines = 80, kMostHistoryCases = 1000, kMostRatePlots = 60;
constexpr std::size_t kMostChanges = 500;

std::string line_name(const History& history, std::size_t index) {
  const auto& revision = history.lines[index].revision;
  return revision.empty() ? fmt::format("line {}", history.numbers[index]) : revision;
}

const char* outcome_class(const HistoryCase& one) {
  if (one.outcome == "passed") return one.flaky ? "lost" : "clean";
  if (one.outcome == "failed") return "bad";
  return one.outcome == "error" ? "lost" : "open";
}

/// A letter, so that the page does not rely on colour alone.
const char* outcome_letter(const HistoryCase& one) {
  if (one.outcome == "passed") return one.flaky ? "f" : "&#10003;";
  if (one.outcome == "failed") return "&#10007;";
  return one.outcome == "error" ? "!" : "&#183;";
}

/// Cases by what came of them.
struct OutcomeCount {
  std::size_t passed = 0, failed = 0, other = 0;

  std::size_t all() const { return passed + failed + other; }
  /// "1 of 3 cases failed, 1 gave no answer", "all 3 cases passed"
  std::string text() const {
    if (all() == 0) return "no cases";
    if (passed == all()) {
      return all() == 1 ? "the case passed" : fmt::format("all {} cases passed", all());
    }
    const auto open = other == 0 ? "" : fmt::format("{} gave no answer", other);
    if (failed == 0) return fmt::format("{} passed, {}", base::counted(passed, "case"), open);
    return fmt::format("{} of {} failed{}{}", failed, base::counted(all(), "case"),
                       other == 0 ? "" : ", ", open);
  }
};

std::string capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 32);
  return text;
}

OutcomeCount count_of(const HistoryLine& line) {
  OutcomeCount out;
  for (const auto& [name, one] : line.cases) {
    ++(one.outcome == "passed" ? out.passed : one.outcome == "failed" ? out.failed : out.other);
  }
  return out;
}

/// One suite of the history: the last lines are shown.
class SuitePart {
 public:
  SuitePart(const History& history, const std::vector<std::size_t>& suite, double confidence)
      : history_(history), suite_(suite), changes_(find_changes(history, suite, confidence)) {
    first_ = suite.size() > kMostLines ? suite.size() - kMostLines : 0;
    for (const auto& point : changes_.points) changed_.emplace(point.name, point.line);
  }

  std::size_t changes() const { return changes_.points.size(); }
  const HistoryLine& last() const { return history_.lines[suite_.back()]; }

  std::string html(std::size_t number) const {
    const auto body = changes_html() + revisions_table() + outcomes_table() + rate_plots();
    return section_of(fmt::format("suite-{}", number), "Suite " + html_short(last().suite_text()),
                      body);
  }

 private:
  const HistoryLine& line(std::size_t i) const { return history_.lines[suite_[i]]; }

  std::string changes_html() const {
    std::string rows;
    // The newest first, as it is the most interesting.
    const auto& points = changes_.points;
    for (std::size_t k = 0; k < points.size() && k < kMostChanges; ++k) {
      const auto& point = points[points.size() - 1 - k];
      const bool rate = point.kind == ChangePoint::Kind::kRate;
      rows += fmt::format(
          "<tr><th scope=\"row\">{}</th><td data-label=\"Case\">{}</td>"
          "<td data-label=\"What\">{}{}</td></tr>\n",
          html_short(line_name(history_, suite_[point.line])), html_short(point.name),
          html_short(point.words),
          rate ? ", adjusted " + harness::p_text(point.p_value) : std::string());
    }
    if (rows.empty()) rows = "<tr><td colspan=\"3\">nothing</td></tr>\n";
    auto out =
        "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"What changed\"><table "
        "class=\"flow\">"
        "<caption>What changed, the newest first</caption><thead><tr><th scope=\"col\">At</th>"
        "<th scope=\"col\">Case</th><th scope=\"col\">What</th></tr></thead><tbody>\n" +
        rows + "</tbody></table></div>\n";
    if (points.size() > kMostChanges) {
      out += fmt::format("<p>{} older changes are left out.</p>\n", points.size() - kMostChanges);
    }
    if (changes_.comparisons == 0) return out;
    return out + fmt::format(
                     "<p class=\"hint\">Rates are held against the first measurement since their "
                     "last change by Fisher&#39;s exact test; that any change is ever named by "
                     "chance has a probability of at most {}, shared by all looks and all rates "
                     "({} comparisons so far).</p>\n",
                     harness::percent_up(1.0 - changes_.confidence), changes_.comparisons);
  }

  /// A row for each line, the newest first.
  std::string revisions_table() const {
    std::string rows;
    for (std::size_t i = suite_.size(); i-- > first_;) {
      rows += fmt::format(
          "<tr><th scope=\"row\">{}</th><td data-label=\"Date\">{}</td><td data-label=\"Subject\">"
          "{}</td><td data-label=\"Cases\">{}</td></tr>\n",
          html_short(line_name(history_, suite_[i])), html_short(line(i).date),
          html_short(line(i).subject), html_short(count_of(line(i)).text()));
    }
    return "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"Revisions\">"
           "<table class=\"flow\"><caption>Revisions, the newest first</caption><thead><tr><th "
           "scope=\"col\">"
           "Revision</th><th scope=\"col\">Date</th><th scope=\"col\">Subject</th>"
           "<th scope=\"col\">Cases</th></tr></thead><tbody>\n" +
           rows + "</tbody></table></div>\n";
  }

  std::vector<std::string> names() const {
    std::set<std::string> out;
    for (std::size_t i = first_; i < suite_.size(); ++i) {
      for (const auto& [name, one] : line(i).cases) out.insert(name);
    }
    return {out.begin(), out.end()};
  }

  std::string outcomes_table() const {
    std::string head, rows;
    for (std::size_t i = first_; i < suite_.size(); ++i) {
      head += fmt::format("<th scope=\"col\" class=\"ev\"><span>{}</span></th>",
                          html_short(line_name(history_, suite_[i])));
    }
    const auto all = names();
    for (std::size_t k = 0; k < all.size() && k < kMostHistoryCases; ++k) {
      rows += "<tr><th scope=\"row\">" + html_short(all[k]) + "</th>";
      for (std::size_t i = first_; i < suite_.size(); ++i) rows += cell(all[k], i);
      rows += "</tr>\n";
    }
    auto out =
        "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"Outcomes\">"
        "<table class=\"tl\"><caption>Outcomes: &#10003; passed, f flaky, &#10007; failed, ! no "
        "answer, &#183; not finished; a bar where something changed</caption><thead><tr><td></td>" +
        head + "</tr></thead><tbody>\n" + rows + "</tbody></table></div>\n";
    if (first_ > 0) out += fmt::format("<p>{} older lines are left out.</p>\n", first_);
    if (all.size() > kMostHistoryCases) {
      out += fmt::format("<p>{} further cases are left out.</p>\n", all.size() - kMostHistoryCases);
    }
    return out;
  }

  std::string cell(const std::string& name, std::size_t i) const {
    const bool is_change = changed_.contains({name, i});
    const auto at = line(i).cases.find(name);
    if (at == line(i).cases.end()) return is_change ? "<td class=\"p\"></td>" : "<td></td>";
    const auto& one = at->second;
    return fmt::format("<td class=\"v {}{}\" title=\"{}: {}{}{}\">{}</td>", outcome_class(one),
                       is_change ? " p" : "", html_short(line_name(history_, suite_[i])),
                       html_short(one.outcome), one.verdict.empty() ? "" : ", ",
                       html_short(one.verdict), outcome_letter(one));
  }

  std::string rate_plots() const {
    std::string out;
    std::size_t plots = 0, left_out = 0;
    for (const auto& name : names()) {
      std::set<std::string> rates;
      for (std::size_t i = first_; i < suite_.size(); ++i) {
        const auto at = line(i).cases.find(name);
        if (at == line(i).cases.end()) continue;
        for (const auto& rate : at->second.rates) rates.insert(rate.of);
      }
      for (const auto& of : rates) {
        if (++plots > kMostRatePlots) {
          ++left_out;
          continue;
        }
        out += fmt::format("<figure><figcaption><b>{}</b>, {}</figcaption>{}</figure>\n",
                           html_short(name), html_short(of), rate_plot(name, of));
      }
    }
    if (out.empty()) return out;
    out = "<h3>Rates with their intervals, line by line</h3>\n<div class=\"panels\">\n" + out +
          "</div>\n";
    if (left_out > 0) out += fmt::format("<p>{} further rates are left out.</p>\n", left_out);
    return out;
  }

  std::string rate_plot(const std::string& name, const std::string& of) const {
    const double wide = 460.0, high = 200.0;
    const auto lines = suite_.size() - first_;
    const PlotAxis x{-0.5, static_cast<double>(lines) - 0.5, 56.0, wide - 14.0};
    const PlotAxis y{0.0, 1.0, high - 14.0, 14.0};
    auto out =
        fmt::format("<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n",
                    px(wide), px(high), html_short(of));
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      out += tools::line(x.from, y.at(share), x.to, y.at(share), "grid") +
             label(x.from - 6.0, y.at(share) + 4.0, "end", percent(share));
    }
    for (std::size_t i = first_; i < suite_.size(); ++i) {
      const auto at = line(i).cases.find(name);
      if (at == line(i).cases.end()) continue;
      // A cause that was not seen is a rate, too.
      const auto rate = measured_rate(at->second, of);
      if (!rate) continue;
      const double px_x = x.at(static_cast<double>(i - first_));
      const double share = static_cast<double>(rate->count) / static_cast<double>(rate->runs);
      out += tools::line(px_x, y.at(rate->lower), px_x, y.at(rate->upper), "border") +
             fmt::format(
                 "<circle class=\"stop\" cx=\"{}\" cy=\"{}\" r=\"3\"><title>{}: {} of "
                 "{}</title></circle>\n",
                 px(px_x), px(y.at(share)), html_short(line_name(history_, suite_[i])), rate->count,
                 rate->runs);
    }
    for (const auto& point : changes_.points) {
      const bool is_its = point.kind == ChangePoint::Kind::kRate && point.name == name &&
                          point.words.starts_with(of + ": ") && point.line >= first_;
      if (!is_its) continue;
      const double at = x.at(static_cast<double>(point.line - first_) - 0.5);
      out += tools::line(at, y.from, at, y.to, "goal");
    }
    return out + "</svg>\n";
  }

  const History& history_;
  const std::vector<std::size_t>& suite_;
  Changes changes_;
  std::set<std::pair<std::string, std::size_t>> changed_;
  std::size_t first_ = 0;
};

}  // namespace

std::string history_page(const History& history, const std::string& file, double confidence) {
  const auto suites = suites_of(history);
  std::string parts;
  std::size_t changes = 0;
  OutcomeCount state;
  for (std::size_t i = 0; i < suites.size(); ++i) {
    const SuitePart part(history, suites[i], confidence);
    changes += part.changes();
    const auto now = count_of(part.last());
    state.passed += now.passed;
    state.failed += now.failed;
    state.other += now.other;
    parts += part.html(i + 1);
  }
  std::string banners;
  for (const auto& remark : remarks_on(history, file)) {
    banners += "<p class=\"banner\">" + html_short(remark) + "</p>\n";
  }
  std::string at;
  if (!history.lines.empty()) {
    const auto& last = history.lines.back();
    at = " at " + html_short(line_name(history, history.lines.size() - 1));
    for (const auto* word : {&last.date, &last.subject}) {
      if (!word->empty()) at += ", " + html_short(*word);
    }
  }
  const auto body = fmt::format(
      "<header class=\"top {}\"><p class=\"kicker\">parallax suite --history: {}</p><h1>{}</h1>"
      "<p>{} in {}{}</p></header>\n{}<main id=\"main\">\n{}</main>\n",
      state.failed > 0  ? "bad"
      : state.other > 0 ? "open"
                        : "clean",
      html_short(file), html_short(capital(state.text())), base::counted(changes, "change"),
      base::counted(std::ssize(history.lines), "line"), at, banners, parts);
  DocumentOptions options;
  options.style =
      ".tl td.v.clean{background:var(--clean-bg)}.tl td.v.bad{background:var(--bad-bg)}"
      ".tl td.v.lost{background:var(--lost-bg)}.tl td.v{text-align:center}";
  return html_document(fmt::format("{}: history {}", capital(state.text()), file), body, options);
}

}  // namespace parallax::tools
