// Printed bounds contain the computed ones, and printed confidences never exceed theirs.
#include "harness/confidence/rounding.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "harness/confidence/clean_runs.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

double read(const std::string& text) { return std::stod(text) / 100.0; }

TEST_CASE("rounding: whatever the probability, the printed interval contains it") {
  const CounterRng rng({.sample = 11});
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    // Across the whole range, and near to both ends.
    const double exponent = -12.0 * rng.uniform(3 * i);
    const double tail = std::pow(10.0, exponent);
    const double p = i % 3 == 0 ? rng.uniform(3 * i + 1) : i % 3 == 1 ? tail : 1.0 - tail;
    CAPTURE(p);
    const double slack = 1e-12 * p;  // of numbers that were typed
    CHECK(read(percent_down(p)) <= p + slack);
    CHECK(read(percent_up(p)) >= p - slack);
    CHECK(read(percent_up(p)) - read(percent_down(p)) <= 0.0101 * std::min(p, 1.0 - p) + 1e-15);
    CHECK(read(level_text(p)) <= p + slack);
    CHECK(std::stod(small_figure(p, Round::kDown)) <= p + slack);
    CHECK(std::stod(small_figure(p, Round::kUp)) >= p - slack);
    CHECK(std::stod(p_text(p).substr(4)) >= p - slack);
  }
}

TEST_CASE("rounding: a probability above zero is not shown as zero, nor one below one as one") {
  CHECK(percent_about(1.0 / 8000.0) == "0.0125 %");
  CHECK(percent_up(clopper_pearson_upper(0, 8000, 0.975)) == "0.0462 %");
  CHECK(percent_interval(0.0, 0.000461) == "0 to 0.0461 %");
  CHECK(percent_up(0.99961) == "99.961 %");
  CHECK(percent_about(0.9999) == "99.99 %");
  CHECK(percent_up(1e-9) == "1e-07 %");
  CHECK(small_figure(1.2301e-5, Round::kUp) == "1.24e-05");
  CHECK(small_figure(1.2301e-5, Round::kDown) == "1.23e-05");
}

TEST_CASE("rounding: numbers that were typed read as they were typed") {
  for (const char* text : {"5 %", "7 %", "0.1 %", "48.3 %", "14 %", "29 %", "57.5 %", "2.01 %"}) {
    CHECK(percent_up(read(text)) == text);
    CHECK(percent_down(read(text)) == text);
  }
  for (const char* text :
       {"99 %", "99.9 %", "99.99 %", "99.9999 %", "95 %", "68.271 %", "97.5 %"}) {
    CHECK(level_text(read(text)) == text);
  }
  CHECK(level_text(1.0 - 2.0 * (1.0 - 0.99)) == "98 %");
  CHECK(level_text(0.99999999) == "99.999999 %");
  CHECK(p_text(0.05) == "p = 0.05");
  CHECK(p_text(0.0501) == "p = 0.051");
}

TEST_CASE("rounding: decimals are cut towards the side that is asked for") {
  CHECK(decimal_figure(0.30149, 3, Round::kDown) == "0.301");
  CHECK(decimal_figure(0.30141, 3, Round::kUp) == "0.302");
  CHECK(decimal_figure(-0.30149, 3, Round::kDown) == "-0.302");
  CHECK(decimal_figure(-0.0001, 2, Round::kUp) == "0.00");
  CHECK(decimal_figure(2.5, 2, Round::kUp) == "2.50");
}

}  // namespace
}  // namespace parallax::harness
