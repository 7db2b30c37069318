#include "compiler/base/hash.h"

#include <doctest/doctest.h>

#include <string>

namespace parallax::base {
namespace {

TEST_CASE("FNV-1a with 64 bits has its published values") {
  CHECK(fnv1a64("") == 0xcbf29ce484222325U);
  CHECK(fnv1a64("a") == 0xaf63dc4c8601ec8cU);
  CHECK(fnv1a64("foobar") == 0x85944171f73967e8U);
  CHECK(fnv1a64(std::string("\0", 1)) == 0xaf63bd4c8601b7dfU);
}

TEST_CASE("pieces of a text have the hash of the whole, and bytes have no sign") {
  CHECK(fnv1a64("bar", fnv1a64("foo")) == fnv1a64("foobar"));
  CHECK(fnv1a64("\xFF") == (kFnvStart ^ 0xFFU) * kFnvPrime);
}

TEST_CASE("a word is one step whose high bits come down") {
  CHECK(fnv1a64_word(0, 0) == 0);
  CHECK(fnv1a64_word(0, 1) == (kFnvPrime ^ (kFnvPrime >> 29U)));
  // A plain step would leave the low bits of both alike.
  CHECK((fnv1a64_word(kFnvStart, std::uint64_t{1} << 63U) & 0xFFFFFFFFFFU) !=
        (fnv1a64_word(kFnvStart, 0) & 0xFFFFFFFFFFU));
}

}  // namespace
}  // namespace parallax::base
