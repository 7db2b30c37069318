#include "harness/campaign/run_recorder.h"

#include <nlohmann/json.hpp>
#include <set>

#include "harness/campaign/replay.h"
#include "harness/recording/recording_file.h"
#include "harness/report/report.h"
#include "tests/harness/campaign/two_regions.h"

namespace parallax::harness::test {
namespace {

namespace fs = std::filesystem;

/// The scripted world with poses: the box and the robot, where their variables say.
class MovingSimulator final : public Simulator {
 public:
  MovingSimulator(const Script& script, std::string fault)
      : inner_(script), fault_(std::move(fault)) {}

  SimulatorInfo info() override {
    auto info = inner_.info();
    info.scene.emplace();
    info.scene->bodies = {{"box", BodyKind::kItem, "", {}, true, {}, {}},
                          {"robot", BodyKind::kRobot, "", {}, true, {}, {}}};
    return info;
  }
  void record_motion(double interval_s) override { interval_s_ = interval_s; }
  Outcome reset(const State& initial, std::uint64_t seed) override {
    writer_ = MotionWriter({2, 0});
    time_s_ = 0.0;
    return moved(inner_.reset(initial, seed));
  }
  Outcome act(std::string_view action, const State& arguments, double limit_s) override {
    return moved(inner_.act(action, arguments, limit_s));
  }
  State observe() override { return inner_.observe(); }

 private:
  Outcome moved(Outcome outcome) {
    outcome.margins["left"] = 1.0;
    if (interval_s_ == 0.0 || outcome.status == SimStatus::kInvalidStart) return outcome;
    time_s_ += outcome.sim_time_s;
    const auto state = inner_.observe();
    const std::vector<Pose> poses = {Pose{{number(state, "box.x"), 0.0, 0.0}},
                                     Pose{{number(state, "robot.x"), 0.0, 0.0}}};
    writer_.add(time_s_, poses, {});
    outcome.motion.frames = writer_.take();
    if (time_s_ > 1.0) outcome.motion.fault = fault_;
    return outcome;
  }

  ScriptedSimulator inner_;
  std::string fault_;
  double interval_s_ = 0.0, time_s_ = 0.0;
  MotionWriter writer_;
};

struct MovingBench : Bench {
  std::string fault;
  MovingBench() { options.record = RecordMode::kDiscrepancies; }

