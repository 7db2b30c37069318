#include "harness/confidence/family.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "compiler/base/contract.h"
#include "compiler/base/words.h"
#include "harness/confidence/criterion.h"
#include "harness/confidence/rounding.h"

namespace parallax::harness {
namespace {

/// "90 clean runs of each of 3 traces"
std::string runs_by_trace(const CriterionSpec& spec, const std::optional<SpendingRule>& rule,
                          std::string_view runs) {
  auto whole = spec;
  whole.share = 1.0;
  const auto needed = fmt::format("{} {}", planned_runs(whole), runs);
  if (!rule || rule->traces() == 1) return needed;
  if (rule->traces()) return fmt::format("{} of each of {} traces", needed, *rule->traces());
  return needed + " of each trace";
}

}  // namespace

double SpendingRule::share(std::int64_t k) const {
  PARALLAX_REQUIRE(k >= 1 && (!traces_ || k <= *traces_), "the number of a trace of the family");
  if (traces_) return 1.0 / static_cast<double>(*traces_);
  const auto place = static_cast<double>(k);
  return 6.0 / (std::numbers::pi * std::numbers::pi * place * place);
}

std::string SpendingRule::text() const {
  if (!traces_) {
    return "the whole error where each trace passes, else 6/(pi^2 k^2) of it for trace k";
  }
  if (*traces_ == 1) return "the whole error for the only trace";
  return fmt::format("the whole error where each of {} traces passes, else 1/{} of it for each",
                     *traces_, *traces_);
}

std::string family_claim(std::span<const FamilyMember> members, const CriterionSpec& spec,
                         Comparison comparison, const FamilyScope& scope) {
  std::int64_t clean = 0, lost = 0, runs = 0, claimed = 0;
  bool rejected = false;
  const std::string* law = nullptr;
  bool one_law = true;
  DrawnStarts drawn;
  CertifiedBound worst{spec.confidence_level, 0.0};
  const bool leaves_out = std::any_of(members.begin(), members.end(),
                                      [](const auto& member) { return member.is_discrepancy; });
  bool one_number = true, all_tried = true;
  std::int64_t least_tried = 0;
  const DrawnStates* states = nullptr;
  for (const auto& member : members) {
    if (member.is_discrepancy) continue;
    ++claimed;
    one_law = one_law && (law == nullptr || *law == member.drawn.law);
    law = &member.drawn.law;
    if (!member.drawn.left_out.empty()) drawn.left_out = member.drawn.left_out;
    clean += member.clean;
    lost += member.lost;
    runs += member.runs;
    rejected = rejected || member.is_rejected;
    const auto& initial = member.drawn.initial;
    one_number = one_number && (states == nullptr || states->all == initial.all);
    least_tried = states == nullptr ? initial.tried : std::min(least_tried, initial.tried);
    if (states == nullptr || initial.all != 1) states = &initial;
    all_tried = all_tried && initial.all && initial.tried >= *initial.all;
    const auto& bound = leaves_out ? member.shared : member.stated;
    worst.confidence_level = std::min(worst.confidence_level, bound.confidence_level);
    worst.epsilon = std::max(worst.epsilon, bound.epsilon);
  }
  if (law != nullptr) drawn.law = one_law ? *law : std::string("of each trace");
  if (claimed == 0 || worst.epsilon >= 1.0 || worst.confidence_level <= 0.0) return {};
  const auto all = std::ssize(members);
  const auto of_traces =
      all == 1         ? std::string()
      : claimed == all ? fmt::format("for each of the {} traces ", all)
      : claimed == 1   ? fmt::format("for the one of {} traces that gave no discrepancy ", all)
                       : fmt::format(
                             "for each of the {} of {} traces that gave no "
                               "discrepancy ",
                             claimed, all);
  const bool as_planned = spec.kind != CriterionKind::kPaper && worst.epsilon <= spec.epsilon;
  const auto lost_text = lost == 0
                             ? std::string()
                             : fmt::format(", {} counted as {}", base::counted(lost, "lost run"),
                                           base::agreed(lost, "a failure", "failures"));
  if (one_number) {
    drawn.initial = *states;
    drawn.initial.tried = least_tried;
  } else {
    drawn.initial = {states->law, 1, all_tried ? 1 : 0, 0, true};
  }
  const double epsilon = as_planned ? spec.epsilon : worst.epsilon;
  const auto region = all == 1 ? "the start region" : "its start region";
  auto text = fmt::format(
      "with {} confidence, {}fewer than {} of {} give a discrepancy {}{} ({} clean {} of {}{}){}",
      level_text(worst.confidence_level), of_traces, percent_up(epsilon),
      starts_text(region, drawn, rejected),
      comparison == Comparison::kFinal ? "in the last state" : "at any step",
      single_state_text(drawn.initial, epsilon), clean, base::agreed(clean, "run", "runs"), runs,
      lost_text, kSupposition);
  if (!scope.completeness.empty()) text += "; " + scope.completeness;
  if (scope.split_initial) {
    text += "; each initial state that leads to the same events counts as a trace";
  }
  return text;
}

std::string criterion_text(const CriterionSpec& spec, const std::optional<SpendingRule>& rule) {
  if (spec.kind == CriterionKind::kPaper) {
    return fmt::format("paper ({}) at C = {}; not a probability of error", spec.paper.preset,
                       level_text(spec.confidence_level));
  }
  const auto epsilon = percent_up(spec.epsilon);
  const auto confidence =
      fmt::format("{} confidence{}", level_text(spec.confidence_level),
                  rule && rule->traces() != 1 ? " in all of them together" : "");
  if (spec.kind == CriterionKind::kAnytime) {
    return fmt::format("anytime: {} exclude p >= {} with {}, more after lost ones",
                       runs_by_trace(spec, rule, "clean runs"), epsilon, confidence);
  }
  if (spec.kind == CriterionKind::kClopperPearson) {
    return fmt::format("clopper-pearson: {}, then one look; p >= {} is to be excluded with {}",
                       runs_by_trace(spec, rule, "runs"), epsilon, confidence);
  }
  return fmt::format("clean-runs: {} exclude p >= {} with {}",
                     runs_by_trace(spec, rule, "clean runs"), epsilon, confidence);
}

}  // namespace parallax::harness
