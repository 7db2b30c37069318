#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "compiler/base/diagnostic.h"
#include "runtime/certify/completeness_claim.h"
#include "runtime/proof/drat_checker.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

/// The files of a proof while they are made: the DRAT proof under the name that was asked for, and
/// beside it, with `.cnf` appended, the DIMACS formula that it refutes. They get their names when
/// they are kept; else nothing stays behind.
class ProofFiles {
 public:
  /// Opens both for writing, so that a wrong name is told before the work: kFileNotWritable, or
  /// kNotARegularFile for a folder, device or pipe.
  static base::Result<ProofFiles> create(const std::filesystem::path& proof,
                                         base::DiagnosticSink& sink);
  ~ProofFiles();
  ProofFiles(ProofFiles&& other) noexcept;
  ProofFiles(const ProofFiles&) = delete;
  ProofFiles& operator=(const ProofFiles&) = delete;
  ProofFiles& operator=(ProofFiles&&) = delete;

  /// Where the solver writes.
  std::FILE* proof() const { return proof_; }
  std::filesystem::path formula_path() const { return proof_path_.string() + ".cnf"; }
  const std::filesystem::path& proof_path() const { return proof_path_; }
  /// Under these names they are until they are kept.
  std::filesystem::path formula_part() const { return formula_path().string() + ".part"; }
  std::filesystem::path proof_part() const { return proof_path_.string() + ".part"; }

  /// What was written so far can be read. False: a part of it was lost.
  bool flush() const { return std::fflush(proof_) == 0 && std::ferror(proof_) == 0; }
  /// Drops what was written to the proof; reports kFileNotWritable.
  base::Status restart(base::DiagnosticSink& sink);
  /// Everything was written to the disk; reports kFileNotWritable.
  base::Status close(base::DiagnosticSink& sink);
  /// Gives them their names.
  base::Status keep(base::DiagnosticSink& sink);

 private:
  explicit ProofFiles(std::filesystem::path proof) : proof_path_(std::move(proof)) {}
  std::filesystem::path proof_path_;
  std::FILE* proof_ = nullptr;
  bool present_ = false;
};

/// A solver for a session that looks for traces in many calls, whose log is a DRAT proof of what
/// the calls found: in the end, if they found all traces, of the claim.
///
/// Clauses that are added before the first call are those of the model. Later ones that only have
/// variables of the claim are taken for its blocking clauses, unless they are units; the others
/// are logged, the literal of their largest variable first: if that is new, the clause is a
/// definition, which DRAT admits (RAT). What an unsatisfiable call shows is logged as the clause
/// that its assumptions contradict each other.
///
/// The log is checked like any other proof: nothing here has to be trusted. `proof` outlives the
/// solver and is the caller's to flush and to ask for errors.
std::unique_ptr<SatSolver> make_logged_solver(std::FILE* proof, const CompletenessClaim& claim,
                                              const std::atomic<bool>* stop = nullptr);

enum class ProofOrigin : std::uint8_t {
  kSearch,      // the log of the solver that found the traces
  kFreshSolve,  // a solver that starts afresh refuted the claim
};

struct Certificate {
  ProofVerdict verdict = ProofVerdict::kNotFinished;
  ProofStatistics statistics;
  std::int64_t proof_bytes = 0;
  ProofOrigin origin = ProofOrigin::kFreshSolve;
};

/// Writes the claim and a proof of it, and has both checked as they are on the disk. If the search
/// was `logged` in the proof file, this log is tried first; if it is not accepted, or there is
/// none, a solver that starts afresh makes the proof. The files are kept if a proof is accepted.
/// Reports kFileNotWritable; kProofRejected, also where the solver finds a further trace;
/// kProofNotChecked if solver or checker were stopped.
Certificate prove(const CompletenessClaim& claim, ProofFiles& files, const ProofLimits& limits,
                  base::DiagnosticSink& sink, bool logged = false);

}  // namespace parallax::runtime
