// The pool of workers with simulators on other machines, where they get lost: runs that are
// repeated, runs that are made twice, and runs that are lost.

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

#include "harness/campaign/worker_pool.h"

namespace parallax::harness {
namespace {

/// State that the workers of one test share: which of them fail and when, and the assignments.
struct Place {
  bool seeds = true;
  /// Given a sample and the number of its assignment, from 1: is the worker lost at it?
  std::function<bool(std::int64_t, std::int64_t)> goes = [](auto, auto) { return false; };
  /// Likewise: it hangs until it is interrupted, or released.
  std::function<bool(std::int64_t, std::int64_t)> hangs = [](auto, auto) { return false; };
  /// Workers there will ever be; below 0: any number.
  std::int64_t workers = -1;

  std::mutex mutex;
  std::condition_variable changed;
  std::map<std::int64_t, std::int64_t> assignments;  // by sample
  bool released = false;
};

class FakeWorker final : public RemoteSimulator {
 public:
  explicit FakeWorker(Place& place) : place_(place) {}

  bool ready() override {
    if (alive_) return true;
    const std::lock_guard lock(place_.mutex);
    if (place_.workers == 0) return false;
    if (place_.workers > 0) --place_.workers;
    return alive_ = true;
  }
  void throw_when_gone(bool throws) override { throws_ = throws; }
  void interrupt() override {
    const std::lock_guard lock(place_.mutex);
    interrupted_ = true;
    place_.changed.notify_all();
  }
  SimulatorInfo info() override {
    SimulatorInfo info;
    info.name = "fake";
    info.determinism = place_.seeds ? "bitwise" : "none";
    info.seeds = place_.seeds;
    return info;
  }
  Outcome reset(const State& initial, std::uint64_t) override {
    const auto sample = std::get<std::int64_t>(initial.at("sample"));
    std::unique_lock lock(place_.mutex);
    const auto assignment = ++place_.assignments[sample];
    if (place_.hangs(sample, assignment)) {
      place_.changed.wait(lock, [&] { return interrupted_ || place_.released; });
    }
    sample_ = sample;
    if (!place_.goes(sample, assignment)) return {};
    alive_ = false;
    if (throws_) throw WorkerGone("gone");
    return {SimStatus::kLost, "gone", 0.0, {}};
  }
  Outcome act(std::string_view, const State&, double) override { return {}; }
  State observe() override { return {{"square", sample_ * sample_}}; }

 private:
  Place& place_;
  bool alive_ = false, throws_ = false, interrupted_ = false;
  std::int64_t sample_ = 0;
};

/// Samples that say their number at the start and see its square.
class Squares final : public SampleMaker {
 public:
  explicit Squares(bool repeats) : repeats_(repeats) {}
  std::optional<SampleRecord> make(std::int64_t sample, Simulator& simulator,
                                   const std::function<bool()>& abandoned) const override {
    SampleRecord record;
    record.sample = sample;
    record.initial = {{"sample", sample}};
    Nothing nothing;
    const auto status = simulate_start(nothing, repeats_, simulator, record, abandoned);
    if (!status) return std::nullopt;
    record.status = sample_status(*status);
    return record;
  }
  std::optional<SampleRecord> repeat(const SampleRecord&, Simulator&,
                                     const std::function<bool()>&) const override {
    return std::nullopt;
  }

