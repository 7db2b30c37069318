// Cheap questions whose cost is compared with a recorded one, in units of the reference work.

#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

#include "tools/bench/bench.h"
#include "tools/bench/bounds.h"
#include "tools/bench/check.h"
#include "tools/bench/contestants.h"

namespace parallax::tools {
namespace {

/// First all rows this often, each after a run of the reference work;
constexpr int kRounds = 3;
/// then those that seem slow again, as other work on the machine only ever adds time.
constexpr int kMoreRounds = 4;
constexpr double kTimeLimit_s = 30.0;

/// One question with the answer that is known.
struct Question {
  std::string name;
  Contestant contestant;
  std::string expected = {};  // empty: only the exit code is checked
};

/// A predicate that nothing determines where its event does not happen: few traces, many hidden
/// valuations.
constexpr const char* kOpenPredicate = R"(range time 0 1
sort level: integer
range level 0 3
sort tin
tin Red
predicate Noted(event,time)
fluent Mark(level)
event Ring()
event Set(level)
event Push(tin)
[time] !Happens(Push(Red),time) -> Happens(Ring(),time).
[time,level,event] Happens(event,time) -> !(Noted(event,0) -> HoldsAt(Mark(level),time)).
)";

Question counting(Bench& bench, const std::string& family, const std::string& traces) {
  return {"count " + family, parallax_counts(bench.model_file(family)), traces};
}

/// A run refuses a folder that holds one already, so each begins without.
Question scenario_run(Bench& bench, const std::string& name, const std::string& scenario,
                      int runs) {
  const auto folder = bench.path("run");
  const auto command = fmt::format(
      "rm -rf '{0}' && exec '{1}' run '{2}/scenarios/{3}' --jobs 1 --seed 1 --max-runs {4} "
      "--out '{0}' --quiet",
      folder, parallax_program(), PARALLAX_SOURCE_DIR, scenario, runs);
  return {"run " + name, {"parallax", {"sh", "-c", command}, "", {0, 1, 4}, {}}};
}

std::vector<Question> all_questions(Bench& bench) {
  std::vector<Question> all;
  const auto add = [&](const std::string& name, const std::vector<std::string>& arguments) {
    all.push_back({name, parallax_with(arguments)});
  };
  const std::string kitchen = PARALLAX_SOURCE_DIR "/scenarios/kitchen/plan2_modified.yaml";
  add("compile chain_200", {"compile", bench.model_file("chain_200"), "-o", bench.path("out.cnf")});
  all.push_back(counting(bench, "chain_400", "0"));
  const auto noted = bench.path("noted.e");
  std::ofstream(noted) << kOpenPredicate;
  all.push_back({"count traces with an open predicate", parallax_counts(noted), "48"});
  all.push_back(counting(bench, "lamps_4_6", "1048576"));
  all.push_back(counting(bench, "robot_4_2_8", "1759222"));
  all.push_back(counting(bench, "roaming_6_4_30", "36576324650499955"));
  all.push_back(counting(bench, "distant_4_6", "331776"));
  all.push_back(counting(bench, "pigeon_20_19", "0"));
  all.push_back({"list robot_4_2_4", parallax_lists(bench.model_file("robot_4_2_4")), "3488"});
  add("first trace of robot_8_4_0",
      {"traces", bench.model_file("robot_8_4_0"), "--limit", "1", "--order", "any"});
  add("consequences of bankplan_3_12_4_5",
      {"consequences", bench.model_file("bankplan_3_12_4_5"), "--json"});
  add("check kitchen/plan2_modified", {"check", kitchen});
  add("traces of kitchen/plan2_modified", {"traces", kitchen, "--limit", "0"});
  all.push_back(scenario_run(bench, "kitchen/plan2_modified", "kitchen/plan2_modified.yaml", 1));
  return all;
}

/// The least processor time of a question and of the reference work over all rounds so far.
struct Measured {
  double least_s = std::numeric_limits<double>::infinity();
  std::string fault;  // it gave no answer or a wrong one
};

class Check {
 public:
  explicit Check(const CheckOptions& options)
      : options_(options), bench_(MeasureOptions{1, kTimeLimit_s, kTimeLimit_s}) {}

  int run() {
    std::string error;
    if (!read_bounds(error)) {
      fmt::print(stderr, "{}: {}\n", options_.bounds, error);
      return 3;
    }
    questions_ = all_questions(bench_);
    measured_.resize(questions_.size());
    for (int round = 0; round < kRounds; ++round) {
      measure_round([](std::size_t) { return true; });
    }
    for (int round = 0; round < kMoreRounds; ++round) {
      measure_round([&](std::size_t i) { return judged(i) == BoundVerdict::kExceeded; });
    }
    const bool fine = report_questions();
    const bool builds_fine = options_.build_cpu_s <= 0.0 || report_build();
    if (options_.record) write_bounds();
    return (fine && builds_fine) || options_.record ? 0 : 1;
  }

