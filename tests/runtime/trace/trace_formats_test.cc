// Every format against a reader that knows nothing but the format's description, and the results of
// Parallax's own readers.

#include <doctest/doctest.h>

#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>

#include "compiler/pipeline/compile.h"
#include "runtime/enumerate/model_enumerator.h"
#include "runtime/trace/csv_format.h"
#include "runtime/trace/itf_format.h"
#include "runtime/trace/open_atoms.h"
#include "runtime/trace/trace_reader.h"
#include "tests/support/classic_models.h"
#include "tests/support/csv_reader.h"
#include "tests/support/itf_reader.h"
#include "tests/support/random_model.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using compiler::CompiledModel;
using runtime::Trace;
using Names = std::vector<std::string>;

/// A trace whose names are given one after the other.
class NamedTrace {
 public:
  explicit NamedTrace(std::int64_t number = 0, std::size_t points = 0) {
    trace.number = number;
    trace.symbols = symbols_;
    trace.points.resize(points);
  }
  void holds(std::size_t t, std::string_view name) {
    trace.points[t].holds.push_back(symbols_->add_fluent(name));
  }
  void happens(std::size_t t, std::string_view name) {
    trace.points[t].happens.push_back(symbols_->add_event(name));
  }
  void released(std::size_t t, std::string_view name) {
    trace.points[t].released.push_back(symbols_->add_fluent(name));
  }
  Trace trace;

 private:
  std::shared_ptr<compiler::SymbolTable> symbols_ = std::make_shared<compiler::SymbolTable>();
};

constexpr int kTracesOfOneModel = 20;

/// Trace and model in the order in which they are compared; this text distinguishes traces.
std::string observed(const Trace& trace) { return runtime::to_jsonl(trace); }

std::string atom_of(const std::string& symbol, const Names& arguments) {
  std::string out = symbol + '(';
  for (std::size_t i = 0; i < arguments.size(); ++i) out += (i > 0 ? "," : "") + arguments[i];
  return out + ')';
}

/// The trace that an ITF text tells, by the mapping that docs/reference/formats.md describes.
Trace trace_of(const ItfFile& file) {
  NamedTrace out(file.meta.at("trace").get<std::int64_t>(), file.states.size());
  std::set<std::string> predicates;
  for (std::size_t t = 0; t < file.states.size(); ++t) {
    for (const auto& [name, value] : file.states[t]) {
      if (name == "mbt::nondetPicks") continue;
      if (name == "mbt::actionTaken") {
        std::istringstream events(value.get<std::string>());
        for (std::string event; t > 0 && std::getline(events, event, '+');) {
          out.happens(t - 1, event);
        }
        if (t == 0) CHECK(value == "init");
        continue;
      }
      const auto colons = name.find("::");
      const auto symbol = colons == std::string::npos ? name : name.substr(colons + 2);
      for (const auto& [arguments, truth] : ItfFile::map_of(value)) {
        if (!truth.get<bool>()) continue;
        const auto atom = atom_of(symbol, arguments);
        if (name.starts_with("ReleasedAt::")) {
          out.released(t, atom);
        } else if (name.starts_with("predicate::")) {
          predicates.insert(atom);
        } else {
          out.holds(t, atom);
        }
      }
    }
  }
  out.trace.predicates.assign(predicates.begin(), predicates.end());
  return out.trace;
}

/// The picks of a state are its events, by symbol.
void check_picks(const ItfFile& file) {
  for (const auto& state : file.states) {
    std::set<std::string> taken, picked;
    std::istringstream events(state.at("mbt::actionTaken").get<std::string>());
    for (std::string event; std::getline(events, event, '+');) taken.insert(event);
    taken.erase("init");
    for (const auto& [symbol, option] : state.at("mbt::nondetPicks").items()) {
      if (option.at("tag") == "None") continue;
      CHECK(option.at("tag") == "Some");
      for (const auto& tuple : option.at("value").at("#set")) {
        Names arguments;
        for (const auto& argument : tuple.at("#tup")) {
          arguments.push_back(ItfFile::printed(argument));
        }
        picked.insert(atom_of(symbol, arguments));
      }
    }
    CHECK(taken == picked);
  }
}

/// The traces that a CSV text tells; columns are looked up by name.
std::vector<Trace> traces_of(const std::string& csv, const CompiledModel& model) {
  const auto records = read_csv(csv);
  const auto& head = records.front();
  std::set<std::string> fluents, events;
  for (const auto& fluent : model.fluents) fluents.insert(fluent.name);
  for (const auto& event : model.events) events.insert(event.name);
  std::vector<NamedTrace> traces;
  for (std::size_t r = 1; r + 1 < records.size(); ++r) {
    const auto number = std::stoll(records[r][0]);
    if (traces.empty() || traces.back().trace.number != number) traces.emplace_back(number);
    auto& out = traces.back();
    const auto t = out.trace.points.size();
    CHECK(records[r][1] == std::to_string(t));
    out.trace.predicates.clear();
    out.trace.points.emplace_back();
    for (std::size_t c = 2; c < head.size(); ++c) {
      const auto& field = records[r][c];
      CHECK((field == "0" || field == "1" || (field.empty() && events.contains(head[c]))));
      if (field != "1") continue;
      if (fluents.contains(head[c])) {
        out.holds(t, head[c]);
      } else if (events.contains(head[c])) {
        out.happens(t, head[c]);
      } else if (head[c].starts_with("ReleasedAt(")) {
        out.released(t, head[c].substr(11, head[c].size() - 12));
      } else {
        out.trace.predicates.push_back(head[c]);
      }
    }
  }
  std::vector<Trace> told;
  for (const auto& trace : traces) told.push_back(trace.trace);
  return told;
}

