// Formatting changes nothing but the layout, and nothing at all the second time.

#include "compiler/syntax/formatter.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "compiler/syntax/formula_layout.h"
#include "compiler/syntax/loader.h"
#include "tests/compiler/front_end.h"
#include "tests/support/peer_examples.h"
#include "tests/support/random.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

std::string formatted(const std::string& text) {
  FrontEnd front;
  const auto file = front.add(text);
  const auto result = compiler::format_text(file, front.files, front.sink);
  REQUIRE_MESSAGE(result.has_value(), front.text() << text);
  return *result;
}

std::size_t longest_line(const std::string& text) {
  std::istringstream in(text);
  std::string line;
  std::size_t longest = 0;
  while (std::getline(in, line)) longest = std::max(longest, line.size());
  return longest;
}

/// The comments of a text without syntax errors, in order: `;` has no other use.
Strings comments(const std::string& text) {
  Strings found;
  std::istringstream in(text);
  std::string line;
  while (std::getline(in, line)) {
    const auto at = line.find(';');
    if (at == std::string::npos) continue;
    const auto end = line.find_last_not_of(" \t\r\f\v");
    found.push_back(line.substr(at, end + 1 - at));
  }
  return found;
}

/// Everything that must be so for any text without syntax errors.
void check_properties(const std::string& text) {
  FrontEnd before, after;
  const auto old_file = before.add(text);
  const auto old_ast = compiler::parse_file(old_file, before.files, before.sink);
  if (before.sink.has_errors()) {
    CHECK_FALSE(compiler::format_text(old_file, before.files, before.sink));
    return;
  }
  const auto once = formatted(text);
  CAPTURE(text);
  CAPTURE(once);
  CHECK(formatted(once) == once);
  CHECK(comments(once) == comments(text));
  const auto new_file = after.add(once);
  const auto new_ast = compiler::parse_file(new_file, after.files, after.sink);
  CHECK_FALSE(after.sink.has_errors());
  CHECK(compiler::same_statements(old_ast, new_ast));
  // No line becomes one that the 2005 reasoner would misread.
  CHECK(after.sink.sorted().size() <= before.sink.sorted().size());
  CHECK((once.empty() || (once.back() == '\n' && !once.ends_with("\n\n"))));
  CHECK(once.find("\n\n\n") == std::string::npos);
  CHECK(once.find(" \n") == std::string::npos);
  CHECK(once.find('\r') == std::string::npos);
}

TEST_CASE("formatter: declarations and formulas get one spacing") {
  CHECK(formatted("sort   a ,b:  c\n  fluent F( a,b )\nrange  time 0   3\n") ==
        "sort a, b: c\nfluent F(a,b)\nrange time 0 3\n");
  CHECK(formatted("[ a , time ]HoldsAt( F(a) , time )&!P(a)->a = b|{ c }Q( c+1 ).") ==
        "[a,time] HoldsAt(F(a),time) & !P(a) -> a=b | {c} Q(c+1).\n");
  CHECK(formatted("L :P( ) .Q( ).") == "L: P().\nQ().\n");
  CHECK(formatted("((P()) & (Q())).\r\n") == "((P()) & (Q())).\n");
  CHECK(formatted("x = - 1 + -y * 2.") == "x=-1+-y*2.\n");
  CHECK(formatted("2<= count{ a,b :P(a)&Q( b )}->sum{a : W(a)+1: P(a)}=3.") ==
        "2<=count{a,b: P(a) & Q(b)} -> sum{a: W(a)+1: P(a)}=3.\n");
  CHECK(formatted("") == "");
  CHECK(formatted("\n\n") == "");
}

TEST_CASE("formatter: comments and groups stay") {
  CHECK(formatted("\n\n; head\r\n\n\n\nsort a ; one\n   ; two\n\n; three\nP().   ; four\n\n") ==
        "; head\n\nsort a ; one\n   ; two\n\n; three\nP().   ; four\n");
  CHECK(formatted("[a] P(a)&;why\n  ;more\nQ(a) ; last\n.\n; end") ==
        "[a] P(a) & ;why\n  ;more\n  Q(a) ; last\n  .\n; end\n");
  CHECK(formatted("; only a comment") == "; only a comment\n");
}

