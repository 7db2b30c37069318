#include "runtime/trace/trace_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/artifacts.h"
#include "compiler/base/whole_number.h"
#include "runtime/trace/claim_reader.h"
#include "runtime/trace/itf_format.h"

namespace parallax::runtime {

namespace {

using compiler::AtomKind;

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

/// One atom of `undetermined`: `P(A)`, or `ReleasedAt(On(A),3)`.
bool read_undetermined(const JsonValue& atom, ClaimReader& reader, ClaimedTrace& trace) {
  if (!atom.is(JsonKind::kString)) {
    reader.unexpected("the text of an atom", atom);
    return false;
  }
  const auto parts = split_atom(atom.text());
  if (!parts || parts->symbol != "ReleasedAt") {
    return reader.leave_open(AtomKind::kPredicate, std::string(atom.text()), atom.source(),
                             trace.predicates);
  }
  const bool is_pair = parts->arguments.size() == 2;
  const auto time = is_pair ? base::whole_number<Timepoint>(parts->arguments[1]) : std::nullopt;
  if (!time || *time < 0 || *time > trace.length()) {
    reader.unexpected("`ReleasedAt` of a fluent and a timepoint of the trace", atom);
    return false;
  }
  return reader.leave_open(AtomKind::kReleasedAt, parts->arguments[0], atom.source(),
                           trace.points[static_cast<std::size_t>(*time)].released);
}

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
  for (const auto& [event, claim] : trace.points.back().happens.listed) {
    if (reader.may_happen_last(event, trace.length())) continue;
    return sink.error(codes::kTraceFileShape, claim.source, "no event at the last timepoint",
                      fmt::format("`{}`", event));
  }
  if (!read_list(root, "predicates", AtomKind::kPredicate, reader, trace.predicates)) {
    return sink.already_reported();
  }
  const auto undetermined = root.find("undetermined");
  if (!undetermined) return trace;
  if (!undetermined->is(JsonKind::kArray)) {
    return reader.unexpected("a list of atoms", *undetermined);
  }
  for (const auto& atom : undetermined->items()) {
    if (!read_undetermined(atom, reader, trace)) return sink.already_reported();
  }
  return trace;
}

/// Does the text hold an object on each line, rather than one object over several? One line that
/// opens more than it closes settles it. Strings may hold brackets.
bool first_line_is_whole(std::string_view line) {
  std::int64_t depth = 0;
  bool inside = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (inside && c == '\\') {
      ++i;
    } else if (c == '"') {
      inside = !inside;
    } else if (!inside && (c == '{' || c == '[')) {
      ++depth;
    } else if (!inside && (c == '}' || c == ']')) {
      --depth;
    }
  }
  return depth == 0 && !inside;
}

std::vector<base::SourceRange> lines_of(base::FileId file, std::string_view text) {
  std::vector<base::SourceRange> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = std::min(text.find('\n', begin), text.size());
    if (!base::is_all_space(text.substr(begin, end - begin))) {
      lines.push_back({file, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)});
    }
    begin = end + 1;
  }
  return lines;
}

void note_model(const JsonValue& root, TraceFileHead& head) {
  const auto meta = root.find("#meta");
  const auto model = meta ? meta->find("model") : root.find("model");
  if (!model || !model->is(JsonKind::kString)) return;
  head.model = std::string(model->text());
  head.model_source = model->source();
}

/// Takes the closing line off the list. False, reported, if it does not fit to it.
bool take_summary(TraceFileHead& head, const base::SourceFiles& files, base::DiagnosticSink& sink) {
  const auto last = JsonDocument::parse(head.traces.back(), files, sink);
  if (!last) return false;
  note_model(last->root(), head);
  // A single ITF document is no list.
  head.closed = head.traces.size() == 1 && last->root().find("states").has_value();
  if (!last->root().find("summary")) return true;
  head.traces.pop_back();
  head.closed = true;
  const auto complete = last->root().find("complete");
  head.complete = complete && complete->is(JsonKind::kBoolean) && complete->boolean();
  const auto count = last->root().find("traces");
  if (count && count->integer() != std::ssize(head.traces)) {
    sink.error(codes::kTraceFileShape, count->source(),
               fmt::format("{} traces, as stand before this line", head.traces.size()),
               count->text());
    return false;
  }
  return true;
}

}  // namespace

base::Result<TraceFileHead> open_trace_file(base::FileId file, const base::SourceFiles& files,
                                            base::DiagnosticSink& sink) {
  const auto text = files[file].text();
  const auto size = static_cast<std::uint32_t>(text.size());
  const auto lines = lines_of(file, text);
  if (lines.empty()) {
    return sink.error(codes::kTraceFileSyntax, {file, 0, 0}, "it is empty");
  }
  TraceFileHead head;
  if (lines.size() > 1 && !first_line_is_whole(files.text(lines.front()))) {
    head.traces.push_back({file, 0, size});
  } else {
    head.traces = lines;
  }
  if (!take_summary(head, files, sink)) return sink.already_reported();
  if (!head.model && !head.traces.empty()) {  // ITF says it in each trace
    const auto first = JsonDocument::parse(head.traces.front(), files, sink);
    if (!first) return sink.already_reported();
    note_model(first->root(), head);
  }
  return head;
}

base::Result<ClaimedTrace> read_trace(const base::SourceRange& place, std::int64_t default_number,
                                      const base::SourceFiles& files, ClaimReader& reader) {
  const auto document = JsonDocument::parse(place, files, reader.sink());
  if (!document) return reader.sink().already_reported();
  const auto root = document->root();
  if (!root.is(JsonKind::kObject)) return reader.unexpected("the object of a trace", root);
  auto trace = root.find("states") ? read_itf_trace(root, reader) : read_jsonl_trace(root, reader);
  if (trace && trace->number == 0) trace->number = default_number;
  return trace;
}

}  // namespace parallax::runtime
