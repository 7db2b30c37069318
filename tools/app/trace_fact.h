#pragma once

#include <optional>
#include <string>

#include "compiler/artifact/compiled_model.h"
#include "tools/app/context.h"

namespace parallax::tools {

/// A fact that a user asks about.
struct TraceFact {
  compiler::AtomKind kind = compiler::AtomKind::kHoldsAt;
  std::string name;
  std::optional<compiler::Timepoint> time;
  bool negated = false;
  /// None: no clause mentions the atom, it is false in every trace.
  std::optional<compiler::Literal> atom;
};

/// Reads `HoldsAt(F(a),3)`, `Happens(..)`, `ReleasedAt(..)` or the atom of a predicate, with `!`
/// before it or not; blanks do not count, `F` stands for `F()`. kNoSuchFact says where the text is
/// wrong and why, and which name is the nearest.
base::Result<TraceFact> parse_fact(const std::string& text, const compiler::CompiledModel& model,
                                   Context& context);

}  // namespace parallax::tools
