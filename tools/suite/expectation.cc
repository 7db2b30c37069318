#include "tools/suite/expectation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>

#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"
#include "compiler/base/words.h"
#include "harness/confidence/rate_evidence.h"
#include "harness/confidence/rounding.h"
#include "harness/report/run_report.h"

namespace parallax::tools {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kShownCauses = 3;  // of many
constexpr std::size_t kShownAxioms = 5;  // of a set
constexpr std::int64_t kMostRuns = 1'000'000;

Json member(const Json& json, const char* name, Json otherwise) {
  return json.is_object() ? json.value(name, std::move(otherwise)) : otherwise;
}

/// "the event Place(r1), the fluent BoxIn(r1)"
std::string words_of(const harness::CauseExpectation& cause) {
  std::string out;
  const auto add = [&](const char* what, const std::string& value) {
    if (!value.empty()) out += fmt::format("{}the {} {}", out.empty() ? "" : ", ", what, value);
  };
  add("event", cause.event);
  add("fluent", cause.fluent);
  add("reason", cause.reason);
  add("kind", cause.kind);
  return out;
}

/// Is the cause of a discrepancy, or of all those that were counted together, as expected? Apart
/// from the kind of cause.
bool is_as_expected(const harness::CauseExpectation& expect, const harness::Cause& cause) {
  const auto& fluents = cause.fluents;
  return (expect.event.empty() || cause.event == expect.event) &&
         (expect.fluent.empty() ||
          std::find(fluents.begin(), fluents.end(), expect.fluent) != fluents.end()) &&
         (expect.reason.empty() || cause.reason.substr(0, cause.reason.find(':')) == expect.reason);
}

/// The cause of an entry in a document of rates.
harness::Cause counted_cause(const Json& entry) {
  harness::Cause out;
  out.text = member(entry, "cause", "").get<std::string>();
  out.reason = member(entry, "reason", "").get<std::string>();
  out.event = member(entry, "event", "").get<std::string>();
  for (const auto& fluent : member(entry, "fluents", Json::array())) {
    if (fluent.is_string()) out.fluents.push_back(fluent.get<std::string>());
  }
  return out;
}

using Reported = std::vector<harness::ReportedDiscrepancy>;

void compare_cause(const harness::CauseExpectation& expect, const Reported& discrepancies,
                   std::string_view explanation, std::vector<std::string>& out) {
  if (discrepancies.empty()) {
    out.push_back(fmt::format("no discrepancy, expected one with {}", words_of(expect)));
    return;
  }
  for (const auto& discrepancy : discrepancies) {
    const auto& cause = discrepancy.found.cause;
    if (is_as_expected(expect, cause)) continue;
    out.push_back(fmt::format("the cause is `{}`, expected {}", cause.text, words_of(expect)));
    return;
  }
  if (expect.kind.empty()) return;
  const auto told = base::parse_json(explanation);
  const auto kind = member(told, "cause", "unknown").get<std::string>();
  if (kind == expect.kind) return;
  const auto words = member(told, "cause_words", "").get<std::string>();
  out.push_back(fmt::format("the kind of cause is {}, expected {}{}{}", kind, expect.kind,
                            words.empty() ? "" : ": ", words));
}

std::vector<std::string> unlike_causes(const harness::CauseExpectation& expect,
                                       const Json& causes) {
  std::vector<std::string> out;
  for (const auto& entry : causes) {
    const auto kind = member(entry, "kind", "unknown").get<std::string>();
    const auto cause = counted_cause(entry);
    const bool same = is_as_expected(expect, cause);
    if (same && (expect.kind.empty() || kind == expect.kind)) continue;
    const auto count = member(entry, "count", 0).get<std::int64_t>();
    out.push_back(fmt::format("in {} the cause is `{}`{}, expected {}", base::counted(count, "run"),
                              cause.text, same ? fmt::format(" and its kind {}", kind) : "",
                              words_of(expect)));
  }
  return out;
}

/// Tells which required evidence the runs do not give.
std::string missing_evidence(const harness::RateExpectation& expect, const std::string& found,
                             const harness::RateCounts& counts) {
  const harness::RateClaim claim{expect.lower, expect.upper, *expect.confidence};
  const auto bounds = to_string(claim);
  const auto level = harness::level_text(*expect.confidence) + " confidence";
  switch (weigh(claim, counts)) {
    case harness::RateVerdict::kSupports:
      return {};
    case harness::RateVerdict::kRefutes:
      return fmt::format("{}: with {} the rate is not {}", found, level, bounds);
    case harness::RateVerdict::kTooLittle:
      break;
  }
  const auto enough = runs_to_tell(claim, counts, kMostRuns);
  return fmt::format(
      "{}: not enough evidence that the rate is {} with {}, or that it is not; {}", found, bounds,
      level,
      enough ? fmt::format("{} runs would tell if it stays like this", *enough)
             : fmt::format("if it stays like this {} runs would not tell either", kMostRuns));
}

}  // namespace

