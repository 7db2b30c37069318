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

/// The data of one trace for a claim about all traces.
struct FamilyMember {
  std::int64_t clean = 0, lost = 0, runs = 0;
  bool is_discrepancy = false;
  bool is_rejected = false;  // some of its starts were not valid
  CertifiedBound stated;     // by the criterion, with the whole error
  CertifiedBound shared;     // with the trace's share of the error
  DrawnStarts drawn{};       // how its starts are drawn
};

/// The relation of the simulated traces to all traces of the model.
struct FamilyScope {
  std::string completeness;    // "the model has no other trace"; empty: nothing is said
  bool split_initial = false;  // each initial state is a trace of its own
};

/// The claim that all traces support together, one sentence without a full stop: "with 99 %
/// confidence, for each of the 3 traces fewer than 5 % of start states drawn uniformly from its
/// start region give a discrepancy at any step (270 clean runs of 270); the model has no other
/// trace". It is made only if each trace passes, so the chance that it is false is at most that of
/// any one trace, and no error is shared (intersection-union test, Berger 1982). Traces that gave a
/// discrepancy are left out, and the text says so: what runs showed then chose the others, and each
/// has its share of the error (Bonferroni). With nothing to claim it is empty. The bound is their
/// largest, the confidence their least.
std::string family_claim(std::span<const FamilyMember> members, const CriterionSpec& spec,
                         Comparison comparison, const FamilyScope& scope);

/// The criterion in words: "clean-runs: 112 clean runs of each of 3 traces exclude p >= 5 % with 99
/// % confidence in all of them together". Without a rule it is about one trace by itself.
std::string criterion_text(const CriterionSpec& spec, const std::optional<SpendingRule>& rule);

}  // namespace parallax::harness
