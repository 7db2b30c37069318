#pragma once

#include <gmpxx.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "runtime/enumerate/clause_propagation.h"

namespace parallax::runtime {

/// Counts the valuations of some variables that a set of clauses admits, whatever its shape: sets
/// the variables in order, both ways; clauses that share no open variable any more are counted
/// apart, and counts are kept for components that come again (component caching: Bayardo and
/// Pehoushek 2000; Sang et al. 2004). A component is recognized by the SHA-256 of its variables and
/// clauses. With variables in the order of time this does the same as the layered graph, but a
/// clause that looks far ahead becomes part of the cache key. Exact.
class ComponentCounter {
 public:
  /// Counted work and memory, of all calls together: the same on every machine.
  struct Limits {
    std::int64_t steps = 2'000'000'000;  // literals that are looked at to find components
    std::size_t cached = 2'000'000;      // components
    std::size_t held = 50'000'000;       // variables and clauses of those being counted
  };

  /// Over the variables 1 .. `variables`; what `projected` does not have tells nothing apart.
  ComponentCounter(std::int32_t variables, std::span<const Literal> projected);
  /// Before the first count().
  void add_clause(std::span<const Literal> clause);
  /// From now on variables are set so that clauses fall apart soon: the reverse of an elimination
  /// order. What follows from what in time is then not followed, but clauses that look far cost
  /// less. False: to find such an order takes too much, or it was done before; nothing changed.
  bool reorder();
  /// Under these assumptions. None: stopped, or beyond the limits. What was counted is remembered
  /// from call to call. `stop` may be null.
  std::optional<mpz_class> count(std::span<const Literal> assumptions, const Limits& limits,
                                 const std::atomic<bool>* stop);
  /// The values of `projected` of the valuation that `before` others precede, in lexicographic
  /// order; those that follow from others may be missing. There are more than `before` of them.
  /// None as of count().
  std::optional<std::vector<Literal>> nth(mpz_class before, const Limits& limits,
                                          const std::atomic<bool>* stop);
  /// So many components have been counted, each once.
  std::size_t components() const { return counts_.size(); }

 private:
  using Key = std::array<std::uint8_t, 32>;
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };
  struct Component {
    std::vector<std::uint32_t> variables;  // open ones, by rank, ascending
    std::vector<std::uint32_t> clauses;    // clauses that are not true yet, ascending
    std::size_t size() const { return variables.size() + clauses.size(); }
  };
  /// A component that is being counted, or the whole.
  struct Frame {
    Component component;
    Key key = {};
    std::size_t trail = 0;         // its length before the decision
    bool is_last = false;          // there is no further value
    mpz_class total;               // of the values that were counted
    mpz_class product;             // of the parts of this value that were counted
    std::vector<Component> parts;  // parts of this value that are still to be counted
  };

  bool is_within(const Limits& limits, const std::atomic<bool>* stop) const;
  void enter(Component component, const Key& key);
  void take_value(Frame& frame, bool value);
  void leave();
  mpz_class split(const Component& whole, std::vector<Component>& parts);
  void gather(std::uint32_t from, std::uint32_t part);
  bool is_true(std::uint32_t clause);
  Key key_of(const Component& component);

  ClausePropagation state_;
  std::vector<ClausePropagation::Code> units_;
  bool has_empty_ = false;
  std::vector<ClausePropagation::Clause> clauses_;  // of two literals and more
  std::vector<Literal> told_apart_;                 // `projected`
  bool is_reordered_ = false;
  std::vector<std::uint32_t> rank_, ranked_;             // variable to rank, and back
  std::size_t projected_ = 0;                            // projected variables have the first ranks
  std::vector<std::vector<std::uint32_t>> clauses_of_;   // by variable
  std::vector<std::uint32_t> part_of_, part_of_clause_;  // while a component is split
  std::vector<std::uint32_t> reached_;                   // variables, while a part is gathered
  std::unordered_map<Key, mpz_class, KeyHash> counts_;
  std::vector<Frame> frames_;
  std::string bytes_;
  std::size_t held_ = 0;
  std::int64_t steps_ = 0;
};

}  // namespace parallax::runtime
