#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/codes/names.h"
#include "compiler/base/suggest.h"
#include "compiler/sema/declarations.h"
#include "compiler/sema/name_advice.h"
#include "compiler/syntax/lexer.h"

namespace parallax::compiler {
namespace {

/// Edges of a graph: for each vertex the vertices it leads to.
using Graph = std::vector<std::vector<std::uint32_t>>;

/// An edge that closes a circle: edge number `edge` of the last vertex of `path` leads back to one
/// of the path. path[i] leads to path[i + 1] by its edge number edges[i].
struct Circle {
  std::vector<std::uint32_t> path;
  std::vector<std::size_t> edges;
  std::size_t edge = 0;
};

struct DepthFirst {
  std::vector<std::uint32_t> finished;  // every vertex after all it leads to, but for circles
  /// The edges (from, to) that close circles: without them the graph has none.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> closing;
  std::vector<Circle> circles;  // of the first few closing edges
};

class Search {
 public:
  Search(const Graph& graph, std::size_t circle_limit)
      : graph_(graph), circle_limit_(circle_limit), state_(graph.size(), kNew) {}

  DepthFirst run() {
    for (std::uint32_t vertex = 0; vertex < graph_.size(); ++vertex) {
      if (state_[vertex] == kNew) open(vertex);
      while (!stack_.empty()) step();
    }
    return std::move(result_);
  }

 private:
  static constexpr std::uint8_t kNew = 0, kOpen = 1, kDone = 2;
  struct Visit {
    std::uint32_t vertex;
    std::size_t next;
  };

  void open(std::uint32_t vertex) {
    state_[vertex] = kOpen;
    stack_.push_back({vertex, 0});
  }

  void step() {
    Visit& top = stack_.back();
    if (top.next == graph_[top.vertex].size()) {
      state_[top.vertex] = kDone;
      result_.finished.push_back(top.vertex);
      stack_.pop_back();
      return;
    }
    const auto to = graph_[top.vertex][top.next++];
    if (state_[to] == kNew) {
      open(to);
    } else if (state_[to] == kOpen) {
      result_.closing.emplace_back(top.vertex, to);
      if (result_.circles.size() < circle_limit_) note_circle(to);
    }
  }

  void note_circle(std::uint32_t start) {
    const auto first = std::find_if(stack_.begin(), stack_.end(),
                                    [&](const Visit& visit) { return visit.vertex == start; });
    Circle circle;
    for (auto visit = first; visit != stack_.end(); ++visit) {
      circle.path.push_back(visit->vertex);
      circle.edges.push_back(visit->next - 1);
    }
    circle.edge = circle.edges.back();
    circle.edges.pop_back();
    result_.circles.push_back(std::move(circle));
  }

  const Graph& graph_;
  const std::size_t circle_limit_;
  std::vector<std::uint8_t> state_;
  std::vector<Visit> stack_;
  DepthFirst result_;
};

/// Linear in the graph, plus the lengths of the circles written out (at most `circle_limit`).
DepthFirst search_depth_first(const Graph& graph, std::size_t circle_limit) {
  return Search(graph, circle_limit).run();
}

constexpr std::size_t kMostCircles = 20;

class SortDeclarer {
 public:
  SortDeclarer(const ModelAst& model_ast, Repetitions& repetitions, TypedModel& model,
               base::DiagnosticSink& sink)
      : model_ast_(model_ast), repetitions_(repetitions), model_(model), sink_(sink) {}

  void run() {
    for_each_item([&](const Ast& ast, const Statement& statement, const Item& item) {
      declare(ast, statement, item);
    });
    for_each_item([&](const Ast& ast, const Statement&, const Item& item) {
      if (!item.parent.empty()) add_parent(ast, item);
    });
    break_circles();
    inherit();
  }

 private:
  template <typename Visit>
  void for_each_item(const Visit& visit) {
    for (const auto& place : model_ast_.order) {
      const auto& statement = model_ast_.statement(place);
      if (statement.kind != StatementKind::kSort && statement.kind != StatementKind::kReifiedSort) {
        continue;
      }
      const Ast& ast = model_ast_.ast(place);
      for (std::uint32_t i = 0; i < statement.item_count; ++i) {
        visit(ast, statement, ast.items(statement)[i]);
      }
    }
  }

  void declare(const Ast& ast, const Statement& statement, const Item& item) {
    const auto name = ast.text(item.name);
    if (const auto before = model_.find_sort(name)) {
      // A second statement may repeat the first or add a second parent, and nothing else.
      const bool reified = statement.kind == StatementKind::kReifiedSort;
      if (model_.sorts[*before].reified != reified) {
        report_again(ast, item, *before);
      } else if (item.parent.empty()) {
        repetitions_.note(name, ast.source(item.name), model_.sorts[*before].declared);
      }
      return;
    }
    Sort sort;
    sort.name = std::string(name);
    sort.reified = statement.kind == StatementKind::kReifiedSort;
    sort.declared = ast.source(item.name);
    const auto id = model_.sorts.add(std::move(sort));
    model_.sort_index.insert(id.index(), [this](std::uint32_t position) {
      return std::string_view(model_.sorts[SortId(position)].name);
    });
  }

