#include <doctest/doctest.h>

#include <set>

#include "runtime/enumerate/model_enumerator.h"
#include "runtime/graph/model_traces.h"
#include "runtime/graph/trace_count.h"
#include "tests/support/classic_models.h"
#include "tests/support/deep.h"
#include "tests/support/random_model.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using runtime::Distinct;
using runtime::ModelTraces;
using runtime::Strategy;
using runtime::TraceQuery;

constexpr std::size_t kLimit = 300;

TraceQuery query(Strategy strategy, Distinct distinct = Distinct::kObservable) {
  TraceQuery query;
  query.strategy = strategy;
  query.distinct = distinct;
  return query;
}

/// Lines as they are printed; `pieces`: by print_next, else by next.
std::vector<std::string> lines(runtime::TraceSource& source, bool pieces) {
  std::vector<std::string> out;
  while (out.size() < kLimit) {
    std::string line;
    if (pieces) {
      if (!source.print_next(runtime::jsonl_format(), line)) break;
    } else {
      const auto trace = source.next();
      if (!trace) break;
      line = runtime::format_trace(runtime::jsonl_format(), *trace);
    }
    out.push_back(line);
  }
  return out;
}

std::vector<std::string> lines(const compiler::CompiledModel& model, const TraceQuery& query,
                               bool pieces) {
  ModelTraces traces(model, query);
  return lines(traces, pieces);
}

/// The line without the atoms that do not distinguish traces: they need not be determined.
std::string observable(const std::string& line) {
  std::string out;
  std::size_t at = 0;
  while (true) {
    const auto begin = line.find(",\"released\":[", at);
    if (begin == std::string::npos) break;
    out += line.substr(at, begin - at);
    at = line.find(']', begin) + 1;
  }
  return out + line.substr(at, line.find("\"predicates\"", at) - at);
}

std::vector<std::string> observable(std::vector<std::string> lines) {
  for (auto& line : lines) line = observable(line);
  return lines;
}

struct Seen {
  std::size_t models = 0, lists = 0, traces = 0;
  std::size_t far = 0;  // whose clauses look far
};

/// Every strategy that solves says after any number of traces whether there are more.
void compare_ends(const compiler::CompiledModel& model, Distinct distinct, std::size_t count) {
  for (const auto strategy : {Strategy::kAuto, Strategy::kBlocking, Strategy::kSearch}) {
    for (std::size_t k = 0; k <= count; k += 1 + count / 3) {
      auto asked = query(strategy, distinct);
      asked.wanted = static_cast<std::int64_t>(k);
      ModelTraces traces(model, asked);
      for (std::size_t i = 0; i < k; ++i) REQUIRE(traces.next());
      traces.look_on();
      CHECK(traces.exhausted() == (k == count));
    }
  }
}

void compare(const compiler::CompiledModel& model, Distinct distinct, Seen& seen) {
  const auto wanted = lines(model, query(Strategy::kBlocking, distinct), false);
  if (wanted.size() == kLimit) return;
  ++seen.models;
  compare_ends(model, distinct, wanted.size());
  seen.traces += wanted.size();
  const auto split = runtime::split_into_windows(model, distinct);
  const auto* reason = std::get_if<std::string>(&split);
  if (reason != nullptr && reason->find("more than two neighbouring") != std::string::npos) {
    ++seen.far;
  }
  for (const auto strategy : {Strategy::kAuto, Strategy::kSearch, Strategy::kGuarded,
                              Strategy::kTree, Strategy::kComponents}) {
    for (const bool pieces : {false, true}) {
      const auto found = lines(model, query(strategy, distinct), pieces);
      if (distinct == Distinct::kAll) {
        CHECK(found == wanted);
      } else {
        CHECK(observable(found) == observable(wanted));
      }
    }
  }
  // The search hands over to a graph at once, or between two traces.
  auto asked = query(Strategy::kAuto, distinct);
  asked.search_first = 0;
  CHECK(runtime::count_traces(model, asked).count == wanted.size());
  asked.search_first = 40;
  const auto found = lines(model, asked, false);
  CHECK((distinct == Distinct::kAll ? found == wanted : observable(found) == observable(wanted)));
  for (const auto strategy : {Strategy::kAuto, Strategy::kComponents}) {
    const auto counted = runtime::count_traces(model, query(strategy, distinct));
    CHECK(counted.complete);
    CHECK(counted.count == wanted.size());
  }
  ModelTraces graph(model, query(Strategy::kGraph, distinct));
  if (!graph.refusal().empty()) return;
  ++seen.lists;
  CHECK(lines(graph, true) == wanted);
  CHECK(graph.exhausted());
  CHECK(lines(model, query(Strategy::kGraph, distinct), false) == wanted);
  for (std::size_t k = 0; k <= wanted.size(); k += 1 + wanted.size() / 7) {
    ModelTraces from(model, query(Strategy::kGraph, distinct));
    from.seek(static_cast<long>(k));
    CHECK(lines(from, true) ==
          std::vector(wanted.begin() + static_cast<std::ptrdiff_t>(k), wanted.end()));
  }
}

