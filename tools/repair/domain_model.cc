#include "tools/repair/domain_model.h"

#include <filesystem>
#include <utility>

#include "compiler/base/diagnostic_printer.h"
#include "compiler/cnf/encoder.h"
#include "compiler/ground/grounder.h"
#include "compiler/sema/check.h"

namespace parallax::tools {

std::unique_ptr<DomainModel> load_domain(const harness::Scenario& scenario,
                                         const Context& context) {
  auto domain = std::make_unique<DomainModel>();
  base::DiagnosticSink unread;
  compiler::LoadOptions load;
  load.named_by = {scenario.file};
  load.allow_outside = context.form().allow_outside;
  std::vector<std::filesystem::path> paths;
  for (const auto& model : scenario.models) paths.emplace_back(model.text);
  auto ast = compiler::load_model(paths, load, domain->files, unread);
  if (!ast) return nullptr;
  domain->ast = *std::move(ast);
  compiler::CheckOptions check;
  check.time_lower = 0;
  check.time_upper = 1;
  auto typed = compiler::check_model(domain->ast, domain->files, unread, check);
  if (!typed) return nullptr;
  domain->typed = *std::move(typed);
  domain->forms = compiler::repairable_forms(domain->ast, domain->files);
  return domain;
}

std::unique_ptr<DomainModel> domain_of_text(const std::string& text) {
  auto domain = std::make_unique<DomainModel>();
  base::DiagnosticSink unread;
  const auto file = domain->files.add("edited.e", text);
  auto ast = compiler::load_model_text(file, ".", {}, domain->files, unread);
  if (!ast) return nullptr;
  domain->ast = *std::move(ast);
  compiler::CheckOptions check;
  check.time_lower = 0;
  check.time_upper = 1;
  auto typed = compiler::check_model(domain->ast, domain->files, unread, check);
  if (!typed) return nullptr;
  domain->typed = *std::move(typed);
  domain->forms = compiler::repairable_forms(domain->ast, domain->files);
  return domain;
}

std::optional<compiler::CompiledModel> compile_text(const std::string& text, std::int64_t horizon,
                                                    const Context& context, std::string& why) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto refuse = [&] {
    why = "stopped";
    for (const auto& diagnostic : sink.sorted()) {
      if (base::info(diagnostic.code).severity != base::Severity::kError) continue;
      why = diagnostic.message;
      break;
    }
    return std::nullopt;
  };
  const auto file = files.add("edited.e", text);
  const auto ast = compiler::load_model_text(file, ".", {}, files, sink);
  if (!ast) return refuse();
  compiler::CheckOptions check;
  check.time_lower = 0;
  check.time_upper = horizon;
  const auto typed = compiler::check_model(*ast, files, sink, check);
  if (!typed) return refuse();
  compiler::GroundOptions options;
  options.stop = &context.stop();
  auto ground = compiler::ground_model(*typed, options, sink);
  if (!ground) return refuse();
  return compiler::encode(*ground);
}

}  // namespace parallax::tools
