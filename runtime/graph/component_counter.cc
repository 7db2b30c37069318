// Exact model counting with component caching (Bayardo and Pehoushek 2000; Sang et al. 2004).
//
// Variables are set in a fixed order, false and then true, with unit propagation. After each
// value the open clauses fall apart into components without a common open variable; their counts
// are multiplied. A component is known by its open variables and the clauses that are not true
// yet: the other literals of these clauses are false, so both together determine what is left.
// Its count is kept under their SHA-256. Variables that tell nothing apart come last in the
// order; a component of these alone counts 1 as soon as it has one valuation. The k-th valuation
// is found by setting one variable after the other and counting what is left.
//
// By default variables follow time; `reorder` takes the reverse of an elimination order
// (elimination_order.cc). Cost: exponential in the worst case, so literals looked at, components
// and memory are limited.

#include "runtime/graph/component_counter.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

#include "compiler/base/sha256.h"
#include "runtime/graph/elimination_order.h"

namespace parallax::runtime {
namespace {

constexpr std::uint32_t kUnseen = 0xffffffffU;
constexpr std::uint32_t kAlone = 0xfffffffeU;      // a variable of no clause
constexpr std::uint32_t kSatisfied = 0xfffffffdU;  // a clause that is true

/// Most edges while variables are eliminated from the graph in which those that share a clause are
/// neighbours.
constexpr std::size_t kMostEdges = 20'000'000;

/// Ascending numbers as differences, seven bits a byte.
void put_numbers(const std::vector<std::uint32_t>& numbers, std::string& out) {
  std::uint32_t last = 0;
  for (const auto number : numbers) {
    auto rest = number - last;
    last = number;
    for (; rest >= 128; rest >>= 7U) out += static_cast<char>(rest | 128U);
    out += static_cast<char>(rest);
  }
}

}  // namespace

std::size_t ComponentCounter::KeyHash::operator()(const Key& key) const {
  std::size_t hash = 0;
  std::memcpy(&hash, key.data(), sizeof hash);
  return hash;
}

ComponentCounter::ComponentCounter(std::int32_t variables, std::span<const Literal> projected)
    : state_(variables),
      told_apart_(projected.begin(), projected.end()),
      rank_(state_.variables(), kUnseen),
      clauses_of_(state_.variables()),
      part_of_(state_.variables(), kUnseen) {
  for (const auto literal : projected) {
    const auto variable = static_cast<std::uint32_t>(literal.var()) - 1;
    rank_[variable] = static_cast<std::uint32_t>(ranked_.size());
    ranked_.push_back(variable);
  }
  projected_ = ranked_.size();
  for (std::uint32_t variable = 0; variable < rank_.size(); ++variable) {
    if (rank_[variable] != kUnseen) continue;
    rank_[variable] = static_cast<std::uint32_t>(ranked_.size());
    ranked_.push_back(variable);
  }
}

void ComponentCounter::add_clause(std::span<const Literal> clause) {
  std::vector<ClausePropagation::Code> codes;
  codes.reserve(clause.size());
  for (const auto literal : clause) codes.push_back(ClausePropagation::code(literal));
  // Whose literals differ is known to be true or open; twice the same would be watched twice.
  std::sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  if (codes.empty()) has_empty_ = true;
  if (codes.size() == 1) units_.push_back(codes.front());
  if (codes.size() < 2) return;
  const auto number = static_cast<std::uint32_t>(clauses_.size());
  clauses_.push_back(state_.add(codes));
  for (const auto c : codes) {
    auto& clauses = clauses_of_[c >> 1U];
    if (clauses.empty() || clauses.back() != number) clauses.push_back(number);
  }
  part_of_clause_.push_back(kUnseen);
}

bool ComponentCounter::reorder() {
  if (is_reordered_ || has_empty_) return false;
  state_.undo(0);
  for (const auto unit : units_) {
    if (!state_.assume(unit)) return false;
  }
  if (!state_.propagate()) return false;
  std::vector<std::vector<std::uint32_t>> cliques;
  for (std::uint32_t clause = 0; clause < clauses_.size(); ++clause) {
    if (is_true(clause)) continue;
    auto& clique = cliques.emplace_back();
    for (const auto* at = state_.literals(clauses_[clause]); *at != ClausePropagation::kEnd; ++at) {
      if (state_.is_open(*at)) clique.push_back(rank_[*at >> 1U]);
    }
  }
  std::vector<std::uint8_t> stage(rank_.size());
  for (std::size_t ranked = 0; ranked < stage.size(); ++ranked) stage[ranked] = ranked < projected_;
  const auto order = elimination_order(rank_.size(), cliques, stage, kMostEdges);
  if (!order) return false;
  std::vector<std::uint32_t> ranked;
  for (auto at = order->rbegin(); at != order->rend(); ++at) ranked.push_back(ranked_[*at]);
  ranked_ = std::move(ranked);
  for (std::uint32_t r = 0; r < ranked_.size(); ++r) rank_[ranked_[r]] = r;
  counts_.clear();  // components are known by ranks
  steps_ = 0;
  is_reordered_ = true;
  return true;
}

std::optional<mpz_class> ComponentCounter::count(std::span<const Literal> assumptions,
                                                 const Limits& limits,
                                                 const std::atomic<bool>* stop) {
  frames_.clear();
  held_ = 0;
  state_.undo(0);
  bool is_consistent = !has_empty_;
  for (const auto unit : units_) is_consistent = is_consistent && state_.assume(unit);
  for (const auto literal : assumptions) {
    is_consistent = is_consistent && state_.assume(ClausePropagation::code(literal));
  }
  if (!is_consistent || !state_.propagate()) return mpz_class(0);
  auto& whole = frames_.emplace_back();
  whole.is_last = true;
  whole.component.variables.resize(rank_.size());
  std::iota(whole.component.variables.begin(), whole.component.variables.end(), 0U);
  whole.component.clauses.resize(clauses_.size());
  std::iota(whole.component.clauses.begin(), whole.component.clauses.end(), 0U);
  whole.product = split(whole.component, whole.parts);
  while (true) {
    auto& frame = frames_.back();
    if (frame.product != 0 && !frame.parts.empty()) {
      if (!is_within(limits, stop)) return std::nullopt;
      auto part = std::move(frame.parts.back());
      frame.parts.pop_back();
      const auto key = key_of(part);
      if (const auto known = counts_.find(key); known != counts_.end()) {
        frame.product *= known->second;
      } else {
        enter(std::move(part), key);
      }
      continue;
    }
    frame.total += frame.product;
    if (frames_.size() == 1) return frame.total;
    // Hidden variables are not told apart: it is enough that they have some values.
    const bool is_hidden = frame.component.variables.front() >= projected_;
    if (frame.is_last || (is_hidden && frame.total > 0)) {
      leave();
    } else {
      frame.is_last = true;
      take_value(frame, true);
    }
  }
}

std::optional<std::vector<Literal>> ComponentCounter::nth(mpz_class before, const Limits& limits,
                                                          const std::atomic<bool>* stop) {
  std::vector<Literal> values;
  if (!count(values, limits, stop)) return std::nullopt;
  for (const auto literal : told_apart_) {
    if (!state_.is_open(ClausePropagation::code(literal))) continue;
    values.push_back(~literal);
    auto counted = count(values, limits, stop);
    if (counted && before >= *counted) {
      before -= *counted;
      values.back() = literal;
      counted = count(values, limits, stop);
    }
    if (!counted) return std::nullopt;
  }
  return values;
}

bool ComponentCounter::is_within(const Limits& limits, const std::atomic<bool>* stop) const {
  return steps_ < limits.steps && counts_.size() < limits.cached && held_ < limits.held &&
         (stop == nullptr || !stop->load(std::memory_order_relaxed));
}

void ComponentCounter::enter(Component component, const Key& key) {
  held_ += component.size();
  auto& frame = frames_.emplace_back();
  frame.component = std::move(component);
  frame.key = key;
  frame.trail = state_.trail().size();
  take_value(frame, false);
}

/// Sets the first variable of the frame's component to the value.
void ComponentCounter::take_value(Frame& frame, bool value) {
  state_.undo(frame.trail);
  frame.parts.clear();
  state_.set(2 * ranked_[frame.component.variables.front()] + (value ? 0 : 1));
  frame.product = state_.propagate() ? split(frame.component, frame.parts) : mpz_class(0);
}

void ComponentCounter::leave() {
  auto& frame = frames_.back();
  state_.undo(frame.trail);
  held_ -= frame.component.size();
  const auto count = std::move(frame.total);
  counts_.emplace(frame.key, count);
  frames_.pop_back();
  frames_.back().product *= count;
}

/// The open parts of `whole`, the smallest last. Returns the number of valuations of the variables
/// that occur in no clause any more.
mpz_class ComponentCounter::split(const Component& whole, std::vector<Component>& parts) {
  for (const auto ranked : whole.variables) part_of_[ranked_[ranked]] = kUnseen;
  for (const auto clause : whole.clauses) part_of_clause_[clause] = kUnseen;
  std::uint32_t count = 0;
  mp_bitcnt_t alone = 0;
  for (const auto ranked : whole.variables) {
    const auto variable = ranked_[ranked];
    if (part_of_[variable] != kUnseen || !state_.is_open(2 * variable)) continue;
    gather(variable, count);
    if (part_of_[variable] == count) {
      ++count;
    } else if (ranked < projected_) {
      ++alone;
    }
  }
  parts.resize(count);
  for (const auto ranked : whole.variables) {
    const auto part = part_of_[ranked_[ranked]];
    if (part < count) parts[part].variables.push_back(ranked);
  }
  for (const auto clause : whole.clauses) {
    const auto part = part_of_clause_[clause];
    if (part < count) parts[part].clauses.push_back(clause);
  }
  std::stable_sort(parts.begin(), parts.end(), [](const Component& a, const Component& b) {
    return a.variables.size() > b.variables.size();
  });
  mpz_class free = 1;
  free <<= alone;
  return free;
}

/// Notes the open variables that share a clause with `from`, directly or by others.
void ComponentCounter::gather(std::uint32_t from, std::uint32_t part) {
  reached_.assign(1, from);
  part_of_[from] = part;
  bool has_clause = false;
  for (std::size_t next = 0; next < reached_.size(); ++next) {
    for (const auto clause : clauses_of_[reached_[next]]) {
      if (part_of_clause_[clause] != kUnseen) continue;
      if (is_true(clause)) {
        part_of_clause_[clause] = kSatisfied;
        continue;
      }
      part_of_clause_[clause] = part;
      has_clause = true;
      for (const auto* at = state_.literals(clauses_[clause]); *at != ClausePropagation::kEnd;
           ++at) {
        const auto variable = *at >> 1U;
        if (!state_.is_open(*at) || part_of_[variable] == part) continue;
        part_of_[variable] = part;
        reached_.push_back(variable);
      }
    }
  }
  if (!has_clause) part_of_[from] = kAlone;
}

bool ComponentCounter::is_true(std::uint32_t clause) {
  const auto* at = state_.literals(clauses_[clause]);
  while (*at != ClausePropagation::kEnd && !state_.is_true(*at)) {
    ++at;
    ++steps_;
  }
  return *at != ClausePropagation::kEnd;
}

ComponentCounter::Key ComponentCounter::key_of(const Component& component) {
  bytes_.clear();
  put_numbers({static_cast<std::uint32_t>(component.variables.size())}, bytes_);
  put_numbers(component.variables, bytes_);
  put_numbers(component.clauses, bytes_);
  return base::sha256(bytes_);
}

}  // namespace parallax::runtime
