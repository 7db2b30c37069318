#include "runtime/proof/drat_checker.h"

#include <doctest/doctest.h>

#include <cstdio>
#include <random>
#include <sstream>

#include "runtime/solver/sat_solver.h"
#include "tests/runtime/proof/naive_drat.h"

namespace parallax::test {
namespace {

using runtime::DratFormat;
using runtime::ProofVerdict;

struct Formula {
  int variables = 0;
  std::vector<std::vector<long>> clauses;

  std::string dimacs() const {
    std::ostringstream out;
    out << "c made by a test\np cnf " << variables << ' ' << clauses.size() << '\n';
    for (const auto& clause : clauses) {
      for (const auto literal : clause) out << literal << ' ';
      out << "0\n";
    }
    return out.str();
  }
};

Formula random_formula(std::mt19937& random, int variables, std::size_t clauses) {
  Formula formula;
  formula.variables = variables;
  const auto count = static_cast<unsigned>(variables);
  while (formula.clauses.size() < clauses) {
    std::vector<long> clause;
    const auto size = random() % 12 == 0 ? 2 : 3;
    for (int i = 0; i < size; ++i) {
      const long variable = 1 + static_cast<long>(random() % count);
      clause.push_back(random() % 2 == 0 ? variable : -variable);
    }
    formula.clauses.push_back(clause);  // repeated and complementary literals included
  }
  return formula;
}

/// The proof that CaDiCaL writes; none if the formula has a model.
std::optional<std::string> proof_of(const Formula& formula, runtime::ProofForm form) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* stream = open_memstream(&text, &size);
  REQUIRE(stream != nullptr);
  auto solver = runtime::make_proving_solver(stream, form);
  for (const auto& clause : formula.clauses) {
    std::vector<runtime::Literal> literals;
    for (const auto literal : clause) {
      literals.push_back(runtime::Literal::from_dimacs(static_cast<std::int32_t>(literal)));
    }
    solver->add_clause(literals);
  }
  const auto status = solver->solve();
  solver.reset();
  std::fclose(stream);
  std::string proof(text, size);
  std::free(text);
  if (status == runtime::SolveStatus::kSatisfiable) return std::nullopt;
  return proof;
}

runtime::ProofReport check(const std::string& formula, const std::string& proof,
                           DratFormat format = DratFormat::kText,
                           const runtime::ProofLimits& limits = {}) {
  std::istringstream formula_stream(formula), proof_stream(proof);
  return runtime::check_proof(formula_stream, proof_stream, format, limits);
}

bool accepted(const runtime::ProofReport& report) {
  return report.verdict == ProofVerdict::kAccepted;
}

// No model: each clause excludes one assignment of three of the four variables.
constexpr const char* kNoModel =
    "p cnf 4 8\n"
    "1 2 -3 0\n-1 -2 3 0\n2 3 -4 0\n-2 -3 4 0\n1 3 4 0\n-1 -3 -4 0\n-1 2 4 0\n1 -2 -4 0\n";

TEST_CASE("every refutation of CaDiCaL is accepted, binary and text") {
  std::mt19937 random(7);
  int refuted = 0, deletions = 0;
  for (int i = 0; i < 300; ++i) {
    const int variables = 10 + static_cast<int>(random() % 110);
    const auto formula =
        random_formula(random, variables, static_cast<std::size_t>(variables) * 9 / 2);
    const auto form = i % 2 == 0 ? runtime::ProofForm::kBinary : runtime::ProofForm::kText;
    const auto proof = proof_of(formula, form);
    if (!proof) continue;
    ++refuted;
    const auto report =
        check(formula.dimacs(), *proof, i % 2 == 0 ? DratFormat::kBinary : DratFormat::kText);
    CHECK_MESSAGE(accepted(report), report.reason);
    deletions += report.statistics.deletions > 0 ? 1 : 0;
  }
  CHECK(refuted > 100);
  CHECK(deletions > 50);
}

TEST_CASE("a proof with a changed byte is accepted only if it is one nevertheless") {
  std::mt19937 random(11);
  int changed = 0, still_proofs = 0;
  while (changed < 1'000) {
    const int variables = 8 + static_cast<int>(random() % 9);
    const auto formula = random_formula(random, variables, static_cast<std::size_t>(variables) * 5);
    const auto proof = proof_of(formula, runtime::ProofForm::kBinary);
    if (!proof || proof->size() < 30) continue;
    runtime::ProofLimits limits;
    limits.more_variables = 3;
    REQUIRE(accepted(check(formula.dimacs(), *proof, DratFormat::kBinary, limits)));
    for (int i = 0; i < 40; ++i, ++changed) {
      auto corrupted = *proof;
      auto& byte = corrupted[random() % corrupted.size()];
      const auto old = byte;
      while (byte == old) byte = static_cast<char>(random() % 256);
      const bool valid = NaiveDrat(formula.clauses, variables + 3).accepts(corrupted);
      still_proofs += valid ? 1 : 0;
      const auto report = check(formula.dimacs(), corrupted, DratFormat::kBinary, limits);
      CHECK_MESSAGE(accepted(report) == valid, report.reason);
    }
  }
  CHECK(still_proofs < changed / 2);
}

TEST_CASE("a cut off proof is accepted only if what is left is a proof") {
  std::mt19937 random(13);
  const auto formula = random_formula(random, 14, 80);
  const auto proof = proof_of(formula, runtime::ProofForm::kBinary);
  REQUIRE(proof);
  for (std::size_t size = 0; size < proof->size(); ++size) {
    const auto part = proof->substr(0, size);
    CHECK(accepted(check(formula.dimacs(), part, DratFormat::kBinary)) ==
          NaiveDrat(formula.clauses, 1'000).accepts(part));
  }
}

TEST_CASE("a clause whose resolvents follow is accepted") {
  // Propagation does not show 1; its resolvents with the clauses of -1 follow.
  const auto report = check(kNoModel, "1 0\nd 1 2 -3 0\n2 0\n0\n");
  CHECK_MESSAGE(accepted(report), report.reason);
  CHECK(report.statistics.resolution_lemmas == 1);
  // Where a resolvent does not follow it is refused.
  CHECK_FALSE(accepted(check("p cnf 3 2\n-1 2 0\n-1 3 0\n", "1 0\n0\n")));
}

TEST_CASE("a definition over a new variable is accepted, one that contradicts it is not") {
  const std::string formula = "p cnf 2 2\n1 2 0\n-1 -2 0\n";
  auto report = check(formula, "3 1 0\n3 -1 0\n");
  CHECK(report.reason == "its 2 steps reach no contradiction");
  CHECK(report.statistics.resolution_lemmas == 2);
  report = check(formula, "3 1 0\n-3 0\n");
  CHECK(report.reason == "step 2 adds a clause that does not follow: -3 0");
}

TEST_CASE("a deleted clause is of no more use, unless it supports a literal") {
  const std::string formula = "p cnf 3 5\n1 2 0\n-1 2 0\n1 -2 0\n-1 -2 0\n3 0\n";
  CHECK(accepted(check(formula, "2 0\n0\n")));
  CHECK_FALSE(accepted(check(formula, "d 2 1 0\n2 0\n0\n")));
  CHECK_FALSE(accepted(check(formula, "d 1 -2 0\nd -1 -2 0\n2 0\n0\n")));
  // 3 stays assigned, and a clause that is not there cannot be deleted.
  const auto report = check(formula, "d 3 0\nd 1 3 0\n2 0\n0\n");
  CHECK(accepted(report));
  CHECK(report.statistics.ignored_deletions == 2);
}

TEST_CASE("what is no proof or no formula is refused with its place") {
  const std::string formula = "p cnf 1 2\n1 0\n-1 0\n";
  CHECK(accepted(check(formula, "")));  // propagation alone
  CHECK(check(formula, "x 0\n").reason == "after step 0, at byte 2: `x` is no literal");
  CHECK(check(formula, "0\n1").reason == "after step 1, at byte 3: the file ends within a clause");
  CHECK(check(formula, "99999999 0\n").reason ==
        "after step 0, at byte 9: the variable 99999999 is beyond 65537");
  CHECK(check(formula, "b", DratFormat::kBinary).reason ==
        "after step 0, at byte 1: a step begins with neither `a` nor `d`");
  CHECK(check("p cnf 1 2\n1 0\n", "").reason ==
        "the formula, line 2: the file ends after 1 of 2 clauses");
  CHECK(check("p cnf 1 1\n2 0\n", "").reason ==
        "the formula, line 2: `2` is no whole number from -1 to 1");
  CHECK(check("cnf\n", "").reason == "the formula, line 1: the file has no line `p cnf`");
}

TEST_CASE("limits end the check without a verdict") {
  std::mt19937 random(3);
  const auto formula = random_formula(random, 60, 330);
  const auto proof = proof_of(formula, runtime::ProofForm::kText);
  REQUIRE(proof);
  runtime::ProofLimits limits;
  limits.bytes = 4'000;
  auto report = check(formula.dimacs(), *proof, DratFormat::kText, limits);
  CHECK(report.verdict == ProofVerdict::kNotFinished);
  CHECK(report.reason == "it needs more memory than it may use");
  report = check("p cnf 2000000000 1\n2000000000 0\n", "", DratFormat::kText);
  CHECK(report.verdict == ProofVerdict::kNotFinished);
}

TEST_CASE("memory of deleted clauses is used again") {
  // Half a million clauses of ten literals pass through room for a fraction of them.
  std::string formula = "p cnf 12 2\n11 12 0\n-11 12 0\n", proof;
  for (int i = 0; i < 500'000; ++i) {
    const std::string clause = "12 1 2 3 4 5 6 7 8 9 10 0\n";
    proof += clause + "d " + clause;
  }
  runtime::ProofLimits limits;
  limits.bytes = std::size_t{10} << 20U;
  const auto report = check(formula, proof, DratFormat::kText, limits);
  CHECK(report.reason == "its 1000000 steps reach no contradiction");
}

}  // namespace
}  // namespace parallax::test
