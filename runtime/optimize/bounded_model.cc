// Bounds on objectives as clauses (generalized totalizer: Joshi, Martins and Manquinho 2015).
//
// A sum is a list of literals "at least v", one for each value v that it can have, ascending.
// Two sums are added by making a literal for each sum of two values, implied in both directions,
// so that the auxiliaries are functions of the model's variables and traces stay the same. The
// terms of a timepoint are joined as a balanced tree, and the timepoints one after the other, so
// the value up to every timepoint can be read off; with state constraints it counts at the hit.
// Values beyond the bound are merged into one. "Better" is lexicographic: for some objective the
// value is less, and those before it are no worse.
//
// Cost: for two sums of a and b values a * b clauses in each direction; the number of clauses is
// limited.

#include "runtime/optimize/bounded_model.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "compiler/artifact/extended_model.h"

namespace parallax::runtime {
namespace {

using compiler::CompiledModel;
using compiler::Literal;
using compiler::Timepoint;

/// Literals for "at least `value`", for each value that the sum can have, ascending; values from a
/// largest one on are merged.
struct Reached {
  std::int64_t value;
  Literal literal;
};
using Sum = std::vector<Reached>;

/// Clauses over the model's variables and new ones behind them.
class Totals {
 public:
  Totals(const CompiledModel& model, std::size_t most)
      : next_(model.variable_count()), most_(most) {}

  Literal new_variable(Timepoint t) {
    times_.push_back(t);
    return Literal::positive(++next_);
  }
  void add(std::vector<Literal> literals, Timepoint needed, bool is_definition = false) {
    if (clauses_.size() >= most_) {
      full_ = true;
      return;
    }
    clauses_.push_back({std::move(literals), needed, is_definition});
  }
  bool full() const { return full_; }
  const std::vector<compiler::AddedClause>& clauses() const { return clauses_; }
  const std::vector<Timepoint>& times() const { return times_; }

  Sum add_up(const Sum& a, const Sum& b, std::int64_t most, Timepoint t) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    if (a.size() * b.size() > most_) full_ = true;
    if (full_) return {};
    std::map<std::int64_t, Literal> reached;
    const auto value = [&](const Sum& sum, std::size_t i) { return i == 0 ? 0 : sum[i - 1].value; };
    const auto both = [&](std::size_t i, std::size_t j) {
      return std::min(value(a, i) + value(b, j), most);
    };
    for (std::size_t i = 0; i <= a.size(); ++i) {
      for (std::size_t j = 0; j <= b.size(); ++j) {
        const auto sum = both(i, j);
        if (sum > 0 && !reached.contains(sum)) reached.emplace(sum, new_variable(t));
      }
    }
    for (std::size_t i = 0; i <= a.size(); ++i) {
      for (std::size_t j = 0; j <= b.size(); ++j) {
        const auto sum = both(i, j);
        if (sum > 0) reach(a, i, b, j, reached.at(sum), t);
        if (sum < most) stay(a, i, b, j, reached.upper_bound(sum), reached.end(), t);
      }
    }
    Sum out;
    for (const auto& [sum, literal] : reached) {
      if (!out.empty()) add({out.back().literal, ~literal}, t, true);
      out.push_back({sum, literal});
    }
    return out;
  }

 private:
  /// Where both are reached, so is their sum.
  void reach(const Sum& a, std::size_t i, const Sum& b, std::size_t j, Literal sum, Timepoint t) {
    std::vector<Literal> clause = {sum};
    if (i > 0) clause.push_back(~a[i - 1].literal);
    if (j > 0) clause.push_back(~b[j - 1].literal);
    add(std::move(clause), t, true);
  }
  /// Where neither goes further, the next sum is not reached.
  template <typename Next>
  void stay(const Sum& a, std::size_t i, const Sum& b, std::size_t j, Next next, Next end,
            Timepoint t) {
    if (next == end) return;
    std::vector<Literal> clause = {~next->second};
    if (i < a.size()) clause.push_back(a[i].literal);
    if (j < b.size()) clause.push_back(b[j].literal);
    add(std::move(clause), t, true);
  }