/// 4^steps traces: two switches, each pressed or not at every timepoint.
std::string switches(int steps) {
  return "sort s\ns A, B\nfluent On(s)\nevent Press(s)\n"
         "[s,time] Initiates(Press(s),On(s),time).\n[s] !HoldsAt(On(s),0).\nrange time 0 " +
         std::to_string(steps) + "\n";
}

/// An atom of a timepoint, and one of a later timepoint that is no neighbour of it, of a model; as
/// a constraint in which they occur. Empty: the model has none.
std::string far_constraint(const compiler::CompiledModel& model, FuzzRandom& random) {
  std::vector<std::pair<compiler::Timepoint, std::string>> atoms;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    const bool is_state = atom.kind == compiler::AtomKind::kHoldsAt;
    if (!is_state && atom.kind != compiler::AtomKind::kHappens) return;
    atoms.emplace_back(*atom.time, (is_state ? "HoldsAt(" : "Happens(") + atom.name + "," +
                                       std::to_string(*atom.time) + ")");
  });
  for (int i = 0; i < 50 && !atoms.empty(); ++i) {
    const auto& first = random.pick(atoms);
    const auto& second = random.pick(atoms);
    if (second.first < first.first + 2) continue;
    static const std::vector<std::string> kConnectives = {" | ", " -> ", " <-> ", " -> !", " | !"};
    return (random.chance(50) ? "!" : "") + first.second + random.pick(kConnectives) +
           second.second + ".\n";
  }
  return "";
}

}  // namespace

TEST_CASE("every strategy gives the same traces in the same order") {
  Seen seen;
  const std::size_t seeds = is_deep() ? 2000 : 800;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const auto text = random_model(seed, seed % 5 == 0 ? kSolverSize : kBruteForceSize).print();
    const TextModel model(text);
    if (model.ground == nullptr) continue;
    CAPTURE(text);
    compare(model.compiled, seed % 3 == 0 ? Distinct::kAll : Distinct::kObservable, seen);
  }
  CHECK(seen.models > seeds * 2 / 5);
  CHECK(seen.lists > seeds / 7);
  CHECK(seen.traces > seeds * 5 / 2);
}

TEST_CASE("every strategy gives the same traces where clauses look far") {
  Seen seen;
  const std::uint64_t wanted = is_deep() ? 2000 : 700;
  for (std::uint64_t seed = 1; seed <= 6000 && seen.far < wanted; ++seed) {
    const auto text = random_model(seed, seed % 2 == 0 ? kSolverSize : ModelSize{8, 30}).print();
    const TextModel plain(text);
    if (plain.ground == nullptr) continue;
    FuzzRandom random(seed);
    const auto constraint = far_constraint(plain.compiled, random);
    const TextModel model(text + constraint);
    if (model.ground == nullptr || constraint.empty()) continue;
    CAPTURE(text + constraint);
    compare(model.compiled, seed % 3 == 0 ? Distinct::kAll : Distinct::kObservable, seen);
  }
  MESSAGE(seen.far, " models whose clauses look far, of ", seen.models, ", ", seen.traces,
          " traces");
  CHECK(seen.far == wanted);
}

TEST_CASE("every strategy gives the same traces of the classic problems") {
  Seen seen;
  for_each_classic([&](const compiler::Compilation& compiled) {
    compare(compiled.model, Distinct::kObservable, seen);
    compare(compiled.model, Distinct::kAll, seen);
  });
  CHECK(seen.models > 20);
  CHECK(seen.lists > 10);
}

TEST_CASE("a level with many children is halved and the list stays the same") {
  const TextModel model(switches(3));
  REQUIRE(model.ground != nullptr);
  const auto wanted = lines(model.compiled, query(Strategy::kBlocking), false);
  for (const std::size_t most : {1U, 2U, 3U, 15U}) {
    runtime::SolverSession session(model.compiled, runtime::make_cadical_solver());
    std::vector<compiler::Literal> atoms;
    model.compiled.for_each_atom([&](const compiler::AtomRef& atom) {
      if (atom.kind == compiler::AtomKind::kHoldsAt || atom.kind == compiler::AtomKind::kHappens) {
        atoms.push_back(atom.literal());
      }
    });
    runtime::TraceTree tree(session, {atoms}, "tree", most);
    CHECK(lines(tree, false) == wanted);
    CHECK(tree.exhausted());
  }
}

