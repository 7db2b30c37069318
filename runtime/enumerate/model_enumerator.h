#pragma once

#include <atomic>
#include <limits>
#include <memory>
#include <vector>

#include "runtime/enumerate/clause_search.h"
#include "runtime/enumerate/trace_source.h"
#include "runtime/session/solver_session.h"
#include "runtime/symmetry/lex_leader.h"

namespace parallax::runtime {

/// Blocks each trace for good by one clause over the atoms that tell traces apart, and finds the
/// first one of the rest by a walk over these atoms: the first trace costs little, and each further
/// one grows dearer with the number of those found.
class ModelEnumerator final : public TraceSource {
 public:
  /// `session` outlives the enumerator. The first trace is looked for under `breaker`, if there is
  /// one, which compares in canonical order and outlives the enumerator, and is retired then.
  explicit ModelEnumerator(SolverSession& session, Distinct distinct = Distinct::kObservable,
                           TraceOrder order = TraceOrder::kCanonical,
                           SymmetryBreaker* breaker = nullptr);
  std::optional<Trace> next() override;
  bool exhausted() const override { return exhausted_; }
  /// No canonical order is looked for, and no call is needed where the way to the last trace led
  /// past another one.
  void look_on() override;
  SourceStats stats() const override;

 private:
  SolverSession* session_;
  Symbols symbols_;
  std::vector<Literal> order_;  // the atoms, false preferred
  TraceOrder wanted_;
  SymmetryBreaker* breaker_;
  std::int64_t found_ = 0;
  bool exhausted_ = false;
  bool by_symmetry_ = false;
  bool has_more_ = false;  // a trace that is not listed yet was come upon
};

/// Descends a tree whose levels are blocks of atoms. At a node, which is a valuation of the blocks
/// above and is assumed, the valuations of the next block are found by blocking clauses under a
/// guard of their own; the guard is retired before the first child is entered. So no blocking
/// clause outlives its node, and memory is one path with its siblings.
class TraceTree final : public TraceSource {
 public:
  /// `session` outlives the tree. `levels`: blocks of atoms in canonical order that together tell
  /// traces apart. A level with more children than `most_children` is halved where it shows.
  TraceTree(SolverSession& session, std::vector<std::vector<Literal>> levels, std::string name,
            std::size_t most_children);
  std::optional<Trace> next() override;
  bool exhausted() const override { return exhausted_; }
  SourceStats stats() const override;

 private:
  struct Child {
    std::vector<bool> values;  // of the level's atoms
    Trace trace;               // at the last level
  };
  struct Node {
    std::vector<Child> children;  // in canonical order
    std::size_t next = 0;
    std::size_t assumed = 0;  // assumptions of the levels above
  };

  bool expand();
  bool find_children(Node& node, bool& too_many);
  void halve(std::size_t level);

  SolverSession* session_;
  Symbols symbols_;
  std::vector<std::vector<Literal>> levels_;
  std::string name_;
  std::size_t most_children_;
  std::vector<Node> path_;
  std::vector<Literal> assumptions_;
  std::int64_t found_ = 0;
  bool started_ = false;
  bool stopped_ = false;  // there may be further traces, but no way to them is left
  bool exhausted_ = false;
};

/// Begins with one level, which is halved until no node has more than about a thousand children.
std::unique_ptr<TraceTree> make_trace_tree(SolverSession& session, Distinct distinct);
/// Begins with two levels, the halves of the horizon, which are halved in the same way.
std::unique_ptr<TraceTree> make_guarded_blocking(SolverSession& session, Distinct distinct);

/// The traces by search alone: the next one is where the search goes on. Earlier traces are not
/// kept, and there is no solver to wait for; but prefixes that a goal far ahead rules out are tried
/// all the same.
class SearchTraces final : public TraceSource {
 public:
  /// Gives up where a trace costs more than `conflicts`. `model` outlives the traces; `stop` may be
  /// null.
  SearchTraces(const CompiledModel& model, Distinct distinct, const std::atomic<bool>* stop,
               std::int64_t conflicts = std::numeric_limits<std::int64_t>::max());
  std::optional<Trace> next() override;
  bool exhausted() const override { return exhausted_; }
  /// Are there perhaps more traces, for which the budget does not suffice?
  bool gave_up() const { return gave_up_; }
  /// Pauses before the next trace once work() has reached `assignments`.
  void pause_at(std::int64_t assignments) { pause_at_ = assignments; }
  /// next() has found nothing because work() has reached the pause; a later one may be set.
  bool is_paused() const { return paused_; }
  /// Literals set so far.
  std::int64_t work() const { return search_.assignments(); }
  SourceStats stats() const override;

 private:
  const CompiledModel& model_;
  Symbols symbols_;
  const std::atomic<bool>* stop_;
  std::int64_t conflicts_;
  ClauseSearch search_;
  std::int64_t found_ = 0;
  std::int64_t spent_ = 0;  // conflicts since the last trace
  std::int64_t pause_at_ = std::numeric_limits<std::int64_t>::max();
  bool exhausted_ = false, gave_up_ = false, paused_ = false;
};

}  // namespace parallax::runtime
