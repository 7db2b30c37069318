#include "tools/mutate/mutation_score.h"

#include <fmt/format.h>
#include <stdlib.h>  // NOLINT: mkdtemp

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <memory>
#include <mutex>
#include <set>
#include <thread>

#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/sha256.h"
#include "compiler/base/temporary_folder.h"
#include "compiler/base/words.h"
#include "tools/mutate/case_model.h"
#include "tools/mutate/judged_mutants.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Calls `work(thread, i)` for all i below `count`, from several threads.
template <typename Work>
void for_all(std::size_t count, std::int64_t jobs, const std::atomic<bool>& stop,
             const Work& work) {
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> threads;
  for (std::int64_t k = 0; k < jobs; ++k) {
    threads.emplace_back([&, k] {
      for (auto i = next++; i < count && !stop.load(); i = next++) {
        work(static_cast<std::size_t>(k), i);
      }
    });
  }
  for (auto& thread : threads) thread.join();
}

class SuiteMutation {
 public:
  SuiteMutation(const std::vector<SuiteCase>& cases, const MutationOptions& options,
                Context& context)
      : cases_(cases), options_(options), context_(context), results_(cases.size()) {}

  base::Result<MutationScore> run() {
    score_.cases = cases_.size();
    if (!run_originals()) return std::move(score_);
    auto files = look_at_suite(cases_, context_);
    if (context_.stopped()) return std::move(score_);
    if (!files) return context_.sink().already_reported();
    files_ = *std::move(files);
    if (!judge_all()) return context_.sink().already_reported();
    if (!score_.red.empty()) return std::move(score_);
    score_.mutants = std::move(files_.mutants);
    return std::move(score_);
  }

