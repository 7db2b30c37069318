#pragma once

#include <cstdint>
#include <vector>

#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// A group of fluents of which at most one holds at every timepoint, ascending.
using FluentGroup = std::vector<std::uint32_t>;

/// Is the model so large that instances are left out because an event and a fluent never meet?
/// In a smaller one they cost nothing. Not in the meaning of the 2005 reasoner, and not for
/// explanations, which are grounded without `relevance`.
bool drops_meetings(const GroundModel& model, const GroundOptions& options);

/// Which fluents are false whenever an event happens. What an event demands of the state (its
/// preconditions at every timepoint), and of which fluents at most one holds, say so: a robot that
/// moves to a place stands beside it, therefore nowhere else.
class Meetings {
 public:
  /// Nothing is known.
  Meetings() = default;
  /// Reads the preconditions among the constraints so far. Linear in these, and in the sizes of
  /// the groups that preconditions name.
  Meetings(const GroundModel& model, const std::vector<FluentGroup>& groups);

  bool empty() const { return absent_.empty(); }
  /// Can the fluent hold when the event happens?
  bool may_meet(std::uint32_t event, std::uint32_t fluent) const;
  /// The fluents that cannot, ascending.
  const std::vector<std::uint32_t>& absent(std::uint32_t event) const { return absent_[event]; }

 private:
  void read(FormulaId clause, const GroundModel& model);
  void read_clause(std::uint32_t event, const std::vector<FormulaId>& ways,
                   const GroundModel& model);

  const std::vector<FluentGroup>* groups_ = nullptr;   // while it is made
  std::vector<std::vector<std::uint32_t>> groups_of_;  // by fluent, into `groups`
  std::vector<std::vector<std::uint32_t>> absent_;     // by event
};

/// The rows that hold at every timepoint, with fluents that do not meet their event false in their
/// conditions; rows whose conditions become false are left out.
std::vector<EffectRow> rows_that_meet(const EffectRows& rows, const Meetings& meetings,
                                      GroundModel& model);

}  // namespace parallax::compiler