  SimulatorFactory factory() {
    return [this] { return std::make_unique<MovingSimulator>(script, fault); };
  }
  base::Result<CampaignResult> run() {
    ListFeed feed(traces, openness);
    return run_campaign(scenario, feed, factory(), options, files, sink);
  }
  fs::path recordings() const { return options.run_dir / "recordings"; }
  std::set<std::string> kept() const {
    std::set<std::string> out;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(recordings(), error)) {
      out.insert(entry.path().filename().string());
    }
    return out;
  }
  std::map<std::string, std::string> bytes() const {
    std::map<std::string, std::string> out;
    for (const auto& name : kept()) out[name] = slurp(recordings() / name);
    return out;
  }
};

bool is_late(const State& start) { return number(start, "box.x") > 1.93; }

std::int64_t first_late(const Bench& bench) {
  std::int64_t sample = 1;
  while (!is_late(drawn_start(bench, 1, sample))) ++sample;
  return sample;
}

TEST_CASE("recordings: discrepancies and three clean runs are kept, all, or none") {
  MovingBench bench;
  bench.script.drops = is_late;
  const auto late = first_late(bench);
  REQUIRE(late > 4);
  const auto name = "1." + std::to_string(late) + ".rec";
  REQUIRE(bench.run());
  CHECK(bench.kept() == std::set<std::string>{"1.1.rec", "1.2.rec", "1.3.rec", name});
  const auto journal = slurp(bench.journal());

  MovingBench all;
  all.script.drops = is_late;
  all.options.record = RecordMode::kAll;
  REQUIRE(all.run());
  CHECK(std::ssize(all.kept()) == late);
  for (const auto& [file, bytes] : bench.bytes()) CHECK(all.bytes()[file] == bytes);
  CHECK(slurp(all.journal()) == journal);

  MovingBench none;
  none.script.drops = is_late;
  none.options.record = RecordMode::kNone;
  REQUIRE(none.run());
  CHECK_FALSE(fs::exists(none.recordings()));
  CHECK(slurp(none.journal()) == journal);
}

TEST_CASE("recordings: what happened when, and what was seen") {
  MovingBench bench;
  bench.script.drops = is_late;
  const auto late = first_late(bench);
  const auto result = bench.run();
  REQUIRE(result);
  const auto& record = result->discrepancies.at(0).record;
  std::string why;
  const auto recording = find_recording(bench.options.run_dir, 1, late, why);
  REQUIRE(recording);
  CHECK(recording->seed == record.seed);
  CHECK(recording->simulator == "scripted 1");
  CHECK(recording->observations == record.observations);
  CHECK(recording->missing == "");
  REQUIRE(recording->events.size() == 4);
  const auto& picked = recording->events[1];
  CHECK(picked.name == "PickUp()");
  CHECK(picked.begin_s == 0.5);
  CHECK(picked.end_s == 2.0);
  CHECK(picked.status == "failed");
  CHECK(picked.reason == "slipped");
  CHECK(picked.margins.at("left") == RecordedValues::mapped_type(1.0));
  CHECK(recording->events[3].name == "Place()");
  CHECK(recording->events[3].end_s == 3.0);
  // The box, which was dropped, stays where it was; the robot goes away and comes back.
  Playback at(*recording);
  REQUIRE(at.next());
  CHECK(at.pose_of(0).p[0] == doctest::Approx(number(record.initial, "box.x")).epsilon(1e-3));
  double farthest_m = 0.0;
  while (at.next()) farthest_m = std::max(farthest_m, at.pose_of(1).p[0]);
  CHECK(farthest_m == doctest::Approx(1.25).epsilon(1e-3));
  CHECK(at.pose_of(0).p[0] == doctest::Approx(number(record.initial, "box.x")).epsilon(1e-3));
  CHECK(at.pose_of(1).p[0] == doctest::Approx(0.5).epsilon(1e-3));
}

TEST_CASE("recordings: the same bytes with any number of jobs, in a continued run, and repeated") {
  const auto prepared = [](MovingBench& bench) {
    bench.script.drops = is_late;
    bench.traces = 2;
    bench.options.keep_going = true;
  };
  MovingBench one;
  prepared(one);
  REQUIRE(one.run());
  const auto expected = one.bytes();
  std::size_t count = 0;
  for (const std::int64_t trace : {1, 2}) {
    std::int64_t late = 1;
    while (!is_late(drawn_start(one, trace, late))) ++late;
    count += static_cast<std::size_t>(std::min<std::int64_t>(late - 1, 3) + 1);
  }
  CHECK(expected.size() == count);

  MovingBench several;
  prepared(several);
  several.options.jobs = 5;
  several.script.drop_delay = std::chrono::milliseconds(5);
  REQUIRE(several.run());
  CHECK(several.bytes() == expected);

  MovingBench continued;
  prepared(continued);
  std::atomic<bool> stop = false;
  continued.options.stop = &stop;
  continued.options.jobs = 3;
  for (const std::int64_t end : {2, 5, 7}) {
    stop = false;
    continued.options.progress = [&](const CampaignProgress& p) { stop = p.done >= end; };
    REQUIRE(continued.run());
    continued.options.resume = true;
  }
  continued.options.stop = nullptr;
  continued.options.progress = nullptr;
  // A temporary file that a killed writer leaves, and a file that is not ours.
  std::ofstream(continued.recordings() / "1.2.rec.77.tmp") << "half";
  std::ofstream(continued.recordings() / "notes.txt") << "mine";
  REQUIRE(continued.run());
  auto bytes = continued.bytes();
  CHECK(bytes.erase("notes.txt") == 1);
  CHECK(bytes == expected);

  for (const auto& [file, recorded] : expected) {
    const auto id = recording_id(file);
    REQUIRE(id);
    const auto run = read_recorded_run(one.options.run_dir, SampleId{id->first, id->second},
                                       one.files, one.sink);
    REQUIRE(run);
    std::optional<Recording> again;
    const auto replayed = replay_sample(*run, "5ce0", one.factory(), &again);
    CHECK(replayed.outcome == ReplayOutcome::kIdentical);
    REQUIRE(again);
    REQUIRE(write_recording(one.options.run_dir, *again) == "");
    CHECK(slurp(one.recordings() / file) == recorded);
  }
}

TEST_CASE("recordings: lost simulations are kept as far as they came, where all are") {
  MovingBench bench;
  bench.scenario.limits.max_runs = 12;
  const auto lost = drawn_start(bench, 1, 5);
  bench.script.loses = [&](const State& start) { return start == lost; };
  bench.options.record = RecordMode::kAll;
  REQUIRE(bench.run());
  CHECK(bench.kept().size() == 12);
  std::string why;
  const auto recording = find_recording(bench.options.run_dir, 1, 5, why);
  REQUIRE(recording);
  CHECK(recording->status == "lost");
  CHECK(recording->events.size() == 1);

  MovingBench usual;
  usual.scenario.limits.max_runs = 12;
  usual.script.loses = bench.script.loses;
  REQUIRE(usual.run());
  CHECK(usual.kept() == std::set<std::string>{"1.1.rec", "1.2.rec", "1.3.rec"});
}

TEST_CASE("recordings: a simulator that tells nonsense loses its recordings and nothing else") {
  MovingBench good, bad;
  bad.fault = "`box` has a turn that is no unit quaternion w-x-y-z";
  REQUIRE(good.run());
  const auto result = bad.run();
  REQUIRE(result);
  CHECK(result->verdict == CampaignVerdict::kNoDiscrepancy);
  CHECK(slurp(bad.journal()) == slurp(good.journal()));
  CHECK(codes(bad.sink) == std::vector<std::string>{"W7117"});
  std::string why;
  const auto recording = find_recording(bad.options.run_dir, 1, 1, why);
  REQUIRE(recording);
  CHECK(recording->missing == bad.fault);
}

TEST_CASE("recordings: a folder that cannot be written costs the recordings and nothing else") {
  MovingBench good, bad;
  REQUIRE(good.run());
  fs::create_directories(bad.options.run_dir);
  const auto elsewhere = bad.folder.path() / "elsewhere";
  fs::create_directories(elsewhere);
  bad.options.resume = true;
  SUBCASE("a link that leads out") {
    // Behind the check of the folder, as one that is laid while the run goes on.
    bad.script.on_info = [&] {
      std::error_code error;
      fs::create_directory_symlink(elsewhere, bad.recordings(), error);
    };
  }
  SUBCASE("a file") {
    bad.script.on_info = [&] { std::ofstream(bad.recordings()) << "mine"; };
  }
  REQUIRE(bad.run());
  CHECK(slurp(bad.journal()) == slurp(good.journal()));
  CHECK(codes(bad.sink) == std::vector<std::string>{"W7117"});
  CHECK(fs::is_empty(elsewhere));
}

TEST_CASE("recordings: a folder of that name without a run is somebody else's") {
  MovingBench bench;
  fs::create_directories(bench.recordings());
  std::ofstream(bench.recordings() / "1.1.rec") << "mine";
  CHECK_FALSE(bench.run());
  CHECK(slurp(bench.recordings() / "1.1.rec") == "mine");
}

TEST_CASE("recordings: a simulator without poses leaves no folder") {
  Bench bench;
  bench.options.record = RecordMode::kAll;
  REQUIRE(bench.run());
  CHECK_FALSE(fs::exists(bench.options.run_dir / "recordings"));
}

}  // namespace
}  // namespace parallax::harness::test
