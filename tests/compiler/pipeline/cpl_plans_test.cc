// Small plans: measured behaviour of the real CPL, compared with the unroller on the same files.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/pipeline/compile.h"
#include "runtime/enumerate/model_enumerator.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
const fs::path kFolder = fs::path(PARALLAX_SOURCE_DIR) / "tests" / "plans" / "cpl";
constexpr std::size_t kHorizon = 9;

/// Plans that are refused, and why.
const std::map<std::string, std::string> kRefused = {
    {"s55_handler_on_t",
     "a handler on `condition` also hears what the real one signals that is no failure"},
};

struct Measured {
  std::string text;
  bool dies = false;
  bool lisp_error = false;
  std::set<std::string> traces;
  std::set<std::string> failures;  // classes that ended it
};

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  REQUIRE(in);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// How the plan ended, and the performs; behind those of a plan that is done `last`, if there is
/// room for it.
void note_trace(std::istringstream words, Measured& plan, const std::string& last = "") {
  std::string end;
  words >> end;
  plan.lisp_error = plan.lisp_error || end == "error";
  if (end.starts_with("failed(")) plan.failures.insert(end.substr(7, end.size() - 8));
  std::string trace;
  std::size_t performs = 0;
  for (std::string word; words >> word; ++performs) trace += word + ' ';
  if (end == "done" && performs < kHorizon) trace += last;
  plan.traces.insert(trace);
}

std::map<std::string, Measured> measured() {
  std::istringstream in(text_of(kFolder / "measured.txt"));
  std::map<std::string, Measured> out;
  Measured* plan = nullptr;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    if (line.starts_with(' ')) {
      REQUIRE(plan != nullptr);
      note_trace(std::move(words), *plan);
      continue;
    }
    std::string word;
    words >> word;
    plan = &out[word];
    plan->dies = static_cast<bool>(words >> word);
    plan->text = text_of(kFolder / "measured" / (line.substr(0, line.find(' ')) + ".lisp"));
  }
  return out;
}

/// Each plan notes that it is done, so that a trace tells success from failure.
std::map<std::string, Measured> derived() {
  constexpr int kHelpers = 7;  // lines
  std::istringstream helpers(text_of(kFolder / "measured" / "s01_retry.lisp"));
  std::string prelude;
  std::string line;
  for (int i = 0; i < kHelpers && std::getline(helpers, line); ++i) prelude += line + '\n';
  std::map<std::string, Measured> out;
  for (const auto& file : fs::directory_iterator(kFolder / "derived")) {
    std::istringstream in(text_of(file.path()));
    Measured* plan = nullptr;
    while (std::getline(in, line)) {
      if (line.starts_with("= ")) {
        std::istringstream words(line.substr(2));
        std::string name;
        std::string mark;
        words >> name >> mark;
        const auto [entry, added] = out.try_emplace(name);
        REQUIRE_MESSAGE(added, "two plans are called " << name);
        plan = &entry->second;
        plan->dies = mark == "dies";
        plan->text = prelude;
      } else if (plan != nullptr && line.starts_with("-> ")) {
        note_trace(std::istringstream(line.substr(3)), *plan, "Note(done) ");
      } else if (plan != nullptr) {
        plan->text += line + '\n';
      }
    }
  }
  for (auto& [name, plan] : out) plan.text += "(common-lisp-user::note :done)\n";
  return out;
}

struct Ours {
  bool refused = false;
  bool located = false;  // the refusal names a place in the plan
  std::string codes;
  std::set<std::string> traces;
  std::set<std::string> failures;
};

