#pragma once

#include <string>
#include <string_view>

namespace parallax::tools {

/// A page in the language of `man`, written from top to bottom.
class Roff {
 public:
  Roff(const std::string& title, const std::string& date, const std::string& source);

  void section(std::string_view name);
  void subsection(std::string_view name);
  /// Running text, filled to the width of the reader.
  void text(std::string_view words);
  /// Lines as they are, indented.
  void block(std::string_view lines);
  /// Running text and, where lines begin with blanks, blocks of them.
  void mixed(std::string_view lines);
  /// A name that stands out, and what it is. `value` follows the name, as something to be replaced.
  void entry(std::string_view name, std::string_view value, std::string_view words);
  /// "name - words", as indexes of manuals want it.
  void title_line(std::string_view name, std::string_view words);
  /// A command line: bold words, then others.
  void synopsis(std::string_view command, std::string_view arguments);

  const std::string& page() const { return page_; }

 private:
  void line(std::string_view text);
  void new_paragraph();

  std::string page_;
  bool fresh_ = true;  // just below a heading, where no paragraph may begin
};

}  // namespace parallax::tools
