// A proof that a list of traces is complete.
//
// The claim is a formula without a model: the clauses of the compiled model and, for each listed
// trace, one clause that says that some observable is different. With state constraints it also
// chooses a length at which the trace ends, or that it goes on, and a blocking clause binds its
// own length. The search for traces can log a DRAT proof as it goes: clauses that define new
// variables are logged with the new literal first (RAT), and each unsatisfiable call as the
// clause that its assumptions contradict each other. If the checker does not accept the log, a
// fresh solver proves the claim. Formula and proof are checked as they are on the disk
// (drat_checker.cc), so nothing that made them has to be trusted.
//
// Cost: linear in the model and in observables times traces, and one proof.

#include "runtime/certify/certificate.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <utility>
#include <vector>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/shown_text.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

using compiler::AtomKind;
using compiler::Literal;

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kWrittenAtOnce = std::size_t{1} << 16U;

/// The clauses that end with the trace hold at timepoint t, 1 .. horizon; numbered as a session
/// does.
Literal trace_reaches(const CompiledModel& model, const LengthVariables& lengths, Timepoint t) {
  PARALLAX_REQUIRE(has_ending_clauses(model), "a model with such clauses");
  return Literal::positive(lengths.last() + t);
}

base::Reported not_writable(const fs::path& path, int error, base::DiagnosticSink& sink) {
  return sink.error_about(codes::kFileNotWritable, path.string(),
                          std::strerror(error != 0 ? error : EIO));
}

class LoggedSolver final : public SatSolver {
 public:
  LoggedSolver(std::FILE* proof, const CompletenessClaim& claim, const std::atomic<bool>* stop)
      : proof_(proof),
        claim_variables_(claim.variables()),
        solver_(make_proving_solver(proof, ProofForm::kBinary, stop, ProofUse::kIncremental)) {
    for (const auto literal : claim.given()) log(std::span(&literal, 1));
  }

  void add_clause(std::span<const Literal> clause) override {
    if (solver_->solve_calls() > 0) log_addition(clause);
    solver_->add_clause(clause);
  }
  void assume(Literal literal) override {
    assumed_.push_back(literal);
    solver_->assume(literal);
  }
  SolveStatus solve() override {
    const auto status = solver_->solve();
    if (status == SolveStatus::kUnsatisfiable) log_core();
    assumed_.clear();
    return status;
  }
  bool value(Literal literal) const override { return solver_->value(literal); }
  bool failed(Literal literal) const override { return solver_->failed(literal); }
  bool is_fixed(Literal literal) const override { return solver_->is_fixed(literal); }
  void set_phase(Literal literal) override { solver_->set_phase(literal); }
  void limit_conflicts(std::int64_t most) override { solver_->limit_conflicts(most); }
  std::int64_t conflicts() const override { return solver_->conflicts(); }
  std::int64_t solve_calls() const override { return solver_->solve_calls(); }

 private:
  void log_addition(std::span<const Literal> clause) {
    if (clause.empty()) return;
    clause_.assign(clause.begin(), clause.end());
    const auto last = std::max_element(clause_.begin(), clause_.end(),
                                       [](Literal a, Literal b) { return a.var() < b.var(); });
    if (clause_.size() > 1 && last->var() <= claim_variables_) return;
    std::iter_swap(clause_.begin(), last);
    log(clause_);
  }
  void log_core() {
    clause_.clear();
    for (const auto literal : assumed_) {
      if (solver_->failed(literal)) clause_.push_back(~literal);
    }
    log(clause_);
  }
  /// Binary DRAT: `a`, each literal as 2v or 2v + 1 in groups of 7 bits, 0.
  void log(std::span<const Literal> clause) {
    std::fputc('a', proof_);
    for (const auto literal : clause) {
      auto code =
          2U * static_cast<std::uint32_t>(literal.var()) + (literal.is_positive() ? 0U : 1U);
      for (; code > 127; code >>= 7U) std::fputc(static_cast<int>((code & 127U) | 128U), proof_);
      std::fputc(static_cast<int>(code), proof_);
    }
    std::fputc(0, proof_);
  }

  std::FILE* proof_;
  std::int64_t claim_variables_;
  std::unique_ptr<SatSolver> solver_;
  std::vector<Literal> assumed_, clause_;
};

base::Status write_formula(const ProofClaim& claim, const ProofFiles& files,
                           base::DiagnosticSink& sink) {
  errno = 0;
  std::ofstream out(files.formula_part(), std::ios::binary | std::ios::trunc);
  claim.write_dimacs(out);
  out.close();
  if (out) return base::Unit{};
  return sink.error_about(codes::kFileNotWritable, files.formula_path().string(),
                          std::strerror(errno != 0 ? errno : ENOSPC));
}