std::vector<std::string> unmet(const harness::Expectation& expect, std::string_view run_document,
                               std::string_view explanation) {
  const auto run = harness::read_run_report(run_document);
  if (!run || run->status != "ok") return {"the run gave no result"};
  std::vector<std::string> out;
  if (expect.verdict && run->verdict != *expect.verdict) {
    out.push_back(fmt::format("verdict {}, expected {}", run->verdict, *expect.verdict));
  }
  const auto iterations = run->iterations.value_or(-1);
  if (expect.iterations && iterations != *expect.iterations) {
    out.push_back(fmt::format("{} iterations, expected {}", iterations, *expect.iterations));
  }
  const auto simulations = run->simulations.value_or(-1);
  if (expect.max_simulations && simulations > *expect.max_simulations) {
    out.push_back(
        fmt::format("{} simulations, expected at most {}", simulations, *expect.max_simulations));
  }
  const auto discrepancies = run->discrepancies.value_or(Reported());
  std::set<std::string> diverging, earlier;
  for (const auto& discrepancy : discrepancies) {
    for (const auto& fluent : discrepancy.found.fluents) diverging.insert(fluent.fluent);
    for (const auto& fluent : discrepancy.found.first) earlier.insert(fluent.fluent);
  }
  if (run->comparison != to_string(harness::Comparison::kFinal)) diverging.merge(earlier);
  for (const auto& fluent : expect.fluents) {
    if (diverging.contains(fluent)) continue;
    out.push_back(fmt::format("{} {}", fluent,
                              earlier.contains(fluent)
                                  ? "diverged on the way, but not in the end, which is what counts"
                                  : "did not diverge"));
  }
  if (expect.cause) compare_cause(*expect.cause, discrepancies, explanation, out);
  return out;
}

std::vector<std::string> unmet(const harness::RateExpectation& expect,
                               std::string_view rates_document) {
  const auto rates = base::parse_json(rates_document);
  if (rates.is_discarded() || !rates.is_object() || rates.value("status", "") != "ok" ||
      rates.value("traces", Json::array()).size() != 1) {
    return {"the runs gave no rate"};
  }
  const auto& trace = rates["traces"][0];
  const auto& any = trace["any"];
  const double rate = any.value("rate", -1.0);
  const double lower = any.value("lower", 2.0), upper = any.value("upper", -1.0);
  const harness::RateCounts counts{
      trace.value("runs", std::int64_t{0}) + trace.value("lost", std::int64_t{0}),
      any.value("count", std::int64_t{0}), trace.value("lost", std::int64_t{0}), expect.fixed_runs};
  const auto found =
      fmt::format("discrepancies in {} of {} runs of trace {}, {} [{}, {}]{}", counts.failures,
                  counts.runs - counts.lost, expect.trace, harness::percent_about(rate),
                  harness::percent_figure(lower, harness::Round::kDown),
                  harness::percent_figure(upper, harness::Round::kUp),
                  counts.lost == 0 ? "" : fmt::format(", {} more lost", counts.lost));
  std::vector<std::string> out;
  if (expect.confidence) {
    if (auto missing = missing_evidence(expect, found, counts); !missing.empty()) {
      out.push_back(std::move(missing));
    }
  } else if (lower > expect.upper || upper < expect.lower) {
    out.push_back(
        fmt::format("{}, expected {:g} to {:g} %", found, 100 * expect.lower, 100 * expect.upper));
  }
  if (expect.cause) {
    for (auto& unlike : unlike_causes(*expect.cause, member(trace, "causes", Json::array()))) {
      out.push_back(std::move(unlike));
    }
  }
  return out;
}

