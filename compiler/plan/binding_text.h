#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/ascii.h"
#include "compiler/base/diagnostic.h"

namespace parallax::compiler {

/// The text of a binding file, cut into entries.
struct BindingText {
  std::string text;                  // as long as the file; comments and separators are blanks
  std::vector<std::size_t> entries;  // where entries start
};

/// An entry starts with `motion`, `action`, `query`, `goal` or `object` at the start of a line or
/// behind a separating `;`.
BindingText clean_binding(std::string_view file);

/// Length of a parameter `?x` at the start of `text`; 0 if there is none.
std::size_t variable_length(std::string_view text);

/// Reads the words of one entry after the other. Anything unexpected is E4001.
class BindingCursor {
 public:
  BindingCursor(std::string_view file_text, base::FileId file, base::DiagnosticSink& sink)
      : file_(file), sink_(sink), cleaned_(clean_binding(file_text)) {}

  const std::string& text() const { return cleaned_.text; }
  std::size_t entries() const { return cleaned_.entries.size(); }
  /// Goes to an entry; `kPreamble` is the text before the first one.
  static constexpr std::size_t kPreamble = static_cast<std::size_t>(-1);
  void enter(std::size_t entry);

  std::size_t position() const { return i_; }
  bool at_end() const { return i_ == end_; }
  char peek() const { return text()[i_]; }
  void advance(std::size_t count = 1) { i_ += count; }
  /// The rest of the entry.
  std::string_view rest() const { return std::string_view(text()).substr(i_, end_ - i_); }
  base::SourceRange range(std::size_t begin, std::size_t end) const {
    return {file_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
  }
  void skip_blanks() {
    while (i_ < end_ && base::is_space(peek())) ++i_;
  }
  std::string_view peek_name() const;
  bool take(std::string_view literal);
  bool take_word(std::string_view word);
  /// The name of something; false: reported.
  bool name(std::string_view what, std::string& out);
  /// A name, perhaps behind the prefix of a package.
  bool symbol(std::string_view what, std::string& package, std::string& out);
  /// `going | driving`: at least one, without their packages.
  bool types(std::vector<std::string>& out);
  bool variable(std::string& out);
  /// (?a ?b), with or without commas; nothing at all is an empty list.
  bool variables(std::vector<std::string>& out);
  /// Reports that `what` does not stand here; false.
  bool expected(std::string_view what);
  bool failed() const { return failed_; }

 private:
  base::FileId file_;
  base::DiagnosticSink& sink_;
  BindingText cleaned_;
  std::size_t i_ = 0;
  std::size_t end_ = 0;  // of the entry
  bool failed_ = false;
};

}  // namespace parallax::compiler
