#pragma once

#include <cstdio>
#include <filesystem>
#include <string>

#include "compiler/base/diagnostic.h"

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

}  // namespace parallax::runtime
