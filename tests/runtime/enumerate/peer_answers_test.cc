// The models of the 2005 reasoner's examples, compared with the answers it recorded.

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "compiler/pipeline/compile.h"
#include "runtime/enumerate/model_enumerator.h"
#include "tests/support/checked_traces.h"
#include "tests/support/peer_examples.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using compiler::Meaning;

/// True atoms with their times: "Alive()@0", "!Load()@1" for an event, "~Alive()@1" for a release.
using Model = std::set<std::string>;

/// Undoes the answer's layout: blanks between arguments, the closing period.
std::string atom_of(std::string line) {
  while (!line.empty() && (line.back() == '.' || line.back() == '\r')) line.pop_back();
  std::string out;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] != ' ' || (i > 0 && line[i - 1] != ',')) out += line[i];
  }
  return out;
}

using Lines = std::vector<std::string>;

/// Applies one command of a normal diff (`2c2`, `5,7c5`, `8d7`, `3a4,5`) with its new lines;
/// `shift` is how far the lines have moved through earlier commands.
void apply_command(const std::smatch& command, const Lines& added, Lines& lines, long& shift) {
  const bool appends = command[3] == "a";
  const long from = std::stol(command[1]);
  const long to = command[2].matched ? std::stol(command[2]) : from;
  const auto begin = lines.begin() + (appends ? from : from - 1) + shift;
  const auto end = appends ? begin : lines.begin() + to + shift;
  shift += static_cast<long>(added.size()) - (end - begin);
  lines.insert(lines.erase(begin, end), added.begin(), added.end());
}

/// The lines of an answer; models that are printed as a difference from the one before are written
/// out.
Lines lines_of(const fs::path& path) {
  static const std::regex diff("model (\\d+) diff:(.*)"), model("model \\d+:"),
      command("(\\d+)(?:,(\\d+))?([acd])(\\d+)(?:,(\\d+))?");
  std::ifstream in(path);
  Lines out, last;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    std::smatch parts;
    if (!std::regex_match(line, parts, diff)) {
      inside = std::regex_match(line, model) || (inside && line != "---");
      if (inside) last.push_back(line);
      if (std::regex_match(line, model)) last.clear();
      out.push_back(line);
      continue;
    }
    out.push_back("model " + parts[1].str() + ":");
    std::string next = parts[2];
    Lines added;
    std::smatch pending;
    std::string pending_text;
    long shift = 0;
    const auto flush = [&] {
      if (std::regex_match(pending_text, pending, command)) {
        apply_command(pending, added, last, shift);
      }
      added.clear();
    };
    do {
      if (next.starts_with("> ")) {
        added.push_back(next.substr(2));
      } else if (!next.starts_with("< ") && next != "---") {
        flush();
        pending_text = next;
      }
    } while (std::getline(in, next) && !next.empty());
    flush();
    out.insert(out.end(), last.begin(), last.end());
    out.emplace_back("---");
  }
  return out;
}

/// Reads the models of a recorded answer: full states or changes, both forms of the printer.
class AnswerReader {
 public:
  /// `full_states`: every timepoint lists all that holds, not the changes.
  explicit AnswerReader(bool full_states) : full_states_(full_states) {}

  std::set<Model> read(const fs::path& path) {
    static const std::regex model("model \\d+:|near miss:"), number("\\d+"),
        trailer("[A-Za-z0-9]+: \\d+ predicates.*");
    for (const auto& line : lines_of(path)) {
      if (std::regex_match(line, model)) {
        close();
        near_miss_ = near_miss_ || line.front() == 'n';
        inside_ = true;
      } else if (std::regex_match(line, trailer)) {
        close();
      } else if (inside_ && std::regex_match(line, number)) {
        keep();
        time_ = std::stoi(line);
      } else if (inside_ && line == "P") {
        keep();
        time_ = -1;
      } else if (inside_ && time_ < 0) {
        take_released(atom_of(line));
      } else if (inside_ && time_ >= 0) {
        take(atom_of(line));
      }
    }
    close();
    if (near_miss_) models_.clear();
    return models_;
  }

