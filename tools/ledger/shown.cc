#include "tools/ledger/shown.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "compiler/base/json.h"
#include "harness/report/run_report.h"

namespace parallax::tools {
namespace {

using Json = nlohmann::json;

std::string text(const Json& object, const char* name) {
  const auto* value = base::json_member(object, name);
  return value == nullptr ? "" : base::json_as<std::string>(*value).value_or("");
}

std::int64_t whole(const Json& object, const char* name) {
  const auto* value = base::json_member(object, name);
  return value == nullptr ? 0 : base::json_as<std::int64_t>(*value).value_or(0);
}

const Json& member(const Json& object, const char* name) {
  static const Json kNone;
  const auto* value = base::json_member(object, name);
  return value == nullptr ? kNone : *value;
}

using harness::ReportedDiscrepancy;
using harness::RunReport;

std::vector<std::string> differing(const std::vector<harness::DivergingFluent>& fluents) {
  std::vector<std::string> out;
  for (const auto& one : fluents) out.push_back((one.observed ? "" : "not ") + one.fluent);
  std::sort(out.begin(), out.end());
  return out;
}

/// A perform of an executed plan, with its outcome as the plan was told it.
std::string step_text(const harness::PathStep& step) {
  auto out = step.event;
  if (!step.object.empty()) out += " = " + step.object;
  if (step.succeeded) return out;
  return out + (step.condition.empty() ? " fails" : fmt::format(" fails ({})", step.condition));
}

/// Number of the event that the cause names, in a trace with these events; none if it has no such
/// event from the first divergence on.
std::optional<std::size_t> event_of_cause(const harness::Discrepancy& found,
                                          const std::vector<std::string>& events) {
  const auto divergence = std::max<std::int64_t>(1, found.first_divergence);
  const auto from = std::min(static_cast<std::size_t>(divergence - 1), events.size());
  const auto at = std::find(events.begin() + static_cast<std::ptrdiff_t>(from), events.end(),
                            found.cause.event);
  if (at == events.end()) return std::nullopt;
  return static_cast<std::size_t>(at - events.begin());
}

/// How the event of a trace went wrong; empty: it went well.
std::string outcome_in_trace(const harness::Discrepancy& found, std::optional<std::size_t> event) {
  const auto& reason = found.cause.reason;
  if (!reason.empty()) return reason.substr(0, reason.find(':'));
  const auto& outcomes = found.record.outcomes;
  if (!event || *event >= outcomes.size()) return {};
  const auto status = outcomes[*event].status;
  return status == harness::SimStatus::kOk ? "" : std::string(to_string(status));
}

/// How the step of an executed plan went that the model does not have so; empty: the model has it,
/// and not the state after it.
std::string outcome_in_path(const harness::Discrepancy& found) {
  const auto at = static_cast<std::size_t>(std::max<std::int64_t>(0, found.path->event));
  const auto& outcomes = found.record.outcomes;
  if (found.path->event >= 0 && at < outcomes.size() &&
      outcomes[at].status != harness::SimStatus::kOk) {
    return reason_word(outcomes[at]);
  }
  if (found.path->impossible) return "happens";
  if (!found.path->outcome || at >= found.record.path->steps.size()) return {};
  const auto& step = found.record.path->steps[at];
  if (!step.object.empty()) return "found " + step.object;
  return step.succeeded ? "succeeds" : "fails";
}

std::vector<std::string> steps_before(const harness::Discrepancy& found) {
  std::vector<std::string> out;
  for (const auto& step : found.record.path->steps) {
    if (std::ssize(out) >= found.path->event) break;
    out.push_back(step_text(step));
  }
  return out;
}

ShownDiscrepancy discrepancy_of(const ReportedDiscrepancy& reported, const RunReport& run) {
  const auto& found = reported.found;
  ShownDiscrepancy out;
  out.sample = reported.id();
  out.words = reported.words;
  const bool at_end = run.comparison == to_string(harness::Comparison::kFinal);
  const bool last = (at_end && !found.fluents.empty()) || found.first.empty();
  out.fluents = differing(last ? found.fluents : found.first);
  if (reported.has_cause) out.event = found.cause.event.empty() ? "start" : found.cause.event;
  if (found.path) {
    out.outcome = outcome_in_path(found);
    out.trace = steps_before(found);
  } else {
    const auto is_its = [&](const auto& trace) { return trace.number == found.trace; };
    const auto trace = std::find_if(run.traces->begin(), run.traces->end(), is_its);
    std::optional<std::size_t> event;
    if (trace != run.traces->end()) event = event_of_cause(found, trace->events);
    out.outcome = outcome_in_trace(found, event);
    if (event)
      out.trace.assign(trace->events.begin(),
                       std::next(trace->events.begin(), static_cast<std::ptrdiff_t>(*event)));
  }
  // The event failed: the differing fluents are consequences of that.
  if (!out.outcome.empty()) out.fluents.clear();
  return out;
}

std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < line.size();) {
    const auto end = std::min(line.find(' ', at), line.size());
    if (end > at) out.push_back(line.substr(at, end - at));
    at = end + 1;
  }
  return out;
}

}  // namespace

std::optional<ShownRun> shown_run(std::string_view document) {
  const auto run = harness::read_run_report(document);
  if (!run || !run->traces || !run->discrepancies) return std::nullopt;
  ShownRun out;
  out.scenario = run->scenario;
  out.is_executed = run->execution == to_string(harness::Execution::kClosedLoop);
  const auto clean = to_string(harness::CampaignVerdict::kNoDiscrepancy);
  out.is_complete = out.is_executed ? run->verdict == clean
                                    : run->exploration != "stopped" && run->status == "ok" &&
                                          run->interrupted == false;
  for (const auto& trace : *run->traces) {
    out.traces.push_back({trace.events, trace.verdict == clean});
  }
  for (const auto& found : *run->discrepancies) {
    out.discrepancies.push_back(discrepancy_of(found, *run));
  }
  return out;
}

std::optional<ShownRun> shown_rates(std::string_view document) {
  const auto rates = base::parse_json(document);
  const auto& traces = member(rates, "traces");
  if (!traces.is_array()) return std::nullopt;
  ShownRun out;
  out.scenario = text(rates, "scenario");
  for (const auto& trace : traces) {
    const auto events = words_of(text(trace, "events"));
    const auto& causes = member(trace, "causes");
    for (const auto& cause : causes.is_array() ? causes : Json::array()) {
      ShownDiscrepancy shown;
      shown.counted = true;
      shown.trace = events;
      const auto words = text(cause, "cause"), event = text(cause, "event");
      shown.event = event.empty() ? "start" : event;
      // A cause may be a fluent or an outcome, so both are kept: the ledger's entry says which it
      // is.
      if (const auto head = shown.event + ": "; words.starts_with(head)) {
        shown.outcome = words.substr(head.size());
        shown.fluents = {shown.outcome};
      }
      shown.words = fmt::format("{} in {} of {} runs of trace {}", words, whole(cause, "count"),
                                whole(trace, "runs"), whole(trace, "trace"));
      out.discrepancies.push_back(std::move(shown));
    }
  }
  return out;
}

std::string identity_text(const ShownDiscrepancy& shown) {
  auto out = shown.event;
  if (!shown.outcome.empty()) {
    out += ": " + shown.outcome;
  } else if (!shown.fluents.empty()) {
    out += fmt::format(": {}", fmt::join(shown.fluents, ", "));
  }
  if (!shown.counted && !shown.trace.empty()) {
    out += fmt::format(", after {}", fmt::join(shown.trace, ", "));
  }
  return out;
}

}  // namespace parallax::tools
