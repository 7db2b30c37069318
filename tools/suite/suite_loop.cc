#include "tools/suite/suite_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>

#include "compiler/base/shown_text.h"
#include "compiler/base/subprocess.h"
#include "compiler/base/words.h"
#include "harness/report/text_layout.h"
#include "tools/suite/schedule.h"

namespace parallax::tools {
namespace {

/// A case to be run, with its time and memory as far as they are known.
Task task_of(std::size_t index, const SuiteCase& one, const StoredCases& earlier) {
  constexpr std::int64_t kUnknownMb = 500;
  Task task{index, std::nullopt, kUnknownMb};
  if (const auto* traces = std::get_if<harness::ManifestCase>(&one.check)) {
    task.memory_mb = traces->memory_limit_mb.value_or(kUnknownMb);
  }
  const auto at = earlier.find(one.name());
  if (at == earlier.end() || at->second.result.wall_s <= 0) return task;
  task.wall_s = at->second.result.wall_s;
  if (at->second.result.peak_memory_mb > 0) task.memory_mb = at->second.result.peak_memory_mb;
  return task;
}

struct Mark {
  std::string_view text, color;
};

Mark mark_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::kPassed:
      return {"ok   ", "1;32"};
    case Outcome::kFailed:
      return {"FAIL ", "1;31"};
    case Outcome::kInconclusive:
      return {"OPEN ", "1;33"};
    case Outcome::kRemoved:
      return {"GONE ", "1;33"};
    case Outcome::kError:
    case Outcome::kNotFinished:
    case Outcome::kSkipped:
      break;
  }
  return {"ERROR", "1;31"};
}

constexpr std::string_view kIndent = "       ";

/// Further lines below a case. With `breaks` long sentences are broken: lines without indentation
/// and columns.
void append_lines(const std::string& text, bool breaks, std::string& out) {
  auto rest = std::string_view(text);
  while (rest.ends_with('\n')) rest.remove_suffix(1);
  while (!rest.empty()) {
    const auto line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    out += '\n';
    const bool is_sentence = !line.starts_with(' ') && line.find("  ") == std::string_view::npos;
    if (breaks && is_sentence) {
      out += harness::wrapped(kIndent, line, kIndent.size(), kSuiteColumns);
      out.pop_back();
    } else {
      out += fmt::format("{}{}", kIndent, base::shown_lines(line));
    }
  }
}

}  // namespace

std::string line_of(const SuiteCase& one, const CaseResult& result, bool color) {
  const auto mark = mark_of(result.outcome);
  const auto how = result.reused.empty() ? fmt::format("{:.1f} s", result.wall_s) : result.reused;
  auto line =
      color ? fmt::format("\x1b[{}m{}\x1b[0m", mark.color, mark.text) : std::string(mark.text);
  line += ' ' + base::printable(one.name());
  if (result.outcome != Outcome::kRemoved) line += fmt::format(" ({})", how);
  if (result.flaky()) line += fmt::format(", flaky: passed in attempt {}", result.attempts);
  for (const auto& rate : result.rates) {
    if (rate.fixed || result.outcome != Outcome::kPassed) continue;
    line += fmt::format(", shown by {} runs", rate.runs + rate.lost);
    break;
  }
  if (!result.golden_written.empty()) {
    line +=
        fmt::format("\n{}golden file written: {}", kIndent, base::printable(result.golden_written));
  }
  for (const auto& problem : result.problems) append_lines(problem, true, line);
  // For a case without an answer, the messages of the program take its place.
  if (result.outcome == Outcome::kError) append_lines(result.messages, false, line);
  return line;
}

void Reuse::resume(const StoredCases& earlier, bool permits_more, bool starts_commands) {
  for (std::size_t i = 0; i < record_.cases().size(); ++i) {
    const auto at = earlier.find(record_.cases()[i].name());
    if (!is_open(i) || at == earlier.end()) continue;
    auto result = at->second.result;
    const bool finished =
        result.outcome != Outcome::kNotFinished && result.outcome != Outcome::kSkipped;
    if (permits_more && result.outcome == Outcome::kError) continue;
    // Nobody knows what the program of another simulator reads: a module that it imports may have
    // changed.
    if (starts_commands && !record_.cases()[i].command.empty()) continue;
    // The expectation may have changed although no file that was read has.
    if (at->second.one.revision != record_.cases()[i].revision) continue;
    if (!finished || result.inputs.empty() || !hashes_.unchanged(result.inputs)) continue;
    if (result.ledger != ledger_digest_of(cache_.key().ledger, record_.cases()[i])) continue;
    result.reused = "resumed";
    take(i, std::move(result));
  }
}

