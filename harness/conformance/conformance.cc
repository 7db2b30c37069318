#include "harness/conformance/conformance.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/conformance/conformance_run.h"
#include "harness/simulator/protocol_check.h"
#include "harness/simulator/units.h"

namespace parallax::harness {

bool Conformance::check_handshake() {
  now_ = CheckKind::kHandshake;
  if (!connect()) {
    skip(now_, "it did not come to an end");
    return false;
  }
  const auto& info = report_.info;
  for (auto& text : info_faults(info)) fault(std::move(text));
  for (auto& text : info_oddities(info)) warn(std::move(text));
  const auto settable = std::count_if(info.parameters.begin(), info.parameters.end(),
                                      [](const Parameter& one) { return one.settable; });
  if (info.parameters.empty()) warn("it declares no variables, so no scenario can be checked");
  say(now_, fmt::format("{} variables ({} to be set), {} actions, {:.2f} s", info.parameters.size(),
                        settable, info.actions.size(), hello_wall_s_));
  return true;
}

void Conformance::check_units() {
  now_ = CheckKind::kUnits;
  for (auto& finding : unit_findings(report_.info, seen_)) {
    find(finding.is_fault, std::move(finding.text));
  }
  say(now_, fmt::format("{} variables in {} states", report_.info.parameters.size(), seen_.size()));
}

void Conformance::check_end() {
  now_ = CheckKind::kEnd;
  if (!connect()) return skip(now_, "it was given up");
  const double limit = options_.process.close_timeout_s;
  if (ask(CloseRequest{}, limit) && !probe().ended_by_itself(limit)) {
    fault(fmt::format("it does not end within {:g} s of `close`", limit));
  }
  probe_.reset();
  if (!connect()) return skip(now_, "it was given up");
  if (!probe().ended_by_itself(limit)) {
    fault(
        fmt::format("it does not end within {:g} s of the end of its input, so it stays behind "
                    "when the program that started it is killed",
                    limit));
  }
  probe_.reset();
  say(now_, "by `close`, and by the end of its input");
}

void Conformance::add_claims() {
  const auto& info = report_.info;
  auto& claims = report_.claims;
  const auto measured = report_.repeatability;
  const bool known = measured != Repeatability::kUnknown;
  claims.replay = !known                                  ? "unknown: no run came to its end"
                  : measured == Repeatability::kBitwise   ? "bitwise"
                  : measured == Repeatability::kTolerance ? "not to the bit; within the tolerance"
                                                          : "no: repeated runs end differently";
  const bool retries = info.seeds && info.determinism == "bitwise";
  claims.retries = !retries ? "no: the first loss counts"
                   : !known ? "yes, as it promises; unknown whether it keeps that"
                   : measured == Repeatability::kBitwise
                       ? "yes: a lost run is made again with its start and seed"
                       : "yes, and wrongly: a run that is made again is another one";
  claims.independence = !known   ? "unknown"
                        : wears_ ? "no: a run depends on those before it"
                        : measured == Repeatability::kNone
                            ? std::string(
                                  "only if its own randomness is independent from run to "
                                  "run, which no seed controls") +
                                  (looks_alike_ ? "; early and late runs look alike" : "")
                        : noise_seen_ && info.seeds && seeds_fine_
                            ? "yes: starts and seeds are drawn independently"
                        : noise_seen_ ? "only if it really uses the seed"
                                      : "yes: starts are drawn independently, and "
                                        "nothing else varies";
  claims.jobs = !jobs_work_ ? "unknown"
                : *jobs_work_
                    ? "yes"
                    : "no: two processes do not work side by side, each in a world of its own";
  claims.search = has_margins_ ? "yes: it gives margins"
                  : first_     ? "blind: it gives no margins"
                               : "unknown";
  claims.recordings = !connected_once_ ? "unknown"
                      : info.scene     ? "yes: it gives poses"
                                       : "no: it gives no poses";
  if (!connected_once_) claims.retries = "unknown";
}

ConformanceReport Conformance::run() {
  if (check_handshake() && (!options_.on_info || options_.on_info(report_.info))) {
    now_ = CheckKind::kReset;
    choose_starts();
    choose_actions();
    check_resets();
    if (starts_.empty()) {
      skip(CheckKind::kActions, "no start is known");
    } else {
      check_actions();
    }
    check_determinism();
    check_seeds();
    check_wear();
    check_invalid_starts();
    check_unknown();
    check_time_limit();
    check_start_up();
    check_timing();
    check_units();
    check_end();
    report_.complete = !given_up();
  }
  add_claims();
  return std::move(report_);
}

std::size_t ConformanceReport::faults() const {
  return static_cast<std::size_t>(
      std::count_if(findings.begin(), findings.end(),
                    [](const ConformanceFinding& finding) { return finding.is_fault; }));
}

ConformanceReport check_conformance(const ConformanceOptions& options) {
  return Conformance(options).run();
}

}  // namespace parallax::harness
