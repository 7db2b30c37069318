#pragma once

// Mistakes that people make in models of the event calculus, made in the text of a model that is
// right. Nothing here knows what a repair can change: a mistake is another text of one line. The
// list is the same in every run.

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "tools/bench/mistakes/axiom_text.h"

namespace parallax::tools {

enum class MistakeKind {
  kEffectDropped,
  kWrongSign,
  kWrongFluent,
  kWrongArgument,
  kConditionDropped,
  kConditionAdded,
  kTriggerDropped,
  kTriggerWrong,
  kNumberWrong,
  kConstraintWrong,
  kInitialFactWrong,
  kDefinitionWrong,
};

inline constexpr int kMistakeKinds = 12;

/// "wrong sign"
const char* to_string(MistakeKind kind);

/// One line of a model file replaced by another.
struct Mistake {
  MistakeKind kind = MistakeKind::kEffectDropped;
  bool in_start = false;  // in the file of initial facts
  std::size_t line = 0;   // counted from 0
  std::string text;       // empty: the line is left out
};

/// A model without mistakes: its declarations, its axioms and its initial facts, one on a line.
struct ModelText {
  std::vector<std::string> declarations, rules, start;
};

/// Events that an axiom demands, by name.
std::set<std::string> demanded_events(const ModelText& model);

/// Mistakes in the order of kinds and lines, at most `per_kind` of a kind, spread evenly over all
/// that the model has room for.
std::vector<Mistake> make_mistakes(const ModelText& model, std::size_t per_kind);

/// The lines of a file with the mistakes in it.
std::vector<std::string> with_mistakes(std::vector<std::string> lines,
                                       const std::vector<Mistake>& mistakes, bool is_start);

}  // namespace parallax::tools
