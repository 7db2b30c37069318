#include "harness/report/discrepancy_summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "compiler/base/utf8.h"
#include "compiler/base/words.h"
#include "harness/report/report_words.h"
#include "harness/report/text_layout.h"

namespace parallax::harness {
namespace {

constexpr std::size_t kMaxSteps = 8, kMaxFluents = 4, kMaxVariables = 9;

using Names = std::set<std::string, std::less<>>;

/// Three significant digits, none of them dropped in front of the point; a "1" is no unit.
std::string rounded(double value, const std::string& unit) {
  const auto digits = std::abs(value) >= 1000.0 ? fmt::format("{:.0f}", value)
                      : std::abs(value) < 1e-6  ? std::string("0")
                                                : fmt::format("{:.3g}", value);
  return unit.empty() || unit == "1" ? digits : digits + ' ' + unit;
}

/// Adds the names in "ItemAt(milk1,pFloor)": `milk1` and `pFloor`.
void add_names(std::string_view term, Names& names) {
  auto begin = term.find('(');
  while (begin != std::string_view::npos && begin + 1 < term.size()) {
    const auto end = std::min(term.find_first_of("(,)", begin + 1), term.size());
    if (end > begin + 1) names.emplace(term.substr(begin + 1, end - begin - 1));
    begin = end;
  }
}

std::string reason_of(const ActionOutcome& outcome) {
  return outcome.reason.empty() ? std::string(to_string(outcome.status)) : outcome.reason;
}

enum class ToldReason : std::uint8_t { kWhole, kWord, kNot };

/// One discrepancy, told in words.
class Account {
 public:
  Account(const CampaignResult& result, const Discrepancy& found)
      : result_(result), found_(found), trace_(trace_of()), event_(parting_event()) {}

  std::string sentence(ToldReason how = ToldReason::kWhole) const {
    const auto name = event_name();
    const auto acted = event_ && *event_ < outcomes().size();
    if (found_.path && acted && (found_.path->impossible || found_.path->outcome)) {
      return excluded_step(name, how);
    }
    const auto& differing = differences();
    std::string text;
    if (acted && !found_.path && outcomes()[*event_].status != SimStatus::kOk &&
        !is_predicted_to_fail(*event_)) {
      text = fmt::format("{} fails{}, and the model says that it succeeds", name, told_reason(how));
    } else if (differing.empty()) {
      text = found_.cause.text;
    } else {
      const auto& first = differing.front();
      text = fmt::format("{} {} is {}, and the model says {}", when(), first.fluent, first.observed,
                         first.predicted);
      if (const auto more = static_cast<std::int64_t>(differing.size()) - 1; more > 0) {
        text += fmt::format(" ({})", base::counted(more, "other fluent differs", "others differ"));
      }
    }
    if (found_.kind == DiscrepancyKind::kTransient) text += "; it ends as predicted";
    return text;
  }

  /// The reason of the action that parts, in full; empty: no action failed there.
  std::string reason() const {
    if (!event_ || *event_ >= outcomes().size()) return {};
    const auto& outcome = outcomes()[*event_];
    if (outcome.status != SimStatus::kOk) return reason_of(outcome);
    return found_.path ? found_.record.path->steps[*event_].condition : std::string();
  }

  std::string write(bool color) const {
    std::string out;
    steps(color, out);
    fluents(out);
    start(out);
    return out;
  }

 private:
  const TraceResult& trace_of() const {
    const auto same = [&](const TraceResult& one) { return one.trace->number == found_.trace; };
    return *std::find_if(result_.traces.begin(), result_.traces.end(), same);
  }
  const CampaignTrace& trace() const { return *trace_.trace; }
  const std::vector<ActionOutcome>& outcomes() const { return found_.record.outcomes; }

  /// As the cause has it: "Go(r2)" of "Go(r2): path-blocked".
  std::string event_name() const {
    return found_.cause.text.substr(0, found_.cause.text.find(": "));
  }

  /// Number of the event after which, or in which, they part; none if the start differs.
  std::optional<std::size_t> parting_event() const {
    if (found_.path) {
      if (found_.path->event < 0) return std::nullopt;
      return static_cast<std::size_t>(found_.path->event);
    }
    // Where the end alone is compared, what differs there may have begun later than the rest.
    const auto from = std::max<std::int64_t>(1, found_.first_divergence) - 1;
    for (auto i = static_cast<std::size_t>(from); i < trace().event_count(); ++i) {
      if (trace().event(i) == event_name()) return i;
    }
    return std::nullopt;
  }

