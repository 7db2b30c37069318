// Entries that are put into scenario files whose layout stays.

#include "tools/repair/mapping_line.h"

#include <doctest/doctest.h>

namespace parallax::tools {
namespace {

/// The text with `New(): {..}` behind the entry for `key`.
std::string with_entry(const std::string& text, const std::string& key) {
  base::SourceFiles files;
  const auto file = files.add("s.yaml", text);
  harness::FluentBinding beside;
  const auto at = static_cast<std::uint32_t>(text.find(key));
  REQUIRE(at < text.size());
  beside.source = {file, at, at + static_cast<std::uint32_t>(key.size())};
  const auto change = mapping_line(beside, "New(): {}", files);
  REQUIRE(change.has_value());
  return compiler::changed_text(text, file, {*change});
}

TEST_CASE("an entry of several lines keeps them; comments of the next one stay with that") {
  const std::string text =
      "mapping:\n"
      "  # how it is\n"
      "  \"At(item, place)\":\n"
      "    {inside: place,\n"
      "     body: \"{item}\"}   # seen\n"
      "\n"
      "  # flags\n"
      "  Held(): {flag: box.held}\n"
      "actions: {}\n";
  CHECK(with_entry(text, "At(item, place)") ==
        "mapping:\n"
        "  # how it is\n"
        "  \"At(item, place)\":\n"
        "    {inside: place,\n"
        "     body: \"{item}\"}   # seen\n"
        "  New(): {}\n"
        "\n"
        "  # flags\n"
        "  Held(): {flag: box.held}\n"
        "actions: {}\n");
  CHECK(with_entry(text, "Held()").find("box.held}\n  New(): {}\nactions") != std::string::npos);
}

TEST_CASE("the last line of a file, lines that end with a return, and braces") {
  CHECK(with_entry("mapping:\n  A(): ignored", "A()") == "mapping:\n  A(): ignored\n  New(): {}");
  CHECK(with_entry("mapping:\r\n  A(): ignored\r\n", "A()") ==
        "mapping:\r\n  A(): ignored\r\n  New(): {}\r\n");
  CHECK(with_entry("mapping: {A(): ignored, \"B(x)\": ignored}\n", "B(x)") ==
        "mapping: {A(): ignored, New(): {}, \"B(x)\": ignored}\n");
}

TEST_CASE("a fluent that is bound by its name alone has no place in a file") {
  CHECK_FALSE(mapping_line({}, "New(): {}", {}).has_value());
}

}  // namespace
}  // namespace parallax::tools
