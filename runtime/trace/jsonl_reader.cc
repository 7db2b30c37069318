#include <fmt/format.h>

#include "compiler/base/diagnostic_codes.h"
#include "runtime/trace/claim_reader.h"

namespace parallax::runtime {

using compiler::AtomKind;

namespace {

/// A list of the true atoms; a list that is missing says nothing.
bool read_list(const JsonValue& object, std::string_view name, AtomKind kind, ClaimReader& reader,
               AtomClaims& claims) {
  const auto list = object.find(name);
  if (!list) return true;
  if (!list->is(JsonKind::kArray)) {
    reader.unexpected("a list of atoms", *list);
    return false;
  }
  claims.closed = true;
  for (const auto& atom : list->items()) {
    if (!atom.is(JsonKind::kString)) {
      reader.unexpected("the text of an atom", atom);
      return false;
    }
    const AtomClaim claim{true, atom.source()};
    if (!reader.claim(kind, std::string(atom.text()), claim, claims)) return false;
  }
  return true;
}

}  // namespace

base::Result<ClaimedTrace> read_jsonl_trace(const JsonValue& root, ClaimReader& reader) {
  auto& sink = reader.sink();
  ClaimedTrace trace;
  trace.source = root.source();
  if (const auto number = root.find("trace")) {
    if (number->integer().value_or(0) < 1) return reader.unexpected("a number from 1 on", *number);
    trace.number = *number->integer();
  }
  const auto points = root.find("timepoints");
  if (!points) return reader.unexpected("an object with `timepoints`", root);
  if (!points->is(JsonKind::kArray)) return reader.unexpected("a list of timepoints", *points);
  for (const auto& entry : points->items()) {
    if (!entry.is(JsonKind::kObject)) return reader.unexpected("a timepoint", entry);
    auto& point = trace.points.emplace_back();
    point.source = entry.source();
    const auto time = entry.find("time");
    const auto wanted = static_cast<std::int64_t>(trace.points.size()) - 1;
    if (!time) return reader.unexpected("a timepoint with `time`", entry);
    if (time->integer() != wanted) {
      return reader.unexpected(fmt::format("timepoint {}", wanted), *time);
    }
    if (!read_list(entry, "holds", AtomKind::kHoldsAt, reader, point.holds) ||
        !read_list(entry, "happens", AtomKind::kHappens, reader, point.happens) ||
        !read_list(entry, "released", AtomKind::kReleasedAt, reader, point.released)) {
      return sink.already_reported();
    }
  }
  if (trace.points.empty()) return reader.unexpected("at least one timepoint", *points);
  if (!trace.points.back().happens.listed.empty()) {
    const auto& first = *trace.points.back().happens.listed.begin();
    return sink.error(base::DiagnosticCode::kTraceFileShape, first.second.source,
                      "no event at the last timepoint", fmt::format("`{}`", first.first));
  }
  if (!read_list(root, "predicates", AtomKind::kPredicate, reader, trace.predicates)) {
    return sink.already_reported();
  }
  return trace;
}

}  // namespace parallax::runtime
