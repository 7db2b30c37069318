#pragma once

#include <cstdint>
#include <vector>

#include "compiler/reference/expanded_model.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// A rule that a valuation breaks.
struct ReferenceFinding {
  enum class Rule : std::uint8_t {
    kAxiom,            // index: conjunct
    kNoninertial,      // a noninertial fluent is not released
    kReleasedAtStart,  // a fluent with inertia is
    kFrame,            // DEC5 to DEC8
    kEffect,           // DEC9 to DEC12; index: row of (fluent, timepoint)
    kTrajectory,       // DEC3 or DEC4; index: path
    kCompletion        // index: completed atom
  };
  Rule rule = Rule::kAxiom;
  int dec = 0;  // the number of the DEC axiom
  std::size_t index = 0;
  std::uint32_t fluent = 0;
  std::int64_t timepoint = 0;
};

/// One look at an expanded model under one assignment of its atoms. What needs a timepoint after
/// `last` is left out.
class ReferenceSearch {
 public:
  using Values = std::vector<std::uint8_t>;
  ReferenceSearch(const TypedModel& model, const ExpandedModel& expanded, const Values& values,
                  std::int64_t last)
      : model_(model), expanded_(expanded), values_(values), last_(last) {}

  /// Ends at `limit` findings, or when more than `max_reasons` formulas were evaluated to find
  /// reasons of completed atoms.
  void run(std::size_t limit, std::int64_t max_reasons);
  const std::vector<ReferenceFinding>& found() const { return found_; }
  bool finished() const { return finished_; }

 private:
  enum class Truth : std::uint8_t { kFalse, kTrue, kUnknown };
  using Rule = ReferenceFinding::Rule;

  bool full() const { return found_.size() >= limit_; }
  void note(const ReferenceFinding& finding) {
    if (!full()) found_.push_back(finding);
  }
  bool is_true(std::uint32_t atom) const { return values_[atom] != 0; }
  Truth value(const ReferenceFormula& formula) const;
  /// Does an event change the fluent this way at t?
  Truth changed(EffectKind kind, std::uint32_t fluent, std::int64_t t) const;
  Truth fires(const ExpandedModel::EffectRow& row, std::int64_t t) const;

  void check_axioms();
  void check_releases();
  void check_frame(std::uint32_t fluent, std::int64_t t);
  void check_effects(std::uint32_t fluent, std::int64_t t);
  void check_path(std::size_t index);
  void check_completion(std::int64_t max_reasons);
  bool has_reason(const ExpandedModel::Completed& completed, Values& changed) const;

  const TypedModel& model_;
  const ExpandedModel& expanded_;
  const Values& values_;
  std::int64_t last_ = 0;
  std::size_t limit_ = 0;
  std::vector<ReferenceFinding> found_;
  bool finished_ = true;
};

}  // namespace parallax::compiler
