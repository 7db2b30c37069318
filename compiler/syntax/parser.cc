#include "compiler/syntax/parser.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <unordered_set>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/texts.h"
#include "compiler/base/diagnostic.h"
#include "compiler/syntax/ast.h"
#include "compiler/syntax/foreign_spelling.h"
#include "compiler/syntax/formula_parser.h"
#include "compiler/syntax/lexer.h"

namespace parallax::compiler {
namespace {

/// Parses the statement on `line` (one line without its comment) into `ast`. `text` is the text of
/// the file. What is malformed is reported (E1010, E1011) and left out.
class StatementParser {
 public:
  /// `misspelt` collects the names of sorts that no sort can have.
  StatementParser(Ast& ast, std::string_view text, Word line,
                  std::unordered_set<std::string_view>& misspelt, base::DiagnosticSink& sink)
      : ast_(ast),
        text_(text.substr(0, line.end)),
        misspelt_(misspelt),
        sink_(sink),
        position_(line.begin) {
    trim(line.begin);
    statement_.source = {line.begin, end()};
  }

  void parse() {
    keyword_ = name();
    const auto word = ast_text(keyword_);
    if (word == "reified") {
      statement_.kind = StatementKind::kReifiedSort;
      const auto second = name();
      if (ast_text(second) != "sort") return malformed("`sort`", second);
      return sorts();
    }
    if (word == "sort") return sorts();
    if (word == "option") return option();
    if (word == "range") return range();
    if (word == "completion") return completion();
    if (word == "load") return rest(StatementKind::kLoad, "a path");
    if (word == "minimize") return rest(StatementKind::kMinimize, "`count` or `sum`");
    if (word == "xor") return names(StatementKind::kXor);
    if (word == "mutex") return names(StatementKind::kMutex);
    if (word == "noninertial") return names(StatementKind::kNoninertial);
    if (word == "manualrelease") return names(StatementKind::kManualRelease);
    if (word == "ignore") return names(StatementKind::kIgnore);
    declaration();
  }

 private:
  // --- characters ---

  std::uint32_t end() const { return static_cast<std::uint32_t>(text_.size()); }
  bool at_end() const { return position_ >= text_.size(); }
  std::string_view ast_text(Word word) const {
    return text_.substr(word.begin, word.end - word.begin);
  }

  void trim(std::uint32_t begin) {
    while (text_.size() > begin && is_blank(text_.back())) text_.remove_suffix(1);
  }
  void skip_blanks() {
    while (!at_end() && is_blank(text_[position_])) ++position_;
  }
  /// The next run of letters, digits and underscores; empty if there is none.
  Word name() {
    skip_blanks();
    const auto begin = position_;
    while (!at_end() && base::is_name_character(text_[position_])) ++position_;
    return {begin, position_};
  }
  /// The next run of anything but blanks.
  Word chunk() {
    skip_blanks();
    const auto begin = position_;
    while (!at_end() && !is_blank(text_[position_])) ++position_;
    return {begin, position_};
  }
  bool accept(char c) {
    skip_blanks();
    if (at_end() || text_[position_] != c) return false;
    ++position_;
    return true;
  }

  // --- errors ---

  void malformed(std::string_view expected) {
    skip_blanks();
    auto found = chunk();
    if (found.empty()) found = {position_, position_};
    malformed(expected, found);
  }
  void malformed(std::string_view expected, Word found) {
    const auto what =
        found.empty() ? std::string("the end of the line") : "`" + shortened(ast_text(found)) + "`";
    const auto place = found.empty() ? keyword_ : found;
    auto error = sink_.error(codes::kMalformedStatement, ast_.source(place),
                             shortened(ast_text(keyword_)), expected, what);
    const auto* foreign = foreign_sign(ast_text(found));
    const bool comment = foreign != nullptr && foreign->kind == ForeignSpelling::Kind::kComment;
    if (comment || ast_text(found).starts_with('%')) error.fix("begin the comment with `;`");
  }

  /// Nothing but a period, which is reported, may follow. True if that is so.
  bool at_line_end() {
    skip_blanks();
    if (at_end()) return true;
    if (text_[position_] == '.' && position_ + 1 == end()) {
      sink_.error(codes::kStatementPeriod, ast_.source(Word{position_, position_ + 1}))
          .fix("remove the period");
      return true;
    }
    return false;
  }
  void finish(std::string_view expected) {
    if (!at_line_end()) return malformed(expected);
    ast_.add(statement_);
  }