 private:
  /// False if a case does not pass.
  bool run_originals() {
    InputHashes hashes;
    std::size_t damaged = 0;
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      auto hit = options_.cache != nullptr ? options_.cache->find(cases_[i], hashes, damaged)
                                           : std::nullopt;
      if (hit && cases_[i].command.empty()) {
        results_[i] = std::move(hit->result);
      } else {
        open.push_back(i);
      }
    }
    for_all(open.size(), options_.jobs, context_.stop(), [&](std::size_t, std::size_t k) {
      const auto i = open[k];
      results_[i] = run_case(cases_[i], options_.runner, context_.stop());
      if (options_.cache != nullptr) (void)options_.cache->store(cases_[i], results_[i]);
      say(line_of(cases_[i], results_[i]));
    });
    for (std::size_t i = 0; i < cases_.size() && !context_.stopped(); ++i) {
      if (results_[i].outcome == Outcome::kPassed) continue;
      score_.red.push_back(line_of(cases_[i], results_[i]));
    }
    if (score_.red.empty() && !context_.stopped()) {
      say("the suite passes: " + base::counted(std::ssize(cases_), "case"));
    }
    return score_.red.empty() && !context_.stopped();
  }

  void choose() {
    if (!options_.only_files.empty()) {
      std::erase_if(files_.mutants, [&](const Mutant& mutant) {
        return mutant.file.find(options_.only_files) == std::string::npos;
      });
    }
    score_.made = files_.mutants.size();
    keep_spread(files_.mutants, options_.at_most);
  }

  /// Everything that the judgements depend on.
  std::string identity() const {
    std::string all = program_hash() + '\n' + std::to_string(options_.runner.seed) + '\n';
    for (const auto& one : cases_) all += one.name() + '\n';
    for (const auto& [name, text] : files_.texts) {
      all += name + ' ' + base::sha256_hex(text) + '\n';
    }
    return base::sha256_hex(all);
  }

  base::Status judge_all() {
    auto& sink = context_.sink();
    auto judged =
        JudgedMutants::open(options_.out / kJudgedFile, identity(), options_.resume, sink);
    if (!judged) return sink.already_reported();
    const base::TemporaryFolder scratch("mutants");
    if (scratch.path().empty()) {
      return sink.error_about(codes::kFileNotWritable, "", "no temporary folder can be made");
    }
    std::vector<double> wall_s;
    for (const auto& result : results_) wall_s.push_back(result.wall_s);
    const JudgedSuite suite{cases_, files_.originals, wall_s, options_.runner,
                            context_.form().allow_outside};
    const auto jobs = static_cast<std::size_t>(options_.jobs);
    CpuWatch watch(jobs, context_.stop());
    std::vector<ScratchCopy> copies;
    std::vector<std::unique_ptr<MutantJudge>> judges;
    copies.reserve(jobs);
    for (std::size_t k = 0; k < jobs; ++k) {
      auto copy = ScratchCopy::make(files_.texts, scratch.path() / std::to_string(k + 1), sink);
      if (!copy) return sink.already_reported();
      copies.push_back(*std::move(copy));
      judges.push_back(std::make_unique<MutantJudge>(
          suite, copies.back(), cases_of_copy(cases_, copies.back()), watch, k, context_.stop()));
    }
    pass_over(*judges.front());
    choose();
    if (!run_copies(judges)) return base::Unit{};
    score_.judgements.resize(files_.mutants.size());
    begin_ = last_ = Clock::now();
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < files_.mutants.size(); ++i) {
      auto known = judged->find(files_.mutants[i]);
      if (known) score_.judgements[i] = *std::move(known);
      if (!known) open.push_back(i);
    }
    if (open.size() < files_.mutants.size()) {
      say(fmt::format("{} mutants were judged before", files_.mutants.size() - open.size()));
    }
    open_ = open.size();
    std::vector<base::DiagnosticSink> sinks(jobs);
    for_all(open.size(), options_.jobs, context_.stop(), [&](std::size_t k, std::size_t n) {
      const auto i = open[n];
      auto judgement = judges[k]->judge(files_.mutants[i], sinks[k]);
      if (!judgement) {
        const std::lock_guard lock(mutex_);
        failed_ = true;
        sink = sinks[k];  // there was nothing in it
        context_.stop().store(true);
        return;
      }
      if (judgement->outcome == MutantOutcome::kOpen) return;
      judged->add(files_.mutants[i], *judgement);
      score_.judgements[i] = *std::move(judgement);
      progress(score_.judgements[i], files_.mutants[i]);
    });
    if (failed_) return sink.already_reported();
    if (const int error = judged->write_error(); error != 0) {
      const auto file = options_.out / kJudgedFile;
      sink.error_about(codes::kFileNotWritable, file.string(), std::strerror(error));
    }
    return base::Unit{};
  }

  /// Without a mistake the copies answer as the originals do. False if one does not.
  bool run_copies(const std::vector<std::unique_ptr<MutantJudge>>& judges) {
    std::vector<CaseResult> results(cases_.size());
    for_all(cases_.size(), options_.jobs, context_.stop(), [&](std::size_t k, std::size_t i) {
      if (!simulates(cases_[i])) results[i] = judges[k]->run(i);
    });
    for (std::size_t i = 0; i < cases_.size() && !context_.stopped(); ++i) {
      if (simulates(cases_[i]) || results[i].outcome == Outcome::kPassed) continue;
      score_.red.push_back("in a copy of its files: " + line_of(cases_[i], results[i]));
    }
    return score_.red.empty();
  }

  /// Removes mutants of files that a case names by an absolute name: the original is read, not the
  /// copy with the mistake, so nobody would notice it.
  void pass_over(MutantJudge& judge) {
    std::set<std::string> outside;
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      for (auto& name : judge.outside(i)) outside.insert(std::move(name));
    }
    if (outside.empty()) return;
    std::set<std::string> named;
    std::erase_if(files_.mutants, [&](const Mutant& mutant) {
      if (!outside.contains(base::real_path(mutant.file).string())) return false;
      named.insert(mutant.file);
      return true;
    });
    for (const auto& name : named) {
      score_.passed_over.push_back(
          name + " is named by an absolute name, or found in the current folder: not mutated");
    }
  }

  void say(const std::string& text) {
    const std::lock_guard lock(mutex_);
    context_.remark(text);
  }

  void progress(const MutantJudgement& judgement, const Mutant& mutant) {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (judgement.outcome == MutantOutcome::kUnnoticed) {
      context_.remark(fmt::format("unnoticed {}:{} {}", mutant.file, mutant.line, mutant.kind));
    }
    constexpr auto kEvery = std::chrono::seconds(10);
    const auto now = Clock::now();
    if (now - last_ < kEvery || done_ == open_) return;
    last_ = now;
    const std::chrono::duration<double> past = now - begin_;
    const auto left =
        past.count() / static_cast<double>(done_) * static_cast<double>(open_ - done_);
    context_.remark(fmt::format("{} of {} mutants, about {:.0f} s left", done_, open_, left));
  }

  const std::vector<SuiteCase>& cases_;
  const MutationOptions& options_;
  Context& context_;
  std::vector<CaseResult> results_;  // of the cases as they are
  SuiteFiles files_;
  MutationScore score_;
  std::mutex mutex_;
  Clock::time_point begin_, last_;
  std::size_t done_ = 0, open_ = 0;
  bool failed_ = false;
};

}  // namespace

std::size_t MutationScore::count(MutantOutcome outcome) const {
  return static_cast<std::size_t>(std::count_if(
      judgements.begin(), judgements.end(),
      [&](const MutantJudgement& judgement) { return judgement.outcome == outcome; }));
}

base::Result<MutationScore> score_suite(const std::vector<SuiteCase>& cases,
                                        const MutationOptions& options, Context& context) {
  return SuiteMutation(cases, options, context).run();
}

}  // namespace parallax::tools
