#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "harness/campaign/motion_tap.h"
#include "harness/campaign/sample_runner.h"

namespace parallax::harness {

/// A simulation whose worker is gone is begun anew so often, where that gives the same run.
inline constexpr std::int64_t kMostAssignments = 10;

/// Threads that own one simulator each and make samples of one stream at a time. Which worker
/// simulates a sample, and when, shows nowhere: the caller waits for samples in its own order.
///
/// Simulators may be somewhere else (RemoteSimulator). Where they promise that the same start and
/// seed give the same run, a simulation whose worker is gone is given to another one, and one that
/// takes much longer than others is also given to a worker that has nothing to do: what is finished
/// first counts, and the other one is ignored. Elsewhere a simulation is given away once, and is
/// lost with its worker: a second attempt would be another draw, and slow failures would be outrun.
class WorkerPool {
 public:
  /// `finished` is called in the worker's thread for each simulation, before `wait` returns it;
  /// `moved` before that, with what moved. Without it no simulator is asked what does.
  WorkerPool(std::int64_t jobs, SimulatorFactory make_simulator,
             std::function<void(const SampleRecord&)> finished, const std::atomic<bool>* stop,
             std::function<void(const SampleRecord&, const MotionLog&)> moved = {});
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// The info of the first worker's simulator. None when stopped.
  std::optional<SimulatorInfo> info();

  void submit(std::shared_ptr<const SampleMaker> maker, std::int64_t sample);
  /// Simulates the start of `record` again; wait for it with DrawPhase::kConfirm.
  void submit_repeat(std::shared_ptr<const SampleMaker> maker, SampleRecord record);
  /// The result of a submitted sample. None when the stop flag was raised. What a worker threw is
  /// thrown again here.
  std::optional<SampleRecord> wait(std::int64_t sample, DrawPhase phase);
  /// Forgets everything submitted; what is under way ends after its current action.
  void abandon();
  /// abandon, and wait for the workers to end. Nothing may be submitted afterwards.
  void close();

  std::int64_t runs_made() const { return runs_made_; }
  double simulated_s() const;

 private:
  using Key = std::pair<std::int64_t, DrawPhase>;
  using Clock = std::chrono::steady_clock;
  /// The state shared by workers that run the same simulation.
  struct Flight {
    std::atomic<bool> done = false;
    std::int64_t copies = 0, assignments = 0;  // under the lock
    Clock::time_point begun;                   // likewise: the first of them
  };
  struct Job {
    std::shared_ptr<const SampleMaker> maker;
    std::int64_t sample = 0;
    std::optional<SampleRecord> repeat;
    std::uint64_t generation = 0;
    std::shared_ptr<Flight> flight = std::make_shared<Flight>();
    Key key() const { return {sample, repeat ? DrawPhase::kConfirm : DrawPhase::kCertify}; }
  };

  void work(std::size_t worker);
  void serve_jobs(Simulator* simulator);
  void serve_elsewhere(Simulator& simulator);
  void simulate(const Job& job, Simulator& simulator);
  void submit(Job job);
  // These are called under the lock.
  bool has_job() const { return !queue_.empty() || straggler() != nullptr; }
  const Job* straggler() const;
  std::optional<Job> take_job();

  void put_back(const Job& job);
  bool claim(const Job& job, SampleStatus status, Clock::duration took);
  template <typename Ready>
  bool wait_until(std::unique_lock<std::mutex>& lock, Ready ready);
  bool stopped() const { return stop_ != nullptr && stop_->load(); }

  SimulatorFactory make_simulator_;
  std::function<void(const SampleRecord&)> finished_;
  std::function<void(const SampleRecord&, const MotionLog&)> moved_;
  const std::atomic<bool>* stop_;
  std::atomic<std::uint64_t> generation_ = 0;
  std::atomic<bool> closing_ = false;
  std::atomic<std::int64_t> runs_made_ = 0;

  mutable std::mutex mutex_;      // guards what follows
  std::condition_variable work_;  // for workers: there is a job, or an end
  std::condition_variable done_;  // for the caller: there is a result, or a fault
  std::deque<Job> queue_;
  std::map<Key, SampleRecord> results_;  // of this generation
  std::optional<SimulatorInfo> info_;
  bool elsewhere_ = false;                    // simulators are
  bool repeats_ = false;                      // see may_repeat_losses
  std::map<Key, Job> under_way_;              // of this generation
  std::chrono::duration<double> spent_{0.0};  // on finished simulations
  std::int64_t finished_runs_ = 0;
  std::set<RemoteSimulator*> remotes_;
  std::exception_ptr thrown_;
  double simulated_s_ = 0.0;
  std::vector<std::thread> threads_;
};

}  // namespace parallax::harness
