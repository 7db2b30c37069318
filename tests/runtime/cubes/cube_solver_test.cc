// Cubes: the answers are the plain solver's, and the findings are the same for any number of jobs.

#include "runtime/cubes/cube_solver.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

#include "runtime/enumerate/model_enumerator.h"
#include "tests/support/classic_models.h"
#include "tests/support/random.h"
#include "tests/support/random_model.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using compiler::Literal;
using runtime::CubeOptions;
using runtime::SolveStatus;
using Clause = std::vector<Literal>;

/// No call is easy, and lanes exchange clauses all the time.
CubeOptions always(std::int64_t jobs, std::int64_t round = 3) {
  CubeOptions options;
  options.jobs = jobs;
  options.easy = 0;
  options.round = round;
  return options;
}

Literal draw_literal(Random& random, std::int32_t variables) {
  const auto literal = Literal::positive(
      1 + static_cast<std::int32_t>(random.below(static_cast<std::size_t>(variables))));
  return random.below(2) == 0 ? literal : ~literal;
}

/// About as many clauses of three literals as make half of such problems contradictory.
std::vector<Clause> draw_clauses(Random& random, std::int32_t variables) {
  std::vector<Clause> clauses(static_cast<std::size_t>(variables) * 21 / 5);
  for (auto& clause : clauses) {
    for (int i = 0; i < 3; ++i) clause.push_back(draw_literal(random, variables));
  }
  return clauses;
}

/// Birds in holes: contradictory, and hard for solvers.
void add_pigeons(runtime::SatSolver& solver, std::int32_t holes) {
  const auto in = [&](std::int32_t bird, std::int32_t hole) {
    return Literal::positive(bird * holes + hole + 1);
  };
  for (std::int32_t bird = 0; bird <= holes; ++bird) {
    Clause somewhere;
    for (std::int32_t hole = 0; hole < holes; ++hole) somewhere.push_back(in(bird, hole));
    solver.add_clause(somewhere);
    for (std::int32_t other = 0; other < bird; ++other) {
      for (std::int32_t hole = 0; hole < holes; ++hole) {
        solver.add_clause(Clause{~in(bird, hole), ~in(other, hole)});
      }
    }
  }
}

TEST_CASE("random clauses, call by call: answers, blame and valuations") {
  std::size_t satisfiable = 0, refuted = 0, cut = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const auto variables = 20 + static_cast<std::int32_t>(random.below(100));
    const auto clauses = draw_clauses(random, variables);
    std::vector<std::unique_ptr<runtime::SatSolver>> solvers;
    for (const std::int64_t jobs : {1, 2, 4}) solvers.push_back(make_cube_solver(always(jobs)));
    auto three = always(2);
    three.lanes = 3;
    solvers.push_back(make_cube_solver(three));
    const auto plain = runtime::make_cadical_solver();
    std::vector<Clause> added;
    const auto add = [&](const Clause& clause) {
      added.push_back(clause);
      plain->add_clause(clause);
      for (auto& solver : solvers) solver->add_clause(clause);
    };
    for (const auto& clause : clauses) add(clause);
    for (int call = 0; call < 6; ++call) {
      Clause assumed;
      for (std::size_t i = random.below(5); i > 0; --i) {
        assumed.push_back(draw_literal(random, variables));
      }
      const auto assume = [&](runtime::SatSolver& solver, const Clause& literals) {
        for (const auto literal : literals) solver.assume(literal);
      };
      assume(*plain, assumed);
      const auto expected = plain->solve();
      for (auto& solver : solvers) {
        assume(*solver, assumed);
        REQUIRE(solver->solve() == expected);
      }
      cut += solvers.front()->conflicts() > 0 ? 1 : 0;
      if (expected == SolveStatus::kUnsatisfiable) {
        ++refuted;
        for (auto& solver : solvers) {
          Clause blamed;
          for (const auto literal : assumed) {
            const bool is_blamed = solver->failed(literal);
            CHECK((&solver > &solvers[2] || is_blamed == solvers.front()->failed(literal)));
            if (is_blamed) blamed.push_back(literal);
          }
          assume(*plain, blamed);
          CHECK(plain->solve() == SolveStatus::kUnsatisfiable);
        }
      } else {
        ++satisfiable;
        Clause blocking;
        for (auto& solver : solvers) {
          const auto holds = [&](Literal literal) { return solver->value(literal); };
          for (const auto& clause : added) {
            CHECK(std::any_of(clause.begin(), clause.end(), holds));
          }
          CHECK(std::all_of(assumed.begin(), assumed.end(), holds));
        }
        for (std::int32_t v = 1; v <= variables; ++v) {
          const auto literal = Literal::positive(v);
          const bool value = solvers[0]->value(literal);
          CHECK(solvers[1]->value(literal) == value);
          CHECK(solvers[2]->value(literal) == value);
          if (v <= 12) blocking.push_back(value ? ~literal : literal);
        }
        add(blocking);
      }
    }
  }
  CHECK(satisfiable > 50);
  CHECK(refuted > 50);
  CHECK(cut > 100);
}