TEST_CASE("formatter: long formulas are broken at their connectives") {
  const std::string atom = "HoldsAt(VeryLongFluentName(agent1,object2),time)";
  CHECK(formatted("[agent1,object2,time] " + atom + " & " + atom + " -> " + atom + ".") ==
        "[agent1,object2,time]\n  " + atom + " &\n  " + atom + " ->\n    " + atom + ".\n");
  // A negation stays with its operand, and in front of a quantifier together with it.
  CHECK(formatted("[time] !" + atom + " & " + atom + " -> " + atom + ".") ==
        "[time]\n  !" + atom + " &\n  " + atom + " ->\n    " + atom + ".\n");
  CHECK(formatted("[time] !{agent1} " + atom + " & " + atom + ".") ==
        "[time] !{agent1}\n  " + atom + " &\n  " + atom + ".\n");
  CHECK(formatted(atom + " | " + atom + " & " + atom + ".") ==
        atom + " |\n  " + atom + " &\n    " + atom + ".\n");
  CHECK(formatted("count{agent1,object2: " + atom + " & " + atom + "}>=2.") ==
        "count{agent1,object2: " + atom + " &\n      " + atom + "}>=2.\n");
  CHECK(formatted("sum{agent1: W(agent1,2): " + atom + " | " + atom + "}>=2.") ==
        "sum{agent1: W(agent1,2): " + atom + " |\n    " + atom + "}>=2.\n");
  const auto nested = formatted("L: [time] (" + atom + " | " + atom + ") & {x} (" + atom + " | (" +
                                atom + " -> " + atom + ")).");
  CHECK(nested == "L: [time]\n  (" + atom + " |\n   " + atom + ") &\n  {x}\n    (" + atom +
                      " |\n     (" + atom + " ->\n        " + atom + ")).\n");
  CHECK(longest_line(nested) <= compiler::kLayoutWidth);
}

TEST_CASE("formatter: a text with a syntax error is refused") {
  FrontEnd front;
  const auto file = front.add("P() & .\nQ().\n");
  CHECK_FALSE(compiler::format_text(file, front.files, front.sink));
  CHECK(front.codes() == Strings{"E1003"});
}

TEST_CASE("formatter: variables that are spelt like keywords stay in the middle of lines") {
  const std::string atom =
      "HoldsAt(VeryLongFluentName(agent1,object2,object3,object4,object5),time)";
  const Strings texts = {"P() &\n(sort -> b) | sort=b & " + atom + " & " + atom + ".",
                         "P() & sort -> load.", "P() & " + atom + " & range.", "x\n & y."};
  for (const auto& text : texts) {
    check_properties(text);
  }
}

TEST_CASE("formatter: every model of the repository and every foundation") {
  int count = 0;
  for (const auto* folder : {"scenarios", "tests", "tools", "docs"}) {
    const auto root = fs::path(PARALLAX_SOURCE_DIR) / folder;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
      if (!entry.is_regular_file() || entry.path().extension() != ".e") continue;
      std::ostringstream text;
      text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
      check_properties(text.str());
      ++count;
    }
  }
  CHECK(count > 2);
  for (const auto& foundation : compiler::foundations()) {
    check_properties(std::string(foundation.text));
  }
}

TEST_CASE("formatter: the examples of the 2005 reasoner") {
  const auto folder = peer_examples();
  if (!folder) return;
  int count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(*folder / "examples")) {
    if (entry.path().extension() != ".e") continue;
    std::ostringstream text;
    text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    check_properties(text.str());
    ++count;
  }
  CHECK(count > 20);
}

/// A formula with random blanks, line breaks and comments between its tokens.
class TextGenerator {
 public:
  explicit TextGenerator(Random& random) : random_(random) {}

