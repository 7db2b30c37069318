// Order in which the cases of a suite are started.
//
// Cases with unknown time come first, then the longest (longest processing time first, Graham
// 1969), so that no long one is left for the end. A thread takes the first waiting case that the
// memory in use leaves room for; smaller cases may overtake one that has to wait. A case that
// needs more than all the memory runs when nothing else does. Cost: linear in the waiting cases
// for each start.

#include "tools/suite/schedule.h"

#include <algorithm>
#include <limits>

namespace parallax::tools {

Schedule::Schedule(std::vector<Task> tasks, std::int64_t memory_mb)
    : tasks_(std::move(tasks)), memory_mb_(memory_mb) {
  const auto expected = [](const Task& task) {
    return task.wall_s.value_or(std::numeric_limits<double>::infinity());
  };
  std::stable_sort(tasks_.begin(), tasks_.end(),
                   [&](const Task& a, const Task& b) { return expected(a) > expected(b); });
}

std::optional<std::size_t> Schedule::take() {
  std::unique_lock lock(mutex_);
  while (!tasks_.empty()) {
    const auto fits = [&](const Task& task) {
      return memory_mb_ == 0 || running_.empty() || used_mb_ + task.memory_mb <= memory_mb_;
    };
    const auto next = std::find_if(tasks_.begin(), tasks_.end(), fits);
    if (next == tasks_.end()) {
      changed_.wait(lock);
      continue;
    }
    const auto task = *next;
    tasks_.erase(next);
    used_mb_ += task.memory_mb;
    running_.push_back(task);
    return task.index;
  }
  return std::nullopt;
}

void Schedule::done(std::size_t index) {
  {
    const std::lock_guard lock(mutex_);
    const auto task = std::find_if(running_.begin(), running_.end(),
                                   [&](const Task& one) { return one.index == index; });
    if (task == running_.end()) return;
    used_mb_ -= task->memory_mb;
    running_.erase(task);
  }
  changed_.notify_all();
}

}  // namespace parallax::tools
