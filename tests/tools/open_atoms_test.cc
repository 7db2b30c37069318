// Atoms that a trace leaves open are printed as undetermined, in every format and whatever the
// strategy. The oracle lists all valuations and groups them by what tells traces apart.

#include <doctest/doctest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "compiler/base/temporary_folder.h"
#include "compiler/pipeline/compile.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/graph/model_traces.h"
#include "runtime/trace/trace_reader.h"
#include "tests/support/csv_reader.h"
#include "tests/support/random_model.h"
#include "tests/support/text_model.h"
#include "tools/app/trace_listing.h"
#include "tools/app/trace_writer.h"

namespace parallax::test {
namespace {

using compiler::CompiledModel;
using runtime::Distinct;
using runtime::ModelTraces;
using runtime::Strategy;
using runtime::Trace;
using runtime::TraceQuery;

constexpr std::size_t kMostTraces = 100, kMostValuations = 3000;

class Capture final : public tools::Context {
 public:
  Capture() = default;
  Capture(Form form, std::atomic<bool>& stop) : Context(form, stop) {}
  void result(const std::string& piece) override { text += piece; }
  std::string text;
};

TraceQuery query(Strategy strategy, Distinct distinct) {
  TraceQuery query;
  query.strategy = strategy;
  query.distinct = distinct;
  return query;
}

/// The atoms that do not tell traces apart, `ReleasedAt(F(),0)` or `P(A)`: true, false or open.
using Hidden = std::map<std::string, std::optional<bool>>;

std::string release(const std::string& fluent, std::size_t t) {
  return "ReleasedAt(" + fluent + ',' + std::to_string(t) + ')';
}

Hidden hidden_of(const Trace& trace, const runtime::Vocabulary& vocabulary) {
  Hidden out;
  for (const auto& symbol : vocabulary.predicates) {
    for (const auto& atom : symbol.atoms) out[atom] = runtime::contains(trace.predicates, atom);
  }
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    for (const auto& symbol : vocabulary.releasable) {
      for (std::size_t i = 0; i < symbol.atoms.size(); ++i) {
        out[release(symbol.atoms[i], t)] =
            runtime::contains(trace.points[t].released, compiler::FluentId(symbol.ids[i]));
      }
    }
  }
  return out;
}

/// By the text of a trace without its number; none: there are too many.
std::optional<std::map<std::string, Hidden>> grouped(const CompiledModel& model) {
  const auto vocabulary = runtime::vocabulary_of(model);
  ModelTraces valuations(model, query(Strategy::kBlocking, Distinct::kAll));
  std::map<std::string, Hidden> groups;
  for (std::size_t seen = 0;; ++seen) {
    auto valuation = valuations.next();
    if (!valuation) return groups;
    if (seen == kMostValuations || groups.size() > kMostTraces) return std::nullopt;
    const auto hidden = hidden_of(*valuation, vocabulary);
    valuation->number = 0;
    const auto [group, added] = groups.emplace(to_text(*valuation), hidden);
    for (const auto& [atom, value] : hidden) {
      if (auto& known = group->second.at(atom); known != value) known = std::nullopt;
    }
  }
}

tools::ModelOptions named() {
  tools::ModelOptions options;
  options.models = {"test.e"};
  return options;
}

/// The list of all traces in a format, or as a document; nothing if the strategy cannot be had.
std::optional<std::string> listed(const compiler::Compilation& compilation, Strategy strategy,
                                  const std::string& format) {
  const auto& model = compilation.model;
  ModelTraces traces(model, query(strategy, Distinct::kObservable));
  if (!traces.refusal().empty()) return std::nullopt;
  std::atomic<bool> stop = false;
  Capture context({.json = format == "json"}, stop);
  const tools::CertifyOption nothing;
  tools::TraceCertifier certifier(nothing, {}, model, context);
  const auto options = named();
  const auto listing = tools::make_listing(options, {format, {}}, false, compilation, context);
  runtime::OpenAtomFinder finder(
      model, [] { return runtime::make_cadical_solver(); }, false);
  tools::TraceWriter writer({format, false, 0, listing.get(), &finder}, nullptr, certifier,
                            context);
  writer.write_all(traces);
  CHECK(traces.exhausted());
  CHECK_FALSE(writer.cut_short());
  return format == "json" ? writer.list() : context.text;
}

/// The hidden atoms that the program's reader finds in a list.
std::vector<Hidden> read_back(const std::string& text, const CompiledModel& model) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto head = runtime::open_trace_file(files.add("traces", text), files, sink);
  REQUIRE(head.has_value());
  const auto vocabulary = runtime::vocabulary_of(model);
  runtime::ClaimReader reader(vocabulary, sink);
  std::vector<Hidden> out;
  for (const auto& place : head->traces) {
    const auto claimed = runtime::read_trace(place, 1, files, reader);
    REQUIRE(claimed.has_value());
    auto& hidden = out.emplace_back();
    for (const auto& symbol : vocabulary.predicates) {
      for (const auto& atom : symbol.atoms) hidden[atom] = claimed->predicates.value(atom);
    }
    for (std::size_t t = 0; t < claimed->points.size(); ++t) {
      for (const auto& symbol : vocabulary.releasable) {
        for (const auto& atom : symbol.atoms) {
          hidden[release(atom, t)] = claimed->points[t].released.value(atom);
        }
      }
    }
  }
  return out;
}

