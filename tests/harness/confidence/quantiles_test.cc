#include "harness/confidence/quantiles.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

// Reference values were computed with 40 digits from the defining integrals.

bool near(double actual, double expected, double relative = 1e-11) {
  return std::abs(actual - expected) <= relative * std::abs(expected);
}

double binomial_tail(int at_least, int n, double p) {
  double sum = 0.0, coefficient = 1.0;
  for (int k = 0; k <= n; ++k) {
    if (k >= at_least) sum += coefficient * std::pow(p, k) * std::pow(1 - p, n - k);
    coefficient = coefficient * (n - k) / (k + 1);
  }
  return sum;
}

TEST_CASE("normal quantile: reference values from the centre to the far tail") {
  const std::array<std::pair<double, double>, 9> cases = {{{1e-300, -37.0470962993611992},
                                                           {1e-20, -9.26234008979840757},
                                                           {1e-10, -6.3613409024040562},
                                                           {0.001, -3.09023230616781354},
                                                           {0.02425, -1.97296105131188485},
                                                           {0.3, -0.524400512708040784},
                                                           {0.9, 1.28155156554460047},
                                                           {0.975, 1.95996398454005424},
                                                           {0.999999, 4.75342430882289895}}};
  // 0.999999 is no binary fraction: its rounding alone moves the quantile by 1e-11.
  for (const auto& [p, z] : cases)
    CHECK(near(normal_quantile(p), z, p == 0.999999 ? 1e-11 : 1e-14));
  CHECK(normal_quantile(0.5) == 0.0);
}

TEST_CASE("normal quantile: inverse of the distribution function, odd about one half") {
  for (int i = 1; i < 1000; ++i) {
    const double p = i / 1000.0;
    CHECK(near(normal_cdf(normal_quantile(p)), p, 1e-13));
    CHECK(normal_quantile(1.0 - p) == doctest::Approx(-normal_quantile(p)).epsilon(1e-12));
  }
  CHECK_THROWS_AS(normal_quantile(0.0), base::ContractViolation);
  CHECK_THROWS_AS(normal_quantile(1.0), base::ContractViolation);
}

TEST_CASE("incomplete beta: reference values") {
  CHECK(near(incomplete_beta(0.5, 0.5, 0.3), 0.369010119565545383));
  CHECK(near(incomplete_beta(2, 3, 0.4), 0.5248));
  CHECK(near(incomplete_beta(10, 0.5, 0.9), 0.151640909634709921));
  CHECK(near(incomplete_beta(30.5, 70.25, 0.3), 0.487630874628557998));
  CHECK(near(incomplete_beta(1, 90, 0.05), 0.990111635290341009));
  CHECK(near(incomplete_beta(500, 1500, 0.26), 0.849045636445046158));
  CHECK(near(incomplete_beta(0.5, 2000, 0.001), 0.9545402415621452));
  CHECK(near(incomplete_beta(300, 300, 0.49), 0.312157936642942753));
  CHECK(incomplete_beta(2, 3, 0.0) == 0.0);
  CHECK(incomplete_beta(2, 3, 1.0) == 1.0);
}

TEST_CASE("incomplete beta: equals binomial tails, and reflects") {
  for (int n = 1; n <= 30; n += 3) {
    for (int k = 1; k <= n; k += 2) {
      for (const double p : {0.01, 0.2, 0.5, 0.83}) {
        CHECK(incomplete_beta(k, n - k + 1, p) ==
              doctest::Approx(binomial_tail(k, n, p)).epsilon(1e-10));
        CHECK(incomplete_beta(k, n - k + 1, p) ==
              doctest::Approx(1.0 - incomplete_beta(n - k + 1, k, 1.0 - p)).epsilon(1e-10));
      }
    }
  }
}

TEST_CASE("beta quantile: reference values and round trips") {
  CHECK(near(beta_quantile(0.99, 1, 90), 0.049881492681856285));
  CHECK(near(beta_quantile(0.99, 2, 89), 0.0714910418096711637));
  CHECK(near(beta_quantile(0.95, 6, 100), 0.09751375714586455));
  CHECK(near(beta_quantile(0.5, 3, 7), 0.286236668022782715));
  CHECK(near(beta_quantile(0.01, 0.5, 0.5), 0.0002467198171342215));
  CHECK(near(beta_quantile(0.99, 6, 1301), 0.0100060024027899764));
  for (const double a : {0.5, 1.0, 4.0, 60.0}) {
    for (const double b : {0.5, 2.0, 300.0}) {
      for (const double p : {1e-6, 0.05, 0.5, 0.999}) {
        CHECK(near(incomplete_beta(a, b, beta_quantile(p, a, b)), p, 1e-10));
      }
    }
  }
  CHECK(beta_quantile(0.0, 2, 3) == 0.0);
  CHECK(beta_quantile(1.0, 2, 3) == 1.0);
}

TEST_CASE("student t quantile: reference values") {
  CHECK(near(student_t_quantile(0.975, 1), 12.7062047361747046));
  CHECK(near(student_t_quantile(0.975, 2), 4.30265272974946385));
  CHECK(near(student_t_quantile(0.975, 5), 2.57058183563631551));
  CHECK(near(student_t_quantile(0.995, 3), 5.84090930973335726));
  CHECK(near(student_t_quantile(0.9999, 7), 7.06343282815751401));
  CHECK(near(student_t_quantile(0.6, 4), 0.270722294707597425));
  CHECK(near(student_t_quantile(0.999999, 30), 5.87111712041888265, 1e-10));
  CHECK(near(student_t_quantile(0.975, 295), 1.9680381148904699));
  CHECK(near(student_t_quantile(0.9874, 2.5), 4.84717337039694935));
}

TEST_CASE("student t quantile: closed forms for one and two degrees of freedom") {
  for (const double p : {1e-9, 1e-3, 0.2, 0.49, 0.51, 0.8, 0.999}) {
    const double cauchy = -1.0 / std::tan(std::numbers::pi * p);  // no cancellation in the tail
    CHECK(student_t_quantile(p, 1) == doctest::Approx(cauchy).epsilon(1e-10));
    const double two = (2 * p - 1) / std::sqrt(2 * p * (1 - p));
    CHECK(student_t_quantile(p, 2) == doctest::Approx(two).epsilon(1e-10));
  }
  CHECK(student_t_quantile(0.5, 1) == 0.0);
}

TEST_CASE("student t: quantile and distribution are inverse, and tend to the normal") {
  for (const double dof : {1.5, 3.0, 10.0, 100.0}) {
    for (const double p : {1e-5, 0.01, 0.3, 0.7, 0.995}) {
      CHECK(near(student_t_cdf(student_t_quantile(p, dof), dof), p, 1e-10));
    }
  }
  CHECK(student_t_quantile(0.975, 1e7) == doctest::Approx(normal_quantile(0.975)).epsilon(1e-6));
}

}  // namespace
}  // namespace parallax::harness
