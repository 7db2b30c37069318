// The output gate: text that reaches terminals, CI systems and spreadsheets is harmless, whatever
// it holds.

#include "compiler/base/shown_text.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "compiler/base/markdown.h"
#include "compiler/base/utf8.h"

namespace parallax::base {
namespace {

/// Fragments of hostile texts, and of harmless ones beside them.
const std::vector<std::string>& fragments() {
  static const std::vector<std::string> all = {"\x1b[31m",
                                               "\x1b[0m",
                                               "\x1b]0;t\x07",
                                               "\xC2\x9B",
                                               "\x9B",
                                               "\xC2\x85",
                                               "\x7F",
                                               "\r",
                                               "\r\n",
                                               "\n",
                                               "\t",
                                               " ",
                                               "::",
                                               "::error::x",
                                               "##[error]",
                                               "##vso[task]",
                                               "###[x]",
                                               "\xE2\x80\xAE",
                                               "\xE2\x80\xA8",
                                               "\xE2\x81\xA6",
                                               "=1+1",
                                               "@a",
                                               "-",
                                               "+",
                                               "name",
                                               "\xC3\xA9",
                                               "\xC2\xA0",
                                               "#",
                                               ":",
                                               "\xEF\xBB\xBF",
                                               std::string(1, '\0')};
  return all;
}

std::string drawn(std::mt19937& random) {
  std::string text;
  for (auto n = random() % 8; n > 0; --n) text += fragments()[random() % fragments().size()];
  return text;
}

/// Does anything in it steer what shows it, but line ends and tabs?
bool steers(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto point = front_code_point(std::string_view(text).substr(i));
    if (!point.valid) return true;
    const bool layout = text[i] == '\n' || text[i] == '\t' ||
                        (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n');
    if (!layout && steers_display(point.value)) return true;
    i += point.length;
  }
  return false;
}

/// Written anew from what the runners of CI systems do with a line: leading blanks do not count.
bool has_command(const std::string& text) {
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const auto end = std::min(text.find('\n', begin), text.size());
    auto line = text.substr(begin, end - begin);
    for (const char* sign : {"##[", "##vso[", "##teamcity["}) {
      if (line.find(sign) != std::string::npos) return true;
    }
    while (!line.empty()) {
      if (line[0] == ' ' || line[0] == '\t') {
        line.erase(0, 1);
      } else if (line.starts_with("\xC2\xA0")) {
        line.erase(0, 2);
      } else {
        break;
      }
    }
    if (line.starts_with("::")) return true;
    begin = end + 1;
  }
  return false;
}

TEST_CASE("each escape is that of JSON, and harmless characters stay") {
  CHECK(shown_lines("a\x1b[31m\n\tb\r\nc\rd") == "a\\u001b[31m\n\tb\r\nc\\u000dd");
  CHECK(shown_lines("\xC2\x9B\x9B\xE2\x80\xAE") == "\\u009b\\x9b\\u202e");
  CHECK(shown_lines("gr\xC3\xBC\xC3\x9F \xF0\x9F\x8E\x88 # a::b") ==
        "gr\xC3\xBC\xC3\x9F \xF0\x9F\x8E\x88 # a::b");
  CHECK(printable("a\nb\tc\xC2\x85") == "a\\u000ab\\u0009c\\u0085");
}

TEST_CASE("the first sign of a command of a CI system is escaped, unless it is meant") {
  CHECK(shown_lines("::error::x") == "\\u003a:error::x");
  CHECK(shown_lines("a\n \t::x") == "a\n \t\\u003a:x");
  CHECK(shown_lines("a ::x") == "a ::x");
  CHECK(shown_lines("a ##vso[x] ##[y] ## [z] ##") == "a #\\u0023vso[x] #\\u0023[y] ## [z] ##");
  CHECK(shown_lines("::error::\x1b", {.commands = true}) == "::error::\\u001b");
  CHECK(shown_markup("::before { }") == "::before { }");
}

TEST_CASE("only the program's own colours stay, and only where colours are on") {
  CHECK(shown_lines("\x1b[1;31mred\x1b[0m") == "\\u001b[1;31mred\\u001b[0m");
  CHECK(shown_lines("\x1b[1;31mred\x1b[0m\x1b[2J", {.colors = true}) ==
        "\x1b[1;31mred\x1b[0m\\u001b[2J");
  CHECK(shown_lines("\x1b[0m::x", {.colors = true}) == "\x1b[0m\\u003a:x");
}

TEST_CASE(
    "whatever the text: nothing steers, no line is a command, a second pass changes nothing") {
  std::mt19937 random(7);
  for (int i = 0; i < 20'000; ++i) {
    const auto text = drawn(random);
    CAPTURE(text);
    const auto lines = shown_lines(text);
    REQUIRE_FALSE(steers(lines));
    REQUIRE_FALSE(has_command(lines));
    REQUIRE(shown_lines(lines) == lines);
    REQUIRE_FALSE(steers(shown_markup(text)));
    const auto line = printable(text);
    REQUIRE_FALSE(steers(line));
    REQUIRE(line.find_first_of("\n\t\r") == std::string::npos);
    REQUIRE_FALSE(steers(markdown_block(text)));
    REQUIRE(markdown_text(text).find('\n') == std::string::npos);
    REQUIRE_FALSE(steers(markdown_text(text)));
  }
}

TEST_CASE("in JSON the gate changes no value") {
  std::mt19937 random(8);
  for (int i = 0; i < 5'000; ++i) {
    const auto text = with_invalid_utf8_replaced(drawn(random));
    const nlohmann::json document = {{"a", text}, {text, 1}};
    REQUIRE(nlohmann::json::parse(shown_lines(document.dump(1))) == document);
  }
}

TEST_CASE("a cell of a spreadsheet is no formula unless it is a number") {
  CHECK(csv_cell("F()") == "F()");
  CHECK(csv_cell("At(a,b)") == "\"At(a,b)\"");
  CHECK(csv_cell("a\"b") == "\"a\"\"b\"");
  CHECK(csv_cell("a\nb") == "a\\u000ab");
  CHECK(csv_cell("") == "");
  for (const char* number : {"-1", "+2.5", "-0.5e-3", "-.5", "-inf", "-nan", "7", "1e300"}) {
    CHECK(csv_cell(number) == number);
  }
  CHECK(csv_cell("=1+1") == "'=1+1");
  CHECK(csv_cell("=1+1, b") == "\"'=1+1, b\"");
  CHECK(csv_cell("@SUM(A1)") == "'@SUM(A1)");
  CHECK(csv_cell("-1+cmd|' /C calc'!A0") == "'-1+cmd|' /C calc'!A0");
  CHECK(csv_cell("-") == "'-");
  CHECK(csv_cell("-e5") == "'-e5");
  CHECK(csv_cell("-nan(1)") == "'-nan(1)");
  CHECK(csv_cell("\xEF\xBC\x9D"
                 "1") ==
        "'\xEF\xBC\x9D"
        "1");  // a wide equals sign
  std::mt19937 random(9);
  for (int i = 0; i < 20'000; ++i) {
    auto cell = csv_cell(drawn(random));
    if (cell.starts_with('"')) cell.erase(0, 1);
    REQUIRE_FALSE(steers(cell));
    REQUIRE(
        (cell.empty() || cell == "-" || std::string("=+-@\t").find(cell[0]) == std::string::npos));
  }
}

}  // namespace
}  // namespace parallax::base
