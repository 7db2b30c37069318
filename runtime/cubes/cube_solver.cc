// Hard questions for several solvers, with the same answer whatever the number of threads.
//
// A call is given to one solver for a fixed number of conflicts. If it stays open, the question
// is split by a literal that makes both halves easier (split_literal.cc) until each lane, a
// solver of its own, has a cube: literals that it assumes. Lanes work in rounds of a fixed
// number of conflicts; between rounds they exchange short learned clauses and refuted cubes, and
// an idle lane takes half of the shortest cube. All clauses follow from the formula alone, so
// they hold for every lane. Work is counted and not timed, and within a round the first lane
// with a valuation answers, so threads only change how long it takes. The failed assumptions are
// the union of those that refuted the cubes.
//
// Cost: as that of the solver; its clauses once more, and one solver for each lane after the
// first hard call.

#include "runtime/cubes/cube_solver.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/cubes/split_literal.h"
#include "runtime/solver/sharing_solver.h"

namespace parallax::runtime {
namespace {

/// Longer clauses cost the others more than they save.
constexpr std::size_t kShared = 6;
constexpr auto kNoLimit = std::numeric_limits<std::int64_t>::max();

/// A solver and the cube that it is at.
struct Lane {
  std::unique_ptr<SharingSolver> solver;
  std::optional<std::vector<Literal>> cube;
  SolveStatus status = SolveStatus::kUnknown;
  std::exception_ptr error;
};

class CubeSolver final : public SatSolver {
 public:
  explicit CubeSolver(const CubeOptions& options) : options_(options) { add_lane(); }

  void add_clause(std::span<const Literal> clause) override {
    for (const auto literal : clause) {
      variables_ = std::max(variables_, literal.var());
      clauses_.push_back(literal.dimacs());
    }
    clauses_.push_back(0);
    for (auto& lane : lanes_) lane.solver->add_clause(clause);
  }
  void assume(Literal literal) override {
    variables_ = std::max(variables_, literal.var());
    assumptions_.push_back(literal);
  }
  SolveStatus solve() override;
  bool value(Literal literal) const override { return lanes_[found_by_].solver->value(literal); }
  bool failed(Literal literal) const override {
    if (!failed_) return lanes_.front().solver->failed(literal);
    return std::find(failed_->begin(), failed_->end(), literal) != failed_->end();
  }
  bool is_fixed(Literal literal) const override { return lanes_.front().solver->is_fixed(literal); }
  void set_phase(Literal literal) override {
    phases_.push_back(literal);
    for (auto& lane : lanes_) lane.solver->set_phase(literal);
  }
  void limit_conflicts(std::int64_t most) override { limit_ = most; }
  std::int64_t conflicts() const override {
    std::int64_t sum = 0;
    for (const auto& lane : lanes_) sum += lane.solver->conflicts();
    return sum;
  }
  std::int64_t solve_calls() const override { return calls_; }