SolveStatus write_proof(const ProofClaim& claim, const ProofFiles& files,
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
ProofReport make_proof(const ProofClaim& claim, ProofFiles& files, const ProofLimits& limits,
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

CompletenessClaim::CompletenessClaim(const CompiledModel& model)
    : model_(model),
      lengths_(model),
      index_(model),
      variables_(model.has_constraints ? lengths_.last() : model.variable_count()) {
  if (model.has_constraints && has_ending_clauses(model)) variables_ += model.horizon;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    const auto kind = atom.kind;
    const bool result = kind == AtomKind::kResult && model.has_constraints;
    if (kind != AtomKind::kHoldsAt && kind != AtomKind::kHappens && !result) return;
    const auto name = result ? to_string(kind, atom.plan) : atom.name;
    observables_.push_back({atom.literal(), kind, atom.time.value_or(0), atom.number, name});
  });
}

/// Two traces of this length are one if they agree on the keys.
bool CompletenessClaim::is_key(const Observable& observable, Timepoint length) const {
  if (!model_.has_constraints) return true;
  // The object that a perform returned is known one timepoint later.
  const auto last = observable.kind == AtomKind::kResult ? length : length - 1;
  return observable.kind != AtomKind::kHoldsAt && observable.time <= last;
}

void CompletenessClaim::add(const Trace& trace) {
  Found found{trace.length(), std::vector<bool>(observables_.size(), false)};
  for (std::size_t i = 0; i < observables_.size(); ++i) {
    const auto& observable = observables_[i];
    if (!is_key(observable, found.length)) continue;
    if (observable.kind == AtomKind::kResult) {
      const auto& before = trace.points[static_cast<std::size_t>(observable.time) - 1];
      found.values[i] = before.returned == observable.name;
      continue;
    }
    const auto& point = trace.points[static_cast<std::size_t>(observable.time)];
    found.values[i] = observable.kind == AtomKind::kHoldsAt
                          ? contains(point.holds, compiler::FluentId(observable.number))
                          : contains(point.happens, compiler::EventId(observable.number));
  }
  traces_.push_back(std::move(found));
}

std::vector<Literal> CompletenessClaim::given() const {
  std::vector<Literal> literals;
  for (Timepoint t = 1; t <= model_.horizon; ++t) literals.push_back(lengths_.reaches(t));
  for (Timepoint t = 1; t <= model_.horizon; ++t) {
    if (model_.has_constraints || !has_ending_clauses(model_)) break;
    literals.push_back(trace_reaches(model_, lengths_, t));
  }
  return literals;
}

/// Clauses that end with the trace are guarded: behind its end no plan is followed.
void CompletenessClaim::visit_model(const Visit& visit) const {
  std::vector<Literal> guarded;
  for (std::size_t i = 0; i < model_.clauses.size(); ++i) {
    const auto t = model_.clause_timepoints[i];
    const bool ends = model_.has_constraints && t > 0 && ends_with_trace(model_, i);
    if (!ends) {
      visit(model_.clauses[i]);
      continue;
    }
    guarded.assign(model_.clauses[i].begin(), model_.clauses[i].end());
    guarded.push_back(~trace_reaches(model_, lengths_, t));
    visit(guarded);
  }
}

/// States that a trace that ends at n meets the constraints there and at no earlier timepoint (0
/// counts if it has a hit atom).
void CompletenessClaim::visit_end(Timepoint n, const Visit& visit) const {
  const auto imply = [&](Literal consequence) {
    const Literal clause[] = {~lengths_.ends(n), consequence};
    visit(clause);
  };
  for (Timepoint t = 1; t <= n && has_ending_clauses(model_); ++t) {
    imply(trace_reaches(model_, lengths_, t));
  }
  for (Timepoint t = 0; t <= n; ++t) {
    const auto hit = index_.hit(t);
    PARALLAX_REQUIRE(hit.has_value() || t == 0, "every timepoint from 1 has its hit atom");
    if (hit) imply(t == n ? *hit : ~*hit);
  }
}

/// A trace that goes on never meets the constraints within the horizon.
void CompletenessClaim::visit_going_on(const Visit& visit) const {
  const auto imply = [&](Literal consequence) {
    const Literal clause[] = {~lengths_.goes_on(), consequence};
    visit(clause);
  };
  for (Timepoint t = 1; t <= model_.horizon && has_ending_clauses(model_); ++t) {
    imply(trace_reaches(model_, lengths_, t));
  }
  for (Timepoint t = 0; t <= model_.horizon; ++t) {
    if (const auto hit = index_.hit(t)) imply(~*hit);
  }
  if (const auto running = index_.running(model_.horizon)) {
    imply(*running);
  }
}

void CompletenessClaim::visit_lengths(const Visit& visit) const {
  if (!model_.has_constraints) return;
  std::vector<Literal> some;
  if (may_go_on_) {
    some.push_back(lengths_.goes_on());
    visit_going_on(visit);
  }
  const bool hits_at_start = index_.hit(0).has_value();
  for (Timepoint n = hits_at_start ? 0 : 1; n <= model_.horizon; ++n) {
    some.push_back(lengths_.ends(n));
    visit_end(n, visit);
  }
  visit(some);
}

