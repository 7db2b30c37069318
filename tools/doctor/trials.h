#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "compiler/base/subprocess.h"
#include "harness/world/world_spec.h"
#include "tools/doctor/doctor.h"

namespace parallax::tools {

/// Runs a program in `folder`, without input, for at most 30 s.
class TrialRunner {
 public:
  TrialRunner(std::filesystem::path folder, const std::atomic<bool>& stop)
      : folder_(std::move(folder)), stop_(stop) {}

  const std::filesystem::path& folder() const { return folder_; }
  bool is_stopped() const { return stop_.load(); }
  /// A program that is looked up in PATH.
  base::Captured run(const std::vector<std::string>& command,
                     const std::string& program = {}) const;
  /// This program.
  base::Captured run_parallax(std::vector<std::string> arguments) const;
  bool write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path folder_;
  const std::atomic<bool>& stop_;
};

CheckUp try_solver(const TrialRunner& runner);
CheckUp try_simulator(const TrialRunner& runner);
/// An engine that is a module: a ball falls as far as it has to.
CheckUp try_engine(harness::EngineKind engine);
CheckUp try_sdf();
CheckUp try_urdf();
CheckUp try_mjcf();
/// Also that a hull can be made.
CheckUp try_meshes();
CheckUp try_git(const TrialRunner& runner);
CheckUp try_python(const TrialRunner& runner);

}  // namespace parallax::tools
