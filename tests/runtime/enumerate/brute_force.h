#pragma once

#include <set>
#include <string>

#include "compiler/reference/reference_evaluator.h"
#include "runtime/enumerate/model_enumerator.h"

namespace parallax::test {

/// The observable part of a trace as one line: "0:F();1:..|0:E()..".
inline std::string signature(const std::vector<std::set<std::string>>& holds,
                             const std::vector<std::set<std::string>>& happens) {
  std::string out;
  for (const auto* part : {&holds, &happens}) {
    for (const auto& point : *part) {
      for (const auto& atom : point) out += atom + ' ';
      out += ';';
    }
    out += '|';
  }
  return out;
}

/// Every valuation of the atoms (at most 2^20) that the reference evaluator accepts, reduced to
/// its observable part.
inline std::set<std::string> brute_force(const compiler::TypedModel& typed,
                                         const compiler::CompiledModel& compiled) {
  const compiler::ReferenceEvaluator evaluator(typed);
  const auto points = static_cast<std::size_t>(evaluator.horizon()) + 1;
  std::set<std::string> accepted;
  PARALLAX_REQUIRE(compiled.atoms.size() <= 20, "brute force is for small models");
  for (std::uint32_t bits = 0; bits < (1U << compiled.atoms.size()); ++bits) {
    compiler::Valuation v;
    v.holds.resize(points);
    v.happens.resize(points);
    v.released.resize(points);
    for (std::size_t i = 0; i < compiled.atoms.size(); ++i) {
      if (((bits >> i) & 1U) == 0) continue;
      const auto& atom = compiled.atoms[i];
      const auto t = static_cast<std::size_t>(atom.time.value_or(0));
      if (atom.kind == compiler::AtomKind::kHoldsAt) v.holds[t].insert(atom.name);
      if (atom.kind == compiler::AtomKind::kHappens) v.happens[t].insert(atom.name);
      if (atom.kind == compiler::AtomKind::kReleasedAt) v.released[t].insert(atom.name);
      if (atom.kind == compiler::AtomKind::kPredicate) v.predicates.insert(atom.name);
    }
    if (!evaluator.check(v)) accepted.insert(signature(v.holds, v.happens));
  }
  return accepted;
}

/// What the enumerator finds, in its order.
inline std::vector<std::string> enumerate_all(const compiler::CompiledModel& compiled) {
  runtime::SolverSession session(compiled, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session);
  std::vector<std::string> found;
  while (const auto trace = enumerator.next()) {
    std::vector<std::set<std::string>> holds, happens;
    for (const auto& point : trace->points) {
      holds.emplace_back(point.holds.begin(), point.holds.end());
      happens.emplace_back(point.happens.begin(), point.happens.end());
    }
    found.push_back(signature(holds, happens));
  }
  return found;
}

}  // namespace parallax::test
