// Every marked model of docs/reference/model_language.md has the number of traces that the page
// says, and the warnings that its mark names after it.

#include <doctest/doctest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/checked_traces.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

std::string guide() {
  std::ifstream in(std::string(PARALLAX_SOURCE_DIR) + "/docs/reference/model_language.md");
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

TEST_CASE("the models of the language guide have as many traces as it says") {
  const auto text = guide();
  const std::string mark = "<!-- traces: ";
  int models = 0;
  for (auto at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
    const auto expected = std::stoll(text.substr(at + mark.size()));
    const auto said = text.substr(at + mark.size(), text.find(" -->", at) - at - mark.size());
    const auto comma = said.find(", ");
    const auto codes = comma == std::string::npos ? "" : said.substr(comma + 2);
    const auto begin = text.find("```\n", at) + 4;
    const auto block = text.substr(begin, text.find("```", begin) - begin);
    CAPTURE(block);
    const TextModel model(block);
    CHECK(model.codes() == codes);
    REQUIRE(model.typed != nullptr);
    const auto traces = checked_traces(*model.typed, model.compiled);
    CHECK(static_cast<std::int64_t>(traces.size()) == expected);
    ++models;
  }
  CHECK(models >= 7);
}

}  // namespace
}  // namespace parallax::test
