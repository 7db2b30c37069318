#include "tools/suite/junit.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/contract.h"
#include "compiler/base/xml_text.h"

namespace parallax::tools {
namespace {

using base::xml_escaped;

struct Tally {
  std::size_t tests = 0, failures = 0, errors = 0, skipped = 0;
  double wall_s = 0.0;

  void add(const CaseResult& result) {
    ++tests;
    wall_s += result.wall_s;
    failures += result.outcome == Outcome::kFailed ? 1 : 0;
    skipped += result.outcome == Outcome::kSkipped ? 1 : 0;
    errors += result.outcome == Outcome::kError || result.outcome == Outcome::kNotFinished ? 1 : 0;
  }
  std::string attributes() const {
    return fmt::format(R"(tests="{}" failures="{}" errors="{}" skipped="{}" time="{:.3f}")", tests,
                       failures, errors, skipped, wall_s);
  }
};

/// `<failure message="first sentence">all of them</failure>`.
void append_problem(std::string& out, std::string_view element, const CaseResult& result) {
  std::string all;
  for (const auto& problem : result.problems) all += problem + '\n';
  const auto headline = all.substr(0, all.find('\n'));
  out += fmt::format("      <{0} message=\"{1}\" type=\"{2}\">{3}</{0}>\n", element,
                     xml_escaped(headline), to_string(result.outcome), xml_escaped(all));
}

void append_case(std::string& out, const SuiteCase& one, const CaseResult& result) {
  const auto slash = one.id == one.file ? one.id.rfind('/') : std::string::npos;
  const auto name = slash == std::string::npos ? one.id : one.id.substr(slash + 1);
  out +=
      fmt::format("    <testcase classname=\"{}\" name=\"{}\" file=\"{}\" time=\"{:.3f}\">\n",
                  xml_escaped(one.group), xml_escaped(name), xml_escaped(one.file), result.wall_s);
  switch (result.outcome) {
    case Outcome::kPassed:
      break;
    case Outcome::kFailed:
      append_problem(out, "failure", result);
      break;
    case Outcome::kError:
      append_problem(out, "error", result);
      break;
    case Outcome::kNotFinished:
      out += "      <error message=\"not finished\" type=\"not finished\"/>\n";
      break;
    case Outcome::kSkipped:
      out += "      <skipped message=\"not in this shard\"/>\n";
      break;
  }
  if (!result.messages.empty()) {
    out += fmt::format("      <system-err>{}</system-err>\n", xml_escaped(result.messages));
  }
  out += "    </testcase>\n";
}

}  // namespace

std::string to_junit(const std::vector<SuiteCase>& cases, const std::vector<CaseResult>& results,
                     std::string_view timestamp) {
  PARALLAX_REQUIRE(cases.size() == results.size(), "a result for every case");
  Tally total;
  for (const auto& result : results) total.add(result);
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  out += fmt::format("<testsuites name=\"parallax suite\" {}>\n", total.attributes());
  for (std::size_t i = 0; i < cases.size();) {
    Tally tally;
    std::string body;
    const auto& group = cases[i].group;
    for (; i < cases.size() && cases[i].group == group; ++i) {
      tally.add(results[i]);
      append_case(body, cases[i], results[i]);
    }
    out += fmt::format("  <testsuite name=\"{}\" {} timestamp=\"{}\">\n{}  </testsuite>\n",
                       xml_escaped(group), tally.attributes(), xml_escaped(timestamp), body);
  }
  return out + "</testsuites>\n";
}

}  // namespace parallax::tools
