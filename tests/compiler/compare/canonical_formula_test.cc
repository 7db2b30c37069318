#include "compiler/compare/canonical_formula.h"

#include <doctest/doctest.h>

#include "compiler/compare/model_facts.h"
#include "compiler/syntax/parser.h"
#include "tests/support/model_edits.h"

namespace parallax::test {
namespace {

std::string canonical(const std::string& formula) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto parsed = compiler::parse_formula(files.add("f.e", formula), files, sink);
  REQUIRE_MESSAGE(parsed.has_value(), formula);
  return compiler::canonical_formula(parsed->ast, parsed->root);
}

std::string canonical_model(const std::string& text) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto ast = compiler::parse_file(files.add("m.e", text), files, sink);
  REQUIRE_MESSAGE(!sink.has_errors(), text);
  return compiler::canonical_text(compiler::text_facts(ast, files));
}

}  // namespace

TEST_CASE("names of bound variables, layout, brackets and order of operands say nothing") {
  const auto* wanted =
      "[cup1,table1,time1] (HoldsAt(Clean(cup1),time1) & HoldsAt(On(cup1,table1),time1)) -> "
      "!Happens(Wash(cup1),time1)";
  CHECK(canonical(wanted) == wanted);
  CHECK(canonical("[table,cup,time]\n (HoldsAt(On(cup,table),time)&\n (HoldsAt(Clean(cup),time)))"
                  " -> !(Happens(Wash(cup),time))") == wanted);
  CHECK(canonical("[time7] ([cup3,table2] HoldsAt(Clean(cup3),time7) & HoldsAt(On(cup3,table2),"
                  "time7) -> !Happens(Wash(cup3),time7)).") == wanted);
}

TEST_CASE("what differs in meaning stays different") {
  CHECK(canonical("[a,b] P(a,b) -> P(b,a)") != canonical("[a,b] P(b,a) -> P(a,b)"));
  CHECK(canonical("[a1,a2] P(a1,a2) -> Q(a1,a2)") != canonical("[a1,a2] P(a1,a2) -> Q(a2,a1)"));
  CHECK(canonical("[a] P(a) -> Q(a)") != canonical("[a] Q(a) -> P(a)"));
  CHECK(canonical("[a] {b} P(a,b)") != canonical("{b} [a] P(a,b)"));
  CHECK(canonical("[a] P(a)") != canonical("[b] P(b)"));  // another sort
  CHECK(canonical("(A() -> B()) -> C()") != canonical("A() -> (B() -> C())"));
  CHECK(canonical("1-2-3=0") != canonical("1-(2-3)=0"));
  CHECK(canonical("!A() & B()") != canonical("!(A() & B())"));
}

TEST_CASE("variables are told apart by all places where they stand") {
  CHECK(canonical("[a1,a2] (P(a1) & P(a2)) -> Q(a1)") ==
        canonical("[a1,a2] (P(a1) & P(a2)) -> Q(a2)"));
  CHECK(canonical("[a1,a2,a3] P(a1,a2) & P(a2,a3) -> Q(a1)") ==
        canonical("[a3,a2,a1] P(a2,a1) & P(a3,a2) -> Q(a3)"));
}

TEST_CASE("an inner quantifier may use the name of an outer one") {
  CHECK(canonical("[a] P(a) -> ({a} Q(a))") == canonical("[a1] P(a1) -> ({a2} Q(a2))"));
  CHECK(canonical("count{a,b: P(a) & Q(b)}>=2") == canonical("count{b1,a3: Q(b1)&P(a3)} >= 2"));
  CHECK(canonical("[a] sum{b: W(b,a): Q(b)}=2") == canonical("[a2] 2=sum{b3: W(b3,a2): Q(b3)}"));
  CHECK(canonical("count{a: P(a)}>=2") != canonical("count{a: P(a)}>=3"));
  CHECK(canonical("count{a: P(a)}>=2 & {a} Q(a)") ==
        canonical("({a2} Q(a2)) & count{a1: P(a1)}>=2"));
  CHECK(canonical("([a] P(a)) & ([a] Q(a))") == canonical("([a1] P(a1)) & ([a2] Q(a2))"));
}

TEST_CASE("reading a canonical text and writing it again changes nothing") {
  std::size_t formulas = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    const auto model = random_model(seed, seed % 5 == 0 ? kSolverSize : kBruteForceSize);
    const auto text = canonical_model(model.print());
    CHECK(canonical_model(text) == text);
    formulas += model.statements.size();
  }
  CHECK(formulas > 3000);
}

TEST_CASE("a model that is written differently has the same canonical text") {
  FuzzRandom random(7);
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const auto model = random_model(seed, seed % 5 == 0 ? kSolverSize : kBruteForceSize);
    const auto text = model.print();
    const auto other = rewritten(model, random).print();
    CAPTURE(text);
    CAPTURE(other);
    CHECK(canonical_model(text) == canonical_model(other));
  }
}

TEST_CASE("deep and wide formulas take neither stack nor much time") {
  std::string deep;
  for (int i = 0; i < 9000; ++i) deep += "!(";
  deep += "A()" + std::string(9000, ')');
  CHECK(canonical(deep).size() > 9000);
  std::string wide = "[a]";
  for (int i = 0; i < 100000; ++i) wide += (i == 0 ? "P(a," : " & P(a,") + std::to_string(i) + ")";
  CHECK(canonical(wide).size() > 1000000);
}

}  // namespace parallax::test
