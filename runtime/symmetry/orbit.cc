#include "runtime/symmetry/orbit.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "compiler/base/hash.h"

namespace parallax::runtime {

namespace {

/// An atom that is true at some timepoint: what it is, and the constants it connects.
struct Edge {
  std::uint32_t kind = 0, layer = 0;
  std::span<const std::uint32_t> ends;
};

using Colours = std::vector<std::uint32_t>;  // by constant; equal ones are not told apart yet
using Form = std::vector<std::uint32_t>;

/// Kinds of edges that are no atoms of the model's: the length of the trace, what was returned.
constexpr auto kLength = std::numeric_limits<std::uint32_t>::max();

/// The least form of a graph, and how many relabellings leave the graph as it is.
class FormSearch {
 public:
  explicit FormSearch(std::vector<Edge> edges, std::size_t vertices)
      : edges_(std::move(edges)), at_(vertices) {
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
      for (const auto end : edges_[e].ends) {
        if (at_[end].empty() || at_[end].back() != e) at_[end].push_back(e);
      }
    }
  }

  std::pair<Form, mpz_class> run(Colours colours) {
    refine(colours);
    return least(std::move(colours));
  }

 private:
  /// Splits cells until equal constants are connected to equal constants in equal ways. New
  /// colours depend on the graph, never on the numbers of its constants.
  void refine(Colours& colours) const {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> seen(colours.size());
    auto cells = count(colours);
    while (cells < colours.size()) {
      for (std::uint32_t v = 0; v < colours.size(); ++v) {
        std::uint64_t sum = 0;
        for (const auto e : at_[v]) {
          auto hash = base::fnv1a64_word(base::kFnvStart, edges_[e].kind);
          hash = base::fnv1a64_word(hash, edges_[e].layer);
          for (const auto end : edges_[e].ends) {
            hash = base::fnv1a64_word(hash, 2 * std::uint64_t{colours[end]} + (end == v ? 1 : 0));
          }
          sum += hash;
        }
        seen[v] = {sum, v};
      }
      std::sort(seen.begin(), seen.end(), [&](const auto& a, const auto& b) {
        return std::pair(colours[a.second], a.first) < std::pair(colours[b.second], b.first);
      });
      // A cell's colour is the number of constants before it, as everywhere.
      Colours next(colours.size());
      for (std::uint32_t i = 0; i < seen.size(); ++i) {
        const bool same = i > 0 && seen[i].first == seen[i - 1].first &&
                          colours[seen[i].second] == colours[seen[i - 1].second];
        next[seen[i].second] = same ? next[seen[i - 1].second] : i;
      }
      colours = std::move(next);
      const auto more = count(colours);
      if (more == cells) return;
      cells = more;
    }
  }

  static std::size_t count(const Colours& colours) {
    std::vector<bool> used(colours.size());
    for (const auto colour : colours) used[colour] = true;
    return static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  }

  /// The first cell of more than one constant; empty if there is none.
  static std::vector<std::uint32_t> first_cell(const Colours& colours) {
    std::vector<std::vector<std::uint32_t>> cells(colours.size());
    for (std::uint32_t v = 0; v < colours.size(); ++v) cells[colours[v]].push_back(v);
    for (auto& cell : cells) {
      if (cell.size() > 1) return std::move(cell);
    }
    return {};
  }

  /// The constant comes before the others of its cell.
  Colours individualized(const Colours& colours, std::uint32_t vertex) const {
    auto out = colours;
    for (std::uint32_t v = 0; v < out.size(); ++v) {
      if (v != vertex && out[v] == colours[vertex]) ++out[v];
    }
    refine(out);
    return out;
  }

  /// The graph with constants named by their colours, each of which has one.
  Form relabelled(const Colours& colours) const {
    std::vector<Form> lines;
    for (const auto& edge : edges_) {
      auto& line = lines.emplace_back(Form{edge.kind, edge.layer});
      for (const auto end : edge.ends) line.push_back(colours[end]);
    }
    std::sort(lines.begin(), lines.end());
    Form out;
    for (const auto& line : lines) {
      out.push_back(static_cast<std::uint32_t>(line.size()));
      out.insert(out.end(), line.begin(), line.end());
    }
    return out;
  }

  /// The leaf that is reached by always taking the first constant of a cell.
  Form first_leaf(Colours colours) const {
    for (auto cell = first_cell(colours); !cell.empty(); cell = first_cell(colours)) {
      colours = individualized(colours, cell.front());
    }
    return relabelled(colours);
  }

  /// Does exchanging two constants of one cell leave the graph as it is?
  bool are_twins(std::uint32_t a, std::uint32_t b) const {
    std::vector<Form> before, after;
    for (const auto* edges : {&at_[a], &at_[b]}) {
      for (const auto e : *edges) {
        Form line = {edges_[e].kind, edges_[e].layer};
        line.insert(line.end(), edges_[e].ends.begin(), edges_[e].ends.end());
        before.push_back(line);
        for (std::size_t i = 2; i < line.size(); ++i) {
          line[i] = line[i] == a ? b : line[i] == b ? a : line[i];
        }
        after.push_back(std::move(line));
      }
    }
    std::sort(before.begin(), before.end());
    std::sort(after.begin(), after.end());
    return before == after;
  }

