#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/fuzz/oracles.h"
#include "tests/support/process.h"

namespace parallax::test {
namespace {

/// A file of this process, removed at its end.
class ProgramFile {
 public:
  ProgramFile()
      : path_(std::filesystem::temp_directory_path() /
              ("parallax_fuzz_" + std::to_string(::getpid()) + ".lp")) {}
  ~ProgramFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  ProgramFile(const ProgramFile&) = delete;
  ProgramFile& operator=(const ProgramFile&) = delete;
  std::string write(const std::string& text) const {
    std::ofstream(path_) << text;
    return path_.string();
  }

 private:
  std::filesystem::path path_;
};

/// The arguments of `name(a,b(c,d),e)`.
std::vector<std::string> arguments_of(const std::string& atom) {
  std::vector<std::string> arguments;
  const auto open = atom.find('(');
  if (open == std::string::npos) return arguments;
  int depth = 0;
  std::string current;
  for (std::size_t i = open + 1; i + 1 < atom.size(); ++i) {
    if (atom[i] == '(') ++depth;
    if (atom[i] == ')') --depth;
    if (atom[i] == ',' && depth == 0) {
      arguments.push_back(std::move(current));
      current.clear();
    } else {
      current += atom[i];
    }
  }
  arguments.push_back(std::move(current));
  return arguments;
}

compiler::Valuation read_answer(const std::string& line, const compiler::AspNames& names,
                                std::size_t horizon, std::set<std::size_t>& axioms) {
  compiler::Valuation trace;
  trace.holds.resize(horizon + 1);
  trace.happens.resize(horizon + 1);
  trace.released.resize(horizon + 1);
  std::istringstream words(line);
  std::string atom;
  while (words >> atom) {
    const auto predicate = atom.substr(0, atom.find('('));
    const auto arguments = arguments_of(atom);
    const auto at = [&](std::vector<std::set<std::string>>& where) {
      where[std::stoul(arguments[1])].insert(names.original(arguments[0]));
    };
    if (predicate == "holds_at") {
      at(trace.holds);
    } else if (predicate == "happens") {
      at(trace.happens);
    } else if (predicate == "released_at") {
      at(trace.released);
    } else if (predicate == "axiom_exists") {
      axioms.insert(std::stoul(arguments[0]));
    } else {
      trace.predicates.insert(names.original(atom));
    }
  }
  return trace;
}

}  // namespace

bool clingo_is_installed() {
  const auto version = run_process({"clingo", "--version"});
  return version.code == 0 && version.out.starts_with("clingo version 5");
}

std::optional<ClingoAnswer> clingo_traces(const compiler::AspProgram& program, std::size_t limit,
                                          bool observable, std::size_t horizon,
                                          std::string& error) {
  static const ProgramFile file;
  std::vector<std::string> command = {"clingo", "--verbose=0", "--warn=none",
                                      "--models=" + std::to_string(limit)};
  if (observable) command.emplace_back("--project=project");
  command.push_back(file.write(program.text));
  const auto result = run_process(command);
  // 10: satisfiable, 20: the search space was exhausted.
  if (result.code != 10 && result.code != 20 && result.code != 30) {
    error = "clingo ended with " + std::to_string(result.code) + "\n" + result.err;
    return std::nullopt;
  }
  ClingoAnswer answer;
  answer.found.complete = result.code != 10;
  std::istringstream lines(result.out);
  std::string line;
  while (std::getline(lines, line)) {
    if (line == "SATISFIABLE" || line == "UNSATISFIABLE") break;
    answer.found.traces.push_back(
        read_answer(line, program.names, horizon, answer.existing_axioms));
  }
  return answer;
}

std::variant<std::optional<std::int64_t>, std::string> clingo_optimum(
    const compiler::AspProgram& program, const std::string& minimize) {
  static const ProgramFile file;
  const auto result = run_process(
      {"clingo", "--verbose=0", "--warn=none", file.write(program.text + minimize + "\n")});
  if (result.code == 20) return std::nullopt;
  const std::string heading = "Optimization: ";
  const auto last = result.out.rfind(heading);
  if (result.code != 30 || last == std::string::npos) {
    return "clingo ended with " + std::to_string(result.code) + "\n" + result.err;
  }
  return std::stoll(result.out.substr(last + heading.size()));
}

}  // namespace parallax::test