std::vector<Hidden> read_table(const std::string& text, const runtime::Vocabulary& vocabulary) {
  std::vector<Hidden> out;
  if (text.empty()) return out;
  auto records = read_csv(text);
  std::map<std::string, std::size_t> column;
  for (std::size_t c = 0; c < records.front().size(); ++c) column[records.front()[c]] = c;
  for (std::size_t r = 1; r < records.size(); ++r) {
    const auto t = std::stoull(records[r][1]);
    if (t == 0) out.emplace_back();
    const auto value = [&](const std::string& name) {
      const auto& cell = records[r][column.at(name)];
      return cell.empty() ? std::nullopt : std::optional(cell == "1");
    };
    for (const auto& symbol : vocabulary.predicates) {
      for (const auto& atom : symbol.atoms) out.back()[atom] = value(atom);
    }
    for (const auto& symbol : vocabulary.releasable) {
      for (const auto& atom : symbol.atoms) {
        out.back()[release(atom, t)] = value("ReleasedAt(" + atom + ')');
      }
    }
  }
  return out;
}

std::string spaced(const std::string& atom) {
  std::string out;
  for (const char c : atom) {
    out += c;
    if (c == ',') out += ' ';
  }
  return out;
}

/// Models as the program of 2005 prints them: an open atom is said to be neither true nor false.
void check_models(const std::string& text, const std::vector<Hidden>& wanted) {
  std::vector<std::set<std::string>> models;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("model ")) models.emplace_back();
    if (!models.empty()) models.back().insert(line);
  }
  REQUIRE(models.size() == wanted.size());
  for (std::size_t i = 0; i < models.size(); ++i) {
    for (const auto& [atom, value] : wanted[i]) {
      const auto line = spaced(atom) + '.';
      CHECK(models[i].contains(line) == (value == true));
      // Atoms that no formula mentions have no line at all.
      if (value != false) CHECK_FALSE(models[i].contains('!' + line));
    }
  }
}

void check_lines(const std::string& text, const std::vector<Hidden>& wanted) {
  std::istringstream in(text);
  std::size_t i = 0;
  for (std::string line; std::getline(in, line); ++i) {
    const auto trace = nlohmann::json::parse(line);
    const auto undetermined = trace.value("undetermined", std::vector<std::string>());
    std::set<std::string> open;
    for (const auto& [atom, value] : wanted.at(i)) {
      if (!value) open.insert(atom);
    }
    CHECK(undetermined == std::vector<std::string>(open.begin(), open.end()));
    CHECK(trace.contains("undetermined") == !open.empty());
    for (const auto& atom : trace.at("predicates")) CHECK_FALSE(open.contains(atom));
  }
  CHECK(i == wanted.size());
}