  /// Below a node whose colours are refined. Constants of the cell that some relabelling which
  /// respects the colours makes of each other lead to equal subtrees: one is followed for all.
  std::pair<Form, mpz_class> least(Colours colours) {
    const auto cell = first_cell(colours);
    if (cell.empty()) return {relabelled(colours), 1};
    struct Child {
      std::uint32_t vertex;
      Form first_leaf;
      unsigned long alike = 1;
    };
    std::vector<Child> children;
    for (const auto vertex : cell) {
      auto same = std::find_if(children.begin(), children.end(),
                               [&](const Child& one) { return are_twins(one.vertex, vertex); });
      Form leaf;
      if (same == children.end()) {
        leaf = first_leaf(individualized(colours, vertex));
        same = std::find_if(children.begin(), children.end(),
                            [&](const Child& one) { return one.first_leaf == leaf; });
      }
      if (same != children.end()) {
        ++same->alike;
      } else {
        children.push_back({vertex, std::move(leaf)});
      }
    }
    std::pair<Form, mpz_class> best;
    bool any = false;
    for (const auto& child : children) {
      auto [form, automorphisms] = least(individualized(colours, child.vertex));
      automorphisms *= child.alike;
      if (any && form == best.first) {
        best.second += automorphisms;
      } else if (!any || form < best.first) {
        best = {std::move(form), std::move(automorphisms)};
      }
      any = true;
    }
    return best;
  }

  std::vector<Edge> edges_;
  std::vector<std::vector<std::uint32_t>> at_;  // edges, by constant
};

}  // namespace

TraceOrbits::TraceOrbits(const CompiledModel& model, const Interchangeables& constants,
                         Compared compared)
    : compared_(compared) {
  for (const auto& set : constants.sets) {
    for (const auto& name : set) {
      constants_.emplace(name, static_cast<std::uint32_t>(set_of_.size()));
      set_of_.push_back(static_cast<std::uint32_t>(set_sizes_.size()));
    }
    set_sizes_.push_back(set.size());
    for (std::size_t i = 2; i <= set.size(); ++i) group_ *= static_cast<unsigned long>(i);
  }
  for (const auto& fluent : model.fluents) fluents_.push_back(parse(fluent.name));
  for (const auto& event : model.events) events_.push_back(parse(event.name));
  for (const auto& atom : model.fixed) {
    if (atom.kind == compiler::AtomKind::kPredicate) predicates_[atom.name] = parse(atom.name);
    if (const auto* result = std::get_if<compiler::ReturnedObject>(&atom.plan)) {
      returned_[result->object] = parse("returned(" + result->object + ")");
    }
  }
  for (const auto& slot : model.slots) {
    if (slot.kind == compiler::AtomKind::kPredicate) predicates_[slot.name] = parse(slot.name);
  }
}

TraceOrbits::Term TraceOrbits::parse(const std::string& name) {
  Term term;
  std::string kind;
  std::size_t copied = 0;
  for_each_constant(name, [&](std::size_t begin, std::size_t end) {
    const auto found = constants_.find(std::string_view(name).substr(begin, end - begin));
    if (found == constants_.end()) return;
    kind.append(name, copied, begin - copied);
    kind += '?';
    copied = end;
    term.constants.push_back(found->second);
  });
  kind.append(name, copied, std::string::npos);
  term.kind = kinds_.emplace(kind, static_cast<std::uint32_t>(kinds_.size())).first->second;
  return term;
}

Orbit TraceOrbits::of(const Trace& trace) const {
  // Of different lengths there is no exchange.
  std::vector<Edge> edges = {{kLength, static_cast<std::uint32_t>(trace.points.size()), {}}};
  const auto layers = 4 * trace.points.size() + 1;
  const auto add = [&](const Term& term, std::size_t layer) {
    edges.push_back({term.kind, static_cast<std::uint32_t>(layer), term.constants});
  };
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    const auto& point = trace.points[t];
    const bool is_key = compared_ == Compared::kKey || compared_ == Compared::kKeyAndStart;
    if (!is_key || (t == 0 && compared_ == Compared::kKeyAndStart)) {
      for (const auto id : point.holds) add(fluents_[id.index()], 4 * t);
    }
    for (const auto id : point.happens) add(events_[id.index()], 4 * t + 1);
    if (is_key && point.returned) add(returned_.at(*point.returned), 4 * t + 3);
    if (compared_ != Compared::kEverything) continue;
    for (const auto id : point.released) add(fluents_[id.index()], 4 * t + 2);
  }
  for (const auto& name : trace.predicates) {
    const auto found = predicates_.find(name);
    if (compared_ == Compared::kEverything && found != predicates_.end())
      add(found->second, layers - 1);
  }
  Colours colours;
  std::uint32_t first = 0;
  for (const auto size : set_sizes_) {
    colours.insert(colours.end(), size, first);
    first += static_cast<std::uint32_t>(size);
  }
  const auto vertices = colours.size();
  auto [form, automorphisms] = FormSearch(std::move(edges), vertices).run(std::move(colours));
  Orbit orbit;
  orbit.form.resize(form.size() * sizeof(form.front()));
  if (!form.empty()) std::memcpy(orbit.form.data(), form.data(), orbit.form.size());
  orbit.size = group_ / automorphisms;
  return orbit;
}

}  // namespace parallax::runtime
