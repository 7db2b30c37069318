// A condition that is called impossible is impossible.

#include <doctest/doctest.h>

#include <cstdint>

#include "compiler/lint/rules.h"
#include "tests/compiler/lint/lint_text.h"
#include "tests/support/random.h"

namespace parallax::test {
namespace {

const char* const kWorld =
    "range time 0 1\nsort n: integer\nrange n 0 3\nsort a\na A, B\npredicate P(n,a)\n"
    "predicate Q()\n";

/// W2108 for `condition -> Q()`.
bool impossible(const std::string& condition) {
  const LintedText linted(kWorld + ("[n1,n2,a1,a2] (" + condition + ") -> Q().\n"));
  for (const auto& code : linted.codes()) {
    if (code == "W2108") return true;
  }
  return false;
}

TEST_CASE("conditions that contradict themselves are found") {
  for (const auto* condition :
       {"n1!=n1", "n1<n1", "!(n1=n1)", "n1=1 & n1=2", "1=n1 & n1=2", "a1=A & a1=B", "A=B", "2<1",
        "n1<1 & n1>2", "n1<2 & n1>1", "n1=1 & n1>1", "n1=n2 & n2!=n1", "a1=A & a1!=A",
        "P(n1,a1) & !P(n1,a1)", "!(P(n1,a1) | Q()) & Q()", "{n} P(n,A) & n=1 & n=2",
        "n1+n2=1 & n1+n2=2"}) {
    CHECK_MESSAGE(impossible(condition), condition);
  }
}

TEST_CASE("conditions that can hold are left alone") {
  for (const auto* condition :
       {"n1=n1", "n1<=n1", "n1=1 & n2=2", "n1>1 & n1<3", "n1!=1 & n1!=2", "P(n1,a1) & !P(n2,a1)",
        "n1=1 | n1=2", "a1!=a2", "1<2", "A!=B", "({n} P(n,A)) & !({n} P(n,A))", "n1-n2=1 & n2-n1=1",
        "n1=n2 & n1=1 & n2=2"}) {
    CHECK_MESSAGE(!impossible(condition), condition);
  }
}

/// A random conjunction of literals over n1 and n2 in 0..3, with what it says.
struct Conjunction {
  struct Literal {
    int left = 0;  // 0, 1: n1, n2; from 2 on the number left-2
    int right = 0;
    int op = 0;
    bool negated = false;
  };
  std::vector<Literal> literals;

  static std::string operand(int x) {
    return x < 2 ? "n" + std::to_string(x + 1) : std::to_string(x - 2);
  }
  std::string text() const {
    static const char* const kOps[] = {"=", "!=", "<", "<=", ">", ">="};
    std::string out;
    for (const auto& literal : literals) {
      if (!out.empty()) out += " & ";
      const auto compared = operand(literal.left) + kOps[literal.op] + operand(literal.right);
      out += literal.negated ? "!(" + compared + ")" : compared;
    }
    return out;
  }
  bool holds(int n1, int n2) const {
    const auto value = [&](int x) { return x == 0 ? n1 : x == 1 ? n2 : x - 2; };
    for (const auto& literal : literals) {
      const int l = value(literal.left), r = value(literal.right);
      const bool results[] = {l == r, l != r, l<r, l <= r, l> r, l >= r};
      if (results[literal.op] == literal.negated) return false;
    }
    return true;
  }
  bool satisfiable() const {
    for (int n1 = -9; n1 <= 9; ++n1) {
      for (int n2 = -9; n2 <= 9; ++n2) {
        if (holds(n1, n2)) return true;
      }
    }
    return false;
  }
};

TEST_CASE("no false alarm in 2,000 random conditions, and some alarms") {
  Random random(5);
  int alarms = 0;
  for (int round = 0; round < 2'000; ++round) {
    Conjunction conjunction;
    const auto count = 1 + random.below(4);
    for (std::uint32_t i = 0; i < count; ++i) {
      conjunction.literals.push_back({static_cast<int>(random.below(6)),
                                      static_cast<int>(random.below(6)),
                                      static_cast<int>(random.below(6)), random.below(4) == 0});
    }
    const bool found = impossible(conjunction.text());
    if (found) CHECK_MESSAGE(!conjunction.satisfiable(), conjunction.text());
    alarms += found ? 1 : 0;
  }
  CHECK(alarms > 200);
}

}  // namespace
}  // namespace parallax::test
