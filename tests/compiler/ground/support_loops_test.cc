// Completed atoms that are reasons of each other.

#include <doctest/doctest.h>

#include "compiler/pipeline/compile.h"

namespace parallax::test {
namespace {

/// The places of W3060.
std::vector<std::uint32_t> loops(const std::string& model) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  compiler::CompileInput input;
  input.text = files.add("model.e", model);
  input.lint = true;
  REQUIRE_MESSAGE(compiler::compile_model(input, files, sink).has_value(), model);
  std::vector<std::uint32_t> out;
  for (const auto& one : sink.sorted()) {
    if (base::info(one.code).id == "W3060") {
      out.push_back(files[one.range->file].position(one.range->begin).line);
    }
  }
  return out;
}

using Lines = std::vector<std::uint32_t>;

const std::string kEvents = "range time 0 3\nfluent F()\nevent A()\nevent B()\n";

TEST_CASE("events that demand each other") {
  const std::string there = "[time] Happens(A(),time) -> Happens(B(),time).\n";
  CHECK(loops(kEvents + there +
              "[time] Happens(B(),time) -> Happens(A(),time).\n"
              "completion Happens\n") == Lines{5});
  CHECK(loops(kEvents + "[time] Happens(A(),time) <-> Happens(B(),time).\n"
                        "completion Happens\n") == Lines{5});
  // Not at once, not completed, or not both ways.
  CHECK(loops(kEvents + there +
              "[time] Happens(B(),time) -> Happens(A(),time+1).\n"
              "completion Happens\n")
            .empty());
  CHECK(loops(kEvents + there + "[time] Happens(B(),time) -> Happens(A(),time).\n").empty());
  CHECK(loops(kEvents + there + "completion Happens\n").empty());
  // The circle contradicts itself.
  CHECK(loops(kEvents + "[time] HoldsAt(F(),time) & Happens(A(),time) -> Happens(B(),time).\n"
                        "[time] !HoldsAt(F(),time) & Happens(B(),time) -> Happens(A(),time).\n"
                        "completion Happens\n")
            .empty());
  // Forth and back in time.
  CHECK(loops(kEvents + "[time] Happens(A(),time) -> Happens(B(),time+1).\n"
                        "[time] Happens(B(),time+1) -> Happens(A(),time).\n"
                        "completion Happens\n") == Lines{5});
}

TEST_CASE("ways that lead in circles") {
  const std::string rooms =
      "range time 0 1\nsort room\nroom R1, R2, R3\npredicate Door(room,room)\n"
      "predicate Way(room,room)\n[room1,room2] Door(room1,room2) -> Way(room1,room2).\n"
      "[room1,room2,room3] Way(room1,room2) & Door(room2,room3) -> Way(room1,room3).\n"
      "completion Door\ncompletion Way\n";
  CHECK(loops(rooms + "Door(R1,R2).\nDoor(R2,R3).\n").empty());
  // From R1 there is no door, and yet ways to R2 and R3 that are reasons of each other.
  CHECK(loops(rooms + "Door(R2,R3).\nDoor(R3,R2).\n") == Lines{7});
  // All ways are there anyway.
  CHECK(loops(rooms + "Door(R1,R2).\nDoor(R2,R3).\nDoor(R3,R1).\n").empty());
}

TEST_CASE("definitions that hold each other up") {
  const std::string head =
      "range time 0 1\npredicate P()\npredicate Q()\npredicate R()\nP() -> Q().\n";
  CHECK(loops(head + "Q() -> P().\ncompletion P\ncompletion Q\n") == Lines{5});
  CHECK(loops(head + "Q() & R() -> P().\ncompletion P\ncompletion Q\n") == Lines{5});
  CHECK(loops(head + "Q() & R() -> P().\ncompletion P\ncompletion Q\ncompletion R\n").empty());
  CHECK(loops(head + "Q() -> P().\nP().\ncompletion P\ncompletion Q\n").empty());
  CHECK(loops(head + "Q() -> P().\ncompletion P\n").empty());
  CHECK(loops(head + "!Q() -> P().\ncompletion P\ncompletion Q\n").empty());
  CHECK(loops(head + "Theta: Q() -> P().\nTheta: R() -> P().\ncompletion Theta P\ncompletion Q\n")
            .size() == 1);
  CHECK(
      loops(head + "Q() -> P().\nTheta: R() -> P().\ncompletion Theta P\ncompletion Q\n").empty());
}

}  // namespace
}  // namespace parallax::test
