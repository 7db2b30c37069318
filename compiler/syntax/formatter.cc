#include "compiler/syntax/formatter.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "compiler/base/codes/files.h"
#include "compiler/syntax/formula_layout.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/parser.h"
#include "compiler/syntax/printer.h"

namespace parallax::compiler {
namespace {

std::string_view without_end_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::size_t leading_blanks(std::string_view text) {
  std::size_t count = 0;
  while (count < text.size() && is_blank(text[count])) ++count;
  return count;
}

/// The lines of `text`; the last one is the text after the last line break.
std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  for (;;) {
    const auto end = text.find('\n');
    lines.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return lines;
    text.remove_prefix(end + 1);
  }
}

/// Could some line be read as a declaration? The first is read where the formula starts.
bool reads_as_formula(std::string_view text) {
  const auto lines = lines_of(text);
  return std::all_of(lines.begin(), lines.end(), [](std::string_view line) {
    return classify_line(line.substr(leading_blanks(line))) == LineKind::kFormulaText;
  });
}

class Formatter {
 public:
  Formatter(const Ast& ast, std::string_view text, Lexer& lexer)
      : ast_(ast), text_(text), lexer_(lexer) {}

  std::string run() {
    while (lexer_.peek().kind != TokenKind::kEnd) {
      gap(lexer_.peek().begin);
      if (lexer_.peek().kind == TokenKind::kStatementLine) {
        statement();
      } else {
        formula();
      }
    }
    gap(static_cast<std::uint32_t>(text_.size()));
    if (!out_.empty() && out_.back() != '\n') out_ += '\n';
    return std::move(out_);
  }

 private:
  /// Blanks and comments from the end of the last statement up to `end`.
  void gap(std::uint32_t end) {
    const auto lines = lines_of(text_.substr(position_, end - position_));
    const bool at_start = position_ == 0;
    bool blank_line = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto line = without_end_blanks(lines[i]);
      const auto blanks = leading_blanks(line);
      if (i == 0 && !at_start) {
        if (!line.empty()) trailing_comment(blanks, line.substr(blanks));
      } else if (!line.empty()) {
        own_line(blank_line);
        (out_ += std::string(blanks, ' ')) += line.substr(blanks);
        blank_line = false;
      } else if (i + 1 < lines.size()) {
        blank_line = true;
      }
    }
    position_ = end;
    if (end < text_.size()) own_line(blank_line);
  }

  void trailing_comment(std::size_t blanks, std::string_view comment) {
    out_.append(std::max<std::size_t>(blanks, 1), ' ');
    out_ += comment;
  }

  void own_line(bool blank_line_before) {
    if (out_.empty()) return;
    out_ += blank_line_before ? "\n\n" : "\n";
  }

  void statement() {
    const auto begin = lexer_.peek().begin;
    const auto end = lexer_.statement_end();
    const auto source = without_end_blanks(text_.substr(begin, end - begin));
    out_ += print_statement(ast_, ast_.statements()[next_statement_++]);
    position_ = begin + static_cast<std::uint32_t>(source.size());
    lexer_.skip_statement();
  }

  void formula() {
    std::vector<LayoutToken> tokens;
    bool comment_inside = false;
    do {
      const auto token = lexer_.next();
      if (!tokens.empty()) {
        const auto from = tokens.back().token.end;
        comment_inside =
            comment_inside || text_.substr(from, token.begin - from).find(';') != text_.npos;
      }
      tokens.push_back({token, lexer_.text(token), false, false, false, 0});
    } while (tokens.back().token.kind != TokenKind::kPeriod);
    ++next_statement_;
    prepare(tokens);
    auto laid_out = comment_inside ? with_comments(tokens) : lay_out(tokens);
    // A variable may be spelled like a keyword: then only the lines as they were are safe.
    out_ += reads_as_formula(laid_out) ? laid_out : as_it_was(tokens);
    position_ = tokens.back().token.end;
  }

