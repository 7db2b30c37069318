#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "harness/cluster/fleet.h"
#include "harness/cluster/worker_link.h"
#include "harness/simulator/pose_intake.h"

namespace parallax::harness {

/// The number of failed attempts in a row to start a worker after which a slot is given up.
inline constexpr std::int64_t kMostStarts = 3;
/// Likewise for workers in a row that were lost before they finished one simulation. Where a lost
/// simulation is made again elsewhere, the simulation itself may end its workers. The limit is then
/// above the number of assignments of one simulation (kMostAssignments of the pool).
inline constexpr std::int64_t kMostLosses = 5, kMostLossesWithRepeats = 20;

/// A simulator that a worker of this program serves, started through the prefix of a slot. A worker
/// that dies, says what is not the protocol or gives no sign of life is ended with its launcher,
/// and started again when it is needed; what it says after that reaches nobody.
class RemoteWorker final : public RemoteSimulator {
 public:
  RemoteWorker(std::shared_ptr<Fleet> fleet, std::vector<std::string> worker);
  ~RemoteWorker() override;

  bool ready() override;
  void throw_when_gone(bool throws) override { throws_ = throws; }
  void interrupt() override { interrupted_.store(true); }
  std::string kind() const override { return kind_; }

  SimulatorInfo info() override { return info_; }
  Outcome reset(const State& initial, std::uint64_t seed) override;
  Outcome act(std::string_view action, const State& arguments, double sim_time_limit_s) override;
  State observe() override;
  void record_motion(double interval_s) override { record_interval_s_ = interval_s; }

 private:
  bool start();
  bool shake_hands();
  void pause(double seconds) const;
  void lose(std::string reason);
  Outcome outcome_of(std::variant<ReplyBody, std::string> reply);

  std::shared_ptr<Fleet> fleet_;
  std::vector<std::string> worker_;
  std::atomic<bool> interrupted_ = false;
  bool throws_ = false;
  std::optional<Fleet::Slot> slot_;
  std::int64_t failed_starts_ = 0, losses_ = 0;  // in a row, at this slot
  std::int64_t resets_ = 0;                      // of this worker
  std::string why_;                              // the last start failed, or the worker was lost
  std::unique_ptr<WorkerLink> link_;             // null: there is no worker
  SimulatorInfo info_;
  std::string kind_;  // of the last worker, where they may be of several
  double record_interval_s_ = 0.0;
  PoseIntake poses_;
};

}  // namespace parallax::harness