void Reuse::look_up(double verified_share) {
  std::vector<std::pair<std::size_t, ResultCache::Hit>> hits;
  std::size_t damaged = 0;
  for (std::size_t i = 0; i < record_.cases().size(); ++i) {
    if (!is_open(i) || !record_.cases()[i].command.empty()) continue;
    if (auto hit = cache_.find(record_.cases()[i], hashes_, damaged)) {
      hits.emplace_back(i, *std::move(hit));
    }
  }
  if (damaged > 0) {
    voice_.remark(fmt::format("{} not what was written; not used",
                              base::counted(damaged, "cached result is", "cached results are")));
  }
  std::stable_sort(hits.begin(), hits.end(), [](const auto& a, const auto& b) {
    return a.second.age_order < b.second.age_order;
  });
  const auto verified =
      static_cast<std::size_t>(std::ceil(verified_share * static_cast<double>(hits.size())));
  const auto open = hits.begin() + static_cast<std::ptrdiff_t>(verified);
  for (auto hit = hits.begin(); hit != open; ++hit) {
    to_verify_.emplace(hit->first, std::move(hit->second));
  }
  std::sort(open, hits.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (auto hit = open; hit != hits.end(); ++hit) {
    passes_.keep(record_.cases()[hit->first], hit->second.result);
    take(hit->first, std::move(hit->second.result));
  }
}

bool Reuse::is_open(std::size_t i) const {
  return record_.results()[i].outcome == Outcome::kNotFinished;
}

void Reuse::verify(std::size_t i, CaseResult& result) const {
  const auto at = to_verify_.find(i);
  if (at == to_verify_.end()) return;
  auto what = disagreement(at->second.result, result);
  if (what.empty()) return;
  result.outcome = Outcome::kError;
  result.problems.insert(result.problems.begin(), std::move(what));
  std::error_code error;
  std::filesystem::remove(at->second.file, error);
}

void Reuse::take(std::size_t i, CaseResult result) {
  voice_.finished(record_.cases()[i], result);
  record_.finish(i, std::move(result));
}

void run_open_cases(SuiteRecord& record, const LoopOptions& options, const StoredCases& earlier,
                    const Reuse& reuse, const ResultCache& cache, const LastPasses& passes,
                    const SuiteVoice& voice, const std::atomic<bool>& stop) {
  std::vector<Task> tasks;
  for (std::size_t i = 0; i < record.cases().size(); ++i) {
    if (reuse.is_open(i)) tasks.push_back(task_of(i, record.cases()[i], earlier));
  }
  Schedule schedule(std::move(tasks), options.memory_mb);
  std::mutex printing;
  const auto work = [&](std::int64_t number) {
    auto runner = options.runner;
    if (options.spread) {
      runner.elsewhere.insert(runner.elsewhere.end(), {"--first-slot", std::to_string(number)});
    }
    while (!stop.load()) {
      const auto index = schedule.take();
      if (!index) return;
      const auto& one = record.cases()[*index];
      if (!one.command.empty() && options.runner.allow_commands) {
        const std::lock_guard lock(printing);
        voice.remark(fmt::format("{} starts `{}`", one.name(), base::command_text(one.command)));
      }
      auto result = run_case(one, runner, stop);
      if (result.outcome != Outcome::kNotFinished) {
        reuse.verify(*index, result);
        if (options.keep_passes) {
          (void)cache.store(one, result);
          passes.keep(one, result);
        }
        const std::lock_guard lock(printing);
        voice.finished(one, result);
      }
      record.finish(*index, std::move(result));
      schedule.done(*index);
    }
  };
  std::vector<std::thread> threads;
  for (std::int64_t i = 0; i < options.jobs; ++i) threads.emplace_back(work, i);
  for (auto& thread : threads) thread.join();
}

}  // namespace parallax::tools