  std::string file() {
    static const Strings kStatements = {"sort a, b : integer",
                                        "range  time 0 7",
                                        "fluent F( a,b )",
                                        "a  C1,C2",
                                        "a! C3",
                                        "function Size (a) : b",
                                        "completion  L Happens",
                                        "mutex F,G",
                                        "load  x/y.e",
                                        "option encoding  3",
                                        "noninertial  F"};
    out_.clear();
    const auto count = random_.below(6);
    for (std::uint32_t i = 0; i <= count; ++i) {
      if (random_.below(3) == 0) {
        out_ += kStatements[random_.below(static_cast<std::uint32_t>(kStatements.size()))];
        out_ += random_.below(4) == 0 ? "  ; note\n" : "\n";
      } else {
        if (random_.below(4) == 0) out_ += "Label: ";
        quiet_ = random_.below(2) == 0;
        formula(1 + random_.below(40));
        out_ += ".";
        out_ += random_.below(3) == 0 ? " ; end\n" : "\n";
      }
      while (random_.below(3) == 0) out_ += random_.below(2) == 0 ? "\n" : "  ; between\n";
    }
    return out_;
  }

 private:
  /// Blanks that may hold a comment or a line break; nothing that starts a line is a bare word.
  void space() {
    const auto kind = random_.below(quiet_ ? 4 : 9);
    if (kind == 0) out_ += " ";
    if (kind == 1) out_ += "  ";
    if (kind == 4) out_ += "\n";
    if (kind == 5) out_ += " ; inside\n  ";
  }
  void formula(std::uint32_t size) {
    static const Strings kOps = {" & ", "|", "->", " <-> ", "&", " | ", "&", " -> "};
    if (size <= 1) return atom();
    switch (random_.below(7)) {
      case 0:
        out_ += "!";
        return group(size - 1);
      case 1:
        out_ += random_.below(2) == 0 ? "[a1, time]" : "{ b }";
        space();
        return formula(size - 1);
      case 2:
        return group(size - 1);
      default:
        group_or_formula(size / 2);
        out_ += kOps[random_.below(8)];
        space();
        group_or_formula(size - size / 2);
    }
  }
  void group_or_formula(std::uint32_t size) {
    if (random_.below(2) == 0) return group(size);
    formula(size);
  }
  void group(std::uint32_t size) {
    out_ += "(";
    space();
    formula(size);
    out_ += ")";
  }
  void atom() {
    static const Strings kAtoms = {
        "P()",
        "HoldsAt( Fluent(a1,b2), time)",
        "Happens(E(),time+1)",
        "(a1 = C1)",
        "(x < -y*2)",
        "Predicate(Long(Name(a)), Another(Name(b,c)), f(1 , 2 - x), 0.5)",
        "(time1 - time2 >= 3)"};
    out_ += kAtoms[random_.below(static_cast<std::uint32_t>(kAtoms.size()))];
  }

  Random& random_;
  std::string out_;
  bool quiet_ = true;
};

TEST_CASE("formatter: 3,000 generated texts") {
  Random random(77);
  for (int round = 0; round < 3'000; ++round) check_properties(TextGenerator(random).file());
}

TEST_CASE("formatter: deep and wide formulas are formatted without recursion and without bloat") {
  const std::size_t depth = 10'000;
  std::string chain = "A()", wide = "Fluent(1)";
  for (std::size_t i = 0; i < depth; ++i) {
    chain += " -> A()";
    wide += "&Fluent(" + std::to_string(i) + ")";
  }
  const Strings formulas = {std::string(depth, '(') + "A()" + std::string(depth, ')') + ".",
                            chain + ".", wide + ".", std::string(depth, '!') + "A().",
                            "[x] " + wide + "->" + wide + "."};
  for (const auto& text : formulas) {
    const auto once = formatted(text);
    CHECK(formatted(once) == once);
    CHECK(once.size() < 3 * text.size());
  }
}

}  // namespace
}  // namespace parallax::test
