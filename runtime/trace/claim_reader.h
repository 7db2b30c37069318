#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "runtime/trace/trace.h"
#include "runtime/trace/trace_claims.h"

namespace parallax::runtime {

enum class JsonKind : std::uint8_t { kNull, kBoolean, kNumber, kString, kArray, kObject };

class JsonDocument;

/// A value of a document, which outlives it. Cheap to copy.
class JsonValue {
 public:
  JsonKind kind() const;
  base::SourceRange source() const;
  bool is(JsonKind wanted) const { return kind() == wanted; }
  bool boolean() const;           // only for kBoolean
  std::string_view text() const;  // for kString, decoded; for kNumber, as it is written
  std::optional<std::int64_t> integer() const;  // for a kNumber that is an integer of 64 bits
  std::vector<JsonValue> items() const;         // for kArray
  /// The value of an object's member, if there is one. Linear in the members.
  std::optional<JsonValue> find(std::string_view name) const;
  /// The names and values of an object in turn.
  std::vector<JsonValue> members() const;

 private:
  friend class JsonDocument;
  JsonValue(const JsonDocument* document, std::uint32_t index)
      : document_(document), index_(index) {}
  const JsonDocument* document_;
  std::uint32_t index_;
};

/// A JSON text whose every value knows its place. Suitable for texts of unknown origin: at most
/// kMaxDepth levels and kMaxValues values of 28 bytes, no recursion; an object must not have a name
/// twice.
class JsonDocument {
 public:
  static constexpr std::size_t kMaxDepth = 100;
  static constexpr std::size_t kMaxValues = 4'000'000;

  /// Parses one value and nothing else. Reports E6101 at the first wrong place. `files` outlives
  /// the document.
  static base::Result<JsonDocument> parse(base::SourceRange text, const base::SourceFiles& files,
                                          base::DiagnosticSink& sink);
  JsonValue root() const { return {this, 0}; }

 private:
  friend class JsonValue;
  friend class JsonBuilder;
  static constexpr std::uint32_t kNone = 0xffffffff;
  struct Node {
    JsonKind kind = JsonKind::kNull;
    bool truth = false;
    std::uint32_t begin = 0, end = 0;  // in the file
    std::uint32_t child = kNone, next = kNone;
    std::uint32_t text = 0, size = 0;  // of a string, in the pool
  };
  explicit JsonDocument(std::string_view file_text, base::FileId file)
      : file_text_(file_text), file_(file) {}
  bool has_duplicate(std::uint32_t object, std::uint32_t& place) const;

  std::string_view file_text_;
  base::FileId file_;
  std::vector<Node> nodes_;
  std::string pool_;  // decoded strings
};

/// Services shared by the readers of both formats: the names of the model, and errors about the
/// shape of a text.
class ClaimReader {
 public:
  ClaimReader(const Vocabulary& vocabulary, base::DiagnosticSink& sink);
  /// For files whose model is not known: takes any name.
  explicit ClaimReader(base::DiagnosticSink& sink) : sink_(sink) {}

  /// E6102: expected `what`, found the value.
  base::Reported unexpected(std::string_view what, const JsonValue& found);
  /// Adds a claim; E6103 unless the model has the atom, E6102 if it was claimed otherwise before.
  bool claim(compiler::AtomKind kind, std::string name, const AtomClaim& claim, AtomClaims& claims);
  /// Notes that nothing is claimed of an atom. E6103 unless the model has it, E6102 if it was
  /// claimed before.
  bool leave_open(compiler::AtomKind kind, std::string name, base::SourceRange source,
                  AtomClaims& claims);
  base::DiagnosticSink& sink() { return sink_; }
  /// Does the model have such a symbol?
  bool has_symbol(compiler::AtomKind kind, const std::string& symbol) const;
  /// Can the event happen at the end of a trace of this length?
  bool may_happen_last(const std::string& event, Timepoint length) const;

 private:
  bool has(compiler::AtomKind kind, const std::string& name) const;
  bool know(compiler::AtomKind kind, const std::string& name, base::SourceRange source);
  const std::vector<SymbolInstances>& symbols_of(compiler::AtomKind kind) const;

  const Vocabulary* vocabulary_ = nullptr;
  base::DiagnosticSink& sink_;
  std::unordered_set<std::string> fluents_, events_, predicates_;  // for look-up only
};

base::Result<ClaimedTrace> read_itf_trace(const JsonValue& root, ClaimReader& reader);

}  // namespace parallax::runtime
