#include "tools/suite/junit.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/contract.h"

namespace parallax::tools {
namespace {

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

/// The length of the UTF-8 sequence at the front that XML 1.0 can hold, or 0.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const auto first = byte(0);
  if (first < 0x80U) return first >= 0x20U || first == '\t' || first == '\n' ? 1 : 0;
  const std::size_t length = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
  if (first < 0xC2U || first > 0xF4U || text.size() < length) return 0;
  std::uint32_t code = first & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
    code = code << 6U | (byte(i) & 0x3FU);
  }
  const bool overlong = (length == 3 && code < 0x800U) || (length == 4 && code < 0x10000U);
  const bool surrogate = code >= 0xD800U && code <= 0xDFFFU;
  const bool outside = code > 0x10FFFFU || code == 0xFFFEU || code == 0xFFFFU;
  return overlong || surrogate || outside ? 0 : length;
}

std::string_view entity(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&apos;";
    case '\t':
      return "&#9;";
    case '\n':
      return "&#10;";
    default:
      return {};
  }
}

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

std::string xml_escaped(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const auto length = character_length(text);
    if (text.front() == '\r') {
      out += "&#13;";
    } else if (length == 0) {
      out += fmt::format("\\x{:02X}", static_cast<unsigned>(static_cast<unsigned char>(text[0])));
    } else if (const auto known = entity(text.front()); !known.empty()) {
      out += known;
    } else {
      out += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

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
