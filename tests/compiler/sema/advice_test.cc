// Advice in messages: spellings of other languages, missing sorts and constants, wrong names.

#include <doctest/doctest.h>

#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

// Ten lines; what follows starts on line 11.
const std::string kHouse =
    "sort room\nroom Kitchen, Hall\nsort box\nfluent F()\nfluent G()\nfluent In(room)\n"
    "event Flip()\nevent Go(room)\nrange time 0 2\n\n";

std::string said(const std::string& text) { return CheckedText(kHouse + text).text(); }
Strings places_of(const std::string& text) { return CheckedText(kHouse + text).places(); }

bool says(const std::string& text, const std::string& part) {
  const auto all = said(text);
  CAPTURE(all);
  return all.find(part) != std::string::npos;
}

TEST_CASE("signs and words of other languages: one message with the right spelling") {
  struct Sample {
    const char* written;
    const char* right;
  };
  const auto formula = [](const std::string& sign) {
    return "[time] HoldsAt(F(),time) " + sign + " HoldsAt(G(),time).\n";
  };
  for (const auto& [written, right] :
       {Sample{"=>", "->"}, Sample{"==>", "->"}, Sample{"-->", "->"}, Sample{"implies", "->"},
        Sample{"<=>", "<->"}, Sample{"iff", "<->"}, Sample{"and", "&"}, Sample{"&&", "&"},
        Sample{"/\\", "&"}, Sample{"or", "|"}, Sample{"||", "|"}, Sample{"\\/", "|"},
        Sample{",", "&"}, Sample{"\xE2\x88\xA7", "&"}, Sample{"\xE2\x86\x92", "->"}}) {
    CAPTURE(written);
    CHECK(CheckedText(kHouse + formula(written)).codes() == Strings{"E1020"});
    CHECK(
        says(formula(written), std::string("fix: replace `") + written + "` with `" + right + "`"));
    CHECK(CheckedText(kHouse + formula(right)).codes().empty());
  }
  for (const auto* equal : {"==", "<>", "~=", "\xE2\x89\xA0"}) {
    CAPTURE(equal);
    const auto text = std::string("[room1,room2] room1 ") + equal + " room2 -> room1=Hall.\n";
    CHECK(CheckedText(kHouse + text).codes() == Strings{"E1020"});
  }
  for (const auto* no : {"not ", "~", "\xC2\xAC", "not(", "not !"}) {
    CAPTURE(no);
    const auto closing = std::string(no).ends_with("(") ? ")" : "";
    const auto text =
        std::string("[time] ") + no + "HoldsAt(F(),time)" + closing + " -> Happens(Flip(),time).\n";
    CHECK(CheckedText(kHouse + text).codes() == Strings{"E1020"});
  }
}

TEST_CASE("a word of another language at the start of a line is no declaration") {
  CHECK(places_of("not HoldsAt(F(),0).\n") == Strings{"E1020 11:1-3"});
  CHECK(places_of("HoldsAt(F(),0)\nand HoldsAt(G(),0).\n") == Strings{"E1020 12:1-3"});
  CHECK(places_of("forall time HoldsAt(F(),time).\n") == Strings{"E1020 11:1-6"});
  CHECK(places_of("exists room (HoldsAt(In(room),0)).\n") == Strings{"E1020 11:1-6"});
  // A sort may be called so.
  CHECK(CheckedText("sort not\nnot A, B\nsort and\nand C\npredicate P(not)\n[not] P(not).\n")
            .codes()
            .empty());
}

