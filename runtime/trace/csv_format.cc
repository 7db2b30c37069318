#include "runtime/trace/csv_format.h"

#include "compiler/base/shown_text.h"
#include "compiler/base/words.h"
#include "runtime/trace/open_atoms.h"

namespace parallax::runtime {
namespace {

void append_names(const std::vector<SymbolInstances>& symbols, const char* before,
                  const char* after, std::string& row) {
  for (const auto& symbol : symbols) {
    for (const auto& atom : symbol.atoms) row += ',' + base::csv_cell(before + atom + after);
  }
}

template <typename Id>
void append_value(const Id& id, const std::vector<Id>& truths, const std::vector<Id>& open,
                  std::string& row) {
  row += contains(open, id) ? "," : contains(truths, id) ? ",1" : ",0";
}

template <typename Id>
void append_bits(const std::vector<SymbolInstances>& symbols, const std::vector<Id>& truths,
                 const std::vector<Id>& open, std::string& row) {
  for (const auto& symbol : symbols) {
    for (const auto id : symbol.ids) append_value(Id(id), truths, open, row);
  }
}

/// Predicates have no ids in a trace.
void append_predicates(const std::vector<SymbolInstances>& symbols,
                       const std::vector<std::string>& truths, const std::vector<std::string>& open,
                       std::string& row) {
  for (const auto& symbol : symbols) {
    for (const auto& atom : symbol.atoms) append_value(atom, truths, open, row);
  }
}

std::size_t count(const std::vector<SymbolInstances>& symbols) {
  std::size_t atoms = 0;
  for (const auto& symbol : symbols) atoms += symbol.atoms.size();
  return atoms;
}

}  // namespace

CsvFormat::CsvFormat(const CompiledModel& model) : vocabulary_(vocabulary_of(model)) {}

std::string CsvFormat::begin() {
  std::string row = "trace,time";
  append_names(vocabulary_.fluents, "", "", row);
  append_names(vocabulary_.releasable, "ReleasedAt(", ")", row);
  append_names(vocabulary_.events, "", "", row);
  append_names(vocabulary_.predicates, "", "", row);
  return row + "\r\n";
}

std::string CsvFormat::trace(const Trace& trace, const OpenAtoms& open) {
  std::string out;
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    const auto& point = trace.points[t];
    out += std::to_string(trace.number) + ',' + std::to_string(t);
    append_bits(vocabulary_.fluents, point.holds, {}, out);
    append_bits(vocabulary_.releasable, point.released, open.released_at(t), out);
    if (t + 1 < trace.points.size()) {
      append_bits(vocabulary_.events, point.happens, {}, out);
    } else {
      out.append(count(vocabulary_.events), ',');
    }
    append_predicates(vocabulary_.predicates, trace.predicates, open.predicates, out);
    out += "\r\n";
  }
  return out;
}

std::string CsvFormat::end(const ListEnd& end) {
  const auto columns = count(vocabulary_.fluents) + count(vocabulary_.releasable) +
                       count(vocabulary_.events) + count(vocabulary_.predicates);
  auto row = base::csv_cell("# " + end.exploration + end.remark + ": " +
                            base::counted(end.traces, "trace"));
  return row.append(columns + 1, ',') + "\r\n";
}

}  // namespace parallax::runtime
