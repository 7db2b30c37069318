#include "compiler/artifact/origin.h"

namespace parallax::compiler {

std::string_view to_string(OriginKind kind) {
  switch (kind) {
    case OriginKind::kAxiom:
      return "axiom";
    case OriginKind::kEffectAxiom:
      return "effect axiom";
    case OriginKind::kTrajectoryAxiom:
      return "trajectory axiom";
    case OriginKind::kFrameAxiom:
      return "frame axiom";
    case OriginKind::kCompletion:
      return "completion";
    case OriginKind::kInvariant:
      return "state invariant";
    case OriginKind::kUnmentioned:
      return "atom without a mention";
    case OriginKind::kPlanStep:
      return "plan step";
    case OriginKind::kStateConstraint:
      return "state constraint";
    case OriginKind::kTrace:
      return "trace";
  }
  return {};
}

std::optional<OriginKind> origin_kind(std::string_view text) {
  for (const auto kind :
       {OriginKind::kAxiom, OriginKind::kEffectAxiom, OriginKind::kTrajectoryAxiom,
        OriginKind::kFrameAxiom, OriginKind::kCompletion, OriginKind::kInvariant,
        OriginKind::kUnmentioned, OriginKind::kPlanStep, OriginKind::kStateConstraint,
        OriginKind::kTrace}) {
    if (to_string(kind) == text) return kind;
  }
  return std::nullopt;
}

}  // namespace parallax::compiler
