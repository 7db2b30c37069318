#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "compiler/base/temporary_folder.h"
#include "tools/diff/model_difference.h"

namespace parallax::tools {

/// The texts that two runs kept, unpacked into a temporary folder that goes with the object. They
/// must have the hash that the run's journal records. Nothing is reported.
class KeptPair {
 public:
  KeptPair(const std::string& old_folder, const std::string& new_folder, const Context& context);

  /// "r kept no texts"; empty: both have them.
  const std::string& refused() const { return refused_; }
  /// Texts are there, and are not those that the run read.
  bool is_altered() const { return is_altered_; }
  // The scenarios.
  const std::filesystem::path& before() const { return before_; }
  const std::filesystem::path& after() const { return after_; }

  /// Compares settings, declarations and axioms, plan and bindings, without solving anything.
  /// Places are named as below the root of each.
  std::optional<ModelDifference> compare(const Context& context) const;

 private:
  base::TemporaryFolder scratch_{"inputs"};
  std::filesystem::path before_, after_;
  std::string refused_;
  bool is_altered_ = false;
};

/// The comparison of the texts of two runs, or the reason why there is none.
struct KeptComparison {
  std::optional<ModelDifference> difference;
  std::string refused;      // "r kept no texts"; empty where there is a difference
  bool is_altered = false;  // texts are there, and are not those that the run read
};

/// Compares the scenarios of two run folders by the texts that the runs kept.
KeptComparison compare_kept(const std::string& old_folder, const std::string& new_folder,
                            Context& context);

/// The differences as lines, as `parallax diff` shows those of two scenarios; empty: none.
std::string kept_text(const ModelDifference& found, bool stat);

}  // namespace parallax::tools
