#include "runtime/trace/claim_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/suggest.h"

namespace parallax::runtime {

using base::DiagnosticCode;
using compiler::AtomKind;

namespace {

constexpr std::size_t kMaxQuoted = 60;       // bytes of a value in a message
constexpr std::size_t kMaxSuggested = 5000;  // names that a misspelled one is compared with

void collect(const std::vector<SymbolInstances>& symbols, std::unordered_set<std::string>& names) {
  for (const auto& symbol : symbols) names.insert(symbol.atoms.begin(), symbol.atoms.end());
}

std::string quoted(const JsonValue& value) {
  switch (value.kind()) {
    case JsonKind::kNull:
      return "null";
    case JsonKind::kBoolean:
      return value.boolean() ? "true" : "false";
    case JsonKind::kNumber:
      return std::string(value.text().substr(0, kMaxQuoted));
    case JsonKind::kString: {
      const auto text = value.text();
      return fmt::format("`{}{}`", text.substr(0, kMaxQuoted),
                         text.size() > kMaxQuoted ? "..." : "");
    }
    case JsonKind::kArray:
      return "a list";
    case JsonKind::kObject:
      return "an object";
  }
  return {};
}

const char* word_of(AtomKind kind) {
  if (kind == AtomKind::kHappens) return "event";
  return kind == AtomKind::kPredicate ? "formula with the atom" : "fluent";
}

}  // namespace

ClaimReader::ClaimReader(const Vocabulary& vocabulary, base::DiagnosticSink& sink)
    : vocabulary_(vocabulary), sink_(sink) {
  collect(vocabulary.fluents, fluents_);
  collect(vocabulary.events, events_);
  collect(vocabulary.predicates, predicates_);
}

base::Reported ClaimReader::unexpected(std::string_view what, const JsonValue& found) {
  return sink_.error(DiagnosticCode::kTraceFileShape, found.source(), what, quoted(found));
}

bool ClaimReader::has(AtomKind kind, const std::string& name) const {
  if (kind == AtomKind::kHappens) return events_.contains(name);
  if (kind == AtomKind::kPredicate) return predicates_.contains(name);
  return fluents_.contains(name);
}

bool ClaimReader::claim(AtomKind kind, std::string name, const AtomClaim& claim,
                        AtomClaims& claims) {
  if (!has(kind, name)) {
    auto built = sink_.error(DiagnosticCode::kTraceUnknownAtom, claim.source, word_of(kind), name);
    const auto& symbols = kind == AtomKind::kHappens     ? vocabulary_.events
                          : kind == AtomKind::kPredicate ? vocabulary_.predicates
                                                         : vocabulary_.fluents;
    std::vector<std::string> names;
    for (const auto& symbol : symbols) {
      names.insert(names.end(), symbol.atoms.begin(), symbol.atoms.end());
    }
    if (names.size() > kMaxSuggested) return false;
    if (const auto near = base::nearest_name(name, names)) {
      built.fix(fmt::format("replace `{}` with `{}`", name, *near));
    }
    return false;
  }
  const auto [entry, added] = claims.listed.try_emplace(std::move(name), claim);
  if (added || entry->second.value == claim.value) return true;
  sink_
      .error(DiagnosticCode::kTraceFileShape, claim.source,
             fmt::format("one value of `{}`", entry->first), "another one")
      .note(entry->second.source, "the first one stands here");
  return false;
}

}  // namespace parallax::runtime