struct Seen {
  std::size_t models = 0, open = 0, settled = 0, long_lists = 0, graphs = 0;
};

void check_model(const TextModel& text, Seen& seen) {
  const auto groups = grouped(text.compiled);
  if (!groups || groups->empty()) return;
  compiler::Compilation compilation;
  compilation.model = text.compiled;
  const auto& model = compilation.model;
  const auto vocabulary = runtime::vocabulary_of(model);
  std::vector<Hidden> wanted;
  ModelTraces traces(model, query(Strategy::kBlocking, Distinct::kObservable));
  bool any_open = false;
  while (auto trace = traces.next()) {
    trace->number = 0;
    wanted.push_back(groups->at(to_text(*trace)));
    for (const auto& [atom, value] : wanted.back()) any_open = any_open || !value;
  }
  REQUIRE(wanted.size() == groups->size());
  ++seen.models;
  ++(any_open ? seen.open : seen.settled);
  if (wanted.size() > 20) ++seen.long_lists;
  for (const auto* format : {"jsonl", "json", "itf", "csv", "decreasoner"}) {
    CAPTURE(std::string(format));
    const auto first = listed(compilation, Strategy::kBlocking, format);
    REQUIRE(first.has_value());
    for (const auto name : runtime::kStrategyNames) {
      CAPTURE(std::string(name));
      const auto strategy = *runtime::kStrategyNames.find(name);
      const auto other = listed(compilation, strategy, format);
      if (!other) continue;
      CHECK(*other == *first);
      if (strategy == Strategy::kGraph) ++seen.graphs;
    }
    if (format == std::string("jsonl")) {
      check_lines(*first, wanted);
      CHECK(read_back(*first, model) == wanted);
    } else if (format == std::string("json")) {
      const auto lines = listed(compilation, Strategy::kBlocking, "jsonl");
      CHECK(nlohmann::json::parse('[' + *first + ']').size() == wanted.size());
      CHECK(std::count(lines->begin(), lines->end(), '\n') == std::ssize(wanted));
    } else if (format == std::string("itf")) {
      CHECK(read_back(*first, model) == wanted);
    } else if (format == std::string("csv")) {
      CHECK(read_table(*first, vocabulary) == wanted);
    } else {
      check_models(*first, wanted);
    }
  }
}

TEST_CASE("random models: what all valuations behind a trace share is told, the rest is not") {
  Seen seen;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    CAPTURE(seed);
    const TextModel text(random_model(seed, kBruteForceSize).print());
    if (text.ground == nullptr) continue;
    check_model(text, seen);
  }
  CHECK(seen.models > 150);
  CHECK(seen.open > 30);
  CHECK(seen.settled > 30);
  CHECK(seen.long_lists > 10);
  CHECK(seen.graphs > 50);
}

TEST_CASE("predicates and releases that are open for one reason or another") {
  const std::string lamps =
      "range time 0 2\nsort k\nk A,B\nfluent On(k)\nevent Press(k)\npredicate Old(k)\n"
      "[k,time] Initiates(Press(k),On(k),time).\n[k] !HoldsAt(On(k),0).\n";
  Seen seen;
  for (const std::string more : {
           "Old(A) | Old(B).\n",                  // each, but not both false
           "Old(A) <-> !Old(B).\n",               // each settles the other
           "[k] Old(k) <-> HoldsAt(On(k),2).\n",  // none
           "[k] Old(k) -> HoldsAt(On(k),2).\n",   // in some traces
           "[k,time] Releases(Press(k),On(k),time).\n",
           "[k,time] Releases(Press(k),On(k),time).\n[k] !ReleasedAt(On(k),0).\n",
       }) {
    CAPTURE(more);
    const TextModel text(lamps + more);
    REQUIRE(text.ground != nullptr);
    check_model(text, seen);
  }
  CHECK(seen.open >= 3);
  CHECK(seen.settled >= 1);
}