  // --- statements ---

  void option() {
    statement_.kind = StatementKind::kOption;
    statement_.name = chunk();
    if (statement_.name.empty()) return malformed("the name of an option");
    skip_blanks();
    statement_.value = {position_, end()};
    position_ = end();
    if (statement_.value.empty()) return malformed("a value");
    ast_.add(statement_);
  }

  /// Reads a statement whose text after the keyword is checked elsewhere.
  void rest(StatementKind kind, const char* wanted) {
    statement_.kind = kind;
    skip_blanks();
    statement_.value = {position_, end()};
    position_ = end();
    if (statement_.value.empty()) return malformed(wanted);
    ast_.add(statement_);
  }

  bool bound(std::int64_t& value) {
    skip_blanks();
    const auto begin = position_;
    if (!at_end() && text_[position_] == '-') ++position_;
    const auto digits = name();
    const Word all{begin, digits.end};
    const auto text = ast_text(all);
    const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc::result_out_of_range) {
      sink_.error(codes::kNumberTooLarge, ast_.source(all), shortened(text));
      return false;
    }
    if (error != std::errc() || last != text.data() + text.size() || digits.empty()) {
      if (all.empty()) {
        malformed("an integer");
      } else {
        malformed("an integer", all);
      }
      return false;
    }
    return true;
  }

  void range() {
    statement_.kind = StatementKind::kRange;
    statement_.sort = name();
    if (statement_.sort.empty()) return malformed("a sort");
    SortBounds bounds;
    if (!bound(bounds.lower) || !bound(bounds.upper)) return;
    statement_.first_item = ast_.add_bounds(bounds);
    finish("the end of the line");
  }

  void add_item(const Item& item) {
    const auto index = ast_.add_item(item);
    if (statement_.item_count == 0) statement_.first_item = index;
    ++statement_.item_count;
  }

  void sorts() {
    if (statement_.kind != StatementKind::kReifiedSort) statement_.kind = StatementKind::kSort;
    do {
      Item item;
      item.name = name();
      if (item.name.empty()) return malformed("the name of a sort");
      check_spelling(item.name);
      if (accept(':')) {
        item.parent = name();
        if (item.parent.empty()) return malformed("the sort above");
      }
      add_item(item);
    } while (accept(','));
    finish("`,`, `:` or the end of the line");
  }

  /// Reported once, here; the sort is declared all the same, so that its uses are understood.
  void check_spelling(Word sort) {
    const auto name = ast_text(sort);
    if (std::all_of(name.begin(), name.end(), base::is_lower)) return;
    misspelt_.insert(name);
    auto error = sink_.error(codes::kSortSpelling, ast_.source(sort), shortened(name));
    std::string right;
    for (const char c : name) {
      if (base::is_lower(base::to_lower(c))) right += base::to_lower(c);
    }
    if (!right.empty()) error.fix("write `" + shortened(right) + "` wherever the sort is named");
  }

  void names(StatementKind kind) {
    statement_.kind = kind;
    do {
      const auto word = name();
      // Old models end a list of ignored names with a comma.
      if (word.empty() && kind == StatementKind::kIgnore && statement_.item_count > 0) break;
      if (word.empty()) return malformed("a name");
      add_item({word, {}});
    } while (accept(','));
    finish("`,` or the end of the line");
  }

  void completion() {
    statement_.kind = StatementKind::kCompletion;
    statement_.name = name();
    if (statement_.name.empty()) return malformed("a label or a predicate");
    const auto second = name();
    if (!second.empty()) {
      statement_.label = statement_.name;
      statement_.name = second;
    }
    finish("the end of the line");
  }

  void declaration() {
    statement_.sort = keyword_;
    statement_.additional = accept('!');
    const auto first = name();
    if (first.empty()) return malformed("a name");
    if (accept('(')) return constructor(first);
    statement_.kind = StatementKind::kConstants;
    add_item({first, {}});
    while (accept(',')) {
      const auto word = name();
      if (word.empty()) return malformed("a name");
      add_item({word, {}});
    }
    finish("`,`, `(` or the end of the line");
  }

  void constructor(Word first) {
    statement_.kind = StatementKind::kConstructor;
    statement_.name = first;
    if (!accept(')')) {
      do {
        const auto sort = name();
        if (sort.empty()) return malformed("a sort");
        add_item({sort, {}});
      } while (accept(','));
      if (!accept(')')) return malformed("`,` or `)`");
    }
    if (accept(':')) {
      statement_.value = name();
      if (statement_.value.empty()) return malformed("the sort of the result");
    }
    finish("the end of the line");
  }

