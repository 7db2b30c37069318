// The digits by which engines are told apart, on processors and in builds.

#include "harness/engine/engine_arithmetic.h"

#include <set>

#include "tests/harness/engine/engines.h"

namespace parallax::harness {
namespace {

TEST_CASE("an engine's digits are the same each time, and another engine's are others") {
  std::set<std::string> seen;
  for (const auto engine : engines()) {
    const auto digits = engine_digits(engine);
    CAPTURE(digits);
    CHECK(digits.size() == 16);
    CHECK(engine_digits(engine) == digits);
    CHECK(seen.insert(digits).second);
  }
}

}  // namespace
}  // namespace parallax::harness
