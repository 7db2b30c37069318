#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/compare/fact.h"
#include "harness/confidence/rate_evidence.h"
#include "harness/confidence/run_result.h"
#include "tools/app/context.h"

namespace parallax::tools {

/// The initial states that the runs of a trace began in.
struct RevisionInitial {
  /// "uniform", "weights" or "first"; files of versions that sampled only the first do not say it.
  std::string law = "first";
  std::optional<std::int64_t> all;  // none: more than are listed; of "first" also: not known
  std::string states{};             // hash of which they are; empty: an earlier version's file

  bool is_one_state() const { return law == "first" || all == 1; }
};

/// The rates that `parallax rates --json` found for one trace.
struct RevisionRates {
  std::string events;
  harness::RateCounts any;
  struct Cause {
    std::string text;
    std::int64_t count = 0;
  };
  std::vector<Cause> causes;
  std::string law{};  // by which starts were drawn, in words; empty: uniformly
  RevisionInitial initial{};
  struct Run {
    harness::RunResult result = harness::RunResult::kClean;
    std::string start;  // hash of its variables
  };
  std::vector<Run> runs{};  // by sample number; empty: not listed (`rates --outcomes`)
};

struct RatesRevision {
  std::string name;  // the file
  std::string scenario, compare;
  /// The comparison of each fluent, "Open(..) every-step, Parked() ignored". What says nothing is
  /// empty in files of earlier versions.
  std::string compared{};
  std::string match{};                        // "model", "trace"
  std::string simulator{}, scenario_hash{};   // for people
  std::string starts_hash{}, judging_hash{};  // of the scenario's settings
  bool says_what_it_is_of() const { return !compared.empty() || !starts_hash.empty(); }
  std::uint64_t seed = 0;
  bool complete = false;  // all runs were made
  bool fixed = true;      // their number did not depend on what they came to
  std::vector<RevisionRates> traces;
};

/// Reports kNoRatesResult for a file without rates, or whose counts contradict each other.
base::Result<RatesRevision> load_rates(const std::string& path, Context& context);
/// The same for a text; `name`: as messages call it.
base::Result<RatesRevision> parse_rates(const std::string& name, const std::string& text,
                                        Context& context);

/// "uniform of 6", "the first of 6", "only the first" where nothing says of how many.
std::string initial_text(const RevisionInitial& initial);

/// The rates as facts: what was counted as declarations, the counts as axioms.
std::vector<compiler::Fact> rates_facts(const RatesRevision& rates);

}  // namespace parallax::tools