/// The claims as a trace; every atom must be claimed.
Trace trace_of(const runtime::ClaimedTrace& claimed, const CompiledModel& model) {
  NamedTrace out(claimed.number, claimed.points.size());
  auto& trace = out.trace;
  const auto is_true = [](const runtime::AtomClaims& claims, const std::string& name) {
    const auto value = claims.value(name);
    REQUIRE_MESSAGE(value.has_value(), name);
    return *value;
  };
  for (std::size_t t = 0; t < claimed.points.size(); ++t) {
    const auto& point = claimed.points[t];
    for (std::size_t f = 0; f < model.fluents.size(); ++f) {
      const auto& name = model.fluents[f].name;
      if (is_true(point.holds, name)) out.holds(t, name);
      if (!model.release_slots[f]) continue;
      if (is_true(point.released, name)) out.released(t, name);
    }
    for (const auto& event : model.events) {
      if (t + 1 == claimed.points.size()) continue;
      if (is_true(point.happens, event.name)) out.happens(t, event.name);
    }
  }
  for (const auto& [name, claim] : claimed.predicates.listed) {
    if (claim.value) trace.predicates.push_back(name);
  }
  return trace;
}

/// Traces that Parallax's reader finds in a file.
std::vector<Trace> read_back(const std::string& text, const CompiledModel& model) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto file = files.add("traces", text);
  const auto head = runtime::open_trace_file(file, files, sink);
  REQUIRE(head.has_value());
  CHECK(head->model == runtime::model_hash(model));
  const auto vocabulary = runtime::vocabulary_of(model);
  runtime::ClaimReader reader(vocabulary, sink);
  std::vector<Trace> traces;
  for (const auto& place : head->traces) {
    const auto claimed = runtime::read_trace(place, 1, files, reader);
    REQUIRE(claimed.has_value());
    traces.push_back(trace_of(*claimed, model));
  }
  return traces;
}

std::size_t check_formats(const CompiledModel& model) {
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session);
  runtime::ItfFormat itf(model, {"parallax", "model.e", {}});
  runtime::CsvFormat csv(model);
  std::vector<Trace> traces;
  std::string rows = csv.begin(), itf_lines;
  while (static_cast<int>(traces.size()) < kTracesOfOneModel) {
    auto trace = enumerator.next();
    if (!trace) break;
    const ItfFile file(itf.document(*trace, {}, {}));
    CHECK(observed(trace_of(file)) == observed(*trace));
    check_picks(file);
    const auto line = itf.trace(*trace, {});
    CHECK(line.find('\n') == line.size() - 1);
    CHECK(ItfFile(line).states == file.states);
    CHECK(observed(read_back(itf.document(*trace, {}, {}), model).at(0)) == observed(*trace));
    itf_lines += line;
    rows += csv.trace(*trace, {});
    traces.push_back(*std::move(trace));
  }
  const runtime::ListEnd end{static_cast<std::int64_t>(traces.size()), false, "stopped", {}, {}};
  rows += csv.end(end);
  itf_lines += itf.end(end);
  const auto from_csv = traces_of(rows, model);
  const auto from_lines = read_back(itf_lines, model);
  REQUIRE(from_csv.size() == traces.size());
  REQUIRE(from_lines.size() == traces.size());
  for (std::size_t i = 0; i < traces.size(); ++i) {
    CHECK(observed(from_csv[i]) == observed(traces[i]));
    CHECK(observed(from_lines[i]) == observed(traces[i]));
  }
  CHECK(read_csv(rows).back().front().starts_with("# stopped: "));
  return traces.size();
}

TEST_CASE("traces of the classic problems survive ITF and CSV and both ways of reading them") {
  std::size_t models = 0;
  for_each_classic([&](const compiler::Compilation& compiled) {
    check_formats(compiled.model);
    ++models;
  });
  CHECK(models > 15);
}

TEST_CASE("traces of random models survive ITF and CSV and both ways of reading them") {
  std::size_t models = 0, traces = 0;
  for (std::uint64_t seed = 1; seed <= 250; ++seed) {
    CAPTURE(seed);
    const TextModel model(
        random_model(seed, seed % 5 == 0 ? kSolverSize : kBruteForceSize).print());
    if (model.ground == nullptr) continue;
    traces += check_formats(model.compiled);
    ++models;
  }
  CHECK(models > 100);
  CHECK(traces > 500);
}

TEST_CASE("an argument beyond the integers of JSON keeps its value") {
  const TextModel model(
      "range time 0 1\nsort n: integer\nrange n 9007199254740992 9007199254740993\n"
      "fluent F(n)\nevent E(n)\n");
  REQUIRE(model.ground != nullptr);
  CHECK(check_formats(model.compiled) == 16);
}

TEST_CASE("a name in a JSON line is escaped where it must be") {
  const Names names = {"A()", "a\nb\x01", "a\"b\\c", "\xc3\xa9"};  // sorted by bytes
  NamedTrace named(1, 1);
  for (const auto& name : names) named.holds(0, name);
  const auto line = nlohmann::json::parse(runtime::to_jsonl(named.trace));
  CHECK(line["timepoints"][0]["holds"] == names);
  CHECK(line["timepoints"][0]["happens"].empty());
}

}  // namespace
}  // namespace parallax::test
