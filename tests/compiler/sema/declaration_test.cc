// Sorts, constants, symbols, ranges, options and the messages about them.

#include <doctest/doctest.h>

#include "tests/compiler/front_end.h"
#include "tests/compiler/typed_text.h"

namespace parallax::test {
namespace {

using compiler::SymbolKind;

constexpr const char* kTime = "range time 0 3\n";

Strings places(const std::string& text) { return CheckedText(text).places(); }

TEST_CASE("sorts: parents, integer and reified are inherited, in any order of declaration") {
  const CheckedText checked(
      "sort tv: device\nsort device: object\nsort object\nsort value: integer\n"
      "sort small: value\nreified sort belief\nrange small 0 2\n");
  REQUIRE_MESSAGE(checked.model, checked.text());
  const auto& model = *checked.model;
  const auto sort = [&](const char* name) { return *model.find_sort(name); };
  CHECK(model.is_subsort(sort("tv"), sort("object")));
  CHECK_FALSE(model.is_subsort(sort("object"), sort("tv")));
  CHECK(model.sorts[sort("small")].integer);
  CHECK_FALSE(model.sorts[sort("object")].integer);
  CHECK(model.sorts[sort("belief")].reified);
  CHECK(model.sorts[sort("fluent")].reified);
  CHECK(model.sorts_overlap(sort("object"), sort("tv")));
  CHECK_FALSE(model.sorts_overlap(sort("object"), sort("belief")));
  CHECK_FALSE(model.find_sort("nothing"));
}

TEST_CASE("sorts: a second parent and a repetition are accepted with a warning") {
  const CheckedText checked("sort a\nsort b\nsort c: a\nsort c: b\nc C\n");
  CHECK(checked.places() == Strings{"W2007 4:6-6"});
  REQUIRE(checked.model);
  CHECK(checked.model->sorts[*checked.model->find_sort("c")].parents.size() == 2);
  CHECK(
      checked.model->sorts_overlap(*checked.model->find_sort("a"), *checked.model->find_sort("b")));
  CHECK(places("sort a\nsort a\n") == Strings{"W2012 2:6-6"});
  CHECK(places("sort a\nsort b: a\nsort b: a\n") == Strings{"W2012 3:6-6"});
  CHECK(places("sort a\nsort b\nreified sort b: a\n") == Strings{"E2002 3:14-14"});
}

TEST_CASE("sorts: unknown parents, circles and bad names are reported at their place") {
  CHECK(places("sort agent: objct\nsort object\n") == Strings{"E2001 1:13-17"});
  CHECK(CheckedText("sort agent: objct\nsort object\n").text().find("with `object`") !=
        std::string::npos);
  CHECK(places("sort a: b\nsort b: c\nsort c: a\n").size() == 1);
  CHECK(places("sort a: a\n") == Strings{"E2003 1:6-6"});
  CHECK(places("sort Agent, room2\n") == Strings{"E1012 1:6-10", "E1012 1:13-17"});
}

TEST_CASE("constants: one sort each unless the declaration says `!`") {
  const CheckedText checked("sort a\nsort b\na C\nb! C\na D, _E\n");
  REQUIRE_MESSAGE(checked.model, checked.text());
  CHECK(checked.model->objects[*checked.model->find_object("C")].sorts.size() == 2);
  CHECK(
      checked.model->sorts_overlap(*checked.model->find_sort("a"), *checked.model->find_sort("b")));
  CHECK(places("sort a\nsort b\na C\nb C\n") == Strings{"E2014 4:3-3"});
  CHECK(places("sort a\na C, C\n") == Strings{"W2012 2:6-6"});
  CHECK(places("sort a\na 3, A\n") == Strings{"E1017 2:3-3"});
  CHECK(places("agnt James\nsort agent\n") == Strings{"E2001 1:1-4"});
  CHECK(places("sort v: integer\nv C\nrange v 0 1\n") == Strings{"E2006 2:3-3"});
  CHECK(places("fluent Loaded\n") == Strings{"E2004 1:8-13"});
}

TEST_CASE("constants: lower-case names are fine unless they read as variables") {
  const CheckedText checked(
      "sort region\nregion r1, left\npredicate P(region)\nP(r1) & P(left).\n");
  CHECK(checked.text() == "");
  CHECK(places("sort region\nregion region1\n") == Strings{"E1017 2:8-14"});
  CHECK(places("sort region\nsort town\nregion town1\n") == Strings{"E1017 3:8-12"});
  const CheckedText wrong("sort region\nregion r1, r2\npredicate P(region)\nP(r3).\n");
  CHECK(wrong.places() == Strings{"E2101 4:3-4"});
  CHECK(wrong.text().find("fix: replace `r3` with `r1`") != std::string::npos);
}

TEST_CASE("constants: a declared variable declares no object where the sort has others") {
  const std::string text =
      "sort guest\nguest Visitor\npredicate Knows(guest,guest)\nguest guest1, guest2\n"
      "[guest1,guest2] Knows(guest1,guest2).\n";
  const CheckedText checked(text);
  REQUIRE(checked.model);
  CHECK(checked.places() == Strings{"W2011 4:7-12", "W2011 4:15-20"});
  CHECK(checked.text().find("fix:") == std::string::npos);
  CHECK(checked.model->sorts[*checked.model->find_sort("guest")].constants.size() == 1);
  // Whatever the order, and where the objects are of a sort below.
  CHECK(places("sort guest\nguest guest1\nguest Visitor\n") == Strings{"W2011 2:7-12"});
  CHECK(places("sort guest\nsort friend: guest\nfriend Ann\nguest guest1\n") ==
        Strings{"W2011 4:7-12"});
}

TEST_CASE("constants: a misspelt keyword is recognised") {
  const CheckedText checked("sorts agent\n");
  CHECK(checked.codes() == Strings{"E2001"});
  CHECK(checked.text().find("fix: replace `sorts` with `sort`") != std::string::npos);
}

TEST_CASE("symbols: their kind follows from the sort, sorts of arguments are resolved") {
  const CheckedText checked(
      std::string(kTime) +
      "sort cup\nsort len: integer\nrange len 0 5\nreified sort belief\ncup C1\n"
      "fluent Filled(cup)\nevent Fill(cup)\npredicate Ab(cup,time)\nfunction Size(cup): len\n"
      "belief BFilled(cup)\nreified sort relation: fluent\nrelation Near(cup,cup)\n");
  REQUIRE_MESSAGE(checked.model, checked.text());
  const auto& model = *checked.model;
  const auto symbol = [&](const char* name) -> const compiler::Symbol& {
    return model.symbols[*model.find_symbol(name)];
  };
  CHECK(symbol("Filled").kind == SymbolKind::kFluent);
  CHECK(symbol("Fill").kind == SymbolKind::kEvent);
  CHECK(symbol("Ab").kind == SymbolKind::kPredicate);
  CHECK_FALSE(symbol("Ab").result);
  CHECK(symbol("Ab").arguments.size() == 2);
  CHECK(symbol("Size").kind == SymbolKind::kFunction);
  CHECK(model.sorts[*symbol("Size").result].name == "len");
  CHECK(symbol("BFilled").kind == SymbolKind::kReified);
  CHECK(symbol("Near").kind == SymbolKind::kFluent);
  CHECK(model.sorts[*symbol("Near").result].name == "relation");
  CHECK(model.core.happens == model.find_symbol("Happens"));
  CHECK(model.core.anti_trajectory.has_value());
}

TEST_CASE("symbols: contradictory and malformed declarations") {
  CHECK(places(std::string(kTime) + "fluent F()\nevent F()\n") == Strings{"E2002 3:7-7"});
  CHECK(places("predicate P(nosort)\n") == Strings{"E2001 1:13-18"});
  CHECK(places("predicate p()\n") == Strings{"E1017 1:11-11"});
  CHECK(places("sort cup\ncup C(cup)\n") == Strings{"E2005 2:5-5"});
  CHECK(places("sort cup\ncup C\nfunction F(cup)\n") == Strings{"E2009 3:10-10"});
  CHECK(places(std::string(kTime) + "sort cup\ncup C\nfluent F(cup): cup\n") ==
        Strings{"E2009 4:16-18"});
  CHECK(places("predicate Happens(time)\n") == Strings{"E2002 1:11-17"});
  CHECK(CheckedText("predicate Happens(time)\n").text().find("foundations/EC.e:") !=
        std::string::npos);
}

TEST_CASE("symbols: the same declaration again is a warning, another one an error") {
  const std::string model = std::string(kTime) + "sort a\na A\nfluent F(a)\nfunction G(a): a\n";
  CHECK(places(model + "fluent F(a)\n") == Strings{"W2012 6:8-8"});
  CHECK(places(model + "function G(a): a\n") == Strings{"W2012 6:10-10"});
  CHECK(places(model + "fluent F(a,a)\n") == Strings{"E2002 6:8-8"});
  CHECK(places(model + "event F(a)\n") == Strings{"E2002 6:7-7"});
}

TEST_CASE("foundations: a model may declare what they declare, with one warning a file") {
  const std::string root = "sort boolean\nsort integer\nreified sort predicate\n";
  const std::string calculus =
      "sort time: integer\nsort offset: integer\nreified sort fluent\nreified sort event\n"
      "predicate Happens(event,time)\npredicate HoldsAt(fluent,time)\nfluent fluent2\n";
  CHECK(places(root + calculus + "range time 0 1\n") == Strings{"W2010 1:6-12", "W2011 10:8-14"});
  CHECK(places(root + "load foundations/EC.e\n") == Strings{"W2010 1:6-12"});
  CHECK(places("sort integer\nsort time\npredicate HoldsAt(fluent)\n") ==
        Strings{"W2010 1:6-12", "E2002 3:11-17"});
}

TEST_CASE("symbols: terms that could nest without end are refused") {
  CHECK(places("reified sort belief\nbelief BNot(belief)\n") == Strings{"E2010 2:8-19"});
  CHECK(places("reified sort a\nreified sort b\na A(b)\nb B(a)\n").size() == 1);
  CHECK(places(std::string(kTime) + "fluent Meta(fluent)\n") == Strings{"E2010 2:8-19"});
  CHECK(places("reified sort a\nreified sort b: a\nb B(a)\n") == Strings{"E2010 3:3-6"});
  CHECK(places("reified sort a\nreified sort b\nsort c\nc C\na A(b)\nb B(c)\n").empty());
}

TEST_CASE("ranges: accumulate, need an integer sort and ordered bounds") {
  const CheckedText checked("sort v: integer\nrange v 0 2\nrange v -9 -7\n");
  REQUIRE(checked.model);
  CHECK(checked.model->sorts[*checked.model->find_sort("v")].ranges.size() == 2);
  CHECK(places("sort a\nrange a 0 1\n") == Strings{"E2007 2:7-7"});
  CHECK(places("range time 3 0\n") == Strings{"E2008 1:1-14"});
  CHECK(places("range tme 0 3\n") == Strings{"E2001 1:7-9"});
  CHECK(places("range time 0 1\nrange time 0 3\n") == Strings{"W2008 2:1-14"});
}

TEST_CASE("ranges: an integer sort that is used needs one, reported once") {
  CHECK(places("sort v: integer\npredicate P(v)\n[v,v1] P(v) & P(v1).\n") ==
        Strings{"E2113 3:2-2"});
  CHECK(places("sort v: integer\npredicate P(v)\n") == Strings{});
  CHECK(places("fluent F()\n") == Strings{"E2113 1:8-10"});
  CHECK(places("sort v: integer\nsort w: v\nrange w 0 1\npredicate P(v)\n[v] P(v).\n").empty());
  const CheckedText part("fluent F()\n", {.complete_model = false});
  CHECK(part.codes() == Strings{"W2003"});
  CHECK(part.model);
}

TEST_CASE("the range of time may come from outside, and overrides the model's") {
  const auto time = [](const std::string& text, const compiler::CheckOptions& options) {
    const CheckedText checked(text, options);
    REQUIRE_MESSAGE(checked.model, checked.text());
    const auto& ranges = checked.model->sorts[*checked.model->find_sort("time")].ranges;
    REQUIRE(ranges.size() == 1);
    return std::pair(ranges[0].lower, ranges[0].upper);
  };
  CHECK(time("fluent F()\n", {.time_upper = 7}) == std::pair<std::int64_t, std::int64_t>(0, 7));
  CHECK(time("range time 1 3\n", {.time_upper = 7}) == std::pair<std::int64_t, std::int64_t>(1, 7));
  CHECK(time("range time 1 3\n", {.time_lower = 2}) == std::pair<std::int64_t, std::int64_t>(2, 3));
  CHECK(CheckedText("range time 5 9\n", {.time_upper = 2}).codes() == Strings{"E2008"});
  CHECK(CheckedText("fluent F()\n", {.time_lower = 2}).codes() == Strings{"E2113"});
}

TEST_CASE("options: those with a meaning are kept, wrong ones are located") {
  const CheckedText checked(
      "option encoding 3\noption trajectory on\noption manualrelease on\noption renaming off\n"
      "option timediff off\noption modeldiff on\noption showpred off\noption debug off\n"
      "option solver relsat\noption finalstatefile x.e\noption tmpfilerm on\n"
      "range time 0 1\nfluent F()\n");
  REQUIRE_MESSAGE(checked.model, checked.text());
  const auto& options = checked.model->options;
  CHECK(options.encoding == 3);
  CHECK((options.trajectory && options.manual_release && options.model_diff));
  CHECK_FALSE((options.renaming || options.time_diff || options.show_predicates));
  CHECK(checked.model->symbols[*checked.model->find_symbol("F")].manual_release);
  CHECK_FALSE(options.founded.has_value());
  CHECK(CheckedText("option founded on\nrange time 0 1\n").model->options.founded.has_value());
  CHECK_FALSE(CheckedText("option founded on\noption founded off\nrange time 0 1\n")
                  .model->options.founded.has_value());
  CHECK(places("option founded yes\n") == Strings{"E2012 1:16-18"});
  CHECK(places("option encodin 2\n") == Strings{"E2011 1:8-14"});
  CHECK(places("option encoding 4\n") == Strings{"E2012 1:17-17"});
  CHECK(places("option debug yes\n") == Strings{"E2012 1:14-16"});
  CHECK(places("option weighted on\n") == Strings{"E2012 1:17-18"});
}

TEST_CASE("noninertial and manualrelease mark fluents and nothing else") {
  const std::string model = std::string(kTime) + "fluent F()\nfluent G()\nevent E()\n";
  const CheckedText checked(model + "noninertial F\nmanualrelease G\n");
  REQUIRE(checked.model);
  const auto& symbols = checked.model->symbols;
  CHECK(symbols[*checked.model->find_symbol("F")].noninertial);
  CHECK_FALSE(symbols[*checked.model->find_symbol("F")].manual_release);
  CHECK(symbols[*checked.model->find_symbol("G")].manual_release);
  CHECK(places(model + "noninertial E\n") == Strings{"E2013 5:13-13"});
  CHECK(places(model + "noninertial Ff\n") == Strings{"E2101 5:13-14"});
}

TEST_CASE("completion: with and without label; a label without formulas is suspicious") {
  const std::string model = std::string(kTime) + "event E()\nDelta: Happens(E(),0).\n";
  const CheckedText checked(model + "completion Delta Happens\ncompletion Happens\n");
  REQUIRE(checked.model);
  REQUIRE(checked.model->completions.size() == 2);
  CHECK(checked.model->completions[0].label == "Delta");
  CHECK_FALSE(checked.model->completions[1].label);
  CHECK(places(model + "completion Theta Happens\n") == Strings{"W2005 4:1-24"});
  CHECK(places(model + "completion Hapens\n") == Strings{"E2101 4:12-17"});
  CHECK(places(model + "completion E\n") == Strings{"E2013 4:12-12"});
  CHECK(CheckedText(model + "completion Initiates\n").model->completions.empty());
}

TEST_CASE("ignore: formulas go wherever they stand, declarations and lists from there on") {
  const CheckedText checked(
      std::string(kTime) +
      "fluent F()\nfluent G()\n!HoldsAt(F(),0).\nignore G, H, C\nHoldsAt(G(),0).\n"
      "fluent H(nosort)\nsort a\na C\n!HoldsAt(G(),1).\nnoninertial G, F\nmutex G, F\n");
  REQUIRE_MESSAGE(checked.model, checked.text());
  CHECK(checked.model->find_symbol("G"));
  CHECK_FALSE(checked.model->find_symbol("H"));
  CHECK_FALSE(checked.model->find_object("C"));
  CHECK_FALSE(checked.model->symbols[*checked.model->find_symbol("G")].noninertial);
  CHECK(checked.model->axioms.size() == 1);
}

TEST_CASE("mutex: one axiom a pair, the n-th arguments of a sort shared, time added") {
  const CheckedText checked(
      std::string(kTime) +
      "sort agent\nagent A\nfluent F(agent)\nevent E(agent)\n"
      "event M(agent,agent)\npredicate P(agent)\nmutex F, E, M\nmutex E, P\n");
  REQUIRE_MESSAGE(checked.model, checked.text());
  Strings axioms;
  for (const auto& axiom : checked.model->axioms) {
    axioms.push_back(TypedText(*checked.model).axiom(axiom));
  }
  CHECK(axioms == Strings{"[agent,time ](!HoldsAt(F(agent),time ) | !Happens(E(agent),time ))",
                          "[agent1,time ,agent2](!HoldsAt(F(agent1),time ) | "
                          "!Happens(M(agent1,agent2),time ))",
                          "[agent1,time ,agent2](!Happens(E(agent1),time ) | "
                          "!Happens(M(agent1,agent2),time ))",
                          "[agent,time ](!Happens(E(agent),time ) | !P(agent))"});
}

TEST_CASE("xor: adds that at least one is true, and tells a time argument from the moment") {
  const CheckedText checked(std::string(kTime) + "fluent At(time)\nfluent F()\nxor At, F\n");
  REQUIRE_MESSAGE(checked.model, checked.text());
  Strings axioms;
  for (const auto& axiom : checked.model->axioms) {
    axioms.push_back(TypedText(*checked.model).axiom(axiom));
  }
  CHECK(axioms == Strings{"[time,time ](!HoldsAt(At(time),time ) | !HoldsAt(F(),time ))",
                          "[time,time ](HoldsAt(At(time),time ) | HoldsAt(F(),time ))"});
  CHECK(places(std::string(kTime) + "event E()\nmutex E, F\n") == Strings{"E2101 3:10-10"});
  CHECK(places("sort a\na A\nfunction F(a): a\npredicate P()\nmutex F, P\n") ==
        Strings{"E2013 5:7-7"});
  CHECK(places("load foundations/Root.e\nreified sort fluent\nfluent F()\nfluent G()\n"
               "mutex F, G\n") == Strings{"E2305 5:7-7", "E2305 5:10-10"});
}

}  // namespace
}  // namespace parallax::test
