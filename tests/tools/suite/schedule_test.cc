#include "tools/suite/schedule.h"

#include <doctest/doctest.h>

#include <atomic>
#include <random>
#include <thread>
#include <vector>

namespace parallax::tools {
namespace {

TEST_CASE("unknown cases go first, then the longest, equal ones in their order") {
  Schedule schedule({{0, 1.0, 0}, {1, 5.0, 0}, {2, std::nullopt, 0}, {3, 5.0, 0}, {4, 0.1, 0}}, 0);
  std::vector<std::size_t> order;
  while (const auto next = schedule.take()) order.push_back(*next);
  CHECK(order == std::vector<std::size_t>{2, 1, 3, 0, 4});
}

TEST_CASE("what needs more than all the memory runs alone, and the others fill the gaps") {
  Schedule schedule({{0, 9.0, 700}, {1, 8.0, 600}, {2, 7.0, 300}, {3, 6.0, 5000}}, 1000);
  CHECK(schedule.take() == 0);
  CHECK(schedule.take() == 2);  // the second does not fit beside the first
  schedule.done(0);
  CHECK(schedule.take() == 1);
  schedule.done(2);
  schedule.done(1);
  CHECK(schedule.take() == 3);
  CHECK_FALSE(schedule.take().has_value());
}

TEST_CASE("threads never hold more memory than there is, and every case has its turn") {
  std::mt19937 random(7);
  std::vector<Task> tasks;
  std::vector<std::int64_t> needs;
  for (std::size_t i = 0; i < 300; ++i) {
    needs.push_back(static_cast<std::int64_t>(random() % 900) + 1);
    tasks.push_back({i, static_cast<double>(random() % 50), needs.back()});
  }
  Schedule schedule(std::move(tasks), 1000);
  std::atomic<std::int64_t> used{0}, most{0};
  std::atomic<std::size_t> done{0};
  const auto work = [&] {
    while (const auto next = schedule.take()) {
      const auto now = used += needs[*next];
      for (auto seen = most.load(); now > seen && !most.compare_exchange_weak(seen, now);) {
      }
      std::this_thread::yield();
      used -= needs[*next];
      ++done;
      schedule.done(*next);
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) threads.emplace_back(work);
  for (auto& thread : threads) thread.join();
  CHECK(done == 300);
  CHECK(most <= 1000);
}

}  // namespace
}  // namespace parallax::tools
