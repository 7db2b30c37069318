#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "harness/conformance/conformance.h"
#include "harness/conformance/protocol_probe.h"
#include "harness/conformance/run_record.h"

namespace parallax::harness {

/// The seed of the first reset, and further seeds whose results are compared with it.
inline constexpr std::uint64_t kTriedSeeds[] = {1, 2, 3, (std::uint64_t{1} << 53U) - 1};

std::optional<double> numeric(const Value& value);
inline bool is_ready(const Outcome& outcome) { return outcome.status == SimStatus::kOk; }

/// A whole check, from the first process to the claims.
class Conformance {
 public:
  explicit Conformance(const ConformanceOptions& options)
      : options_(options), starts_(options.starts), actions_(options.actions) {
    report_.states = options.states;
  }

  ConformanceReport run();

 private:
  // Asking.
  bool connect();
  ProtocolProbe& probe() { return *probe_; }
  bool given_up() const;
  bool stopped() const { return options_.process.stop != nullptr && *options_.process.stop; }
  std::optional<ReplyBody> ask(RequestBody body, double timeout_s, bool unknown_field = false);
  /// None: it was lost. A refusal by an error is kUnsupported.
  std::optional<Outcome> outcome_of(RequestBody body, double timeout_s, bool unknown_field = false);
  std::optional<Outcome> reset(const State& start, std::uint64_t seed);
  std::optional<Outcome> act(const TriedAction& action, double limit_s);
  std::optional<State> observe();
  std::optional<RunRecord> record(const State& start, std::uint64_t seed);
  /// The same run by one request.
  std::optional<RunRecord> performed(const State& start, std::uint64_t seed);
  double act_timeout_s(double limit_s) const;
  void lost(const std::string& trouble);
  double time_slack_s() const { return 2.0 * report_.info.timestep_s; }

  // Saying.
  void fault(std::string text) { find(true, std::move(text)); }
  void warn(std::string text) { find(false, std::move(text)); }
  void find(bool is_fault, std::string text);
  void say(CheckKind kind, std::string what) { note(kind, true, std::move(what)); }
  void skip(CheckKind kind, std::string why) { note(kind, false, std::move(why)); }
  void note(CheckKind kind, bool was_made, std::string what);

  // The checks.
  bool check_handshake();
  void choose_starts();
  void choose_actions();
  void check_resets();
  void check_start(const State& start, const State& seen);
  void check_actions();
  void check_determinism();
  void check_seeds();
  void check_wear();
  void check_invalid_starts();
  void check_refused(const char* what, const State& start, bool may_be_invalid);
  void check_unknown();
  void check_time_limit();
  bool shows_a_clock();
  void check_start_up();
  bool tell_drift(const std::vector<RunRecord>& early, const std::vector<RunRecord>& late);
  std::vector<RunRecord> several_runs(std::chrono::steady_clock::time_point until);
  void check_timing();
  void check_units();
  void check_end();
  void add_claims();

  const ConformanceOptions& options_;
  ConformanceReport report_;
  CheckKind now_ = CheckKind::kHandshake;
  std::unique_ptr<ProtocolProbe> probe_;
  int losses_ = 0;
  bool connected_once_ = false;
  std::vector<State> starts_;
  std::vector<TriedAction> actions_;
  std::optional<RunRecord> first_;  // of the first start and seed
  std::vector<State> seen_;
  std::set<std::string> said_;
  bool noise_seen_ = false, seeds_fine_ = true, wears_ = false, looks_alike_ = false;
  std::optional<bool> jobs_work_;  // none: not tried
  double hello_wall_s_ = 0.0;
  bool reset_before_ = false;  // by the process that lives
  std::vector<double> first_reset_walls_s_, later_reset_walls_s_;
  double most_sim_time_said_s_ = 0.0;  // of any action
  double acted_wall_s_ = 0.0, acted_sim_s_ = 0.0;
  bool has_margins_ = false;
};

}  // namespace parallax::harness
