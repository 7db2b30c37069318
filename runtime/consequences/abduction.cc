// Least sets of events that explain an observation (Shanahan 1989), by guessing and refuting.
//
// One solver finds sets of abducible events that admit the observation, by size: a totalizer
// bounds their number, and the bound rises by one when no set of the present size is left. A
// second solver refutes: if exactly these events happen, can the observation fail? If not, the
// set is an explanation, and all supersets are blocked. If it can, the set only makes the
// observation possible, and this one set is blocked. As sets come by size, each explanation is
// minimal among those found.
//
// Cost: two calls or so for each candidate; there may be exponentially many candidates.

#include "runtime/consequences/abduction.h"

#include <algorithm>
#include <utility>

namespace parallax::runtime {
namespace {

constexpr std::size_t kFirstBound = 8;

}  // namespace

Explanations::Explanations(SolverSession& find, SolverSession& refute, Timepoint n,
                           std::vector<Literal> abducibles, Literal observed)
    : find_(find),
      refute_(refute),
      n_(n),
      abducibles_(std::move(abducibles)),
      observed_(observed) {}

SolveStatus Explanations::find_within(std::size_t size) {
  if (bound_ == nullptr || size >= bound_->largest()) {
    const auto largest = bound_ == nullptr ? kFirstBound : 4 * bound_->largest();
    bound_ = std::make_unique<SizeBound>(find_, abducibles_, largest);
  }
  std::vector<Literal> assumptions = {observed_};
  if (const auto small = bound_->at_most(size)) assumptions.push_back(*small);
  return find_.solve(n_, assumptions);
}

/// The next set of abducibles, of the smallest size, that admits the observation.
std::optional<std::vector<Literal>> Explanations::candidate() {
  while (true) {
    auto status = find_within(size_);
    if (status == SolveStatus::kUnsatisfiable) {
      const auto observed = observed_;
      status = find_.solve(n_, std::span(&observed, 1));
      exhausted_ = status == SolveStatus::kUnsatisfiable;
      if (status == SolveStatus::kSatisfiable) {
        ++size_;
        continue;
      }
    }
    stopped_ = status == SolveStatus::kUnknown;
    if (status != SolveStatus::kSatisfiable) return std::nullopt;
    find_.require_model(n_);
    std::vector<Literal> set;
    for (const auto atom : abducibles_) {
      if (find_.value(atom)) set.push_back(atom);
    }
    return set;
  }
}

std::optional<std::vector<Literal>> Explanations::next() {
  while (!exhausted_ && !stopped_) {
    auto set = candidate();
    if (!set) break;
    std::vector<Literal> exactly;
    for (const auto atom : abducibles_) {
      const bool chosen = std::find(set->begin(), set->end(), atom) != set->end();
      exactly.push_back(chosen ? atom : ~atom);
    }
    exactly.push_back(~observed_);
    const auto counterexample = refute_.solve(n_, exactly);
    if (counterexample == SolveStatus::kUnknown) {
      stopped_ = true;
      break;
    }
    exactly.pop_back();
    std::vector<Literal> blocking;
    if (counterexample == SolveStatus::kUnsatisfiable) {
      for (const auto atom : *set) blocking.push_back(~atom);  // nor any larger set
      exhausted_ = blocking.empty();
      if (!exhausted_) find_.add_clause(blocking);
      return set;
    }
    ++possible_only_;
    for (const auto literal : exactly) blocking.push_back(~literal);
    exhausted_ = blocking.empty();
    if (!exhausted_) find_.add_clause(blocking);
  }
  return std::nullopt;
}

}  // namespace parallax::runtime
