#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/base/source_file.h"

namespace parallax::compiler {

/// What kind of text a clause comes from.
enum class OriginKind : std::uint8_t {
  kAxiom,
  kEffectAxiom,
  kTrajectoryAxiom,
  kFrameAxiom,  // the declaration of a fluent, for DEC5 to DEC8
  kCompletion,
  kInvariant,    // follows from the others and only shortens the search: no reason of anything
  kUnmentioned,  // denies, in the meaning of the 2005 reasoner, what no formula mentions
  kPlanStep,
  kStateConstraint,
  kTrace,  // of a trace from elsewhere that is held against the model
};

/// `axiom`, `effect axiom`, ... as artifacts and messages write it.
std::string_view to_string(OriginKind kind);
std::optional<OriginKind> origin_kind(std::string_view text);

/// A range of a source text as messages print it; it outlives the text.
struct TextPlace {
  std::string file;  // as the user named it
  base::LineColumn begin;
  base::LineColumn end;  // one column beyond the last
  friend bool operator==(const TextPlace&, const TextPlace&) = default;
};

/// Where a clause comes from. Clauses that no text asks for (frame axioms DEC5 to DEC8) carry the
/// declaration of their fluent.
struct Origin {
  base::SourceRange source;  // of a model that was read from an artifact: a line of that file
  OriginKind kind = OriginKind::kAxiom;
  std::string id = {};    // unique in the model; depends on the kind and the text alone
  TextPlace place = {};   // where `source` was when the model was compiled
  std::string text = {};  // of the source, on one line, without comments
};

}  // namespace parallax::compiler
