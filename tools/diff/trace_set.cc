// Two sets of traces by their differences.
//
// A set becomes a tree of its prefixes: a node's children are the events and the state of the
// next step, by name, as the files need not share ids. A trace of the other set is followed
// down; where it has no child it leaves the set, and a trace that only ends elsewhere leaves it
// at its last timepoint. The witness is the trace that leaves earliest, with the fewest events
// before that. Cost: the size of both sets, times the logarithm of the children at a node.

#include "tools/diff/trace_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "compiler/base/file_io.h"
#include "compiler/base/words.h"
#include "runtime/trace/trace_reader.h"

namespace parallax::tools {
namespace {

/// The events before a timepoint and the fluents at it: by name, because two files are compared.
using Step = std::pair<runtime::Names, runtime::Names>;

/// A trace as it was told, with ids of `symbols`. What it does not list is false.
runtime::Trace trace_of(const runtime::ClaimedTrace& claimed, std::int64_t number,
                        const std::shared_ptr<compiler::SymbolTable>& symbols) {
  runtime::Trace trace;
  trace.number = number;
  trace.symbols = symbols;
  const auto names = [](const runtime::AtomClaims& claims) {
    std::vector<std::string> out;
    for (const auto& [name, claim] : claims.listed) {
      if (claim.value) out.push_back(name);
    }
    return out;
  };
  for (const auto& point : claimed.points) {
    trace.points.push_back(
        runtime::point_of_names(names(point.holds), names(point.happens), *symbols));
  }
  return trace;
}

std::vector<Step> steps_of(const runtime::Trace& trace) {
  std::vector<Step> steps;
  runtime::Names before;
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    steps.emplace_back(std::move(before), trace.holds(t));
    before = trace.happens(t);
  }
  return steps;
}

/// All prefixes of the traces of a set.
class PrefixTree {
 public:
  explicit PrefixTree(const TraceSet& set) {
    nodes_.emplace_back();
    for (const auto& trace : set.traces) {
      std::size_t node = 0;
      for (auto& step : steps_of(trace)) {
        const auto [child, added] =
            nodes_[node].children.try_emplace(std::move(step), nodes_.size());
        node = child->second;
        if (added) nodes_.emplace_back();
      }
      nodes_[node].ends = true;
    }
  }

  /// The first timepoint at which the trace differs from all of these; none if it is one of them. A
  /// trace that only ends elsewhere leaves them at its last timepoint.
  std::optional<std::int64_t> leaves_at(const runtime::Trace& trace) const {
    std::size_t node = 0;
    std::int64_t t = 0;
    for (const auto& step : steps_of(trace)) {
      const auto child = nodes_[node].children.find(step);
      if (child == nodes_[node].children.end()) return t;
      node = child->second;
      ++t;
    }
    return nodes_[node].ends ? std::nullopt : std::optional(t - 1);
  }

 private:
  struct TreeNode {
    std::map<Step, std::size_t> children;
    bool ends = false;
  };
  std::vector<TreeNode> nodes_;
};

std::size_t events_before(const runtime::Trace& trace, std::int64_t t) {
  std::size_t count = 0;
  for (std::int64_t i = 0; i < t; ++i) {
    count += trace.points[static_cast<std::size_t>(i)].happens.size();
  }
  return count;
}

}  // namespace

base::Result<TraceSet> load_trace_set(const std::string& path, Context& context) {
  auto& sink = context.sink();
  const auto file = base::load_text(path, context.files(), sink);
  if (!file) return sink.already_reported();
  const auto head = runtime::open_trace_file(*file, context.files(), sink);
  if (!head) return sink.already_reported();
  TraceSet out{path, {}, head->closed, head->complete};
  const auto symbols = std::make_shared<compiler::SymbolTable>();
  runtime::ClaimReader reader(sink);
  for (const auto& place : head->traces) {
    const auto number = std::ssize(out.traces) + 1;
    const auto claimed = runtime::read_trace(place, number, context.files(), reader);
    if (!claimed) return sink.already_reported();
    out.traces.push_back(trace_of(*claimed, number, symbols));
    out.tells_last_events = out.tells_last_events && claimed->points.back().happens.closed;
  }
  std::set<std::vector<Step>> seen;
  std::erase_if(out.traces,
                [&](const runtime::Trace& trace) { return !seen.insert(steps_of(trace)).second; });
  return out;
}

std::string canonical_text(const TraceSet& set) {
  std::set<std::string> traces;
  for (const auto& trace : set.traces) {
    const auto text = to_text(trace);
    traces.insert("trace" + text.substr(text.find('\n')));  // without its number
  }
  std::string out;
  for (const auto& trace : traces) out += trace;
  return out + fmt::format("{}, {}\n", base::counted(std::ssize(set.traces), "trace"),
                           set.complete ? "complete" : "not known to be complete");
}

TraceSetSide only_in(const TraceSet& set, const TraceSet& other) {
  const PrefixTree tree(other);
  TraceSetSide side;
  std::optional<std::pair<std::int64_t, std::size_t>> best;
  for (const auto& trace : set.traces) {
    const auto leaves = tree.leaves_at(trace);
    if (!leaves) continue;
    ++side.count;
    const std::pair rank(*leaves, events_before(trace, *leaves));
    if (best && *best <= rank) continue;
    best = rank;
    side.witness = trace;
    side.leaves_at = *leaves;
  }
  return side;
}

}  // namespace parallax::tools
