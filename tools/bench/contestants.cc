#include "tools/bench/contestants.h"

#include "tools/bench/bench.h"
#include "tools/bench/child_run.h"

namespace parallax::tools {
namespace {

/// 10: satisfiable, 20: unsatisfiable, 30: all models were found.
Contestant clingo_with(std::vector<std::string> command, Encoding encoding) {
  const auto* name = encoding == Encoding::kTuned ? "clingo, by hand" : "clingo";
  Contestant clingo{name, std::move(command), "", {10, 20, 30}, {}};
  clingo.answer = [](const ChildRun& run) { return clingo_answer(run.tail); };
  return clingo;
}

}  // namespace

Contestant parallax_with(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), parallax_program());
  return {"parallax", std::move(arguments), "", {0}, {}};
}

Contestant parallax_counts(const std::string& file) {
  auto contestant = parallax_with({"traces", file, "--count"});
  contestant.answer = [](const ChildRun& run) { return count_answer(run.tail); };
  return contestant;
}

Contestant parallax_lists(const std::string& file) {
  auto contestant = parallax_with({"traces", file, "--limit", "0", "--format", "jsonl"});
  contestant.answer = [](const ChildRun& run) { return jsonl_answer(run.tail); };
  return contestant;
}

Contestant clingo_counts(const std::string& file, Encoding encoding) {
  return clingo_with({"clingo", file, "0", "-q", "--warn=none"}, encoding);
}

Contestant clingo_lists(const std::string& file, Encoding encoding) {
  return clingo_with({"clingo", file, "0", "--warn=none"}, encoding);
}

Contestant clingo_minimizes(const std::string& file, const std::string& costs,
                            const std::string& configuration) {
  auto clingo =
      clingo_with({"clingo", file, costs, "-q", "--warn=none", "--configuration=" + configuration},
                  Encoding::kTuned);
  clingo.program = "clingo, " + configuration;
  clingo.answer = [](const ChildRun& run) { return clingo_optimum(run.tail); };
  return clingo;
}

Contestant clingo_finds(const std::string& file, const std::string& configuration) {
  auto clingo = clingo_with(
      {"clingo", file, "-q", "--warn=none", "--configuration=" + configuration}, Encoding::kTuned);
  clingo.program = "clingo, " + configuration;
  clingo.answer = [](const ChildRun& run) {
    return run.code == 20 ? "unsatisfiable" : "satisfiable";
  };
  return clingo;
}

Contestant clingo_consequences(const std::string& file, const std::string& mode,
                               const std::string& configuration) {
  auto clingo = clingo_with({"clingo", file, "0", "-q", "--warn=none", "--enum-mode=" + mode,
                             "--configuration=" + configuration},
                            Encoding::kExported);
  clingo.program = "clingo, " + configuration;
  clingo.answer = [](const ChildRun& run) { return clingo_consequences(run.tail); };
  return clingo;
}

Contestant clingo_grounds(const std::string& file, Encoding encoding) {
  auto gringo = clingo_with({"clingo", "--mode=gringo", file, "--warn=none"}, encoding);
  gringo.good_codes.push_back(0);
  gringo.answer = nullptr;
  return gringo;
}

}  // namespace parallax::tools
