#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace parallax::test {

/// A plan's text as nested lists: enough of Lisp for the plans of the tests. Shares nothing with
/// the reader that it is compared with.
struct Datum {
  enum class Kind { kSymbol, kNumber, kString, kList };
  Kind kind = Kind::kList;
  std::string text;  // symbols without package and colon, in lower case
  bool keyword = false;
  double number = 0.0;
  std::vector<Datum> items;

  bool is(std::string_view symbol) const { return kind == Kind::kSymbol && text == symbol; }
  bool is_list() const { return kind == Kind::kList; }
  /// The symbol at the head of a list; empty for anything else.
  std::string head() const {
    return is_list() && !items.empty() && items[0].kind == Kind::kSymbol ? items[0].text : "";
  }
};

/// The top-level data of a text. Quotes become (quote x), #'f (function f).
std::vector<Datum> read_data(std::string_view text);

/// One line.
std::string print(const Datum& datum);

}  // namespace parallax::test
