#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/geometry_proof/trace_proof.h"

namespace parallax::harness {

/// What was proved of one test of an action.
struct TestCertificate {
  CheckedTest test;
  std::vector<std::string> assumed;
  std::int64_t examined = 0;     // boxes
  std::int64_t unconfirmed = 0;  // decided, and open since the second evaluation did not agree
  double safe = 0.0, refuted = 0.0, open = 0.0;
  std::vector<DecidedBox> boxes;
};

struct ActionCertificate {
  std::size_t number = 0;
  std::string event, controller;
  std::vector<TestCertificate> tests;
  std::string left_to_simulation;  // why; empty if there are tests
};

/// What was proved of a trace, and all that it takes to check it again.
struct Certificate {
  std::string scenario;
  std::string scenario_hash;  // over all its texts; empty in certificates that do not say
  std::int64_t trace = 0;
  std::vector<std::string> variables;  // that are drawn
  StartBox region;
  ProofAssumptions assumptions;
  std::vector<ActionCertificate> actions;
  bool stopped = false;
};

/// Proves the tests of these actions, each box confirmed by the second evaluation.
std::vector<ActionCertificate> certify(const std::vector<ProvableAction>& actions,
                                       const ProofLimits& limits);

/// A certificate as JSON, and back; a text that says what is wrong with one that cannot be read.
/// Shares are read off the boxes.
std::string certificate_json(const Certificate& certificate);
std::optional<std::string> read_certificate(std::string_view text, Certificate& certificate);

/// Do the boxes fill the region without overlapping, having come from halving it?
bool fill(const std::vector<DecidedBox>& boxes, const StartBox& region);

/// A certificate held against what its scenario says by now.
struct CertificateCheck {
  std::string mismatch;          // the certificate is of something else; empty if it is not
  std::int64_t confirmed = 0;    // decided boxes
  std::int64_t unconfirmed = 0;  // the second evaluation did not get there
  std::int64_t wrong = 0;        // at the middle of the box it says the contrary
  double safe = 0.0, refuted = 0.0, open = 0.0;  // shares of the region, of the last test
};
CertificateCheck check_certificate(const Certificate& certificate,
                                   const std::vector<ProvableAction>& actions,
                                   const std::atomic<bool>* stop);

/// Pieces that the second evaluation may cut a box into.
inline constexpr int kSecondEffort = 1 << 12;

}  // namespace parallax::harness
