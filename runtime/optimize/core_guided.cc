// The least value of an objective by unsatisfiable cores: OLL (Andres, Kaufmann, Matheis and
// Schaub 2012; Morgado, Dodaro and Marques-Silva 2014).
//
// Every term gives a soft literal whose breaking costs its weight. All soft literals of at least
// the present level are assumed. If that fails, a core of them cannot be kept together: the
// lower bound rises by the core's least weight, which its literals lose, and a totalizer counts
// how many of the core are broken; "at most one" becomes a soft literal with that weight, and
// later "at most two", and so on. If it succeeds, the trace found is an upper bound; soft
// literals heavier than the gap are required for good, the cores found at this level are
// counted, and the level falls (stratification: Ansotegui, Bonet, Gabas and Levy 2012). The
// search ends where both bounds meet.
//
// Cost: a call for each core and level; cores are shortened within a fixed number of conflicts.

#include "runtime/optimize/core_guided.h"

#include <algorithm>
#include <utility>

namespace parallax::runtime {
namespace {

/// Conflicts that shortening a core is worth, for each literal; counted, so that answers do not
/// depend on the machine.
constexpr std::int64_t kConflictsToShorten = 500;
constexpr std::size_t kLongestToShorten = 200;
constexpr std::size_t kFirstCounted = 4;

}  // namespace

std::int64_t objective_value(const compiler::Objective& objective, Timepoint n,
                             const std::function<bool(Literal)>& value) {
  std::int64_t sum = 0;
  for (const auto& term : objective.terms) {
    if (term.needed <= n && (!term.literal || value(*term.literal))) sum += term.weight;
  }
  return sum;
}

std::int64_t trivial_bound(const compiler::Objective& objective, Timepoint n) {
  std::int64_t sum = 0;
  for (const auto& term : objective.terms) {
    if (term.needed <= n && (!term.literal || term.weight < 0)) sum += term.weight;
  }
  return sum;
}

CoreGuidedSearch::CoreGuidedSearch(SolverSession& session, Timepoint n,
                                   std::vector<Literal> assumed, bool alone, Note note)
    : session_(session),
      n_(n),
      assumed_(std::move(assumed)),
      alone_(alone),
      note_(std::move(note)) {}

void CoreGuidedSearch::prepare(const compiler::Objective& objective) {
  objective_ = &objective;
  softs_.clear();
  counters_.clear();
  uncounted_.clear();
  upper_.reset();
  found_.reset();
  lower_ = trivial_bound(objective, n_);
  for (const auto& term : objective.terms) {
    if (term.needed > n_ || !term.literal) continue;
    const bool gain = term.weight < 0;
    add_soft(gain ? *term.literal : ~*term.literal, gain ? -term.weight : term.weight);
  }
  level_ = 0;
  for (const auto& [literal, soft] : softs_) {
    session_.prefer(Literal::from_dimacs(literal));
    level_ = std::max(level_, soft.weight / 2 + 1);
  }
}

/// Adds a soft literal. One of a literal and its negation is broken in any case, which raises the
/// lower bound.
void CoreGuidedSearch::add_soft(Literal good, std::int64_t weight) {
  const auto opposite = softs_.find((~good).dimacs());
  if (opposite != softs_.end()) {
    const auto both = std::min(weight, opposite->second.weight);
    lower_ += both;
    opposite->second.weight -= both;
    weight -= both;
    if (opposite->second.weight == 0) softs_.erase(opposite);
  }
  if (weight > 0) softs_[good.dimacs()].weight += weight;
}

SolveStatus CoreGuidedSearch::solve(std::span<const Literal> softs) {
  auto assumptions = assumed_;
  assumptions.insert(assumptions.end(), softs.begin(), softs.end());
  const auto status = session_.solve_whole(n_, assumptions);
  if (status == SolveStatus::kSatisfiable) {
    session_.require_model(n_);
    note_();
    const auto value =
        objective_value(*objective_, n_, [&](Literal literal) { return session_.value(literal); });
    if (!found_ || value < *found_) found_ = value;
    if (!upper_ || value < *upper_) upper_ = value;
  }
  return status;
}

std::vector<Literal> CoreGuidedSearch::active() const {
  std::vector<Literal> out;
  for (const auto& [literal, soft] : softs_) {
    if (soft.weight >= level_) out.push_back(Literal::from_dimacs(literal));
  }
  return out;
}

std::vector<Literal> CoreGuidedSearch::failed_of(const std::vector<Literal>& softs) {
  std::vector<Literal> out;
  for (const auto literal : softs) {
    if (session_.failed(literal)) out.push_back(literal);
  }
  return out;
}

/// Removes literals from a core that are not needed, as far as that shows quickly.
void CoreGuidedSearch::shorten(std::vector<Literal>& core) {
  if (core.size() > kLongestToShorten) return;
  for (std::size_t i = 0; i < core.size() && core.size() > 1;) {
    auto rest = core;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    session_.limit_conflicts(kConflictsToShorten);
    if (solve(rest) == SolveStatus::kUnsatisfiable) {
      core = failed_of(rest);
    } else {
      ++i;
    }
  }
}

/// Handles a core: its literals cannot all be kept, so the lower bound rises by the least of their
/// weights. False: the core is empty.
bool CoreGuidedSearch::relax(std::vector<Literal> core) {
  if (core.empty()) return false;
  ++cores_;
  Core found{std::move(core), 0};
  for (const auto literal : found.literals) {
    const auto weight = softs_.at(literal.dimacs()).weight;
    found.weight = found.weight == 0 ? weight : std::min(found.weight, weight);
  }
  lower_ += found.weight;
  for (const auto literal : found.literals) {
    const auto soft = softs_.find(literal.dimacs());
    const auto was = soft->second;
    soft->second.weight -= found.weight;
    if (soft->second.weight == 0) softs_.erase(soft);
    if (was.counter) allow(*was.counter, was.allowed + 1, found.weight);
  }
  if (found.literals.size() == 1) {
    harden(~found.literals.front());
  } else {
    uncounted_.push_back(std::move(found));
  }
  return true;
}

/// Counts the broken literals of a core. One is broken; from now on, no more than one is assumed.
void CoreGuidedSearch::count(const Core& core) {
  Counter counter;
  for (const auto literal : core.literals) counter.broken.push_back(~literal);
  counters_.push_back(std::move(counter));
  allow(counters_.size() - 1, 1, core.weight);
}

/// Charges the weight for more than `broken` broken literals of a core.
void CoreGuidedSearch::allow(std::size_t number, std::size_t broken, std::int64_t weight) {
  auto& counter = counters_[number];
  if (broken >= counter.broken.size()) return;
  if (counter.bound == nullptr || broken >= counter.bound->largest()) {
    const auto largest = counter.bound == nullptr ? kFirstCounted : 4 * counter.bound->largest();
    counter.bound = std::make_unique<SizeBound>(session_, counter.broken, largest);
  }
  const auto good = counter.bound->at_most(broken);
  PARALLAX_REQUIRE(good.has_value(), "a totalizer counts up to its largest bound");
  auto& soft = softs_[good->dimacs()];
  soft.weight += weight;
  soft.counter = number;
  soft.allowed = broken;
}

void CoreGuidedSearch::harden(Literal literal) {
  if (alone_) {
    session_.add_clause(std::span(&literal, 1));
  } else {
    assumed_.push_back(literal);
  }
}

/// Hardens soft literals that cost more than the gap between the bounds: every trace that counts
/// keeps them.
void CoreGuidedSearch::harden_heavy() {
  if (!upper_) return;
  for (auto soft = softs_.begin(); soft != softs_.end();) {
    if (soft->second.weight <= *upper_ - lower_) {
      ++soft;
      continue;
    }
    harden(Literal::from_dimacs(soft->first));
    soft = softs_.erase(soft);
  }
}

void CoreGuidedSearch::next_level() {
  std::int64_t most = 0;
  for (const auto& [literal, soft] : softs_) {
    if (soft.weight < level_) most = std::max(most, soft.weight);
  }
  level_ = most / 2 + 1;
}

/// A trace with the least value is known: requires that value from now on.
void CoreGuidedSearch::settle() {
  for (const auto& core : std::exchange(uncounted_, {})) count(core);
  for (const auto& [literal, soft] : softs_) harden(Literal::from_dimacs(literal));
  softs_.clear();
}

SolveStatus CoreGuidedSearch::minimize(const compiler::Objective& objective,
                                       std::optional<std::int64_t> below) {
  prepare(objective);
  if (below) upper_ = *below - 1;
  // A first trace, to have one to show whatever stops the search.
  const auto first = solve({});
  if (first != SolveStatus::kSatisfiable) return first;
  while (!upper_ || lower_ <= *upper_) {
    const auto softs = active();
    const auto status = solve(softs);
    if (status == SolveStatus::kUnknown) return status;
    if (status == SolveStatus::kUnsatisfiable) {
      auto core = failed_of(softs);
      shorten(core);
      if (!relax(std::move(core))) return SolveStatus::kUnsatisfiable;
    }
    if (found_ == lower_) {
      settle();
      return SolveStatus::kSatisfiable;
    }
    if (status != SolveStatus::kSatisfiable) continue;
    const bool all_counted = uncounted_.empty();
    for (const auto& core : std::exchange(uncounted_, {})) count(core);
    harden_heavy();
    if (all_counted) next_level();
  }
  return SolveStatus::kUnsatisfiable;
}

}  // namespace parallax::runtime