std::string first_error(const std::string& document) {
  const auto json = base::parse_json(document);
  if (!json.is_object()) return {};
  for (const auto& diagnostic : json.value("diagnostics", Json::array())) {
    if (diagnostic.value("severity", "") != "error") continue;
    return fmt::format("{}: {}", diagnostic.value("code", ""), diagnostic.value("message", ""));
  }
  return {};
}

std::string first_discrepancy(const std::string& run_document) {
  const auto run = harness::read_run_report(run_document);
  if (!run || !run->discrepancies || run->discrepancies->empty()) return {};
  const auto& first = run->discrepancies->front();
  return fmt::format("{}: {}", first.id(), first.words);
}

ToldStanding standing_of_run(std::string_view run_document) {
  const auto run = base::parse_json(run_document);
  ToldStanding first;
  for (const auto& found : member(run, "discrepancies", Json::array())) {
    auto told = standing_of_confirmation(base::json_text(found));
    if (told.is != "in-doubt") return told;
    if (first.is.empty()) first = std::move(told);
  }
  return first;
}

ToldStanding standing_of_confirmation(std::string_view document) {
  const auto standing = member(base::parse_json(document), "standing", Json::object());
  return {member(standing, "is", "").get<std::string>(),
          base::printable(member(standing, "words", "").get<std::string>())};
}

std::string blame(std::string_view explanation) {
  const auto told = base::parse_json(explanation);
  const auto sets = member(told, "sets", Json::array());
  if (sets.empty()) return {};
  auto out = base::printable(member(sets.front(), "words", "").get<std::string>());
  const auto axioms = member(sets.front(), "axioms", Json::array());
  for (std::size_t i = 0; i < std::min(axioms.size(), kShownAxioms); ++i) {
    out += fmt::format("{}  {}:{}  {}: {}", out.empty() ? "" : "\n",
                       base::printable(member(axioms[i], "file", "").get<std::string>()),
                       member(axioms[i], "line", 0).get<std::int64_t>(),
                       member(axioms[i], "what", "").get<std::string>(),
                       member(axioms[i], "text", "").get<std::string>());
  }
  if (axioms.size() > kShownAxioms) {
    out += fmt::format("\n  and {} more", axioms.size() - kShownAxioms);
  }
  return out;
}

std::string frequent_causes(std::string_view rates_document) {
  const auto rates = base::parse_json(rates_document);
  const auto traces = member(rates, "traces", Json::array());
  if (traces.empty()) return {};
  const auto causes = member(traces.front(), "causes", Json::array());
  std::string out;
  for (std::size_t i = 0; i < std::min(causes.size(), kShownCauses); ++i) {
    const auto count = member(causes[i], "count", 0).get<std::int64_t>();
    out += fmt::format("{}{}: {}", out.empty() ? "" : "\n", base::counted(count, "time"),
                       member(causes[i], "cause", "").get<std::string>());
  }
  return out;
}

bool has_failed(const std::string& document) {
  const auto json = base::parse_json(document);
  return !json.is_object() || json.value("status", "") != "ok";
}

}  // namespace parallax::tools