Ours unrolled(const std::string& text, bool interleave) {
  struct NoRegions final : compiler::PoseLocator {
    std::optional<std::string> region_of(std::string_view,
                                         const compiler::PlanPose&) const override {
      return std::nullopt;
    }
    std::optional<Nearest> nearest(std::string_view, const compiler::PlanPose&) const override {
      return std::nullopt;
    }
  };
  const NoRegions nowhere;
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto plan = files.add("plan.lisp", text);
  const auto binding = files.add("free.bind", text_of(kFolder / "free.bind"));
  compiler::CompileInput input;
  input.models = {kFolder / "free.e"};
  input.horizon = kHorizon;
  input.plan = compiler::PlanInput{{plan}, binding, std::nullopt, &nowhere};
  input.plan->interleave = interleave;
  const auto compiled = compiler::compile_model(input, files, sink);
  Ours out;
  out.refused = !compiled;
  for (const auto& entry : sink.sorted()) {
    if (base::info(entry.code).severity != base::Severity::kError) continue;
    out.codes += std::string(base::info(entry.code).id) + ' ';
    out.located = entry.range && entry.range->file == plan && entry.range->end > entry.range->begin;
  }
  if (out.refused) return out;
  for (const auto& terminal : compiled->plan->terminals) {
    if (terminal.kind == compiler::TerminalKind::kFailed) out.failures.insert(terminal.detail);
  }
  runtime::SolverSession session(compiled->model, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session);
  while (const auto trace = enumerator.next()) {
    std::string key;
    for (std::size_t t = 0; t + 1 < trace->points.size(); ++t) {
      const auto& point = trace->points[t];
      for (const auto& event : trace->happens(t)) {
        key += event;
        if (!point.succeeded) key += "!";
        if (point.returned) key += '=' + *point.returned;
        key += ' ';
      }
    }
    out.traces.insert(key);
  }
  return out;
}

std::string difference(const std::string& name, const Measured& real, const Ours& ours) {
  // A plan that signals a Lisp error is refused, or ends as the real one.
  if (real.dies || (real.lisp_error && ours.refused)) {
    return ours.refused && ours.located ? "" : "accepted, and the real one dies";
  }
  if (ours.refused) {
    return name.starts_with('r') && ours.located ? "" : "refused: " + ours.codes;
  }
  std::string out;
  for (const auto& trace : real.traces) {
    if (!ours.traces.contains(trace)) out += "missing " + trace + '\n';
  }
  for (const auto& trace : ours.traces) {
    if (!name.starts_with('p') && !real.traces.contains(trace)) out += "not real " + trace + '\n';
  }
  for (const auto& failure : real.failures) {
    if (!ours.failures.contains(failure)) out += "does not end in " + failure + '\n';
  }
  return out;
}

TEST_CASE("plans mean what the real CPL made of them") {
  const auto all = measured();
  CHECK(all.size() == 71);
  for (const auto& [name, real] : all) {
    CAPTURE(name);
    const auto ours = unrolled(real.text, name.starts_with('p'));
    if (kRefused.contains(name)) {
      CHECK_MESSAGE(ours.refused, "not refused any more: " << kRefused.at(name));
      CHECK(ours.located);
    } else {
      CHECK_MESSAGE(difference(name, real, ours).empty(), difference(name, real, ours));
    }
  }
  for (const auto& [name, reason] : kRefused) CHECK(all.contains(name));
  // Its branches had delays, as those of the plans with `par`: the traces are some of all orders.
  const auto& pursue = all.at("r01_pursue");
  const auto turns = unrolled(pursue.text, true);
  CHECK(difference("p", pursue, turns).empty());
  CHECK(turns.traces.size() > pursue.traces.size());
}

std::string both_ways(const Measured& expected, const Ours& ours) {
  std::string out;
  for (const auto& trace : expected.traces) {
    if (!ours.traces.contains(trace)) out += "missing " + trace + '\n';
  }
  for (const auto& trace : ours.traces) {
    if (!expected.traces.contains(trace)) out += "too many " + trace + '\n';
  }
  return out;
}

TEST_CASE("plans mean what the description of the language says, worked out by hand") {
  const auto all = derived();
  CHECK(all.size() == 578);
  for (const auto& [name, expected] : all) {
    CAPTURE(name);
    const auto ours = unrolled(expected.text, name.starts_with('p'));
    if (expected.dies) {
      CHECK(ours.refused);
      CHECK(ours.located);
      continue;
    }
    REQUIRE_MESSAGE(!ours.refused, ours.codes);
    CHECK_MESSAGE(ours.traces == expected.traces, both_ways(expected, ours));
    for (const auto& failure : expected.failures) CHECK(ours.failures.contains(failure));
  }
}

}  // namespace
}  // namespace parallax::test