  void report_again(const Ast& ast, const Item& item, SortId before) {
    const auto& sort = model_.sorts[before];
    sink_.error(codes::kDeclaredTwice, ast.source(item.name), sort.name)
        .note(sort.declared, "first declared here");
  }

  void add_parent(const Ast& ast, const Item& item) {
    const auto sort = model_.find_sort(ast.text(item.name));
    if (!sort) return;
    const auto parent = resolve_sort(ast, item.parent, model_, sink_);
    if (!parent) return;
    auto& parents = model_.sorts[*sort].parents;
    const bool first_statement = model_.sorts[*sort].declared == ast.source(item.name);
    if (std::find(parents.begin(), parents.end(), *parent) != parents.end()) {
      return repetitions_.note(ast.text(item.name), ast.source(item.name),
                               model_.sorts[*sort].declared);
    }
    if (!first_statement && !parents.empty()) {
      sink_.warning(codes::kSecondParent, ast.source(item.name), model_.sorts[*sort].name)
          .note(model_.sorts[*sort].declared, "first declared here");
    }
    parents.push_back(*parent);
  }

  void break_circles() {
    auto found = search_depth_first(parent_graph(), 0);
    order_ = std::move(found.finished);
    for (const auto& [from, to] : found.closing) {
      Sort& sort = model_.sorts[SortId(from)];
      const Sort& above = model_.sorts[SortId(to)];
      sink_.error(codes::kSortBelowItself, sort.declared, sort.name)
          .note(above.declared, "`" + above.name + "`, the sort above it, declared here");
      std::erase(sort.parents, SortId(to));
    }
  }

  Graph parent_graph() const {
    Graph graph(model_.sorts.size());
    for (std::size_t i = 0; i < graph.size(); ++i) {
      for (const auto parent : model_.sorts[model_.sorts.id_at(i)].parents) {
        graph[i].push_back(parent.index());
      }
    }
    return graph;
  }

  void inherit() {
    for (const auto index : order_) {  // parents before children
      Sort& sort = model_.sorts[SortId(index)];
      sort.integer = sort.name == "integer";
      for (const auto parent : sort.parents) {
        sort.integer = sort.integer || model_.sorts[parent].integer;
        sort.reified = sort.reified || model_.sorts[parent].reified;
      }
    }
  }

  const ModelAst& model_ast_;
  Repetitions& repetitions_;
  TypedModel& model_;
  base::DiagnosticSink& sink_;
  std::vector<std::uint32_t> order_;
};

}  // namespace

void declare_sorts(const ModelAst& ast, Repetitions& repetitions, TypedModel& model,
                   base::DiagnosticSink& sink) {
  SortDeclarer(ast, repetitions, model, sink).run();
}

void check_finite_sorts(const TypedModel& model, base::DiagnosticSink& sink) {
  // Elements of a sort contain elements of its subsorts and of its constructors' arguments.
  Graph graph(model.sorts.size());
  std::vector<std::vector<std::optional<SymbolId>>> constructor(model.sorts.size());  // of an edge
  for (std::size_t i = 0; i < model.sorts.size(); ++i) {
    for (const auto parent : model.sorts[model.sorts.id_at(i)].parents) {
      graph[parent.index()].push_back(static_cast<std::uint32_t>(i));
      constructor[parent.index()].emplace_back();
    }
  }
  for (std::size_t i = 0; i < model.symbols.size(); ++i) {
    const auto& symbol = model.symbols[model.symbols.id_at(i)];
    if (!symbol.result || symbol.kind == SymbolKind::kFunction) continue;
    for (const auto argument : symbol.arguments) {
      graph[symbol.result->index()].push_back(argument.index());
      constructor[symbol.result->index()].emplace_back(model.symbols.id_at(i));
    }
  }
  for (const auto& circle : search_depth_first(graph, kMostCircles).circles) {
    // Subsorts alone form no circle, so some edge belongs to a constructor.
    auto by = constructor[circle.path.back()][circle.edge];
    for (std::size_t i = 0; !by && i < circle.edges.size(); ++i) {
      by = constructor[circle.path[i]][circle.edges[i]];
    }
    sink.error(codes::kInfiniteSort, model.symbols[*by].declared,
               model.sorts[SortId(circle.path.front())].name);
  }
}

std::optional<SortId> resolve_sort(const Ast& ast, Word word, TypedModel& model,
                                   base::DiagnosticSink& sink) {
  const auto name = ast.text(word);
  if (const auto found = model.find_sort(name)) return found;
  model.refuse(name);
  auto report = sink.error(codes::kUnknownSort, ast.source(word), shortened(name));
  if (const auto near = NameAdvice(model, sink).sort(name)) {
    const auto& sort = model.sorts[*near];
    report.note(sort.declared, "sort `" + sort.name + "` declared here");
    report.fix(NameAdvice::replace(name, sort.name));
    return std::nullopt;
  }
  // A misspelt keyword looks like a declaration of constants.
  static const std::array<std::string, 11> kKeywords = {
      "option", "range",         "sort",       "xor",         "mutex",   "load",
      "ignore", "manualrelease", "completion", "noninertial", "minimize"};
  if (const auto near = base::nearest_name(name, kKeywords)) {
    report.fix(NameAdvice::replace(name, *near));
  }
  return std::nullopt;
}

}  // namespace parallax::compiler
