// Lines that are statements, lines that are not, and malformed ones.

#include <doctest/doctest.h>

#include "compiler/syntax/lexer.h"
#include "compiler/syntax/printer.h"
#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

using compiler::LineKind;
using compiler::StatementKind;

struct ParsedStatements : FrontEnd {
  compiler::Ast ast;
  explicit ParsedStatements(std::string text)
      : ast(compiler::parse_file(add(std::move(text)), files, sink)) {}
  /// The statements as the printer writes them.
  std::string printed() const { return compiler::print_file(ast); }
};

TEST_CASE("every statement of the language is read and printed") {
  const std::string text =
      "option encoding 3\n"
      "load foundations/Root.e\n"
      "sort agent\n"
      "sort a: b, c, d: e\n"
      "reified sort belief\n"
      "reified sort x: fluent\n"
      "agent James, Jessie\n"
      "agent! Cat\n"
      "fluent On(object,surface)\n"
      "event Load()\n"
      "function TVOf(switch): tv\n"
      "range time 0 10\n"
      "range value -5 -1\n"
      "completion Happens\n"
      "completion Delta Happens\n"
      "noninertial F, G\n"
      "manualrelease F\n"
      "mutex A, B, C\n"
      "xor A, B\n"
      "ignore N1, N2\n"
      "minimize sum Price(item): Happens(Buy(item),time), count Happens(Go(),time)\n"
      "Delta: P(A).\n"
      "7: P(A).\n"
      "[x] P(x) -> Q(x).\n";
  const ParsedStatements parsed(text);
  CHECK(parsed.text() == "");
  CHECK(parsed.printed() == text);
}

TEST_CASE("blanks, indentation, comments, CRLF and a missing final newline change nothing") {
  const ParsedStatements parsed(
      "  sort   a:b ,c ; a comment: sort d\r\n\tagent\tJames,Jessie\r\n"
      "; whole line\r\n\r\n   [x]\r\n  P(x) ; Q(x)\r\n  & R(x). S().\r\nrange time 0 3");
  CHECK(parsed.text() == "");
  CHECK(parsed.printed() ==
        "sort a: b, c\nagent James, Jessie\n[x] P(x) & R(x).\nS().\nrange time 0 3\n");
}

TEST_CASE("statements know exactly where they stand") {
  const ParsedStatements parsed(
      "sort agent\n  agent James , Jessie ; friends\nDelta: P(James) &\n Q().\n");
  const auto& statements = parsed.ast.statements();
  REQUIRE(statements.size() == 3);
  CHECK(parsed.files.text(parsed.ast.source(statements[1].source)) == "agent James , Jessie");
  CHECK(parsed.files.text(parsed.ast.source(parsed.ast.items(statements[1])[1].name)) == "Jessie");
  CHECK(parsed.files.text(parsed.ast.source(statements[2].source)) == "Delta: P(James) &\n Q()");
  CHECK(parsed.ast.text(statements[2].label) == "Delta");
  const auto& root = parsed.ast[statements[2].formula];
  CHECK(parsed.files.text(parsed.ast.source(root)) == "P(James) &\n Q()");
}

TEST_CASE("a lower-case word before a name is a declaration, before anything else formula text") {
  CHECK(compiler::classify_line("agent James\n") == LineKind::kStatement);
  CHECK(compiler::classify_line("agent! James") == LineKind::kStatement);
  CHECK(compiler::classify_line("agent = James ->") == LineKind::kFormulaTextOnlyHere);
  CHECK(compiler::classify_line("agent != James ->") == LineKind::kFormulaTextOnlyHere);
  CHECK(compiler::classify_line("agent !F()") == LineKind::kFormulaTextOnlyHere);
  CHECK(compiler::classify_line("time < 3.") == LineKind::kFormulaTextOnlyHere);
  CHECK(compiler::classify_line("agent1 = James") == LineKind::kFormulaText);
  CHECK(compiler::classify_line("agent=James") == LineKind::kFormulaText);
  CHECK(compiler::classify_line("time\n)") == LineKind::kFormulaText);
  CHECK(compiler::classify_line("time ; comment") == LineKind::kFormulaText);
  CHECK(compiler::classify_line("HoldsAt (F(),0).") == LineKind::kFormulaText);
  CHECK(compiler::classify_line("sort a") == LineKind::kStatement);
  CHECK(compiler::classify_line("sort") == LineKind::kStatement);
  CHECK(compiler::classify_line("sorting") == LineKind::kFormulaText);
  CHECK(compiler::classify_line("load ../x.e") == LineKind::kStatement);
  CHECK(compiler::classify_line("delta : P()") == LineKind::kFormulaTextOnlyHere);
}

TEST_CASE("formula text that starts with a lower-case word stays formula text, with a warning") {
  const ParsedStatements parsed("[agent,time]\nagent = James ->\nHappens(Wake(agent), time).\n");
  CHECK(parsed.places() == Strings{"W1101 2:1-5"});
  REQUIRE(parsed.ast.statements().size() == 1);
  CHECK(parsed.printed() == "[agent,time] agent=James -> Happens(Wake(agent),time).\n");
}

TEST_CASE("a declaration inside an unfinished formula ends it with an error and still counts") {
  const ParsedStatements parsed("HoldsAt(F(), 0) &\nagent James\nP().\n");
  CHECK(parsed.places() == Strings{"E1003 1:17-17"});
  CHECK(parsed.printed() == "agent James\nP().\n");
}

struct Malformed {
  const char* text;
  const char* place;
};

TEST_CASE("malformed statements are reported where they go wrong") {
  const std::vector<Malformed> cases = {
      {"option debug", "E1010 1:1-6"},
      {"load", "E1010 1:1-4"},
      {"range time 0", "E1010 1:1-5"},
      {"range time zero 1", "E1010 1:12-15"},
      {"range time 0 1 2", "E1010 1:16-16"},
      {"range time 0 99999999999999999999", "E1002 1:14-33"},
      {"range time 0 1.", "E1011 1:15-15"},
      {"sort agent.", "E1011 1:11-11"},
      {"sort a b", "E1010 1:8-8"},
      {"sort a:", "E1010 1:1-4"},
      {"sort a,,b", "E1010 1:8-9"},
      {"reified a", "E1010 1:9-9"},
      {"agent James Jessie", "E1010 1:13-18"},
      {"agent James,", "E1010 1:1-5"},
      {"fluent On(a", "E1010 1:1-6"},
      {"fluent On(a,)", "E1010 1:13-13"},
      {"fluent On(a) b", "E1010 1:14-14"},
      {"function F(a):", "E1010 1:1-8"},
      {"completion", "E1010 1:1-10"},
      {"completion A B C", "E1010 1:16-16"},
      {"minimize", "E1010 1:1-8"},
      {"mutex A B", "E1010 1:9-9"},
      {"xor", "E1010 1:1-3"},
      {"ignore ,", "E1010 1:8-8"},
  };
  for (const auto& c : cases) {
    CAPTURE(c.text);
    const ParsedStatements parsed(c.text);
    CHECK(parsed.places() == Strings{c.place});
  }
}

TEST_CASE("a period after a statement is reported once and the statement still counts") {
  const ParsedStatements parsed("sort agent.\nagent James.\n");
  CHECK(parsed.codes() == Strings{"E1011", "E1011"});
  CHECK(parsed.printed() == "sort agent\nagent James\n");
}

}  // namespace
}  // namespace parallax::test
