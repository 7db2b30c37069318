#include "tools/diff/rates_revision.h"

#include <fmt/format.h>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "harness/confidence/comparison.h"

namespace parallax::tools {
namespace {

using compiler::Fact;
using compiler::FactKind;
using SortedJson = nlohmann::json;

constexpr std::int64_t kMostCounted = 1'000'000'000;

/// The member, of just this type.
template <typename T>
std::optional<T> at(const SortedJson& object, const char* name) {
  const auto* member = base::json_member(object, name);
  return member == nullptr ? std::nullopt : base::json_as<T>(*member);
}

/// Below zero: it is no count.
std::int64_t count_at(const SortedJson& object, const char* name) {
  const auto count = at<std::int64_t>(object, name).value_or(-1);
  return count <= kMostCounted ? count : -1;
}

/// None: it is no `initial_states`.
std::optional<RevisionInitial> initial_of(const SortedJson& json) {
  const auto law = at<std::string>(json, "law");
  const auto* all = base::json_member(json, "all");
  const bool is_known = law == harness::law_word(harness::Initial::kAll) ||
                        law == harness::law_word(harness::Initial::kWeights) ||
                        law == harness::law_word(harness::Initial::kFirst);
  if (!is_known || all == nullptr) return std::nullopt;
  RevisionInitial out;
  out.law = *law;
  out.states = at<std::string>(json, "states_hash").value_or("");
  if (!all->is_null()) {
    out.all = base::json_as<std::int64_t>(*all);
    if (!out.all || *out.all < 1) return std::nullopt;
  }
  return out;
}

/// The runs of the member `samples`; none: they are not runs with these counts.
std::optional<std::vector<RevisionRates::Run>> runs_of(const SortedJson& samples,
                                                       const harness::RateCounts& counts) {
  if (!samples.is_array()) return std::nullopt;
  std::vector<RevisionRates::Run> out;
  std::int64_t failures = 0, lost = 0;
  for (const auto& sample : samples) {
    const auto outcome = at<std::string>(sample, "outcome");
    auto start = at<std::string>(sample, "start");
    if (!outcome || !start) return std::nullopt;
    auto result = harness::RunResult::kClean;
    if (outcome == "discrepancy") {
      result = harness::RunResult::kFailure;
      ++failures;
    } else if (outcome == "lost") {
      result = harness::RunResult::kLost;
      ++lost;
    } else if (outcome != "clean" && outcome != "admitted") {
      return std::nullopt;
    }
    out.push_back({result, *std::move(start)});
  }
  const bool agrees =
      std::ssize(out) == counts.runs && failures == counts.failures && lost == counts.lost;
  return agrees ? std::optional(std::move(out)) : std::nullopt;
}

/// None: it is no such trace.
std::optional<RevisionRates> rates_of(const SortedJson& json, bool fixed) {
  const auto events = at<std::string>(json, "events");
  const auto runs = count_at(json, "runs"), lost = count_at(json, "lost");
  const auto* any = base::json_member(json, "any");
  const auto* causes = base::json_member(json, "causes");
  const auto failures = any == nullptr ? -1 : count_at(*any, "count");
  if (!events || runs < 0 || lost < 0 || failures < 0 || failures > runs) return std::nullopt;
  if (causes == nullptr || !causes->is_array()) return std::nullopt;
  RevisionRates out{*events, {runs + lost, failures, lost, fixed}, {}};
  const auto* law = base::json_member(json, "law");
  const auto* words = law == nullptr ? nullptr : base::json_member(*law, "words");
  if (words != nullptr && words->is_array()) {
    for (const auto& word : *words) {
      out.law += (out.law.empty() ? "" : "; ") + base::json_as<std::string>(word).value_or("");
    }
  }
  if (const auto* initial = base::json_member(json, "initial_states")) {
    const auto read = initial_of(*initial);
    if (!read) return std::nullopt;
    out.initial = *read;
  }
  if (const auto* samples = base::json_member(json, "samples")) {
    auto listed = runs_of(*samples, out.any);
    if (!listed) return std::nullopt;
    out.runs = *std::move(listed);
  }
  std::int64_t sum = 0;
  for (const auto& cause : *causes) {
    const auto text = at<std::string>(cause, "cause");
    const auto times = count_at(cause, "count");
    if (!text || times < 0) return std::nullopt;
    sum += times;
    out.causes.push_back({*text, times});
  }
  return sum == failures ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace

base::Result<RatesRevision> load_rates(const std::string& path, Context& context) {
  const auto text = base::read_file(path, context.sink());
  if (!text) return context.sink().already_reported();
  return parse_rates(path, *text, context);
}

base::Result<RatesRevision> parse_rates(const std::string& name, const std::string& text,
                                        Context& context) {
  const auto refuse = [&](const std::string& why) {
    return context.sink().error_about(codes::kNoRatesResult, name, why);
  };
  const auto json = base::parse_json(text);
  if (!json.is_object()) return refuse("it is no JSON object");
  const auto* traces = base::json_member(json, "traces");
  const auto complete = at<bool>(json, "complete");
  const auto compared = at<std::string>(json, "compare");
  if (at<std::string>(json, "status") != "ok" || !complete || !compared || traces == nullptr ||
      !traces->is_array()) {
    return refuse("it lacks `status: ok`, `complete`, `compare` or `traces`");
  }
  RatesRevision out;
  out.name = name;
  out.scenario = at<std::string>(json, "scenario").value_or("");
  out.compare = *compared;
  if (const auto* list = base::json_member(json, "compared"); list && list->is_array()) {
    for (const auto& one : *list) {
      out.compared += fmt::format("{}{} {}", out.compared.empty() ? "" : ", ",
                                  at<std::string>(one, "fluent").value_or(""),
                                  at<std::string>(one, "compared").value_or(""));
    }
  }
  out.match = at<std::string>(json, "match").value_or("");
  out.simulator = at<std::string>(json, "simulator").value_or("");
  out.scenario_hash = at<std::string>(json, "scenario_hash").value_or("");
  out.starts_hash = at<std::string>(json, "starts_hash").value_or("");
  out.judging_hash = at<std::string>(json, "judging_hash").value_or("");
  out.seed = at<std::uint64_t>(json, "seed").value_or(0);
  out.complete = *complete;
  out.fixed = at<std::string>(json, "intervals") != "anytime";
  for (std::size_t i = 0; i < traces->size(); ++i) {
    auto trace = rates_of((*traces)[i], out.fixed);
    if (!trace) return refuse(fmt::format("the counts of entry {} of `traces` are none", i + 1));
    for (const auto& other : out.traces) {
      if (other.events == trace->events) return refuse("a trace stands there twice");
    }
    out.traces.push_back(*std::move(trace));
  }
  return out;
}

std::string initial_text(const RevisionInitial& initial) {
  if (initial.law == harness::law_word(harness::Initial::kFirst)) {
    return initial.all ? fmt::format("the first of {}", *initial.all) : "only the first";
  }
  return fmt::format("{} of {}", initial.law,
                     initial.all ? std::to_string(*initial.all) : "more than are listed");
}

std::vector<Fact> rates_facts(const RatesRevision& rates) {
  std::vector<Fact> out;
  const auto add = [&](FactKind kind, const std::string& key, const std::string& rest) {
    const auto text = key + ": " + rest;
    out.push_back({kind, key, text, text, {rates.name, 0}});
  };
  add(FactKind::kDeclaration, "scenario", rates.scenario);
  add(FactKind::kDeclaration, "seed", std::to_string(rates.seed));
  add(FactKind::kDeclaration, "compare", rates.compare);
  const auto add_known = [&](const char* key, const std::string& value) {
    if (!value.empty()) add(FactKind::kDeclaration, key, value);
  };
  add_known("compared", rates.compared);
  add_known("match", rates.match);
  add_known("simulator", rates.simulator);
  add_known("hash of scenario, models and plan", rates.scenario_hash);
  add_known("hash of starts", rates.starts_hash);
  add_known("hash of judging", rates.judging_hash);
  if (!rates.complete) add(FactKind::kDeclaration, "complete", "no");
  for (const auto& trace : rates.traces) {
    const auto name = fmt::format("trace [{}]", trace.events);
    add(FactKind::kDeclaration, name,
        fmt::format("{} runs, {} lost", trace.any.runs - trace.any.lost, trace.any.lost));
    if (!trace.law.empty()) add(FactKind::kDeclaration, name + ", starts", trace.law);
    if (!trace.initial.is_one_state()) {
      add(FactKind::kDeclaration, name + ", initial states", initial_text(trace.initial));
    }
    if (!trace.initial.states.empty()) {
      add(FactKind::kDeclaration, name + ", hash of initial states", trace.initial.states);
    }
    add(FactKind::kAxiom, name, fmt::format("{} discrepancies", trace.any.failures));
    for (const auto& cause : trace.causes) {
      add(FactKind::kAxiom, fmt::format("{}, {}", name, cause.text), std::to_string(cause.count));
    }
  }
  return out;
}

}  // namespace parallax::tools
