#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>

#include "compiler/base/file_io.h"
#include "tools/cli/command.h"
#include "tools/cli/expectation.h"
#include "tools/cli/signals.h"

extern char** environ;

namespace parallax::tools {
namespace fs = std::filesystem;

namespace {

struct SuiteOptions {
  std::vector<std::string> paths;
  std::string only;
  std::string out = "out/suite";
  std::uint64_t seed = 1;
  std::int64_t jobs = 1;
};

struct SuiteCase {
  std::string file;
  harness::Expectation expect;
  std::vector<std::string> problems;
  double wall_s = 0.0;
  bool finished = false;
};

/// The YAML files below the paths, sorted, each once.
std::vector<std::string> scenario_files(const SuiteOptions& options, base::DiagnosticSink& sink) {
  std::vector<std::string> files;
  for (const auto& path : options.paths) {
    std::error_code error;
    if (fs::is_regular_file(path, error)) {
      files.push_back(path);
      continue;
    }
    fs::recursive_directory_iterator walk(path, error);
    if (error) {
      sink.error_about(base::DiagnosticCode::kFileNotFound, path, error.message());
      continue;
    }
    for (const auto& entry : walk) {
      const auto name = entry.path().filename().string();
      if (entry.is_regular_file(error) && (name.ends_with(".yaml") || name.ends_with(".yml"))) {
        files.push_back(entry.path().lexically_normal().string());
      }
    }
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

/// Has the text a key `expect` at its outermost level?
bool says_what_it_expects(const std::string& file) {
  base::DiagnosticSink ignored;
  const auto text = base::read_file(file, ignored);
  return text && (text->starts_with("expect:") || text->find("\nexpect:") != std::string::npos);
}

/// A case for every file that says what it expects; fragments that others include do not.
std::vector<SuiteCase> find_cases(const SuiteOptions& options, Invocation& invocation) {
  std::vector<SuiteCase> cases;
  for (const auto& file : scenario_files(options, invocation.sink())) {
    if (file.find(options.only) == std::string::npos) continue;
    base::SourceFiles files;
    base::DiagnosticSink sink;
    const auto scenario = harness::load_scenario(file, files, sink);
    if (scenario && scenario->expect) cases.push_back({file, *scenario->expect, {}, 0.0, false});
    // Broken, but meant as a case: it must not pass by being skipped.
    if (!scenario && says_what_it_expects(file)) cases.push_back({file, {}, {}, 0.0, false});
  }
  return cases;
}

/// Runs a command with its standard output caught; the rest goes where ours goes.
std::string capture(std::vector<std::string> command, bool quiet) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return {};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  if (quiet) {
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  }
  std::vector<char*> argv;
  for (auto& word : command) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  const int failed =
      ::posix_spawn(&child, "/proc/self/exe", &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  std::string out;
  std::array<char, 4096> buffer{};
  bool told = false;
  while (failed == 0) {
    // A signal to us alone ends the case as well.
    if (stop_flag().load() && !told) {
      ::kill(child, SIGTERM);
      told = true;
    }
    pollfd ready{ends[0], POLLIN, 0};
    if (::poll(&ready, 1, 100) <= 0) continue;
    const auto count = ::read(ends[0], buffer.data(), buffer.size());
    if (count <= 0) break;
    out.append(buffer.data(), static_cast<std::size_t>(count));
  }
  ::close(ends[0]);
  if (failed == 0) ::waitpid(child, nullptr, 0);
  return out;
}

void run_case(SuiteCase& one, const SuiteOptions& options, bool quiet) {
  const auto begin = std::chrono::steady_clock::now();
  auto name = one.file;
  std::replace(name.begin(), name.end(), '/', '_');
  const auto folder = fs::path(options.out) / name;
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  const auto document =
      capture({"parallax", "run", one.file, "--json", "--seed", std::to_string(options.seed),
               "--out", folder.string(), quiet ? "--quiet" : "--color=auto"},
              quiet);
  one.problems = unmet(one.expect, document);
  // A run that was cut off by a signal to all of us says nothing about the case.
  one.finished = !stop_flag().load();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  one.wall_s = wall.count();
}

void run_all(std::vector<SuiteCase>& cases, const SuiteOptions& options, Invocation& invocation) {
  std::atomic<std::size_t> next{0};
  std::mutex printing;
  const auto work = [&] {
    for (std::size_t i = next++; i < cases.size() && !stop_flag().load(); i = next++) {
      run_case(cases[i], options, true);
      const std::lock_guard lock(printing);
      std::string line =
          fmt::format("{} {} ({:.1f} s)", cases[i].problems.empty() ? "ok  " : "FAIL",
                      cases[i].file, cases[i].wall_s);
      for (const auto& problem : cases[i].problems) line += "\n       " + problem;
      invocation.remark(line);
    }
  };
  std::vector<std::thread> threads;
  for (std::int64_t i = 0; i < options.jobs; ++i) threads.emplace_back(work);
  for (auto& thread : threads) thread.join();
}

int run_suite(const SuiteOptions& options, Invocation& invocation) {
  auto cases = find_cases(options, invocation);
  if (invocation.sink().has_errors()) return 0;
  if (cases.empty()) {
    invocation.sink().error_about(base::DiagnosticCode::kNoCases, options.paths.front());
    return 0;
  }
  run_all(cases, options, invocation);
  std::size_t passed = 0;
  std::size_t failed = 0;
  for (const auto& one : cases) {
    if (!one.finished) continue;
    ++(one.problems.empty() ? passed : failed);
  }
  const auto not_run = cases.size() - passed - failed;
  if (invocation.options().json) {
    invocation.document(
        fmt::format("{{\"status\":\"ok\",\"passed\":{},\"failed\":{},\"not_run\":{}}}\n", passed,
                    failed, not_run));
  } else {
    invocation.result(fmt::format("{} passed, {} failed{}\n", passed, failed,
                                  not_run == 0 ? "" : fmt::format(", {} not run", not_run)));
  }
  if (failed > 0) return 1;
  return not_run == 0 ? 0 : 4;
}

}  // namespace

Command add_suite_command(CLI::App& app) {
  auto options = std::make_shared<SuiteOptions>();
  auto* command =
      app.add_subcommand("suite", "Run every scenario below a path that says what it expects");
  command->footer(
      "Examples:\n"
      "  parallax suite scenarios --jobs 2\n"
      "  parallax suite scenarios --only edge");
  command->add_option("paths", options->paths, "Scenario files, or folders that hold some")
      ->required();
  command->add_option("--only", options->only, "Only files whose path contains this");
  command->add_option("--out", options->out, "Folder of the runs, made anew")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Seed of every run")
      ->check(whole_number(0, kMaxSeed))
      ->capture_default_str();
  command->add_option("-j,--jobs", options->jobs, "Cases at the same time")
      ->check(whole_number(1, 256))
      ->capture_default_str();
  return {command, [options](Invocation& invocation) { return run_suite(*options, invocation); }};
}

}  // namespace parallax::tools
