// The axioms of the calculus written out, as old models do.

#include "compiler/sema/calculus_axioms.h"

#include <doctest/doctest.h>

#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

constexpr const char* kCalculusWorld = "range time 0 2\nrange offset 1 1\nfluent F()\nevent E()\n";

/// The codes that were reported, then the number of axioms that are left.
std::string left(const std::string& formulas) {
  const CheckedText checked(kCalculusWorld + formulas);
  std::string out;
  for (const auto& code : checked.codes()) out += code + " ";
  return out + (checked.model ? std::to_string(checked.model->axioms.size()) : "refused");
}

TEST_CASE("DEC5 to DEC12 are left out, in whatever way they are written") {
  CHECK(left("[fluent,time] HoldsAt(fluent,time) & !ReleasedAt(fluent,time+1) &\n"
             "!({event} Happens(event,time) & Terminates(event,fluent,time)) ->\n"
             "HoldsAt(fluent,time+1).\n") == "W2010 0");
  CHECK(
      left(
          "[time1,fluent] (!({event3} Initiates(event3,fluent,time1) & Happens(event3,time1)) &\n"
          "!HoldsAt(fluent,time1) & !ReleasedAt(fluent,1+time1)) -> !HoldsAt(fluent,time1+1).\n") ==
      "W2010 0");
  CHECK(left("[fluent,time] ReleasedAt(fluent,time) & !({event} Happens(event,time) &\n"
             "(Initiates(event,fluent,time) | Terminates(event,fluent,time))) ->\n"
             "ReleasedAt(fluent,time+1).\n") == "W2010 0");
  CHECK(left("[fluent,time] !ReleasedAt(fluent,time) &\n"
             "!({event} Happens(event,time) & Releases(event,fluent,time)) ->\n"
             "!ReleasedAt(fluent,time+1).\n") == "W2010 0");
  CHECK(left("[event,fluent,time] Happens(event,time) & Initiates(event,fluent,time) ->\n"
             "HoldsAt(fluent,time+1) & !ReleasedAt(fluent,time+1).\n") == "W2010 0");
  CHECK(left("[event,fluent,time] Happens(event,time) -> (Terminates(event,fluent,time) ->\n"
             "!HoldsAt(fluent,time+1)).\n"
             "[event,fluent,time] Happens(event,time) & Releases(event,fluent,time) ->\n"
             "ReleasedAt(fluent,time+1).\n") == "W2010 0");
}

TEST_CASE("DEC3 and DEC4 are left out with the usual intervals, and refused with others") {
  const std::string dec3 =
      "predicate Clipped(time,fluent,time)\n"
      "[event,fluent,fluent2,offset,time] Happens(event,time) & Initiates(event,fluent,time) &\n"
      "0 < offset & Trajectory(fluent,time,fluent2,offset) &\n"
      "!Clipped(time,fluent,time+offset) -> HoldsAt(fluent2,time+offset).\n";
  CHECK(left(dec3) == "W2010 0");
  CHECK(left(dec3 + "[time1,fluent,time2] Clipped(time1,fluent,time2) <-> ({event,time}\n"
                    "Happens(event,time) & Terminates(event,fluent,time) & time1<=time & "
                    "time2>time).\n") == "W2010 1");
  CHECK(left(dec3 + "[time1,fluent,time2] Clipped(time1,fluent,time2) <-> ({event,time}\n"
                    "Happens(event,time) & Releases(event,fluent,time) & time1<=time & "
                    "time2>time).\n") == "E2303 refused");
}

TEST_CASE("formulas that look like the axioms and say something else stay") {
  // Another timepoint, another effect, a sort of some events only, a constant, two variables in
  // one.
  CHECK(left("[event,fluent,time] Happens(event,time) & Initiates(event,fluent,time) ->\n"
             "HoldsAt(fluent,time).\n") == "1");
  CHECK(left("[event,fluent,time] Happens(event,time) & Releases(event,fluent,time) ->\n"
             "HoldsAt(fluent,time+1).\n") == "1");
  CHECK(left("[event,fluent,time] Happens(event,time) | Initiates(event,fluent,time) ->\n"
             "HoldsAt(fluent,time+1).\n") == "1");
  CHECK(left("[fluent,fluent1,event,time] Happens(event,time) & Initiates(event,fluent,time) ->\n"
             "HoldsAt(fluent1,time+1).\n") == "1");
  CHECK(left("[fluent,time] HoldsAt(fluent,time) &\n"
             "!({event} Happens(event,time) & Terminates(event,fluent,time)) ->\n"
             "HoldsAt(fluent,time+1).\n") == "1");
}

}  // namespace
}  // namespace parallax::test
