#include "compiler/compare/fact.h"

#include <doctest/doctest.h>

#include "compiler/compare/model_facts.h"
#include "compiler/syntax/parser.h"

namespace parallax::test {
namespace {

using compiler::Fact;

std::vector<Fact> facts_of(const std::string& text) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  return compiler::text_facts(compiler::parse_file(files.add("m.e", text), files, sink), files);
}

/// "-3 +4 ~1:2": lines of what was removed, added and changed.
std::string lines(const std::string& before, const std::string& after) {
  const auto a = facts_of(before), b = facts_of(after);
  const auto difference = compiler::compare_facts(a, b);
  std::string out;
  for (const auto i : difference.removed) out += " -" + std::to_string(a[i].place.line);
  for (const auto i : difference.added) out += " +" + std::to_string(b[i].place.line);
  for (const auto& [i, j] : difference.changed) {
    out += " ~" + std::to_string(a[i].place.line) + ":" + std::to_string(b[j].place.line);
  }
  return out.empty() ? out : out.substr(1);
}

}  // namespace

TEST_CASE("order, repetition and the grouping of declarations say nothing") {
  CHECK(lines("sort a, b\na A, B\nfluent F(a)\nHoldsAt(F(A),0).\n!HoldsAt(F(B),0).\n",
              "sort b\nsort a\nfluent F(a)\na B\na A\n!HoldsAt(F(B),0).\nHoldsAt(F(A),0).\n"
              "HoldsAt(F(A),0).\n") == "");
}

TEST_CASE("declarations are matched by what they declare") {
  CHECK(lines("range time 0 3\n", "; longer\nrange time 0 4\n") == "~1:2");
  CHECK(lines("fluent F(a)\n", "fluent F(a,b)\n") == "~1:1");
  CHECK(lines("fluent F(a)\n", "fluent G(a)\n") == "-1 +1");
  CHECK(lines("sort a\nsort b\n", "sort b\nsort c\n") == "-1 +2");
}

TEST_CASE("axioms are matched by similarity, the most similar first") {
  const std::string before =
      "[time] HoldsAt(F(),time) -> Initiates(E(),G(),time).\n"
      "[time] HoldsAt(G(),time) -> Terminates(E(),F(),time).\n";
  CHECK(lines(before,
              "[time] HoldsAt(G(),time) -> Terminates(D(),F(),time).\n"
              "[time] HoldsAt(F(),time) & HoldsAt(H(),time) -> Initiates(E(),G(),time).\n") ==
        "~1:2 ~2:1");
  CHECK(lines("HoldsAt(F(),0).\n", "[a1,a2,time] Happens(M(a1),time) & P(a2) -> a1=a2.\n") ==
        "-1 +1");
}

TEST_CASE("a label is part of an axiom") {
  CHECK(lines("Delta: Happens(E(),0).\n", "Happens(E(),0).\n") == "~1:1");
}

TEST_CASE("similarity is not looked for among very many") {
  std::string before, after;
  for (int i = 0; i < 1000; ++i) {
    before += "P(" + std::to_string(i) + ",0).\n";
    after += "P(" + std::to_string(i) + ",1).\n";
  }
  const auto a = facts_of(before), b = facts_of(after);
  const auto difference = compiler::compare_facts(a, b);
  CHECK(difference.removed.size() == 1000);
  CHECK(difference.added.size() == 1000);
  CHECK(difference.changed.empty());
}

}  // namespace parallax::test
