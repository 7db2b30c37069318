// Single mistakes of models and plans: the list is complete, and each changes just its own place.

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "compiler/repair/mutation.h"
#include "compiler/sema/check.h"

namespace parallax::compiler {
namespace {

constexpr const char* kModel = R"(sort drawer
drawer top, low
fluent Open(drawer)
fluent Parked()
fluent Busy()
noninertial Busy
event Pull(drawer)
event Swap(drawer,drawer)
[drawer,time] HoldsAt(Parked(),time) & !HoldsAt(Open(drawer),time) -> Initiates(Pull(drawer),Open(drawer),time).
[drawer1,drawer2,time] HoldsAt(Open(drawer1),time) -> Releases(Swap(drawer1,drawer2),Open(drawer2),time).
[drawer,time] Happens(Pull(drawer),time) -> HoldsAt(Parked(),time).
[time] HoldsAt(Busy(),time) <-> !HoldsAt(Parked(),time).
[time] HoldsAt(Busy(),time) & HoldsAt(Open(top),time) -> Happens(Pull(low),time).
!HoldsAt(Open(top),0).
)";

struct Mutated {
  base::SourceFiles files;
  std::vector<Mutation> mutations;
  base::FileId file;

  explicit Mutated(const std::string& text) {
    base::DiagnosticSink sink;
    file = files.add("m.e", text);
    const auto ast = load_model_text(file, ".", {}, files, sink);
    REQUIRE(ast);
    const auto typed = check_model(*ast, files, sink, range());
    REQUIRE(typed);
    mutations = model_mutations(*ast, *typed, files);
  }
  static CheckOptions range() {
    CheckOptions check;
    check.time_lower = 0;
    check.time_upper = 2;
    return check;
  }
  std::string after(const Mutation& mutation) const {
    return changed_text(files[file].text(), file, mutation.changes);
  }
  /// The line of the text that the mistake changes, as it is then.
  std::vector<std::string> lines_of(std::uint32_t line) const {
    std::vector<std::string> out;
    for (const auto& mutation : mutations) {
      if (files[file].position(mutation.at.begin).line != line) continue;
      base::SourceFiles changed;
      const auto id = changed.add("m.e", after(mutation));
      out.push_back(mutation.kind + ": " + std::string(changed[id].line(line)));
    }
    return out;
  }
};

TEST_CASE("mistakes of effects, preconditions, other axioms and facts") {
  const Mutated all(kModel);
  const std::string pull = "Initiates(Pull(drawer),Open(drawer),time).";
  CHECK(all.lines_of(9) ==
        std::vector<std::string>{
            // No mutation adds the condition `Open`: it would say nothing new, as the axiom
            // excludes it.
            "axiom dropped: [drawer1,drawer2,time] HoldsAt(Open(drawer1),time) -> "
            "Releases(Swap(drawer1,drawer2),Open(drawer2),time).",
            "condition dropped: [drawer,time] !HoldsAt(Open(drawer),time) -> " + pull,
            "condition negated: [drawer,time] !HoldsAt(Parked(),time) & "
            "!HoldsAt(Open(drawer),time) -> " +
                pull,
            "condition dropped: [drawer,time] HoldsAt(Parked(),time) -> " + pull,
            "condition negated: [drawer,time] HoldsAt(Parked(),time) & "
            "HoldsAt(Open(drawer),time) -> " +
                pull,
            "sign flipped: [drawer,time] HoldsAt(Parked(),time) & !HoldsAt(Open(drawer),time) -> "
            "Terminates(Pull(drawer),Open(drawer),time).",
            "effect on the wrong fluent: [drawer,time] HoldsAt(Parked(),time) & "
            "!HoldsAt(Open(drawer),time) -> Initiates(Pull(drawer),Parked(),time)."});
  const auto swap = all.lines_of(10);
  const auto has = [](const std::vector<std::string>& lines, const std::string& line) {
    return std::find(lines.begin(), lines.end(), line) != lines.end();
  };
  CHECK(has(swap,
            "argument swapped: [drawer1,drawer2,time] HoldsAt(Open(drawer2),time) -> "
            "Releases(Swap(drawer1,drawer2),Open(drawer2),time)."));
  CHECK(has(swap,
            "argument swapped: [drawer1,drawer2,time] HoldsAt(Open(drawer1),time) -> "
            "Releases(Swap(drawer2,drawer1),Open(drawer1),time)."));
  CHECK(swap.front().starts_with("release forgotten"));
  CHECK(all.lines_of(11).front().starts_with("precondition forgotten"));
  CHECK(has(all.lines_of(13),
            "condition dropped: [time] HoldsAt(Open(top),time) -> Happens(Pull(low),time)."));
  CHECK(has(all.lines_of(14), "fact negated: HoldsAt(Open(top),0)."));
}

TEST_CASE("each mistake is one of its own, and what repair knows is marked") {
  const Mutated all(kModel);
  std::set<std::string> texts;
  for (const auto& mutation : all.mutations) {
    CAPTURE(mutation.words);
    CHECK(mutation.words.find("m.e:") != std::string::npos);
    const auto text = all.after(mutation);
    CHECK(text != kModel);
    CHECK(texts.insert(text).second);
    base::SourceFiles files;
    base::DiagnosticSink sink;
    const auto ast = load_model_text(files.add("m.e", text), ".", {}, files, sink);
    REQUIRE(ast);
    CHECK(check_model(*ast, files, sink, Mutated::range()));
    const auto line = all.files[all.file].position(mutation.at.begin).line;
    CHECK(mutation.is_repairable == (line <= 11 && mutation.kind != "condition negated"));
  }
}

std::vector<std::string> plan_lines(const std::string& plan) {
  base::SourceFiles files;
  const auto file = files.add("p.lisp", plan);
  const std::vector<base::FileId> all = {file};
  const auto text = PlanText::read(files, all);
  REQUIRE(text);
  std::vector<std::string> out;
  for (const auto& mutation : plan_mutations(*text)) {
    out.push_back(mutation.kind + ": " + mutation.words);
    CHECK(changed_text(plan, file, mutation.changes) != plan);
  }
  return out;
}

TEST_CASE("mistakes of a plan") {
  CHECK(plan_lines("(def-cram-function put (?arm ?what)\n"
                   "  (perform (an action (type placing) (arm ?arm) (object ?what))))\n"
                   "(def-cram-function all ()\n"
                   "  (put 'left 'cup)\n"
                   "  (put 'right 'cup)\n"
                   "  (when (holds '(full))\n"
                   "    (perform (a motion (type going) (target base)))))\n"
                   "(all)\n") ==
        std::vector<std::string>{
            "perform dropped: `(perform (an action (type placing) (arm ?arm) (object ?wh...` "
            "(p.lisp:2) is dropped",
            "call dropped: `(put 'left 'cup)` (p.lisp:4) is dropped",
            "performs exchanged: `(put 'left 'cup)` (p.lisp:4) and `(put 'right 'cup)` (p.lisp:5) "
            "are exchanged",
            "argument swapped: in `(put 'left 'cup)` (p.lisp:4), `'left` and `'cup` are exchanged",
            "argument swapped: in `(put 'left 'cup)` (p.lisp:4), `'left` becomes `'right`",
            "call dropped: `(put 'right 'cup)` (p.lisp:5) is dropped",
            "argument swapped: in `(put 'right 'cup)` (p.lisp:5), `'right` and `'cup` are "
            "exchanged",
            "argument swapped: in `(put 'right 'cup)` (p.lisp:5), `'right` becomes `'left`",
            "guard dropped: `(when (holds '(full)) (perform (a motion (type going) (ta...` "
            "(p.lisp:6) is done in any case",
            "perform dropped: `(perform (a motion (type going) (target base)))` (p.lisp:7) is "
            "dropped"});
}

}  // namespace
}  // namespace parallax::compiler
