#include "runtime/certify/proof_files.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "compiler/base/diagnostic_codes.h"

namespace parallax::runtime {
namespace {

namespace fs = std::filesystem;

base::Reported not_writable(const fs::path& path, int error, base::DiagnosticSink& sink) {
  return sink.error_about(base::DiagnosticCode::kFileNotWritable, path.string(),
                          std::strerror(error != 0 ? error : EIO));
}

}  // namespace

base::Result<ProofFiles> ProofFiles::create(const fs::path& proof, base::DiagnosticSink& sink) {
  ProofFiles files(proof);
  for (const auto& path : {files.proof_path(), files.formula_path()}) {
    std::error_code error;
    const auto status = fs::status(path, error);
    if (fs::exists(status) && !fs::is_regular_file(status)) {
      return sink.error_about(base::DiagnosticCode::kNotARegularFile, path.string());
    }
  }
  files.present_ = true;
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
  std::fclose(std::exchange(proof_, nullptr));  // what was lost does not matter any more
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

}  // namespace parallax::runtime
