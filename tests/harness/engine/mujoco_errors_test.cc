// An error of the engine comes back as an exception that begins outside of the engine.

#include "harness/engine/mujoco_errors.h"

#include <doctest/doctest.h>

#include <string>

#include "harness/engine/mujoco_engine.h"

namespace parallax::harness {
namespace {

TEST_CASE("an error ends the call that is asked, and the next one is answered") {
  for (int i = 0; i < 3; ++i) {
    CHECK_THROWS_WITH_AS(ask_engine([] { leave_engine("Stack overflow"); }), "Stack overflow",
                         EngineFault);
    int answer = 0;
    ask_engine([&] { answer = 7; });
    CHECK(answer == 7);
  }
}

TEST_CASE("a long message is cut") {
  static const std::string kLong(5000, 'x');
  try {
    ask_engine([] { leave_engine(kLong.c_str()); });
    FAIL_CHECK("it came back");
  } catch (const EngineFault& fault) {
    CHECK(kLong.starts_with(fault.what()));
    CHECK(std::string(fault.what()).size() > 1000);
  }
}

}  // namespace
}  // namespace parallax::harness
