#include "runtime/proof/check_proof.h"

#include <fmt/format.h>

#include "runtime/proof/proof_reader.h"

namespace parallax::runtime {
namespace {

using Outcome = DratChecker::Outcome;

std::string clause_text(const std::vector<std::int64_t>& clause) {
  constexpr std::size_t kShown = 12;
  std::string text;
  for (std::size_t i = 0; i < clause.size() && i < kShown; ++i) {
    text += fmt::format("{} ", clause[i]);
  }
  return text + (clause.size() > kShown ? fmt::format("... {} literals", clause.size()) : "0");
}

ProofReport unfinished(Outcome outcome) {
  return {ProofVerdict::kNotFinished,
          outcome == Outcome::kStopped ? "it was stopped" : "it needs more memory than it may use",
          {}};
}

ProofReport rejected(std::string reason) {
  return {ProofVerdict::kRejected, std::move(reason), {}};
}

ProofReport read_formula(DimacsReader& reader, DratChecker& checker) {
  std::vector<std::int64_t> clause;
  while (true) {
    const auto found = reader.next(clause);
    if (found == DimacsReader::Outcome::kMalformed) {
      return rejected("the formula, " + reader.problem());
    }
    if (found == DimacsReader::Outcome::kEnd) return {ProofVerdict::kAccepted, {}, {}};
    const auto outcome = checker.add_clause(clause);
    if (outcome != Outcome::kFine) return unfinished(outcome);
  }
}

ProofReport read_proof(DratReader& reader, DratChecker& checker) {
  DratStep step;
  while (true) {
    const auto found = reader.next(step);
    if (found == DratReader::Outcome::kMalformed) {
      return rejected(fmt::format("after step {}, at byte {}: {}", reader.steps(), reader.offset(),
                                  reader.problem()));
    }
    if (found == DratReader::Outcome::kEnd) break;
    const auto outcome =
        step.deletes ? checker.remove_clause(step.clause) : checker.add_lemma(step.clause);
    if (outcome == Outcome::kDoesNotFollow) {
      return rejected(fmt::format("step {} adds a clause that does not follow: {}", reader.steps(),
                                  clause_text(step.clause)));
    }
    if (outcome != Outcome::kFine) return unfinished(outcome);
  }
  if (!checker.refuted()) {
    return rejected(fmt::format("its {} steps reach no contradiction", reader.steps()));
  }
  return {ProofVerdict::kAccepted, {}, {}};
}

}  // namespace

ProofReport check_proof(std::istream& formula, std::istream& proof, DratFormat format,
                        const ProofLimits& limits) {
  DimacsReader dimacs(formula);
  if (!dimacs.read_header()) return rejected("the formula, " + dimacs.problem());
  DratChecker checker(static_cast<std::uint32_t>(dimacs.variables()), limits);
  auto report = read_formula(dimacs, checker);
  if (report.verdict == ProofVerdict::kAccepted) {
    DratReader reader(proof, format, checker.max_variable());
    report = read_proof(reader, checker);
  }
  report.statistics = checker.statistics();
  return report;
}

}  // namespace parallax::runtime
