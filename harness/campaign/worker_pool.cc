// Threads with a simulator each that take simulations from one queue, in any order.
//
// Results are asked for by sample and phase, so the order in which they are ready decides
// nothing. A worker elsewhere may be slow or vanish. When a simulation is repeatable, it is
// therefore given to a second worker if it has taken twice the average and the queue is empty,
// the oldest first; the first result counts. A simulation whose worker is gone goes back to the
// front of the queue unless another worker is still at it. To abandon all work a generation is
// counted up: jobs of an older one end at their next look and their results are dropped. The
// stop flag is raised by a signal handler, which cannot notify, so it is looked at now and then.
//
// There may be a thousand workers. Each job wakes one of those that wait, each result only the
// caller; workers elsewhere that have nothing to do look for late simulations now and then, the
// more of them the less often.
//
// Cost: a job is taken in constant time; the look for a late one is linear in the jobs under
// way.

#include "harness/campaign/worker_pool.h"

#include <algorithm>
#include <system_error>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

constexpr auto kStopSlice = std::chrono::milliseconds(50);  // how late the stop flag may be seen
// Idle threads look for late simulations; beyond so many workers each looks less often.
constexpr std::int64_t kBusyWatchers = 64;

// A simulation is also given to a second worker once it has taken this many times the average. A
// run is rarely that long by itself, and the second worker had nothing to do.
constexpr double kStragglerFactor = 2.0;
constexpr std::chrono::duration<double> kStragglerLeast{0.1};

}  // namespace

WorkerPool::WorkerPool(std::int64_t jobs, SimulatorFactory make_simulator,
                       std::function<void(const SampleRecord&)> finished,
                       const std::atomic<bool>* stop,
                       std::function<void(const SampleRecord&, const MotionLog&)> moved)
    : make_simulator_(std::move(make_simulator)),
      finished_(std::move(finished)),
      moved_(std::move(moved)),
      stop_(stop) {
  PARALLAX_REQUIRE(jobs >= 1, "at least one job");
  for (std::int64_t i = 0; i < jobs; ++i) {
    try {
      threads_.emplace_back([this, i] { work(static_cast<std::size_t>(i)); });
    } catch (const std::system_error&) {
      if (threads_.empty()) throw;  // nobody is left to do the work
      break;                        // fewer workers give the same results later
    }
  }
}

WorkerPool::~WorkerPool() { close(); }

void WorkerPool::close() {
  abandon();
  {
    // Under the lock, or a worker that has just found it false would sleep through the call.
    const std::lock_guard lock(mutex_);
    closing_ = true;
    for (auto* remote : remotes_) remote->interrupt();
  }
  work_.notify_all();
  for (auto& thread : threads_) thread.join();
  threads_.clear();
}

void WorkerPool::abandon() {
  const std::lock_guard lock(mutex_);
  ++generation_;
  queue_.clear();
  results_.clear();
  under_way_.clear();
}

void WorkerPool::submit(Job job) {
  {
    const std::lock_guard lock(mutex_);
    job.generation = generation_;
    queue_.push_back(std::move(job));
  }
  work_.notify_one();
}

void WorkerPool::submit(std::shared_ptr<const SampleMaker> maker, std::int64_t sample) {
  submit(Job{std::move(maker), sample, std::nullopt});
}

void WorkerPool::submit_repeat(std::shared_ptr<const SampleMaker> maker, SampleRecord record) {
  const auto sample = record.sample;
  submit(Job{std::move(maker), sample, std::move(record)});
}

/// The flag is raised by a signal handler, which cannot notify; so it is looked at now and then.
template <typename Ready>
bool WorkerPool::wait_until(std::unique_lock<std::mutex>& lock, Ready ready) {
  while (!ready()) {
    if (thrown_) std::rethrow_exception(thrown_);
    if (stopped()) return false;
    done_.wait_for(lock, kStopSlice);
  }
  return true;
}

std::optional<SimulatorInfo> WorkerPool::info() {
  std::unique_lock lock(mutex_);
  if (!wait_until(lock, [&] { return info_.has_value(); })) return std::nullopt;
  return info_;
}

std::optional<SampleRecord> WorkerPool::wait(std::int64_t sample, DrawPhase phase) {
  std::unique_lock lock(mutex_);
  const Key key(sample, phase);
  if (stopped() || !wait_until(lock, [&] { return results_.contains(key); })) return std::nullopt;
  return std::move(results_.extract(key).mapped());
}

double WorkerPool::simulated_s() const {
  const std::lock_guard lock(mutex_);
  return simulated_s_;
}

void WorkerPool::work(std::size_t worker) {
  try {
    std::unique_ptr<Simulator> simulator;
    // One worker starts at once to say who it is; the others wait until there is something to do.
    // Of those that are elsewhere all start: any of them may be slow, or never come.
    if (worker == 0) {
      simulator = make_simulator_();
      PARALLAX_REQUIRE(simulator != nullptr, "the factory makes a simulator");
      std::optional<SimulatorInfo> info;
      if (simulator->remote() == nullptr) info = simulator->info();
      {
        const std::lock_guard lock(mutex_);
        elsewhere_ = !info;
        info_ = std::move(info);
      }
      work_.notify_all();
      done_.notify_all();
    } else {
      std::unique_lock lock(mutex_);
      work_.wait(lock, [&] { return closing_ || elsewhere_ || !queue_.empty(); });
      if (closing_) return;
      if (elsewhere_) {
        lock.unlock();
        simulator = make_simulator_();
        PARALLAX_REQUIRE(simulator != nullptr, "the factory makes a simulator");
      }
    }
    if (simulator && simulator->remote() != nullptr) {
      serve_elsewhere(*simulator);
    } else {
      serve_jobs(simulator.get());
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!thrown_) thrown_ = std::current_exception();
    done_.notify_all();
  }
}

