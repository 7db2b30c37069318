#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/app/model_options.h"

namespace parallax::tools {

/// Everything that `compile --emit` prints, in the order in which it comes about.
std::vector<compiler::PassInfo> emit_stages();
/// The stages a line each, with what they are.
std::string stage_list();

/// Is it a stage before grounding: tokens, ast, typed, lp?
bool is_front_end_stage(std::string_view stage);

/// The models after that stage as text: the tokens with their places, the statements as the printer
/// writes them, the checked model, or the checked model as a logic program for clingo. What is
/// wrong with the models is in the sink; then nothing is printed.
base::Result<std::string> front_end_text(std::string_view stage, const ModelOptions& options,
                                         Context& context);

}  // namespace parallax::tools
