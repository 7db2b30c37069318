#pragma once

#include <set>
#include <string>
#include <vector>

#include "tests/support/checked_traces.h"

namespace parallax::test {

/// Every assignment of a small model's atoms that the reference evaluator accepts. The atoms are
/// the evaluator's own: the compiler's knowledge of the model plays no part.
class BruteForce {
 public:
  explicit BruteForce(const compiler::TypedModel& typed) : evaluator_(typed) {
    REQUIRE_MESSAGE(!evaluator_.refusal(), *evaluator_.refusal());
    choose_open_atoms();
  }
  const compiler::ReferenceEvaluator& evaluator() const { return evaluator_; }
  /// The number of atoms that are tried both ways.
  std::size_t open_atoms() const { return open_.size(); }

  /// Calls `visit` with the values of every accepted assignment. At most 2^22 are tried.
  template <typename Visit>
  void for_each(const Visit& visit) {
    REQUIRE(open_.size() <= 22);
    for (std::uint32_t bits = 0; bits < (1U << open_.size()); ++bits) {
      for (std::size_t i = 0; i < open_.size(); ++i) {
        values_[open_[i]] = static_cast<std::uint8_t>((bits >> i) & 1U);
      }
      if (evaluator_.accepts(values_)) visit(values_);
    }
  }
  std::set<std::string> signatures() {
    std::set<std::string> all;
    for_each([&](const auto& values) { all.insert(signature(valuation(values))); });
    return all;
  }
  compiler::Valuation valuation(const compiler::ReferenceEvaluator::Values& values) const {
    const auto& model = evaluator_.expanded();
    const auto points = static_cast<std::size_t>(model.horizon()) + 1;
    compiler::Valuation out;
    out.holds.resize(points);
    out.happens.resize(points);
    out.released.resize(points);
    for (std::int64_t t = 0; t <= model.horizon(); ++t) {
      const auto now = static_cast<std::size_t>(t);
      for (std::uint32_t f = 0; f < model.fluents().size(); ++f) {
        if (values[model.holds(f, t)] != 0) out.holds[now].insert(model.fluents()[f]);
        if (values[model.released(f, t)] != 0) out.released[now].insert(model.fluents()[f]);
      }
      for (std::uint32_t e = 0; e < model.events().size() && t < model.horizon(); ++e) {
        if (values[model.happens(e, t)] != 0) out.happens[now].insert(model.events()[e]);
      }
    }
    for (std::uint32_t i = 0; i < model.atom_count(); ++i) {
      if (!model.timepoint(i) && values[i] != 0) out.predicates.insert(model.atom_text(i));
    }
    return out;
  }

 private:
  /// ReleasedAt is settled of most fluents: true where there is no inertia; false, by DEC8 from the
  /// start on, where nothing releases.
  void choose_open_atoms() {
    const auto& model = evaluator_.expanded();
    values_.assign(model.atom_count(), 0);
    std::set<std::uint32_t> settled;
    for (std::uint32_t f = 0; f < model.fluents().size(); ++f) {
      const auto& symbol = model.symbol_of(f);
      bool open = symbol.manual_release;
      for (std::int64_t t = 0; t < model.horizon(); ++t) {
        for (const auto& row : model.rows(f, t)) {
          open = open || row.kind == compiler::EffectKind::kReleases;
        }
      }
      for (std::int64_t t = 0; t <= model.horizon() && (symbol.noninertial || !open); ++t) {
        values_[model.released(f, t)] = symbol.noninertial ? 1 : 0;
        settled.insert(model.released(f, t));
      }
    }
    for (std::uint32_t i = 0; i < model.atom_count(); ++i) {
      if (!settled.contains(i)) open_.push_back(i);
    }
  }

  compiler::ReferenceEvaluator evaluator_;
  compiler::ReferenceEvaluator::Values values_;
  std::vector<std::uint32_t> open_;
};

/// Signatures of the enumerator's traces, in its order.
inline std::vector<std::string> enumerate_all(const compiler::TypedModel& typed,
                                              const compiler::CompiledModel& compiled) {
  std::vector<std::string> found;
  for (const auto& trace : checked_traces(typed, compiled)) {
    found.push_back(signature(tools::valuation_of(trace)));
  }
  return found;
}

}  // namespace parallax::test