  /// " (path-blocked)" behind the event that failed.
  std::string told_reason(ToldReason how) const {
    if (how == ToldReason::kNot) return {};
    const auto whole = reason();
    return fmt::format(" ({})",
                       how == ToldReason::kWord ? whole.substr(0, whole.find(": ")) : whole);
  }

  std::string when() const { return event_ ? "after " + event_name() : "at the start"; }

  /// The fluents that differ where model and world part; where the end alone is compared, those
  /// that differ there.
  const std::vector<DivergingFluent>& differences() const {
    const bool at_end = result_.comparison == Comparison::kFinal && !found_.fluents.empty();
    return at_end || found_.first.empty() ? found_.fluents : found_.first;
  }

  bool is_predicted_to_fail(std::size_t event) const {
    const auto& point = trace().points[event];
    return point.plan_step && !point.succeeded;
  }

  /// Describes a step of an executed plan that the model does not have, or not with this outcome.
  std::string excluded_step(const std::string& name, ToldReason how) const {
    const auto& step = found_.record.path->steps[*event_];
    if (found_.path->impossible) return name + " happens, and the model has no such event there";
    if (!step.succeeded) {
      return fmt::format("{} fails{}, and the model says that it cannot", name, told_reason(how));
    }
    return fmt::format("{} {}, and the model says that it cannot", name,
                       step.object.empty() ? std::string("succeeds") : "finds " + step.object);
  }

  std::size_t step_count() const {
    return found_.path ? found_.record.path->steps.size() : trace().event_count();
  }

  /// Event, place in the plan, how it ended.
  std::vector<std::string> step(std::size_t i) const {
    if (found_.path) {
      const auto& step = found_.record.path->steps[i];
      return {step.object.empty() ? step.event : step.event + " = " + step.object, step.source,
              step.succeeded ? "ok" : "failed: " + step.condition};
    }
    return {trace().event(i), trace().plan[i].source, end_of_action(i)};
  }

  std::string end_of_action(std::size_t i) const {
    if (i >= outcomes().size()) return "not reached";
    const auto& outcome = outcomes()[i];
    const bool fails = is_predicted_to_fail(i);
    if (outcome.status == SimStatus::kOk) {
      return fails ? "ok, and the model says that it fails" : "ok";
    }
    const auto word = reason_word(outcome);
    return fails ? fmt::format("failed, as predicted ({})", word)
                 : fmt::format("{}: {}", to_string(outcome.status), word);
  }

  /// The events that led there, and the next few: what follows is a consequence.
  void steps(bool color, std::string& out) const {
    const auto last = std::min(step_count(), event_.value_or(0) + 3);
    // A line that says that one is left out would be no shorter.
    const auto first = last > kMaxSteps + 1 ? last - kMaxSteps : 0;
    const auto left_out = [&](std::size_t count, std::string_view where) {
      if (count == 0) return;
      out += fmt::format("     {} {}\n",
                         base::counted(static_cast<std::int64_t>(count), "event", "events"), where);
    };
    left_out(first, "before these");
    std::vector<std::vector<std::string>> rows;
    for (auto i = first; i < last; ++i) {
      auto row = step(i);
      if (event_ && i > *event_ && row.back() != "ok") row.back() = "then " + row.back();
      row.insert(row.begin(), {i == event_ ? "*" : " ", fmt::format("{}", i)});
      rows.push_back(std::move(row));
    }
    const auto lines = table(rows, 2);
    for (std::size_t begin = 0; begin < lines.size();) {
      const auto end = lines.find('\n', begin);
      const auto line = lines.substr(begin, end - begin);
      out += painted(line, "31", color && line.starts_with("  *")) + '\n';
      begin = end + 1;
    }
    left_out(step_count() - last, "after these");
  }