  Ast& ast_;
  std::string_view text_;  // of the file, cut at the end of the line
  std::unordered_set<std::string_view>& misspelt_;
  base::DiagnosticSink& sink_;
  std::uint32_t position_;
  Word keyword_;
  Statement statement_;
};

base::SourceRange whole(base::FileId file, const base::SourceFiles& files) {
  return {file, 0, static_cast<std::uint32_t>(files[file].text().size())};
}

Word word(const Token& token) { return {token.begin, token.end}; }

/// `[LABEL:] formula.`
void parse_labelled(Ast& ast, Lexer& lexer, FormulaParser& parser) {
  Statement statement;
  statement.kind = StatementKind::kFormula;
  const Token first = lexer.peek();
  const bool may_be_label = first.kind == TokenKind::kName || first.kind == TokenKind::kNumber;
  if (may_be_label && lexer.colon_follows()) {
    statement.label = word(first);
    lexer.next();
    lexer.next();
  }
  statement.first_node = NodeId(static_cast<std::uint32_t>(ast.node_count()));
  const auto root = parser.parse(FormulaParser::Period::kRequired);
  if (!root) return;
  statement.formula = *root;
  statement.source = {first.begin, ast[*root].end};
  ast.add(statement);
}

base::Result<ParsedFormula> parse_one(const base::SourceRange& range, std::string_view text,
                                      Lexer::Mode mode, base::DiagnosticSink& sink,
                                      FormulaParser::Words words = FormulaParser::Words::kPlain) {
  PARALLAX_REQUIRE(range.begin <= range.end && range.end <= text.size(),
                   "the formula lies inside its file");
  ParsedFormula parsed{Ast(range.file, text), NodeId()};
  const auto errors_before = sink.error_count();
  Lexer lexer(range, text, mode, sink);
  FormulaParser parser(parsed.ast, lexer, sink, words);
  const auto root = parser.parse(FormulaParser::Period::kOptional);
  if (root && lexer.peek().kind != TokenKind::kEnd) {
    return sink.error(codes::kTextAfterFormula, lexer.range(lexer.peek()),
                      lexer.describe(lexer.peek()));
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  parsed.root = *root;
  return parsed;
}

}  // namespace

Ast parse_file(base::FileId file, const base::SourceFiles& files, base::DiagnosticSink& sink) {
  const auto text = files[file].text();
  Ast ast(file, text);
  Lexer lexer(whole(file, files), text, Lexer::Mode::kFile, sink);
  FormulaParser parser(ast, lexer, sink);
  std::unordered_set<std::string_view> misspelt;  // sorts
  while (lexer.peek().kind != TokenKind::kEnd) {
    const Token& first = lexer.peek();
    const bool declares = first.kind == TokenKind::kName && first.first_on_line &&
                          misspelt.contains(lexer.text(first)) && lexer.name_follows();
    if (first.kind == TokenKind::kStatementLine || declares) {
      StatementParser(ast, text, {first.begin, lexer.statement_end()}, misspelt, sink).parse();
      lexer.skip_statement();
    } else if (first.kind == TokenKind::kOperator && first.op == Operator::kModulo) {
      lexer.skip_percent_comment();
    } else {
      parse_labelled(ast, lexer, parser);
    }
  }
  return ast;
}

base::Result<ParsedFormula> parse_formula(const base::SourceRange& range,
                                          const base::SourceFiles& files,
                                          base::DiagnosticSink& sink) {
  return parse_one(range, files[range.file].text(), Lexer::Mode::kFormulaOnly, sink);
}

base::Result<ParsedFormula> parse_formula(base::FileId file, const base::SourceFiles& files,
                                          base::DiagnosticSink& sink) {
  return parse_formula(whole(file, files), files, sink);
}

base::Result<ParsedFormula> parse_temporal_formula(const base::SourceRange& range,
                                                   const base::SourceFiles& files,
                                                   base::DiagnosticSink& sink) {
  return parse_one(range, files[range.file].text(), Lexer::Mode::kFormulaOnly, sink,
                   FormulaParser::Words::kTemporal);
}

base::Result<ParsedFormula> parse_binding_formula(const base::SourceRange& range,
                                                  std::string_view text,
                                                  base::DiagnosticSink& sink) {
  return parse_one(range, text, Lexer::Mode::kBinding, sink);
}

}  // namespace parallax::compiler
