#include "tools/cli/trace_fact.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/suggest.h"

namespace parallax::tools {
namespace {

using compiler::AtomKind;

std::string without_blanks(const std::string& text) {
  std::string out;
  std::copy_if(text.begin(), text.end(), std::back_inserter(out),
               [](char c) { return c != ' ' && c != '\t'; });
  return out;
}

struct Parts {
  AtomKind kind = AtomKind::kPredicate;
  std::string name;
  std::string time;
};

/// `HoldsAt(F(a),3)` as HoldsAt, F(a), 3; anything else is the atom of a predicate.
Parts split(const std::string& text) {
  static constexpr std::pair<const char*, AtomKind> kKinds[] = {
      {"HoldsAt(", AtomKind::kHoldsAt},
      {"Happens(", AtomKind::kHappens},
      {"ReleasedAt(", AtomKind::kReleasedAt}};
  for (const auto& [head, kind] : kKinds) {
    if (!text.starts_with(head) || !text.ends_with(')')) continue;
    const auto begin = std::string(head).size();
    const auto comma = text.rfind(',');
    if (comma == std::string::npos || comma < begin) return {kind, text.substr(begin), ""};
    return {kind, text.substr(begin, comma - begin),
            text.substr(comma + 1, text.size() - comma - 2)};
  }
  return {AtomKind::kPredicate, text, ""};
}

std::vector<std::string> known_names(AtomKind kind, const compiler::CompiledModel& model) {
  if (kind == AtomKind::kHappens) return compiler::names_of(model.events);
  if (kind != AtomKind::kPredicate) return compiler::names_of(model.fluents);
  std::vector<std::string> names;
  for (const auto& atom : model.fixed) {
    if (atom.kind == AtomKind::kPredicate && !atom.time) names.push_back(atom.name);
  }
  return names;
}

}  // namespace

base::Result<TraceFact> parse_fact(const std::string& text, const compiler::CompiledModel& model,
                                   base::DiagnosticSink& sink) {
  auto plain = without_blanks(text);
  TraceFact fact;
  while (plain.starts_with('!')) {
    plain.erase(0, 1);
    fact.negated = !fact.negated;
  }
  const auto fail = [&](const std::string& problem) {
    return sink.error_about(base::DiagnosticCode::kNoSuchFact, "--why", text, problem);
  };
  const auto parts = split(plain);
  fact.kind = parts.kind;
  fact.name = parts.name;
  const auto names = known_names(fact.kind, model);
  const auto known = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (!known(fact.name) && known(fact.name + "()")) fact.name += "()";
  if (!known(fact.name)) {
    const auto* what = fact.kind == AtomKind::kHappens     ? "event"
                       : fact.kind == AtomKind::kPredicate ? "atom of a predicate"
                                                           : "fluent";
    const auto near = base::nearest_name(fact.name, names);
    return fail(fmt::format("the model has no {} `{}`{}", what, fact.name,
                            near ? fmt::format(", but `{}`", *near) : ""));
  }
  if (fact.kind != AtomKind::kPredicate) {
    compiler::Timepoint time = 0;
    const auto* end = parts.time.data() + parts.time.size();
    const auto [stop, error] = std::from_chars(parts.time.data(), end, time);
    if (error != std::errc() || stop != end || time < 0) {
      return fail(fmt::format("`{}` is no timepoint", parts.time));
    }
    fact.time = time;
  }
  fact.atom = compiler::AtomIndex(model).find(fact.kind, fact.name, fact.time);
  return fact;
}

}  // namespace parallax::tools
