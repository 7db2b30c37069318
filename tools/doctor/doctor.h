#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace parallax::tools {

/// Trial of something that the program depends on. Each is tried, not looked up.
enum class Health : std::uint8_t {
  kWorks,
  kBroken,    // it is there, or has to be, and does not do what it should
  kAbsent,    // it is not there, and only what needs it is not to be had
  kNotTried,  // what it needs does not work, or the command was stopped
};

struct CheckUp {
  std::string name;
  Health health = Health::kNotTried;
  std::string found = {};    // the trial and its result
  std::string remedy = {};   // unless it works: what to do; may be empty
  std::string package = {};  // Debian's, where one would help
  bool is_needed = true;     // without it the program does not do its work
};

struct Library {
  std::string name, version;
};

struct Diagnosis {
  std::string version, solver_version, compiler, build_type, system;
  std::vector<Library> libraries;  // that it was built with
  std::int64_t cores = 0;
  std::vector<CheckUp> checks = {};

  /// Needed things that do not work, and optional ones that are there and do not.
  std::int64_t failures() const;
};

/// Solves a model whose traces are known, simulates a scenario, reads worlds of other formats,
/// starts the programs that commands call. The program itself is started as a child for what may
/// crash. Ends early when `stop` is raised.
Diagnosis diagnose(const std::atomic<bool>& stop);

std::string diagnosis_text(const Diagnosis& diagnosis);
/// One object and a newline.
std::string diagnosis_json(const Diagnosis& diagnosis);

}  // namespace parallax::tools
