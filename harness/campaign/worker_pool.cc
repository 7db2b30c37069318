#include "harness/campaign/worker_pool.h"

#include <chrono>
#include <system_error>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

constexpr auto kStopSlice = std::chrono::milliseconds(50);  // how late the stop flag may be seen

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
  }
  changed_.notify_all();
  for (auto& thread : threads_) thread.join();
  threads_.clear();
}

void WorkerPool::abandon() {
  const std::lock_guard lock(mutex_);
  ++generation_;
  queue_.clear();
  results_.clear();
}

void WorkerPool::submit(Job job) {
  {
    const std::lock_guard lock(mutex_);
    job.generation = generation_;
    queue_.push_back(std::move(job));
  }
  changed_.notify_all();
}

void WorkerPool::submit(std::shared_ptr<const SampleMaker> maker, std::int64_t sample) {
  submit(Job{std::move(maker), sample, std::nullopt, 0});
}

void WorkerPool::submit_repeat(std::shared_ptr<const SampleMaker> maker, SampleRecord record) {
  const auto sample = record.sample;
  submit(Job{std::move(maker), sample, std::move(record), 0});
}

/// The flag is raised by a signal handler, which cannot notify; so it is looked at now and then.
template <typename Ready>
bool WorkerPool::wait_until(std::unique_lock<std::mutex>& lock, Ready ready) {
  while (!ready()) {
    if (thrown_) std::rethrow_exception(thrown_);
    if (stopped()) return false;
    changed_.wait_for(lock, kStopSlice);
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
    if (worker == 0) {
      simulator = make_simulator_();
      PARALLAX_REQUIRE(simulator != nullptr, "the factory makes a simulator");
      auto info = simulator->info();
      const std::lock_guard lock(mutex_);
      info_ = std::move(info);
    }
    changed_.notify_all();
    serve_jobs(simulator.get());
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!thrown_) thrown_ = std::current_exception();
    changed_.notify_all();
  }
}

void WorkerPool::serve_jobs(Simulator* simulator) {
  std::unique_ptr<Simulator> own;
  for (;;) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closing_ || !queue_.empty(); });
    if (closing_) return;
    const Job job = std::move(queue_.front());
    queue_.pop_front();
    lock.unlock();
    if (simulator == nullptr) {
      own = make_simulator_();
      PARALLAX_REQUIRE(own != nullptr, "the factory makes a simulator");
      simulator = own.get();
    }
    MotionTap tap(*simulator, static_cast<bool>(moved_));
    simulate(job, tap);
  }
}

void WorkerPool::simulate(const Job& job, MotionTap& simulator) {
  const auto abandoned = [&] { return closing_ || generation_ != job.generation || stopped(); };
  auto record = job.repeat ? job.maker->repeat(*job.repeat, simulator, abandoned)
                           : job.maker->make(job.sample, simulator, abandoned);
  if (!record) return;
  if (moved_) moved_(*record, simulator.log());
  finished_(*record);
  ++runs_made_;
  const std::lock_guard lock(mutex_);
  for (const auto& outcome : record->outcomes) simulated_s_ += outcome.sim_time_s;
  if (generation_ == job.generation) {
    const Key key(record->sample, record->phase);
    results_.insert_or_assign(key, std::move(*record));
  }
  changed_.notify_all();
}

}  // namespace parallax::harness
