#pragma once

#include <gmpxx.h>

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "runtime/enumerate/trace_source.h"
#include "runtime/graph/trace_graph.h"

namespace parallax::runtime {

/// The traces as the paths of a layered graph, in canonical order and without a solver call. The
/// k-th path is found from the number of ways on from each node.
class GraphPaths final : public TraceSource {
 public:
  /// Why the graph cannot list its traces with everything that a trace shows; empty: it can.
  static std::string obstacle(const TraceGraph& graph, const CompiledModel& model);

  /// `graph` has no obstacle; it and `model` outlive the paths.
  GraphPaths(const TraceGraph& graph, const CompiledModel& model);
  /// Makes the trace that `before` others precede the next one; if there is no such trace, there is
  /// no next one.
  void seek(mpz_class before);
  std::optional<Trace> next() override;
  /// Reuses the text of the timepoints that the trace shares with the one before it.
  bool print_next(const TraceFormat& format, std::string& out) override;
  bool exhausted() const override { return is_at_end_; }
  SourceStats stats() const override;

 private:
  struct Step {
    std::uint32_t node = 0;
    const std::vector<GraphEdge>* edges = nullptr;  // null in the last layer
    std::size_t edge = 0;
    std::size_t printed = 0;  // length of `body_` with this timepoint
  };
  /// Contents of a timepoint; `before` and `events` are one more than the index, 0 for none.
  struct Shown {
    std::uint32_t before = 0, node = 0, events = 0;
    friend bool operator==(const Shown&, const Shown&) = default;
  };
  struct ShownHash {
    std::size_t operator()(const Shown& shown) const;
  };

  bool advance();
  bool take_way(Step& step, Timepoint t, std::size_t edge);
  void descend();
  void push(std::uint32_t node);
  Shown shown(std::size_t t) const;
  const TracePoint& state(std::uint32_t node);
  TracePoint point(const Shown& shown);
  const std::string& piece(const TraceFormat& format, std::size_t t);

  const TraceGraph& graph_;
  Symbols symbols_;
  /// By bit of the graph's vectors; none: something else.
  std::vector<std::optional<compiler::FluentId>> fluents_, released_in_observed_,
      released_in_hidden_;
  std::vector<std::optional<compiler::EventId>> events_;
  std::vector<std::string> predicates_;
  std::vector<Step> path_;     // to the last layer; empty before the first trace
  std::size_t start_ = 0;      // the start that comes next
  bool is_placed_ = false;     // `path_` is the next trace already
  bool is_at_end_ = false;     // there is no next trace
  std::size_t unchanged_ = 0;  // timepoints that `body_` has already
  mpz_class number_ = 0;       // of the trace that was given last
  std::map<std::uint32_t, TracePoint> states_;
  std::string body_;
  const TraceFormat* format_ = nullptr;  // of `body_` and `pieces_`
  std::unordered_map<Shown, std::string, ShownHash> pieces_;
  std::size_t pieces_size_ = 0;
};

}  // namespace parallax::runtime