  std::int32_t next_;
  std::size_t most_;
  bool full_ = false;
  std::vector<compiler::AddedClause> clauses_;
  std::vector<Timepoint> times_;  // of the new variables
};

/// Sum of an objective up to each timepoint, above its lower bound there.
class RunningTotal {
 public:
  /// Sums above `most` are not told apart.
  RunningTotal(const CompiledModel& model, const compiler::Objective& objective, std::int64_t most,
               Totals& totals) {
    std::vector<std::vector<const compiler::ObjectiveTerm*>> by_time(
        static_cast<std::size_t>(model.horizon) + 1);
    for (const auto& term : objective.terms) {
      by_time[static_cast<std::size_t>(term.needed)].push_back(&term);
    }
    Sum sum;
    std::int64_t least = 0;
    Timepoint t = 0;
    for (const auto& terms : by_time) {
      std::vector<Sum> parts;
      for (const auto* term : terms) {
        const bool gain = term->weight < 0;
        if (!term->literal || gain) least += term->weight;
        if (!term->literal) continue;
        const auto weight = std::min(gain ? -term->weight : term->weight, most + 1);
        const auto costs = gain ? ~*term->literal : *term->literal;
        if (weight > 0) parts.push_back({{weight, costs}});
      }
      sum = totals.add_up(sum, join(parts, most + 1, t, totals), most + 1, t);
      sums_.push_back(sum);
      least_.push_back(least);
      ++t;
    }
  }

  /// The condition that the value at t is at most `value`: literals of which at least one has to
  /// hold. None: that is always so; empty: never.
  std::optional<std::vector<Literal>> at_most(std::int64_t value, Timepoint t) const {
    const auto place = static_cast<std::size_t>(t);
    const auto rest = value - least_[place];
    if (rest < 0) return std::vector<Literal>();
    const auto& sum = sums_[place];
    const auto over = std::find_if(sum.begin(), sum.end(),
                                   [&](const Reached& reached) { return reached.value > rest; });
    if (over == sum.end()) return std::nullopt;
    return std::vector{~over->literal};
  }

 private:
  static Sum join(std::span<const Sum> parts, std::int64_t most, Timepoint t, Totals& totals) {
    if (parts.empty()) return {};
    if (parts.size() == 1) return parts.front();
    const auto middle = parts.size() / 2;
    const auto left = join(parts.first(middle), most, t, totals);
    const auto right = join(parts.subspan(middle), most, t, totals);
    return totals.add_up(left, right, most, t);
  }

  std::vector<Sum> sums_;            // by timepoint
  std::vector<std::int64_t> least_;  // by timepoint
};

/// The largest value that any bound leaves to the variable terms; -1: none leaves anything.
std::int64_t largest_rest(const CompiledModel& model, const compiler::Objective& objective,
                          std::int64_t value) {
  std::int64_t least = 0, most_negative = 0;
  std::vector<std::int64_t> by_time(static_cast<std::size_t>(model.horizon) + 1, 0);
  for (const auto& term : objective.terms) {
    if (!term.literal || term.weight < 0) {
      by_time[static_cast<std::size_t>(term.needed)] += term.weight;
    }
  }
  for (const auto more : by_time) {
    least += more;
    most_negative = std::min(most_negative, least);
  }
  const auto from = model.has_constraints ? most_negative : least;
  return std::max<std::int64_t>(value - from, -1);
}

}  // namespace

std::optional<CompiledModel> with_bound(const CompiledModel& model,
                                        std::span<const std::int64_t> values, BoundKind kind,
                                        std::size_t most_clauses) {
  Totals totals(model, most_clauses);
  const compiler::AtomIndex index(model);
  std::vector<RunningTotal> running;
  for (std::size_t i = 0; i < model.objectives.size() && !totals.full(); ++i) {
    const auto& objective = model.objectives[i];
    const auto most = largest_rest(model, objective, values[i]);
    running.emplace_back(model, objective, std::max<std::int64_t>(most, 0), totals);
  }
  if (totals.full()) return std::nullopt;
  // Where `when` holds, if it is given, the objective has at most this value.
  const auto bound = [&](std::size_t i, std::int64_t value, std::optional<Literal> when) {
    for (Timepoint t = 0; t <= model.horizon; ++t) {
      const auto hit = index.hit(t);
      if (model.has_constraints ? !hit : t < model.horizon) continue;
      auto clause = running[i].at_most(value, t);
      if (!clause) continue;
      if (hit) clause->push_back(~*hit);
      if (when) clause->push_back(~*when);
      totals.add(*std::move(clause), t);
    }
  };
  if (kind == BoundKind::kNoWorse) {
    for (std::size_t i = 0; i < values.size(); ++i) bound(i, values[i], std::nullopt);
  } else {
    std::vector<Literal> some;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto here = totals.new_variable(0);
      some.push_back(here);
      for (std::size_t before = 0; before < i; ++before) bound(before, values[before], here);
      bound(i, values[i] - 1, here);
    }
    totals.add(some, 0);
  }
  if (totals.full()) return std::nullopt;
  std::vector<compiler::Atom> sums;
  for (const auto t : totals.times()) {
    sums.push_back({compiler::AtomKind::kAuxiliary, "", t, {}});
  }
  return compiler::extended_model(
      model, sums, totals.clauses(),
      {{}, compiler::OriginKind::kObjective, "objective", {}, "objective"});
}

}  // namespace parallax::runtime
