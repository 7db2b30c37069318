#include "compiler/base/xml_text.h"

#include <doctest/doctest.h>

#include <string>

namespace parallax::base {
namespace {

TEST_CASE("markup and line ends become entities") {
  CHECK(xml_escaped("a<b> & \"c\" 'd'") == "a&lt;b&gt; &amp; &quot;c&quot; &apos;d&apos;");
  CHECK(xml_escaped("a\tb\nc\rd") == "a&#9;b&#10;c&#13;d");
  CHECK(xml_escaped("]]>") == "]]&gt;");
}

TEST_CASE("what XML cannot hold is shown as bytes") {
  CHECK(xml_escaped(std::string("a\0b", 3)) == "a\\x00b");
  CHECK(xml_escaped("\x1b[31mred") == "\\x1B[31mred");
  CHECK(xml_escaped("\xEF\xBF\xBE") == "\\xEF\\xBF\\xBE");  // U+FFFE
  CHECK(xml_escaped("\xEF\xBF\xBD") == "\xEF\xBF\xBD");     // U+FFFD is a character
  CHECK(xml_escaped("\x7F\xC2\x9B\xE2\x80\xAE") == "\\u007F\\u009B\\u202E");
}

TEST_CASE("bytes that are no UTF-8 are shown, characters are kept") {
  CHECK(xml_escaped("caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x8E\x88") ==
        "caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x8E\x88");
  CHECK(xml_escaped("\xC3") == "\\xC3");                             // cut off
  CHECK(xml_escaped("\xC0\xAF") == "\\xC0\\xAF");                    // overlong
  CHECK(xml_escaped("\xED\xA0\x80") == "\\xED\\xA0\\x80");           // surrogate
  CHECK(xml_escaped("\xF4\x90\x80\x80") == "\\xF4\\x90\\x80\\x80");  // above U+10FFFF
  CHECK(xml_escaped("\xC3<") == "\\xC3&lt;");
}

}  // namespace
}  // namespace parallax::base
