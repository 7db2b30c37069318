#include "runtime/trace/csv_format.h"

#include <algorithm>

#include "runtime/trace/vocabulary.h"

namespace parallax::runtime {
namespace {

std::vector<std::string> atoms_of(const std::vector<SymbolInstances>& symbols) {
  std::vector<std::string> atoms;
  for (const auto& symbol : symbols) {
    atoms.insert(atoms.end(), symbol.atoms.begin(), symbol.atoms.end());
  }
  return atoms;
}

void append_bits(const std::vector<std::string>& columns, const std::vector<std::string>& truths,
                 std::string& row) {
  for (const auto& column : columns) {
    row += std::binary_search(truths.begin(), truths.end(), column) ? ",1" : ",0";
  }
}

}  // namespace

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

CsvFormat::CsvFormat(const CompiledModel& model) {
  const auto vocabulary = vocabulary_of(model);
  fluents_ = atoms_of(vocabulary.fluents);
  released_ = atoms_of(vocabulary.releasable);
  events_ = atoms_of(vocabulary.events);
  predicates_ = atoms_of(vocabulary.predicates);
}

std::string CsvFormat::begin() {
  std::string row = "trace,time";
  for (const auto& name : fluents_) row += ',' + csv_field(name);
  for (const auto& name : released_) row += ',' + csv_field("ReleasedAt(" + name + ")");
  for (const auto& name : events_) row += ',' + csv_field(name);
  for (const auto& name : predicates_) row += ',' + csv_field(name);
  return row + "\r\n";
}

std::string CsvFormat::trace(const Trace& trace) {
  std::string out;
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    const auto& point = trace.points[t];
    out += std::to_string(trace.number) + ',' + std::to_string(t);
    append_bits(fluents_, point.holds, out);
    append_bits(released_, point.released, out);
    if (t + 1 < trace.points.size()) {
      append_bits(events_, point.happens, out);
    } else {
      out.append(events_.size(), ',');
    }
    append_bits(predicates_, trace.predicates, out);
    out += "\r\n";
  }
  return out;
}

std::string CsvFormat::end(const ListEnd& end) {
  const auto columns = fluents_.size() + released_.size() + events_.size() + predicates_.size();
  auto row = csv_field("# " + end.exploration + end.remark + ": " + std::to_string(end.traces) +
                       (end.traces == 1 ? " trace" : " traces"));
  return row.append(columns + 1, ',') + "\r\n";
}

}  // namespace parallax::runtime
