#include "tools/app/certify.h"

#include <fmt/format.h>

#include <filesystem>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/pipeline/compile.h"
#include "runtime/certify/certificate.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "tools/app/trace_writer.h"

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

std::string PlanReservations::verdict() const {
  std::string out;
  if (orders) out += "not of every order, ";
  if (meaning) out += "approximated, ";
  if (cut) out += "within the bounds of loops and calls, ";
  return out + "no proof";
}

std::vector<std::pair<std::string, bool>> PlanReservations::fields() const {
  std::vector<std::pair<std::string, bool>> out;
  if (orders) out.emplace_back("every_order", false);
  if (meaning) out.emplace_back("approximated", true);
  if (cut) out.emplace_back("cut", true);
  return out;
}

bool may_be_cut(const runtime::CompiledModel& model) {
  const compiler::AtomIndex index(model);
  for (std::size_t cut = 0; cut < model.plan_cuts.size(); ++cut) {
    if (index.at(compiler::PlanCutId(static_cast<std::uint32_t>(cut)), model.horizon)) return true;
  }
  return false;
}

namespace {

void tell_gap(const compiler::PlanGap& gap, Context& context) {
  const bool orders = gap.kind == compiler::GapKind::kOrder;
  context.remark(fmt::format("{}: {} at {}", orders ? "not explored" : "approximated", gap.text,
                             context.files().place(gap.source)));
}

}  // namespace

void tell_reservations(const compiler::Compilation& compilation, Context& context) {
  if (compilation.plan) {
    for (const auto& gap : compilation.plan->gaps) tell_gap(gap, context);
  }
  const auto& model = compilation.model;
  const compiler::AtomIndex index(model);
  for (std::size_t cut = 0; cut < model.plan_cuts.size(); ++cut) {
    const compiler::PlanCutId id(static_cast<std::uint32_t>(cut));
    if (!index.at(id, model.horizon)) continue;
    context.remark(fmt::format("unrolling was cut: `{}` at {}", model.plan_cuts[cut].form,
                               place_text(model.plan_cuts[cut].place)));
  }
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
  runtime::ProofLimits limits;
  limits.stop = &context_.stop();
  const auto memory_mb = context_.form().memory_limit_mb;
  if (memory_mb > 0) limits.bytes = static_cast<std::size_t>(memory_mb) << 19U;  // the half
  const auto certificate = runtime::prove(*claim_, *files_, limits, context_.sink(), searched);
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
  if (!plan || plan->gaps.empty()) return;
  for (const auto& gap : plan->gaps) {
    const bool orders = gap.kind == compiler::GapKind::kOrder;
    (orders ? reservations_.orders : reservations_.meaning) = true;
    if (tells) tell_gap(gap, context_);
  }
  verdict_ = reservations_.verdict();
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
