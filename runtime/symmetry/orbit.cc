// Canonical form of a trace under a group of permutations of its constants (McKay 1981; Linton
// 2004).
//
// A trace is a graph: constants are vertices, true atoms are edges coloured by their kind and
// timepoint. A node of the search tree has chosen which constants go to the bases of the first
// levels of the chain of stabilizers; the colours of the others are refined by their edges and
// by the group's orbits. Only constants of the least colour are candidates for the next base. At
// a leaf all constants have their places and the graph can be written down; the least text is
// the form. Candidates that an automorphism of the graph takes to each other have equal
// subtrees, so one is followed for all, and the numbers of such candidates multiply to the
// number of automorphisms. The orbit's size is the group's order divided by it.
//
// Cost: exponential in the worst case; a few refinements where colours tell the constants apart.

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

/// An atom that is true at some timepoint: its kind, and the constants it connects.
struct Edge {
  std::uint32_t kind = 0, layer = 0;
  std::span<const std::uint32_t> ends;
};

using Colours = std::vector<std::uint32_t>;  // by constant; equal ones are not told apart yet
using Form = std::vector<std::uint32_t>;

/// Kinds of edges that are no atoms of the model: the length of the trace, returned objects.
constexpr auto kLength = std::numeric_limits<std::uint32_t>::max();

