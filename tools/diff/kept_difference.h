#pragma once

#include <optional>
#include <string>

#include "tools/diff/model_difference.h"

namespace parallax::tools {

/// The comparison of the texts of two runs, or the reason why there is none.
struct KeptComparison {
  std::optional<ModelDifference> difference;
  std::string refused;      // "r kept no texts"; empty where there is a difference
  bool is_altered = false;  // texts are there, and are not those that the run read
};

/// Compares the scenarios of two run folders by the texts that the runs kept: settings,
/// declarations and axioms, plan and bindings, without solving anything. Places are named as below
/// the root of each. The texts must have the hash that the run's journal records. Nothing is
/// reported.
KeptComparison compare_kept(const std::string& old_folder, const std::string& new_folder,
                            Context& context);

/// The differences as lines, as `parallax diff` shows those of two scenarios; empty: none.
std::string kept_text(const ModelDifference& found, bool stat);

}  // namespace parallax::tools
