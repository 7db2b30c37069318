// Symmetry-breaking clauses (Crawford, Ginsberg, Luks and Roy 1996).
//
// For each generator g a valuation must not come after its image under g, in one fixed order of
// the variables. The first valuation of an orbit comes before all its images, so it survives any
// set of such clauses. "Not after" is a chain along the pairs (v, g(v)) in order (Aloul,
// Sakallah and Markov 2003): while all pairs before are equal, v implies g(v), and where that
// holds with equality the next pair is compared. The auxiliary "equal so far" is needed in one
// direction only. Pairs that are equal because of pairs before them, and pairs with one settled
// value, are left out. The clauses are added block by block, as far as a caller needs them;
// leaving some out is never wrong.
//
// Cost: three clauses and one variable for each pair of a generator.

#include "runtime/symmetry/lex_leader.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "compiler/artifact/extended_model.h"

namespace parallax::runtime {

using compiler::AtomKind;

namespace {

constexpr auto kUnordered = std::numeric_limits<std::size_t>::max();

/// By variable - 1: 1 or -1 if a clause of one literal settles the value, else 0.
std::vector<std::int8_t> settled_values(const CompiledModel& model) {
  std::vector<std::int8_t> values(static_cast<std::size_t>(model.variable_count()), 0);
  for (std::size_t c = 0; c < model.clauses.size(); ++c) {
    // A shorter horizon has only some of them.
    if (model.clauses[c].size() != 1) continue;
    const auto literal = model.clauses[c].front();
    const auto place = literal.var() - 1 - model.base();
    const auto t = place < 0 ? 0 : place / model.stride();
    if (model.clause_timepoints[c] > t) continue;
    values[static_cast<std::size_t>(literal.var()) - 1] = literal.is_positive() ? 1 : -1;
  }
  return values;
}

/// Variables that are equal because others are.
class EqualVariables {
 public:
  /// False: they were equal before.
  bool join(std::int32_t a, std::int32_t b) {
    a = first_of(a);
    b = first_of(b);
    if (a == b) return false;
    parent_[a] = b;
    return true;
  }

