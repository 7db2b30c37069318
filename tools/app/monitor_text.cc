#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/json.h"
#include "compiler/base/words.h"
#include "tools/app/monitor.h"

namespace parallax::tools {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// Number of fluents and plan steps that are spelled out in the text.
constexpr std::size_t kMostShown = 8;
constexpr std::size_t kMostShownOfOutlier = 2;

std::string value_text(const harness::Value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return fmt::format("\"{}\"", *text);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* real = std::get_if<double>(&value)) return fmt::format("{:.6g}", *real);
  return fmt::format("{}", std::get<std::int64_t>(value));
}

std::string fluent_text(const RefusedFluent& fluent) {
  std::string out = fmt::format(
      "  {}{}", fluent.neither ? "neither so nor so: " : (fluent.observed ? "" : "not "),
      base::printable(fluent.fluent));
  std::vector<std::string> values;
  for (const auto& [name, value] : fluent.variables) {
    values.push_back(base::printable(fmt::format("{} = {}", name, value_text(value))));
  }
  if (!values.empty()) out += fmt::format("   ({})", fmt::join(values, ", "));
  return out + "\n";
}

std::string place_text(const MonitorResult& result) {
  const auto& place = *result.first;
  if (place.line == 0) {
    return fmt::format("{}: timepoint {}, t = {:.6g} s", base::printable(result.log),
                       place.timepoint, place.t);
  }
  return fmt::format("{}:{}: t = {:.6g} s", base::printable(result.log), place.line, place.t);
}

std::string refusal_text(const MonitorResult& result) {
  const auto& refusal = result.refusal;
  std::string out = place_text(result);
  if (refusal.event.empty() && refusal.fluents.empty()) {
    return out + ": no state that is still possible lets a step without events happen\n";
  }
  if (refusal.event.empty()) {
    out += fmt::format(": no state that is still possible agrees with what was seen{}\n",
                       result.first->at_the_end ? " at the end" : "");
    for (std::size_t i = 0; i < refusal.fluents.size() && i < kMostShown; ++i) {
      out += fluent_text(refusal.fluents[i]);
    }
    if (refusal.fluents.size() > kMostShown) {
      out += fmt::format("  and {} more\n", refusal.fluents.size() - kMostShown);
    }
    return out;
  }
  out += refusal.only_outcome
             ? fmt::format(": `{}` can happen, but not with this outcome\n", refusal.event)
             : fmt::format(": `{}` cannot happen in any state that is still possible\n",
                           refusal.event);
  if (refusal.only_outcome) return out;
  for (std::size_t i = 0; i < refusal.expected.size() && i < kMostShown; ++i) {
    out += fmt::format("  the plan would perform {}\n", refusal.expected[i]);
  }
  if (refusal.plan_is_over) out += "  the plan may be over\n";
  return out;
}

/// Says how a log was read more leniently than it is written, and how often that counted.
std::string tolerance_text(const MonitorResult& result) {
  if (!result.tolerance) return {};
  const auto& [reading, rate] = *result.tolerance;
  std::string out;
  if (!reading.is_exact()) {
    const auto count = result.tolerated.near_border;
    out += fmt::format("tolerated: {} within {:g} m or {:g} rad of a border",
                       base::counted(count, "observation"), reading.m, reading.rad);
    if (count > 0) {
      out +=
          fmt::format(", where both sides are possible; {} agree{} with the model only so",
                      result.tolerated.only_within, result.tolerated.only_within == 1 ? "s" : "");
    }
    out += '\n';
  }
  if (rate.is_none()) return out;
  out += fmt::format("not counted: {} of {} compared, as {} of {} in a row may be wrong\n",
                     base::counted(result.outlier_count, "outlier"), result.compared, rate.at_most,
                     rate.of);
  for (const auto& outlier : result.outliers) {
    out += fmt::format("  line {}, t = {:.6g} s\n", outlier.place.line, outlier.place.t);
    for (std::size_t i = 0; i < outlier.refusal.fluents.size() && i < kMostShownOfOutlier; ++i) {
      out += "  " + fluent_text(outlier.refusal.fluents[i]);
    }
  }
  const auto unnamed = result.outlier_count - std::ssize(result.outliers);
  if (unnamed > 0) out += fmt::format("  and {} more\n", unnamed);
  return out;
}

OrderedJson tolerance_json(const MonitorResult& result) {
  const auto& [reading, rate] = *result.tolerance;
  OrderedJson lines = OrderedJson::array();
  for (const auto& outlier : result.outliers) lines.push_back(outlier.place.line);
  OrderedJson out{{"tolerance_m", reading.m},
                  {"tolerance_rad", reading.rad},
                  {"near_border", result.tolerated.near_border},
                  {"only_within_tolerance", result.tolerated.only_within}};
  out["outliers"] = OrderedJson{{"at_most", rate.at_most},
                                {"of", rate.of},
                                {"count", result.outlier_count},
                                {"first_lines", std::move(lines)}};
  return out;
}

std::string first_text(const MonitorResult& result) {
  if (!result.first) return {};
  if (result.verdict == MonitorVerdict::kInconsistent) return refusal_text(result);
  return fmt::format("{}: {}\n", place_text(result), result.undecided_because);
}

OrderedJson value_json(const harness::Value& value) {
  return std::visit([](const auto& plain) { return OrderedJson(plain); }, value);
}