 private:
  struct Nothing final : ActionSource {
    void begin(SampleRecord&) override {}
    const ActionCall* next(SampleRecord&) override { return nullptr; }
  };
  bool repeats_;
};

struct Ran {
  std::vector<SampleRecord> records;     // in order
  std::map<std::int64_t, int> finished;  // by sample: number of reports by the pool
  std::map<std::int64_t, std::int64_t> assignments;
};

Ran run(Place& place, std::int64_t jobs, std::int64_t samples,
        const std::function<void()>& before_end = {}) {
  Ran out;
  std::mutex telling;
  WorkerPool pool(
      jobs, [&] { return std::make_unique<FakeWorker>(place); },
      [&](const SampleRecord& record) {
        const std::lock_guard lock(telling);
        ++out.finished[record.sample];
      },
      nullptr);
  REQUIRE(pool.info());
  const auto maker = std::make_shared<const Squares>(place.seeds);
  for (std::int64_t i = 1; i <= samples; ++i) pool.submit(maker, i);
  if (before_end) before_end();
  for (std::int64_t i = 1; i <= samples; ++i) {
    auto record = pool.wait(i, DrawPhase::kCertify);
    REQUIRE(record);
    out.records.push_back(*std::move(record));
  }
  pool.close();
  out.assignments = place.assignments;
  return out;
}

void check_all_seen(const Ran& ran) {
  for (std::size_t i = 0; i < ran.records.size(); ++i) {
    const auto& record = ran.records[i];
    const auto number = static_cast<std::int64_t>(i) + 1;
    CHECK(record.status == SampleStatus::kOk);
    CHECK(record.retries == 0);
    REQUIRE(record.observations.size() == 1);
    CHECK(record.observations[0].at("square") == Value(number * number));
    CHECK(ran.finished.at(number) == 1);
  }
}

TEST_CASE(
    "where the same seed gives the same run, a lost one is made elsewhere as if it were not") {
  for (const std::int64_t jobs : {1, 3}) {
    Place place;
    // About a third of the 40 samples lose their first worker, and sample 7 loses nine.
    place.goes = [](std::int64_t sample, std::int64_t assignment) {
      return (sample % 3 == 0 && assignment == 1) || (sample == 7 && assignment <= 9);
    };
    const auto ran = run(place, jobs, 40);
    check_all_seen(ran);
    CHECK(ran.assignments.at(7) == 10);
    CHECK(ran.assignments.at(3) == 2);
  }
}

TEST_CASE("one that loses every worker is lost in the end, with its reason") {
  Place place;
  place.goes = [](std::int64_t sample, std::int64_t) { return sample == 2; };
  const auto ran = run(place, 2, 3);
  CHECK(ran.records[0].status == SampleStatus::kOk);
  CHECK(ran.records[1].status == SampleStatus::kLost);
  CHECK(ran.records[1].reason == "gone");
  CHECK(ran.records[2].status == SampleStatus::kOk);
  CHECK(ran.finished.at(2) == 1);
}

TEST_CASE("elsewhere the first assignment counts, and its loss is a lost run") {
  Place place;
  place.seeds = false;
  place.goes = [](std::int64_t sample, std::int64_t) { return sample % 5 == 0; };
  const auto ran = run(place, 3, 50);
  for (const auto& record : ran.records) {
    CHECK((record.status == SampleStatus::kLost) == (record.sample % 5 == 0));
    CHECK(ran.assignments.at(record.sample) == 1);
    CHECK(ran.finished.at(record.sample) == 1);
  }
}

TEST_CASE("one that takes too long is made twice, and the late one is ignored") {
  Place place;
  // The first worker at it never answers; without a second one this would wait for ever.
  place.hangs = [](std::int64_t sample, std::int64_t assignment) {
    return sample == 4 && assignment == 1;
  };
  const auto ran = run(place, 3, 20);
  check_all_seen(ran);
  CHECK(ran.assignments.at(4) == 2);
}

TEST_CASE("while one is still at it, those that are lost at the same do not make it a loss") {
  Place place;
  place.hangs = [](std::int64_t sample, std::int64_t assignment) {
    return sample == 4 && assignment == 1;
  };
  place.goes = [&](std::int64_t sample, std::int64_t assignment) {
    if (sample != 4 || assignment == 1) return false;
    if (assignment == kMostAssignments) {  // as many as may be; now the first one goes on
      place.released = true;
      place.changed.notify_all();
    }
    return true;
  };
  const auto ran = run(place, 3, 20);
  check_all_seen(ran);
  CHECK(ran.assignments.at(4) >= kMostAssignments);
}

TEST_CASE("without a promise that it is the same run it is made once, however long it takes") {
  Place place;
  place.seeds = false;
  place.hangs = [](std::int64_t sample, std::int64_t assignment) {
    return sample == 4 && assignment == 1;
  };
  std::thread patience;
  const auto ran = run(place, 3, 20, [&] {
    patience = std::thread([&] {
      // Long enough for everybody else to have nothing to do and look for work.
      std::this_thread::sleep_for(std::chrono::milliseconds(400));
      const std::lock_guard lock(place.mutex);
      place.released = true;
      place.changed.notify_all();
    });
  });
  patience.join();
  check_all_seen(ran);
  CHECK(ran.assignments.at(4) == 1);
}

TEST_CASE("workers that are gone for good leave the work to others") {
  Place place;
  place.workers = 4;  // for three threads: two of them end
  place.goes = [](std::int64_t sample, std::int64_t assignment) {
    return sample <= 3 && assignment == 1;
  };
  const auto ran = run(place, 3, 30);
  check_all_seen(ran);
}

TEST_CASE("a simulation that was abandoned is not made elsewhere") {
  Place place;
  place.hangs = [](std::int64_t sample, std::int64_t assignment) {
    return sample == 1 && assignment == 1;
  };
  std::atomic<int> told = 0;
  WorkerPool pool(
      2, [&] { return std::make_unique<FakeWorker>(place); }, [&](const SampleRecord&) { ++told; },
      nullptr);
  REQUIRE(pool.info());
  const auto maker = std::make_shared<const Squares>(true);
  pool.submit(maker, 1);
  pool.submit(maker, 2);
  REQUIRE(pool.wait(2, DrawPhase::kCertify));
  pool.abandon();
  pool.submit(maker, 3);
  REQUIRE(pool.wait(3, DrawPhase::kCertify));
  pool.close();
  CHECK(place.assignments.at(3) == 1);
}

}  // namespace
}  // namespace parallax::harness
