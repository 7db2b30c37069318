#include "tools/app/certify.h"

#include <fmt/format.h>

#include <filesystem>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "runtime/certify/certificate.h"
#include "runtime/enumerate/plan_enumerator.h"

namespace parallax::tools {
namespace {

constexpr const char* kUsualFile = "true";  // what CLI11 gives a flag without a value

/// domain.e, domain.dec.cnf: domain.drat, in the current folder.
std::string usual_file(const std::string& model) {
  auto name = std::filesystem::path(model).filename().string();
  return name.substr(0, name.find('.', 1)) + ".drat";
}

bool is_whole(const std::string& exploration) { return exploration != "stopped"; }

}  // namespace

runtime::ProofLimits proof_limits(const Context& context) {
  runtime::ProofLimits limits;
  limits.stop = &context.stop();
  const auto memory_mb = context.form().memory_limit_mb;
  if (memory_mb > 0) limits.bytes = static_cast<std::size_t>(memory_mb) << 19U;  // the half
  return limits;
}

TraceCertifier::TraceCertifier(const CertifyOption& option, const std::vector<std::string>& models,
                               const runtime::CompiledModel& model, Context& context)
    : option_(option), context_(context) {
  if (option.file.empty()) return;
  const auto path = option.file == kUsualFile ? usual_file(models.front()) : option.file;
  for (const auto* suffix : {"", ".cnf", ".part", ".cnf.part"}) {
    if (!base::check_output(path + suffix, context.files(), context.sink())) return;
  }
  auto files = runtime::ProofFiles::create(path, context.sink());
  if (!files) return;
  files_.emplace(*std::move(files));
  claim_.emplace(model);
}

void TraceCertifier::decline(const std::string& reason) {
  if (!files_) return;
  context_.sink().error_about(codes::kNothingProved, files_->proof_path().string(), reason);
}

std::unique_ptr<runtime::SatSolver> TraceCertifier::solver() {
  if (!files_) return runtime::make_cadical_solver(&context_.stop());
  return runtime::make_logged_solver(files_->proof(), *claim_, &context_.stop());
}

void TraceCertifier::conclude(const std::string& exploration, bool searched) {
  if (!files_) return;
  if (reservations_.any()) {
    if (option_.keep) decline("the plan may have executions that were not explored");
    return;
  }
  if (!is_whole(exploration)) return decline("the list was stopped before its end");
  if (exploration == runtime::to_string(runtime::Exploration::kCompleteUpToBound)) {
    claim_->limit_to_horizon();
  }
  const auto certificate =
      runtime::prove(*claim_, *files_, proof_limits(context_), context_.sink(), searched);
  switch (certificate.verdict) {
    case runtime::ProofVerdict::kAccepted:
      verdict_ = "proof checked";
      origin_ = certificate.origin == runtime::ProofOrigin::kSearch ? "search" : "fresh solve";
      break;
    case runtime::ProofVerdict::kRejected:
      verdict_ = "proof not accepted";
      return;
    case runtime::ProofVerdict::kNotFinished:
      verdict_ = "proof not checked";
      return;
  }
  if (!option_.keep) return;
  context_.remark(fmt::format("{}: {} bytes, {} lemmas, by {}, refutes {}",
                              files_->proof_path().string(), certificate.proof_bytes,
                              certificate.statistics.lemmas,
                              origin_ == "search" ? "the search itself" : "a fresh solve",
                              files_->formula_path().string()));
}

void TraceCertifier::rest_on_symmetry() {
  if (!files_ && !reservations_.any()) verdict_ = kBySymmetry;
}

void TraceCertifier::note_gaps(const std::optional<compiler::PlanGraph>& plan, bool tells) {
  const auto gaps = reservations_of(plan);
  if (!gaps.any()) return;
  reservations_.orders = reservations_.orders || gaps.orders;
  reservations_.meaning = reservations_.meaning || gaps.meaning;
  verdict_ = reservations_.verdict();
  if (!tells) return;
  for (const auto& text : gap_texts(plan, context_)) context_.remark(text);
}

void TraceCertifier::note_cut() {
  reservations_.cut = true;
  verdict_ = reservations_.verdict();
}

std::string TraceCertifier::remark(const std::string& exploration) const {
  return is_whole(exploration) ? fmt::format(" ({})", verdict_) : "";
}

std::string TraceCertifier::fields() const {
  const bool by_symmetry = verdict_ == kBySymmetry;
  const bool none = by_symmetry || reservations_.any() || verdict_ == "no proof";
  auto out = fmt::format("\"proof\":\"{}\",", none ? "none" : verdict_.substr(6));
  for (const auto& [name, value] : reservations_.fields()) {
    out += fmt::format("\"{}\":{},", name, value);
  }
  if (by_symmetry) out += "\"symmetry\":true,";
  if (verdict_ == "proof checked") out += fmt::format("\"proof_origin\":\"{}\",", origin_);
  if (verdict_ == "proof checked" && option_.keep) {
    const auto text = [](const std::filesystem::path& path) {
      return base::json_text(nlohmann::json(path.string()));
    };
    out += fmt::format("\"proof_file\":{},\"formula_file\":{},", text(files_->proof_path()),
                       text(files_->formula_path()));
  }
  return out;
}

}  // namespace parallax::tools