TEST_CASE("the list goes on from any number, also far beyond 64 bits") {
  const TextModel model(switches(70));
  REQUIRE(model.ground != nullptr);
  ModelTraces traces(model.compiled, query(Strategy::kAuto));
  mpz_class count;
  mpz_ui_pow_ui(count.get_mpz_t(), 4, 70);
  traces.seek(count - 2);
  std::string line;
  CHECK(traces.print_next(runtime::jsonl_format(), line));
  CHECK(line.starts_with("{\"trace\":" + mpz_class(count - 1).get_str() + ","));
  CHECK_FALSE(traces.exhausted());
  const auto last = traces.next();
  REQUIRE(last.has_value());
  CHECK(last->points[69].happens.size() == 2);
  CHECK_FALSE(traces.next().has_value());
  CHECK(traces.exhausted());
}

TEST_CASE("samples are uniform, repeatable and the same by every strategy") {
  const TextModel model(switches(2));
  REQUIRE(model.ground != nullptr);
  const auto draw = [&](Strategy strategy, std::size_t size, std::uint64_t seed) {
    std::vector<std::string> out;
    for (const auto& trace :
         runtime::sample_traces(model.compiled, query(strategy), size, seed).traces) {
      out.push_back(runtime::to_jsonl(trace));
    }
    return out;
  };
  const auto wanted = draw(Strategy::kGraph, 50, 3);
  CHECK(wanted.size() == 50);
  for (const auto strategy : {Strategy::kAuto, Strategy::kTree, Strategy::kBlocking}) {
    CHECK(draw(strategy, 50, 3) == wanted);
  }
  CHECK(draw(Strategy::kGraph, 50, 4) != wanted);
  // 16 traces, 16000 draws: chi squared has 15 degrees of freedom, 44.3 is its 99.99 % quantile.
  std::map<std::string, int> counts;
  for (const auto& trace :
       runtime::sample_traces(model.compiled, query(Strategy::kGraph), 16000, 1).traces) {
    ++counts[runtime::event_key(trace)];
  }
  CHECK(counts.size() == 16);
  double chi = 0;
  for (const auto& [key, count] : counts) chi += (count - 1000.0) * (count - 1000.0) / 1000.0;
  CHECK(chi < 44.3);
}

TEST_CASE("atoms that clauses look back at from far are carried along the graph, if they are few") {
  const auto text = [](const std::string& things) {
    return "sort s\ns " + things +
           "\nfluent F(s)\nevent E(s)\nrange time 0 4\n"
           "[s,time] Initiates(E(s),F(s),time).\n[s] !HoldsAt(F(s),0).\n"
           "[s] Happens(E(s),0) | Happens(E(s),3).\n";
  };
  const TextModel one(text("A"));
  REQUIRE(one.ground != nullptr);
  // The graph counts them; that they will have happened is hidden in a state, so it does not list.
  const ModelTraces counted(one.compiled, query(Strategy::kGraph));
  REQUIRE(counted.graph() != nullptr);
  CHECK(counted.graph()->count() == 12);
  CHECK(lines(one.compiled, query(Strategy::kAuto), true) ==
        lines(one.compiled, query(Strategy::kBlocking), true));
  CHECK(lines(one.compiled, query(Strategy::kAuto), true).size() == 12);
  // Thirteen are too many.
  const TextModel many(text("A, B, C, D, E, F, G, H, I, J, K, L, M"));
  REQUIRE(many.ground != nullptr);
  const ModelTraces forced(many.compiled, query(Strategy::kGraph));
  CHECK(forced.refusal().find("more than two neighbouring timepoints") != std::string::npos);
  CHECK(lines(many.compiled, query(Strategy::kAuto), true) ==
        lines(many.compiled, query(Strategy::kTree), true));
  mpz_class count;
  mpz_ui_pow_ui(count.get_mpz_t(), 12, 13);
  CHECK(runtime::count_traces(many.compiled, query(Strategy::kAuto)).count == count);
}

/// A million states a timepoint: no strategy may look at all first halves before the first trace.
TEST_CASE("a few traces of a wide model take a few solver calls, whatever the levels") {
  const TextModel model(
      "sort thing\n"
      "thing A, B, C, D, E, F, G, H, I, J, K, L, M, N, O, P, Q, R, S, T\n"
      "fluent On(thing)\n"
      "event Flip(thing)\n"
      "[thing,time] !HoldsAt(On(thing),time) -> Initiates(Flip(thing),On(thing),time).\n"
      "[thing,time] HoldsAt(On(thing),time) -> Terminates(Flip(thing),On(thing),time).\n"
      "range time 0 4\n");
  REQUIRE(model.ground != nullptr);
  for (const auto strategy : {Strategy::kTree, Strategy::kGuarded}) {
    ModelTraces traces(model.compiled, query(strategy));
    CHECK(lines(traces, false).size() == kLimit);
    CHECK(traces.stats().solve_calls < 100'000);
  }
}

}  // namespace parallax::test
