#include "tools/ledger/shown.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "compiler/base/json.h"

namespace parallax::tools {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kNot = "not ";

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

std::vector<std::string> texts(const Json& list) {
  std::vector<std::string> out;
  for (const auto& item : list.is_array() ? list : Json::array()) {
    if (item.is_string()) out.push_back(item.get<std::string>());
  }
  return out;
}

std::vector<std::string> differing(const Json& list) {
  std::vector<std::string> out;
  for (const auto& item : list.is_array() ? list : Json::array()) {
    const auto& observed = member(item, "observed");
    const bool holds = observed.is_boolean() && observed.get<bool>();
    out.push_back((holds ? "" : std::string(kNot)) + text(item, "fluent"));
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// A perform of an executed plan, with its outcome as the plan was told it.
std::string step_text(const Json& step) {
  auto out = text(step, "event");
  if (const auto object = text(step, "object"); !object.empty()) out += " = " + object;
  if (text(step, "outcome") != "failed") return out;
  const auto condition = text(step, "condition");
  return out + (condition.empty() ? " fails" : fmt::format(" fails ({})", condition));
}

/// "Place(r1): not BoxIn(r1)": the event, and its outcome or a fluent that differs after it.
void take_cause(const std::string& cause, ShownDiscrepancy& shown) {
  const auto colon = cause.find(": ");
  shown.event = cause.substr(0, colon);
  const auto rest = colon == std::string::npos ? "" : cause.substr(colon + 2);
  const auto is_fluent = [&](const std::string& fluent) { return fluent == rest; };
  if (std::any_of(shown.fluents.begin(), shown.fluents.end(), is_fluent)) return;
  // The event failed: the differing fluents are consequences of that.
  shown.outcome = rest;
  if (!rest.empty()) shown.fluents.clear();
}

/// The events before the one that the cause names.
std::vector<std::string> trace_before(const Json& found, const std::vector<std::string>& events,
                                      const std::string& event) {
  const auto divergence = std::max<std::int64_t>(1, whole(found, "first_divergence"));
  const auto from = std::min(static_cast<std::size_t>(divergence - 1), events.size());
  const auto at =
      std::find(events.begin() + static_cast<std::ptrdiff_t>(from), events.end(), event);
  if (at == events.end()) return {};
  return {events.begin(), at};
}

ShownDiscrepancy discrepancy_of(const Json& found, bool final, const ShownRun& run,
                                const std::vector<std::int64_t>& numbers) {
  ShownDiscrepancy out;
  const auto trace = whole(found, "trace");
  out.sample = fmt::format("{}.{}", trace, whole(found, "sample"));
  out.words = text(found, "words");
  auto last = differing(member(found, "fluents"));
  auto first = differing(member(found, "first"));
  out.fluents = (final && !last.empty()) || first.empty() ? std::move(last) : std::move(first);
  take_cause(text(member(found, "cause"), "text"), out);
  if (run.is_executed) {
    const auto event = whole(member(found, "differs"), "event");
    const auto& path = member(found, "path");
    for (std::size_t i = 0; path.is_array() && i < path.size(); ++i) {
      if (static_cast<std::int64_t>(i) < event) out.trace.push_back(step_text(path[i]));
    }
    return out;
  }
  const auto at = std::find(numbers.begin(), numbers.end(), trace);
  if (at == numbers.end()) return out;
  const auto& events = run.traces[static_cast<std::size_t>(at - numbers.begin())].events;
  out.trace = trace_before(found, events, out.event);
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
  const auto run = base::parse_json(document);
  const auto &traces = member(run, "traces"), &discrepancies = member(run, "discrepancies");
  if (!traces.is_array() || !discrepancies.is_array()) return std::nullopt;
  ShownRun out;
  out.scenario = text(run, "scenario");
  out.is_executed = text(run, "execution") == "closed-loop";
  const auto& interrupted = member(run, "interrupted");
  out.is_complete = text(run, "exploration") != "stopped" && text(run, "status") == "ok" &&
                    interrupted.is_boolean() && !interrupted.get<bool>();
  if (out.is_executed) out.is_complete = text(run, "verdict") == "no-discrepancy";
  std::vector<std::int64_t> numbers;
  for (const auto& trace : traces) {
    numbers.push_back(whole(trace, "trace"));
    out.traces.push_back(
        {texts(member(trace, "events")), text(trace, "verdict") == "no-discrepancy"});
  }
  const bool final = text(run, "compare") == "final";
  for (const auto& found : discrepancies) {
    out.discrepancies.push_back(discrepancy_of(found, final, out, numbers));
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
      const auto words = text(cause, "cause");
      const auto colon = words.find(": ");
      // A cause may be a fluent or an outcome, so both are kept: the ledger's entry says which it
      // is.
      if (colon != std::string::npos) shown.fluents = {words.substr(colon + 2)};
      take_cause(words, shown);
      if (!shown.fluents.empty()) shown.outcome = shown.fluents.front();
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
