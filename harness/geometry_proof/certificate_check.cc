// Checks a certificate against its scenario. The certificate says only where to look: which boxes,
// of which tests. Everything else is made anew and compared, and each decided box is put to the
// second evaluation alone.

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "harness/geometry_proof/certificate.h"
#include "harness/geometry_proof/proof_assumptions.h"

namespace parallax::harness {
namespace {

bool same_bounds(const StartBox& a, const StartBox& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.lower == y.lower && x.upper == y.upper;
  });
}

bool same_test(const CheckedTest& a, const CheckedTest& b) {
  return a.controller == b.controller && a.function == b.function && a.source == b.source &&
         a.refusal == b.refusal && a.statement == b.statement;
}

/// The first wrong statement of a certificate about an action; empty: none. `actual` is null if the
/// trace has no such action.
std::string wrong_action(const ActionCertificate& said, const ProvableAction* actual,
                         const StartBox& region) {
  if (actual == nullptr || actual->event != said.event || actual->controller != said.controller) {
    return fmt::format("its action {}, {}, is none of the trace", said.number, said.event);
  }
  if (actual->tests.size() != said.tests.size()) {
    return fmt::format("its action {}, {}, has {} tests, and {} follow from the scenario",
                       said.number, said.event, said.tests.size(), actual->tests.size());
  }
  if (actual->left_to_simulation != said.left_to_simulation) {
    return fmt::format("why {} is left to simulation is not what follows from the scenario",
                       said.event);
  }
  for (std::size_t i = 0; i < said.tests.size(); ++i) {
    const ActionTest& test = *actual->tests[i];
    if (!same_test(said.tests[i].test, test.check().test())) {
      return fmt::format("`{}`, as it is described there, is no test of {}",
                         said.tests[i].test.function, said.event);
    }
    if (said.tests[i].assumed != test.state().assumed) {
      return fmt::format(
          "what it takes for granted before {} is not what follows from the "
          "scenario and its assumptions",
          said.event);
    }
    if (!fill(said.tests[i].boxes, region)) {
      return fmt::format("the boxes of {} do not fill the start region", said.event);
    }
  }
  return {};
}

void confirm_boxes(const TestCertificate& said, const ActionTest& test, const StartBox& region,
                   const std::atomic<bool>* stop, CheckedCertificate& out) {
  for (const DecidedBox& box : said.boxes) {
    if (box.verdict == BoxVerdict::kOpen) continue;
    std::vector<double> middle;
    for (const Bounds1& one : box.bounds) middle.push_back(0.5 * one.lower + 0.5 * one.upper);
    const bool stopped = stop != nullptr && stop->load();
    if (!stopped && test.second().refuses_at(middle) != (box.verdict == BoxVerdict::kRefuted)) {
      ++out.wrong;
    } else if (stopped || !test.second().confirms(box.bounds, box.verdict, kSecondEffort)) {
      ++out.unconfirmed;
    } else {
      ++out.confirmed;
      (box.verdict == BoxVerdict::kSafe ? out.safe : out.refuted) +=
          volume_share(box.bounds, region);
    }
  }
}

}  // namespace

std::vector<std::string> drawn_variables(const StartCuboid& region, StartBox& box) {
  std::vector<std::string> names;
  for (const auto& [name, interval] : region.dimensions) {
    if (!(interval.lower < interval.upper)) continue;
    names.push_back(name);
    box.push_back({interval.lower, interval.upper});
  }
  return names;
}

CertificateCheck check_certificate(const GeometryCertificate& certificate,
                                   const ProofSubject& subject, const std::atomic<bool>* stop) {
  CertificateCheck out;
  StartBox region;
  if (drawn_variables(subject.region, region) != certificate.variables ||
      !same_bounds(region, certificate.region)) {
    out.mismatch = "its start region is not that of the scenario's trace";
    return out;
  }
  out.mismatch = wrong_assumptions(certificate.assumptions, subject.layout);
  if (!out.mismatch.empty()) return out;
  auto actual = provable_actions(subject.spec, subject.layout, subject.region, subject.calls,
                                 certificate.assumptions);
  std::vector<ProvableAction*> found;
  std::size_t next = 0;  // the actions stand there in the order of the trace, each once at most
  for (const ActionCertificate& said : certificate.actions) {
    const bool is_there = said.number >= next && said.number < actual.size();
    found.push_back(is_there ? &actual[said.number] : nullptr);
    out.mismatch = wrong_action(said, found.back(), region);
    if (!out.mismatch.empty()) return out;
    next = said.number + 1;
  }
  for (std::size_t a = 0; a < found.size(); ++a) {
    const ActionCertificate& said = certificate.actions[a];
    for (std::size_t i = 0; i < said.tests.size(); ++i) {
      const ActionTest& test = *found[a]->tests[i];
      CheckedCertificate one{said.number, said.event, said.tests[i].test.function,
                             test.state().assumed};
      confirm_boxes(said.tests[i], test, region, stop, one);
      out.confirmed += one.confirmed;
      out.unconfirmed += one.unconfirmed;
      out.wrong += one.wrong;
      out.tests.push_back(std::move(one));
    }
    out.actions.push_back(std::move(*found[a]));
  }
  return out;
}

}  // namespace parallax::harness
