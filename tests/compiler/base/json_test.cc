#include "compiler/base/json.h"

#include <doctest/doctest.h>

namespace parallax::base {
namespace {

using Json = nlohmann::ordered_json;

TEST_CASE("documents are written whatever bytes their texts hold") {
  CHECK(json_text(Json{{"b", 1}, {"a", "x"}}) == R"({"b":1,"a":"x"})");
  CHECK(json_text(Json{{"a", "\xFF"}}) == "{\"a\":\"\xEF\xBF\xBD\"}");
  CHECK(json_text(Json{{"a", 1}}, 2) == "{\n  \"a\": 1\n}");
  CHECK(json_quoted("a\"b\\\n\x01") == R"("a\"b\\\n\u0001")");
  CHECK(json_quoted("\xC3") == "\"\xEF\xBF\xBD\"");
  CHECK(json_quoted("\x7F \xC2\x9B \xE2\x80\xAE \xC3\xA9") ==
        "\"\\u007f \\u009b \\u202e \xC3\xA9\"");
}

TEST_CASE("a value is what it is, or nothing") {
  CHECK(json_as<std::string>(Json("a")) == "a");
  CHECK(json_as<bool>(Json(true)) == true);
  CHECK(json_as<double>(Json(1.5)) == 1.5);
  CHECK(json_as<double>(Json(2)) == 2.0);
  CHECK(json_as<std::int64_t>(Json(-2)) == -2);
  CHECK(json_as<std::uint64_t>(Json(UINT64_MAX)) == UINT64_MAX);
  CHECK_FALSE(json_as<std::string>(Json(1)));
  CHECK_FALSE(json_as<bool>(Json(1)));
  CHECK_FALSE(json_as<double>(Json("1")));
  CHECK_FALSE(json_as<double>(Json(nullptr)));
  CHECK_FALSE(json_as<std::int64_t>(Json(1.0)));
  CHECK_FALSE(json_as<std::int64_t>(Json(UINT64_MAX)));
  CHECK_FALSE(json_as<std::uint64_t>(Json(-1)));
}

TEST_CASE("members of objects") {
  const Json object = {{"a", 1}, {"n", nullptr}};
  REQUIRE(json_member(object, "a") != nullptr);
  CHECK(*json_member(object, "a") == 1);
  CHECK(json_member(object, "n")->is_null());
  CHECK(json_member(object, "b") == nullptr);
  CHECK(json_member(Json::array({1}), "a") == nullptr);
  CHECK(json_member(Json("a"), "a") == nullptr);
}

}  // namespace
}  // namespace parallax::base
