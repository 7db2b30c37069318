#include "compiler/asp/asp_export.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/compiler/front_end.h"
#include "tests/support/process.h"

namespace parallax::test {
namespace {

struct Exported : CheckedText {
  std::string text;
  std::optional<compiler::AspProgram> program;

  explicit Exported(const std::string& source) : CheckedText(source) {
    if (!model) return;
    auto made = compiler::to_asp(*model, files, {}, sink);
    if (!made) return;
    program = *std::move(made);
    text = program->text;
  }
  bool has(const std::string& part) const { return text.find(part) != std::string::npos; }
};

/// The number of answer sets, or -1 where clingo is not installed (with a message).
int answer_sets(const std::string& text) {
  if (run_process({"clingo", "--version"}).code != 0) {
    MESSAGE("clingo is not installed: skipped");
    return -1;
  }
  const auto path = std::filesystem::temp_directory_path() /
                    ("parallax_asp_" + std::to_string(::getpid()) + ".lp");
  std::ofstream(path) << text;
  const auto result = run_process(
      {"clingo", "--verbose=0", "--warn=none", "--models=0", "--project=project", path.string()});
  std::filesystem::remove(path);
  CAPTURE(text);
  CAPTURE(result.err);
  CHECK((result.code == 20 || result.code == 30));
  return static_cast<int>(std::count(result.out.begin(), result.out.end(), '\n')) - 1;
}

void check_answer_sets(const std::string& source, int expected) {
  const Exported exported(source);
  CAPTURE(exported.FrontEnd::text());
  REQUIRE(exported.program.has_value());
  const int found = answer_sets(exported.text);
  if (found >= 0) CHECK(found == expected);
}

TEST_CASE("an axiom without quantifiers inside becomes one rule behind its source text") {
  const Exported exported(
      "range time 0 2\nsort room\nroom Hall\nfluent In(room)\nevent Go(room)\n"
      "[room,time] !HoldsAt(In(room),time) -> Initiates(Go(room),In(room),time).\n"
      "[room,time]\nHoldsAt(In(room),time) ->\nHoldsAt(In(room),time+1).\n");
  CHECK(
      exported.has("\n% m.e:6: [room,time] !HoldsAt(In(room),time) -> "
                   "Initiates(Go(room),In(room),time)\n"
                   "initiates(go(Room),in(Room),Time) :- room(Room), step(Time), "
                   "not holds_at(in(Room),Time).\n"));
  CHECK(
      exported.has("% m.e:7: [room,time] HoldsAt(In(room),time) -> HoldsAt(In(room),time+1)\n"
                   ":- room(Room), time(Time), time((Time+1)), holds_at(in(Room),Time), "
                   "not holds_at(in(Room),(Time+1)).\n"));
}

TEST_CASE("names that differ in the first letter's size or are words of the program stay apart") {
  const Exported exported(
      "range time 0 1\nsort thing\nthing Not, not, A, a\nfluent Step(thing)\nevent Happens_()\n");
  REQUIRE(exported.program.has_value());
  const auto& names = exported.program->names;
  CHECK(exported.has("thing(not_;not__;a;a_)."));
  CHECK(names.original("step_(not_)") == "Step(Not)");
  CHECK(names.original("step_(a_)") == "Step(a)");
  for (const auto* text : {"Step(Not)", "Step(a)", "Happens_()", "Q(Step(A),Happens_(),-3)"}) {
    CHECK(names.original(names.printed(text)) == text);
  }
  CHECK(names.original("happens_") == "Happens_()");
}

TEST_CASE("completion: an open occurrence gives a rule for the atom, a hidden one a copy") {
  const Exported exported(
      "range time 0 2\nfluent F()\nevent E()\nevent G()\n"
      "[time] HoldsAt(F(),time) -> Happens(E(),time).\n[time] {event} Happens(event,time).\n"
      "completion Happens\n");
  CHECK(exported.has("reason_happens(e,Time) :- step(Time), holds_at(f,Time).\n"));
  CHECK(exported.has("(Event,Time,) != (P1,P2,)"));
  CHECK(exported.has(":- happens(X1,X2), not reason_happens(X1,X2).\n"));
}

TEST_CASE("founded reasons ask for the reasons of completed atoms, or are refused") {
  const std::string ways =
      "option founded on\nrange time 0 1\nfluent F()\nsort room\nroom A, B, C\n"
      "predicate Door(room,room)\npredicate Way(room,room)\ncompletion Way\n"
      "[room1,room2] Door(room1,room2) -> Way(room1,room2).\n"
      "[room1,room2,room3] Way(room1,room2) & Way(room2,room3) -> Way(room1,room3).\n"
      "[room1,room2] Door(room1,room2) <-> (room1=A & room2=B | room1=B & room2=C |\n"
      "  room1=C & room2=B).\nnoninertial F\n";
  const Exported exported(ways);
  CHECK(exported.has("reason_way(Room2,Room3)"));
  check_answer_sets(ways, 4);
  check_answer_sets(ways + "HoldsAt(F(),0).\nWay(A,A).\n", 2);
  const Exported hidden(
      "option founded on\nrange time 0 1\nevent E()\nevent G()\n"
      "[time] ({event} Happens(event,time)) -> Happens(E(),time).\n"
      "completion Happens\n");
  CHECK(hidden.places() == Strings{"E3051 5:1-57"});
}

TEST_CASE("counts and sums become aggregates over an auxiliary of their own") {
  const std::string items =
      "range time 0 1\nsort item\nitem A, B, C\nsort weight: integer\nrange weight 1 9\n"
      "function Weight(item): weight\nWeight(A)=2.\nWeight(B)=3.\nWeight(C)=4.\n"
      "fluent In(item)\nevent Load(item)\n[item,time] Initiates(Load(item),In(item),time).\n"
      "[item] !HoldsAt(In(item),0).\n[time] count{item: Happens(Load(item),time)}<=2.\n"
      "[time] sum{item: Weight(item): HoldsAt(In(item),time)}<=6.\n";
  const Exported exported(items);
  CHECK(exported.has("#count{ Item : counted_1(Item,Time) } > 2"));
  CHECK(exported.has("#sum{ "));
  check_answer_sets(items, 6);
}

TEST_CASE("a number of more than 32 bits is reported where it stands") {
  const Exported exported("range time 0 1\nfluent F()\nHoldsAt(F(),0) | 3000000000=1.\n");
  CHECK(exported.places() == Strings{"E3050 3:18-27"});
  const Exported ranges("range time 0 1\nsort k: integer\nrange k -3000000000 3\nfluent F(k)\n");
  CHECK(ranges.places() == Strings{"E3050 3:1-21"});
}

TEST_CASE("formulas nested eight thousand deep are exported in linear space") {
  std::string text = "HoldsAt(F(),time)";
  for (int i = 0; i < 4000; ++i) text = "(HoldsAt(F(),time) | (Happens(E(),time) & " + text + "))";
  const Exported exported("range time 0 1\nfluent F()\nevent E()\n[time] " + text +
                          ".\ncompletion Happens\n");
  REQUIRE(exported.program.has_value());
  CHECK(exported.text.size() < 40 * text.size());
}

TEST_CASE("division cuts off towards zero and the remainder has the dividend's sign") {
  check_answer_sets(
      "range time 0 0\nsort value: integer\nrange value -7 7\nfluent F(value)\n"
      "[value] HoldsAt(F(value),0) <-> value/2 = -3 & value%2 = -1 & value/(-3)=2.\n"
      "HoldsAt(F(-7),0).\n",
      1);
}

TEST_CASE("completion of a disjunction makes the events exclusive") {
  check_answer_sets(
      "range time 0 1\nfluent F()\nevent E()\nevent G()\nHappens(E(),0) | Happens(G(),0).\n"
      "HoldsAt(F(),0).\ncompletion Happens\n",
      2);
}

TEST_CASE("a part that does not exist takes the whole instance with it") {
  // At the last timepoint nothing is said, although the first part is false there by itself.
  check_answer_sets(
      "range time 0 1\nfluent F()\nevent E()\n"
      "[time] HoldsAt(F(),time) <-> (time<0 & Happens(E(),time)).\n",
      0 + 2);
}

TEST_CASE("a trajectory fixes another fluent until its own is terminated") {
  check_answer_sets(
      "range time 0 3\nrange offset 1 3\nsort height: integer\nrange height 0 6\n"
      "fluent Falling()\nfluent Height(height)\nnoninertial Height\n"
      "event Drop()\nevent Catch()\n"
      "[time] {height} HoldsAt(Height(height),time).\n"
      "[height1,height2,time] HoldsAt(Height(height1),time) & HoldsAt(Height(height2),time) -> "
      "height1=height2.\n"
      "[time] Initiates(Drop(),Falling(),time).\n[time] Terminates(Catch(),Falling(),time).\n"
      "[height1,height2,offset,time] HoldsAt(Height(height1),time) & height2=height1-2*offset -> "
      "Trajectory(Falling(),time,Height(height2),offset).\n"
      "!HoldsAt(Falling(),0).\nHoldsAt(Height(6),0).\nHappens(Drop(),0).\nHappens(Catch(),1).\n"
      "completion Happens\n",
      7 * 7);
}

TEST_CASE("the models of the language guide have as many answer sets as it says traces") {
  std::ifstream in(std::string(PARALLAX_SOURCE_DIR) + "/docs/reference/model_language.md");
  const std::string guide{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const std::string mark = "<!-- traces: ";
  int models = 0;
  for (auto at = guide.find(mark); at != std::string::npos; at = guide.find(mark, at + 1)) {
    const auto begin = guide.find("```\n", at) + 4;
    check_answer_sets(guide.substr(begin, guide.find("```", begin) - begin),
                      std::stoi(guide.substr(at + mark.size())));
    ++models;
  }
  CHECK(models >= 7);
}

}  // namespace
}  // namespace parallax::test
