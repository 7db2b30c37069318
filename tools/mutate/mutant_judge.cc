#include "tools/mutate/mutant_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "compiler/base/path_gate.h"
#include "runtime/compare/trace_difference.h"
#include "tools/app/plan_reservations.h"
#include "tools/diff/model_difference.h"
#include "tools/mutate/case_model.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

std::string first_error_of(const base::DiagnosticSink& sink) {
  for (const auto& diagnostic : sink.sorted()) {
    if (base::info(diagnostic.code).severity == base::Severity::kError) return diagnostic.message;
  }
  return {};
}

/// Time limit for a scenario without one of its own, from its time with the original.
double limit_of_run(double wall_s) {
  constexpr double kLeast = 60.0, kTimes = 10.0;
  return std::max(kLeast, kTimes * wall_s);
}

}  // namespace

MutantJudge::MutantJudge(const JudgedSuite& suite, const ScratchCopy& copy,
                         std::vector<SuiteCase> own_cases, CpuWatch& watch, std::size_t thread,
                         const std::atomic<bool>& stop)
    : suite_(suite),
      copy_(copy),
      own_cases_(std::move(own_cases)),
      watch_(watch),
      thread_(thread),
      stop_(stop) {}

std::vector<std::string> MutantJudge::outside(std::size_t index) {
  Context context({.allow_outside = suite_.allow_outside}, watch_.flag(thread_));
  (void)load_case_model(own_cases_[index], context);
  std::vector<std::string> out;
  const auto add = [&](const std::string& name) {
    std::error_code error;
    if (!fs::is_regular_file(name, error) || base::lies_below(name, copy_.folder())) return;
    out.push_back(base::real_path(name).string());
  };
  for (std::uint32_t i = 0; i < context.files().size(); ++i) {
    add(context.files()[base::FileId(i)].name());
  }
  for (const auto& name : context.files().inputs()) add(name);
  return out;
}

MutantJudge::Told MutantJudge::compare_models(const CaseModel& original, const CaseModel& mutated,
                                              const std::atomic<bool>& flag) {
  Told out;
  runtime::DifferenceOptions options;
  options.any_difference = true;
  options.stop = &flag;
  const auto found = runtime::compare_traces(original.compiled, mutated.compiled, options);
  for (const auto* side : {&found.lost, &found.gained}) {
    if (side->answer != runtime::DifferenceAnswer::kFound) continue;
    out.answer = Told::Answer::kDiffers;
    out.judgement.gained = side == &found.gained;
    out.judgement.excluded_by = side->witness->excluded_by;
    out.judgement.trace = beginning_text(*side->witness);
    out.judgement.trace_json = observable_jsonl(side->witness->trace);
    return out;
  }
  const bool decided = found.lost.answer == runtime::DifferenceAnswer::kNone &&
                       found.gained.answer == runtime::DifferenceAnswer::kNone;
  if (decided && found.vocabulary.is_same() &&
      original.compiled.horizon == mutated.compiled.horizon) {
    out.answer = Told::Answer::kSame;
  } else if (decided) {
    out.why = "the models have other names or horizons, and no trace tells them apart";
  } else if (flag.load()) {
    out.why = fmt::format("comparing the traces took more than {:g} s of processor time",
                          suite_.compare_s);
  } else {
    out.why = "no call decided whether the traces are the same";
  }
  return out;
}

MutantJudge::Told MutantJudge::compare(std::size_t index) {
  const auto& original = suite_.originals[index];
  if (!original) return {};
  auto& flag = watch_.flag(thread_);
  watch_.begin(thread_, suite_.compare_s);
  Context context({.allow_outside = suite_.allow_outside}, flag);
  const auto mutated = load_case_model(own_cases_[index], context);
  Told out;
  if (!mutated) {
    out.answer = flag.load() ? Told::Answer::kUnknown : Told::Answer::kInvalid;
    out.why = flag.load() ? "compiling it takes too long" : first_error_of(context.sink());
  } else if (original->key == mutated->key) {
    out.answer = Told::Answer::kSame;
  } else {
    const std::pair keys(original->key, mutated->key);
    auto known = compared_.find(keys);
    if (known == compared_.end()) {
      known = compared_.emplace(keys, compare_models(*original, *mutated, flag)).first;
    }
    out = known->second;
  }
  watch_.end(thread_);
  const auto name = suite_.cases[index].name();
  if (out.answer == Told::Answer::kDiffers) out.judgement.told_in = name;
  if (out.answer == Told::Answer::kUnknown) out.why = name + ": " + out.why;
  const bool told_otherwise = out.answer == Told::Answer::kSame && simulates(suite_.cases[index]) &&
                              original->plan && mutated->plan &&
                              !same_arguments(*original->plan, *mutated->plan);
  if (out.answer == Told::Answer::kSame) {
    auto left_out = reservations_of(original->plan);
    left_out.cut = goes_behind_cut(original->compiled) || goes_behind_cut(mutated->compiled);
    if (left_out.any()) {
      out.answer = Told::Answer::kUnknown;
      out.why = fmt::format("{}: the traces are the same, but they are {}", name, left_out.words());
    }
  }
  if (told_otherwise) {
    out.answer = Told::Answer::kUnknown;
    out.why = name + ": the traces are the same, but the plan tells controllers something else";
  }
  return out;
}

