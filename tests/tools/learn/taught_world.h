#pragma once

#include <doctest/doctest.h>

#include <atomic>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/sema/check.h"
#include "compiler/syntax/loader.h"
#include "tools/learn/learned_model.h"
#include "tools/repair/domain_model.h"

namespace parallax::tools {

/// Declarations and runs, without a simulator, and what is learned from them.
class TaughtWorld {
 public:
  explicit TaughtWorld(std::string declarations) : declarations_(std::move(declarations)) {
    const auto file = files_.add("world.e", declarations_);
    ast_ = std::make_unique<compiler::ModelAst>(
        *compiler::load_model_text(file, ".", {}, files_, sink_));
    compiler::CheckOptions check;
    check.time_lower = 0;
    check.time_upper = 1;
    typed_ =
        std::make_unique<compiler::TypedModel>(*compiler::check_model(*ast_, files_, sink_, check));
    vocabulary_ = std::make_unique<LearnVocabulary>(*typed_);
    std::string why;
    model_ = compile_text(declarations_, 1, context_, why);
    REQUIRE(model_);
    completion_ = std::make_unique<StateCompletion>(*model_, *vocabulary_, context_.stop());
    observations_ = std::make_unique<Observations>(*vocabulary_, *completion_);
  }

  /// A run that is learned from.
  void add(Evidence run) {
    run.ids = {"1." + std::to_string(all_.size() + 1)};
    CHECK_FALSE(observations_->add(run).has_value());
    all_.push_back(std::move(run));
  }

  LearnedEffects learn() const {
    const std::atomic<bool> stop{false};
    return learn_effects(*observations_, {}, {}, stop);
  }
  std::set<std::string> axioms() const {
    std::set<std::string> out;
    for (const auto& rule : learn().rules) out.insert(print(rule, *vocabulary_));
    return out;
  }
  /// How many of the runs, those that were learned from or others, the learned model admits.
  RunsCheck check() const { return check(all_); }
  RunsCheck check(const std::vector<Evidence>& runs) const {
    const auto effects = learn();
    const auto text = learned_text("; Learned.", declarations_, effects, *vocabulary_, "");
    return check_runs(text, runs, effects.rules, *vocabulary_, context_);
  }

 private:
  std::string declarations_;
  base::SourceFiles files_;
  base::DiagnosticSink sink_;
  Context context_;
  std::unique_ptr<compiler::ModelAst> ast_;
  std::unique_ptr<compiler::TypedModel> typed_;
  std::unique_ptr<LearnVocabulary> vocabulary_;
  std::optional<compiler::CompiledModel> model_;
  std::unique_ptr<StateCompletion> completion_;
  std::unique_ptr<Observations> observations_;
  std::vector<Evidence> all_;
};

}  // namespace parallax::tools
