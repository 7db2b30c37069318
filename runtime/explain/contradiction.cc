#include "runtime/explain/contradiction.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <sstream>
#include <string>

namespace parallax::runtime {
namespace {

using compiler::CompiledModel;

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
