#include "harness/report/run_report.h"

#include <fmt/format.h>

#include <algorithm>
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

/// One text an entry, empty where it is none, so that each keeps its place.
std::vector<std::string> reported_places(const ReportJson& object, const char* name) {
  std::vector<std::string> out;
  for (const auto& value : reported_list(object, name)) {
    out.push_back(base::json_as<std::string>(value).value_or(""));
  }
  return out;
}

std::vector<DivergingFluent> reported_fluents(const ReportJson& object, const char* name) {
  std::vector<DivergingFluent> out;
  for (const auto& entry : reported_list(object, name)) {
    out.push_back({reported_text(entry, "fluent"), reported_whole(entry, "timepoint"),
                   reported<bool>(entry, "predicted"), reported<bool>(entry, "observed"),
                   reported_text(entry, "measured")});
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
  out.end = kPathEndWords.find(reported_text(entry, "path_end")).value_or(PathEnd::kDone);
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
  kDiscrepancyKindWords.take(reported_text(entry, "kind"), found.kind);
  found.confirmation =
      kRepeatResultWords.find(reported_text(entry, "repeated")).value_or(RepeatResult::kLost);
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
  out.words = reported<std::string>(entry, "words", found.cause.text);
  out.replay = reported_text(entry, "replay");
  const auto& standing = reported_member(entry, "standing");
  out.standing = {standing_named(reported_text(standing, "is")), reported_text(standing, "words")};
  out.is_whole = reported_or_none<std::int64_t>(entry, "trace") &&
                 reported_or_none<std::int64_t>(entry, "sample") && divergence &&
                 *divergence >= 0 && are_whole_fluents(reported_member(entry, "first"));
  return out;
}

PathCount reported_count(const ReportJson& entry) {
  return {reported_texts(entry, "events"),
          reported_texts(entry, "outcomes"),
          kPathEndWords.find(reported_text(entry, "end")).value_or(PathEnd::kDone),
          reported_text(entry, "detail"),
          reported_whole(entry, "simulations"),
          reported_whole(entry, "example")};
}

ReportedCover reported_cover(const ReportJson& cover) {
  return {reported_text(cover, "end"), reported_whole(cover, "items"),
          reported_whole(cover, "shown"), reported<double>(cover, "confidence"),
          reported<double>(cover, "bound", 1.0)};
}

StartResult reported_starts(const ReportJson& starts) {
  StartResult out;
  out.all = reported_or_none<std::int64_t>(starts, "all");
  out.tried = reported_whole(starts, "tried");
  out.visits = reported_whole(starts, "visits");
  for (const auto& state : reported_list(starts, "states")) {
    out.states[reported_whole(state, "state")] = {
        reported_text(state, "holds"), reported_whole(state, "clean"),
        reported_whole(state, "lost"), reported_whole(state, "discrepancies")};
  }
  return out;
}

ReportedTrace reported_trace(const ReportJson& entry) {
  const auto &certified = reported_member(entry, "certified"),
             &paper = reported_member(entry, "paper");
  ReportedTrace out;
  out.number = reported_whole(entry, "trace");
  out.verdict = reported_text(entry, "verdict");
  out.claim = reported_text(entry, "claim");
  out.events = reported_texts(entry, "events");
  out.sources = reported_places(entry, "sources");
  out.initial_state = reported_texts(entry, "initial_state");
  if (const auto& starts = reported_member(entry, "initial_states"); starts.is_object()) {
    out.starts = reported_starts(starts);
  }
  out.caveats = reported_texts(entry, "caveats");
  out.not_covered = reported_texts(entry, "not_covered");
  out.simulations = reported_or_none<std::int64_t>(entry, "simulations");
  out.clean = reported_or_none<std::int64_t>(entry, "clean");
  out.lost = reported_or_none<std::int64_t>(entry, "lost");
  for (const auto& lost : reported_list(entry, "losses")) {
    out.losses.push_back({reported_text(lost, "reason"), reported_whole(lost, "count"),
                          reported_whole(lost, "example")});
  }
  out.confidence = reported_or_none<double>(certified, "confidence");
  out.epsilon = reported_or_none<double>(certified, "epsilon");
  out.error_share = reported_or_none<double>(entry, "error_share");
  out.paper_stopped_at = reported_or_none<std::int64_t>(paper, "stopped_at");
  out.paper_variant = reported_text(paper, "variant");
  for (const auto& cause : reported_list(entry, "causes")) {
    auto& rate = out.causes.emplace_back();
    rate.cause = reported_text(cause, "cause");
    rate.count = reported_whole(cause, "count");
    rate.rate = reported<double>(cause, "rate");
    rate.lower = reported<double>(cause, "lower");
    rate.upper = reported<double>(cause, "upper", 1.0);
    rate.example = reported_whole(cause, "example");
    rate.reason = reported_text(cause, "reason");
  }
  out.chosen_starts = reported_or_none<std::int64_t>(entry, "chosen_starts");
  out.unfinished = reported_or_none<std::int64_t>(entry, "unfinished");
  for (const auto& path : reported_list(entry, "paths")) out.paths.push_back(reported_count(path));
  if (const auto& cover = reported_member(entry, "until_covered"); cover.is_object()) {
    out.cover = reported_cover(cover);
  }
  return out;
}

std::optional<CriterionSpec> reported_criterion(const ReportJson& criterion) {
  if (!criterion.is_object()) return std::nullopt;
  CriterionSpec out;
  const auto kind =
      std::find(kCriterionWords.begin(), kCriterionWords.end(), reported_text(criterion, "kind"));
  if (kind != kCriterionWords.end()) {
    out.kind = static_cast<CriterionKind>(kind - kCriterionWords.begin());
  }
  out.confidence_level = reported<double>(criterion, "confidence", out.confidence_level);
  out.epsilon = reported<double>(criterion, "epsilon", out.epsilon);
  out.runs = std::max<std::int64_t>(0, reported_whole(criterion, "runs"));
  out.paper.preset =
      reported<std::string>(reported_member(criterion, "paper"), "preset", out.paper.preset);
  return out;
}

std::optional<ReportedFamily> reported_family(const ReportJson& family) {
  if (!family.is_object()) return std::nullopt;
  return ReportedFamily{reported_or_none<std::int64_t>(family, "traces"),
                        reported_text(family, "claim")};
}

std::vector<CoverageShare> reported_coverage(const ReportJson& coverage) {
  std::vector<CoverageShare> out;
  if (!coverage.is_object()) return out;
  for (const auto& [group, share] : coverage.items()) {
    out.push_back({group, reported_whole(share, "covered"), reported_whole(share, "all")});
  }
  return out;
}

std::optional<ReportedOpinion> reported_opinion(const ReportJson& opinion) {
  if (!opinion.is_object()) return std::nullopt;
  return ReportedOpinion{reported_text(opinion, "other"), reported_texts(opinion, "words")};
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
  out.bounds = reported_texts(report, "bounds");
  if (const auto& compared = reported_member(report, "compared"); compared.is_array()) {
    for (const auto& entry : compared) {
      if (reported_text(entry, "compared") != "ignored") continue;
      out.ignored.push_back(reported_text(entry, "fluent"));
    }
  }
  out.execution = reported_text(report, "execution");
  out.comparison = reported_text(report, "compare");
  for (const auto& entry : reported_list(report, "compared")) {
    out.compared += fmt::format("{}{} {}", out.compared.empty() ? "" : ", ",
                                reported_text(entry, "fluent"), reported_text(entry, "compared"));
  }
  out.criterion = reported_json(report, "criterion");
  out.simulator = reported_json(report, "simulator");
  out.criterion_spec = reported_criterion(reported_member(report, "criterion"));
  const auto& simulator = reported_member(report, "simulator");
  out.simulator_name = reported_text(simulator, "name");
  out.simulator_version = reported_text(simulator, "version");
  out.family = reported_family(reported_member(report, "family"));
  out.coverage = reported_coverage(reported_member(report, "coverage"));
  out.opinion = reported_opinion(reported_member(report, "second_opinion"));
  out.interrupted = reported_or_none<bool>(report, "interrupted");
  out.traces = list_of<ReportedTrace>(report, "traces", reported_trace);
  out.discrepancies = list_of<ReportedDiscrepancy>(report, "discrepancies", reported_discrepancy);
  return out;
}

}  // namespace parallax::harness
