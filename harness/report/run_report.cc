#include "harness/report/run_report.h"

#include <fmt/format.h>

#include <limits>

#include "compiler/base/json.h"
#include "harness/report/report_words.h"

namespace parallax::harness {
namespace {

using ReportJson = nlohmann::json;

/// The member with this type, or the fallback if there is none.
template <typename T>
T reported(const ReportJson& object, const char* name, T otherwise = {}) {
  const auto* value = base::json_member(object, name);
  return value == nullptr ? otherwise : base::json_as<T>(*value).value_or(std::move(otherwise));
}

template <typename T>
std::optional<T> reported_or_none(const ReportJson& object, const char* name) {
  const auto* value = base::json_member(object, name);
  return value == nullptr ? std::nullopt : base::json_as<T>(*value);
}

std::string reported_text(const ReportJson& object, const char* name) {
  return reported<std::string>(object, name);
}

std::int64_t reported_whole(const ReportJson& object, const char* name) {
  return reported<std::int64_t>(object, name);
}

const ReportJson& reported_member(const ReportJson& object, const char* name) {
  static const ReportJson kNone;
  const auto* value = base::json_member(object, name);
  return value == nullptr ? kNone : *value;
}

/// The member as JSON; empty if there is none.
std::string reported_json(const ReportJson& object, const char* name) {
  const auto& value = reported_member(object, name);
  return value.is_null() ? "" : base::json_text(value);
}

/// The entries of a list; empty for other values.
const ReportJson::array_t& reported_list(const ReportJson& object, const char* name) {
  static const ReportJson::array_t kNone;
  const auto& value = reported_member(object, name);
  return value.is_array() ? value.get_ref<const ReportJson::array_t&>() : kNone;
}

std::vector<std::string> reported_texts(const ReportJson& object, const char* name) {
  std::vector<std::string> out;
  for (const auto& value : reported_list(object, name)) {
    if (value.is_string()) out.push_back(value.get<std::string>());
  }
  return out;
}

/// The enumerator up to `last` that has this word; the fallback if there is none.
template <typename Enum, typename Word>
Enum enumerator(std::string_view text, Enum last, const Word& word, Enum otherwise) {
  for (int i = 0; i <= static_cast<int>(last); ++i) {
    if (word(static_cast<Enum>(i)) == text) return static_cast<Enum>(i);
  }
  return otherwise;
}

std::vector<DivergingFluent> reported_fluents(const ReportJson& object, const char* name) {
  std::vector<DivergingFluent> out;
  for (const auto& entry : reported_list(object, name)) {
    out.push_back({reported_text(entry, "fluent"), reported_whole(entry, "timepoint"),
                   reported<bool>(entry, "predicted"), reported<bool>(entry, "observed")});
  }
  return out;
}

bool are_whole_fluents(const ReportJson& list) {
  if (!list.is_array()) return false;
  for (const auto& entry : list) {
    if (!reported_or_none<std::int64_t>(entry, "timepoint") ||
        !reported_or_none<std::string>(entry, "fluent") ||
        !reported_or_none<bool>(entry, "observed")) {
      return false;
    }
  }
  return true;
}

/// Numbers that are not finite are written as null, and come back as NaN.
State reported_state(const ReportJson& object, const char* name) {
  State out;
  const auto& state = reported_member(object, name);
  if (!state.is_object()) return out;
  for (const auto& [variable, value] : state.items()) {
    if (value.is_boolean()) {
      out[variable] = value.get<bool>();
    } else if (const auto whole = base::json_as<std::int64_t>(value)) {
      out[variable] = *whole;
    } else if (value.is_number()) {
      out[variable] = value.get<double>();
    } else if (value.is_string()) {
      out[variable] = value.get<std::string>();
    } else if (value.is_null()) {
      out[variable] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return out;
}

ExecutedPath reported_path(const ReportJson& entry) {
  ExecutedPath out;
  out.start = reported_whole(entry, "start_state");
  out.end = enumerator(
      reported_text(entry, "path_end"), PathEnd::kUnnamedObject,
      [](PathEnd end) { return to_string(end); }, PathEnd::kDone);
  for (const auto& one : reported_list(entry, "path")) {
    PathStep step;
    step.event = reported_text(one, "event");
    step.source = reported_text(one, "source");
    step.succeeded = reported_text(one, "outcome") != "failed";
    step.object = reported_text(one, "object");
    step.condition = reported_text(one, "condition");
    out.steps.push_back(std::move(step));
  }
  return out;
}

ReportedDiscrepancy reported_discrepancy(const ReportJson& entry) {
  ReportedDiscrepancy out;
  auto& found = out.found;
  found.trace = reported_whole(entry, "trace");
  found.sample = reported_whole(entry, "sample");
  found.seed = reported<std::uint64_t>(entry, "seed");
  const auto divergence = reported_or_none<std::int64_t>(entry, "first_divergence");
  found.first_divergence = divergence.value_or(0);
  if (reported_text(entry, "kind") == to_string(DiscrepancyKind::kTransient)) {
    found.kind = DiscrepancyKind::kTransient;
  }
  found.confirmation = enumerator(reported_text(entry, "repeated"), Confirmation::kLost,
                                  confirmation_key, Confirmation::kLost);
  const auto& cause = reported_member(entry, "cause");
  found.cause = {reported_text(cause, "text"), reported_text(cause, "reason"),
                 reported_text(cause, "event"), reported_texts(cause, "fluents")};
  out.has_cause = reported_or_none<std::string>(cause, "event").has_value();
  found.first = reported_fluents(entry, "first");
  found.fluents = reported_fluents(entry, "fluents");
  auto& record = found.record;
  record.trace = found.trace;
  record.sample = found.sample;
  record.seed = found.seed;
  record.initial = reported_state(entry, "start");
  found.end = reported_state(entry, "end");
  for (const auto& one : reported_list(entry, "outcomes")) {
    record.outcomes.push_back({sim_status_from(reported_text(one, "status")),
                               reported_text(one, "reason"), reported<double>(one, "sim_time_s")});
  }
  if (const auto& differs = reported_member(entry, "differs"); differs.is_object()) {
    found.path =
        PathDivergence{reported_whole(differs, "event"), reported<bool>(differs, "impossible"),
                       reported<bool>(differs, "outcome"), reported<bool>(differs, "together")};
    record.path = reported_path(entry);
  }
  out.words = reported_text(entry, "words");
  out.replay = reported_text(entry, "replay");
  out.is_whole = reported_or_none<std::int64_t>(entry, "trace") &&
                 reported_or_none<std::int64_t>(entry, "sample") && divergence &&
                 *divergence >= 0 && are_whole_fluents(reported_member(entry, "first"));
  return out;
}

ReportedTrace reported_trace(const ReportJson& entry) {
  const auto& certified = reported_member(entry, "certified");
  return {reported_whole(entry, "trace"),
          reported_text(entry, "verdict"),
          reported_texts(entry, "events"),
          reported_texts(entry, "initial_state"),
          reported_or_none<std::int64_t>(entry, "simulations"),
          reported_or_none<std::int64_t>(entry, "clean"),
          reported_or_none<double>(certified, "confidence"),
          reported_or_none<double>(certified, "epsilon")};
}

/// The list of what `read` makes of each entry; none if the report has no such list.
template <typename T>
std::optional<std::vector<T>> list_of(const ReportJson& report, const char* name,
                                      T (*read)(const ReportJson&)) {
  if (!reported_member(report, name).is_array()) return std::nullopt;
  std::vector<T> out;
  for (const auto& entry : reported_list(report, name)) out.push_back(read(entry));
  return out;
}

}  // namespace

std::string ReportedDiscrepancy::id() const {
  return fmt::format("{}.{}", found.trace, found.sample);
}

std::optional<RunReport> read_run_report(std::string_view text) {
  const auto report = base::parse_json(text);
  if (!report.is_object()) return std::nullopt;
  RunReport out;
  out.status = reported_text(report, "status");
  out.scenario = reported_text(report, "scenario");
  out.seed = reported_or_none<std::uint64_t>(report, "seed");
  out.tool_version = reported_text(report, "tool_version");
  out.verdict = reported_text(report, "verdict");
  out.iterations = reported_or_none<std::int64_t>(report, "iterations");
  out.simulations = reported_or_none<std::int64_t>(report, "simulations");
  out.exploration = reported_text(report, "exploration");
  out.execution = reported_text(report, "execution");
  out.comparison = reported_text(report, "compare");
  out.criterion = reported_json(report, "criterion");
  out.simulator = reported_json(report, "simulator");
  out.simulator_name = reported_text(reported_member(report, "simulator"), "name");
  out.interrupted = reported_or_none<bool>(report, "interrupted");
  out.traces = list_of<ReportedTrace>(report, "traces", reported_trace);
  out.discrepancies = list_of<ReportedDiscrepancy>(report, "discrepancies", reported_discrepancy);
  return out;
}

}  // namespace parallax::harness
