#include "compiler/compare/plan_facts.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "compiler/lisp/lisp_reader.h"

namespace parallax::test {
namespace {

using compiler::Fact;
using compiler::FactKind;

struct PlanText {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  base::FileId file;
  explicit PlanText(const std::string& text) : file(files.add("p.lisp", text)) {}
  compiler::LispText lisp() {
    auto read = compiler::read_lisp(files, file, sink);
    REQUIRE(read);
    return *std::move(read);
  }
  std::vector<Fact> facts() { return compiler::plan_facts(lisp(), files); }
};

const char* const kTwoForms =
    "; a comment\n(def-cram-function fetch ()\n  (perform (an action (type going))))\n"
    "(def-cram-function stay () nil)\n";

TEST_CASE("layout, comments and case of a plan say nothing") {
  PlanText one(kTwoForms);
  PlanText other(
      "(DEF-CRAM-FUNCTION fetch () (perform (an action (type GOING))))\n\n\n"
      "(def-cram-function stay () ; nothing\n nil)\n");
  CHECK(compiler::compare_facts(one.facts(), other.facts()).empty());
  CHECK(compiler::canonical_plan(one.lisp()) == compiler::canonical_plan(other.lisp()));
}

TEST_CASE("a definition is known by its name, so that a changed one is one fact changed") {
  PlanText one(kTwoForms);
  PlanText other(
      "(def-cram-function fetch () (perform (an action (type looking))))\n"
      "(def-cram-function stay () nil)\n");
  const auto difference = compiler::compare_facts(one.facts(), other.facts());
  CHECK(difference.changed.size() == 1);
  CHECK(difference.added.empty());
  CHECK(difference.removed.empty());
}

TEST_CASE("the order of forms is a fact, unless the forms that stay stand in the same order") {
  PlanText one(kTwoForms);
  PlanText swapped(
      "(def-cram-function stay () nil)\n"
      "(def-cram-function fetch () (perform (an action (type going))))\n");
  auto before = one.facts(), after = swapped.facts();
  compiler::drop_equal_order(before, after);
  CHECK(compiler::compare_facts(before, after).changed.size() == 1);
  PlanText longer(std::string(kTwoForms) + "(def-cram-function more () nil)\n");
  before = one.facts();
  after = longer.facts();
  compiler::drop_equal_order(before, after);
  const auto difference = compiler::compare_facts(before, after);
  CHECK(difference.changed.empty());
  CHECK(difference.added.size() == 1);
}

TEST_CASE("edits are the smallest pieces in which two forms differ") {
  PlanText one("(def-cram-function f () (go here) (take it))\n");
  PlanText other("(def-cram-function f () (go there) (take it) (leave))\n");
  // Both texts in one set of files, as a comparison has them.
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto read = [&](const PlanText& plan) {
    const auto id = files.add("p.lisp", std::string(plan.files[plan.file].text()));
    auto lisp = compiler::read_lisp(files, id, sink);
    REQUIRE(lisp);
    return *std::move(lisp);
  };
  const auto before = read(one), after = read(other);
  const auto edits = compiler::datum_edits(before, before.forms[0], after, after.forms[0], files);
  REQUIRE(edits.size() == 2);
  CHECK(edits[0].removed == "here");
  CHECK(edits[0].added == "there");
  CHECK(edits[1].removed.empty());
  CHECK(edits[1].added == "(leave)");
  CHECK(edits[1].new_place.line == 1);
}

TEST_CASE("what is put around a form, or taken away, is an edit of its own") {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto read = [&](const std::string& text) {
    auto lisp = compiler::read_lisp(files, files.add("p.lisp", text), sink);
    REQUIRE(lisp);
    return *std::move(lisp);
  };
  const auto edits = [&](const std::string& old_text, const std::string& new_text) {
    const auto before = read(old_text), after = read(new_text);
    return compiler::datum_edits(before, before.forms[0], after, after.forms[0], files);
  };
  const auto one = edits("(def f () (go a) (take b))", "(def f () (go a) (try (x) (take b) (y)))");
  REQUIRE(one.size() == 1);
  CHECK(one[0].removed.empty());
  CHECK(one[0].added == "(try (x) ... (y))");
  CHECK(one[0].around == "(take b)");
  // Several forms, deeper inside, and other edits before and behind, in the order of the text.
  const auto many = edits("(def f () (go a) (take b) (put c) (leave d))",
                          "(def f () (go z) (try (let () (take b) (put c)) (y)) (leave q))");
  REQUIRE(many.size() == 3);
  CHECK(many[0].added == "z");
  CHECK(many[1].added == "(try (let () ...) (y))");
  CHECK(many[1].around == "(take b) and what follows it");
  CHECK(many[2].added == "q");
  const auto gone = edits("(def f () (try (take b)))", "(def f () (take b))");
  REQUIRE(gone.size() == 1);
  CHECK(gone[0].removed == "(try ...)");
  CHECK(gone[0].added.empty());
  // A number inside something is no wrapped number.
  CHECK(edits("(def f () 1)", "(def f () (g 2 1))")[0].around.empty());
}

TEST_CASE("of long texts the part is shown in which they differ") {
  std::string common;
  for (int i = 0; i < 100; ++i) common += "word" + std::to_string(i) + " ";
  const auto [before, after] = compiler::changed_parts(common + "old tail " + common,
                                                       common + "new and longer tail " + common);
  CHECK(before.size() < 200);
  CHECK(before.starts_with("... "));
  CHECK(before.ends_with(" ..."));
  CHECK(before.find("word99 old tail word0 ") != std::string::npos);
  CHECK(after.find("word99 new and longer tail word0 ") != std::string::npos);
  CHECK(compiler::changed_parts("a b", "a c") == std::pair<std::string, std::string>("a b", "a c"));
}

TEST_CASE("entries of a binding table are facts without comments and layout") {
  base::SourceFiles files;
  const auto one = files.add(
      "a.bind",
      "; a comment\nmotion going (:target ?p) -> Go(region(?p))  ok: At(region(?p)) @t+1\n");
  const auto facts = compiler::binding_facts(one, files);
  const auto other = files.add(
      "b.bind", "motion going   (:target ?p)\n   -> Go(region(?p))\n   ok: At(region(?p)) @t+1\n");
  CHECK(!facts.empty());
  CHECK(compiler::compare_facts(facts, compiler::binding_facts(other, files)).empty());
}

}  // namespace
}  // namespace parallax::test
