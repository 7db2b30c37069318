// The grammar for editors finds the same tokens as the lexer.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/base/codes/names.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/loader.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using compiler::TokenKind;
using nlohmann::json;

std::string content(const fs::path& path) {
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

const fs::path kFolder = fs::path(PARALLAX_SOURCE_DIR) / "tools" / "editor";

/// The part of TextMate grammars that ours uses: `match` rules with a name or captures, `include`
/// of the repository. The earliest match wins, among equals the first rule. Its regular expressions
/// mean the same in ECMAScript.
class Grammar {
 public:
  explicit Grammar(const json& grammar) { add(grammar, grammar["patterns"]); }

  /// The scope of every byte of the line; empty where there is none.
  std::vector<std::string> scopes(const std::string& line) const {
    std::vector<std::string> out(line.size());
    std::size_t at = 0;
    while (at < line.size()) {
      const Rule* best = nullptr;
      std::smatch found;
      for (const auto& rule : rules_) {
        std::smatch match;
        auto flags = std::regex_constants::match_default;
        if (at != 0) {
          flags = std::regex_constants::match_prev_avail | std::regex_constants::match_not_bol;
        }
        const auto begin = line.begin() + static_cast<std::ptrdiff_t>(at);
        if (!std::regex_search(begin, line.end(), match, rule.regex, flags)) continue;
        if (best != nullptr && match.position(0) >= found.position(0)) continue;
        best = &rule;
        found = match;
      }
      if (best == nullptr) break;
      for (const auto& [group, name] : best->names) {
        const auto begin = at + static_cast<std::size_t>(found.position(group));
        const auto length = static_cast<std::size_t>(found.length(group));
        for (std::size_t i = begin; i < begin + length; ++i) out[i] = name;
      }
      const auto end = static_cast<std::size_t>(found.position(0) + found.length(0));
      REQUIRE(end > 0);
      at += end;
    }
    return out;
  }

 private:
  struct Rule {
    std::regex regex;
    std::vector<std::pair<std::size_t, std::string>> names;  // group, scope
  };

  void add(const json& grammar, const json& patterns) {
    for (const auto& pattern : patterns) {
      if (pattern.contains("include")) {
        const auto name = pattern["include"].get<std::string>().substr(1);
        add(grammar, grammar["repository"].at(name)["patterns"]);
        continue;
      }
      Rule rule;
      rule.regex = std::regex(pattern["match"].get<std::string>());
      if (pattern.contains("name")) rule.names.emplace_back(0, pattern["name"]);
      if (pattern.contains("captures")) {
        for (const auto& [group, what] : pattern["captures"].items()) {
          rule.names.emplace_back(std::stoul(group), what["name"]);
        }
      }
      rules_.push_back(std::move(rule));
    }
  }

  std::vector<Rule> rules_;
};

/// The scope that a token of a formula should have: its beginning up to the last two parts.
std::string expected_scope(const compiler::Token& token, const std::string& text, char after,
                           bool label) {
  switch (token.kind) {
    case TokenKind::kName:
      if (label) return "entity.name.label.dec";
      if (after == '(') return "function.dec";  // our own or one of the event calculus
      return text[0] >= 'a' && text[0] <= 'z' ? "variable.other.dec" : "constant.other.dec";
    case TokenKind::kNumber:
      return label ? "entity.name.label.dec" : "constant.numeric.dec";
    case TokenKind::kOperator:
      return "keyword.operator.dec";
    case TokenKind::kOpenParen:
    case TokenKind::kCloseParen:
      return "punctuation.section.parens.dec";
    case TokenKind::kOpenBracket:
    case TokenKind::kCloseBracket:
    case TokenKind::kOpenBrace:
    case TokenKind::kCloseBrace:
      return "punctuation.section.quantifier.dec";
    case TokenKind::kComma:
    case TokenKind::kColon:
      return "punctuation.separator.dec";
    case TokenKind::kPeriod:
      return "punctuation.terminator.dec";
    case TokenKind::kStatementLine:
    case TokenKind::kEnd:
      break;
  }
  return "?";
}

/// The scopes of a whole text, by byte.
std::vector<std::string> scopes_of(const Grammar& grammar, const std::string& text) {
  std::vector<std::string> scopes;
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    const auto own = grammar.scopes(line);
    scopes.insert(scopes.end(), own.begin(), own.end());
    scopes.emplace_back();  // the line break
  }
  return scopes;
}

/// Comments first: from a `;` to the end of its line, and nothing else.
void check_comments(const std::string& text, const std::vector<std::string>& scopes) {
  bool inside = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    inside = text[i] != '\n' && (inside || text[i] == ';');
    const bool comment = scopes[i].starts_with("comment.");
    CHECK_MESSAGE(comment == inside, "byte " << i << " of " << text);
  }
}