 private:
  void add_lane();
  void run(Lane& lane, std::int64_t conflicts) const;
  void run_round(std::int64_t conflicts);
  SolveStatus solve_cubes(std::int64_t most);
  bool give_work(SplitLiteral& splits);
  std::optional<SolveStatus> answer();
  bool refute(Lane& lane);
  void exchange();
  bool is_stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  CubeOptions options_;
  std::vector<Lane> lanes_;  // the first one is there from the start
  std::vector<std::int32_t> clauses_;
  std::vector<Literal> phases_, assumptions_;
  std::int32_t variables_ = 0;
  std::int64_t limit_ = kNoLimit, calls_ = 0;
  std::size_t found_by_ = 0;
  std::optional<std::vector<Literal>> failed_;  // none: the first lane's to tell
  std::vector<std::vector<Literal>> refuted_;   // as clauses, until the next exchange
};

void CubeSolver::add_lane() {
  auto& lane = lanes_.emplace_back();
  lane.solver = make_sharing_solver(kShared, options_.stop);
  std::vector<Literal> clause;
  for (const auto literal : phases_) lane.solver->set_phase(literal);
  for (const auto literal : clauses_) {
    if (literal == 0) {
      lane.solver->add_clause(clause);
      clause.clear();
    } else {
      const auto variable = Literal::positive(literal < 0 ? -literal : literal);
      clause.push_back(literal < 0 ? ~variable : variable);
    }
  }
}

void CubeSolver::run(Lane& lane, std::int64_t conflicts) const {
  for (const auto literal : assumptions_) lane.solver->assume(literal);
  if (lane.cube) {
    for (const auto literal : *lane.cube) lane.solver->assume(literal);
  }
  lane.solver->limit_conflicts(conflicts);
  lane.status = lane.solver->solve();
}

SolveStatus CubeSolver::solve() {
  ++calls_;
  const auto limit = std::exchange(limit_, kNoLimit);
  const auto before = conflicts();
  found_by_ = 0;
  failed_.reset();
  for (auto& lane : lanes_) lane.cube.reset();
  run(lanes_.front(), std::min(limit, options_.easy));
  auto status = lanes_.front().status;
  const auto spent = std::max(conflicts() - before, std::min(limit, options_.easy));
  if (status == SolveStatus::kUnknown && spent < limit && !is_stopped()) {
    status = solve_cubes(limit - spent);
  } else {
    (void)lanes_.front().solver->take_learned();
  }
  assumptions_.clear();
  return status;
}

SolveStatus CubeSolver::solve_cubes(std::int64_t most) {
  while (lanes_.size() < options_.lanes) add_lane();
  exchange();
  failed_.emplace();
  lanes_.front().cube.emplace();
  SplitLiteral splits(variables_, clauses_);
  while (most > 0 && !is_stopped()) {
    if (!give_work(splits)) return SolveStatus::kUnsatisfiable;
    const auto before = conflicts();
    run_round(std::min(options_.round, most));
    if (const auto status = answer()) return *status;
    exchange();
    most -= std::max<std::int64_t>(conflicts() - before, 1);
  }
  return SolveStatus::kUnknown;
}

/// Lanes without a cube get half of one that has not been split for longest: the shortest one.
/// False: no cube is left.
bool CubeSolver::give_work(SplitLiteral& splits) {
  for (auto& idle : lanes_) {
    if (idle.cube) continue;
    Lane* busy = nullptr;
    for (auto& lane : lanes_) {
      if (lane.cube && (busy == nullptr || lane.cube->size() < busy->cube->size())) busy = &lane;
    }
    if (busy == nullptr) return false;
    auto assumed = assumptions_;
    assumed.insert(assumed.end(), busy->cube->begin(), busy->cube->end());
    const auto literal = splits.best(assumed, [&](Literal l) { return is_fixed(l); });
    if (!literal) continue;
    idle.cube = busy->cube;
    idle.cube->push_back(~*literal);
    busy->cube->push_back(*literal);
  }
  return true;
}

void CubeSolver::run_round(std::int64_t conflicts) {
  std::vector<Lane*> busy;
  for (auto& lane : lanes_) {
    lane.status = SolveStatus::kUnknown;
    if (lane.cube) busy.push_back(&lane);
  }
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (auto i = next++; i < busy.size(); i = next++) {
      try {
        run(*busy[i], conflicts);
      } catch (...) {
        busy[i]->error = std::current_exception();
      }
    }
  };
  std::vector<std::thread> threads;
  const auto helpers = std::min(static_cast<std::size_t>(options_.jobs), busy.size());
  for (std::size_t i = 1; i < helpers; ++i) {
    try {
      threads.emplace_back(work);
    } catch (const std::system_error&) {
      break;  // there are no more threads to be had; those that run do the work
    }
  }
  work();
  for (auto& thread : threads) thread.join();
  for (const auto* lane : busy) {
    if (lane->error) std::rethrow_exception(lane->error);
  }
}

/// Answer to the whole question according to this round; none: it is still open.
std::optional<SolveStatus> CubeSolver::answer() {
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    if (lanes_[i].status != SolveStatus::kSatisfiable) continue;
    found_by_ = i;
    return SolveStatus::kSatisfiable;
  }
  for (auto& lane : lanes_) {
    if (lane.status != SolveStatus::kUnsatisfiable) continue;
    if (refute(lane)) return SolveStatus::kUnsatisfiable;
  }
  return std::nullopt;
}

/// Notes which part of the lane's cube cannot hold, and which assumptions are to blame. True: the
/// cube was not even needed.
bool CubeSolver::refute(Lane& lane) {
  std::vector<Literal> clause, blamed;
  for (const auto literal : *lane.cube) {
    if (lane.solver->failed(literal)) clause.push_back(~literal);
  }
  for (const auto literal : assumptions_) {
    if (lane.solver->failed(literal)) blamed.push_back(literal);
  }
  const bool all = clause.empty();
  if (all) failed_->clear();  // other refuted cubes do not matter
  failed_->insert(failed_->end(), blamed.begin(), blamed.end());
  for (const auto literal : blamed) clause.push_back(~literal);
  refuted_.push_back(std::move(clause));
  lane.cube.reset();
  return all;
}

/// Gives every lane the clauses that the others learned.
void CubeSolver::exchange() {
  std::vector<std::vector<std::vector<Literal>>> learned;
  for (auto& lane : lanes_) learned.push_back(lane.solver->take_learned());
  for (std::size_t from = 0; from < learned.size(); ++from) {
    for (std::size_t to = 0; to < lanes_.size(); ++to) {
      if (to == from) continue;
      for (const auto& clause : learned[from]) lanes_[to].solver->add_clause(clause);
    }
  }
  for (auto& lane : lanes_) {
    for (const auto& clause : refuted_) lane.solver->add_clause(clause);
  }
  refuted_.clear();
}

}  // namespace

std::unique_ptr<SatSolver> make_cube_solver(const CubeOptions& options) {
  return std::make_unique<CubeSolver>(options);
}

std::unique_ptr<SatSolver> make_solver_for_jobs(std::int64_t jobs, const std::atomic<bool>* stop) {
  if (jobs == 0) return make_cadical_solver(stop);
  CubeOptions options;
  options.jobs = jobs;
  options.stop = stop;
  return make_cube_solver(options);
}

}  // namespace parallax::runtime