 private:
  void take(const std::string& atom) {
    static const std::regex timed("(HoldsAt|Happens|ReleasedAt)\\((.*),(\\d+)\\)");
    std::smatch parts;
    if (atom.empty() || atom.front() == '!') return;
    if (std::regex_match(atom, parts, timed)) {
      if (parts[1] == "Happens") model_.insert("!" + parts[2].str() + "@" + parts[3].str());
      if (parts[1] == "HoldsAt") state_.insert(parts[2]);
    } else if (atom.front() == '-') {
      state_.erase(atom.substr(1));
    } else {
      state_.insert(atom.front() == '+' ? atom.substr(1) : atom);
    }
  }
  void take_released(const std::string& atom) {
    static const std::regex released("ReleasedAt\\((.*),(\\d+)\\)");
    std::smatch parts;
    if (!std::regex_match(atom, parts, released)) return;
    model_.insert("~" + parts[1].str() + "@" + parts[2].str());
  }
  /// The state of the timepoint that ends here; it is where the next one starts from.
  void keep() {
    if (time_ < 0) return;
    for (const auto& fluent : state_) model_.insert(fluent + "@" + std::to_string(time_));
    if (full_states_) state_.clear();
  }
  void close() {
    if (!inside_) return;
    keep();
    models_.insert(model_);
    model_.clear();
    state_.clear();
    time_ = -1;
    inside_ = false;
  }

  bool full_states_;
  std::set<Model> models_;
  Model model_;
  std::set<std::string> state_;
  int time_ = -1;
  bool inside_ = false, near_miss_ = false;
};

bool has_option(const fs::path& example, const std::string& option) {
  std::ifstream in(example);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str().find("option " + option) != std::string::npos;
}

compiler::CompileInput input_for(const fs::path& example, const fs::path& root, Meaning meaning) {
  compiler::CompileInput input;
  input.models = {example};
  input.load.include_dirs = {root};
  input.load.allow_outside = true;
  input.ground.meaning = meaning;
  return input;
}

std::set<Model> enumerate(const fs::path& example, const fs::path& root, bool with_released) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto compiled =
      compiler::compile_model(input_for(example, root, Meaning::kDecreasoner), files, sink);
  REQUIRE(compiled.has_value());
  runtime::SolverSession session(compiled->model, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session);
  std::set<Model> models;
  while (const auto trace = enumerator.next()) {
    Model model;
    for (std::size_t t = 0; t < trace->points.size(); ++t) {
      const auto at = "@" + std::to_string(t);
      for (const auto fluent : trace->holds(t)) model.insert(std::string(fluent) + at);
      for (const auto event : trace->happens(t)) model.insert("!" + std::string(event) + at);
      if (!with_released) continue;
      for (const auto fluent : trace->released(t)) model.insert("~" + std::string(fluent) + at);
    }
    models.insert(model);
  }
  return models;
}

TEST_CASE("the models of every example are the recorded ones") {
  const auto root = peer_examples();
  if (!root) return;
  std::size_t compared = 0;
  for (const auto& example : answered_examples(*root)) {
    CAPTURE(example);
    auto answer = example;
    answer.replace_extension(".txt");
    const bool shows_released = !has_option(example, "showpred off");
    CHECK(enumerate(example, *root, shows_released) ==
          AnswerReader(has_option(example, "timediff off")).read(answer));
    ++compared;
  }
  CHECK(compared > 46);
}

TEST_CASE("in the standard meaning, the traces of every example satisfy the reference evaluator") {
  const auto root = peer_examples();
  if (!root) return;
  std::int64_t checked = 0;
  std::size_t examples = 0;
  for (const auto& example : answered_examples(*root)) {
    CAPTURE(example);
    base::SourceFiles files;
    base::DiagnosticSink sink;
    const auto compiled =
        compiler::compile_model(input_for(example, *root, Meaning::kStandard), files, sink);
    REQUIRE(compiled.has_value());
    TraceChecker checker(*compiled->typed);
    runtime::SolverSession session(compiled->model, runtime::make_cadical_solver());
    runtime::ModelEnumerator enumerator(session);
    while (const auto trace = enumerator.next()) checker.check(*trace);
    checked += checker.checked();
    ++examples;
  }
  CHECK(examples > 42);
  CHECK(checked > 0);
}

}  // namespace
}  // namespace parallax::test
