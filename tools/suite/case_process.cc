#include "tools/suite/case_process.h"

#include <fmt/format.h>

#include <csignal>

#include "compiler/base/codes/campaigns.h"
#include "tools/suite/expectation.h"

namespace parallax::tools {
namespace {

/// Why a command gave no answer.
std::string no_answer(const base::Captured& child) {
  const auto code = child.code;
  if (lacked_workers(child)) return "no worker was left to simulate it";
  if (code < 0) return "the program could not be started";
  if (code == 2 || code == 3) return "the input was refused";
  if (code == 4) return "inconclusive: a limit ended it first";
  if (code == 128 + SIGXCPU) return "inconclusive: it took more processor time than it may";
  if (code > 128) return fmt::format("the program was ended by signal {}", code - 128);
  return fmt::format("the program ended with exit code {}", code);
}

constexpr std::size_t kMaxMessageBytes = std::size_t{64} << 10U;

}  // namespace

base::Captured run_this_program(const CommandWords& words, Footprint& footprint,
                                const std::atomic<bool>& stop,
                                std::optional<std::uint64_t> cpu_limit_s) {
  std::vector<std::string> command = {"parallax"};
  command.insert(command.end(), words.options.begin(), words.options.end());
  command.insert(command.end(), {"--footprint", footprint.file()});
  command.emplace_back("--");
  command.insert(command.end(), words.files.begin(), words.files.end());
  base::CaptureOptions options;
  options.program = "/proc/self/exe";
  options.max_errors = kMaxMessageBytes;
  options.ends_with_us = true;
  options.cpu_limit_s = cpu_limit_s;
  options.signal_when = [&stop, told = false]() mutable {
    if (told || !stop.load()) return 0;
    told = true;
    return SIGTERM;
  };
  auto child = base::capture(command, options);
  footprint.add(child);
  return child;
}

bool lacked_workers(const base::Captured& child) {
  const auto id = base::info(codes::kNoWorkerLeft).id;
  return child.code == 4 && child.err.find(fmt::format("error[{}]", id)) != std::string::npos;
}

void report_no_answer(const base::Captured& child, CaseResult& result) {
  result.outcome = Outcome::kError;
  result.problems = {no_answer(child)};
  if (auto error = first_error(child.out); !error.empty()) {
    result.problems.push_back(std::move(error));
  }
}

void add_permissions(const RunnerOptions& options, bool simulates,
                     std::vector<std::string>& words) {
  if (simulates) words.emplace_back(options.allow_commands ? "--allow-commands" : "--no-commands");
  if (options.allow_outside) words.emplace_back("--allow-outside");
}

std::string explanation_of(CommandWords words, double limit_s, const RunnerOptions& options,
                           Footprint& footprint, const std::atomic<bool>& stop) {
  words.options.insert(words.options.begin(), {"explain", "--json"});
  words.options.insert(words.options.end(),
                       {"--time-limit", fmt::format("{}", limit_s), "--quiet", "--color=never"});
  if (options.allow_outside) words.options.emplace_back("--allow-outside");
  const auto child = run_this_program(words, footprint, stop);
  return child.code == 0 || child.code == 1 ? child.out : "";
}

}  // namespace parallax::tools