 private:
  bool read_bounds(std::string& error) {
    std::ifstream in(options_.bounds);
    std::stringstream text;
    text << in.rdbuf();
    auto bounds = parse_bounds(text.str(), error);
    if (!bounds) return options_.record;
    bounds_ = *std::move(bounds);
    return true;
  }

  double cpu_of(const Contestant& contestant, std::string& fault, const std::string& expected) {
    const auto side = bench_.measured(contestant);
    if (!side.cost) fault = side.remark;
    if (side.cost && !expected.empty() && side.answer != expected) {
      fault = fmt::format("answered {}, not {}", side.answer, expected);
    }
    return side.cost ? side.cost->cpu_s : std::numeric_limits<double>::infinity();
  }

  void measure_reference() {
    std::string fault;
    const Contestant work{"reference", {bench_program(), "reference"}, "", {0}, {}};
    reference_s_ = std::min(reference_s_, cpu_of(work, fault, ""));
  }

  void measure_round(const std::function<bool(std::size_t)>& is_wanted) {
    for (std::size_t i = 0; i < questions_.size(); ++i) {
      if (!is_wanted(i) || !measured_[i].fault.empty()) continue;
      measure_reference();
      auto& so_far = measured_[i];
      const auto& question = questions_[i];
      so_far.least_s =
          std::min(so_far.least_s, cpu_of(question.contestant, so_far.fault, question.expected));
    }
  }

  double ratio(std::size_t i) const { return measured_[i].least_s / reference_s_; }
  std::optional<double> recorded(std::size_t i) const {
    return recorded_ratio(bounds_.questions, questions_[i].name);
  }
  BoundVerdict judged(std::size_t i) const { return judge_question(ratio(i), recorded(i)); }

  bool report_questions() {
    fmt::print(
        "questions, in units of the reference work ({:.0f} ms of processor time)\n"
        "  {:<36}{:>9} {:>9} {:>8}\n",
        1e3 * reference_s_, "", "measured", "recorded", "");
    bool fine = true;
    for (std::size_t i = 0; i < questions_.size(); ++i) {
      const auto& name = questions_[i].name;
      if (!measured_[i].fault.empty()) {
        fmt::print("  {:<36}FAILED: {}\n", name, measured_[i].fault);
        fine = false;
        continue;
      }
      const auto verdict = judged(i);
      fine = fine && verdict != BoundVerdict::kExceeded && verdict != BoundVerdict::kUnknown;
      fmt::print("{}", verdict_line(name, ratio(i), recorded(i), verdict));
      found_.questions[name] = ratio(i);
    }
    for (const auto& [name, unused] : bounds_.questions) {
      if (found_.questions.contains(name) || options_.record) continue;
      const bool failed = std::any_of(questions_.begin(), questions_.end(),
                                      [&](const auto& question) { return question.name == name; });
      if (!failed) fmt::print("  {:<36}recorded, but no longer asked\n", name);
      fine = fine && failed;
    }
    return fine;
  }

  bool report_build() {
    double reference_s = std::numeric_limits<double>::infinity();
    const Contestant compile{
        "g++",
        {"env", "CCACHE_DISABLE=1", "g++", "-std=c++20", "-O2", "-c", "-x", "c++",
         PARALLAX_SOURCE_DIR "/tools/bench/build_reference.txt", "-o", bench_.path("reference.o")},
        "",
        {0},
        {}};
    std::string fault;
    for (int round = 0; round < kRounds; ++round) {
      reference_s = std::min(reference_s, cpu_of(compile, fault, ""));
    }
    const std::string name = "all, from nothing";
    const auto ratio = options_.build_cpu_s / reference_s;
    const auto recorded = recorded_ratio(bounds_.builds, name);
    const auto verdict = judge_build(ratio, recorded);
    fmt::print("builds, in units of the reference file ({:.2f} s of processor time)\n{}",
               reference_s, verdict_line(name, ratio, recorded, verdict));
    found_.builds[name] = ratio;
    return verdict != BoundVerdict::kExceeded;
  }

  void write_bounds() {
    if (found_.builds.empty()) found_.builds = bounds_.builds;
    std::ofstream(options_.bounds) << to_json(found_);
    fmt::print("recorded in {}\n", options_.bounds);
  }

  CheckOptions options_;
  Bench bench_;
  Bounds bounds_, found_;
  std::vector<Question> questions_;
  std::vector<Measured> measured_;
  double reference_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace

int check_bounds(const CheckOptions& options) { return Check(options).run(); }

}  // namespace parallax::tools
