#include "harness/law/expression.h"

#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "compiler/base/source_file.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

using Kind = Expression::Kind;

double value_of(const std::string& text, const std::map<std::string, double>& values,
                Kind kind = Kind::kNumber) {
  base::DiagnosticSink sink;
  const auto expression = Expression::parse(
      text, kind, {base::FileId(0), 0, static_cast<std::uint32_t>(text.size())}, sink);
  REQUIRE(expression.has_value());
  std::vector<double> arguments;
  for (const auto& name : expression->names()) arguments.push_back(values.at(name.text));
  return expression->value(arguments);
}

bool holds(const std::string& text, const std::map<std::string, double>& values) {
  return value_of(text, values, Kind::kTruth) == 1.0;
}

/// "7: message" of the one error, with the offset at which it begins.
std::string error_of(const std::string& text, Kind kind = Kind::kNumber) {
  base::DiagnosticSink sink;
  CHECK_FALSE(Expression::parse(text, kind,
                                {base::FileId(0), 0, static_cast<std::uint32_t>(text.size())}, sink)
                  .has_value());
  const auto reports = sink.sorted();
  REQUIRE(reports.size() == 1);
  return std::to_string(reports[0].range->begin) + ": " + reports[0].message;
}

TEST_CASE("formulas bind as written") {
  CHECK(value_of("0.2 + 1.03 * milk1.fill", {{"milk1.fill", 2.0}}) == 0.2 + 1.03 * 2.0);
  CHECK(value_of("1 - 2 - 3", {}) == -4.0);
  CHECK(value_of("8 / 4 / 2", {}) == 1.0);
  CHECK(value_of("2 ^ 3 ^ 2", {}) == 512.0);
  CHECK(value_of("-2 ^ 2", {}) == -4.0);
  CHECK(value_of("2 ^ -1", {}) == 0.5);
  CHECK(value_of("- - 3 * -(1 + 1)", {}) == -6.0);
  CHECK(value_of("1e-3 + 2.5E+2 + .5", {}) == 1e-3 + 2.5e2 + .5);
  CHECK(value_of("min(3, 1, 2) + max(1, 4) + abs(-2) + sqrt(9) + hypot(3, 4)", {}) == 15.0);
  CHECK(value_of("cos(0) + sin(0)", {}) == 1.0);
  CHECK(holds("not 1 < 2 or 3 > 2 and 1 <= 1", {}));
  CHECK_FALSE(holds("not (1 < 2 or 3 > 2) and 1 >= 1", {}));
  CHECK(holds("a.x + 0.1 < b.x and a.x != b.x", {{"a.x", 1.0}, {"b.x", 1.2}}));
  CHECK_FALSE(holds("a.x + 0.1 < b.x and a.x != b.x", {{"a.x", 1.1}, {"b.x", 1.2}}));
  CHECK(holds("2 > 1 and 2 >= 2 and 1 == 1", {}));
}

TEST_CASE("random trees print to a text that has their value") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const CounterRng rng({.campaign_seed = 5, .sample = seed});
    std::uint64_t draw = 0;
    const std::map<std::string, double> values = {{"a", 1.25}, {"b.x", -0.5}, {"c", 3.0}};
    // Text with brackets round everything, and its value computed beside it.
    const auto tree = [&](auto&& self, int depth) -> std::pair<std::string, double> {
      const auto pick = static_cast<int>(rng.uniform(draw++) * (depth == 0 ? 4 : 10));
      if (pick == 0) return {"a", 1.25};
      if (pick == 1) return {"b.x", -0.5};
      if (pick == 2) return {"c", 3.0};
      if (pick == 3) {
        const double number = std::floor(100.0 * rng.uniform(draw++)) / 8.0;
        return {std::to_string(number), number};
      }
      const auto [l, x] = self(self, depth - 1);
      const auto [r, y] = self(self, depth - 1);
      switch (pick) {
        case 4:
          return {"(" + l + ")+(" + r + ")", x + y};
        case 5:
          return {"(" + l + ") - (" + r + ")", x - y};
        case 6:
          return {"(" + l + ")*(" + r + ")", x * y};
        case 7:
          return {"min(" + l + "," + r + ")", std::min(x, y)};
        case 8:
          return {"-(" + l + ") + abs(" + r + ")", -x + std::abs(y)};
        default:
          return {"max( " + l + " , " + r + " , 0 )", std::max({x, y, 0.0})};
      }
    };
    const auto [text, expected] = tree(tree, 6);
    CAPTURE(text);
    CHECK(value_of(text, values) == expected);
  }
}

TEST_CASE("what has no finite value has none, and what rests on it does not hold") {
  CHECK(std::isnan(value_of("1 / 0", {})));
  CHECK(std::isnan(value_of("sqrt(0 - 1)", {})));
  CHECK(std::isnan(value_of("1e300 * 1e300", {})));
  CHECK_FALSE(holds("not sqrt(0 - 1) < 0", {}));
  CHECK_FALSE(holds("1 / 0 > 1 or 1 < 2", {}));
}

TEST_CASE("errors of formulas stand at the word that is wrong") {
  CHECK(error_of("1 + ") == "2: the formula cannot be read: it ends where a value is wanted");
  CHECK(error_of("") == "0: the formula cannot be read: it ends where a value is wanted");
  CHECK(error_of("(1 + 2").find("a bracket is not closed") != std::string::npos);
  CHECK(error_of("1 + 2)") == "5: the formula cannot be read: `)` follows where it should end");
  CHECK(error_of("1 2") == "2: the formula cannot be read: `2` follows where it should end");
  CHECK(error_of("3 * foo(1)").substr(0, 3) == "4: ");
  CHECK(error_of("abs(1, 2)") == "0: the formula cannot be read: `abs` takes 1, not 2");
  CHECK(error_of("max(1)") == "0: the formula cannot be read: `max` takes at least 2, not 1");
  CHECK(error_of("1 < 2 < 3", Kind::kTruth).substr(0, 3) == "6: ");
  CHECK(error_of("1 < 2").find("where a number is wanted") != std::string::npos);
  CHECK(error_of("1 + 2", Kind::kTruth).find("where a condition is wanted") != std::string::npos);
  CHECK(error_of("(1 < 2) + 1") ==
        "8: the formula cannot be read: `+` is about numbers, not what "
        "is true or false");
  CHECK(error_of("1 and 2 > 1", Kind::kTruth).substr(0, 3) == "2: ");
  CHECK(error_of("a = 1", Kind::kTruth).find("`==` does") != std::string::npos);
  CHECK(error_of("1.2.3").find("is not a finite number") != std::string::npos);
  CHECK(error_of("1e999").find("is not a finite number") != std::string::npos);
  CHECK(error_of("0x10").find("is not a finite number") != std::string::npos);
  CHECK(error_of("\u00f6 < 1").find("`\u00f6` stands where a value is wanted") !=
        std::string::npos);
  CHECK(error_of("a ; b").substr(0, 3) == "2: ");
  CHECK(error_of("system(\"ls\")").find("0: ") == 0);
  for (const auto* open : {"(", "-", "not ", "abs(", "2^"}) {
    std::string deep;
    for (int i = 0; i < 3000 && deep.size() < 9000; ++i) deep += open;
    CHECK(error_of(deep + "1").find("nests too deeply") != std::string::npos);
  }
  CHECK(error_of(std::string(20'000, '1')).find("20000 characters") != std::string::npos);
}

}  // namespace
}  // namespace parallax::harness
