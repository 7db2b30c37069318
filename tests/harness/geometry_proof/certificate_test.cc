#include "harness/geometry_proof/certificate.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "compiler/base/json.h"
#include "harness/geometry_proof/proof_assumptions.h"
#include "tests/support/random.h"
#include "tools/bench/proof/proof_worlds.h"

namespace parallax::harness {
namespace {

DecidedBox box(double x0, double x1, double y0, double y1) {
  return {{{x0, x1}, {y0, y1}}, BoxVerdict::kSafe, {}};
}

TEST_CASE("boxes fill a region if they came from halving it") {
  const StartBox region = {{0.0, 1.0}, {0.0, 1.0}};
  const DecidedBox left = box(0.0, 0.5, 0.0, 1.0), low = box(0.5, 1.0, 0.0, 0.5),
                   high = box(0.5, 1.0, 0.5, 1.0);
  CHECK(fill({left, low, high}, region));
  CHECK(fill({box(0.0, 1.0, 0.0, 1.0)}, region));
  CHECK_FALSE(fill({}, region));
  CHECK_FALSE(fill({left, low}, region));                              // a gap
  CHECK_FALSE(fill({left, low, high, high}, region));                  // twice
  CHECK_FALSE(fill({left, low, box(0.5, 1.0, 0.5, 0.9)}, region));     // not to the border
  CHECK_FALSE(fill({left, box(0.4, 1.0, 0.0, 0.5), high}, region));    // overlapping
  CHECK_FALSE(fill({{{{0.0, 1.0}}, BoxVerdict::kSafe, {}}}, region));  // of another region
}

/// A drive and the same again: the second one stands on assumptions about the first.
struct Made {
  bench::ProofWorld world = bench::random_drive(6);
  WorldLayout layout = lay_out(world.spec);
  std::vector<ProofAction> calls = {world.action, world.action};
  std::vector<ProvableAction> actions =
      provable_actions(world.spec, layout, world.region, calls, {});
  GeometryCertificate certificate;
  explicit Made(std::int64_t boxes = 800) {
    SubdivisionLimits limits;
    limits.boxes = boxes;
    certificate.scenario = "world.yaml";
    certificate.scenario_hash = "1234";
    certificate.trace = 3;
    certificate.variables = drawn_variables(world.region, certificate.region);
    certificate.actions = certify(actions, limits);
  }
  CertificateCheck check(const GeometryCertificate& one) const {
    return check_certificate(one, {world.spec, layout, world.region, calls}, nullptr);
  }
};

TEST_CASE("a certificate that was written and read is confirmed, and a changed one is not") {
  const Made made;
  const std::string text = certificate_json(made.certificate);
  GeometryCertificate read;
  const auto fault = read_certificate(text, read);
  CAPTURE(fault.value_or(std::string()));
  REQUIRE_FALSE(fault);
  CHECK(certificate_json(read) == text);
  const auto fine = made.check(read);
  CHECK(fine.mismatch == "");
  CHECK(fine.confirmed > 10);
  CHECK(fine.is_confirmed());
  const auto& said = read.actions.front().tests.front();
  CHECK(fine.tests.front().safe == doctest::Approx(said.safe));
  CHECK(fine.tests.front().refuted == doctest::Approx(said.refuted));

  GeometryCertificate swapped = read;
  for (DecidedBox& one : swapped.actions.front().tests.front().boxes) {
    if (one.verdict == BoxVerdict::kSafe) one.verdict = BoxVerdict::kRefuted;
  }
  CHECK(made.check(swapped).wrong > 0);

  GeometryCertificate shorter = read;
  shorter.actions.front().tests.front().boxes.pop_back();
  CHECK(!made.check(shorter).mismatch.empty());

  GeometryCertificate renamed = read;
  renamed.actions.front().event = "Go(elsewhere)";
  CHECK(!made.check(renamed).mismatch.empty());
}

TEST_CASE("an empty certificate and one that decides nothing confirm nothing") {
  const Made made(20);
  GeometryCertificate empty = made.certificate;
  empty.actions.clear();
  CHECK(made.check(empty).mismatch == "");
  CHECK_FALSE(made.check(empty).is_confirmed());

  GeometryCertificate open = made.certificate;
  for (auto& action : open.actions) {
    for (auto& test : action.tests) {
      test.boxes = {{open.region, BoxVerdict::kOpen, {}}};
      test.examined = 1;
      test.unconfirmed = 0;
      test.safe = test.refuted = 0.0;
      test.open = 1.0;
    }
  }
  GeometryCertificate read;
  CHECK_FALSE(read_certificate(certificate_json(open), read));
  CHECK(made.check(read).mismatch == "");
  CHECK_FALSE(made.check(read).is_confirmed());

  GeometryCertificate twice = made.certificate;
  twice.actions.push_back(twice.actions.back());
  CHECK(!made.check(twice).mismatch.empty());
}

TEST_CASE("assumptions of a certificate are held against their ranges and the world") {
  const Made made(20);
  for (const AssumptionField& field : assumption_fields()) {
    CAPTURE(field.name);
    for (const double value : {-1.0, -1e-9, 10.5, 1e300}) {
      GeometryCertificate bad = made.certificate;
      bad.assumptions.*field.value = value;
      CHECK(!made.check(bad).mismatch.empty());
      GeometryCertificate read;
      CHECK(read_certificate(certificate_json(bad), read));
    }
    auto document = base::parse_ordered_json(certificate_json(made.certificate));
    document["assumptions"].erase(field.name);
    GeometryCertificate read;
    CHECK(read_certificate(base::json_text(document), read).value_or("") ==
          fmt::format("`{}` is missing", field.name));
  }
  GeometryCertificate odd = made.certificate;
  odd.assumptions.sliders.emplace_back("nothing.q", Bounds1{0.0, 1.0});
  CHECK(!made.check(odd).mismatch.empty());
  // The second drive stands on how near to its goal the first one came.
  GeometryCertificate nearer = made.certificate;
  nearer.assumptions.goal_m = 0.0;
  CHECK(!made.check(nearer).mismatch.empty());
}

/// Every value in a document, by its pointer.
void collect(const nlohmann::ordered_json& json, const std::string& at,
             std::vector<std::string>& out) {
  if (!at.empty()) out.push_back(at);
  if (json.is_object()) {
    for (const auto& [name, value] : json.items()) collect(value, at + "/" + name, out);
  } else if (json.is_array()) {
    for (std::size_t i = 0; i < json.size(); ++i)
      collect(json[i], fmt::format("{}/{}", at, i), out);
  }
}

/// The document with one mistake in it.
nlohmann::ordered_json mutated(const nlohmann::ordered_json& document,
                               const std::vector<std::string>& places, test::Random& random) {
  using Pointer = nlohmann::ordered_json::json_pointer;
  auto out = document;
  const Pointer at(places[random.below(places.size())]);
  auto& value = out[at];
  const auto& parent = std::as_const(out)[at.parent_pointer()];
  const auto kind = random.below(6);
  if (kind == 0) {  // gone
    auto& holder = out[at.parent_pointer()];
    if (holder.is_array()) {
      holder.erase(std::stoul(at.back()));
    } else {
      holder.erase(at.back());
    }
  } else if (kind == 1 && parent.is_array()) {  // there twice
    const auto copy = value;
    out[at.parent_pointer()].push_back(copy);
  } else if (kind == 2) {
    value = nullptr;  // as NaN is written
  } else if (value.is_number()) {
    const double number = value.get<double>();
    const double others[] = {-number, -1.0, 0.0, 1e300, number + 0.25, number * 0.5, 1.0, 7.0};
    value = others[random.below(std::size(others))];
    if (random.below(2) == 0) value = static_cast<std::int64_t>(random.below(5));
  } else if (value.is_string()) {
    const char* others[] = {"safe", "refuted", "open", "", "drive", "stopped"};
    value = others[random.below(std::size(others))];
  } else {
    value = value.is_array() ? nlohmann::ordered_json::array() : nlohmann::ordered_json::object();
  }
  return out;
}

/// Returns the first claim of the certificate that is found to be false, or an empty text. Samples
/// starts of boxes with a verdict and decides them by the second evaluation of the true
/// assumptions; texts and numbers must follow from the world.
std::string false_claim(const GeometryCertificate& said, const Made& made, test::Random& random) {
  for (const auto& action : said.actions) {
    const auto& real = made.certificate.actions.at(action.number);
    if (action.event != real.event || action.controller != real.controller) return "another action";
    if (action.tests.size() != real.tests.size()) return "another number of tests";
    for (std::size_t i = 0; i < action.tests.size(); ++i) {
      const auto& test = action.tests[i];
      if (test.assumed != real.tests[i].assumed) return "other assumptions";
      if (test.test.statement != real.tests[i].test.statement) return "another statement";
      double shares[3] = {0.0, 0.0, 0.0};
      for (const auto& box : test.boxes) {
        double share = 1.0;
        std::vector<double> start;
        for (std::size_t k = 0; k < box.bounds.size(); ++k) {
          const auto& whole = said.region[k];
          share *= (box.bounds[k].upper - box.bounds[k].lower) / (whole.upper - whole.lower);
          const double u = 0.001 * static_cast<double>(random.below(1001));
          start.push_back(box.bounds[k].lower + u * (box.bounds[k].upper - box.bounds[k].lower));
        }
        shares[static_cast<std::size_t>(box.verdict)] += share;
        if (box.verdict == BoxVerdict::kOpen) continue;
        const bool refuses = made.actions[action.number].tests[i]->second().refuses_at(start);
        if (refuses != (box.verdict == BoxVerdict::kRefuted)) return "a box with a wrong verdict";
      }
      if (std::abs(shares[0] - test.safe) > 1e-6 || std::abs(shares[1] - test.refuted) > 1e-6 ||
          std::abs(shares[2] - test.open) > 1e-6 ||
          std::abs(shares[0] + shares[1] + shares[2] - 1.0) > 1e-6) {
        return "shares that are not those of its boxes";
      }
    }
  }
  return {};
}

TEST_CASE("no single mistake in a certificate makes it confirm more, or something false") {
  const Made made(60);
  const auto document = base::parse_ordered_json(certificate_json(made.certificate));
  const auto true_one = made.check(made.certificate);
  REQUIRE(true_one.confirmed > 5);
  std::vector<std::string> places;
  collect(document, "", places);
  // Bounds and verdicts of boxes are most of a document: the rest is tried as often.
  std::vector<std::string> few;
  for (const auto& place : places) {
    if (place.find("/boxes/") == std::string::npos) few.push_back(place);
  }
  test::Random random(38);
  int read_well = 0, accepted = 0;
  for (int n = 0; n < 1000; ++n) {
    const auto other = mutated(document, n % 2 == 0 ? few : places, random);
    GeometryCertificate said;
    if (read_certificate(base::json_text(other), said)) continue;
    ++read_well;
    const auto result = made.check(said);
    CAPTURE(base::json_text(nlohmann::ordered_json::diff(document, other)).substr(0, 300));
    CHECK(result.confirmed <= true_one.confirmed);
    if (!result.is_confirmed()) continue;
    ++accepted;
    CHECK(false_claim(said, made, random) == "");
  }
  CHECK(read_well > 50);
  CHECK(accepted > 0);  // a name of a file may be another one
}

TEST_CASE("what is no certificate is refused with a reason") {
  const std::string good = certificate_json(Made(20).certificate);
  for (const std::string& text :
       {std::string(), std::string("{}"), std::string("[1]"), std::string("{\"kind\":1}"),
        good.substr(0, good.size() / 2),
        std::string("{\"kind\":\"parallax geometry proof\",\"version\":2}"),
        std::string("{\"kind\":\"parallax geometry proof\",\"version\":1}"),
        std::string("{\"kind\":\"parallax geometry proof\",\"version\":1,\"variables\":[\"x\"],"
                    "\"region\":[[1,0]],\"actions\":[]}"),
        std::string("{\"kind\":\"parallax geometry proof\",\"version\":1,\"variables\":[\"x\"],"
                    "\"region\":[[0,1]],\"actions\":[{\"tests\":[{\"function\":\"f\",\"boxes\":"
                    "[{\"verdict\":\"fine\",\"bounds\":[[0,1]]}]}]}]}")}) {
    GeometryCertificate certificate;
    const auto fault = read_certificate(text, certificate);
    CAPTURE(text.substr(0, 200));
    REQUIRE(fault);
    CHECK(!fault->empty());
  }
}

}  // namespace
}  // namespace parallax::harness
