#include "compiler/sema/name_advice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "compiler/base/suggest.h"
#include "compiler/syntax/lexer.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMostNames = 20'000;
constexpr std::size_t kMostErrors = 20;  // later ones are not shown

}  // namespace

std::string with_article(std::string_view noun) {
  const bool vowel = !noun.empty() && std::string_view("aeiou").find(noun[0]) != noun.npos;
  return fmt::format("{} {}", vowel ? "an" : "a", noun);
}

std::string_view calculus_advice(std::string_view name, std::size_t arguments) {
  if (name == "Happens3" || (name == "Happens" && arguments == 3)) {
    return "an event that takes time is a predicate of the model: declare `predicate "
           "Happens3(event,time,time)`, write `[event,time] Happens(event,time) -> "
           "Happens3(event,time,time).`, one rule for each compound event, and `completion "
           "Happens3`; its effects are those of its parts";
  }
  if (name == "Clipped" || name == "Declipped") {
    return "add `load foundations/DEC.e`, which defines it";
  }
  if (name == "StoppedIn" || name == "StartedIn") {
    return "DEC3 and DEC4 hold by themselves; for other uses declare and define it, as `Clipped` "
           "is "
           "in `foundations/DEC.e`";
  }
  if (name == "Started" || name == "Stopped" || name == "Initiated" || name == "Terminated") {
    return "add `load foundations/ECCausal.e`, which defines it";
  }
  if (name == "AntiTrajectory" || name == "Trajectory") return "add `load foundations/EC.e`";
  return {};
}

std::string signature(const TypedModel& model, const Symbol& symbol) {
  std::string out = shortened(symbol.name) + "(";
  for (std::size_t i = 0; i < symbol.arguments.size(); ++i) {
    if (i != 0) out += ',';
    out += model.sorts[symbol.arguments[i]].name;
  }
  return out + ")";
}

std::string sort_name(const TypedModel& model, TermId id) {
  const Term& term = model.terms[id];
  switch (term.kind) {
    case TermKind::kVariable:
      return model.sorts[model.variables[term.variable].sort].name;
    case TermKind::kObject: {
      const auto& sorts = model.objects[term.object].sorts;
      return sorts.empty() ? std::string("?") : model.sorts[sorts.front()].name;
    }
    case TermKind::kApply: {
      const auto& result = model.symbols[term.symbol].result;
      return result ? model.sorts[*result].name : std::string("?");
    }
    case TermKind::kInteger:
    case TermKind::kArithmetic:
      return "integer";
  }
  return {};
}

bool NameAdvice::worthwhile(std::size_t names) const {
  return names <= kMostNames && sink_.error_count() <= kMostErrors;
}

std::optional<SymbolId> NameAdvice::symbol(std::string_view name,
                                           std::span<const SymbolKind> kinds) const {
  if (!worthwhile(model_.symbols.size())) return std::nullopt;
  std::vector<std::string> names;
  for (const auto& symbol : model_.symbols) {
    if (std::find(kinds.begin(), kinds.end(), symbol.kind) != kinds.end()) {
      names.push_back(symbol.name);
    }
  }
  const auto near = base::nearest_name(name, names);
  return near ? model_.find_symbol(*near) : std::nullopt;
}

std::optional<ObjectId> NameAdvice::object(std::string_view name) const {
  if (!worthwhile(model_.objects.size())) return std::nullopt;
  std::vector<std::string> names;
  for (const auto& object : model_.objects) names.push_back(object.name);
  const auto near = base::nearest_name(name, names);
  return near ? model_.find_object(*near) : std::nullopt;
}

std::optional<SortId> NameAdvice::sort(std::string_view name) const {
  if (!worthwhile(model_.sorts.size())) return std::nullopt;
  std::vector<std::string> names;
  for (const auto& sort : model_.sorts) names.push_back(sort.name);
  const auto near = base::nearest_name(name, names);
  return near ? model_.find_sort(*near) : std::nullopt;
}

std::string NameAdvice::constants_of(SortId sort) const {
  constexpr std::size_t kMostShown = 10;
  std::vector<std::string> shown;
  std::size_t count = 0;
  for (const auto& object : model_.objects) {
    if (!worthwhile(model_.objects.size())) break;
    const bool belongs = std::any_of(object.sorts.begin(), object.sorts.end(),
                                     [&](SortId own) { return model_.is_subsort(own, sort); });
    if (!belongs) continue;
    if (++count <= kMostShown) shown.push_back("`" + shortened(object.name) + "`");
  }
  const auto& name = model_.sorts[sort].name;
  if (count == 0) return {};
  return fmt::format("the constants of `{}`: {}{}", name, fmt::join(shown, ", "),
                     count > kMostShown ? fmt::format(" and {} more", count - kMostShown) : "");
}

std::string NameAdvice::replace(std::string_view wrong, std::string_view right) {
  return fmt::format("replace `{}` with `{}`", shortened(wrong), shortened(right));
}

}  // namespace parallax::compiler
