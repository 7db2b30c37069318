#include "tools/bench/mistakes/mistake_bench.h"

#include <algorithm>
#include <chrono>
#include <numeric>

namespace parallax::tools {
namespace {

constexpr int kFirstDouble = 1000;

/// All numbers below `count` once, neighbours far from each other.
std::vector<std::size_t> spread(std::size_t count) {
  std::vector<std::size_t> out;
  if (count == 0) return out;
  auto step = static_cast<std::size_t>(0.618 * static_cast<double>(count)) + 1;
  while (std::gcd(step, count) != 1) ++step;
  for (std::size_t i = 0; i < count; ++i) out.push_back(i * step % count);
  return out;
}

/// One world on its way through the bench.
struct Course {
  MistakeTrial trial;
  std::vector<Mistake> mistakes;
  std::vector<std::size_t> order;
  std::size_t next = 0;
  std::vector<std::size_t> shown = {};  // numbers of single mistakes that the first plan shows
  std::size_t next_double = 0;
};

/// The i-th pair of such mistakes in different lines, or none if there are too few.
std::vector<Mistake> pair_of(const Course& course, std::size_t i) {
  const auto count = course.shown.size();
  for (std::size_t further = 1; further < count; ++further) {
    const auto a = course.shown[i * 2 % count];
    const auto b = course.shown[(i * 2 + count / 2 + further) % count];
    const auto &one = course.mistakes[a], &other = course.mistakes[b];
    if (one.line != other.line && one.kind != other.kind) return {one, other};
  }
  return {};
}

}  // namespace

std::vector<MistakeOutcome> measure_mistakes(const MistakeBenchOptions& options,
                                             const std::vector<MistakeOutcome>& known,
                                             const std::function<void(const MistakeOutcome&)>& told,
                                             std::string& error) {
  const auto begin = std::chrono::steady_clock::now();
  const auto is_over = [&] {
    const std::chrono::duration<double> gone = std::chrono::steady_clock::now() - begin;
    return gone.count() > options.seconds;
  };
  std::vector<MistakeOutcome> outcomes;
  const auto measured = [&](const Course& course, const std::string& world,
                            const std::vector<Mistake>& mistakes, int number) {
    const auto found = std::find_if(known.begin(), known.end(), [&](const auto& outcome) {
      return outcome.world == world && outcome.number == number;
    });
    outcomes.push_back(found != known.end() ? *found : course.trial.measure(mistakes, number));
    if (found == known.end()) told(outcomes.back());
    return outcomes.back();
  };
  std::vector<std::pair<std::string, Course>> courses;
  for (const auto& world : mistake_worlds()) {
    const auto& named = options.worlds;
    if (!named.empty() && std::find(named.begin(), named.end(), world.name) == named.end()) {
      continue;
    }
    auto trial = MistakeTrial::make(world, options.trial, error);
    if (!trial) return outcomes;
    auto mistakes = make_mistakes(trial->model(), options.per_kind);
    auto order = spread(mistakes.size());
    order.resize(std::min(order.size(), options.at_most));
    courses.emplace_back(world.name, Course{std::move(*trial), std::move(mistakes), order});
  }
  bool goes_on = true;
  while (goes_on && !is_over()) {
    goes_on = false;
    for (auto& [world, course] : courses) {
      if (course.next == course.order.size() || is_over()) continue;
      goes_on = true;
      const auto at = course.order[course.next++];
      const auto outcome = measured(course, world, {course.mistakes[at]}, static_cast<int>(at));
      if (outcome.shown == Shown::kFirstPlan) course.shown.push_back(at);
    }
  }
  for (std::size_t i = 0; i < options.doubles; ++i) {
    for (auto& [world, course] : courses) {
      const auto mistakes = pair_of(course, i);
      if (mistakes.empty() || is_over()) continue;
      measured(course, world, mistakes, kFirstDouble + static_cast<int>(i));
    }
  }
  return outcomes;
}

}  // namespace parallax::tools
