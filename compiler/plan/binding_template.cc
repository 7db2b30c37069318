#include "compiler/plan/binding_template.h"

#include "compiler/base/diagnostic_codes.h"

namespace parallax::compiler {
namespace {

using base::DiagnosticCode;
using base::SourceRange;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// Splits one template; literal text is gathered until a variable comes.
class TemplateParser {
 public:
  TemplateParser(std::string_view text, SourceRange source, base::DiagnosticSink& sink)
      : text_(text), source_(source), sink_(sink) {}

  base::Result<Template> parse() {
    while (i_ < text_.size()) {
      const auto rest = text_.substr(i_);
      if (const auto length = variable_length(rest); length != 0) {
        add({TemplatePiece::Kind::kVariable, {}, std::string(rest.substr(0, length)), {}});
        i_ += length;
      } else if (is_word(rest.front())) {
        if (!parse_word()) return sink_.already_reported();
      } else {
        literal_ += text_[i_++];
      }
    }
    flush();
    return out_;
  }

 private:
  void flush() {
    if (literal_.empty()) return;
    out_.push_back({TemplatePiece::Kind::kText, literal_, {}, {}});
    literal_.clear();
  }
  void add(TemplatePiece piece) {
    flush();
    out_.push_back(std::move(piece));
  }
  void skip_blanks() {
    while (i_ < text_.size() && is_blank(text_[i_])) ++i_;
  }
  bool parse_word() {
    const auto begin = i_;
    while (i_ < text_.size() && is_word(text_[i_])) ++i_;
    const auto word = text_.substr(begin, i_ - begin);
    if (!is_mapping_function(word)) {
      literal_ += word;
      return true;
    }
    const auto behind = i_;
    skip_blanks();
    if (i_ == text_.size() || text_[i_] != '(') {
      // A bare `place` repeats the event's; which variable that is, is known to the caller.
      i_ = behind;
      add({TemplatePiece::Kind::kMapped, {}, {}, std::string(word)});
      return true;
    }
    ++i_;
    skip_blanks();
    const auto variable = text_.substr(i_, variable_length(text_.substr(i_)));
    i_ += variable.size();
    skip_blanks();
    if (variable.empty() || i_ == text_.size() || text_[i_] != ')') {
      const auto at = static_cast<std::uint32_t>(begin);
      const auto end = static_cast<std::uint32_t>(behind);
      sink_.error(DiagnosticCode::kBindingSyntax,
                  SourceRange{source_.file, source_.begin + at, source_.begin + end},
                  "one variable as the argument of a mapping function", "something else");
      return false;
    }
    ++i_;
    add({TemplatePiece::Kind::kMapped, {}, std::string(variable), std::string(word)});
    return true;
  }

  std::string_view text_;
  SourceRange source_;
  base::DiagnosticSink& sink_;
  std::size_t i_ = 0;
  std::string literal_;
  Template out_;
};

}  // namespace

bool is_mapping_function(std::string_view name) {
  return name == "region" || name == "place" || name == "gaze";
}

std::size_t variable_length(std::string_view text) {
  if (text.empty() || text.front() != '?') return 0;
  std::size_t i = 1;
  while (i < text.size()) {
    const bool hyphen = text[i] == '-' && i + 1 < text.size() && is_word(text[i + 1]);
    if (!is_word(text[i]) && !hyphen) break;
    ++i;
  }
  return i == 1 ? 0 : i;
}

base::Result<Template> parse_template(std::string_view text, SourceRange source,
                                      base::DiagnosticSink& sink) {
  return TemplateParser(text, source, sink).parse();
}

}  // namespace parallax::compiler
