// Cheap questions whose cost is compared with a recorded one. The cost is the number of
// instructions that Cachegrind counts (Nethercote & Seward 2007): it is the same from run to run
// within a thousandth, on a busy machine, too, where processor time differs by more than half. What
// memory and caches cost is not in it; the tables of times show that.

#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

#include "tools/bench/bench.h"
#include "tools/bench/bounds.h"
#include "tools/bench/check.h"
#include "tools/bench/contestants.h"

namespace parallax::tools {
namespace {

/// Counting takes some thirty times as long as running.
constexpr double kTimeLimit_s = 300.0;
/// Builds are timed, in units of the quickest of so many compilations of one file.
constexpr int kCompilations = 3;

/// One question with the answer that is known.
struct Question {
  std::string name;
  Contestant contestant;
  std::string expected = {};  // empty: only the exit code is checked
  std::string input = {};     // the file on standard input, if any
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

/// The requests to the simulator of a scenario during one run, as it reads them from its standard
/// input.
std::string recorded_requests(Bench& bench, const std::string& scenario) {
  const auto requests = bench.path("requests.jsonl");
  const auto spied = bench.path("spied.yaml");
  std::ofstream(spied) << fmt::format(
      "include: {0}\nsimulator:\n  command: [sh, -c, \"tee '{1}' | '{2}' worker '{0}'\"]\n",
      scenario, requests, parallax_program());
  auto run =
      parallax_with({"run", spied, "--allow-outside", "--allow-commands", "--jobs", "1", "--seed",
                     "1", "--max-runs", "1", "--out", bench.path("run"), "--quiet"});
  run.good_codes = {0, 4};
  bench.measured(run);
  return requests;
}

/// One run's motions in the scenario's physics.
Question simulation(Bench& bench, const std::string& name, const std::string& scenario) {
  return {"simulate " + name, parallax_with({"worker", scenario}), "",
          recorded_requests(bench, scenario)};
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
  all.push_back(simulation(bench, "kitchen/plan2_modified", kitchen));
  return all;
}

/// The number in Cachegrind's line `I refs: 1,234`; of the process that it began with.
std::optional<double> counted_instructions(const std::string& log) {
  std::ifstream in(log);
  for (std::string line; std::getline(in, line);) {
    const auto found = line.find("refs:");
    if (found == std::string::npos) continue;
    std::erase_if(line, [](char c) { return c == ','; });
    return std::stod(line.substr(line.find(':', found) + 1));
  }
  return std::nullopt;
}

/// Millions of instructions that a question took, or why there is no number.
struct Counted {
  double millions = 0.0;
  std::string fault = {};
};

Counted counted(Bench& bench, const Question& question) {
  const auto log = bench.path("instructions.log");
  auto contestant = question.contestant;
  std::vector<std::string> command = {"valgrind", "--tool=cachegrind", "--cache-sim=no",
                                      "--cachegrind-out-file=/dev/null", "--log-file=" + log};
  if (!question.input.empty()) {
    const auto begin = fmt::format("exec \"$@\" < '{}'", question.input);
    command.insert(command.begin(), {"sh", "-c", begin, "sh"});
  }
  contestant.command.insert(contestant.command.begin(), command.begin(), command.end());
  const auto side = bench.measured(contestant);
  if (!side.cost) return {0.0, side.remark};
  if (!question.expected.empty() && side.answer != question.expected) {
    return {0.0, fmt::format("answered {}, not {}", side.answer, question.expected)};
  }
  const auto instructions = counted_instructions(log);
  if (!instructions) return {0.0, "valgrind counted nothing"};
  return {1e-6 * *instructions};
}

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

  bool report_questions() {
    fmt::print("questions, in millions of instructions\n  {:<36}{:>9} {:>9} {:>8}\n", "", "counted",
               "recorded", "");
    bool fine = true;
    for (const auto& question : all_questions(bench_)) {
      const auto& name = question.name;
      const auto [millions, fault] = counted(bench_, question);
      if (!fault.empty()) {
        fmt::print("  {:<36}FAILED: {}\n", name, fault);
        fine = false;
        continue;
      }
      const auto recorded = recorded_cost(bounds_.questions, name);
      const auto verdict = judge_question(millions, recorded);
      fine = fine && verdict != BoundVerdict::kExceeded && verdict != BoundVerdict::kUnknown;
      fmt::print("{}", verdict_line(name, millions, recorded, verdict));
      std::fflush(stdout);
      found_.questions[name] = millions;
    }
    for (const auto& [name, unused] : bounds_.questions) {
      if (options_.record || found_.questions.contains(name)) continue;
      fmt::print("  {:<36}recorded, but not answered now\n", name);
      fine = false;
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
    for (int round = 0; round < kCompilations; ++round) {
      const auto side = bench_.measured(compile);
      if (side.cost) reference_s = std::min(reference_s, side.cost->cpu_s);
    }
    const std::string name = "all, from nothing";
    const auto ratio = options_.build_cpu_s / reference_s;
    const auto recorded = recorded_cost(bounds_.builds, name);
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
};

}  // namespace

int check_bounds(const CheckOptions& options) { return Check(options).run(); }

}  // namespace parallax::tools