OrderedJson first_json(const MonitorResult& result) {
  OrderedJson out = OrderedJson::object();
  const auto& place = *result.first;
  if (place.line > 0) out["line"] = place.line;
  out["t"] = place.t;
  out["timepoint"] = place.timepoint;
  const auto& refusal = result.refusal;
  if (result.verdict == MonitorVerdict::kUndecided) {
    out["because"] = result.undecided_because;
    return out;
  }
  if (!refusal.event.empty()) {
    out["event"] = refusal.event;
    out["only_outcome"] = refusal.only_outcome;
    out["expected"] = refusal.expected;
    out["plan_may_be_over"] = refusal.plan_is_over;
  }
  out["fluents"] = OrderedJson::array();
  for (const auto& fluent : refusal.fluents) {
    OrderedJson variables = OrderedJson::object();
    for (const auto& [name, value] : fluent.variables) variables[name] = value_json(value);
    OrderedJson entry{{"fluent", fluent.fluent}};
    entry["observed"] = fluent.neither ? OrderedJson("neither") : OrderedJson(fluent.observed);
    entry["variables"] = std::move(variables);
    out["fluents"].push_back(std::move(entry));
  }
  return out;
}

OrderedJson fields(const MonitorResult& result) {
  OrderedJson out{{"verdict", to_string(result.verdict)},
                  {"observations", result.observations},
                  {"compared", result.compared},
                  {"under_way", result.under_way},
                  {"events", result.events}};
  out["states"] = OrderedJson{{"most", result.most_states}};
  if (result.states) out["states"]["last"] = *result.states;
  if (result.tolerance) out["tolerated"] = tolerance_json(result);
  if (result.verdict == MonitorVerdict::kUndecided) out["because"] = result.undecided_because;
  if (result.first) out["first"] = first_json(result);
  return out;
}

}  // namespace

MonitorVerdict verdict_of(const std::vector<MonitorResult>& runs) {
  bool decided = !runs.empty();
  for (const auto& run : runs) {
    if (run.verdict == MonitorVerdict::kInconsistent) return run.verdict;
    decided = decided && run.verdict == MonitorVerdict::kConsistent;
  }
  return decided ? MonitorVerdict::kConsistent : MonitorVerdict::kUndecided;
}

std::string monitor_text(const MonitorResult& result) {
  std::string out = first_text(result);
  out += fmt::format(
      "{}: {} ({} compared",
      result.failed ? "consistent as far as the log can be read" : to_string(result.verdict),
      base::counted(result.observations, "observation"), result.compared);
  if (result.under_way > 0)
    out += fmt::format(", {} while an action was under way", result.under_way);
  out += fmt::format("), {}; at most {} possible at once", base::counted(result.events, "step"),
                     base::counted(result.most_states, "state"));
  if (result.states) out += fmt::format(", {} at last", *result.states);
  out += "\n";
  out += tolerance_text(result);
  for (const auto& action : result.unended) {
    out += fmt::format("not ended: {} (line {}, t = {:.6g} s)\n", action.event, action.place.line,
                       action.place.t);
  }
  if (result.verdict == MonitorVerdict::kUndecided && !result.first && !result.failed) {
    out += fmt::format("undecided: {}\n", base::printable(result.undecided_because));
  }
  if (!result.unreported.empty()) {
    out += fmt::format("never reported: {}\n",
                       base::printable(fmt::format("{}", fmt::join(result.unreported, ", "))));
  }
  for (const auto& hint : result.hints) out += base::printable(hint) + "\n";
  return out;
}

std::string monitor_text(const std::vector<MonitorResult>& runs) {
  std::string out;
  std::size_t consistent = 0, unchecked = 0;
  for (const auto& run : runs) {
    if (run.verdict == MonitorVerdict::kConsistent) ++consistent;
    if (run.interrupted) ++unchecked;
    out += first_text(run);
  }
  if (unchecked > 0)
    out +=
        fmt::format("not checked: {}, as it was stopped\n", base::counted(unchecked, "simulation"));
  return out + fmt::format("{}: {} of {} {} consistent with the model\n",
                           to_string(verdict_of(runs)), consistent,
                           base::counted(runs.size(), "simulation"),
                           base::agreed(std::ssize(runs), "is", "are"));
}

std::string monitor_json(const MonitorResult& result, const std::string& scenario) {
  OrderedJson out{{"status", result.failed ? "error" : "ok"},
                  {"scenario", base::printable(scenario)},
                  {"log", base::printable(result.log)}};
  out.update(fields(result));
  out["unreported"] = result.unreported;
  out["unended"] = OrderedJson::array();
  for (const auto& action : result.unended) {
    out["unended"].push_back(
        OrderedJson{{"event", action.event}, {"line", action.place.line}, {"t", action.place.t}});
  }
  out["timing"] = OrderedJson{{"wall_s", result.wall_s}};
  return base::json_text(out) + "\n";
}

std::string monitor_json(const std::vector<MonitorResult>& runs, const std::string& scenario) {
  OrderedJson out{{"status", "ok"},
                  {"scenario", base::printable(scenario)},
                  {"verdict", to_string(verdict_of(runs))},
                  {"runs", OrderedJson::array()}};
  for (const auto& run : runs) {
    OrderedJson entry{{"sample", run.log}};
    entry.update(fields(run));
    out["runs"].push_back(std::move(entry));
  }
  return base::json_text(out) + "\n";
}

}  // namespace parallax::tools