TEST_CASE("comments of other languages: one message each, the rest of the line is passed over") {
  CHECK(places_of("% a comment, (unbalanced\nHoldsAt(F(),0).\n") == Strings{"E1020 11:1-1"});
  CHECK(places_of("// a comment, (unbalanced\n// another\nrange time 5 6\n") ==
        Strings{"E1020 11:1-2", "E1020 12:1-2", "W2008 13:1-14"});
  CHECK(places_of("HoldsAt(F(),0). % so\nHoldsAt(G(),0). # and so\n") ==
        Strings{"E1020 11:17-17", "E1020 12:17-17"});
  CHECK(places_of("HoldsAt(F(),0) &\n% in between\nHoldsAt(G(),0).\n") == Strings{"E1020 12:1-1"});
  CHECK(says("room Cellar % down there\n", "fix: begin the comment with `;`"));
  // A remainder stays one.
  CHECK(CheckedText(kHouse + "[time] time % 2 = 0 -> HoldsAt(F(),time).\n").codes().empty());
}

TEST_CASE("a sort that cannot be called so is reported once, not at every use") {
  const std::string model =
      "sort Robot\nRobot R1, R2\nfluent At(Robot)\nevent Drive(Robot)\n"
      "[Robot,time] Initiates(Drive(Robot),At(Robot),time).\nHoldsAt(At(R1),0).\n";
  CHECK(places_of(model) == Strings{"E1012 11:6-10"});
  CHECK(says(model, "fix: write `robot` wherever the sort is named"));
  CHECK(places_of("sort bigBox\nbigBox B1\npredicate P(bigBox)\nP(B1).\n") ==
        Strings{"E1012 11:6-11"});
}

TEST_CASE("a symbol that cannot be called so is reported once, with the name that it can have") {
  CHECK(places_of("event go(room)\n[room,time] Initiates(go(room),In(room),time).\n") ==
        Strings{"E1017 11:7-8"});
  CHECK(says("event go(room)\n", "`go` cannot name an event"));
  CHECK(says("event go(room)\n", "fix: replace `go` with `Go`"));
  CHECK(says("sort lane\nlane lane3\n", "fix: replace `lane3` with `Lane3`"));
}

TEST_CASE("a constant that is not declared: those of its sort are listed") {
  const std::string list = "note: the constants of `room`: `Kitchen`, `Hall`\n";
  CHECK(says("HoldsAt(In(Garage),0).\n", list));
  CHECK(says("HoldsAt(In(Kichen),0).\n", list));
  CHECK(says("[room] room=Garage -> HoldsAt(In(room),0).\n", list));
  CHECK(says("[room] Garage!=room -> HoldsAt(In(room),0).\n", list));
  CHECK_FALSE(says("predicate P(box)\nP(Garage).\n", "the constants of"));
  std::string many = "box B1";
  for (int i = 2; i <= 30; ++i) many += ",B" + std::to_string(i);
  CHECK(says(many + "\npredicate P(box)\nP(Garage).\n", "`B10` and 20 more"));
}

TEST_CASE("a variable whose name is no sort: the place where it stands says which it needs") {
  const std::string short_name = "[r,time] HoldsAt(In(r),time) -> Happens(Go(r),time).\n";
  CHECK(places_of(short_name) == Strings{"E2103 11:2-2"});
  CHECK(says(short_name, "fix: write `room` or `room1` for `r`"));
  CHECK(says("[q,time] HoldsAt(F(),time).\n", "help: A variable gets its sort from its name"));
  CHECK(places_of("[Room,time] HoldsAt(In(Room),time).\n") == Strings{"E2103 11:2-5"});
}

TEST_CASE("the range of time may come from the horizon, and messages say so") {
  const std::string model = "fluent F()\nHoldsAt(F(),7).\n[time] HoldsAt(F(),time).\n";
  const auto without = CheckedText(model).text();
  CHECK(without.find("or give the last timepoint with --horizon 10") != std::string::npos);
  compiler::CheckOptions options;
  options.time_lower = 0;
  options.time_upper = 3;
  const auto with = CheckedText(model, options).text();
  CHECK(with.find("note: the timepoints are 0 to 3, as the horizon says") != std::string::npos);
  CHECK(with.find("EC.e") == std::string::npos);
}

}  // namespace
}  // namespace parallax::test
