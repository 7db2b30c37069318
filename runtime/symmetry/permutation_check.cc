// Does a permutation of constants map the clauses of a model onto themselves?
//
// Names are mapped by replacing constants; facts about moved constants are compared first, as
// they refute most candidates. Auxiliaries have no names: in the order in which they are defined
// by each other, each is mapped to the one whose definitions have the hash of the mapped
// definitions. Then every clause that mentions a moved node has to have its image among the
// clauses, found by a hash that does not depend on the order of literals and compared literal by
// literal. So a collision of hashes can hide a symmetry but not make one. Clauses that hold at
// every timepoint are looked at once; invariants follow from the rest and are left out.
//
// Cost: linear in the clauses that mention a moved constant or an auxiliary over it.

#include "runtime/symmetry/permutation_check.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "compiler/base/hash.h"

namespace parallax::runtime {

using compiler::AtomKind;
using compiler::CompiledModel;
using compiler::Literal;

namespace {

constexpr auto kNoImage = std::numeric_limits<ModelNode>::max();
constexpr auto kNoRank = std::numeric_limits<std::uint32_t>::max();

std::uint64_t mixed(std::uint64_t a, std::uint64_t b) {
  return base::fnv1a64_word(base::fnv1a64_word(base::kFnvStart, a), b);
}

}  // namespace

PermutationCheck::PermutationCheck(const CompiledModel& model, const NamedAtoms& atoms)
    : model_(model), atoms_(atoms) {
  const auto nodes = atoms.node_count();
  mentions_.resize(nodes);
  facts_.resize(nodes);
  definitions_.resize(nodes);
  users_.resize(nodes);
  rank_.assign(nodes, kNoRank);
  images_.assign(nodes, kNoImage);
  collect();
}

void PermutationCheck::collect() {
  for (std::size_t s = 0; s < model_.sections.size(); ++s) {
    const auto& section = model_.sections[s];
    if (section.copies < 1) continue;
    for (std::size_t c = section.begin; c < section.begin + section.clauses; ++c) {
      const auto kind = model_.origins[model_.clause_origins[c]].kind;
      const bool defines = model_.clause_is_definition[c];
      if (kind == compiler::OriginKind::kInvariant && !defines) continue;
      const auto number = static_cast<std::uint32_t>(entries_.size());
      entries_.push_back(
          {static_cast<std::uint32_t>(c), section.repeated ? static_cast<std::int32_t>(s) + 1 : 0});
      const auto literals = model_.clauses[c];
      for (const auto literal : literals) {
        mentions_[node_of(model_, literal.var())].push_back(number);
      }
      if (!defines && literals.size() == 1) {
        facts_[node_of(model_, literals.front().var())].push_back(number);
      }
      if (!defines || literals.empty()) continue;
      const auto self = node_of(model_, literals.front().var());
      if (!atoms_.node(self).name.empty()) continue;
      definitions_[self].push_back(number);
      for (const auto literal : literals.subspan(1)) {
        users_[node_of(model_, literal.var())].push_back(self);
      }
    }
  }
}

/// Prepares tables that only a check needs: many models have no two constants worth checking.
void PermutationCheck::prepare() {
  seen_.assign(entries_.size(), 0);
  by_hash_.reserve(entries_.size());
  for (std::uint32_t e = 0; e < entries_.size(); ++e) by_hash_.emplace(clause_hash(entries_[e]), e);
  order_auxiliaries();
}

/// Orders auxiliaries after those that define them. One in a cycle has no rank, and is no image.
void PermutationCheck::order_auxiliaries() {
  std::vector<std::uint32_t> open(definitions_.size(), 0);  // auxiliaries it waits for
  std::vector<ModelNode> ready;
  const auto is_defined = [&](ModelNode node) { return !definitions_[node].empty(); };
  for (ModelNode node = 0; node < users_.size(); ++node) {
    if (!is_defined(node)) continue;
    for (const auto user : users_[node]) ++open[user];
  }
  for (ModelNode node = 0; node < users_.size(); ++node) {
    if (is_defined(node) && open[node] == 0) ready.push_back(node);
  }
  for (std::uint32_t next = 0; next < ready.size(); ++next) {
    const auto node = ready[next];
    rank_[node] = next;
    by_definition_.emplace(definition_hash(node), node);
    for (const auto user : users_[node]) {
      if (--open[user] == 0) ready.push_back(user);
    }
  }
  for (auto& users : users_) {
    std::sort(users.begin(), users.end());
    users.erase(std::unique(users.begin(), users.end()), users.end());
  }
}

ModelNode PermutationCheck::image(ModelNode node) const {
  return images_[node] == kNoImage ? node : images_[node];
}

std::int32_t PermutationCheck::time_of(std::int32_t variable) const {
  const auto place = variable - 1 - model_.base();
  return place < 0 ? -1 : place / model_.stride();
}

/// Hash of a literal whose variable is mapped to the node `image`, seen from timepoint `origin`.
std::uint64_t PermutationCheck::literal_hash(Literal literal, ModelNode image,
                                             std::int32_t origin) const {
  const auto time = time_of(literal.var());
  const auto from = time < 0 ? 0 : static_cast<std::uint64_t>(time - origin + (1 << 20));
  return mixed(image, 2 * from + (literal.is_positive() ? 1 : 0));
}

/// Hash of a mapped clause; the same whatever the order of the literals.
std::uint64_t PermutationCheck::clause_hash(const Entry& entry) const {
  std::uint64_t sum = 0;
  for (const auto literal : model_.clauses[entry.clause]) {
    sum += literal_hash(literal, image(node_of(model_, literal.var())), 0);
  }
  return mixed(sum, static_cast<std::uint64_t>(entry.section));
}

/// Hash of the mapped definitions of an auxiliary; the same whatever their order.
std::uint64_t PermutationCheck::definition_hash(ModelNode auxiliary) const {
  std::uint64_t all = 0;
  for (const auto number : definitions_[auxiliary]) {
    const auto& entry = entries_[number];
    const auto literals = model_.clauses[entry.clause];
    const auto time = std::max(time_of(literals.front().var()), 0);
    std::uint64_t sum = 0;
    for (const auto literal : literals.subspan(1)) {
      sum += literal_hash(literal, image(node_of(model_, literal.var())), time);
    }
    const auto when = entry.section == 0 ? static_cast<std::uint64_t>(time) : 0;
    all += mixed(mixed(sum, when), 2 * static_cast<std::uint64_t>(entry.section) +
                                       (literals.front().is_positive() ? 1 : 0));
  }
  return all;
}

std::uint64_t PermutationCheck::signature(std::uint32_t constant) const {
  std::uint64_t all = 0;
  for (const auto node : atoms_.mentions(constant)) {
    const auto& [name, places] = atoms_.node(node);
    // The name with this constant blanked, and the others too: the kind of atom.
    std::uint64_t kind = base::kFnvStart;
    std::size_t copied = 0;
    for (const auto& place : places) {
      kind = base::fnv1a64(std::string_view(name).substr(copied, place.begin - copied), kind);
      kind = base::fnv1a64_word(kind, place.constant == constant ? 1 : 2);
      copied = place.begin + place.size;
    }
    kind = base::fnv1a64(std::string_view(name).substr(copied), kind);
    std::uint64_t where = 0;
    for (const auto number : mentions_[node]) {
      const auto literals = model_.clauses[entries_[number].clause];
      for (const auto literal : literals) {
        if (node_of(model_, literal.var()) != node) continue;
        const auto tag =
            mixed(static_cast<std::uint64_t>(entries_[number].section), literals.size());
        where += mixed(tag, literal_hash(literal, 0, 0));
      }
    }
    all += mixed(kind, where);
  }
  return all;
}

bool PermutationCheck::set_image(ModelNode node, ModelNode to) {
  const auto state = static_cast<ModelNode>(model_.base()) + model_.state_slots;
  const auto fixed = static_cast<ModelNode>(model_.base());
  const auto place = [&](ModelNode n) { return n < fixed ? 0 : n < state ? 1 : 2; };
  if (place(node) != place(to)) return false;
  images_[node] = to;
  moved_.push_back(node);
  return true;
}

/// Quick test: most constants that are alike differ by facts, such as where each thing is at first.
bool PermutationCheck::map_facts(const ConstantMap& map) {
  for (std::uint32_t constant = 0; constant < map.size(); ++constant) {
    if (map[constant] == constant) continue;
    for (const auto node : atoms_.mentions(constant)) {
      if (facts_[node].empty() || images_[node] != kNoImage) continue;
      const auto to = atoms_.image(node, map);
      if (!to || !set_image(node, *to)) return false;
      for (const auto number : facts_[node]) {
        ++work_;
        if (!has_image(entries_[number])) return false;
      }
    }
  }
  return true;
}

bool PermutationCheck::map_names(const ConstantMap& map) {
  for (std::uint32_t constant = 0; constant < map.size(); ++constant) {
    if (map[constant] == constant) continue;
    for (const auto node : atoms_.mentions(constant)) {
      if (images_[node] != kNoImage) continue;  // mentions several, or has facts
      const auto to = atoms_.image(node, map);
      if (!to || !set_image(node, *to)) return false;
    }
  }
  return true;
}

/// Are the moved nodes and their images the same nodes, each once?
bool PermutationCheck::is_bijective() {
  std::vector<ModelNode> from = moved_, to;
  for (const auto node : moved_) to.push_back(images_[node]);
  std::sort(from.begin(), from.end());
  std::sort(to.begin(), to.end());
  return from == to;
}

/// Maps auxiliaries in order of rank, so that the parts of each definition have their images
/// before.
bool PermutationCheck::map_auxiliaries() {
  std::set<std::pair<std::uint32_t, ModelNode>> due;
  const auto touch = [&](ModelNode node) {
    for (const auto user : users_[node]) due.emplace(rank_[user], user);
  };
  for (const auto node : moved_) touch(node);
  while (!due.empty()) {
    const auto [rank, auxiliary] = *due.begin();
    due.erase(due.begin());
    work_ += static_cast<std::int64_t>(definitions_[auxiliary].size());
    if (rank == kNoRank) return false;
    const auto found = by_definition_.find(definition_hash(auxiliary));
    if (found == by_definition_.end()) return false;
    if (found->second == auxiliary) continue;
    if (!set_image(auxiliary, found->second)) return false;
    touch(auxiliary);
  }
  return is_bijective();
}

/// Is the mapped clause one of the model's? Clauses with equal hashes are compared literal by
/// literal.
bool PermutationCheck::has_image(const Entry& entry) {
  const auto sorted = [](std::vector<std::int32_t>& all) { std::sort(all.begin(), all.end()); };
  std::vector<std::int32_t> wanted, other;
  for (const auto literal : model_.clauses[entry.clause]) {
    const auto node = node_of(model_, literal.var());
    const auto variable =
        literal.var() + static_cast<std::int32_t>(image(node)) - static_cast<std::int32_t>(node);
    wanted.push_back(literal.is_positive() ? variable : -variable);
  }
  sorted(wanted);
  const auto [begin, end] = by_hash_.equal_range(clause_hash(entry));
  return std::any_of(begin, end, [&](const auto& one) {
    const auto& candidate = entries_[one.second];
    if (candidate.section != entry.section) return false;
    if (model_.clause_timepoints[candidate.clause] != model_.clause_timepoints[entry.clause]) {
      return false;
    }
    if (model_.clause_is_definition[candidate.clause] !=
        model_.clause_is_definition[entry.clause]) {
      return false;
    }
    other.clear();
    for (const auto literal : model_.clauses[candidate.clause]) {
      other.push_back(literal.is_positive() ? literal.var() : -literal.var());
    }
    sorted(other);
    return other == wanted;
  });
}

void PermutationCheck::clear() {
  for (const auto node : moved_) images_[node] = kNoImage;
  moved_.clear();
}

bool PermutationCheck::is_symmetric(const ConstantMap& map) {
  if (checks_ == 0) prepare();
  clear();
  ++checks_;
  bool maps = map_facts(map) && map_names(map) && map_auxiliaries();
  for (std::size_t i = 0; maps && i < moved_.size(); ++i) {
    for (const auto number : mentions_[moved_[i]]) {
      if (std::exchange(seen_[number], checks_) == checks_) continue;
      ++work_;
      maps = has_image(entries_[number]);
      if (!maps) break;
    }
  }
  clear();
  return maps;
}

}  // namespace parallax::runtime