/// A goal `HoldsAt(F,time)`, joined with an atom of a predicate if there is one.
struct Goal {
  std::string fluent, predicate;
  bool both = false;

  std::string text() const {
    const auto holds = "HoldsAt(" + fluent + ",time)";
    return predicate.empty() ? holds : holds + (both ? " & " : " | ") + predicate;
  }
  bool met(const Trace& trace, std::size_t t) const {
    const auto names = trace.holds(t);
    const bool holds = std::find(names.begin(), names.end(), fluent) != names.end();
    if (predicate.empty()) return holds;
    const bool also = runtime::contains(trace.predicates, predicate);
    return both ? holds && also : holds || also;
  }
};

/// Is the valuation one behind the trace, and does it meet the goal where the trace ends?
bool is_behind(const Trace& valuation, const Trace& trace, const Goal& goal, std::size_t first) {
  const auto n = trace.points.size() - 1;
  for (std::size_t t = 0; t <= n; ++t) {
    if (valuation.holds(t) != trace.holds(t)) return false;
    if (t < n && valuation.happens(t) != trace.happens(t)) return false;
    if (t >= first && goal.met(valuation, t) != (t == n)) return false;
  }
  return true;
}

/// The number of traces that were compared, and of those with an open atom.
std::pair<int, int> check_prefixes(const TextModel& bare, const std::string& text, const Goal& goal,
                                   bool all_hits) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const base::TemporaryFolder folder("prefixes");
  std::ofstream(folder.path() / "m.e") << text;
  compiler::CompileInput input;
  input.models = {folder.path() / "m.e"};
  const auto formula = goal.text();
  const base::SourceRange range{files.add("goal", formula), 0,
                                static_cast<std::uint32_t>(formula.size())};
  input.constraints = {{range, range}};
  const auto compilation = compiler::compile_model(input, files, sink);
  if (!compilation) return {0, 0};
  const auto& model = compilation->model;
  std::vector<Trace> valuations;
  ModelTraces all(bare.compiled, query(Strategy::kBlocking, Distinct::kAll));
  while (auto valuation = all.next()) {
    if (valuations.size() == kMostValuations) return {0, 0};
    valuations.push_back(*std::move(valuation));
  }
  const auto vocabulary = runtime::vocabulary_of(bare.compiled);
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  runtime::PlanEnumerator enumerator(session, {.all_hits = all_hits});
  runtime::OpenAtomFinder finder(
      model, [] { return runtime::make_cadical_solver(); }, all_hits);
  std::pair<int, int> seen;
  while (const auto trace = enumerator.next()) {
    const auto end = trace->points.size();
    const std::size_t from_start = compiler::AtomIndex(model).hit(0) ? 0 : 1;
    const auto first = all_hits ? end - 1 : from_start;
    std::map<std::string, std::set<bool>> values;
    for (const auto& valuation : valuations) {
      if (!is_behind(valuation, *trace, goal, first)) continue;
      auto cut = valuation;
      cut.points.resize(end);
      for (const auto& [atom, value] : hidden_of(cut, vocabulary)) values[atom].insert(*value);
    }
    std::vector<std::string> wanted;
    for (const auto& [atom, both] : values) {
      if (both.size() == 2) wanted.push_back(atom);
    }
    const auto open = finder.find(*trace);
    REQUIRE(open.has_value());
    CHECK(runtime::printed_atoms(*open, *trace->symbols) == wanted);
    ++seen.first;
    if (!wanted.empty()) ++seen.second;
  }
  return seen;
}

