#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "compiler/base/json.h"
#include "harness/confidence/family.h"
#include "harness/confidence/rounding.h"
#include "tools/page/gather.h"
#include "tools/page/markup.h"

namespace parallax::tools {

const char* to_string(SampleVerdict verdict) {
  switch (verdict) {
    case SampleVerdict::kClean:
      return "clean";
    case SampleVerdict::kDiscrepancy:
      return "discrepancy";
    case SampleVerdict::kLost:
      return "lost";
    case SampleVerdict::kNotJudged:
      break;
  }
  return "not judged";
}

const char* to_string(SampleOrigin origin) {
  switch (origin) {
    case SampleOrigin::kDrawn:
      return "drawn";
    case SampleOrigin::kChosen:
      return "chosen start";
    case SampleOrigin::kSearch:
      return "search";
    case SampleOrigin::kFurther:
      break;
  }
  return "made afterwards";
}

std::string sample_name(std::int64_t trace, std::int64_t sample) {
  return fmt::format("{}.{}", trace, sample);
}

namespace {

using nlohmann::json;

/// A member of an object with this type, or the fallback if there is none.
template <typename T>
T field(const json& object, const char* name, T otherwise = {}) {
  const auto* value = base::json_member(object, name);
  if (value == nullptr) return otherwise;
  return base::json_as<T>(*value).value_or(otherwise);
}

std::int64_t whole(const json& object, const char* name) {
  return field<std::int64_t>(object, name);
}
std::string text(const json& object, const char* name) { return field<std::string>(object, name); }

/// The members of a list; empty for other values.
const json::array_t& list(const json& object, const char* name) {
  static const json::array_t kNone;
  const auto* value = base::json_member(object, name);
  return value != nullptr && value->is_array() ? value->get_ref<const json::array_t&>() : kNone;
}

std::vector<std::string> texts(const json& object, const char* name) {
  std::vector<std::string> out;
  for (const auto& value : list(object, name)) {
    if (value.is_string()) out.push_back(value.get<std::string>());
  }
  return out;
}

std::vector<PageDifference> differences(const json& object, const char* name) {
  std::vector<PageDifference> out;
  for (const auto& entry : list(object, name)) {
    out.push_back({text(entry, "fluent"), whole(entry, "timepoint"),
                   field<bool>(entry, "predicted"), field<bool>(entry, "observed")});
  }
  return out;
}

PagePath path_of(const json& entry) {
  constexpr std::size_t kMostSteps = 60;
  PagePath out;
  const auto events = texts(entry, "events"), outcomes = texts(entry, "outcomes");
  for (std::size_t i = 0; i < events.size() && i < kMostSteps; ++i) {
    out.steps += (i > 0 ? ", " : "") + events[i];
    if (i < outcomes.size() && outcomes[i] != "ok") out.steps += ": " + outcomes[i];
  }
  if (events.size() > kMostSteps) out.steps += ", ...";
  const auto detail = text(entry, "detail");
  out.end = text(entry, "end") + (detail.empty() ? "" : ": " + detail);
  out.simulations = whole(entry, "simulations");
  out.example = whole(entry, "example");
  return out;
}

/// "12 of 14 behaviours shown; each of the others comes in fewer than 5 % of executions"
std::string covered_text(const json& cover) {
  const auto items = whole(cover, "items"), shown = whole(cover, "shown");
  auto out = fmt::format("{} of {} behaviours of plan and model shown", shown, items);
  const auto bound = field<double>(cover, "bound", 1.0);
  if (shown < items && bound < 1.0) {
    out += fmt::format("; each of the others comes in fewer than {} of executions ({} confidence)",
                       harness::percent_up(bound),
                       harness::level_text(field<double>(cover, "confidence")));
  }
  const auto end = text(cover, "end");
  return shown < items && !end.empty() ? out + "; ended by: " + end : out;
}

PageTrace trace_of(const json& entry) {
  PageTrace out;
  out.number = whole(entry, "trace");
  out.verdict = text(entry, "verdict");
  out.claim = text(entry, "claim");
  out.caveats = texts(entry, "caveats");
  out.simulations = whole(entry, "simulations");
  out.clean = whole(entry, "clean");
  out.lost = whole(entry, "lost");
  for (const auto& lost : list(entry, "losses")) {
    out.losses.push_back({text(lost, "reason"), whole(lost, "count"), whole(lost, "example")});
  }
  if (const auto* certified = base::json_member(entry, "certified")) {
    out.certified_confidence = field<double>(*certified, "confidence");
    out.certified_epsilon = field<double>(*certified, "epsilon", 1.0);
  }
  const double share = field<double>(entry, "error_share", 1.0);
  if (share > 0.0 && share <= 1.0) out.error_share = std::max(share, 1e-6);
  if (const auto* paper = base::json_member(entry, "paper")) {
    out.paper_variant = text(*paper, "variant");
    if (const auto* at = base::json_member(*paper, "stopped_at")) {
      out.paper_stopped_at = base::json_as<std::int64_t>(*at);
    }
  }
  out.not_covered = texts(entry, "not_covered");
  out.initial_state = texts(entry, "initial_state");
  if (const auto* initial = base::json_member(entry, "initial_states");
      initial != nullptr && initial->is_object()) {
    const auto* all = base::json_member(*initial, "all");
    const auto known = all == nullptr ? std::nullopt : base::json_as<std::int64_t>(*all);
    out.all_states =
        known ? std::to_string(*known) : fmt::format("more than {}", harness::kMostInitialStates);
    for (const auto& state : list(*initial, "states")) {
      out.states.push_back({whole(state, "state"), text(state, "holds"), whole(state, "clean"),
                            whole(state, "lost"), whole(state, "discrepancies")});
    }
  }
  out.chosen_starts = whole(entry, "chosen_starts");
  out.unfinished = whole(entry, "unfinished");
  if (const auto* cover = base::json_member(entry, "until_covered")) {
    out.covered = covered_text(*cover);
  }
  for (const auto& path : list(entry, "paths")) out.paths.push_back(path_of(path));
  const auto& sources = list(entry, "sources");
  for (std::size_t i = 0; const auto& event : texts(entry, "events")) {
    const bool is_known = i < sources.size() && sources[i].is_string();
    out.steps.push_back({event, is_known ? sources[i].get<std::string>() : "", {}, {}, {}});
    ++i;
  }
  for (const auto& cause : list(entry, "causes")) {
    out.causes.push_back({text(cause, "cause"), whole(cause, "count"), field<double>(cause, "rate"),
                          field<double>(cause, "lower"), field<double>(cause, "upper", 1.0)});
  }
  return out;
}

PageDiscrepancy discrepancy_of(const json& entry) {
  PageDiscrepancy out;
  out.trace = whole(entry, "trace");
  out.sample = whole(entry, "sample");
  out.first_divergence = whole(entry, "first_divergence");
  out.words = text(entry, "words");
  out.kind = text(entry, "kind");
  out.repeated = text(entry, "repeated");
  if (const auto* cause = base::json_member(entry, "cause")) {
    out.cause = text(*cause, "text");
    out.reason = text(*cause, "reason");
  }
  if (out.words.empty()) out.words = out.cause;
  if (const auto* standing = base::json_member(entry, "standing")) {
    out.standing = {harness::standing_named(text(*standing, "is")), text(*standing, "words")};
  }
  if (const auto* differs = base::json_member(entry, "differs")) {
    out.parting_event = field<std::int64_t>(*differs, "event");
  }
  out.first = differences(entry, "first");
  out.fluents = differences(entry, "fluents");
  if (const auto* start = base::json_member(entry, "start");
      start != nullptr && start->is_object()) {
    for (const auto& [name, value] : start->items()) {
      out.start.emplace_back(name, value.is_number()       ? number(value.get<double>())
                                   : value.is_string()     ? value.get<std::string>()
                                   : value.is_structured() ? "..."
                                                           : base::json_text(value));
    }
  }
  return out;
}

std::optional<harness::SpendingRule> spending_of(const json& report) {
  const auto* family = base::json_member(report, "family");
  if (family == nullptr || !family->is_object()) return std::nullopt;
  const auto traces = whole(*family, "traces");
  constexpr std::int64_t kMost = 1'000'000;
  return harness::SpendingRule(traces > 0 ? std::optional(std::min(traces, kMost)) : std::nullopt);
}

void add_criterion(const json& criterion, const std::optional<harness::SpendingRule>& spending,
                   PageData& page) {
  const auto kind = text(criterion, "kind");
  page.confidence = std::clamp(field<double>(criterion, "confidence", 0.99), 0.01, 1.0 - 1e-9);
  page.epsilon = std::clamp(field<double>(criterion, "epsilon", 0.05), 1e-9, 1.0 - 1e-9);
  page.is_paper = kind == "paper";
  auto& spec = page.asked;
  spec.confidence_level = page.confidence;
  spec.epsilon = page.epsilon;
  for (std::size_t i = 0; i < harness::kCriterionWords.size(); ++i) {
    if (kind == harness::kCriterionWords[i]) spec.kind = static_cast<harness::CriterionKind>(i);
  }
  spec.runs = std::max<std::int64_t>(0, whole(criterion, "runs"));
  if (page.is_paper) {
    if (const auto* paper = base::json_member(criterion, "paper")) {
      spec.paper.preset = text(*paper, "preset");
    }
  }
  page.criterion = harness::criterion_text(spec, spending);
}

}  // namespace

bool add_report(const std::string& source, PageData& page) {
  const auto report = base::parse_json(source);
  if (!report.is_object() || base::json_member(report, "traces") == nullptr) return false;
  page.scenario = text(report, "scenario");
  page.verdict = text(report, "verdict");
  page.seed = field<std::uint64_t>(report, "seed");
  page.simulations = whole(report, "simulations");
  page.tool_version = text(report, "tool_version");
  page.exploration = text(report, "exploration");
  page.interrupted = field<bool>(report, "interrupted");
  page.closed_loop = text(report, "execution") == "closed-loop";
  if (const auto* simulator = base::json_member(report, "simulator")) {
    page.simulator = text(*simulator, "name") + ' ' + text(*simulator, "version");
  }
  if (const auto* criterion = base::json_member(report, "criterion")) {
    add_criterion(*criterion, spending_of(report), page);
  }
  if (const auto* family = base::json_member(report, "family")) page.claim = text(*family, "claim");
  for (const auto& entry : list(report, "traces")) page.traces.push_back(trace_of(entry));
  for (const auto& entry : list(report, "discrepancies")) {
    page.discrepancies.push_back(discrepancy_of(entry));
  }
  if (const auto* coverage = base::json_member(report, "coverage");
      coverage != nullptr && coverage->is_object()) {
    for (const auto& [group, share] : coverage->items()) {
      page.coverage.push_back(
          {group, std::to_string(whole(share, "covered")), std::to_string(whole(share, "all"))});
    }
  }
  if (const auto* opinion = base::json_member(report, "second_opinion")) {
    page.opinion_of = text(*opinion, "other");
    page.opinion_sentences = texts(*opinion, "words");
  }
  if (page.interrupted) {
    page.banners.push_back("The run was interrupted: what is claimed is what it had come to.");
  }
  return true;
}

}  // namespace parallax::tools