CaseResult MutantJudge::run(std::size_t index) {
  auto options = suite_.runner;
  options.out = copy_.folder().string() + "-runs";
  std::error_code error;
  fs::create_directories(options.out, error);
  options.ends_early = true;
  options.time_limit_s = limit_of_run(suite_.wall_s[index]);
  return run_case(own_cases_[index], options, stop_);
}

MutantJudgement MutantJudge::look_at(const Mutant& mutant) {
  const auto noticed = [&](std::size_t i, const CaseResult& result) {
    auto why = result.problems.empty() ? std::string() : result.problems.front();
    why = why.substr(0, why.find('\n'));
    // Removes the name of the copy's folder.
    for (auto at = why.find(copy_.folder().string()); at != std::string::npos;
         at = why.find(copy_.folder().string())) {
      why.erase(at, copy_.folder().string().size() + 1);
    }
    return MutantJudgement{MutantOutcome::kNoticed, suite_.cases[i].name(), std::move(why)};
  };
  std::optional<MutantJudgement> told;
  std::vector<std::size_t> to_run;
  std::string unknown, undecided;
  for (const auto i : mutant.cases) {
    if (simulates(suite_.cases[i])) continue;
    const auto result = run(i);
    if (stop_.load()) return {};
    if (result.outcome == Outcome::kPassed || result.outcome == Outcome::kInconclusive) continue;
    if (result.outcome == Outcome::kFailed) return noticed(i, result);
    // No answer: perhaps the mutant is not a valid model.
    auto found = compare(i);
    if (found.answer == Told::Answer::kInvalid) {
      return {MutantOutcome::kInvalid, "", std::move(found.why)};
    }
    return noticed(i, result);
  }
  for (const auto i : mutant.cases) {
    auto found = compare(i);
    if (stop_.load()) return {};
    if (found.answer == Told::Answer::kInvalid) {
      return {MutantOutcome::kInvalid, "", std::move(found.why)};
    }
    if (found.answer == Told::Answer::kSame) continue;
    if (simulates(suite_.cases[i])) to_run.push_back(i);
    if (found.answer == Told::Answer::kUnknown && unknown.empty()) unknown = std::move(found.why);
    if (found.answer == Told::Answer::kDiffers && !told) told = std::move(found.judgement);
  }
  for (const auto i : to_run) {
    const auto result = run(i);
    if (stop_.load()) return {};
    if (result.outcome == Outcome::kPassed) continue;
    const auto& expect = std::get<harness::Expectation>(suite_.cases[i].check);
    const auto limit = limit_of_run(suite_.wall_s[i]);
    if (!expect.time_limit_s && result.wall_s >= limit) {
      undecided =
          fmt::format("{}: its simulations took more than {:.0f} s", suite_.cases[i].name(), limit);
      continue;
    }
    return noticed(i, result);
  }
  if (!undecided.empty()) return {MutantOutcome::kUnknown, "", std::move(undecided)};
  if (told) {
    told->outcome = MutantOutcome::kUnnoticed;
    return *std::move(told);
  }
  if (!unknown.empty()) return {MutantOutcome::kUnknown, "", std::move(unknown)};
  return {MutantOutcome::kEquivalent};
}

base::Result<MutantJudgement> MutantJudge::judge(const Mutant& mutant, base::DiagnosticSink& sink) {
  if (!copy_.write(mutant.file, mutant.text, sink)) return sink.already_reported();
  compared_.clear();
  auto out = look_at(mutant);
  if (!copy_.restore(mutant.file, sink)) return sink.already_reported();
  return out;
}

std::vector<SuiteCase> cases_of_copy(std::vector<SuiteCase> cases, const ScratchCopy& copy) {
  for (auto& one : cases) {
    const auto in_copy = [&](std::string& name) { name = copy.place_of(name).string(); };
    const bool is_file = one.id == one.file;
    in_copy(one.file);
    if (is_file) one.id = one.file;
    auto* traces = std::get_if<harness::ManifestCase>(&one.check);
    if (traces == nullptr) continue;
    for (auto& model : traces->models) in_copy(model.text);
    if (traces->expect.golden) in_copy(traces->expect.golden->text);
  }
  return cases;
}

}  // namespace parallax::tools
