// The number of orbits of traces under the symmetries of a model, without listing them.
//
// It is the mean, over all symmetries, of the number of traces that a symmetry leaves as they
// are (Cauchy and Frobenius; Burnside 1911). These are the traces of the model with clauses that
// make each observed atom equal to its image, and are counted as any model's. If the symmetries
// are all permutations within sets of constants, conjugate ones leave equally many traces: one
// of each combination of cycle types is asked and weighted with the size of its class, n! /
// prod(part^times * times!). Else every symmetry is asked, as a product of one representative
// from each level of the chain of stabilizers.
//
// Cost: one count of traces for each symmetry asked, at most 1000.

#include "runtime/graph/orbit_number.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/artifact/extended_model.h"
#include "runtime/enumerate/canonical.h"
#include "runtime/graph/trace_count.h"
#include "runtime/symmetry/named_atoms.h"

namespace parallax::runtime {
namespace {

/// So few counts are no more than a list of orbits takes.
constexpr std::size_t kFewAsked = 16;

/// One of each class of conjugates, or each symmetry by itself.
struct CountedSymmetry {
  ConstantMap map;   // of all constants
  mpz_class weight;  // number of symmetries that leave as many traces
};

/// Cycles that come to `size` together: the cycle types of permutations, as falling lists.
void for_each_partition(std::uint32_t size, std::uint32_t most, std::vector<std::uint32_t>& parts,
                        const auto& visit) {
  if (size == 0) return visit(parts);
  for (auto part = std::min(size, most); part > 0; --part) {
    parts.push_back(part);
    for_each_partition(size - part, part, parts, visit);
    parts.pop_back();
  }
}

/// How many permutations have this cycle type: n! / prod(part^times times!).
mpz_class permutations_of(std::span<const std::uint32_t> parts) {
  mpz_class count = 1;
  unsigned long n = 0, times = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::uint32_t k = 0; k < parts[i]; ++k) count *= ++n;
    times = i > 0 && parts[i] == parts[i - 1] ? times + 1 : 1;
    count /= static_cast<unsigned long>(parts[i]) * times;
  }
  return count;
}

class Symmetries {
 public:
  Symmetries(const NamedAtoms& atoms, const ModelSymmetry& symmetry) : symmetry_(symmetry) {
    identity_.resize(atoms.constants().size());
    std::iota(identity_.begin(), identity_.end(), 0U);
    for (std::uint32_t i = 0; i < identity_.size(); ++i) numbers_.emplace(atoms.constants()[i], i);
  }

  /// None: they are too many.
  std::optional<std::vector<CountedSymmetry>> run() {
    if (!symmetry_.constants().together.empty()) return all();
    std::vector<CountedSymmetry> asked = {{identity_, 1}};
    for (const auto& set : symmetry_.constants().sets) {
      std::vector<CountedSymmetry> next;
      std::vector<std::uint32_t> parts;
      const auto size = static_cast<std::uint32_t>(set.size());
      for_each_partition(size, size, parts, [&](const std::vector<std::uint32_t>& cycles) {
        const auto weight = permutations_of(cycles);
        for (const auto& one : asked) {
          if (next.size() > kMostAsked) return;
          next.push_back({with_cycles(one.map, set, cycles), one.weight * weight});
        }
      });
      if (next.size() > kMostAsked) return std::nullopt;
      asked = std::move(next);
    }
    return asked;
  }

 private:
  ConstantMap with_cycles(ConstantMap map, const std::vector<std::string>& set,
                          const std::vector<std::uint32_t>& cycles) const {
    std::size_t begin = 0;
    for (const auto length : cycles) {
      for (std::size_t i = 0; i < length; ++i) {
        map[numbers_.at(set[begin + i])] = numbers_.at(set[begin + (i + 1) % length]);
      }
      begin += length;
    }
    return map;
  }

  /// Products of one from each level.
  std::optional<std::vector<CountedSymmetry>> all() {
    const auto& group = symmetry_.group();
    if (group.order() > static_cast<unsigned long>(kMostAsked)) return std::nullopt;
    std::vector<std::uint32_t> of_group;
    for (const auto& name : group.constants) of_group.push_back(numbers_.at(name));
    std::vector<CountedSymmetry> asked = {{identity_, 1}};
    for (auto level = group.levels.rbegin(); level != group.levels.rend(); ++level) {
      std::vector<CountedSymmetry> next;
      for (std::size_t i = 0; i < level->orbit.size(); ++i) {
        auto to = identity_;
        if (level->to.empty()) {
          std::swap(to[of_group[level->base]], to[of_group[level->orbit[i]]]);
        } else {
          for (std::size_t c = 0; c < of_group.size(); ++c) {
            to[of_group[c]] = of_group[level->to[i][c]];
          }
        }
        for (const auto& one : asked) {
          auto& product = next.emplace_back(one).map;
          for (auto& constant : product) constant = to[constant];
        }
      }
      asked = std::move(next);
    }
    return asked;
  }

  const ModelSymmetry& symmetry_;
  std::unordered_map<std::string, std::uint32_t> numbers_;
  ConstantMap identity_;
};

}  // namespace

CompiledModel model_left_by(const CompiledModel& model, const NodeMap& symmetry,
                            std::span<const Literal> observed) {
  std::vector<bool> is_observed(static_cast<std::size_t>(model.variable_count()) + 1);
  for (const auto literal : observed) is_observed[static_cast<std::size_t>(literal.var())] = true;
  std::vector<compiler::AddedClause> clauses;
  const auto tie = [&](std::int32_t one, std::int32_t other) {
    if (!is_observed[static_cast<std::size_t>(one)]) return;
    const auto a = Literal::positive(one), b = Literal::positive(other);
    clauses.push_back({{~a, b}, model.horizon, false});
    clauses.push_back({{a, ~b}, model.horizon, false});
  };
  for (const auto& [one, other] : symmetry) {
    for (Timepoint t = 0; t <= model.horizon; ++t) {
      const auto a = variable_at(model, one, t), b = variable_at(model, other, t);
      if (a > model.variable_count() || b > model.variable_count()) break;
      tie(a, b);
      if (a <= model.base()) break;
    }
  }
  return compiler::extended_model(model, {}, clauses,
                                  {{}, compiler::OriginKind::kAxiom, "symmetry", {}, "symmetry"});
}

std::optional<OrbitNumber> count_orbits(const CompiledModel& model, const ModelSymmetry& symmetry,
                                        const TraceQuery& query) {
  const NamedAtoms atoms(model);
  const auto asked = Symmetries(atoms, symmetry).run();
  if (!asked) return std::nullopt;
  const auto observed = projected_atoms(model, query.distinct);
  const auto all = count_traces(model, query);
  mpz_class order = 0;
  for (const auto& one : *asked) order += one.weight;
  if (!all.complete) return std::nullopt;
  if (asked->size() > kFewAsked && all.count / order < asked->size()) return std::nullopt;
  // If a graph was too small for all traces, it is too small for these counts as well.
  auto same = query;
  if (all.stats.strategy == "components") same.strategy = Strategy::kComponents;
  OrbitNumber result{0, all.count, asked->size()};
  mpz_class left = 0;
  for (const auto& one : *asked) {
    const auto moved = moved_nodes(atoms, one.map);
    const auto counted =
        moved.empty() ? all : count_traces(model_left_by(model, moved, observed), same);
    if (!counted.complete) return std::nullopt;
    left += one.weight * counted.count;
  }
  PARALLAX_REQUIRE(left % order == 0, "the mean over a group is a number of orbits");
  result.orbits = left / order;
  return result;
}

}  // namespace parallax::runtime
