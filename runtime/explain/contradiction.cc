// Minimal sets of axioms that contradict each other.
//
// One set is made minimal by leaving out one group after the other; after each success only the
// groups that the solver used stay. The smallest set comes from the duality of contradictions
// and corrections (Ignatiev, Previti, Liffiton and Marques-Silva 2015): every contradiction hits
// each correction, the complement of a maximal consistent set. A smallest hitting set of the
// corrections so far is either contradictory, and then a smallest contradiction, or consistent,
// and then it grows and gives a further correction. All minimal sets come from a map of the
// subsets that are still undecided (Liffiton, Previti, Malik and Marques-Silva 2016): a seed is
// shrunk to a contradiction, all above which is decided, or grown to a consistent set, all below
// which is.
//
// Both may need exponentially many calls. The clauses of the found set are proved contradictory
// by a fresh solver whose proof is checked (drat_checker.cc).

#include "runtime/explain/contradiction.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "runtime/explain/group_solver.h"

namespace parallax::runtime {

using compiler::CompiledModel;

namespace {

/// Smallest sets that have an element of each given set, by a SAT solver and a sequential counter
/// (Sinz 2005). Size: elements times `bound` clauses.
class HittingSets {
 public:
  /// Elements 0 .. count - 1; nobody asks for sets with more than `bound` elements.
  HittingSets(std::size_t count, std::size_t bound, const std::atomic<bool>* stop);
  void add(const IndexSet& to_hit);
  /// A smallest one; none if every one has more than `bound` elements, or the solver was stopped
  /// (then `stopped`). The size never falls from call to call.
  std::optional<IndexSet> smallest();
  bool stopped() const { return stopped_; }
  /// No hitting set is smaller than this.
  std::size_t lower_bound() const { return size_; }

 private:
  Literal element(std::size_t i) const {
    return Literal::positive(static_cast<std::int32_t>(i) + 1);
  }
  /// At least j of the elements 0 .. i are in the set, 1 <= j <= bound + 1.
  Literal at_least(std::size_t j, std::size_t i) const;