TEST_CASE("of a trace that ends where a goal is met, only what goes on from there counts") {
  int compared = 0, open = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    const auto text = random_model(seed, kBruteForceSize).print();
    const TextModel bare(text);
    if (bare.ground == nullptr) continue;
    const auto vocabulary = runtime::vocabulary_of(bare.compiled);
    if (vocabulary.fluents.empty()) continue;
    Goal goal{vocabulary.fluents.front().atoms.front(), {}, seed % 2 == 0};
    if (!vocabulary.predicates.empty()) goal.predicate = vocabulary.predicates.back().atoms.back();
    for (const bool all_hits : {false, true}) {
      const auto seen = check_prefixes(bare, text, goal, all_hits);
      compared += seen.first;
      open += seen.second;
    }
  }
  CHECK(compared > 200);
  CHECK(open > 20);
}

TEST_CASE("a stop before the open atoms of a trace are known leaves the trace out") {
  const TextModel text("range time 0 1\nfluent F()\npredicate P()\npredicate Q()\nP() | Q().\n");
  std::atomic<bool> stop = false;
  Capture context({}, stop);
  const tools::CertifyOption nothing;
  tools::TraceCertifier certifier(nothing, {}, text.compiled, context);
  ModelTraces traces(text.compiled, query(Strategy::kBlocking, Distinct::kObservable));
  const auto trace = traces.next();
  REQUIRE(trace.has_value());
  runtime::OpenAtomFinder finder(
      text.compiled, [&stop] { return runtime::make_cadical_solver(&stop); }, false);
  tools::TraceWriter writer({"jsonl", false, 0, nullptr, &finder}, nullptr, certifier, context);
  stop = true;
  writer.write(*trace);
  CHECK(writer.cut_short());
  CHECK(writer.count() == 0);
  CHECK(context.text.empty());
}

/// The trace as a format prints it where no solver tells which atoms are open.
std::string unsettled(const TextModel& text, const Trace& trace, const std::string& format) {
  compiler::Compilation compilation;
  compilation.model = text.compiled;
  std::atomic<bool> stop = false;
  Capture context({.json = format == "json"}, stop);
  const tools::CertifyOption nothing;
  tools::TraceCertifier certifier(nothing, {}, compilation.model, context);
  const auto options = named();
  const auto listing = tools::make_listing(options, {format, {}}, false, compilation, context);
  const std::atomic<bool> given_up = true;
  runtime::OpenAtomFinder finder(
      compilation.model, [&given_up] { return runtime::make_cadical_solver(&given_up); }, false);
  tools::TraceWriter::Form form{format, false, 0, listing.get(), &finder};
  form.prints_unsettled = true;
  tools::TraceWriter writer(form, nullptr, certifier, context);
  writer.write(trace);
  CHECK(writer.count() == 1);
  CHECK_FALSE(writer.cut_short());
  return format == "json" ? writer.list() : context.text;
}

TEST_CASE("a trace whose open atoms nobody can tell is printed, and nothing is claimed of them") {
  const TextModel text(
      "range time 0 1\nfluent F()\nevent E()\npredicate P()\npredicate Q()\nP() | Q().\n"
      "[time] Releases(E(),F(),time).\nHappens(E(),0).\n");
  REQUIRE(text.ground != nullptr);
  ModelTraces traces(text.compiled, query(Strategy::kBlocking, Distinct::kObservable));
  const auto trace = traces.next();
  REQUIRE(trace.has_value());
  const auto vocabulary = runtime::vocabulary_of(text.compiled);
  const auto hidden = hidden_of(*trace, vocabulary);
  REQUIRE(hidden.size() == 4);
  Hidden nothing;
  for (const auto& [atom, value] : hidden) nothing[atom] = std::nullopt;
  for (const auto* format : {"jsonl", "json", "itf"}) {
    CAPTURE(std::string(format));
    const auto printed = unsettled(text, *trace, format);
    CHECK(read_back(printed, text.compiled) == std::vector{nothing});
    CHECK(printed.find("undetermined") == std::string::npos);
  }
  CHECK(read_table(unsettled(text, *trace, "csv"), vocabulary) == std::vector{nothing});
  check_models(unsettled(text, *trace, "decreasoner"), {nothing});
}

}  // namespace
}  // namespace parallax::test
