// Several errors in one run, and the parts that are still read after an error.

#include <doctest/doctest.h>

#include "compiler/syntax/printer.h"
#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

struct Parsed : FrontEnd {
  std::string printed;
  explicit Parsed(std::string source) {
    const auto ast = compiler::parse_file(add(std::move(source)), files, sink);
    printed = compiler::print_file(ast);
  }
};

TEST_CASE("recovery: every broken formula is reported, every whole one is kept") {
  const Parsed parsed(
      "A( .\n"
      "B().\n"
      "C() D().\n"
      "[x E(x).\n"
      "F() & & G().\n"
      "H().\n");
  CHECK(parsed.places() == Strings{"E1003 1:4-4", "E1004 3:5-5", "E1005 4:4-4", "E1003 5:7-7"});
  CHECK(parsed.printed == "B().\nH().\n");
}

TEST_CASE("recovery: a missing period costs no formula") {
  const Parsed parsed("A()\nB().\n[x] P(x)\n!C()\nsort a\nD()");
  CHECK(parsed.places() == Strings{"E1007 1:3-3", "E1007 3:8-8", "E1007 4:4-4", "E1007 6:3-3"});
  CHECK(parsed.printed == "A().\nB().\n[x] P(x).\n!C().\nsort a\nD().\n");
}

TEST_CASE("recovery: an unclosed bracket costs its own formula only") {
  const Parsed parsed("HoldsAt(F(), 0\nHoldsAt(G(), 0).\nHoldsAt(H(, 0).\nP().\n");
  CHECK(parsed.places() == Strings{"E1005 1:14-14", "E1003 3:11-11"});
  CHECK(parsed.printed == "HoldsAt(G(),0).\nP().\n");
  CHECK(parsed.text().find("m.e:1:1-8: note: opened here") != std::string::npos);
}

TEST_CASE("recovery: a statement ends a broken formula") {
  const Parsed parsed("P(a,\nsort x\nQ(\nrange time 0 1\n");
  CHECK(parsed.printed == "sort x\nrange time 0 1\n");
  CHECK(parsed.codes() == Strings{"E1003", "E1003"});
}

TEST_CASE("recovery: runs of illegal characters are one error and leave the formula whole") {
  const Parsed parsed("P() & @@#$ Q().\n\xC3\xA4\xC3\xB6 R().\n\"S\"().\n");
  CHECK(parsed.places() == Strings{"E1001 1:7-10", "E1001 2:1-2", "E1001 3:1-1", "E1001 3:3-3"});
  CHECK(parsed.printed == "P() & Q().\nR().\nS().\n");
  CHECK(parsed.text().find("illegal character `\xC3\xA4`") != std::string::npos);
}

TEST_CASE("recovery: stray brackets and periods do not hide what follows") {
  const Parsed parsed(")\n.\n..\nP().\n]. Q().\n} R().\n");
  CHECK(parsed.printed == "P().\nQ().\n");
  CHECK(parsed.codes() == Strings{"E1003", "E1003", "E1003", "E1003", "E1003"});
}

TEST_CASE("parse_formula: locations are those of the text around it") {
  FrontEnd front;
  const std::string yaml = "constraints:\n  - \"HoldsAt(F(),time) & \"\n  - P() Q()\n";
  const auto file = front.files.add("scenario.yaml", yaml);
  const auto range = [&](std::string_view piece) {
    const auto begin = static_cast<std::uint32_t>(yaml.find(piece));
    return base::SourceRange{file, begin, begin + static_cast<std::uint32_t>(piece.size())};
  };
  CHECK_FALSE(compiler::parse_formula(range("HoldsAt(F(),time) & "), front.files, front.sink));
  CHECK_FALSE(compiler::parse_formula(range("P() Q()"), front.files, front.sink));
  CHECK(front.places() == Strings{"E1003 2:24-24", "E1004 3:9-9"});
  const auto good = compiler::parse_formula(range("HoldsAt(F(),time)"), front.files, front.sink);
  REQUIRE(good);
  CHECK(front.files.text(good->ast.source(good->ast[good->root])) == "HoldsAt(F(),time)");
}

TEST_CASE("parse_formula: several lines, a comment and a final period are fine") {
  FrontEnd front;
  const auto file = front.add("agent = James ; who\n & P()\n.\n");
  const auto parsed = compiler::parse_formula(file, front.files, front.sink);
  REQUIRE(parsed);
  CHECK(compiler::print_formula(parsed->ast, parsed->root) == "agent=James & P()");
  CHECK(front.text() == "");
}

TEST_CASE("parse_formula: an empty range is an error at its place") {
  FrontEnd front;
  const auto file = front.add("key: \n");
  CHECK_FALSE(compiler::parse_formula(base::SourceRange{file, 5, 5}, front.files, front.sink));
  CHECK(front.codes() == Strings{"E1003"});
}

}  // namespace
}  // namespace parallax::test
