#include "tools/repair/world_files.h"

#include <filesystem>
#include <set>
#include <system_error>

#include "compiler/syntax/loader.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

/// A name without links, by which a file is known again.
std::string real_name(const std::string& name) {
  std::error_code error;
  const auto real = fs::weakly_canonical(name, error);
  return error ? name : real.generic_string();
}

std::vector<std::string> loaded_from(const std::vector<harness::LocatedText>& models,
                                     const harness::Scenario& scenario, const Context& context) {
  std::vector<std::string> out;
  if (models.empty()) return out;
  base::SourceFiles files;
  base::DiagnosticSink unread;  // the scenario was loaded before, so that it was reported
  compiler::LoadOptions load;
  load.named_by = {scenario.file};
  load.allow_outside = context.form().allow_outside;
  std::vector<fs::path> paths;
  for (const auto& model : models) paths.emplace_back(model.text);
  if (!compiler::load_model(paths, load, files, unread)) return out;
  for (std::uint32_t i = 0; i < files.size(); ++i) out.push_back(files[base::FileId(i)].name());
  return out;
}

}  // namespace

std::vector<std::string> world_files(const harness::Scenario& scenario, const Context& context) {
  return loaded_from(scenario.simulator.models, scenario, context);
}

std::vector<std::string> model_files(const harness::Scenario& scenario, const Context& context) {
  return loaded_from(scenario.models, scenario, context);
}

std::vector<std::string> read_by_world(const harness::Scenario& scenario,
                                       const std::vector<ChangedFile>& files,
                                       const Context& context) {
  std::set<std::string> world;
  for (const auto& name : world_files(scenario, context)) world.insert(real_name(name));
  std::vector<std::string> out;
  for (const auto& file : files) {
    if (world.contains(real_name(file.name))) out.push_back(file.name);
  }
  return out;
}

}  // namespace parallax::tools
