#include "compiler/syntax/formula_layout.h"

#include <algorithm>

#include "compiler/syntax/precedence.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kStep = 2;            // of indentation
constexpr std::size_t kDeepestIndent = 40;  // columns
constexpr int kDeepestBreak = 40;           // levels; what lies deeper stays on its line
constexpr int kCommaBinding = 0;            // weaker than every operator
constexpr int kArrowBinding = binding(Operator::kImplies);
constexpr int kNothingToBreak = binding(Operator::kEqual);

bool opens(TokenKind kind) {
  return kind == TokenKind::kOpenParen || kind == TokenKind::kOpenBracket ||
         kind == TokenKind::kOpenBrace;
}
bool closes(TokenKind kind) {
  return kind == TokenKind::kCloseParen || kind == TokenKind::kCloseBracket ||
         kind == TokenKind::kCloseBrace;
}
/// Connectives have blanks around them, comparisons and arithmetic have none.
bool is_connective(const LayoutToken& token) {
  return token.token.kind == TokenKind::kOperator && !token.prefix &&
         binding(token.token.op) < kNothingToBreak;
}

bool wants_space(const LayoutToken& before, const LayoutToken& after) {
  if (is_connective(before) || is_connective(after)) return true;
  if (before.token.kind == TokenKind::kColon) return true;
  return before.quantifier && closes(before.token.kind);
}

class Layout {
 public:
  explicit Layout(const std::vector<LayoutToken>& tokens) : tokens_(tokens) {
    begin_.reserve(tokens.size() + 1);
    std::size_t column = 0;
    for (const auto& token : tokens) {
      if (token.space_before) ++column;
      begin_.push_back(column);
      column += token.text.size();
    }
    begin_.push_back(column);
  }

  std::string run() {
    std::size_t first = 0;
    if (tokens_.size() > 1 && tokens_[1].token.kind == TokenKind::kColon) {
      emit(0, 2);
      if (tokens_.size() > 2) text(" ");
      first = 2;
    }
    // The period stays with the last token.
    place({first, tokens_.size() - 1}, kStep, 1, 0);
    emit(tokens_.size() - 1, tokens_.size());
    return std::move(out_);
  }

 private:
  struct Range {
    std::size_t begin = 0;
    std::size_t end = 0;
  };