/// The first traces in the solver's own order, and how the list ends.
std::string traces(const compiler::CompiledModel& model, std::unique_ptr<runtime::SatSolver> solver,
                   runtime::TraceOrder order) {
  runtime::SolverSession session(model, std::move(solver));
  runtime::ModelEnumerator enumerator(session, runtime::Distinct::kObservable, order);
  std::string out;
  for (int i = 0; i < 3; ++i) {
    const auto trace = enumerator.next();
    if (!trace) break;
    out += runtime::to_jsonl(*trace);
  }
  return out + (enumerator.exhausted() ? "complete" : "stopped");
}

/// Is there a trace? Its state, which is not asked for, is left to the solver.
bool has_trace(const std::string& listed) { return listed.starts_with('{'); }

struct Seen {
  std::size_t models = 0, without = 0;
};

void compare(const compiler::CompiledModel& model, Seen& seen) {
  const auto any = [&](std::unique_ptr<runtime::SatSolver> solver) {
    return traces(model, std::move(solver), runtime::TraceOrder::kAny);
  };
  const auto plain = any(runtime::make_cadical_solver());
  const auto one = any(make_cube_solver(always(1, 1)));
  // Threads that come and go with every conflict take a busy machine long.
  if (seen.models % 4 == 0) {
    CHECK(any(make_cube_solver(always(2, 1))) == one);
    CHECK(any(make_cube_solver(always(4, 1))) == one);
  }
  CHECK(has_trace(one) == has_trace(plain));
  CHECK(one.ends_with("complete") == plain.ends_with("complete"));
  // Where nothing is hard it is the plain solver.
  CubeOptions easy;
  easy.jobs = 2;
  CHECK(any(make_cube_solver(easy)) == plain);
  ++seen.models;
  seen.without += has_trace(plain) ? 0 : 1;
}

TEST_CASE("2,000 random models: existence is the plain solver's answer, for any number of jobs") {
  Seen seen;
  for (std::uint64_t seed = 1; seen.models < 2'000; ++seed) {
    CAPTURE(seed);
    const TextModel model(random_model(seed, kSolverSize).print());
    if (model.ground != nullptr) compare(model.compiled, seen);
  }
  CHECK(seen.without > 100);
}

TEST_CASE("classics") {
  Seen seen;
  for_each_classic([&](const compiler::Compilation& classic) { compare(classic.model, seen); });
  CHECK(seen.models > 20);
}

TEST_CASE("a contradiction that takes many rounds") {
  for (const std::int64_t jobs : {1, 2}) {
    const auto solver = make_cube_solver(always(jobs, 100));
    add_pigeons(*solver, 7);
    CHECK(solver->solve() == SolveStatus::kUnsatisfiable);
    CHECK(solver->conflicts() > 200);
  }
}

TEST_CASE("a limit on conflicts ends all lanes, at the same place for any number of jobs") {
  std::vector<std::int64_t> spent;
  for (const std::int64_t jobs : {1, 2, 4}) {
    CubeOptions options;
    options.jobs = jobs;
    options.easy = 100;
    options.round = 50;
    const auto solver = make_cube_solver(options);
    add_pigeons(*solver, 11);
    for (const std::int64_t most : {50, 1000, 3000}) {
      const auto before = solver->conflicts();
      solver->limit_conflicts(most);
      CHECK(solver->solve() == SolveStatus::kUnknown);
      CHECK(solver->conflicts() - before <= most + 2 * options.round);
    }
    spent.push_back(solver->conflicts());
    const auto limited = runtime::make_limited_solver(make_cube_solver(options), 2000);
    add_pigeons(*limited, 11);
    CHECK(limited->solve() == SolveStatus::kUnknown);
    CHECK(limited->solve() == SolveStatus::kUnknown);
    CHECK(limited->conflicts() <= 2000 + 2 * options.round);
  }
  CHECK(spent[1] == spent[0]);
  CHECK(spent[2] == spent[0]);
}

TEST_CASE("all lanes stop when they are told to, before and in the middle") {
  std::atomic<bool> stop = false;
  auto options = always(2, 1'000'000'000);
  options.stop = &stop;
  const auto solver = make_cube_solver(options);
  add_pigeons(*solver, 14);
  // The lanes are at work for as long as the flag is down: this takes a solver days.
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    stop = true;
  });
  CHECK(solver->solve() == SolveStatus::kUnknown);
  later.join();
  CHECK(solver->solve() == SolveStatus::kUnknown);
  stop = false;
  solver->assume(Literal::positive(1));
  solver->assume(Literal::positive(2));
  solver->add_clause(Clause{~Literal::positive(1), ~Literal::positive(2)});
  CHECK(solver->solve() == SolveStatus::kUnsatisfiable);
}

TEST_CASE("no clauses, and none that can hold") {
  for (const std::int64_t jobs : {1, 2}) {
    const auto free = make_cube_solver(always(jobs));
    free->assume(Literal::positive(3));
    CHECK(free->solve() == SolveStatus::kSatisfiable);
    CHECK(free->value(Literal::positive(3)));
    const auto empty = make_cube_solver(always(jobs));
    empty->add_clause(Clause{});
    CHECK(empty->solve() == SolveStatus::kUnsatisfiable);
  }
}

}  // namespace
}  // namespace parallax::test