  std::unique_ptr<SatSolver> solver_;
  std::size_t count_, bound_, size_ = 0;
  bool stopped_ = false;
};

HittingSets::HittingSets(std::size_t count, std::size_t bound, const std::atomic<bool>* stop)
    : solver_(make_cadical_solver(stop)), count_(count), bound_(bound) {
  for (std::size_t i = 0; i < count; ++i) {
    solver_->set_phase(~element(i));
    const Literal one[] = {~element(i), at_least(1, i)};
    solver_->add_clause(one);
    for (std::size_t j = 1; i > 0 && j <= bound + 1; ++j) {
      const Literal kept[] = {~at_least(j, i - 1), at_least(j, i)};
      solver_->add_clause(kept);
      if (j == 1) continue;
      const Literal more[] = {~element(i), ~at_least(j - 1, i - 1), at_least(j, i)};
      solver_->add_clause(more);
    }
  }
}

Literal HittingSets::at_least(std::size_t j, std::size_t i) const {
  return Literal::positive(static_cast<std::int32_t>(count_ + i * (bound_ + 1) + j));
}

void HittingSets::add(const IndexSet& to_hit) {
  std::vector<Literal> clause;
  for (const auto i : to_hit) clause.push_back(element(i));
  solver_->add_clause(clause);
}

std::optional<IndexSet> HittingSets::smallest() {
  for (; size_ <= bound_; ++size_) {
    if (count_ > 0) solver_->assume(~at_least(size_ + 1, count_ - 1));
    const auto status = solver_->solve();
    stopped_ = status == SolveStatus::kUnknown;
    if (stopped_) return std::nullopt;
    if (status == SolveStatus::kUnsatisfiable) continue;
    IndexSet set;
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (solver_->value(element(i))) set.push_back(i);
    }
    return set;
  }
  return std::nullopt;
}

IndexSet everything(const GroupSolver& solver) {
  IndexSet all(solver.group_count());
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

IndexSet complement(const IndexSet& set, std::size_t count) {
  IndexSet rest;
  std::size_t at = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (at < set.size() && set[at] == i) {
      ++at;
    } else {
      rest.push_back(i);
    }
  }
  return rest;
}

IndexSet joined(const IndexSet& a, const IndexSet& b) {
  IndexSet both;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

/// Adds groups to a consistent set, which the solver has just found to be one, as long as it stays
/// consistent. False if the solver was stopped.
bool grow(GroupSolver& solver, IndexSet& consistent) {
  consistent = joined(consistent, solver.satisfied());
  for (const auto group : complement(consistent, solver.group_count())) {
    if (std::binary_search(consistent.begin(), consistent.end(), group)) continue;
    switch (solver.solve(joined(consistent, {group}))) {
      case SolveStatus::kSatisfiable:
        consistent = joined(joined(consistent, {group}), solver.satisfied());
        break;
      case SolveStatus::kUnsatisfiable:
        break;
      case SolveStatus::kUnknown:
        return false;
    }
  }
  return true;
}

/// Which subsets are undecided: not above a contradiction, not below a consistent set.
class SubsetMap {
 public:
  SubsetMap(std::size_t count, const std::atomic<bool>* stop)
      : solver_(make_cadical_solver(stop)), count_(count) {
    for (std::uint32_t i = 0; i < count; ++i) solver_->set_phase(element(i));
  }
  SolveStatus next(IndexSet& subset) {
    const auto status = solver_->solve();
    subset.clear();
    if (status != SolveStatus::kSatisfiable) return status;
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (solver_->value(element(i))) subset.push_back(i);
    }
    return status;
  }
  void drop_above(const IndexSet& contradiction) {
    std::vector<Literal> clause;
    for (const auto i : contradiction) clause.push_back(~element(i));
    solver_->add_clause(clause);
  }
  void drop_below(const IndexSet& consistent) {
    std::vector<Literal> clause;
    for (const auto i : complement(consistent, count_)) clause.push_back(element(i));
    solver_->add_clause(clause);
  }

 private:
  static Literal element(std::uint32_t i) {
    return Literal::positive(static_cast<std::int32_t>(i) + 1);
  }
  std::unique_ptr<SatSolver> solver_;
  std::size_t count_;
};

/// Makes sets to hit out of a consistent set, which the solver has just found to be one: what its
/// largest extension lacks, and further ones that have no element in common with that. False if the
/// solver was stopped.
bool add_corrections(GroupSolver& solver, IndexSet consistent, HittingSets& hitting) {
  auto base = consistent;
  while (true) {
    if (!grow(solver, consistent)) return false;
    const auto correction = complement(consistent, solver.group_count());
    hitting.add(correction);
    base = joined(base, correction);
    const auto status = solver.solve(base);
    if (status != SolveStatus::kSatisfiable) return status == SolveStatus::kUnsatisfiable;
    consistent = base;
  }
}

/// A stream into memory, for the solver's proof.
class MemoryFile {
 public:
  MemoryFile() : stream_(open_memstream(&text_, &size_)) {}
  ~MemoryFile() {
    close();
    std::free(text_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::FILE* stream() const { return stream_; }
  std::string text() {
    close();
    return text_ == nullptr ? std::string() : std::string(text_, size_);
  }

 private:
  void close() {
    if (stream_ != nullptr) std::fclose(stream_);
    stream_ = nullptr;
  }
  char* text_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* stream_;
};

/// Clauses of the groups, each a group of its own.
std::vector<std::size_t> candidates(const CompiledModel& model, const AxiomGroups& axioms,
                                    const IndexSet& groups) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    const auto group = axioms.group_of[model.clause_origins[i]];
    const bool wanted = std::binary_search(groups.begin(), groups.end(), group);
    if (wanted && !model.clause_is_definition[i]) found.push_back(i);
  }
  std::stable_sort(found.begin(), found.end(), [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t i) {
      return std::pair(axioms.group_of[model.clause_origins[i]], model.clause_timepoints[i]);
    };
    return key(a) < key(b);
  });
  return found;
}

ProofReport check(ExecutionFormula& formula, const std::vector<std::size_t>& clauses,
                  const ProofLimits& limits) {
  MemoryFile proof;
  if (proof.stream() == nullptr) return {ProofVerdict::kNotFinished, "there is no memory", {}};
  auto solver = make_proving_solver(proof.stream(), ProofForm::kBinary, limits.stop);
  std::string text;
  std::size_t count = 0;
  const auto add = [&](std::span<const Literal> clause) {
    solver->add_clause(clause);
    for (const auto literal : clause) text += std::to_string(literal.dimacs()) + ' ';
    text += "0\n";
    ++count;
  };
  formula.for_each_always(add);
  for (const auto i : clauses) add(formula.clause(i));
  const auto status = solver->solve();
  solver.reset();
  if (status == SolveStatus::kUnknown) return {ProofVerdict::kNotFinished, "it was stopped", {}};
  if (status == SolveStatus::kSatisfiable) {
    return {ProofVerdict::kRejected, "the solver finds a model", {}};
  }
  std::istringstream formula_text("p cnf " + std::to_string(formula.variables()) + ' ' +
                                  std::to_string(count) + '\n' + text);
  std::istringstream proof_text(proof.text());
  return check_proof(formula_text, proof_text, DratFormat::kBinary, limits);
}

}  // namespace