  void text(std::string_view piece) {
    out_ += piece;
    column_ += piece.size();
  }
  void emit(std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (i != begin && tokens_[i].space_before) text(" ");
      text(tokens_[i].text);
    }
  }
  void new_line(std::size_t indent) {
    indent = std::min(indent, kDeepestIndent);
    out_ += '\n';
    out_.append(indent, ' ');
    column_ = indent;
  }
  std::size_t width(Range range) const {
    const auto last = range.end - 1;
    return range.begin == range.end
               ? 0
               : begin_[last] + tokens_[last].text.size() - begin_[range.begin];
  }

  /// Writes `range` at the current column; further lines start at `indent`, and `tail` columns
  /// must stay free behind the last one. Recursion ends at kDeepestBreak.
  void place(Range range, std::size_t indent, std::size_t tail, int depth) {
    if (column_ + width(range) + tail <= kLayoutWidth || depth > kDeepestBreak) {
      return emit(range.begin, range.end);
    }
    if (place_prefix(range, indent, tail, depth)) return;
    const auto breaks = weakest(range);
    if (breaks.empty()) return place_brackets(range, indent, tail, depth);
    const bool arrow = strength(breaks.front()) == kArrowBinding;
    const bool comma = strength(breaks.front()) == kCommaBinding;
    std::size_t begin = range.begin;
    for (const auto at : breaks) {
      const std::size_t op_width = tokens_[at].text.size() + (comma ? 0 : 1);
      place({begin, at}, arrow || comma ? indent : indent + kStep, op_width, depth + 1);
      if (!comma) text(" ");
      emit(at, at + 1);
      begin = at + 1;
      // The consequence of a condition stands below it.
      const bool last = at == breaks.back();
      new_line(arrow && last ? indent + kStep : indent);
    }
    place({begin, range.end}, comma ? indent : indent + kStep, tail, depth + 1);
  }

  /// `[x] {y} f`: the quantifiers on a line of their own.
  bool place_prefix(Range range, std::size_t indent, std::size_t tail, int depth) {
    // A `!` in front of a quantifier belongs to it, one behind the last to the body.
    auto body = range.begin;
    for (auto i = range.begin; i < range.end;) {
      if (tokens_[i].prefix) {
        ++i;
      } else if (tokens_[i].quantifier) {
        body = i = tokens_[i].partner + 1;
      } else {
        break;
      }
    }
    if (body == range.begin || body >= range.end) return false;
    emit(range.begin, body);
    new_line(indent);
    place({body, range.end}, indent, tail, depth + 1);
    return true;
  }

  /// Breaks a range without connectives outside of brackets inside its outermost brackets.
  void place_brackets(Range range, std::size_t indent, std::size_t tail, int depth) {
    for (auto i = range.begin; i < range.end; ++i) {
      if (i != range.begin && tokens_[i].space_before) text(" ");
      const auto partner = tokens_[i].partner;
      const bool group = opens(tokens_[i].token.kind) && !tokens_[i].quantifier && partner > i + 1;
      const std::size_t rest = width({i, range.end}) + tail;
      emit(i, i + 1);
      if (!group || column_ + rest <= kLayoutWidth) continue;
      const auto inner = column_ <= kDeepestIndent ? column_ : indent + kStep;
      const auto body = i + 1 + emit_variables({i + 1, partner});
      place({body, partner}, inner, width({partner, range.end}) + tail, depth + 1);
      i = partner - 1;
    }
  }

  /// Writes what stands before the body of an aggregate, up to its last colon; how many tokens.
  std::size_t emit_variables(Range range) {
    auto end = range.begin;
    for (auto i = range.begin; i < range.end; ++i) {
      if (opens(tokens_[i].token.kind)) i = tokens_[i].partner;
      if (tokens_[i].token.kind == TokenKind::kColon) end = i + 1;
    }
    emit(range.begin, end);
    if (end != range.begin) text(" ");
    return end - range.begin;
  }

  int strength(std::size_t at) const {
    const auto& token = tokens_[at];
    if (token.token.kind == TokenKind::kComma) return kCommaBinding;
    return is_connective(token) ? binding(token.token.op) : kNothingToBreak;
  }

  /// The weakest connectives of the range outside all brackets, or its commas. A quantifier reaches
  /// to the end, so connectives after it do not count.
  std::vector<std::size_t> weakest(Range range) const {
    std::vector<std::size_t> found;
    int best = kNothingToBreak;
    for (auto i = range.begin; i < range.end; ++i) {
      // A comma ends the reach of a quantifier: look for the next one outside brackets.
      if (tokens_[i].quantifier) {
        i = tokens_[i].partner;
        while (i + 1 < range.end && tokens_[i + 1].token.kind != TokenKind::kComma) {
          ++i;
          if (opens(tokens_[i].token.kind)) i = tokens_[i].partner;
        }
        continue;
      }
      if (opens(tokens_[i].token.kind)) {
        i = tokens_[i].partner;
        continue;
      }
      const int level = strength(i);
      if (level >= kNothingToBreak || level > best) continue;
      if (level < best) found.clear();
      best = level;
      found.push_back(i);
    }
    return found;
  }

  const std::vector<LayoutToken>& tokens_;
  std::vector<std::size_t> begin_;  // by token: its column if all stand on one line
  std::string out_;
  std::size_t column_ = 0;
};

}  // namespace

void prepare(std::vector<LayoutToken>& tokens) {
  std::vector<std::uint32_t> open;
  bool wants_operand = true;
  for (std::uint32_t i = 0; i < tokens.size(); ++i) {
    auto& token = tokens[i];
    const auto kind = token.token.kind;
    if (opens(kind)) {
      // `count{` is no quantifier: its bracket ends it.
      token.quantifier = kind != TokenKind::kOpenParen && wants_operand;
      open.push_back(i);
    } else if (closes(kind) && !open.empty()) {
      token.partner = open.back();
      token.quantifier = tokens[open.back()].quantifier;
      tokens[open.back()].partner = i;
      open.pop_back();
    }
    token.prefix = kind == TokenKind::kOperator && wants_operand;
    wants_operand = kind == TokenKind::kOperator || kind == TokenKind::kComma ||
                    kind == TokenKind::kColon || opens(kind) || (closes(kind) && token.quantifier);
    token.space_before = i != 0 && wants_space(tokens[i - 1], token);
  }
}

std::string lay_out(const std::vector<LayoutToken>& tokens) { return Layout(tokens).run(); }

std::string on_one_line(const std::vector<LayoutToken>& tokens, std::size_t begin,
                        std::size_t end) {
  std::string out;
  for (std::size_t i = begin; i < end; ++i) {
    if (i != begin && tokens[i].space_before) out += ' ';
    out += tokens[i].text;
  }
  return out;
}

}  // namespace parallax::compiler
