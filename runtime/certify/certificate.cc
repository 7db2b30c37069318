#include "runtime/certify/certificate.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "compiler/base/diagnostic_codes.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {
namespace {

using base::DiagnosticCode;

base::Status write_formula(const CompletenessClaim& claim, const ProofFiles& files,
                           base::DiagnosticSink& sink) {
  errno = 0;
  std::ofstream out(files.formula_part(), std::ios::binary | std::ios::trunc);
  claim.write_dimacs(out);
  out.close();
  if (out) return base::Unit{};
  return sink.error_about(DiagnosticCode::kFileNotWritable, files.formula_path().string(),
                          std::strerror(errno != 0 ? errno : ENOSPC));
}

SolveStatus write_proof(const CompletenessClaim& claim, const ProofFiles& files,
                        const ProofLimits& limits) {
  const auto solver = make_proving_solver(files.proof(), ProofForm::kBinary, limits.stop);
  claim.for_each_clause(
      [&](std::span<const compiler::Literal> clause) { solver->add_clause(clause); });
  return solver->solve();
}

ProofReport check_files(const ProofFiles& files, const ProofLimits& limits) {
  std::ifstream formula(files.formula_part(), std::ios::binary);
  std::ifstream proof(files.proof_part(), std::ios::binary);
  return check_proof(formula, proof, DratFormat::kBinary, limits);
}

/// The log of a search. It may use many variables of its own.
ProofReport check_log(const ProofFiles& files, ProofLimits limits) {
  if (!files.flush()) return {};
  limits.more_variables = 1U << 20U;
  return check_files(files, limits);
}

/// Makes the proof and has it checked.
ProofReport make_proof(const CompletenessClaim& claim, ProofFiles& files, const ProofLimits& limits,
                       base::DiagnosticSink& sink) {
  if (!files.restart(sink)) return {ProofVerdict::kNotFinished, {}, {}};
  switch (write_proof(claim, files, limits)) {
    case SolveStatus::kUnsatisfiable:
      break;
    case SolveStatus::kSatisfiable:
      return {ProofVerdict::kRejected, "the solver finds a trace that is not in the list", {}};
    case SolveStatus::kUnknown:
      return {ProofVerdict::kNotFinished, "it was stopped while it was made", {}};
  }
  if (!files.close(sink)) return {ProofVerdict::kNotFinished, {}, {}};
  return check_files(files, limits);
}

}  // namespace

Certificate prove(const CompletenessClaim& claim, ProofFiles& files, const ProofLimits& limits,
                  base::DiagnosticSink& sink, bool logged) {
  if (!write_formula(claim, files, sink)) return {};
  const auto log = logged ? check_log(files, limits) : ProofReport{};
  const bool log_fine = log.verdict == ProofVerdict::kAccepted;
  const auto report = log_fine ? log : make_proof(claim, files, limits, sink);
  if (log_fine && !files.close(sink)) return {};
  const auto subject = files.proof_path().string();
  Certificate certificate{report.verdict, report.statistics, 0,
                          log_fine ? ProofOrigin::kSearch : ProofOrigin::kFreshSolve};
  if (report.verdict == ProofVerdict::kRejected) {
    sink.error_about(DiagnosticCode::kProofRejected, subject, report.reason);
  } else if (report.verdict == ProofVerdict::kNotFinished) {
    if (!report.reason.empty()) {
      sink.error_about(DiagnosticCode::kProofNotChecked, subject, report.reason);
    }
  } else {
    std::error_code error;
    const auto bytes = std::filesystem::file_size(files.proof_part(), error);
    certificate.proof_bytes = error ? 0 : static_cast<std::int64_t>(bytes);
    if (!files.keep(sink)) return {};
  }
  return certificate;
}

}  // namespace parallax::runtime
