// The table of binding strengths, row by row, and its consequences.

#include <doctest/doctest.h>

#include "tests/compiler/front_end.h"
#include "tests/compiler/syntax/tree_text.h"

namespace parallax::test {
namespace {

/// The tree of one formula, or the codes of its errors.
std::string shape(std::string text) {
  FrontEnd front;
  const auto file = front.add(std::move(text));
  const auto parsed = compiler::parse_formula(file, front.files, front.sink);
  if (parsed) return tree_text(parsed->ast, parsed->root);
  return front.codes().at(0);
}

TEST_CASE("quantifiers bind weakest: their scope reaches as far right as possible") {
  CHECK(shape("[x] P(x) & Q(x)") == "([x](P(x)&Q(x)))");
  CHECK(shape("[x] P(x) -> Q(x) <-> R(x)") == "([x]((P(x)->Q(x))<->R(x)))");
  CHECK(shape("A() & {x} B() | C()") == "(A()&({x}(B()|C())))");
  CHECK(shape("!{x} P(x) & Q(x)") == "(!({x}(P(x)&Q(x))))");
  CHECK(shape("({x} P(x)) & Q()") == "(({x}P(x))&Q())");
  CHECK(shape("P() -> [x] Q(x) -> {y} R(y) | S()") == "(P()->([x](Q(x)->({y}(R(y)|S())))))");
  CHECK(shape("[a][b,c] P()") == "([a]([b,c]P()))");
  CHECK(shape("F({x} P(x) & Q(), R())") == "F(({x}(P(x)&Q())),R())");
}

TEST_CASE("-> and <-> share a level and associate to the left") {
  CHECK(shape("A() -> B() -> C()") == "((A()->B())->C())");
  CHECK(shape("A() <-> B() -> C()") == "((A()<->B())->C())");
  CHECK(shape("A() -> B() <-> C()") == "((A()->B())<->C())");
  CHECK(shape("A() | B() -> C() | D()") == "((A()|B())->(C()|D()))");
  CHECK(shape("a<->b") == "(a<->b)");
}

TEST_CASE("| binds weaker than &, both associate to the left and are flat") {
  CHECK(shape("A() | B() & C() | D()") == "(A()|(B()&C())|D())");
  CHECK(shape("A() & B() & C()") == "(A()&B()&C())");
  CHECK(shape("(A() & B()) & C()") == "((A()&B())&C())");
  CHECK(shape("A() & (B() & C())") == "(A()&(B()&C()))");
  CHECK(shape("A() | B() | C() & D()") == "(A()|B()|(C()&D()))");
}

TEST_CASE("= and != bind tighter than & and associate to the left") {
  CHECK(shape("a=b & c!=d") == "((a=b)&(c!=d))");
  CHECK(shape("a=b!=c") == "((a=b)!=c)");
}

TEST_CASE("< <= >= > bind tighter than = and do not associate") {
  CHECK(shape("a=b<c") == "(a=(b<c))");
  CHECK(shape("a<=b=c>=d") == "((a<=b)=(c>=d))");
  CHECK(shape("a<b<c") == "E1008");
  CHECK(shape("a<b>=c") == "E1008");
  CHECK(shape("(a<b)<c") == "((a<b)<c)");
}

TEST_CASE("+ and - bind tighter than comparisons, binary and unary alike") {
  CHECK(shape("a+b<c-d") == "((a+b)<(c-d))");
  CHECK(shape("a-b+c") == "((a-b)+c)");
  CHECK(shape("a-b-c") == "((a-b)-c)");
  CHECK(shape("-a+b") == "((-a)+b)");
  CHECK(shape("-a*b") == "(-(a*b))");
  CHECK(shape("a - -b") == "(a-(-b))");
  CHECK(shape("+a-b") == "((+a)-b)");
  CHECK(shape("x=-1") == "(x=(-1))");
}

TEST_CASE("* / ^ % share the tightest binary level and associate to the left") {
  CHECK(shape("a*b/c^d%e") == "((((a*b)/c)^d)%e)");
  CHECK(shape("a+b*c") == "(a+(b*c))");
  CHECK(shape("2*-a*b") == "(2*(-(a*b)))");
  CHECK(shape("2*-a+b") == "((2*(-a))+b)");
}

TEST_CASE("! binds tightest") {
  CHECK(shape("!x=y") == "((!x)=y)");
  CHECK(shape("!A() & B()") == "((!A())&B())");
  CHECK(shape("!!A()") == "(!(!A()))");
  CHECK(shape("!-a*b") == "(!(-(a*b)))");
  CHECK(shape("!(A() & B())") == "(!(A()&B()))");
}

TEST_CASE("applications take no, one or many arguments, and numbers may have a decimal part") {
  CHECK(shape("F()") == "F()");
  CHECK(shape("F(G(a,1),0.5)") == "F(G(a,1),0.5)");
  CHECK(shape("Sin(0)=0.") == "(Sin(0)=0)");
  CHECK(shape("Sin(0)=0.5.") == "(Sin(0)=0.5)");
}

TEST_CASE("every malformed formula has its own message") {
  CHECK(shape("") == "E1003");
  CHECK(shape("()") == "E1003");
  CHECK(shape("F(a,)") == "E1003");
  CHECK(shape("F(,a)") == "E1003");
  CHECK(shape("A() &") == "E1003");
  CHECK(shape("A() & . ") == "E1003");
  CHECK(shape("A() B()") == "E1004");
  CHECK(shape("(A(), B())") == "E1020");
  CHECK(shape("A(), B()") == "E1020");
  CHECK(shape("a : b") == "E1004");
  CHECK(shape("(A()") == "E1005");
  CHECK(shape("F(a") == "E1005");
  CHECK(shape("[x P(x)") == "E1005");
  CHECK(shape("A())") == "E1006");
  CHECK(shape("A()]") == "E1006");
  CHECK(shape("[] P()") == "E1013");
  CHECK(shape("[x,] P()") == "E1013");
  CHECK(shape("{1} P()") == "E1013");
  CHECK(shape("A(). B().") == "E1018");
  CHECK(shape("A() @ B()") == "E1001");
}

}  // namespace
}  // namespace parallax::test