  void fluents(std::string& out) const {
    const auto& cause = differences();
    std::vector<const DivergingFluent*> later;
    for (const auto& fluent : found_.fluents) {
      const auto known = [&](const auto& one) { return one.fluent == fluent.fluent; };
      if (std::none_of(cause.begin(), cause.end(), known)) later.push_back(&fluent);
    }
    std::vector<std::vector<std::string>> rows = {{"", "predicted", "observed"}};
    const auto add = [&](const DivergingFluent& fluent, const std::string& indent) {
      rows.push_back({indent + fluent.fluent, fluent.predicted ? "true" : "false",
                      fluent.observed ? "true" : "false"});
    };
    const auto shown = std::min(cause.size(), kMaxFluents);
    const auto shown_later = std::min(later.size(), kMaxFluents);
    for (std::size_t i = 0; i < shown; ++i) add(cause[i], "");
    for (std::size_t i = 0; i < shown_later; ++i) add(*later[i], "  ");
    if (rows.size() == 1) return;
    rows[1].push_back(when());
    if (shown_later > 0) rows[1 + shown].push_back("and so at the end");
    out += table(rows, 4);
    measured(out, cause, shown);
    const auto all = cause.size() + later.size();
    if (all > shown + shown_later) {
      out += fmt::format("    and {} more\n", all - shown - shown_later);
    }
  }

  /// Writes what the first `shown` fluents were read from, a line each.
  static void measured(std::string& out, const std::vector<DivergingFluent>& fluents,
                       std::size_t shown) {
    std::string label = "  measured";
    for (std::size_t i = 0; i < shown; ++i) {
      if (fluents[i].measured.empty()) continue;
      label.resize(kSummaryColumn, ' ');
      out += wrapped(label, fmt::format("{}: {}", fluents[i].fluent, fluents[i].measured),
                     kSummaryColumn);
      label.clear();
    }
  }

  /// Writes the values drawn for the start: of the bodies that take part, and of the rest where
  /// there is room.
  void start(std::string& out) const {
    Names involved, drawn;
    for (const auto& fluent : differences()) add_names(fluent.fluent, involved);
    if (event_) add_names(step(*event_).front(), involved);
    for (const auto& [variable, interval] : trace_.start_region) {
      if (interval.lower < interval.upper) drawn.insert(variable);
    }
    std::vector<std::string> first, robot, rest;
    for (const auto& [name, value] : found_.record.initial) {
      const auto* number = std::get_if<double>(&value);
      if (number == nullptr || (!found_.path && drawn.count(name) == 0)) continue;
      // A world that is a model has the fluents themselves for variables.
      if (trace().symbols->fluent(name)) continue;
      const auto body = name.substr(0, name.find('.'));
      auto& list = involved.count(body) > 0 ? first : body == "robot" ? robot : rest;
      list.push_back(fmt::format("{} = {}", name, rounded(*number, unit_of(name))));
    }
    const auto all = first.size() + robot.size() + rest.size();
    if (all == 0) return;
    first.insert(first.end(), robot.begin(), robot.end());
    if (first.empty() || all <= kMaxVariables) first.insert(first.end(), rest.begin(), rest.end());
    first.resize(std::min(first.size(), kMaxVariables));
    auto text = fmt::format("{}", fmt::join(first, ", "));
    if (all > first.size()) text += fmt::format(" ({} more)", all - first.size());
    std::string label = "  start";
    label.resize(kSummaryColumn, ' ');
    out += wrapped(label, text, kSummaryColumn);
  }

  std::string unit_of(std::string_view variable) const {
    for (const auto& parameter : result_.simulator.parameters) {
      if (parameter.name == variable) return parameter.unit;
    }
    return {};
  }

  const CampaignResult& result_;
  const Discrepancy& found_;
  const TraceResult& trace_;
  std::optional<std::size_t> event_;
};

}  // namespace

std::string discrepancy_sentence(const CampaignResult& result, const Discrepancy& found) {
  return Account(result, found).sentence();
}

DiscrepancyHeadline discrepancy_headline(const CampaignResult& result, const Discrepancy& found,
                                         std::size_t columns) {
  const Account account(result, found);
  auto whole = account.sentence();
  if (base::count_code_points(whole) <= columns) return {std::move(whole), {}};
  for (const auto how : {ToldReason::kWord, ToldReason::kNot}) {
    auto brief = account.sentence(how);
    if (brief == whole) continue;  // no action failed, or its reason is one word
    if (how == ToldReason::kNot || base::count_code_points(brief) <= columns) {
      return {std::move(brief), account.reason()};
    }
  }
  return {std::move(whole), {}};
}

std::string discrepancy_summary(const CampaignResult& result, const Discrepancy& found,
                                const ReportStyle& style) {
  return Account(result, found).write(style.color);
}

}  // namespace parallax::harness