/// The least form that a group's permutations give a graph, and the number of those that fix the
/// graph. Permutations are composed level by level: at a node of the search tree, `to` takes the
/// constants chosen so far to the bases of the levels above.
class FormSearch {
 public:
  FormSearch(std::vector<Edge> edges, const ConstantGroup& group)
      : edges_(std::move(edges)), group_(group), at_(group.constants.size()) {
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
      for (const auto end : edges_[e].ends) {
        if (at_[end].empty() || at_[end].back() != e) at_[end].push_back(e);
      }
    }
  }

  std::pair<Form, mpz_class> run() {
    Node root;
    root.to.resize(at_.size());
    std::iota(root.to.begin(), root.to.end(), 0U);
    root.colours.assign(at_.size(), 0);
    split_by_orbits(root);
    refine(root);
    return least(root);
  }

 private:
  struct Node {
    std::size_t level = 0;
    ConstantMap to;
    Colours colours;
  };

  /// Colours that begin to differ where `label` does; a cell's colour is the number of constants
  /// before it.
  template <typename Label>
  static void split(Colours& colours, const Label& label) {
    std::vector<std::uint32_t> order(colours.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto key = [&](std::uint32_t v) { return std::pair(colours[v], label(v)); };
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
    Colours next(colours.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
      const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
      next[order[i]] = same ? next[order[i - 1]] : i;
    }
    colours = std::move(next);
  }

  /// Separates constants that no permutation of the node's level takes to each other.
  void split_by_orbits(Node& node) const {
    if (node.level >= group_.orbits.size()) return;
    const auto& orbits = group_.orbits[node.level];
    split(node.colours, [&](std::uint32_t v) { return orbits[node.to[v]]; });
  }

  /// Splits cells until equal constants are connected to equal constants in equal ways. New
  /// colours depend on the graph and the group, never on the numbers of its constants.
  void refine(Node& node) const {
    auto& colours = node.colours;
    std::vector<std::uint64_t> sums(colours.size());
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
        sums[v] = sum;
      }
      add_ties(node, sums);
      split(colours, [&](std::uint32_t v) { return sums[v]; });
      const auto more = count(colours);
      if (more == cells) return;
      cells = more;
    }
  }

  /// If fixing a base leaves some other constants fewer places to go than others of their orbit,
  /// they belong together, as a room and its door do.
  void add_ties(const Node& node, std::vector<std::uint64_t>& sums) const {
    if (node.level + 1 >= group_.orbits.size()) return;
    std::vector<std::uint32_t> from(node.to.size());
    for (std::uint32_t v = 0; v < from.size(); ++v) from[node.to[v]] = v;
    for (const auto& tie : group_.ties[node.level]) {
      const auto one = from[tie.one], other = from[tie.other];
      const auto hash = [&](std::uint64_t side, std::uint32_t at) {
        const auto kind = base::fnv1a64_word(base::kFnvStart, 2 * std::uint64_t{tie.kind} + side);
        return base::fnv1a64_word(kind, node.colours[at]);
      };
      sums[one] += hash(0, other);
      sums[other] += hash(1, one);
    }
  }

  static std::size_t count(const Colours& colours) {
    std::vector<bool> used(colours.size());
    for (const auto colour : colours) used[colour] = true;
    return static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  }

  /// The constants that may be taken to the base of the node's level: those of the least colour.
  /// By place in the level's orbit.
  std::vector<std::size_t> candidates(const Node& node) const {
    const auto& orbit = group_.levels[node.level].orbit;
    std::vector<std::uint32_t> from(node.to.size());
    for (std::uint32_t v = 0; v < from.size(); ++v) from[node.to[v]] = v;
    std::vector<std::size_t> best;
    for (std::size_t i = 0; i < orbit.size(); ++i) {
      const auto colour = node.colours[from[orbit[i]]];
      const auto least = best.empty() ? colour : node.colours[from[orbit[best.front()]]];
      if (colour < least) best.clear();
      if (colour <= least) best.push_back(i);
    }
    return best;
  }

  /// The constant that stands at the place of the level's orbit is taken to its base.
  Node child(const Node& node, std::size_t place) const {
    const auto& level = group_.levels[node.level];
    Node out = node;
    ++out.level;
    const auto at = level.orbit[place];
    if (level.to.empty()) {
      for (auto& to : out.to) to = to == at ? level.base : to == level.base ? at : to;
    } else {
      ConstantMap back(out.to.size());
      for (std::uint32_t v = 0; v < back.size(); ++v) back[level.to[place][v]] = v;
      for (auto& to : out.to) to = back[to];
    }
    split(out.colours, [&](std::uint32_t v) { return out.to[v] == level.base ? 0 : 1; });
    split_by_orbits(out);
    refine(out);
    return out;
  }

  /// The graph after replacing the constants as the node maps them.
  Form relabelled(const Node& node) const {
    std::vector<Form> lines;
    for (const auto& edge : edges_) {
      auto& line = lines.emplace_back(Form{edge.kind, edge.layer});
      for (const auto end : edge.ends) line.push_back(node.to[end]);
    }
    std::sort(lines.begin(), lines.end());
    Form out;
    for (const auto& line : lines) {
      out.push_back(static_cast<std::uint32_t>(line.size()));
      out.insert(out.end(), line.begin(), line.end());
    }
    return out;
  }

  /// The leaf reached by always taking the first candidate.
  Form first_leaf(Node node) const {
    while (node.level < group_.levels.size()) node = child(node, candidates(node).front());
    return relabelled(node);
  }

  /// Does a permutation leave the graph as it is?
  bool is_kept(const ConstantMap& map) const {
    std::set<std::uint32_t> touched;
    for (std::uint32_t v = 0; v < map.size(); ++v) {
      if (map[v] != v) touched.insert(at_[v].begin(), at_[v].end());
    }
    std::vector<Form> before, after;
    for (const auto e : touched) {
      Form line = {edges_[e].kind, edges_[e].layer};
      line.insert(line.end(), edges_[e].ends.begin(), edges_[e].ends.end());
      before.push_back(line);
      for (std::size_t i = 2; i < line.size(); ++i) line[i] = map[line[i]];
      after.push_back(std::move(line));
    }
    std::sort(before.begin(), before.end());
    std::sort(after.begin(), after.end());
    return before == after;
  }

  /// A permutation of the group that takes the constant at one place of the level's orbit to the
  /// one at another, and leaves the constants chosen before where they are.
  ConstantMap between(const Node& node, std::size_t one, std::size_t other) const {
    const auto& level = group_.levels[node.level];
    ConstantMap map(node.to.size());
    for (std::uint32_t v = 0; v < map.size(); ++v) map[node.to[v]] = v;  // back
    const auto back = map;
    if (level.to.empty()) {
      std::iota(map.begin(), map.end(), 0U);
      std::swap(map[back[level.orbit[one]]], map[back[level.orbit[other]]]);
      return map;
    }
    const auto &from = level.to[one], &to = level.to[other];
    for (std::uint32_t v = 0; v < map.size(); ++v) map[back[from[v]]] = back[to[v]];
    return map;
  }

  /// Candidates that some automorphism of the graph takes to each other lead to equal subtrees: one
  /// is followed for all.
  std::pair<Form, mpz_class> least(const Node& at) const {
    auto node = at;
    auto places = std::vector<std::size_t>();
    for (; node.level < group_.levels.size(); node = child(node, places.front())) {
      places = candidates(node);
      if (places.size() > 1) break;
    }
    if (node.level == group_.levels.size()) return {relabelled(node), 1};
    struct Child {
      std::size_t place;
      Node node;
      Form first_leaf;
      unsigned long alike = 1;
    };
    std::vector<Child> children;
    for (const auto place : places) {
      auto same = std::find_if(children.begin(), children.end(), [&](const Child& one) {
        return is_kept(between(node, one.place, place));
      });
      Node below;
      Form leaf;
      if (same == children.end()) {
        below = child(node, place);
        leaf = first_leaf(below);
        same = std::find_if(children.begin(), children.end(),
                            [&](const Child& one) { return one.first_leaf == leaf; });
      }
      if (same != children.end()) {
        ++same->alike;
      } else {
        children.push_back({place, std::move(below), std::move(leaf)});
      }
    }
    std::pair<Form, mpz_class> best;
    bool any = false;
    for (const auto& child : children) {
      auto [form, automorphisms] = least(child.node);
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
  const ConstantGroup& group_;
  std::vector<std::vector<std::uint32_t>> at_;  // edges, by constant
};

}  // namespace

TraceOrbits::TraceOrbits(const CompiledModel& model, const ConstantGroup& group, Compared compared)
    : group_(group), compared_(compared), order_(group.order()) {
  for (std::uint32_t i = 0; i < group.constants.size(); ++i) {
    constants_.emplace(group.constants[i], i);
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
  // Traces of different lengths are never exchanged.
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
  auto [form, automorphisms] = FormSearch(std::move(edges), group_).run();
  Orbit orbit;
  orbit.form.resize(form.size() * sizeof(form.front()));
  if (!form.empty()) std::memcpy(orbit.form.data(), form.data(), orbit.form.size());
  orbit.size = order_ / automorphisms;
  return orbit;
}

}  // namespace parallax::runtime
