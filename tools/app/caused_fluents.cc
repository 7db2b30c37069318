#include "tools/app/caused_fluents.h"

#include <cstddef>
#include <map>
#include <optional>
#include <utility>

namespace parallax::tools {
namespace {

using compiler::TermKind;
using harness::GroundFluent;

/// The arguments of variables, by the text of a ground term that a pattern was matched with.
class Matcher {
 public:
  explicit Matcher(const compiler::TypedModel& model) : model_(model) {}

  /// Can the term be this ground one, given what its variables are? Terms that compute are taken
  /// for anything.
  bool match(const compiler::Term& pattern, const GroundFluent& ground) {
    if (pattern.arguments.size() != ground.arguments.size()) return false;
    for (std::size_t i = 0; i < ground.arguments.size(); ++i) {
      const auto& argument = model_.terms[pattern.arguments[i]];
      const auto& text = ground.arguments[i];
      if (argument.kind == TermKind::kVariable) {
        if (values_.emplace(argument.variable.index(), text).first->second != text) return false;
      } else if (const auto fixed = text_of(argument); fixed && *fixed != text) {
        return false;
      }
    }
    return true;
  }

 private:
  std::optional<std::string> text_of(const compiler::Term& term) const {
    if (term.kind == TermKind::kObject) return model_.objects[term.object].name;
    if (term.kind == TermKind::kInteger) return std::to_string(term.integer);
    return std::nullopt;
  }

  const compiler::TypedModel& model_;
  std::map<std::size_t, std::string> values_;  // by variable
};

}  // namespace

std::vector<harness::CausedFluent> caused_fluents(
    const compiler::TypedModel& model, const std::vector<GroundFluent>& events,
    const std::vector<GroundFluent>& fluents,
    const std::function<bool(const std::string&)>& is_asked) {
  std::map<std::string, std::vector<const GroundFluent*>> by_symbol;
  for (const auto& fluent : fluents) by_symbol[fluent.symbol].push_back(&fluent);
  std::vector<harness::CausedFluent> out;
  for (const compiler::EffectAxiom& effect : model.effects) {
    const auto &event = model.terms[effect.event], &fluent = model.terms[effect.fluent];
    const bool named = event.kind == TermKind::kApply && fluent.kind == TermKind::kApply;
    if (!named || effect.kind == compiler::EffectKind::kReleases) continue;
    const auto& event_symbol = model.symbols[event.symbol].name;
    if (!is_asked(event_symbol)) continue;
    for (const auto& happens : events) {
      if (happens.symbol != event_symbol) continue;
      Matcher matched(model);
      if (!matched.match(event, happens)) continue;
      for (const auto* holds : by_symbol[model.symbols[fluent.symbol].name]) {
        Matcher both = matched;
        if (!both.match(fluent, *holds)) continue;
        out.push_back({happens, *holds, effect.kind == compiler::EffectKind::kInitiates});
      }
    }
  }
  return out;
}

}  // namespace parallax::tools
