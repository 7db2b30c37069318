#include "tools/mutate/suite_files.h"

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "compiler/base/file_io.h"
#include "compiler/base/file_names.h"
#include "compiler/base/path_gate.h"
#include "compiler/repair/mutation.h"
#include "compiler/sema/check.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

class SuiteReader {
 public:
  SuiteReader(const std::vector<SuiteCase>& cases, Context& context)
      : cases_(cases), context_(context) {}

  base::Result<SuiteFiles> read() {
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      if (context_.stopped() || !read_case(i)) return context_.sink().already_reported();
    }
    for (auto& mutant : out_.mutants) add_readers(mutant);
    std::stable_sort(out_.mutants.begin(), out_.mutants.end(),
                     [](const Mutant& a, const Mutant& b) {
                       return std::tie(a.file, a.line) < std::tie(b.file, b.line);
                     });
    return std::move(out_);
  }

 private:
  base::Status read_case(std::size_t i) {
    const auto& one = cases_[i];
    // Each case has its own list of files, so that files read for another case are not counted.
    Context own(context_.form(), context_.stop());
    auto model = load_case_model(one, own);
    out_.originals.emplace_back();
    if (model) {
      add_model_mutants(*model);
      if (model->scenario && !model->scenario->plan.empty()) add_plan_mutants(*model, own);
      out_.originals.back() = *std::move(model);
    }
    auto& reads = out_.reads.emplace_back();
    if (!keep(one.file, reads)) return context_.sink().already_reported();
    if (const auto* traces = std::get_if<harness::ManifestCase>(&one.check)) {
      for (const auto& text : traces->models) {
        if (!keep(text.text, reads)) return context_.sink().already_reported();
      }
      if (traces->expect.golden && !keep(traces->expect.golden->text, reads)) {
        return context_.sink().already_reported();
      }
    }
    for (std::uint32_t k = 0; k < own.files().size(); ++k) {
      if (!keep(own.files()[base::FileId(k)].name(), reads)) {
        return context_.sink().already_reported();
      }
    }
    for (const auto& input : own.files().inputs()) {
      if (!keep(input, reads)) return context_.sink().already_reported();
    }
    return base::Unit{};
  }

  /// Texts that are no files (of options, of the program itself) are passed over.
  base::Status keep(const std::string& name, std::set<std::string>& reads) {
    std::error_code error;
    if (!fs::is_regular_file(name, error)) return base::Unit{};
    reads.insert(base::real_path(name).string());
    const auto place = base::absolute_name(name);
    if (out_.texts.contains(place)) return base::Unit{};
    auto text = base::read_file(name, context_.sink());
    if (!text) return context_.sink().already_reported();
    context_.files().note_input(name);
    out_.texts.emplace(place, *std::move(text));
    return base::Unit{};
  }

  void add_model_mutants(const CaseModel& model) {
    base::SourceFiles files;
    base::DiagnosticSink unread;  // it was compiled before
    const auto ast = compiler::load_model(model.models, model.load, files, unread);
    if (!ast) return;
    compiler::CheckOptions check;
    check.time_lower = 0;
    check.time_upper = 1;
    const auto typed = compiler::check_model(*ast, files, unread, check);
    if (typed) add(compiler::model_mutations(*ast, *typed, files), files);
  }

  void add_plan_mutants(const CaseModel& model, Context& context) {
    const auto plan = load_scenario_plan(*model.scenario, context);
    if (!plan) return;
    const auto text = compiler::PlanText::read(context.files(), *plan);
    if (text) add(compiler::plan_mutations(*text), context.files());
  }

  /// Each text once, though several cases read it.
  void add(const std::vector<compiler::Mutation>& mutations, const base::SourceFiles& files) {
    for (const auto& mutation : mutations) {
      const auto& file = files[mutation.at.file];
      const bool elsewhere =
          std::any_of(mutation.changes.begin(), mutation.changes.end(),
                      [&](const auto& change) { return change.file != mutation.at.file; });
      if (elsewhere) continue;
      auto text = compiler::changed_text(file.text(), mutation.at.file, mutation.changes);
      const auto place = base::real_path(file.name()).string();
      if (text == file.text() || !made_.emplace(place, text).second) continue;
      out_.mutants.push_back({file.name(),
                              file.position(mutation.at.begin).line,
                              mutation.kind,
                              mutation.words,
                              std::move(text),
                              {}});
    }
  }

  void add_readers(Mutant& mutant) const {
    const auto place = base::real_path(mutant.file).string();
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      if (out_.reads[i].contains(place)) mutant.cases.push_back(i);
    }
    const auto cost = [&](std::size_t i) {
      const auto* run = std::get_if<harness::Expectation>(&cases_[i].check);
      return std::tuple(run != nullptr, run != nullptr && run->rate, run != nullptr && !run->fast,
                        out_.originals[i] ? out_.originals[i]->compiled.clauses.size() : 0, i);
    };
    std::sort(mutant.cases.begin(), mutant.cases.end(),
              [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
  }

  const std::vector<SuiteCase>& cases_;
  Context& context_;
  SuiteFiles out_;
  std::set<std::pair<std::string, std::string>> made_;  // file and text
};

}  // namespace

base::Result<SuiteFiles> look_at_suite(const std::vector<SuiteCase>& cases, Context& context) {
  return SuiteReader(cases, context).read();
}

void keep_spread(std::vector<Mutant>& mutants, std::size_t most) {
  if (most == 0 || mutants.size() <= most) return;
  std::vector<Mutant> kept;
  for (std::size_t i = 0; i < most; ++i) {
    kept.push_back(std::move(mutants[i * mutants.size() / most]));
  }
  mutants = std::move(kept);
}

}  // namespace parallax::tools
