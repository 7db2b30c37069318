// The printed form of the 2005 reasoner, against the answers that it recorded: byte for byte, up to
// the order of the models.

#include "runtime/trace/decreasoner_format.h"

#include <doctest/doctest.h>

#include <map>

#include "compiler/base/line_diff.h"
#include "compiler/pipeline/compile.h"
#include "runtime/session/solver_session.h"
#include "runtime/trace/open_atoms.h"
#include "tests/support/peer_examples.h"
#include "tests/support/recorded_answer.h"
#include "tools/app/trace_listing.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

compiler::Compilation compiled_example(const fs::path& example, const fs::path& root) {
  compiler::CompileInput input;
  input.models = {example};
  input.load.include_dirs = {root};
  input.load.allow_outside = true;
  input.ground.meaning = compiler::Meaning::kDecreasoner;
  base::SourceFiles files;
  base::DiagnosticSink sink;
  auto compiled = compiler::compile_model(input, files, sink);
  REQUIRE(compiled.has_value());
  return *std::move(compiled);
}

/// Every model once, distinguished by all atoms, as by the program of 2005.
std::vector<runtime::Trace> all_models(const compiler::CompiledModel& model) {
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  std::vector<runtime::Trace> found;
  const auto symbols = runtime::symbols_of(model);
  while (session.solve(model.horizon, {}) == runtime::SolveStatus::kSatisfiable) {
    const auto value = [&](compiler::Literal literal) { return session.value(literal); };
    found.push_back(runtime::decode_trace(model, symbols, model.horizon, value));
    std::vector<compiler::Literal> blocking;
    model.for_each_atom([&](const compiler::AtomRef& atom) {
      const auto literal = atom.literal();
      blocking.push_back(value(literal) ? ~literal : literal);
    });
    session.add_clause(blocking);
  }
  return found;
}

std::string joined(const runtime::Lines& lines) {
  std::string out;
  for (const auto& line : lines) out += line + '\n';
  return out;
}

TEST_CASE("every model of every recorded answer is printed, byte for byte, and no other") {
  const auto root = peer_examples();
  if (!root) return;
  std::size_t compared = 0;
  for (const auto& example : answered_examples(*root)) {
    CAPTURE(example);
    auto answer = example;
    answer.replace_extension(".txt");
    const RecordedAnswer recorded(answer);
    const auto compiled = compiled_example(example, *root);
    const runtime::DecreasonerFormat format(compiled.model,
                                            tools::decreasoner_options(*compiled.typed));
    std::map<std::string, int> difference;  // by text: printed here less recorded
    for (const auto& model : recorded.models()) --difference[joined(model.lines)];
    for (const auto& model : all_models(compiled.model)) {
      ++difference[joined(format.lines(model, {}))];
      ++compared;
    }
    for (const auto& entry : difference) {
      const auto& text = entry.first;
      const auto count = entry.second;
      CHECK_MESSAGE(count == 0, (count > 0 ? "only here:\n" : "only recorded:\n") << text);
    }
  }
  CHECK(compared > 70);
}

TEST_CASE("recorded differences between models are printed byte for byte") {
  const auto root = peer_examples();
  if (!root) return;
  std::size_t compared = 0;
  for (const auto& example : answered_examples(*root)) {
    CAPTURE(example);
    auto answer = example;
    answer.replace_extension(".txt");
    const RecordedAnswer recorded(answer);
    const auto& models = recorded.models();
    for (std::size_t i = 1; i < models.size(); ++i) {
      const auto head = models[i].printed.substr(0, models[i].printed.find(':') + 1);
      if (!head.ends_with("diff:")) continue;
      CHECK(head + base::normal_diff(models[i - 1].lines, models[i].lines) + '\n' ==
            models[i].printed);
      ++compared;
    }
  }
  CHECK(compared > 1);
}

}  // namespace
}  // namespace parallax::test
