#include "tools/bench/contestants.h"

#include "tools/bench/bench.h"

namespace parallax::tools {
namespace {

/// The digits that follow the last `mark` and blanks.
std::string number_after(const std::string& text, const std::string& mark) {
  const auto at = text.rfind(mark);
  if (at == std::string::npos) return "";
  const auto begin = text.find_first_not_of(' ', at + mark.size());
  if (begin == std::string::npos) return "";
  const auto end = text.find_first_not_of("0123456789", begin);
  return text.substr(begin, end == std::string::npos ? end : end - begin);
}

/// 10: satisfiable, 20: unsatisfiable, 30: all models were found.
Contestant clingo_with(std::vector<std::string> command) {
  Contestant clingo{"clingo", std::move(command), "", {10, 20, 30}, {}};
  clingo.answer = [](const ChildRun& run) { return clingo_answer(run.tail); };
  return clingo;
}

}  // namespace

std::string clingo_answer(const std::string& tail) {
  const auto at = tail.rfind("\nModels ");
  if (at == std::string::npos) return "";
  return number_after(tail.substr(at, tail.find('\n', at + 1) - at), ":");
}

std::string jsonl_answer(const std::string& tail) { return number_after(tail, "\"traces\":"); }

Contestant parallax_with(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), parallax_program());
  return {"parallax", std::move(arguments), "", {0}, {}};
}

Contestant parallax_counts(const std::string& file) {
  auto contestant = parallax_with({"traces", file, "--count"});
  contestant.answer = [](const ChildRun& run) {
    return run.tail.substr(0, run.tail.find_first_not_of("0123456789"));
  };
  return contestant;
}

Contestant parallax_lists(const std::string& file) {
  auto contestant = parallax_with({"traces", file, "--limit", "0", "--format", "jsonl"});
  contestant.answer = [](const ChildRun& run) { return jsonl_answer(run.tail); };
  return contestant;
}

Contestant clingo_counts(const std::string& file) {
  return clingo_with({"clingo", file, "0", "-q", "--warn=none"});
}

Contestant clingo_lists(const std::string& file) {
  return clingo_with({"clingo", file, "0", "--warn=none"});
}

Contestant clingo_grounds(const std::string& file) {
  auto gringo = clingo_with({"clingo", "--mode=gringo", file, "--warn=none"});
  gringo.good_codes.push_back(0);
  gringo.answer = nullptr;
  return gringo;
}

}  // namespace parallax::tools
