#include "harness/sampling/law_draw.h"

#include <doctest/doctest.h>

#include <numbers>

#include "compiler/base/codes/scenarios.h"
#include "harness/sampling/sampler.h"
#include "tests/harness/law/goodness.h"

namespace parallax::harness {
namespace {

constexpr std::uint64_t kLawDraws = 20'000;

Expression expression(const std::string& text, Expression::Kind kind) {
  base::DiagnosticSink sink;
  auto parsed = Expression::parse(
      text, kind, {base::FileId(0), 0, static_cast<std::uint32_t>(text.size())}, sink);
  REQUIRE(parsed.has_value());
  return *std::move(parsed);
}

void require(SamplingLaw& law, const std::string& text) {
  law.requirements.push_back({expression(text, Expression::Kind::kTruth), {}});
}

SamplingLaw::Formula formula(const std::string& variable, const std::string& text) {
  return {variable, expression(text, Expression::Kind::kNumber), {}, false, {}};
}

Distribution bell_law(double mean, double sd) {
  Distribution law;
  law.kind = Distribution::Kind::kNormal;
  law.mean = mean;
  law.sd = sd;
  return law;
}

Sampler sampler_of(const StartCuboid& cuboid, const SamplingLaw& law, double inset = 0.0) {
  base::DiagnosticSink sink;
  auto sampler = Sampler::make(cuboid, inset, {}, sink, &law);
  REQUIRE(sampler.has_value());
  return *std::move(sampler);
}

base::DiagnosticCode code_of(const StartCuboid& cuboid, const SamplingLaw& law,
                             std::string* message = nullptr) {
  base::DiagnosticSink sink;
  CHECK_FALSE(Sampler::make(cuboid, 1e-6, {}, sink, &law).has_value());
  REQUIRE(sink.sorted().size() == 1);
  if (message != nullptr) *message = sink.sorted()[0].message;
  return sink.sorted()[0].code;
}

std::vector<double> values(const Sampler& sampler, const std::string& variable) {
  std::vector<double> out;
  for (std::uint64_t i = 0; i < kLawDraws; ++i) {
    out.push_back(std::get<double>(sampler.draw({.campaign_seed = 11, .sample = i}).at(variable)));
  }
  return out;
}

double below_half_square(double x) { return x * x; }

TEST_CASE("without conditions every variable that stays uniform is drawn as without a law") {
  const StartCuboid cuboid{{{"a", {0, 1}}, {"b", {2, 5}}, {"c", {3, 3, true}}, {"d", {-1, 1}}}};
  base::DiagnosticSink sink;
  const auto plain = Sampler::make(cuboid, 1e-6, {}, sink);
  REQUIRE(plain.has_value());
  SamplingLaw law;
  law.marginals.push_back({"b", bell_law(3, 1), {}});
  const auto sampler = sampler_of(cuboid, law, 1e-6);
  for (std::uint64_t i = 0; i < 200; ++i) {
    const DrawKey key{.campaign_seed = 3, .sample = i};
    auto one = plain->draw(key), other = sampler.draw(key);
    one.erase("b"), other.erase("b");
    CHECK(one == other);
  }
  CHECK(plain->law() == nullptr);
  CHECK(sampler_of(cuboid, SamplingLaw()).law() == nullptr);
}

TEST_CASE("a law is conditioned on the cell, and on what is required of several values") {
  // The larger of two uniform values, given their order, has P(x) = x^2.
  SamplingLaw law;
  require(law, "a < b");
  const auto pair = sampler_of({{{"a", {0, 1}}, {"b", {0, 1}}}}, law);
  CHECK(test::kolmogorov(values(pair, "b"), below_half_square) < test::kKolmogorovLimit);
  // A standard normal above 1, by a cell and by a requirement.
  const auto tail = [](double x) {
    const auto q = [](double z) { return 0.5 * std::erfc(z / std::numbers::sqrt2); };
    return (q(1.0) - q(x)) / q(1.0);
  };
  SamplingLaw bell;
  bell.marginals.push_back({"a", bell_law(0, 1), {}});
  CHECK(test::kolmogorov(values(sampler_of({{{"a", {1, 9}}}}, bell), "a"), tail) <
        test::kKolmogorovLimit);
  require(bell, "a > 1");
  const auto sampler = sampler_of({{{"a", {-9, 9}}}}, bell);
  CHECK(test::kolmogorov(values(sampler, "a"), tail) < test::kKolmogorovLimit);
  // The counts of refused draws are those of the law: P(a <= 1) = 0.8413.
  std::vector<std::int64_t> refusals(1);
  std::int64_t refused = 0;
  for (std::uint64_t i = 0; i < kLawDraws; ++i) {
    refused += sampler.draw_counting({.campaign_seed = 4, .sample = i}, &refusals).refused;
  }
  CHECK(refusals[0] == refused);
  const auto share = static_cast<double>(refused) / static_cast<double>(refused + kLawDraws);
  CHECK(share == doctest::Approx(0.8413447).epsilon(0.01));
}

TEST_CASE("formulas tie values, through each other and through parameters no simulator sees") {
  SamplingLaw law;
  law.parameters.push_back({"fill", {0, 2}});
  law.formulas.push_back(formula("half", "fill / 2"));
  law.formulas.back().is_parameter = true;
  law.formulas.push_back(formula("milk.mass", "0.2 + 1.03 * half * 2"));
  law.constants.emplace("table.x", 7.0);
  law.formulas.push_back(formula("cup.y", "table.x + x0"));
  const auto sampler = sampler_of({{{"x0", {0, 1}}}}, law);
  std::vector<double> masses;
  for (std::uint64_t i = 0; i < kLawDraws; ++i) {
    const auto start = sampler.draw({.campaign_seed = 8, .sample = i});
    CHECK(start.size() == 3);
    masses.push_back(std::get<double>(start.at("milk.mass")));
    CHECK(std::get<double>(start.at("cup.y")) == 7.0 + std::get<double>(start.at("x0")));
  }
  CHECK(test::kolmogorov(masses, [](double m) { return (m - 0.2) / 2.06; }) <
        test::kKolmogorovLimit);
}

TEST_CASE("a value by formula that a cell bounds is conditioned on the cell") {
  SamplingLaw law;
  law.formulas.push_back(formula("b", "2 * a"));
  const auto sampler = sampler_of({{{"a", {0, 1}}, {"b", {0, 1}}}}, law);
  CHECK(test::kolmogorov(values(sampler, "a"), [](double x) { return 2.0 * x; }) <
        test::kKolmogorovLimit);
}

TEST_CASE("half-planes of a body that is drawn, in its frame, leave the pair uniform") {
  // Behind a body that is turned by a right angle towards (1, 0) is where y is greater.
  SamplingLaw law;
  law.half_planes.push_back({"b", "a", {1, 0}, 0.0, {}});
  const StartCuboid cuboid{{{"a.x", {0, 1}},
                            {"a.y", {0, 1}},
                            {"a.yaw", {std::numbers::pi / 2, std::numbers::pi / 2, true}},
                            {"b.x", {0, 1}},
                            {"b.y", {0, 1}}}};
  const auto sampler = sampler_of(cuboid, law);
  CHECK(test::kolmogorov(values(sampler, "b.y"), below_half_square) < test::kKolmogorovLimit);
  CHECK(test::kolmogorov(values(sampler, "b.x"), [](double x) { return x; }) <
        test::kKolmogorovLimit);
}

TEST_CASE("areas are drawn from directly, cut by the cell and by each other") {
  const auto ring =
      std::make_shared<const Area>(std::vector<PlaneShape>{RingShape{{0, 0}, 0.5, 1.0}});
  SamplingLaw law;
  law.areas.push_back({"cup", ring, {}});
  const StartCuboid whole{{{"cup.x", {-1, 1}}, {"cup.y", {-1, 1}}}};
  const auto radii = [](const Sampler& sampler) {
    std::vector<double> out;
    for (std::uint64_t i = 0; i < kLawDraws; ++i) {
      const auto start = sampler.draw({.campaign_seed = 2, .sample = i});
      out.push_back(
          std::hypot(std::get<double>(start.at("cup.x")), std::get<double>(start.at("cup.y"))));
    }
    return out;
  };
  const auto by_radius = [](double r) { return (r * r - 0.25) / 0.75; };
  CHECK(test::kolmogorov(radii(sampler_of(whole, law)), by_radius) < test::kKolmogorovLimit);
  // The upper half by the cell: the angle is uniform in half a turn.
  const auto half = sampler_of({{{"cup.x", {-1, 1}}, {"cup.y", {0, 1}}}}, law);
  CHECK(test::kolmogorov(radii(half), by_radius) < test::kKolmogorovLimit);
  // The shape of the region, in a frame that is moved, with another area of `sampling` in it.
  StartCuboid moved{{{"cup.x", {9, 11}}, {"cup.y", {-1, 1}}}};
  moved.areas.push_back({"cup", ring, {10, 0}, {}});
  SamplingLaw right;
  right.areas.push_back({"cup",
                         std::make_shared<const Area>(std::vector<PlaneShape>{
                             PolygonShape{{{10, -2}, {12, -2}, {12, 2}, {10, 2}}}}),
                         {}});
  for (const double x : values(sampler_of(moved, right), "cup.x")) CHECK(x >= 10.0);
}

TEST_CASE("points of the unit cube that are not refused are the law's draws") {
  SamplingLaw law;
  law.marginals.push_back({"a", bell_law(0, 1), {}});
  require(law, "a > b");
  const auto sampler = sampler_of({{{"a", {-1, 1}}, {"b", {-1, 1}}, {"c", {2, 2, true}}}}, law);
  REQUIRE(sampler.law() != nullptr);
  CHECK(sampler.law()->coordinates() == 3);
  CHECK(sampler.law()->is_free(0));
  CHECK_FALSE(sampler.law()->is_free(2));
  std::vector<double> direct;
  for (std::uint64_t i = 0; direct.size() < kLawDraws; ++i) {
    const CounterRng rng({.campaign_seed = 21, .sample = i});
    const std::vector<double> point = {rng.uniform(5), rng.uniform(6), 0.3};
    if (const auto start = sampler.law()->start_at(point, nullptr)) {
      direct.push_back(std::get<double>(start->at("a")));
    }
  }
  auto drawn = values(sampler, "a");
  std::sort(drawn.begin(), drawn.end());
  // Two samples: their distance has twice the variance.
  const auto empirical = [&](double x) {
    return static_cast<double>(std::upper_bound(drawn.begin(), drawn.end(), x) - drawn.begin()) /
           static_cast<double>(drawn.size());
  };
  CHECK(test::kolmogorov(direct, empirical) < test::kKolmogorovLimit * std::numbers::sqrt2);
}

TEST_CASE("draws depend on their key alone") {
  SamplingLaw law;
  require(law, "a > 0.9");
  const auto sampler = sampler_of({{{"a", {0, 1}}}}, law),
             again = sampler_of({{{"a", {0, 1}}}}, law);
  for (std::uint64_t i = 100; i-- > 0;) {
    const DrawKey key{.campaign_seed = 1, .sample = i};
    CHECK(sampler.draw(key) == again.draw(key));
    CHECK(sampler.draw(key) != sampler.draw({.campaign_seed = 2, .sample = i}));
  }
}

TEST_CASE("laws that no start comes of are refused, with what refuses most") {
  const StartCuboid cuboid{{{"a", {0, 1}}, {"b", {0, 1}}}};
  SamplingLaw law;
  require(law, "a < 0.5");
  require(law, "b > 0.9995");
  std::string message;
  CHECK(code_of(cuboid, law, &message) == codes::kStartsRefused);
  CHECK(message.find("`b > 0.9995` alone refuses 999") != std::string::npos);
  SamplingLaw enough;
  require(enough, "b > 0.997");
  (void)sampler_of(cuboid, enough);
  SamplingLaw unknown;
  require(unknown, "a < nobody.x");
  CHECK(code_of(cuboid, unknown) == codes::kNoFormulaValue);
  SamplingLaw elsewhere;
  elsewhere.marginals.push_back({"a", bell_law(100, 1), {}});
  CHECK(code_of(cuboid, elsewhere) == codes::kLawWithoutMass);
  SamplingLaw broken;
  broken.formulas.push_back(formula("m", "1 / (a - a)"));
  CHECK(code_of(cuboid, broken, &message) == codes::kStartsRefused);
  CHECK(message.find("`m = 1 / (a - a) has a value`") != std::string::npos);
}

}  // namespace
}  // namespace parallax::harness
