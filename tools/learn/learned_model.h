#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/app/context.h"
#include "tools/learn/effect_learner.h"

namespace parallax::tools {

/// The learned model in the standard layout: the statements without events (`states`), each rule
/// with the runs that taught it, axioms that nothing else changes what rules leave open, and the
/// start. `heading`: comment lines.
std::string learned_text(const std::string& heading, const std::string& states,
                         const LearnedEffects& effects, const LearnVocabulary& vocabulary,
                         const std::string& start);

/// "runs 1/1.1, 1/1.2, 2/1.1, 2/1.4 and 7 more"
std::string named_runs(const std::vector<std::string>& runs);

/// Checks the compiled text of a model against the runs that it was learned from.
struct RunsCheck {
  std::string wrong;  // the text is no right model
  std::size_t admitted = 0, runs = 0;
  std::string first;  // that is not: "run 1/1.4 at 3"
};

/// `forbidden`: may the rules forbid events that the world refused? Then such a step is one where
/// the event does not happen and the model says that it cannot.
RunsCheck check_runs(const std::string& text, const std::vector<Evidence>& runs,
                     const std::vector<LearnedRule>& rules, const LearnVocabulary& vocabulary,
                     const Context& context);

}  // namespace parallax::tools
