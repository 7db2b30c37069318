#pragma once

#include <optional>
#include <string>

#include "tools/diff/model_difference.h"

namespace parallax::tools {

/// Compares the scenarios of two run folders by the texts that the runs kept: settings,
/// declarations and axioms, plan and bindings, without solving anything. Places are named as below
/// the root of each. None where one of them has not kept its texts, or they cannot be read any
/// more. Nothing is reported.
std::optional<ModelDifference> compare_kept(const std::string& old_folder,
                                            const std::string& new_folder, Context& context);

/// The differences as lines, as `parallax diff` shows those of two scenarios; empty: none.
std::string kept_text(const ModelDifference& found, bool stat);

}  // namespace parallax::tools
