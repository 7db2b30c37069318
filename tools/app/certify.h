#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/plan/plan_graph.h"
#include "runtime/certify/certificate.h"
#include "runtime/session/solver_session.h"
#include "runtime/solver/sat_solver.h"
#include "tools/app/context.h"
#include "tools/app/plan_reservations.h"

namespace parallax::tools {

/// `--certify[=FILE]`: whether a list of traces is complete, as a checked proof.
struct CertifyOption {
  std::string file;  // empty: not asked for
  bool keep = true;  // false: the files are gone when the command ends, so nobody is told of them
};

/// Limits of a proof's check: half of the memory that the program may take.
runtime::ProofLimits proof_limits(const Context& context);

/// The verdict on a claim that rests on an argument by symmetry.
inline constexpr std::string_view kBySymmetry = "symmetry, not proof checked";

/// The verdict on a claim that was searched by cubes.
inline constexpr std::string_view kByCubes = "cubes, not proof checked";

/// Collects the traces of a list and proves at its end that there are no others. Without the option
/// it does nothing and says so.
class TraceCertifier {
 public:
  /// `models`: as on the command line; the first one names the file where the user does not. All
  /// references outlive the object.
  TraceCertifier(const CertifyOption& option, const std::vector<std::string>& models,
                 const runtime::CompiledModel& model, Context& context);

  bool is_asked() const { return claim_.has_value(); }
  /// A solver for the search, whose work is logged as a proof where one is asked for. It has to be
  /// gone before the list is concluded.
  std::unique_ptr<runtime::SatSolver> solver();
  /// How a session is to load it.
  runtime::Loading loading() const {
    return files_ ? runtime::Loading::kWhole : runtime::Loading::kAsNeeded;
  }
  /// Can the files be written? If not, that was reported.
  bool ready() const { return !option_.file.empty() == files_.has_value(); }
  void add(const runtime::Trace& trace) {
    if (claim_) claim_->add(trace);
  }
  /// Makes and checks the proof; `exploration`: what is known of the traces that were not listed.
  /// `searched`: the solver above found that there are no others.
  void conclude(const std::string& exploration, bool searched);
  /// Warns that there is nothing to prove.
  void decline(const std::string& reason);

  /// The claim of the list was refuted, or the proof could not be checked.
  bool refuted() const { return verdict_ == "proof not accepted"; }
  /// Records that the claim has no proof: it rests on an argument by symmetry.
  void rest_on_symmetry();
  /// Records that the claim has no proof if the plan has gaps, and says which unless that was said.
  void note_gaps(const std::optional<compiler::PlanGraph>& plan, bool tells = true);
  /// Records that the claim has no proof: some execution comes to where unrolling was cut.
  void note_cut();
  const PlanReservations& reservations() const { return reservations_; }
  /// `no proof`, what PlanReservations says, `symmetry, not proof checked`, `proof checked`,
  /// `proof not accepted` or `proof not checked`.
  const std::string& verdict() const { return verdict_; }
  std::string proof_file() const { return files_ ? files_->proof_path().string() : ""; }
  /// ` (proof checked)` or another verdict for a list that claims to be complete, else nothing.
  std::string remark(const std::string& exploration) const;
  /// Origin of an accepted proof: `search` or `fresh solve`.
  const std::string& origin() const { return origin_; }
  /// `"proof":"checked","proof_origin":"search","proof_file":"..",`: none, checked, not accepted,
  /// not checked; the rest only with a proof that was accepted.
  std::string fields() const;

 private:
  const CertifyOption& option_;
  Context& context_;
  std::optional<runtime::ProofFiles> files_;
  std::optional<runtime::CompletenessClaim> claim_;
  PlanReservations reservations_;
  std::string verdict_ = "no proof", origin_;
};

}  // namespace parallax::tools
