#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"
#include "compiler/base/words.h"
#include "harness/conformance/conformance.h"

namespace parallax::harness {
namespace {

using ReportJson = nlohmann::ordered_json;

std::string_view state_of(const ConformanceReport& report, const CheckResult& check) {
  std::string_view state = check.was_made ? "ok" : "not made";
  for (const auto& finding : report.findings) {
    if (finding.kind != check.kind) continue;
    if (finding.is_fault) return "fault";
    if (check.was_made) state = "warning";
  }
  return state;
}

std::string indented(std::string text) {
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 7) {
    text.replace(at, 1, "\n      ");
  }
  return text;
}

constexpr std::pair<const char*, std::string SupportedClaims::*> kClaimRows[] = {
    {"replay", &SupportedClaims::replay},
    {"retry of lost runs", &SupportedClaims::retries},
    {"clean runs independent", &SupportedClaims::independence},
    {"several jobs", &SupportedClaims::jobs},
    {"search", &SupportedClaims::search},
    {"recordings", &SupportedClaims::recordings}};

}  // namespace

std::string_view to_string(CheckKind kind) {
  static constexpr std::string_view kNames[] = {
      "handshake", "reset",      "actions",  "determinism", "seeds", "wear", "invalid start",
      "unknown",   "time limit", "start-up", "timing",      "units", "end"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string_view to_string(Repeatability repeatability) {
  static constexpr std::string_view kNames[] = {"unknown", "none", "tolerance", "bitwise"};
  return kNames[static_cast<std::size_t>(repeatability)];
}

std::string conformance_text(const ConformanceReport& report, const std::string& command) {
  std::string text = command;
  if (!report.info.name.empty()) {
    text += base::printable(fmt::format(": {} {}", report.info.name, report.info.version));
  }
  text += "\n\n";
  for (const auto& check : report.checks) {
    text += fmt::format("  {:<14} {:<9} {}\n", to_string(check.kind), state_of(report, check),
                        base::printable(check.said));
  }
  text += '\n';
  for (const bool is_fault : {true, false}) {
    for (const auto& finding : report.findings) {
      if (finding.is_fault != is_fault) continue;
      text += fmt::format("{}: {}: {}\n", is_fault ? "fault" : "warning", to_string(finding.kind),
                          indented(finding.text));
    }
  }
  if (!report.findings.empty()) text += '\n';
  text += "what claims it supports, as measured\n";
  for (const auto& [name, member] : kClaimRows) {
    text += fmt::format("  {:<23} {}\n", name, base::printable(report.claims.*member));
  }
  const auto faults = report.faults();
  text += fmt::format("\n{}, {}{}\n", faults == 0 ? "no fault" : base::counted(faults, "fault"),
                      base::counted(report.findings.size() - faults, "warning"),
                      report.complete ? "" : "; it was given up before the end");
  return text;
}

std::string conformance_json(const ConformanceReport& report,
                             const std::vector<std::string>& command) {
  ReportJson checks = ReportJson::array(), findings = ReportJson::array();
  for (const auto& check : report.checks) {
    checks.push_back({{"check", to_string(check.kind)},
                      {"state", state_of(report, check)},
                      {"said", check.said}});
  }
  for (const auto& finding : report.findings) {
    findings.push_back({{"check", to_string(finding.kind)},
                        {"severity", finding.is_fault ? "fault" : "warning"},
                        {"text", finding.text}});
  }
  ReportJson claims = ReportJson::object();
  for (const auto& [name, member] : kClaimRows) {
    std::string key = name;
    std::replace(key.begin(), key.end(), ' ', '_');
    claims[key] = report.claims.*member;
  }
  const auto& info = report.info;
  ReportJson document{
      {"status", report.faults() == 0 && report.complete ? "ok" : "faults"},
      {"command", command},
      {"simulator",
       {{"name", info.name},
        {"version", info.version},
        {"determinism", info.determinism},
        {"seeds", info.seeds},
        {"capabilities", info.capabilities}}},
      {"complete", report.complete},
      {"checks", std::move(checks)},
      {"findings", std::move(findings)},
      {"measured",
       {{"determinism", to_string(report.repeatability)},
        {"largest_start_deviation", report.largest_deviation},
        {"largest_difference", report.largest_difference}}},
      {"claims", std::move(claims)},
      {"timing",
       {{"round_trip_s", report.round_trip_s}, {"real_time_factor", report.real_time_factor}}}};
  if (const auto& states = report.states) {
    document["initial_states"] = {{"all", states->all ? ReportJson(*states->all) : ReportJson()},
                                  {"tried", states->tried}};
  }
  return base::json_text(document) + "\n";
}

}  // namespace parallax::harness
