#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/result.h"
#include "harness/config/scenario.h"
#include "tools/app/context.h"
#include "tools/repair/patch.h"

namespace parallax::tools {

/// Copies of the files that a scenario reads, which may be changed, in the same relative places as
/// the originals. A world that is a model and reads files of the scenario's model has copies of its
/// own, which stay unchanged: the scenario's copy names those.
class ScenarioCopy {
 public:
  /// Copies the files that `context` has read from its file `first_file` and input `first_input`
  /// on. Reports files that cannot be written, and a world that cannot be given copies of its own.
  static base::Result<ScenarioCopy> make(const harness::Scenario& scenario,
                                         const std::filesystem::path& folder,
                                         std::size_t first_file, std::size_t first_input,
                                         Context& context);

  const std::filesystem::path& scenario() const { return scenario_; }
  /// The same changes, of the copies of these originals. Reports a file that the copied scenario
  /// does not read from a copy.
  base::Result<std::vector<ChangedFile>> in_copies(std::vector<ChangedFile> files,
                                                   Context& context) const;
  /// The originals whose copies have changed, by name.
  base::Result<std::vector<ChangedFile>> changes(Context& context) const;

 private:
  struct Copy {
    std::string name;  // of the original, as it is told
    std::filesystem::path target;
    std::string original, text;  // as it is there, and as it was copied
  };
  base::Status freeze_world(const harness::Scenario& scenario, const std::filesystem::path& root,
                            Context& context);
  base::Status look_at_reads(Context& context);
  bool is_copy(const std::string& name) const;

  std::filesystem::path scenario_;
  std::map<std::string, Copy> copies_;  // by the originals' absolute names
  std::set<std::string> read_;  // absolute names of the files that the copied scenario names
};

}  // namespace parallax::tools