void CompletenessClaim::visit_traces(const Visit& visit) const {
  std::vector<Literal> clause;
  for (const auto& found : traces_) {
    clause.clear();
    if (model_.has_constraints) clause.push_back(~lengths_.ends(found.length));
    for (std::size_t i = 0; i < observables_.size(); ++i) {
      if (!is_key(observables_[i], found.length)) continue;
      clause.push_back(found.values[i] ? ~observables_[i].literal : observables_[i].literal);
    }
    visit(clause);
  }
}

void CompletenessClaim::for_each_clause(const Visit& visit) const {
  visit_model(visit);
  visit_lengths(visit);
  visit_traces(visit);
}

std::string CompletenessClaim::comment() const {
  auto out = fmt::format(
      "c No model: these are all traces of the model up to timepoint {}.\n"
      "c First its {} clauses, at the end {} for the traces that were listed.\n",
      model_.horizon, model_.clauses.size(), traces_.size());
  for (const auto& source : model_.sources) {
    out += fmt::format("c source {} {:016x}\n", base::printable(source.name), source.hash);
  }
  for (const auto& observable : observables_) {
    out += fmt::format("c map {} {}({},{})\n", observable.literal.dimacs(),
                       compiler::to_string(observable.kind), observable.name, observable.time);
  }
  return out;
}

void ProofClaim::write_dimacs(std::ostream& out) const {
  std::int64_t clauses = 0;
  for_each_clause([&](std::span<const Literal>) { ++clauses; });
  out << comment() << fmt::format("p cnf {} {}\n", variables(), clauses);
  std::string text;
  const auto write = [&] {
    if (out) out << text;
    text.clear();
  };
  for_each_clause([&](std::span<const Literal> clause) {
    for (const auto literal : clause) {
      std::array<char, 16> digits{};
      const auto [end, error] =
          std::to_chars(digits.data(), digits.data() + digits.size(), literal.dimacs());
      text.append(digits.data(), end);
      text += ' ';
    }
    text += "0\n";
    if (text.size() > kWrittenAtOnce) write();
  });
  write();
}

base::Result<ProofFiles> ProofFiles::create(const fs::path& proof, base::DiagnosticSink& sink) {
  ProofFiles files(proof);
  for (const auto& path : {files.proof_path(), files.formula_path()}) {
    std::error_code error;
    const auto status = fs::status(path, error);
    if (fs::exists(status) && !fs::is_regular_file(status)) {
      return sink.error_about(codes::kNotARegularFile, path.string());
    }
  }
  files.present_ = true;
  for (const auto& part : {files.proof_part(), files.formula_part()}) {
    std::error_code ignored;  // a link would be written through
    fs::remove(part, ignored);
  }
  files.proof_ = std::fopen(files.proof_part().c_str(), "wb");
  if (files.proof_ == nullptr) return not_writable(proof, errno, sink);
  errno = 0;
  if (!std::ofstream(files.formula_part())) return not_writable(files.formula_path(), errno, sink);
  return files;
}

ProofFiles::ProofFiles(ProofFiles&& other) noexcept
    : proof_path_(other.proof_path_),
      proof_(std::exchange(other.proof_, nullptr)),
      present_(std::exchange(other.present_, false)) {}

ProofFiles::~ProofFiles() {
  if (proof_ != nullptr) std::fclose(proof_);
  if (!present_) return;
  std::error_code ignored;
  fs::remove(proof_part(), ignored);
  fs::remove(formula_part(), ignored);
}

base::Status ProofFiles::restart(base::DiagnosticSink& sink) {
  std::fclose(std::exchange(proof_, nullptr));  // errors do not matter any more
  proof_ = std::fopen(proof_part().c_str(), "wb");
  if (proof_ == nullptr) return not_writable(proof_path_, errno, sink);
  return base::Unit{};
}

base::Status ProofFiles::close(base::DiagnosticSink& sink) {
  errno = 0;
  const bool failed =
      std::ferror(proof_) != 0 || std::fflush(proof_) != 0 || fsync(fileno(proof_)) != 0;
  const bool closed = std::fclose(std::exchange(proof_, nullptr)) == 0;
  if (failed || !closed) return not_writable(proof_path_, errno != 0 ? errno : ENOSPC, sink);
  return base::Unit{};
}

base::Status ProofFiles::keep(base::DiagnosticSink& sink) {
  std::error_code error;
  fs::rename(formula_part(), formula_path(), error);
  if (!error) fs::rename(proof_part(), proof_path_, error);
  if (error) return not_writable(proof_path_, error.value(), sink);
  present_ = false;
  return base::Unit{};
}

std::unique_ptr<SatSolver> make_logged_solver(std::FILE* proof, const CompletenessClaim& claim,
                                              const std::atomic<bool>* stop) {
  return std::make_unique<LoggedSolver>(proof, claim, stop);
}

Certificate prove(const ProofClaim& claim, ProofFiles& files, const ProofLimits& limits,
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
    sink.error_about(codes::kProofRejected, subject, report.reason);
  } else if (report.verdict == ProofVerdict::kNotFinished) {
    if (!report.reason.empty()) {
      sink.error_about(codes::kProofNotChecked, subject, report.reason);
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
