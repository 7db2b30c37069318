#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "harness/confidence/comparison.h"
#include "harness/confidence/criterion.h"
#include "harness/confidence/criterion_spec.h"
#include "harness/confidence/spending.h"

namespace parallax::harness {

/// What is known of one trace when a claim about all of them is made.
struct FamilyMember {
  std::int64_t clean = 0, lost = 0, runs = 0;
  bool is_discrepancy = false;
  bool is_rejected = false;     // of its starts some were not valid
  bool is_first_start = false;  // other initial states lead to the same events
  CertifiedBound stated;        // by the criterion, with the trace's share of the error
  DrawnStarts drawn{};          // how its starts are drawn
};

/// What the traces are among all of the model's.
struct FamilyScope {
  std::string completeness;    // "the model has no other trace"; empty: nothing is said
  bool split_initial = false;  // each initial state is a trace of its own
};

/// What all traces support together, one sentence without a full stop: "with 99 % confidence, for
/// each of the 3 traces fewer than 5 % of start states drawn uniformly from its start region give a
/// discrepancy at any step (336 clean runs of 336); the model has no other trace". Traces that gave
/// a discrepancy are left out and said to be; with nothing to claim it is empty. The bound is the
/// worst of theirs, the confidence the least.
std::string family_claim(std::span<const FamilyMember> members, const CriterionSpec& spec,
                         Comparison comparison, const FamilyScope& scope);

/// "clean-runs: 112 clean runs of each of 3 traces exclude p >= 5 % with 99 % confidence in all of
/// them together"; without a rule of one trace by itself.
std::string criterion_text(const CriterionSpec& spec, const std::optional<SpendingRule>& rule);

}  // namespace parallax::harness
