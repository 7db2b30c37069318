#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "compiler/base/result.h"
#include "tools/app/context.h"
#include "tools/repair/patch.h"

namespace parallax::tools {

/// The files that a scenario reads, copied to where they may be changed; they lie to each other as
/// the originals do.
class ScenarioCopy {
 public:
  /// Of what `context` has read from its file `first_file` and input `first_input` on. Reports what
  /// cannot be written.
  static base::Result<ScenarioCopy> make(const std::filesystem::path& scenario,
                                         const std::filesystem::path& folder,
                                         std::size_t first_file, std::size_t first_input,
                                         Context& context);

  const std::filesystem::path& scenario() const { return scenario_; }
  /// The originals whose copies differ by now, by name.
  base::Result<std::vector<ChangedFile>> changes(Context& context) const;

 private:
  std::filesystem::path scenario_;
  std::map<std::string, std::pair<std::filesystem::path, std::string>> copies_;  // with the text
};

}  // namespace parallax::tools