/// The first word of a statement: a keyword or the name of a sort.
void check_statement(const std::string& line, const std::string& scope) {
  static const std::regex keyword(
      "^(option|range|sort|reified|xor|mutex|noninertial|manualrelease|ignore|completion|load)"
      "([ \t].*|$)");
  const bool is_keyword = std::regex_match(line, keyword);
  CHECK_MESSAGE(scope == (is_keyword ? "keyword.control.dec" : "storage.type.dec"), line);
}

int check_text(const Grammar& grammar, const std::string& text) {
  const auto scopes = scopes_of(grammar, text + "\n");
  check_comments(text, scopes);
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto file = files.add("m.e", text);
  compiler::Lexer lexer({file, 0, static_cast<std::uint32_t>(text.size())}, files[file].text(),
                        compiler::Lexer::Mode::kFile, sink);
  int tokens = 0;
  while (lexer.peek().kind != TokenKind::kEnd) {
    const auto token = lexer.peek();
    ++tokens;
    if (token.kind == TokenKind::kStatementLine) {
      check_statement(text.substr(token.begin, lexer.statement_end() - token.begin),
                      scopes[token.begin]);
      lexer.skip_statement();
      continue;
    }
    const bool word = token.kind == TokenKind::kName || token.kind == TokenKind::kNumber;
    // A label that does not start its line is beyond a grammar of lines.
    const bool label = word && lexer.colon_follows() && token.first_on_line;
    const bool hidden_label = word && lexer.colon_follows() && !token.first_on_line;
    const auto next = text.find_first_not_of(" \t", token.end);
    const auto spelled = text.substr(token.begin, token.end - token.begin);
    const auto expected =
        expected_scope(token, spelled, next == std::string::npos ? '\0' : text[next], label);
    for (auto i = token.begin; i < token.end && !hidden_label; ++i) {
      CHECK_MESSAGE(scopes[i].ends_with(expected), spelled << " at " << i << ": " << scopes[i]);
    }
    lexer.next();
  }
  return tokens;
}

TEST_CASE("the grammar reads the example as the lexer does") {
  const auto source = json::parse(content(kFolder / "dec.tmLanguage.json"));
  CHECK(source["scopeName"] == "source.dec");
  CHECK(source["fileTypes"] == json::array({"e"}));
  const Grammar grammar(source);
  const auto example = content(kFolder / "example.e");
  CHECK(check_text(grammar, example) > 150);

  // The example leaves nothing out.
  std::string all;
  for (const auto& scope : scopes_of(grammar, example)) all += scope + " ";
  for (const auto* scope :
       {"comment.line", "keyword.control", "storage.type", "storage.modifier", "entity.name.label",
        "support.function", "entity.name.function", "constant.other", "variable.other",
        "constant.numeric", "keyword.operator", "punctuation.terminator"}) {
    CHECK_MESSAGE(all.find(scope) != std::string::npos, scope);
  }
}

TEST_CASE("the grammar reads every model of the repository as the lexer does") {
  const Grammar grammar(json::parse(content(kFolder / "dec.tmLanguage.json")));
  for (const auto& foundation : compiler::foundations()) {
    check_text(grammar, std::string(foundation.text));
  }
  int count = 0;
  for (const auto& entry :
       fs::recursive_directory_iterator(fs::path(PARALLAX_SOURCE_DIR) / "scenarios")) {
    if (!entry.is_regular_file() || entry.path().extension() != ".e") continue;
    CAPTURE(entry.path().string());
    check_text(grammar, content(entry.path()));
    ++count;
  }
  CHECK(count > 2);
}

TEST_CASE("the problem matcher takes messages apart as they are printed") {
  const auto matcher = json::parse(content(kFolder / "problem_matcher.json"));
  const auto& pattern = matcher["pattern"];
  const std::regex regex(pattern["regexp"].get<std::string>());
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto file = files.add("folder/a model.e", "sort abc\nP()\nQ().\n");
  const auto check = [&](std::uint32_t begin, std::uint32_t end, const std::string& line,
                         const std::string& end_line, const std::string& end_column) {
    base::DiagnosticSink own;
    own.warning(codes::kUnusedSort, base::SourceRange{file, begin, end}, "abc");
    const auto text = base::to_text(own.sorted().front(), files, {});
    std::smatch match;
    const auto first = text.substr(0, text.find('\n'));
    REQUIRE_MESSAGE(std::regex_match(first, match, regex), first);
    const auto group = [&](const char* name) {
      return match[pattern[name].get<std::size_t>()].str();
    };
    CHECK(group("file") == "folder/a model.e");
    CHECK(group("line") == line);
    CHECK(group("column") != "");
    CHECK(group("endLine") == end_line);
    CHECK(group("endColumn") == end_column);
    CHECK(group("severity") == "warning");
    CHECK(group("code") == "W2104");
    CHECK(group("message") == "sort `abc` is not used");
  };
  check(5, 8, "1", "", "8");
  check(5, 6, "1", "", "");
  check(9, 16, "2", "3", "3");
}

}  // namespace
}  // namespace parallax::test