void WorkerPool::serve_jobs(Simulator* simulator) {
  std::unique_ptr<Simulator> own;
  for (;;) {
    std::unique_lock lock(mutex_);
    work_.wait(lock, [&] { return closing_ || !queue_.empty(); });
    if (closing_) return;
    const Job job = *take_job();
    lock.unlock();
    if (simulator == nullptr) {
      own = make_simulator_();
      PARALLAX_REQUIRE(own != nullptr, "the factory makes a simulator");
      simulator = own.get();
    }
    simulate(job, *simulator);
  }
}

void WorkerPool::serve_elsewhere(Simulator& simulator) {
  auto& remote = *simulator.remote();
  // Whatever ends this, nobody is interrupted who is gone.
  struct Leave {
    WorkerPool& pool;
    RemoteSimulator& remote;
    ~Leave() {
      const std::lock_guard lock(pool.mutex_);
      pool.remotes_.erase(&remote);
    }
  };
  const Leave leave{*this, remote};
  {
    const std::lock_guard lock(mutex_);
    remotes_.insert(&remote);
    if (closing_) remote.interrupt();
  }
  // A job is taken when a worker is there to do it, and by nobody who still waits for one.
  while (remote.ready()) {
    std::unique_lock lock(mutex_);
    if (!info_) {
      info_ = remote.info();
      repeats_ = may_repeat_losses(*info_);
      done_.notify_all();
    }
    const auto slice = kStopSlice * (1 + std::ssize(remotes_) / kBusyWatchers);
    while (!closing_ && !has_job()) work_.wait_for(lock, slice);
    if (closing_) break;
    lock.unlock();
    if (!remote.ready()) break;
    lock.lock();
    const auto job = take_job();
    if (!job) continue;
    remote.throw_when_gone(repeats_ && job->flight->assignments < kMostAssignments);
    lock.unlock();
    simulate(*job, simulator);
  }
}

const WorkerPool::Job* WorkerPool::straggler() const {
  if (!repeats_ || finished_runs_ == 0) return nullptr;
  const auto mean = spent_ / static_cast<double>(finished_runs_);
  const auto limit = std::max(kStragglerLeast, kStragglerFactor * mean);
  const Job* oldest = nullptr;
  for (const auto& [key, job] : under_way_) {
    const auto& flight = *job.flight;
    if (flight.copies != 1 || Clock::now() - flight.begun < limit) continue;
    if (oldest == nullptr || flight.begun < oldest->flight->begun) oldest = &job;
  }
  return oldest;
}

std::optional<WorkerPool::Job> WorkerPool::take_job() {
  Job job;
  if (!queue_.empty()) {
    job = std::move(queue_.front());
    queue_.pop_front();
    job.flight->begun = Clock::now();
    under_way_.insert_or_assign(job.key(), job);
  } else if (const auto* late = straggler()) {
    job = *late;
  } else {
    return std::nullopt;
  }
  ++job.flight->copies;
  ++job.flight->assignments;
  return job;
}

/// The worker that was at it is gone. If nobody else is, it is the next one to be done.
void WorkerPool::put_back(const Job& job) {
  {
    const std::lock_guard lock(mutex_);
    auto& flight = *job.flight;
    if (--flight.copies > 0 || flight.done || generation_ != job.generation) return;
    under_way_.erase(job.key());
    queue_.push_front(job);
  }
  work_.notify_one();
}

/// Is it the first result of this simulation? Later ones do not count, nor does a loss while
/// another worker is still at it.
bool WorkerPool::claim(const Job& job, SampleStatus status, Clock::duration took) {
  const std::lock_guard lock(mutex_);
  if (status == SampleStatus::kLost && job.flight->copies > 1) {
    --job.flight->copies;
    return false;
  }
  if (job.flight->done.exchange(true)) return false;
  if (generation_ == job.generation) under_way_.erase(job.key());
  spent_ += took;
  ++finished_runs_;
  return true;
}

void WorkerPool::simulate(const Job& job, Simulator& simulator) {
  const auto abandoned = [&] {
    return closing_ || generation_ != job.generation || job.flight->done || stopped();
  };
  const auto begun = Clock::now();
  MotionTap tap(simulator, static_cast<bool>(moved_));
  std::optional<SampleRecord> record;
  try {
    record = job.repeat ? job.maker->repeat(*job.repeat, tap, abandoned)
                        : job.maker->make(job.sample, tap, abandoned);
  } catch (const WorkerGone&) {
    return put_back(job);
  }
  if (!record || !claim(job, record->status, Clock::now() - begun)) return;
  if (const auto* remote = simulator.remote()) record->kind = remote->kind();
  if (moved_) moved_(*record, tap.log());
  if (finished_) finished_(*record);
  ++runs_made_;
  const std::lock_guard lock(mutex_);
  for (const auto& outcome : record->outcomes) simulated_s_ += outcome.sim_time_s;
  if (generation_ == job.generation) {
    const Key key(record->sample, record->phase);
    results_.insert_or_assign(key, std::move(*record));
  }
  done_.notify_all();
}

}  // namespace parallax::harness
