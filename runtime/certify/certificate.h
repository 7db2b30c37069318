#pragma once

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/diagnostic.h"
#include "runtime/proof/drat_checker.h"
#include "runtime/session/solver_session.h"
#include "runtime/solver/sat_solver.h"
#include "runtime/trace/trace.h"

namespace parallax::runtime {

/// A formula that has no model if what it claims is true.
class ProofClaim {
 public:
  virtual ~ProofClaim() = default;
  virtual std::int64_t variables() const = 0;
  using Visit = std::function<void(std::span<const compiler::Literal>)>;
  /// Visits the same clauses in the same order each time.
  virtual void for_each_clause(const Visit& visit) const = 0;
  /// `c` lines that say what is claimed.
  virtual std::string comment() const = 0;
  /// Returns when the stream fails.
  void write_dimacs(std::ostream& out) const;
};

/// "The model has no trace but these", as a formula that has no model if that is true: the clauses
/// of the compiled model and one blocking clause for every trace.
///
/// Without state constraints a trace is a valuation of HoldsAt and Happens at the full horizon, and
/// its clause says that one of them is different. With constraints a trace is a sequence of events
/// and of what performs returned, up to the first hit, in a valuation of the full horizon. Then the
/// formula also chooses a length, by variables beyond those of the model: `ends` n implies that the
/// constraints hold at n and not before; a blocking clause binds the length that its trace has.
class CompletenessClaim final : public ProofClaim {
 public:
  /// `model` outlives the claim.
  explicit CompletenessClaim(const CompiledModel& model);

  /// For models with constraints: executions that do not end by the horizon may be left.
  void limit_to_horizon() { may_go_on_ = false; }
  /// Traces as they were listed. Memory: one bit for each observable atom.
  void add(const Trace& trace);
  std::int64_t traces() const { return static_cast<std::int64_t>(traces_.size()); }

  std::int64_t variables() const override { return variables_; }
  /// Literals that a search for traces may assume: the claim is about the whole horizon.
  std::vector<compiler::Literal> given() const;
  void for_each_clause(const Visit& visit) const override;
  /// Names the variables of observable atoms.
  std::string comment() const override;

 private:
  struct Observable {
    compiler::Literal literal;
    compiler::AtomKind kind;
    Timepoint time;
    std::uint32_t number;  // of the fluent or event
    std::string name;
  };
  struct Found {
    Timepoint length;
    std::vector<bool> values;  // by observable, as far as they exist
  };

  bool is_key(const Observable& observable, Timepoint length) const;
  void visit_model(const Visit& visit) const;
  void visit_lengths(const Visit& visit) const;
  void visit_end(Timepoint n, const Visit& visit) const;
  void visit_going_on(const Visit& visit) const;
  void visit_traces(const Visit& visit) const;

  const CompiledModel& model_;
  LengthVariables lengths_;
  compiler::AtomIndex index_;
  std::vector<Observable> observables_;
  std::vector<Found> traces_;
  std::int64_t variables_;
  bool may_go_on_ = true;
};

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
  /// Names of the files until they are kept.
  std::filesystem::path formula_part() const { return formula_path().string() + ".part"; }
  std::filesystem::path proof_part() const { return proof_path_.string() + ".part"; }

  /// Makes everything written so far readable. False: a part of it was lost.
  bool flush() const { return std::fflush(proof_) == 0 && std::ferror(proof_) == 0; }
  /// Drops everything written to the proof; reports kFileNotWritable.
  base::Status restart(base::DiagnosticSink& sink);
  /// Writes everything to the disk and closes the proof; reports kFileNotWritable.
  base::Status close(base::DiagnosticSink& sink);
  /// Gives the files their final names.
  base::Status keep(base::DiagnosticSink& sink);

 private:
  explicit ProofFiles(std::filesystem::path proof) : proof_path_(std::move(proof)) {}
  std::filesystem::path proof_path_;
  std::FILE* proof_ = nullptr;
  bool present_ = false;
};

/// A solver for a session that searches for traces in many calls, whose log is a DRAT proof of the
/// calls' results: in the end, if they found all traces, of the claim.
///
/// Clauses that are added before the first call are those of the model. Later ones that only have
/// variables of the claim are taken for its blocking clauses, unless they are units; the others are
/// logged, the literal of their largest variable first: if that is new, the clause is a definition,
/// which DRAT admits (RAT). The result of an unsatisfiable call is logged as the clause that its
/// assumptions contradict each other.
///
/// The log is checked like any other proof: nothing here has to be trusted. `proof` outlives the
/// solver; the caller flushes it and asks for errors.
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
Certificate prove(const ProofClaim& claim, ProofFiles& files, const ProofLimits& limits,
                  base::DiagnosticSink& sink, bool logged = false);

}  // namespace parallax::runtime
