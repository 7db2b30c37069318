#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "tools/suite/suite_runner.h"

namespace parallax::tools {
namespace {

TEST_CASE("equal texts have no difference") {
  CHECK(text_difference("", "") == "");
  CHECK(text_difference("a\nb\n", "a\nb\n") == "");
}

TEST_CASE("a changed line stands between its neighbours") {
  CHECK(text_difference("1\n2\n3\n4\n5\n6\n7\n", "1\n2\n3\nx\n5\n6\n7\n") ==
        "- expected, + found\n"
        "@ line 2\n"
        "  2\n"
        "  3\n"
        "- 4\n"
        "+ x\n"
        "  5\n"
        "  6\n");
}

TEST_CASE("differences far apart are shown apart, by the lines of the expected text") {
  CHECK(text_difference("a\n1\n2\n3\n4\n5\n6\nb\n", "1\n2\n3\n4\n5\n6\nb\nc\n") ==
        "- expected, + found\n"
        "@ line 1\n"
        "- a\n"
        "  1\n"
        "  2\n"
        "@ line 7\n"
        "  6\n"
        "  b\n"
        "+ c\n");
}

TEST_CASE("a missing line end is a difference") {
  CHECK(text_difference("a\n", "a") == "- expected, + found\n@ line 1\n- a\n+ a (no line end)\n");
}

TEST_CASE("a carriage return that only one of them has is seen") {
  CHECK(text_difference("a\r\n", "a\n") ==
        "- expected, + found\n@ line 1\n- a (carriage return)\n+ a\n");
}

TEST_CASE("a long difference is cut and counted") {
  std::string long_text;
  for (int i = 0; i < 100; ++i) long_text += std::to_string(i) + '\n';
  const auto text = text_difference("", long_text);
  CHECK(text.ends_with("+ 39\n... 60 more differing lines\n"));
}

TEST_CASE("texts too large for a table are compared as one stretch") {
  std::string a;
  std::string b;
  for (int i = 0; i < 3000; ++i) {
    a += "a" + std::to_string(i) + '\n';
    b += "b" + std::to_string(i) + '\n';
  }
  const auto text = text_difference(a, b);
  CHECK(text.find("- a0\n") != std::string::npos);
  CHECK(text.ends_with("... 5960 more differing lines\n"));
}

}  // namespace
}  // namespace parallax::tools
