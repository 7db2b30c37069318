#include "harness/geometry_proof/certificate.h"

#include <doctest/doctest.h>

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

struct Made {
  bench::ProofWorld world = bench::random_drive(6);
  WorldLayout layout = lay_out(world.spec);
  std::vector<ProvableAction> actions =
      provable_actions(world.spec, layout, world.region, {world.action}, {});
  Certificate certificate;
  Made() {
    ProofLimits limits;
    limits.boxes = 800;
    certificate.scenario = "world.yaml";
    certificate.trace = 3;
    for (const auto& one : world.region.dimensions) certificate.variables.push_back(one.variable);
    certificate.region = actions.front().tests.front()->scene().whole();
    certificate.actions = certify(actions, limits);
  }
};

TEST_CASE("a certificate that was written and read is confirmed, and a changed one is not") {
  const Made made;
  const std::string text = certificate_json(made.certificate);
  Certificate read;
  REQUIRE_FALSE(read_certificate(text, read));
  CHECK(certificate_json(read).size() > 0);
  const auto fine = check_certificate(read, made.actions, nullptr);
  CHECK(fine.mismatch.empty());
  CHECK(fine.confirmed > 10);
  CHECK(fine.wrong == 0);
  CHECK(fine.unconfirmed == 0);

  Certificate swapped = read;
  for (DecidedBox& one : swapped.actions.front().tests.front().boxes) {
    if (one.verdict == BoxVerdict::kSafe) one.verdict = BoxVerdict::kRefuted;
  }
  CHECK(check_certificate(swapped, made.actions, nullptr).wrong > 0);

  Certificate shorter = read;
  shorter.actions.front().tests.front().boxes.pop_back();
  CHECK(!check_certificate(shorter, made.actions, nullptr).mismatch.empty());

  Certificate renamed = read;
  renamed.actions.front().event = "Go(elsewhere)";
  CHECK(!check_certificate(renamed, made.actions, nullptr).mismatch.empty());
}

TEST_CASE("what is no certificate is refused with a reason") {
  const std::string good = certificate_json(Made().certificate);
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
    Certificate certificate;
    const auto fault = read_certificate(text, certificate);
    CAPTURE(text.substr(0, 200));
    REQUIRE(fault);
    CHECK(!fault->empty());
  }
}

}  // namespace
}  // namespace parallax::harness
