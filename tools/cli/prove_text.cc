#include "tools/cli/prove_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "compiler/base/json.h"
#include "compiler/base/words.h"
#include "harness/campaign/start_words.h"
#include "harness/confidence/rounding.h"
#include "harness/geometry_proof/proof_assumptions.h"

namespace parallax::tools {
namespace {

/// Shares of the settled volume are rounded down, so that no more is claimed than is proved.
std::string proved(double share, int width = 8) {
  return fmt::format("{:>{}}", harness::percent_down(share), width);
}
std::string open_share(double share) { return fmt::format("{:>8}", harness::percent_up(share)); }

/// The number of boxes with the verdict, and the cause that accounts for most of their volume.
std::string boxes_text(const harness::TestCertificate& test, harness::BoxVerdict verdict) {
  std::map<std::string, double> culprits;
  std::int64_t boxes = 0;
  for (const auto& box : test.boxes) {
    if (box.verdict != verdict) continue;
    ++boxes;
    double volume = 1.0;
    for (const auto& one : box.bounds) volume *= one.upper - one.lower;
    if (!box.culprit.empty()) culprits[box.culprit] += volume;
  }
  std::string text = base::counted(boxes, "box", "boxes");
  const auto most =
      std::max_element(culprits.begin(), culprits.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most != culprits.end()) text += "; mostly " + most->first;
  return text;
}

std::string simulated_text(const harness::SimulatedTest& test) {
  std::string text;
  for (const auto verdict :
       {harness::BoxVerdict::kSafe, harness::BoxVerdict::kRefuted, harness::BoxVerdict::kOpen}) {
    const auto& count = test.by_verdict[static_cast<std::size_t>(verdict)];
    text += fmt::format("{}{} of {} {}", text.empty() ? "" : ", ", count.refused, count.starts,
                        to_string(verdict));
  }
  std::string out = fmt::format("      simulated  refused: {}\n", text);
  if (test.not_as_assumed > 0) {
    std::string why;
    for (const auto& [what, count] : test.broken) {
      why += fmt::format("{}{} ({})", why.empty() ? "" : ", ", what, count);
    }
    out += fmt::format("                 {} not as assumed, and not counted: {}\n",
                       test.not_as_assumed, why);
  }
  return out;
}

nlohmann::ordered_json simulated_json(const harness::SimulatedTest& test) {
  nlohmann::ordered_json out;
  for (const auto verdict :
       {harness::BoxVerdict::kSafe, harness::BoxVerdict::kRefuted, harness::BoxVerdict::kOpen}) {
    const auto& count = test.by_verdict[static_cast<std::size_t>(verdict)];
    out[std::string(to_string(verdict))] = {{"starts", count.starts}, {"refused", count.refused}};
  }
  out["not_as_assumed"] = test.not_as_assumed;
  out["broken"] = test.broken;
  return out;
}

std::string_view status_of(const harness::CertificateCheck& result) {
  if (result.wrong > 0) return "wrong";
  if (result.unconfirmed > 0) return "unconfirmed";
  return result.confirmed > 0 ? "ok" : "nothing";
}

using PrettyJson = nlohmann::ordered_json;

PrettyJson state_document(const ProvedState& state) {
  auto document = base::parse_ordered_json(harness::certificate_json(state.certificate));
  for (auto& action : document["actions"]) {
    for (auto& test : action["tests"]) test.erase("boxes");  // those are for --out
  }
  if (!state.simulated.empty()) {
    auto& all = document["simulated"] = PrettyJson::array();
    for (const auto& test : state.simulated) all.push_back(simulated_json(test));
  }
  return document;
}

PrettyJson states_json(const harness::StartResult& about, std::size_t proved) {
  PrettyJson out = {{"all", about.all ? PrettyJson(*about.all) : PrettyJson()}, {"proved", proved}};
  if (!about.unrealisable.empty()) out["unrealisable"] = about.unrealisable;
  return out;
}

/// "from TrolleyAt(onWay) (initial state 2 of 6)"; empty where there is one.
std::string from_text(const harness::GeometryCertificate& certificate,
                      const harness::StartResult& about) {
  if (certificate.initial_state == 0) return {};
  return fmt::format("from {} (initial state {} of {})", certificate.holds,
                     certificate.initial_state, harness::states_text(about));
}

std::string actions_text(const ProvedState& state) {
  std::string text;
  std::size_t index = 0;
  for (const auto& action : state.certificate.actions) {
    text += fmt::format("  {:>2}  {}\n", action.number, action.event);
    if (!action.left_to_simulation.empty()) {
      text += fmt::format("      left to simulation: {}\n", action.left_to_simulation);
    }
    for (const auto& test : action.tests) {
      text += fmt::format("      {} ({}): {}\n", test.test.function, test.test.source,
                          test.test.statement);
      using harness::BoxVerdict;
      text += fmt::format("      safe     {}  {}\n", proved(test.safe),
                          boxes_text(test, BoxVerdict::kSafe));
      text += fmt::format("      refuted  {}  {}\n", proved(test.refuted),
                          boxes_text(test, BoxVerdict::kRefuted));
      text += fmt::format("      open     {}  {}\n", open_share(test.open),
                          boxes_text(test, BoxVerdict::kOpen));
      for (const auto& what : test.assumed) text += "      given      " + what + "\n";
      if (index < state.simulated.size()) text += simulated_text(state.simulated[index]);
      ++index;
    }
  }
  return text;
}

}  // namespace

bool Proved::are_all() const {
  if (one_asked || about.is_single()) return true;
  return about.all && std::ssize(states) + std::ssize(about.unrealisable) >= *about.all;
}

std::string proof_json(const Proved& proved) {
  const auto count = proved.states.size();
  if (proved.about.is_single() || (proved.one_asked && count == 1)) {
    auto document = state_document(proved.states.front());
    if (!proved.about.is_single()) document["initial_states"] = states_json(proved.about, count);
    return base::json_text(document) + "\n";
  }
  PrettyJson document = {{"status", proved.are_all() ? "ok" : "incomplete"},
                         {"trace", proved.trace},
                         {"events", proved.events},
                         {"initial_states", states_json(proved.about, count)}};
  auto& states = document["states"] = PrettyJson::array();
  for (const auto& state : proved.states) states.push_back(state_document(state));
  return base::json_text(document) + "\n";
}

std::string proof_text(const Proved& proved) {
  std::string text = fmt::format("trace {}: {}\n", proved.trace, proved.events);
  const auto& about = proved.about;
  if (!about.is_single()) {
    const auto count = proved.states.size();
    text += about.all && std::ssize(proved.states) == *about.all
                ? fmt::format("proved in each of {} initial states\n", count)
                : fmt::format("proved in {} of {} initial states\n", count,
                              harness::states_text(about));
    constexpr std::size_t kMostShown = 3;
    for (std::size_t i = 0; i < std::min(kMostShown, about.unrealisable.size()); ++i) {
      text += "no start realises " + about.unrealisable[i] + "\n";
    }
    if (about.unrealisable.size() > kMostShown) {
      text += fmt::format("no start realises {} more\n", about.unrealisable.size() - kMostShown);
    }
  }
  for (const auto& state : proved.states) {
    if (!about.is_single()) text += from_text(state.certificate, about) + '\n';
    text += actions_text(state);
  }
  return text;
}

std::string check_json(const harness::GeometryCertificate& certificate,
                       const harness::StartResult& about, const harness::CertificateCheck& result,
                       const std::vector<harness::SimulatedTest>& simulated) {
  nlohmann::ordered_json document = {{"status", status_of(result)},
                                     {"confirmed", result.confirmed},
                                     {"unconfirmed", result.unconfirmed},
                                     {"wrong", result.wrong},
                                     {"trace", certificate.trace}};
  if (certificate.initial_state > 0) {
    document["initial_state"] = {{"number", certificate.initial_state},
                                 {"holds", certificate.holds}};
    document["initial_states"] = states_json(about, 1);
  }
  document["assumptions"] =
      base::parse_ordered_json(harness::certificate_json(certificate))["assumptions"];
  auto& tests = document["tests"] = nlohmann::ordered_json::array();
  for (const auto& test : result.tests) {
    tests.push_back({{"number", test.number},
                     {"event", test.event},
                     {"function", test.function},
                     {"assumed", test.assumed},
                     {"confirmed", test.confirmed},
                     {"unconfirmed", test.unconfirmed},
                     {"wrong", test.wrong},
                     {"safe", test.safe},
                     {"refuted", test.refuted}});
  }
  for (const auto& test : simulated) document["simulated"].push_back(simulated_json(test));
  return base::json_text(document) + "\n";
}

std::string check_text(const harness::GeometryCertificate& certificate,
                       const harness::StartResult& about, const harness::CertificateCheck& result,
                       const std::vector<harness::SimulatedTest>& simulated) {
  std::string text = fmt::format("{} boxes confirmed, {} not confirmed, {} wrong\n",
                                 result.confirmed, result.unconfirmed, result.wrong);
  if (const auto from = from_text(certificate, about); !from.empty()) text += from + '\n';
  for (std::size_t i = 0; i < result.tests.size(); ++i) {
    const auto& test = result.tests[i];
    text += fmt::format("  {:>2}  {}, {}: confirmed of the start region safe {}, refuted {}\n",
                        test.number, test.event, test.function, proved(test.safe, 0),
                        proved(test.refuted, 0));
    for (const auto& what : test.assumed) text += "      given      " + what + "\n";
    if (i < simulated.size()) text += simulated_text(simulated[i]);
  }
  const char* head = "assumed   ";
  for (const auto& line : harness::assumption_lines(certificate.assumptions)) {
    text += fmt::format("{}{}\n", head, line);
    head = "          ";
  }
  if (result.confirmed == 0) text += "nothing was confirmed\n";
  return text;
}

}  // namespace parallax::tools
