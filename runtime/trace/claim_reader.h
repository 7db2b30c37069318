#pragma once

#include <string>
#include <string_view>
#include <unordered_set>

#include "compiler/base/diagnostic.h"
#include "runtime/trace/located_json.h"
#include "runtime/trace/trace_claims.h"
#include "runtime/trace/vocabulary.h"

namespace parallax::runtime {

/// What the readers of both formats share: the names of the model, and how a shape is complained
/// of.
class ClaimReader {
 public:
  ClaimReader(const Vocabulary& vocabulary, base::DiagnosticSink& sink);

  /// E6102: expected `what`, found the value.
  base::Reported unexpected(std::string_view what, const JsonValue& found);
  /// Adds a claim; E6103 unless the model has the atom, E6102 if it was claimed otherwise before.
  bool claim(compiler::AtomKind kind, std::string name, const AtomClaim& claim, AtomClaims& claims);
  base::DiagnosticSink& sink() { return sink_; }
  const Vocabulary& vocabulary() const { return vocabulary_; }

 private:
  bool has(compiler::AtomKind kind, const std::string& name) const;

  const Vocabulary& vocabulary_;
  base::DiagnosticSink& sink_;
  std::unordered_set<std::string> fluents_, events_, predicates_;  // for look-up only
};

base::Result<ClaimedTrace> read_itf_trace(const JsonValue& root, ClaimReader& reader);

}  // namespace parallax::runtime
