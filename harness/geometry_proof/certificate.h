#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/geometry_proof/trace_proof.h"

namespace parallax::harness {

/// The result of proving one test of an action.
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

/// The proof of a trace from one initial state, with all data needed to check it again.
struct GeometryCertificate {
  std::string scenario;
  std::string scenario_hash;  // over all its texts
  std::int64_t trace = 0;
  std::int64_t initial_state = 0;      // number of the trace's initial state; 0: the only one
  std::string holds;                   // what tells that one from the others
  std::vector<std::string> variables;  // that are drawn
  StartBox region;
  ProofAssumptions assumptions;
  std::vector<ActionCertificate> actions;
  bool stopped = false;
};

/// Proves the tests of these actions, each box confirmed by the second evaluation.
std::vector<ActionCertificate> certify(const std::vector<ProvableAction>& actions,
                                       const SubdivisionLimits& limits);

/// Share of the region that a box is.
double volume_share(const StartBox& box, const StartBox& region);
/// Adds a box's share of the region to what its verdict has.
void add_share(const DecidedBox& box, const StartBox& region, TestCertificate& test);

/// Writes a certificate as JSON, and reads one; a text describes the fault of one that cannot be
/// read. Every member is required. Derived numbers are checked: the shares of a test, and the
/// number of boxes examined, against its boxes.
std::string certificate_json(const GeometryCertificate& certificate);
std::optional<std::string> read_certificate(std::string_view text,
                                            GeometryCertificate& certificate);

/// Do the boxes fill the region without overlapping, having come from halving it?
bool fill(const std::vector<DecidedBox>& boxes, const StartBox& region);

/// The subject of a certificate: a trace of the scenario as it is now. All outlive the check.
struct ProofSubject {
  const WorldSpec& spec;
  const WorldLayout& layout;
  const StartCuboid& region;
  const std::vector<ProofAction>& calls;
};

/// The drawn variables of a start region, in the order of certificates, and their box.
std::vector<std::string> drawn_variables(const StartCuboid& region, StartBox& box);

/// The result of checking one test of a certificate.
struct CheckedCertificate {
  std::size_t number = 0;  // of the action
  std::string event, function;
  std::vector<std::string> assumed;  // as they follow from the scenario and the assumptions
  std::int64_t confirmed = 0, unconfirmed = 0, wrong = 0;  // decided boxes
  double safe = 0.0, refuted = 0.0;  // shares of the region that were confirmed
};

/// The result of checking a certificate against its current scenario. The certificate is not
/// trusted: tests and their assumptions are derived anew from the scenario and the certificate's
/// assumed values, which are compared with those that the options of the program admit.
struct CertificateCheck {
  std::string mismatch;          // it is about something else, or claims an untruth; empty: neither
  std::int64_t confirmed = 0;    // decided boxes
  std::int64_t unconfirmed = 0;  // the second evaluation did not get there
  std::int64_t wrong = 0;        // at the middle of the box it says the contrary
  std::vector<CheckedCertificate> tests;
  std::vector<ProvableAction> actions;  // with tests, as the certificate has them

  /// Something was confirmed, and no decided box is open or wrong.
  bool is_confirmed() const {
    return mismatch.empty() && confirmed > 0 && unconfirmed == 0 && wrong == 0;
  }
};
CertificateCheck check_certificate(const GeometryCertificate& certificate,
                                   const ProofSubject& subject, const std::atomic<bool>* stop);

/// Pieces that the second evaluation may cut a box into.
inline constexpr int kSecondEffort = 1 << 12;

}  // namespace parallax::harness
