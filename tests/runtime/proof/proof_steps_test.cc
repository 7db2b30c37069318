// Proofs and formulas written by hand, one step at a time: the steps that the checker accepts and
// refuses, and its readers on arbitrary bytes.

#include <doctest/doctest.h>

#include <sstream>
#include <string>
#include <vector>

#include "runtime/proof/drat_checker.h"
#include "runtime/proof/proof_reader.h"

namespace parallax::test {
namespace {

using runtime::DimacsReader;
using runtime::DratChecker;
using runtime::DratFormat;
using runtime::DratReader;
using runtime::DratStep;
using runtime::ProofLimits;
using Clause = std::vector<std::int64_t>;
using Outcome = DratChecker::Outcome;

/// A checker that holds these clauses.
DratChecker holding(const std::vector<Clause>& formula, const ProofLimits& limits = {}) {
  std::uint32_t variables = 0;
  for (const auto& clause : formula) {
    for (const auto literal : clause) {
      variables = std::max(variables, static_cast<std::uint32_t>(std::abs(literal)));
    }
  }
  DratChecker checker(variables, limits);
  for (const auto& clause : formula) CHECK(checker.add_clause(clause) == Outcome::kFine);
  return checker;
}

const std::vector<Clause> kSquare = {{1, 2}, {-1, 2}, {1, -2}, {-1, -2}};

TEST_CASE("RUP: a clause whose negation propagates to a conflict") {
  auto checker = holding(kSquare);
  CHECK_FALSE(checker.refuted());
  CHECK(checker.add_lemma(Clause{2}) == Outcome::kFine);
  CHECK(checker.refuted());  // 1 and -1 follow
  CHECK(checker.statistics().lemmas == 1);
  CHECK(checker.statistics().resolution_lemmas == 0);
}

TEST_CASE("a step that does not follow is refused, and nothing is held of it") {
  auto checker = holding({{1, 2}, {-1, 3}, {-2, 4}});
  CHECK(checker.add_lemma(Clause{1}) == Outcome::kDoesNotFollow);
  CHECK(checker.add_lemma(Clause{3}) == Outcome::kFine);  // -3 never occurs: no resolvents
  CHECK(checker.add_lemma(Clause{-3}) == Outcome::kDoesNotFollow);
  CHECK(checker.add_lemma(Clause{1, 4}) == Outcome::kFine);  // -1 gives 2, 2 gives 4
  CHECK(checker.add_lemma(Clause{}) == Outcome::kDoesNotFollow);
  CHECK_FALSE(checker.refuted());
}

TEST_CASE("RAT: on the first literal, whatever the others are") {
  auto checker = holding({{1, 2}, {-1, -2}});
  CHECK(checker.add_lemma(Clause{3, 1}) == Outcome::kFine);            // 3 is new
  CHECK(checker.add_lemma(Clause{2, -3}) == Outcome::kDoesNotFollow);  // resolved on 2
  CHECK(checker.add_lemma(Clause{-3, 2}) == Outcome::kFine);           // resolved on -3
  CHECK(checker.statistics().resolution_lemmas == 3);
  CHECK(checker.add_lemma(Clause{3, 1, 2}) == Outcome::kFine);  // RUP, as 3 1 is held
  CHECK(checker.statistics().resolution_lemmas == 3);
}

TEST_CASE("RAT: a removed clause makes no resolvent") {
  const std::vector<Clause> formula = {{1, 2}, {-1, 3}};
  auto with = holding(formula);
  CHECK(with.add_lemma(Clause{1}) == Outcome::kDoesNotFollow);
  auto without = holding(formula);
  CHECK(without.remove_clause(Clause{3, -1}) == Outcome::kFine);  // in any order
  CHECK(without.add_lemma(Clause{1}) == Outcome::kFine);
}

TEST_CASE("a removed clause is of no more use") {
  auto checker = holding(kSquare);
  CHECK(checker.remove_clause(Clause{2, 1}) == Outcome::kFine);
  CHECK(checker.statistics().deletions == 1);
  CHECK(checker.statistics().ignored_deletions == 0);
  CHECK(checker.add_lemma(Clause{2}) == Outcome::kDoesNotFollow);
}

TEST_CASE("a clause that is there twice is removed twice, one that is not there is left") {
  auto checker = holding({{1, 2}, {2, 1}, {-1, 2}, {1, -2}, {-1, -2}});
  CHECK(checker.remove_clause(Clause{1, 2}) == Outcome::kFine);
  CHECK(checker.remove_clause(Clause{1, 3}) == Outcome::kFine);
  CHECK(checker.statistics().ignored_deletions == 1);
  auto copy = holding(kSquare);
  CHECK(checker.add_lemma(Clause{2}) == Outcome::kFine);  // one is left
  auto twice = holding({{1, 2}, {2, 1}, {-1, 2}, {1, -2}, {-1, -2}});
  CHECK(twice.remove_clause(Clause{1, 2}) == Outcome::kFine);
  CHECK(twice.remove_clause(Clause{1, 2}) == Outcome::kFine);
  CHECK(twice.statistics().ignored_deletions == 0);
  CHECK(twice.add_lemma(Clause{2}) == Outcome::kDoesNotFollow);
}

TEST_CASE("what supports a literal stays: a unit clause, and the clause that forced one") {
  auto checker = holding({{1}, {-1, 2}, {-2, 3, 4}});
  CHECK(checker.remove_clause(Clause{1}) == Outcome::kFine);
  CHECK(checker.remove_clause(Clause{2, -1}) == Outcome::kFine);
  CHECK(checker.statistics().ignored_deletions == 2);
  CHECK(checker.add_lemma(Clause{2}) == Outcome::kFine);
  CHECK(checker.add_lemma(Clause{3, 4}) == Outcome::kFine);
  CHECK(checker.remove_clause(Clause{-2, 3, 4}) == Outcome::kFine);  // supports nothing
  CHECK(checker.statistics().ignored_deletions == 2);
  CHECK(checker.statistics().resolution_lemmas == 0);
}

TEST_CASE("tautologies say nothing, repeated literals count once, the empty clause refutes") {
  auto checker = holding({{1, -1}, {2, 2}});
  CHECK_FALSE(checker.refuted());
  CHECK(checker.add_lemma(Clause{3, -3, 4}) == Outcome::kFine);
  CHECK(checker.remove_clause(Clause{1, -1}) == Outcome::kFine);
  CHECK(checker.add_lemma(Clause{-2, -2}) == Outcome::kDoesNotFollow);
  auto refuted = holding({{}});
  CHECK(refuted.refuted());
  CHECK(refuted.add_lemma(Clause{7}) == Outcome::kFine);  // anything follows
  CHECK(holding({{1}, {-1}}).refuted());
}

TEST_CASE("room and variables are limited") {
  ProofLimits limits;
  limits.more_variables = 3;
  CHECK(holding({{1, 2}}, limits).max_variable() == 5);
  limits.bytes = 1'000;
  auto checker = holding({{1, 2}}, limits);
  CHECK(checker.add_lemma(Clause{100}) == Outcome::kNoRoom);
}

struct Read {
  std::vector<DratStep> steps;
  std::string problem;
  std::int64_t offset = 0;
};

Read read(const std::string& text, DratFormat format, std::int64_t max_variable = 1'000) {
  std::istringstream in(text);
  DratReader reader(in, format, max_variable);
  Read out;
  DratStep step;
  auto outcome = DratReader::Outcome::kStep;
  while ((outcome = reader.next(step)) == DratReader::Outcome::kStep) out.steps.push_back(step);
  if (outcome == DratReader::Outcome::kMalformed) out.problem = reader.problem();
  CHECK(reader.steps() == std::ssize(out.steps));
  out.offset = reader.offset();
  return out;
}

std::string bytes(std::initializer_list<int> list) {
  std::string out;
  for (const int byte : list) out += static_cast<char>(byte);
  return out;
}

TEST_CASE("steps in text: clauses over blanks and lines, deletions") {
  const auto found = read("1 -2 0\nd 3\n 4 0 0\n", DratFormat::kText);
  CHECK(found.problem == "");
  REQUIRE(found.steps.size() == 3);
  CHECK(found.steps[0].clause == Clause{1, -2});
  CHECK(!found.steps[0].deletes);
  CHECK(found.steps[1].clause == Clause{3, 4});
  CHECK(found.steps[1].deletes);
  CHECK(found.steps[2].clause.empty());
}

TEST_CASE("steps in binary: 2v and 2v + 1 in groups of seven bits") {
  const auto found =
      read(bytes({'a', 2, 5, 0, 'd', 0x80, 0x01, 0x81, 0x01, 0, 'a', 0}), DratFormat::kBinary);
  CHECK(found.problem == "");
  REQUIRE(found.steps.size() == 3);
  CHECK(found.steps[0].clause == Clause{1, -2});
  CHECK(found.steps[1].clause == Clause{64, -64});
  CHECK(found.steps[1].deletes);
  CHECK(found.steps[2].clause.empty());
  CHECK(found.offset == 12);
}

TEST_CASE("steps that are cut off or no steps are refused; what stands before them is read") {
  const auto problem = [](const std::string& text, DratFormat format, std::size_t steps) {
    const auto found = read(text, format);
    CHECK(found.steps.size() == steps);
    return found.problem;
  };
  const std::string cut = "the file ends within a clause";
  CHECK(problem("1 0\n2", DratFormat::kText, 1) == cut);
  CHECK(problem("d", DratFormat::kText, 0) == cut);
  CHECK(problem("1 0\nd 2 ", DratFormat::kText, 1) == cut);
  CHECK(problem("1 x 0", DratFormat::kText, 0) == "`x` is no literal");
  CHECK(problem("1001 0", DratFormat::kText, 0) == "the variable 1001 is beyond 1000");
  CHECK(problem("1 d 0", DratFormat::kText, 0) == "`d` is no literal");
  for (const auto& text : {bytes({'a'}), bytes({'a', 2}), bytes({'d', 2, 0x80})}) {
    CHECK(problem(text, DratFormat::kBinary, 0) == cut);
  }
  CHECK(problem(bytes({'a', 2, 0, 'x'}), DratFormat::kBinary, 1) ==
        "a step begins with neither `a` nor `d`");
  CHECK(problem(bytes({'a', 1, 0}), DratFormat::kBinary, 0) == "1 is no literal");
  CHECK(problem(bytes({'a', 0x82, 0, 0}), DratFormat::kBinary, 0) ==
        "a number is longer than it need be");
  CHECK(problem(bytes({'a', 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 1}), DratFormat::kBinary, 0) ==
        "a number is too large");
  CHECK(read("1 2 -1 -2 1 0", DratFormat::kText, 2).problem ==
        "a clause has more literals than there are");
}

/// The clauses of a formula as one text, or the reader's problem with it.
std::string clauses_of(const std::string& text) {
  std::istringstream in(text);
  DimacsReader reader(in);
  if (!reader.read_header()) return reader.problem();
  std::string out;
  Clause clause;
  for (;;) {
    switch (reader.next(clause)) {
      case DimacsReader::Outcome::kEnd:
        return out;
      case DimacsReader::Outcome::kMalformed:
        return reader.problem();
      case DimacsReader::Outcome::kClause:
        for (const auto literal : clause) out += std::to_string(literal) + ' ';
        out += "0;";
    }
  }
}

TEST_CASE("formulas: comments anywhere, clauses over lines, as many as were promised") {
  CHECK(clauses_of("c x\n\np cnf 3 2\nc y\n1 -2\n3 0 \nc z\n-1 0\nc end\n") == "1 -2 3 0;-1 0;");
  CHECK(clauses_of("p cnf 0 0\n") == "");
  CHECK(clauses_of("p cnf 0 1\n0\n") == "0;");
  CHECK(clauses_of("p cnf 1 1\n1 0\n-1 0\n").starts_with("line 3: "));
  CHECK(clauses_of("p cnf 1 2\n1 0\n").starts_with("line 2: "));
  CHECK(clauses_of("p cnf 1 1\n1\n").starts_with("line 2: "));
  CHECK(clauses_of("p cnf 1\n").starts_with("line 1: "));
  CHECK(clauses_of("p dnf 1 1\n").starts_with("line 1: "));
  CHECK(clauses_of("") == "line 0: the file has no line `p cnf`");
}

}  // namespace
}  // namespace parallax::test
