// Every diagnostic of the front end can happen: one text for each code.

#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

struct Case {
  const char* code;
  std::string text;
};

std::string repeated(std::string_view piece, std::size_t count) {
  std::string out;
  for (std::size_t i = 0; i < count; ++i) out += piece;
  return out;
}

std::vector<Case> cases() {
  const std::string world =
      "range time 0 2\nrange offset 1 1\nsort a\na A\nfluent F(a)\nevent E()\npredicate P(a)\n";
  return {
      {"E1001", "P(A) $ Q(A).\n"},
      {"E1002", "range time 0 99999999999999999999\n"},
      {"E1003", "P(A) & .\n"},
      {"E1004", "P(A) P(A).\n"},
      {"E1005", "P((A).\n"},
      {"E1006", "P(A)).\n"},
      {"E1007", "P(A)\nsort b\n"},
      {"E1008", "1<2<3.\n"},
      {"E1009", repeated("!", 30'000) + "P()."},
      {"E1010", "range time\n"},
      {"E1011", "sort a.\n"},
      {"E1012", "sort Agent\n"},
      {"E1020", "P(A) => P(A).\n"},
      {"E1013", "[] P().\n"},
      {"E1025", world + "count{a: 1: P(a)}>0.\n"},
      {"E2115", world + "count{a: P(a)}.\n"},
      {"E2116", world + "[time] count{a: Initiates(E(),F(a),time)}>0 -> P(A).\n"},
      {"E1014", "load nowhere/nothing.e\n"},
      {"E1017", "sort a\na 3\n"},
      {"W1101", "sort a\na A\n[a]\na = A.\n"},
      {"E2001", "nosuchsort A\n"},
      {"E2002", "sort a\nreified sort a\n"},
      {"E2003", "sort a: a\n"},
      {"E2004", "fluent F\n"},
      {"E2005", "sort a\na A(a)\n"},
      {"E2006", "sort v: integer\nv V\n"},
      {"E2007", "sort a\nrange a 0 1\n"},
      {"E2008", "range time 1 0\n"},
      {"E2009", "sort a\nfunction G(a)\n"},
      {"E2010", "fluent F(fluent)\n"},
      {"E2011", "option colour on\n"},
      {"E2012", "option renaming perhaps\n"},
      {"E2013", world + "noninertial E\n"},
      {"E2014", "sort a, b\na A\nb A\n"},
      {"E2101", "R(A).\n"},
      {"E2102", world + "P(x).\n"},
      {"E2103", world + "[y] P(y).\n"},
      {"E2104", world + "P(A,A).\n"},
      {"E2105", world + "P(E()).\n"},
      {"E2106", world + "F(A).\n"},
      {"E2107", world + "P(P(A)).\n"},
      {"E2108", world + "A<3.\n"},
      {"E2109", world + "A=3.\n"},
      {"E2110", world + "Happens(E(),5).\n"},
      {"E2111", world + "[time] time=0.5.\n"},
      {"E2112", world + "[time] time^2=1.\n"},
      {"E2113", "fluent F()\n"},
      {"E2114", "predicate P()\n" + repeated("P().\n", 510'000)},
      {"E2301", world + "[time] P(A) | Initiates(E(),F(A),time).\n"},
      {"E2303", world + "[time,offset] Trajectory(F(A),time,F(A),offset) -> P(A).\n"},
      {"E2304", world + "function G(a): a\na B\nG(A)=A.\nG(A)=B.\n"},
      {"E2305", "load foundations/Root.e\nreified sort event\nevent E()\nevent D()\nmutex E, D\n"},
      {"W2001", world + "Initiates(E(),F(A),0).\n"},
      {"W2002", world + "sort b\n{b} P(A).\n"},
      {"W2004", world + "function G(a): time\nG(A)=9.\n"},
      {"W2005", world + "completion Delta Happens\n"},
      {"W2006", world + "3: P(A).\n"},
      {"W2007", "sort a, b\nsort c: a\nsort c: b\n"},
      {"W2008", "range time 0 1\nrange time 0 2\n"},
      {"W2012", "sort a\nsort a\n"},
      {"W2010", "sort time: integer\n"},
      {"W2011", "fluent fluent2\n"},
  };
}

Strings codes_of_formula(std::string text) {
  CheckedText model("range time 0 2\nfluent F()\nevent E()\n");
  FrontEnd front;
  const auto file = front.add(std::move(text));
  const auto parsed = compiler::parse_formula(file, front.files, front.sink);
  if (parsed) {
    const auto checked =
        compiler::check_formula(*model.model, parsed->ast, parsed->root, {}, front.sink);
    CHECK_FALSE(checked);
  }
  return front.codes();
}

Strings codes_of_property(std::string text) {
  CheckedText model("range time 0 2\nfluent F()\nevent E()\n");
  FrontEnd front;
  const auto file = front.add(std::move(text));
  const base::SourceRange whole{file, 0,
                                static_cast<std::uint32_t>(front.files[file].text().size())};
  const auto parsed = compiler::parse_temporal_formula(whole, front.files, front.sink);
  if (parsed) {
    const auto checked =
        compiler::check_formula(*model.model, parsed->ast, parsed->root, {}, front.sink);
    CHECK_FALSE(checked);
  }
  return front.codes();
}

Strings codes_of_load(std::string_view line) {
  std::string pattern = (fs::temp_directory_path() / "parallax-XXXXXX").string();
  REQUIRE(::mkdtemp(pattern.data()) != nullptr);
  const fs::path folder(pattern);
  fs::create_directory(folder / "dir.e");
  std::ofstream(folder / "main.e") << line;
  FrontEnd front;
  const std::vector<fs::path> main = {folder / "main.e"};
  const bool loaded = bool(compiler::load_model(main, {}, front.files, front.sink));
  CHECK(loaded == !front.sink.has_errors());
  fs::remove_all(folder);
  return front.codes();
}

TEST_CASE("every code of the front end is produced by some text") {
  std::set<std::string> seen;
  const auto note = [&](const Strings& codes) { seen.insert(codes.begin(), codes.end()); };
  for (const auto& c : cases()) {
    CAPTURE(c.code);
    const CheckedText checked(c.text);
    const auto codes = checked.codes();
    CHECK(std::find(codes.begin(), codes.end(), c.code) != codes.end());
    CHECK((c.code[0] == 'W' || !checked.model));
    note(codes);
  }
  note(CheckedText("fluent F()\n", {.complete_model = false}).codes());  // W2003
  note(
      CheckedText("sort n: integer\nrange n 1 2\nfunction F(): n\nF()=1.\nF()=2.\nrange time 0 1\n",
                  {.old_reasoner = true})
          .codes());                                         // W2009
  note(codes_of_formula("F(). F()."));                       // E1018
  note(codes_of_formula("[time] Initiates(E(),F(),time)"));  // E2302
  note(codes_of_property(
      "HoldsAt(F(),time) until HoldsAt(F(),time) until HoldsAt(F(),time)"));  // E1021
  note(codes_of_formula("always HoldsAt(F(),time)"));                         // E1022
  note(codes_of_property("allways HoldsAt(F(),time)"));                       // E1023
  note(codes_of_property("[time] always HoldsAt(F(),time)"));                 // E2306
  note(codes_of_load("load dir.e\n"));                                        // E1015
  note(codes_of_load("load /etc/passwd\n"));                                  // E1016
  note(codes_of_load("load main.e\n"));                                       // W1019
  for (const auto& info : base::all_diagnostics()) {
    const bool mine = info.id[1] == '1' || info.id[1] == '2';
    // W21xx and W22xx are lint's, and tested there.
    const bool lint = info.id.starts_with("W21") || info.id.starts_with("W22");
    // Objectives are read when they are compiled: minimize_test.
    const bool objective = info.id == "E1024";
    if (mine && !lint && !objective) CHECK_MESSAGE(seen.contains(std::string(info.id)), info.id);
  }
}

}  // namespace
}  // namespace parallax::test