  /// The lines of the source, each in the standard spacing.
  std::string with_comments(const std::vector<LayoutToken>& tokens) const {
    std::string out;
    std::size_t first = 0;  // of the line
    for (std::size_t i = 1; i <= tokens.size(); ++i) {
      const bool last = i == tokens.size();
      const auto from = tokens[i - 1].token.end;
      const auto between =
          last ? std::string_view() : text_.substr(from, tokens[i].token.begin - from);
      if (!last && between.find('\n') == std::string_view::npos) continue;
      out += on_one_line(tokens, first, i);
      first = i;
      if (last) break;
      append_comments(between, out);
      out += "\n  ";
    }
    return out;
  }

  static void append_comments(std::string_view between, std::string& out) {
    auto lines = lines_of(between);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto line = without_end_blanks(lines[i]);
      if (line.empty()) continue;
      const auto blanks = leading_blanks(line);
      if (i == 0) {
        out.append(std::max<std::size_t>(blanks, 1), ' ');
      } else {
        out += "\n  ";
      }
      out += line.substr(blanks);
    }
  }

  std::string as_it_was(const std::vector<LayoutToken>& tokens) const {
    const auto begin = tokens.front().token.begin;
    std::string out;
    for (const auto line : lines_of(text_.substr(begin, tokens.back().token.end - begin))) {
      if (!out.empty()) out += '\n';
      out += without_end_blanks(line);
    }
    return out;
  }

  const Ast& ast_;
  std::string_view text_;
  Lexer& lexer_;
  std::string out_;
  std::uint32_t position_ = 0;  // end of the text that has been written
  std::size_t next_statement_ = 0;
};

bool same_word(const Ast& a, Word x, const Ast& b, Word y) { return a.text(x) == b.text(y); }

bool same_items(const Ast& a, const Statement& x, const Ast& b, const Statement& y) {
  if (x.kind == StatementKind::kRange) {
    return a.bounds(x).lower == b.bounds(y).lower && a.bounds(x).upper == b.bounds(y).upper;
  }
  for (std::uint32_t i = 0; i < x.item_count; ++i) {
    const Item& left = a.items(x)[i];
    const Item& right = b.items(y)[i];
    if (!same_word(a, left.name, b, right.name)) return false;
    if (!same_word(a, left.parent, b, right.parent)) return false;
  }
  return true;
}

bool same_statement(const Ast& a, const Statement& x, const Ast& b, const Statement& y) {
  return x.kind == y.kind && x.additional == y.additional && x.item_count == y.item_count &&
         same_word(a, x.sort, b, y.sort) && same_word(a, x.name, b, y.name) &&
         same_word(a, x.value, b, y.value) && same_word(a, x.label, b, y.label) &&
         same_items(a, x, b, y) &&
         (x.kind != StatementKind::kFormula || same_tree(a, x.formula, b, y.formula));
}

}  // namespace

bool same_statements(const Ast& a, const Ast& b) {
  const auto& x = a.statements();
  const auto& y = b.statements();
  return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [&](const Statement& left, const Statement& right) {
                      return same_statement(a, left, b, right);
                    });
}

base::Result<std::string> format_text(base::FileId file, const base::SourceFiles& files,
                                      base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  const auto ast = parse_file(file, files, sink);
  if (sink.error_count() != errors_before) return sink.already_reported();
  const auto text = files[file].text();
  base::DiagnosticSink known;  // the parser has reported what the lexer says
  Lexer lexer({file, 0, static_cast<std::uint32_t>(text.size())}, text, Lexer::Mode::kFile, known);
  auto formatted = Formatter(ast, text, lexer).run();

  base::SourceFiles again;
  base::DiagnosticSink complaints;
  const auto copy = again.add(files[file].name(), formatted);
  const auto parsed = parse_file(copy, again, complaints);
  if (complaints.has_errors() || !same_statements(ast, parsed)) {
    return sink.error_about(codes::kInternal, files[file].name(),
                            "formatting would change what the text says");
  }
  return formatted;
}

}  // namespace parallax::compiler