bool shrink(GroupSolver& solver, IndexSet& contradiction, Effort* effort) {
  IndexSet needed;  // or not known to go
  bool minimal = true;
  auto candidates = contradiction;
  const auto keep = [&](std::uint32_t group) {
    needed.insert(std::lower_bound(needed.begin(), needed.end(), group), group);
  };
  while (!candidates.empty()) {
    if (effort != nullptr && effort->is_spent()) {
      contradiction = joined(needed, candidates);
      return false;
    }
    const auto tried = candidates.back();
    candidates.pop_back();
    switch (solver.solve(joined(needed, candidates), effort)) {
      case SolveStatus::kSatisfiable:
        keep(tried);
        break;
      case SolveStatus::kUnsatisfiable: {
        const auto used = solver.core();
        std::erase_if(candidates, [&](std::uint32_t group) {
          return !std::binary_search(used.begin(), used.end(), group);
        });
        break;
      }
      case SolveStatus::kUnknown:
        minimal = false;
        keep(tried);
        break;
    }
  }
  contradiction = std::move(needed);
  return minimal;
}

MinimalSets smallest_set(GroupSolver& solver, const std::atomic<bool>* stop) {
  MinimalSets result;
  const auto status = solver.solve(everything(solver));
  result.unknown = status == SolveStatus::kUnknown;
  result.proven = status == SolveStatus::kSatisfiable;
  if (status != SolveStatus::kUnsatisfiable) return result;
  auto& best = result.sets.emplace_back(solver.core());
  if (!shrink(solver, best) || best.empty()) {
    result.proven = best.empty();
    return result;
  }
  HittingSets hitting(solver.group_count(), best.size() - 1, stop);
  while (true) {
    auto candidate = hitting.smallest();
    result.lower_bound = hitting.lower_bound();
    if (!candidate) {
      result.proven = !hitting.stopped();
      return result;
    }
    switch (solver.solve(*candidate)) {
      case SolveStatus::kUnsatisfiable:
        best = *std::move(candidate);
        result.proven = true;
        return result;
      case SolveStatus::kSatisfiable:
        if (add_corrections(solver, *std::move(candidate), hitting)) break;
        return result;
      case SolveStatus::kUnknown:
        return result;
    }
  }
}

MinimalSets all_minimal_sets(GroupSolver& solver, std::size_t limit,
                             const std::atomic<bool>* stop) {
  MinimalSets result;
  SubsetMap map(solver.group_count(), stop);
  IndexSet seed;
  bool going = true;
  while (going) {
    const auto more = map.next(seed);
    result.proven = more == SolveStatus::kUnsatisfiable;
    if (more != SolveStatus::kSatisfiable) break;
    switch (solver.solve(seed)) {
      case SolveStatus::kSatisfiable:
        going = grow(solver, seed);
        map.drop_below(seed);
        break;
      case SolveStatus::kUnsatisfiable:
        if (limit > 0 && result.sets.size() == limit) {
          going = false;
          break;
        }
        seed = solver.core();
        going = shrink(solver, seed);
        if (going) result.sets.push_back(seed);
        map.drop_above(seed);
        break;
      case SolveStatus::kUnknown:
        going = false;
        break;
    }
  }
  result.unknown = result.sets.empty() && !result.proven;
  std::sort(result.sets.begin(), result.sets.end(), [](const IndexSet& a, const IndexSet& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  return result;
}

GroundContradiction ground_contradiction(ExecutionFormula& formula, const AxiomGroups& axioms,
                                         const IndexSet& groups, const ProofLimits& limits,
                                         Effort& effort) {
  GroundContradiction result;
  const auto all = candidates(formula.model(), axioms, groups);
  GroupSolver solver(formula.variables(), all.size(), make_cadical_solver(limits.stop));
  formula.for_each_always([&](std::span<const Literal> clause) { solver.add_definition(clause); });
  for (std::uint32_t k = 0; k < all.size(); ++k) solver.add(formula.clause(all[k]), k);
  IndexSet kept(all.size());
  std::iota(kept.begin(), kept.end(), 0U);
  if (solver.solve(kept) == SolveStatus::kUnsatisfiable) {
    kept = solver.core();
    result.minimal = shrink(solver, kept, &effort);
  }
  for (const auto k : kept) result.clauses.push_back(all[k]);
  result.proof = check(formula, result.clauses, limits);
  return result;
}

}  // namespace parallax::runtime
