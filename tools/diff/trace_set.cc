#include "tools/diff/trace_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"

namespace parallax::tools {
namespace {

using SortedJson = nlohmann::json;
using Names = std::vector<std::string>;
/// What happens before a timepoint, what holds at it: by name, because two files are compared.
using Step = std::pair<runtime::Names, runtime::Names>;

/// What one line of a file says, or why it is no line of ours.
class LineReader {
 public:
  explicit LineReader(TraceSet& out) : out_(out) {}

  /// Empty if all is well.
  std::string read(std::string_view line) {
    const auto json = SortedJson::parse(line, nullptr, false);
    if (json.is_discarded()) return "it is no JSON";
    if (!json.is_object()) return "it is no object";
    if (json.contains("summary")) {
      out_.closed = true;
      const auto complete = json.find("complete");
      out_.complete = complete != json.end() && complete->is_boolean() && complete->get<bool>();
      return {};
    }
    const auto points = json.find("timepoints");
    if (points == json.end() || !points->is_array() || points->empty()) {
      return "it has no `timepoints`";
    }
    runtime::Trace trace;
    trace.number = static_cast<std::int64_t>(out_.traces.size()) + 1;
    trace.symbols = symbols_;
    for (const auto& point : *points) {
      Names holds, happens;
      for (const auto& [key, names] :
           {std::pair("holds", &holds), std::pair("happens", &happens)}) {
        if (!read_names(point, key, *names)) {
          return fmt::format("`{}` of timepoint {} is no list of names", key, trace.points.size());
        }
      }
      trace.points.push_back(runtime::point_of_names(holds, happens, *symbols_));
    }
    out_.traces.push_back(std::move(trace));
    return {};
  }

 private:
  static bool read_names(const SortedJson& point, const char* key, Names& names) {
    if (!point.is_object()) return false;
    const auto list = point.find(key);
    if (list == point.end()) return true;
    if (!list->is_array()) return false;
    for (const auto& name : *list) {
      if (!name.is_string()) return false;
      names.push_back(name.get<std::string>());
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return true;
  }

  TraceSet& out_;
  std::shared_ptr<compiler::SymbolTable> symbols_ = std::make_shared<compiler::SymbolTable>();
};

std::vector<Step> steps_of(const runtime::Trace& trace) {
  std::vector<Step> steps;
  runtime::Names before;
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    steps.emplace_back(std::move(before), trace.holds(t));
    before = trace.happens(t);
  }
  return steps;
}

/// The beginnings of all traces of a set.
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

  /// The first timepoint at which the trace is none of these; none if it is one of them. A trace
  /// that only ends elsewhere leaves them at its last timepoint.
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
  const auto file = base::load_text(path, context.files(), context.sink());
  if (!file) return context.sink().already_reported();
  TraceSet out;
  out.name = path;
  LineReader reader(out);
  const auto text = context.files()[*file].text();
  for (std::size_t at = 0; at < text.size();) {
    const auto end = std::min(text.find('\n', at), text.size());
    const auto why = end == at ? std::string() : reader.read(text.substr(at, end - at));
    if (!why.empty()) {
      const base::SourceRange place{*file, static_cast<std::uint32_t>(at),
                                    static_cast<std::uint32_t>(end)};
      return context.sink().error(base::DiagnosticCode::kTraceFileSyntax, place, why);
    }
    at = end + 1;
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
  return out + fmt::format("{} {}, {}\n", set.traces.size(),
                           set.traces.size() == 1 ? "trace" : "traces",
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