 private:
  std::int32_t first_of(std::int32_t variable) {
    for (auto up = parent_.find(variable); up != parent_.end(); up = parent_.find(variable)) {
      const auto above = parent_.find(up->second);
      if (above != parent_.end()) up->second = above->second;
      variable = up->second;
    }
    return variable;
  }
  std::unordered_map<std::int32_t, std::int32_t> parent_;
};

}  // namespace

LexLeader::LexLeader(const CompiledModel& model, std::span<const NodeMap> generators,
                     const std::vector<std::vector<Literal>>& order) {
  const auto count = static_cast<std::size_t>(model.variable_count());
  std::vector<std::size_t> rank(count, kUnordered), block(count, 0);
  std::size_t next = 0;
  for (std::size_t b = 0; b < order.size(); ++b) {
    for (const auto literal : order[b]) {
      const auto place = static_cast<std::size_t>(literal.var()) - 1;
      rank[place] = next++;
      block[place] = b;
    }
  }
  const auto settled = settled_values(model);
  const auto at = [](std::int32_t variable) { return static_cast<std::size_t>(variable) - 1; };
  for (const auto& generator : generators) {
    std::vector<std::pair<std::size_t, Pair>> ranked;
    const auto add = [&](std::int32_t a, std::int32_t b) {
      if (rank[at(a)] == kUnordered || rank[at(b)] == kUnordered) return;
      if (settled[at(a)] != 0 && settled[at(a)] == settled[at(b)]) return;
      ranked.push_back({rank[at(a)], {a, b, std::max(block[at(a)], block[at(b)])}});
    };
    for (const auto& [one, other] : generator) {
      const bool fixed = static_cast<std::int32_t>(one) < model.base();
      for (Timepoint t = 0; t <= (fixed ? 0 : model.horizon); ++t) {
        const auto a = variable_at(model, one, t);
        const auto b = variable_at(model, other, t);
        if (a <= model.variable_count() && b <= model.variable_count()) add(a, b);
      }
    }
    std::sort(ranked.begin(), ranked.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    auto& chain = chains_.emplace_back();
    std::size_t reached = 0;
    EqualVariables equal;
    for (const auto& [position, pair] : ranked) {
      // Where all before are equal, these two may be, too: the second half of an exchange.
      if (!equal.join(pair.first, pair.second)) continue;
      // Both are known where the later one is.
      reached = std::max(reached, pair.block);
      chain.pairs.push_back({pair.first, pair.second, reached});
    }
  }
}

void LexLeader::extend(std::size_t blocks, const AddClause& add_clause,
                       const NewVariable& new_variable) {
  for (auto& chain : chains_) {
    const auto& pairs = chain.pairs;
    for (; chain.next < pairs.size() && pairs[chain.next].block < blocks; ++chain.next) {
      const auto first = Literal::positive(pairs[chain.next].first);
      const auto second = Literal::positive(pairs[chain.next].second);
      // (equal and first) -> second; equal and (second -> first) -> still equal.
      std::array<Literal, 3> clause = {~first, second, first};
      const auto add = [&](Literal a, Literal b) {
        clause = {a, b, b};
        if (chain.equal) clause[2] = ~*chain.equal;
        add_clause(std::span(clause).first(chain.equal ? 3 : 2));
      };
      add(~first, second);
      if (chain.next + 1 == pairs.size()) continue;
      const auto equal = new_variable();
      add(equal, ~first);
      add(equal, second);
      chain.equal = equal;
    }
  }
}

std::vector<std::vector<Literal>> whole_order(const CompiledModel& model,
                                              std::vector<std::vector<Literal>> observed) {
  std::vector<bool> known(static_cast<std::size_t>(model.variable_count()));
  for (const auto& block : observed) {
    for (const auto literal : block) known[static_cast<std::size_t>(literal.var()) - 1] = true;
  }
  std::vector<Literal> rest;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    if (known[static_cast<std::size_t>(atom.variable) - 1]) return;
    if (!compiler::is_of_plan(atom.kind)) rest.push_back(atom.literal());
  });
  observed.push_back(std::move(rest));
  return observed;
}

std::vector<std::vector<Literal>> order_by_horizon(const CompiledModel& model) {
  std::vector<std::vector<Literal>> blocks(static_cast<std::size_t>(model.horizon) + 1);
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    if (compiler::is_of_plan(atom.kind)) return;
    const auto n = std::max(atom.needed_horizon(model.horizon), 0);
    blocks[static_cast<std::size_t>(n)].push_back(atom.literal());
  });
  return blocks;
}

SymmetryBreaker::SymmetryBreaker(SolverSession& session, std::span<const NodeMap> generators,
                                 const std::vector<std::vector<Literal>>& order)
    : session_(session),
      clauses_(session.model(), generators, order),
      guard_(session.new_variable()) {}

void SymmetryBreaker::extend(std::size_t blocks) {
  std::vector<Literal> guarded;
  clauses_.extend(
      blocks,
      [&](std::span<const Literal> clause) {
        guarded.assign(clause.begin(), clause.end());
        guarded.push_back(~guard_);
        session_.add_clause(guarded);
      },
      [&] { return session_.new_variable(); });
}

void SymmetryBreaker::retire() {
  const auto never = ~guard_;
  session_.add_clause(std::span(&never, 1));
}

CompiledModel broken_model(const CompiledModel& model, std::span<const NodeMap> generators,
                           const std::vector<std::vector<Literal>>& order) {
  std::vector<compiler::AddedClause> clauses;
  std::int32_t added = 0;
  LexLeader leader(model, generators, order);
  leader.extend(
      order.size(),
      [&](std::span<const Literal> clause) {
        clauses.push_back({{clause.begin(), clause.end()}, model.horizon, false});
      },
      [&] { return Literal::positive(model.variable_count() + ++added); });
  const std::vector<compiler::Atom> chains(static_cast<std::size_t>(added),
                                           {AtomKind::kAuxiliary, {}, {}, {}});
  return compiler::extended_model(
      model, chains, clauses, {{}, compiler::OriginKind::kInvariant, "symmetry", {}, "symmetry"});
}

}  // namespace parallax::runtime
