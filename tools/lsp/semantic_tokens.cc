// Kinds of words, by which editors colour them: sorts, constants, fluents, events, predicates,
// functions, variables, keywords, numbers, comments, texts.
//
// Declared names come from the name map. The rest of a line is told by its characters, and whether
// a line of a model is a statement or formula text by the compiler's lexer: in a formula the name
// of a sort is a variable. Linear in the text.

#include "tools/lsp/semantic_tokens.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/lisp/lisp_token.h"
#include "compiler/plan/binding_text.h"
#include "compiler/syntax/lexer.h"
#include "tools/lsp/file_text.h"

namespace parallax::tools::lsp {
namespace {

enum class TokenType : std::uint8_t {
  kSort,
  kConstant,
  kFluent,
  kEvent,
  kFunction,
  kVariable,
  kKeyword,
  kNumber,
  kComment,
  kText,
};

// The protocol's words for them, which editors have colours for.
constexpr std::array<const char*, 10> kTypeNames = {"type",     "enumMember", "property", "event",
                                                    "function", "variable",   "keyword",  "number",
                                                    "comment",  "string"};

TokenType type_of(NameKind kind) {
  switch (kind) {
    case NameKind::kSort:
      return TokenType::kSort;
    case NameKind::kConstant:
      return TokenType::kConstant;
    case NameKind::kFluent:
      return TokenType::kFluent;
    case NameKind::kEvent:
    case NameKind::kDesignator:
      return TokenType::kEvent;
    case NameKind::kPredicate:
    case NameKind::kFunction:
    case NameKind::kPlanFunction:
      break;
  }
  return TokenType::kFunction;
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

class TokenReader {
 public:
  TokenReader(std::string_view text, const NameMap& names, const std::string& path)
      : text_(text), names_(names), words_(names.words(path)), path_(path) {}

  struct Token {
    std::size_t begin = 0, end = 0;
    TokenType type = TokenType::kComment;
  };

  /// Ascending, without overlap, each on one line.
  std::vector<Token> read() {
    if (is_plan(path_)) {
      read_plan();
    } else if (is_table(path_)) {
      read_table();
    } else {
      each_line(text_, [&](std::size_t begin, std::string_view line) {
        const auto code = without_comment(line, is_yaml(path_));
        read_line(begin, code);
        add(begin + code.size(), begin + line.size(), TokenType::kComment);
      });
    }
    return std::move(tokens_);
  }

 private:
  /// Adds a token, one for each of its lines.
  void add(std::size_t begin, std::size_t end, TokenType type) {
    while (begin < end) {
      const auto line = std::min(text_.find('\n', begin), end);
      auto last = line;
      while (last > begin && text_[last - 1] == '\r') --last;
      if (last > begin) tokens_.push_back({begin, last, type});
      begin = line + 1;
    }
  }

  /// The declared name at a word; words are asked for in their order.
  const DeclaredName* declared(std::size_t begin) {
    while (next_ < words_.size() && words_[next_].begin < begin) ++next_;
    if (next_ == words_.size() || words_[next_].begin != begin) return nullptr;
    return names_.find(words_[next_].key);
  }

  /// A line of a model or of YAML without its comment, at `begin`.
  void read_line(std::size_t begin, std::string_view line) {
    const auto start = std::min(line.find_first_not_of(" \t"), line.size());
    const bool in_model = is_model(path_);
    const bool is_statement =
        in_model && compiler::classify_line(line.substr(start)) == compiler::LineKind::kStatement;
    for (std::size_t i = start; i < line.size();) {
      if (!is_word(line[i])) {
        ++i;
        continue;
      }
      auto end = i;
      const bool is_number = is_digit(line[i]);
      while (end < line.size() &&
             (is_word(line[end]) || (is_number && line[end] == '.' && end + 1 < line.size() &&
                                     is_digit(line[end + 1])))) {
        ++end;
      }
      const auto word = line.substr(i, end - i);
      if (const auto* name = declared(begin + i)) {
        const bool is_variable = in_model && !is_statement && name->kind == NameKind::kSort;
        add(begin + i, begin + end, is_variable ? TokenType::kVariable : type_of(name->kind));
      } else if (is_number) {
        add(begin + i, begin + end, TokenType::kNumber);
      } else if (in_model) {
        add_undeclared(begin + i, word, is_statement, i == start);
      }
      i = end;
    }
  }

  /// A word of a model that no file of it declares: the language's own.
  void add_undeclared(std::size_t begin, std::string_view word, bool is_statement, bool is_first) {
    const auto end = begin + word.size();
    const bool is_lower = std::islower(static_cast<unsigned char>(word.front())) != 0;
    if ((is_statement && is_first) ||
        is_one_of(word, {"Happens", "HoldsAt", "ReleasedAt", "Initiates", "Terminates", "Releases",
                         "Trajectory", "AntiTrajectory"})) {
      add(begin, end, TokenType::kKeyword);
    } else if (is_lower) {
      add(begin, end, is_statement ? TokenType::kSort : TokenType::kVariable);
    }
  }

  void read_table() {
    // Comments are blanks in it; a separating `;` is, too.
    const auto cleaned = compiler::clean_binding(text_).text;
    for (std::size_t i = 0; i < text_.size();) {
      if (cleaned[i] != text_[i]) {
        const auto end = std::min(text_.find('\n', i), text_.size());
        const bool is_separator = i + 1 < end && cleaned[i + 1] == text_[i + 1] &&
                                  cleaned.find_first_not_of(' ', i) < end;
        if (is_separator) {
          ++i;
        } else {
          add(i, end, TokenType::kComment);
          i = end;
        }
        continue;
      }
      const auto variable = compiler::variable_length(text_.substr(i));
      if (variable > 0) {
        add(i, i + variable, TokenType::kVariable);
        i += variable;
        continue;
      }
      if (!is_word(text_[i])) {
        ++i;
        continue;
      }
      auto end = i;
      while (end < text_.size() &&
             (is_word(text_[end]) ||
              (text_[end] == '-' && end + 1 < text_.size() && is_word(text_[end + 1]))))
        ++end;
      const auto word = text_.substr(i, end - i);
      if (const auto* name = declared(i)) {
        add(i, std::min(end, words_[next_].end), type_of(name->kind));
      } else if (is_digit(word.front())) {
        add(i, end, TokenType::kNumber);
      } else if (is_one_of(word, {"motion", "action", "query", "goal", "object", "ok", "else", "on",
                                  "returns", "plan", "exists", "forall", "always", "failures"})) {
        add(i, end, TokenType::kKeyword);
      }
      i = end;
    }
  }

  void read_plan() {
    compiler::LispCursor cursor(text_);
    bool is_head = false;  // the first word of a list
    while (!cursor.at_end()) {
      const auto begin = cursor.position();
      const char c = cursor.peek();
      std::uint32_t comment = 0;
      if (c == ';' || (c == '#' && cursor.peek(1) == '|')) {
        // Comments and the blanks behind them, one line each.
        if (c == ';') {
          while (!cursor.at_end() && cursor.peek() != '\n') cursor.skip(1);
        } else if (!compiler::skip_blanks(cursor, comment)) {
          cursor.skip(text_.size());
        }
        auto end = cursor.position();
        while (end > begin && std::isspace(static_cast<unsigned char>(text_[end - 1])) != 0) --end;
        add(begin, end, TokenType::kComment);
      } else if (c == '"') {
        cursor.skip(1);
        while (!cursor.at_end() && cursor.peek() != '"') cursor.skip(cursor.peek() == '\\' ? 2 : 1);
        cursor.skip(1);
        add(begin, cursor.position(), TokenType::kText);
      } else if (compiler::is_lisp_delimiter(c)) {
        is_head = c == '(' || (is_head && c != ')');
        cursor.skip(1);
      } else {
        (void)compiler::scan_token(cursor);
        if (cursor.position() == begin) cursor.skip(1);
        add_plan_word(begin, cursor.position(), is_head);
        is_head = false;
      }
    }
  }

  void add_plan_word(std::size_t begin, std::size_t end, bool is_head) {
    const auto word = text_.substr(begin, end - begin);
    // The name may stand behind the prefix of a package.
    const auto colon = word.rfind(':');
    const auto place = colon == std::string_view::npos ? begin : begin + colon + 1;
    const bool is_signed = word.size() > 1 && (word.front() == '-' || word.front() == '+');
    if (const auto* name = declared(place)) {
      add(place, end, type_of(name->kind));
    } else if (word.front() == '?') {
      add(begin, end, TokenType::kVariable);
    } else if (is_digit(word[is_signed ? 1 : 0])) {
      add(begin, end, TokenType::kNumber);
    } else if (is_head && text_.substr(place, end - place).starts_with("def")) {
      add(begin, end, TokenType::kKeyword);
    }
  }

  std::string_view text_;
  const NameMap& names_;
  const std::vector<NameMap::Word>& words_;
  std::size_t next_ = 0;  // the first word that was not asked for
  const std::string& path_;
  std::vector<Token> tokens_;
};

}  // namespace

Json token_legend() { return kTypeNames; }

Json semantic_tokens(Documents& documents, const Json& params) {
  const auto path = documents.asked_path(params);
  const auto positions = documents.positions(path);
  Json data = Json::array();
  EditorPlace before;
  // Five numbers a token: lines and columns from the one before, length, type, no modifiers.
  for (const auto& token : TokenReader(documents.text(path), documents.names(path), path).read()) {
    const auto place = positions.place(token.begin);
    const auto end = positions.place(token.end);
    const auto lines = place.line - before.line;
    data.push_back(lines);
    data.push_back(lines == 0 ? place.column - before.column : place.column);
    data.push_back(end.column - place.column);
    data.push_back(static_cast<int>(token.type));
    data.push_back(0);
    before = place;
  }
  return {{"data", std::move(data)}};
}

}  // namespace parallax::tools::lsp
