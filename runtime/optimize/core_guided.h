#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/consequences/size_bound.h"
#include "runtime/session/solver_session.h"

namespace parallax::runtime {

/// The value that an objective has in a trace of length `n`.
std::int64_t objective_value(const compiler::Objective& objective, Timepoint n,
                             const std::function<bool(Literal)>& value);
/// Lower bound for all traces of length `n`: every cost avoided, every gain made.
std::int64_t trivial_bound(const compiler::Objective& objective, Timepoint n);

/// The least value of an objective among the traces of one length, by unsatisfiable cores: OLL
/// (Andres, Kaufmann, Matheis and Schaub 2012; Morgado, Dodaro and Marques-Silva 2014), the largest
/// weights first (Ansotegui, Bonet, Gabas and Levy 2012). The search assumes that no literal costs
/// anything. A core of these assumptions raises the lower bound; a totalizer counts how many
/// literals of the core are broken, and its outputs are assumed next.
class CoreGuidedSearch {
 public:
  /// Called with every valuation found; it is the session's.
  using Note = std::function<void()>;

  /// `assumed`: facts that the traces have in common. `alone`: the session is used for nothing else
  /// afterwards, so facts about the best traces may be added to it. It outlives the object.
  CoreGuidedSearch(SolverSession& session, Timepoint n, std::vector<Literal> assumed, bool alone,
                   Note note);

  /// Satisfiable: the least value is `lower()`, and from then on only traces with it are
  /// considered. Unsatisfiable: no trace has less than `below`, if that is given, or there is none
  /// at all. Unknown: the solver was stopped; no trace has less than `lower()`.
  SolveStatus minimize(const compiler::Objective& objective, std::optional<std::int64_t> below);
  std::int64_t lower() const { return lower_; }
  std::int64_t cores() const { return cores_; }

 private:
  /// Counts how many literals of a core are broken.
  struct Counter {
    std::vector<Literal> broken;
    std::unique_ptr<SizeBound> bound;
  };
  struct Soft {
    std::int64_t weight = 0;
    std::optional<std::size_t> counter;
    std::size_t allowed = 0;  // at most this many of the counter's literals are broken
  };
  struct Core {
    std::vector<Literal> literals;
    std::int64_t weight = 0;
  };

  void prepare(const compiler::Objective& objective);
  void add_soft(Literal good, std::int64_t weight);
  SolveStatus solve(std::span<const Literal> softs);
  std::vector<Literal> active() const;
  std::vector<Literal> failed_of(const std::vector<Literal>& softs);
  void shorten(std::vector<Literal>& core);
  bool relax(std::vector<Literal> core);
  void count(const Core& core);
  void allow(std::size_t counter, std::size_t broken, std::int64_t weight);
  void harden(Literal literal);
  void harden_heavy();
  void next_level();
  void settle();

  SolverSession& session_;
  Timepoint n_;
  std::vector<Literal> assumed_;
  bool alone_;
  Note note_;
  const compiler::Objective* objective_ = nullptr;
  std::map<std::int32_t, Soft> softs_;  // by literal, as DIMACS writes it; true costs nothing
  std::vector<Counter> counters_;
  std::vector<Core> uncounted_;
  std::int64_t lower_ = 0;
  std::optional<std::int64_t> found_;  // the least value of a trace that was found
  std::optional<std::int64_t> upper_;  // the same, or one less than the value to be beaten
  std::int64_t level_ = 0;             // weights from here on are assumed
  std::int64_t cores_ = 0;
};

}  // namespace parallax::runtime
