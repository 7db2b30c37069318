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

/// The options of a run besides its scenario, as the header of its journal records them. None: the
/// journal does not record the option, as older ones do not.
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

/// The options as the text that the header records.
std::string recorded_options_json(const Scenario& scenario, const CampaignOptions& options);
/// Parses that text, or says what is wrong with it: "`options.criterion` is no object".
std::variant<RecordedOptions, std::string> recorded_options(std::string_view text);

}  // namespace parallax::harness
