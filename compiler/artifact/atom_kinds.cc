#include "compiler/artifact/atom_kinds.h"

namespace parallax::compiler {
namespace {

constexpr AtomKind kAllKinds[] = {AtomKind::kHoldsAt,   AtomKind::kHappens,   AtomKind::kReleasedAt,
                                  AtomKind::kPredicate, AtomKind::kLocation,  AtomKind::kHit,
                                  AtomKind::kRunning,   AtomKind::kSucceeded, AtomKind::kResult,
                                  AtomKind::kRegister,  AtomKind::kAuxiliary, AtomKind::kUnused};

}  // namespace

std::string_view to_string(AtomKind kind) {
  switch (kind) {
    case AtomKind::kHoldsAt:
      return "HoldsAt";
    case AtomKind::kHappens:
      return "Happens";
    case AtomKind::kReleasedAt:
      return "ReleasedAt";
    case AtomKind::kPredicate:
      return "Predicate";
    case AtomKind::kLocation:
      return "Location";
    case AtomKind::kHit:
      return "Hit";
    case AtomKind::kRunning:
      return "Running";
    case AtomKind::kSucceeded:
      return "Succeeded";
    case AtomKind::kResult:
      return "Result";
    case AtomKind::kRegister:
      return "Register";
    case AtomKind::kAuxiliary:
      return "Auxiliary";
    case AtomKind::kUnused:
      return "Unused";
  }
  return {};
}

std::optional<AtomKind> atom_kind(std::string_view text) {
  for (const auto kind : kAllKinds) {
    if (to_string(kind) == text) return kind;
  }
  return std::nullopt;
}

}  // namespace parallax::compiler
