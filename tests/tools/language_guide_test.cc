// Every marked model of docs/language.md has the number of traces that the page says.

#include <doctest/doctest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "compiler/reference/reference_evaluator.h"
#include "runtime/enumerate/model_enumerator.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

std::string guide() {
  std::ifstream in(std::string(PARALLAX_SOURCE_DIR) + "/docs/language.md");
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

std::int64_t count_traces(const compiler::CompiledModel& compiled) {
  runtime::SolverSession session(compiled, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session);
  std::int64_t count = 0;
  while (enumerator.next()) ++count;
  return count;
}

TEST_CASE("the models of the language guide have as many traces as it says") {
  const auto text = guide();
  const std::string mark = "<!-- traces: ";
  int models = 0;
  for (auto at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
    const auto expected = std::stoll(text.substr(at + mark.size()));
    const auto begin = text.find("```\n", at) + 4;
    const auto block = text.substr(begin, text.find("```", begin) - begin);
    CAPTURE(block);
    const TextModel model(block);
    REQUIRE(model.codes() == "");
    CHECK(count_traces(model.compiled) == expected);
    ++models;
  }
  CHECK(models >= 7);
}

}  // namespace
}  // namespace parallax::test
