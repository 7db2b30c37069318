#include "tools/doctor/doctor.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"
#include "compiler/base/temporary_folder.h"
#include "compiler/base/words.h"
#include "tools/app/version.h"
#include "tools/doctor/build_facts.h"
#include "tools/doctor/trials.h"

namespace parallax::tools {
namespace {

CheckUp check_folder(const TrialRunner& runner) {
  CheckUp check{.name = "folder"};
  std::error_code error;
  const auto place = std::filesystem::temp_directory_path(error);
  if (!runner.folder().empty() && runner.write("text", "text\n")) {
    check.health = Health::kWorks;
    check.found = fmt::format("files can be written in {}", place.string());
    return check;
  }
  check.health = Health::kBroken;
  check.found = error ? "there is no folder for temporary files"
                      : fmt::format("no files can be written in {}", place.string());
  check.remedy = "let TMPDIR name a folder that is there, with space left, and yours to write";
  return check;
}

/// Without a place for its files.
CheckUp untried(std::string name) {
  return {.name = std::move(name), .found = "not tried: it needs a folder to write to"};
}

const char* word_for(const CheckUp& check) {
  switch (check.health) {
    case Health::kWorks:
      return "works";
    case Health::kBroken:
      return "broken";
    case Health::kAbsent:
      return "absent";
    case Health::kNotTried:
      return "not-tried";
  }
  return "";
}

bool is_failure(const CheckUp& check) {
  return check.health == Health::kBroken || (check.is_needed && check.health != Health::kWorks);
}

}  // namespace

std::int64_t Diagnosis::failures() const {
  return std::count_if(checks.begin(), checks.end(), is_failure);
}

Diagnosis diagnose(const std::atomic<bool>& stop) {
  Diagnosis diagnosis{.version = kVersion,
                      .solver_version = kCadicalVersion,
                      .compiler = kCompiler,
                      .build_type = kBuildType,
                      .system = kSystem,
                      .libraries = {},
                      .cores = std::thread::hardware_concurrency()};
  for (const auto& [name, version] : kLibraries) diagnosis.libraries.push_back({name, version});
  const base::TemporaryFolder folder("doctor");
  const TrialRunner runner(folder.path(), stop);
  auto& checks = diagnosis.checks;
  checks.push_back(check_folder(runner));
  const bool has_folder = checks.back().health == Health::kWorks;
  checks.push_back(has_folder ? try_solver(runner) : untried("solver"));
  checks.push_back(has_folder ? try_simulator(runner) : untried("simulator"));
  checks.push_back(try_engine(harness::EngineKind::kMujoco));
  checks.push_back(try_engine(harness::EngineKind::kBullet));
  checks.push_back(try_sdf());
  checks.push_back(try_urdf());
  checks.push_back(try_mjcf());
  checks.push_back(try_meshes());
  checks.push_back(try_git(runner));
  checks.push_back(try_python(runner));
  return diagnosis;
}

std::string diagnosis_text(const Diagnosis& diagnosis) {
  std::string text = fmt::format("parallax {} (CaDiCaL {})\nbuilt by {}, {}, for {}\n{} {}\n\n",
                                 diagnosis.version, diagnosis.solver_version, diagnosis.compiler,
                                 diagnosis.build_type, diagnosis.system, diagnosis.cores,
                                 base::agreed(diagnosis.cores, "core", "cores"));
  for (const auto& library : diagnosis.libraries) {
    text += fmt::format("  {:<20}  {}\n", library.name, library.version);
  }
  text += "\n";
  for (const auto& check : diagnosis.checks) {
    text += fmt::format("  {:<9}  {:<9}  {}\n", check.name, word_for(check),
                        base::printable(check.found));
    if (check.health == Health::kWorks) continue;
    if (!check.remedy.empty())
      text += fmt::format("  {:<22} {}\n", "", base::printable(check.remedy));
    if (!check.package.empty()) {
      text += fmt::format("  {:<22} apt-get install {}\n", "", check.package);
    }
  }
  const auto failures = diagnosis.failures();
  return text + (failures == 0   ? "\neverything that is needed works\n"
                 : failures == 1 ? "\n1 thing does not work\n"
                                 : fmt::format("\n{} things do not work\n", failures));
}

std::string diagnosis_json(const Diagnosis& diagnosis) {
  auto checks = nlohmann::ordered_json::array();
  for (const auto& check : diagnosis.checks) {
    nlohmann::ordered_json one{{"name", check.name},
                               {"health", word_for(check)},
                               {"needed", check.is_needed},
                               {"found", check.found}};
    if (check.health != Health::kWorks) {
      if (!check.remedy.empty()) one["remedy"] = check.remedy;
      if (!check.package.empty()) one["package"] = check.package;
    }
    checks.push_back(std::move(one));
  }
  auto libraries = nlohmann::ordered_json::object();
  for (const auto& library : diagnosis.libraries) libraries[library.name] = library.version;
  const nlohmann::ordered_json document{{"status", "ok"},
                                        {"version", diagnosis.version},
                                        {"cadical", diagnosis.solver_version},
                                        {"build",
                                         {{"compiler", diagnosis.compiler},
                                          {"type", diagnosis.build_type},
                                          {"system", diagnosis.system}}},
                                        {"libraries", std::move(libraries)},
                                        {"cores", diagnosis.cores},
                                        {"failures", diagnosis.failures()},
                                        {"checks", std::move(checks)}};
  return base::json_text(document) + "\n";
}

}  // namespace parallax::tools
