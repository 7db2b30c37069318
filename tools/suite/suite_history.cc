#include "tools/suite/suite_history.h"

#include <fmt/format.h>

#include "compiler/base/json.h"
#include "tools/suite/last_pass.h"

namespace parallax::tools {
namespace {

using Json = nlohmann::json;

template <typename T>
T value_or(const Json& object, const char* name, T otherwise) {
  const auto* member = base::json_member(object, name);
  return member == nullptr ? otherwise : base::json_as<T>(*member).value_or(otherwise);
}

const Json& list_of(const Json& object, const char* name) {
  static const Json kNone = Json::array();
  const auto* member = base::json_member(object, name);
  return member != nullptr && member->is_array() ? *member : kNone;
}

/// `all`: the document that the trace is of.
MeasuredRate measured(const Json& rate, std::string of, const Json& trace, const Json& all) {
  MeasuredRate out;
  out.of = std::move(of);
  out.count = value_or<std::int64_t>(rate, "count", 0);
  out.runs = value_or<std::int64_t>(trace, "runs", 0);
  out.lost = value_or<std::int64_t>(trace, "unseen", 0);
  out.lower = value_or(rate, "lower", 0.0);
  out.upper = value_or(rate, "upper", 1.0);
  out.confidence = value_or(all, "confidence", 0.95);
  out.fixed = value_or<std::string>(all, "intervals", {}) != "anytime";
  return out;
}

}  // namespace

void note_verdict(std::string_view run_document, CaseResult& result) {
  const auto run = base::parse_json(run_document);
  result.verdict = value_or<std::string>(run, "verdict", {});
  result.where = base::printable(value_or<std::string>(run, "not_everywhere", {}));
}

void note_rates(std::string_view rates_document, CaseResult& result) {
  constexpr std::size_t kMostCauses = 20;  // the most frequent ones come first
  const auto rates = base::parse_json(rates_document);
  for (const auto& trace : list_of(rates, "traces")) {
    const auto head = fmt::format("trace {}: ", value_or<std::int64_t>(trace, "trace", 0));
    const auto* any = base::json_member(trace, "any");
    if (any == nullptr || value_or<std::int64_t>(trace, "runs", 0) <= 0) continue;
    result.rates.push_back(measured(*any, head + "any discrepancy", trace, rates));
    std::size_t causes = 0;
    for (const auto& cause : list_of(trace, "causes")) {
      if (++causes > kMostCauses) break;
      const auto name = value_or<std::string>(cause, "cause", {});
      result.rates.push_back(measured(cause, head + name, trace, rates));
    }
  }
}

HistoryLine history_line(const SuiteRecord& record, const SuiteIdentity& suite,
                         std::string revision) {
  HistoryLine out;
  out.revision = std::move(revision);
  out.paths = suite.paths;
  out.only = suite.only;
  out.fast = suite.fast;
  out.seed = suite.seed;
  out.version = suite.version;
  out.program = suite.program;
  for (std::size_t i = 0; i < record.cases().size(); ++i) {
    const auto& result = record.results()[i];
    if (record.cases()[i].is_removed) continue;
    auto& one = out.cases[record.cases()[i].name()];
    one.outcome = to_string(result.outcome);
    one.verdict = result.verdict;
    one.rates = result.rates;
    one.files = files_hash(result.inputs);
    one.flaky = result.flaky();
    one.wall_s = result.wall_s;
    out.wall_s += result.wall_s;
  }
  return out;
}

}  // namespace parallax::tools
