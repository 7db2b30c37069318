#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "harness/confidence/comparison.h"
#include "harness/confidence/criterion_spec.h"
#include "harness/search/strategy.h"

namespace parallax::harness {

struct CampaignOptions;
struct Scenario;

/// What a run was asked for beside its scenario, as the header of its journal says it. None: a
/// journal that does not say it, as older ones.
struct RecordedOptions {
  std::optional<CriterionKind> criterion;
  Family family = Family::kPerTrace;  // older journals know no other
  std::optional<std::int64_t> criterion_runs;
  std::optional<double> confidence_level, epsilon;
  std::optional<PaperRuleSpec> paper;
  std::optional<Comparison> compare;
  std::optional<bool> match_model;
  Execution execution = Execution::kOpenLoop;
  Starts starts = Starts::kUniform;
  bool keep_going = false, until_covered = false;
  bool all_hits = false, split_initial = false;
  SearchSpec search;
  bool random_sequences = false;  // what was simulated is no trace of the model

  /// Asks for the same of another run of the scenario.
  void apply(Scenario& scenario, CampaignOptions& options) const;
};

/// The text of them.
std::string recorded_options_json(const Scenario& scenario, const CampaignOptions& options);
/// What the text says, or what is wrong with it: "`options.criterion` is no object".
std::variant<RecordedOptions, std::string> recorded_options(std::string_view text);

}  // namespace parallax::harness
