// Splits the clauses of a model into windows of two neighbouring states and the events between
// them.
//
// The window of a clause follows from its latest variables with a timepoint. Variables without
// one belong to no window; those that clauses connect form components (union-find), and a
// component must stay within one window, where it becomes local. If it does not, its variables
// can be carried: each becomes a hidden slot of every state that no step changes, and the
// clauses are placed anew. Windows with equal clauses are one. Auxiliaries of a state that are
// used in one polarity only get a copy in each of the two windows of the state. Hidden slots are
// those, apart from the observed ones, that one window hands on to the next.
//
// Cost: linear in the clauses, for each time that further variables have to be carried (at most
// 12 of them).

#include "runtime/graph/layered_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include "runtime/graph/far_atoms.h"
#include "runtime/graph/unit_values.h"

namespace parallax::runtime {
namespace {

using compiler::AtomKind;

constexpr std::int64_t kNoWindow = -2;  // of a clause without timed variables
constexpr std::int64_t kStart = -1;     // the window of the state at 0 alone; else the step's time

/// Fixed variables that some clause connects.
class Components {
 public:
  explicit Components(std::size_t count) : parent_(count), window_(count, kNoWindow) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  /// False if the two belong to different windows.
  bool unite(std::size_t a, std::size_t b) {
    a = find(a);
    b = find(b);
    const auto window = window_[b];
    parent_[b] = a;
    return window == kNoWindow || place(a, window);
  }
  bool place(std::size_t v, std::int64_t window) {
    auto& own = window_[find(v)];
    if (own == kNoWindow) own = window;
    return own == window;
  }
  std::int64_t window(std::size_t v) { return window_[find(v)]; }

 private:
  std::vector<std::size_t> parent_;
  std::vector<std::int64_t> window_;
};

class Splitter {
 public:
  Splitter(const CompiledModel& model, Distinct distinct, std::vector<std::int8_t> values,
           FixedTies ties)
      : model_(model),
        distinct_(distinct),
        values_(std::move(values)),
        ties_(ties),
        components_(fixed_count()) {}

  std::variant<LayeredModel, std::string> run() && {
    out_.horizon = model_.horizon;
    for (const auto& fluent : model_.fluents) {
      if (fluent.slot) out_.observed.push_back(*fluent.slot);
    }
    if (distinct_ == Distinct::kAll) {
      for (const auto slot : model_.release_slots) {
        if (slot) out_.observed.push_back(*slot);
      }
    }
    if (!read_fixed()) return reason_;
    while (!place_clauses()) {
      if (!carry_more()) return reason_;
    }
    anchor_to_carried();
    const auto added = static_cast<std::uint32_t>(carried_.size());
    out_.carried.resize(added);
    for (const auto& [v, k] : carried_) out_.carried[k] = static_cast<std::int32_t>(v) + 1;
    out_.state_slots = model_.state_slots + added;
    out_.stride = static_cast<std::uint32_t>(model_.stride()) + added;
    for (const auto& event : model_.events) {
      if (event.slot) out_.events.push_back(*event.slot + added);
    }
    find_copied();
    collect();
    find_hidden();
    return std::move(out_);
  }

 private:
  bool place_clauses() {
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      if (!place_clause(c)) return false;
    }
    return true;
  }

  /// Carries the variables that could not be placed, so that the clauses can be placed anew. False
  /// if that is not allowed, or would not help.
  bool carry_more() {
    if (ties_ == FixedTies::kRefused || tied_.empty()) return false;
    std::vector<std::size_t> roots;
    for (const auto v : tied_) roots.push_back(components_.find(v));
    for (std::size_t v = 0; v < fixed_count(); ++v) {
      if (std::find(roots.begin(), roots.end(), components_.find(v)) == roots.end()) continue;
      if (carried_.size() == kMostCarried) return false;
      carried_.emplace(v, static_cast<std::uint32_t>(carried_.size()));
    }
    tied_.clear();
    reason_.clear();
    components_ = Components(fixed_count());
    return true;
  }

  /// Variables that belong to no window, but are tied to carried ones, belong to the start, where
  /// these have their values.
  void anchor_to_carried() {
    for (std::size_t c = 0; c < model_.clauses.size() && !carried_.empty(); ++c) {
      const auto clause = model_.clauses[c];
      if (is_satisfied(c) || window_of(clause) != kNoWindow) continue;
      const bool tied = std::any_of(clause.begin(), clause.end(), [&](Literal literal) {
        return carried_.contains(static_cast<std::size_t>(literal.var()) - 1);
      });
      for (const auto literal : clause) {
        const auto v = static_cast<std::size_t>(literal.var()) - 1;
        const bool open = fixed_value(literal) == 0 && !carried_.contains(v);
        if (tied && open && components_.window(v) == kNoWindow) components_.place(v, kStart);
      }
    }
  }

  std::size_t fixed_count() const { return static_cast<std::size_t>(model_.base()); }
  bool is_fixed(Literal literal) const { return literal.var() <= model_.base(); }
  std::int8_t fixed_value(Literal literal) const {
    const auto value = values_[static_cast<std::size_t>(literal.var()) - 1];
    return literal.is_positive() ? value : static_cast<std::int8_t>(-value);
  }
  bool is_satisfied(std::size_t c) const {
    const auto clause = model_.clauses[c];
    return std::any_of(clause.begin(), clause.end(), [&](Literal literal) {
      return is_fixed(literal) && fixed_value(literal) > 0;
    });
  }

  bool read_fixed() {
    for (std::int32_t v = 1; v <= model_.base(); ++v) {
      const auto& atom = model_.fixed[static_cast<std::size_t>(v) - 1];
      const auto value = values_[static_cast<std::size_t>(v) - 1];
      if (atom.kind == AtomKind::kHappens && value >= 0) {
        reason_ = fmt::format("`{}` happens at the last timepoint", atom.name);
        return false;
      }
      if (value > 0) out_.true_fixed.push_back(v);
      if (value != 0 || atom.kind == AtomKind::kUnused) continue;
      out_.open_fixed.push_back(v);
      if (distinct_ == Distinct::kObservable || atom.kind != AtomKind::kPredicate) continue;
      reason_ = fmt::format("`{}` tells traces apart", atom.name);
      return false;
    }
    return true;
  }

  /// The window of the clause's timed variables; none if they do not fit into one.
  std::optional<std::int64_t> window_of(std::span<const Literal> clause) {
    std::int64_t least = model_.horizon + 1, most = -1, step = kNoWindow;
    for (const auto literal : clause) {
      if (is_fixed(literal)) continue;
      const auto place = literal.var() - model_.base() - 1;
      const std::int64_t t = place / model_.stride();
      if (place % model_.stride() < static_cast<std::int32_t>(model_.state_slots)) {
        least = std::min(least, t);
        most = std::max(most, t);
      } else if (step != kNoWindow && step != t) {
        return std::nullopt;
      } else {
        step = t;
      }
    }
    if (step != kNoWindow) {
      if (most >= 0 && (least < step || most > step + 1)) return std::nullopt;
      return step;
    }
    if (most < 0) return kNoWindow;
    if (most - least > 1) return std::nullopt;
    return most > least ? least : most - 1;
  }

  bool place_clause(std::size_t c) {
    if (is_satisfied(c)) return true;
    const auto clause = model_.clauses[c];
    const auto window = window_of(clause);
    bool fits = window.has_value();
    std::optional<std::size_t> first;
    for (const auto literal : clause) {
      if (!fits) break;
      if (!is_fixed(literal) || fixed_value(literal) != 0) continue;
      const auto v = static_cast<std::size_t>(literal.var()) - 1;
      if (carried_.contains(v)) continue;
      if (window) tied_ = {v};
      if (first) fits = components_.unite(*first, v);
      if (fits && *window != kNoWindow) fits = components_.place(v, *window);
      first = v;
    }
    if (fits) return true;
    if (!window) tied_.clear();
    reason_ = window ? why_tied(c, *window, *first) : why_too_far(c);
    return false;
  }

  std::string_view text_of(std::size_t c) const {
    const auto& origin = model_.origins[model_.clause_origins[c]];
    return origin.text.empty() ? to_string(origin.kind) : std::string_view(origin.text);
  }

  /// The reason why a clause fits into no window.
  std::string why_too_far(std::size_t c) const {
    std::vector<std::int64_t> times;  // of its events
    for (const auto literal : model_.clauses[c]) {
      if (is_fixed(literal)) continue;
      const auto place = literal.var() - model_.base() - 1;
      const bool is_state = slot_of(literal) < static_cast<std::int32_t>(model_.state_slots);
      if (!is_state) times.push_back(place / model_.stride());
    }
    const auto [least, most] = std::minmax_element(times.begin(), times.end());
    if (least != times.end() && *most - *least == 1) {
      return fmt::format("`{}` ties the events of one timepoint to those of the next", text_of(c));
    }
    return fmt::format("the clauses of `{}` look at more than two neighbouring timepoints",
                       text_of(c));
  }

  /// The reason why a clause is tied to another window than its own, by a variable without a
  /// timepoint: names the first clause that put the variable there.
  std::string why_tied(std::size_t c, std::int64_t window, std::size_t v) {
    for (std::size_t other = 0; other < c; ++other) {
      const auto there = window_of(model_.clauses[other]);
      if (!there || *there == kNoWindow || *there == window || is_satisfied(other)) continue;
      for (const auto literal : model_.clauses[other]) {
        if (!is_fixed(literal)) continue;
        const auto w = static_cast<std::size_t>(literal.var()) - 1;
        if (carried_.contains(w)) continue;
        if (components_.find(w) != components_.find(v)) continue;
        const auto& atom = model_.fixed[w];
        const auto by = atom.name.empty() ? std::string() : fmt::format(" by `{}`", atom.name);
        return fmt::format(
            "`{}` and `{}` are tied together{}, and look at more than two neighbouring timepoints",
            text_of(other), text_of(c), by);
      }
    }
    return why_too_far(c);
  }

  /// Does the clause speak of one state only? Its timepoint then.
  std::optional<std::int64_t> state_of(std::span<const Literal> clause) const {
    std::optional<std::int64_t> state;
    for (const auto literal : clause) {
      if (is_fixed(literal)) {
        if (fixed_value(literal) == 0) return std::nullopt;
        continue;
      }
      const auto place = literal.var() - model_.base() - 1;
      const std::int64_t t = place / model_.stride();
      const bool is_state = slot_of(literal) < static_cast<std::int32_t>(model_.state_slots);
      if (!is_state || (state && *state != t)) return std::nullopt;
      state = t;
    }
    return state;
  }
  std::int32_t slot_of(Literal literal) const {
    return (literal.var() - model_.base() - 1) % model_.stride();
  }

  /// Auxiliaries of a state that need no single value in the two windows of that state: each window
  /// gets a copy with the clauses that define it. They are those that stand negated only in clauses
  /// about the state alone: where one copy is true, its formula is, so the disjunction of the
  /// copies serves both windows.
  void find_copied() {
    copied_.assign(model_.state_slots, false);
    for (std::uint32_t slot = 0; slot < model_.state_slots; ++slot) {
      copied_[slot] = model_.slots[slot].kind == AtomKind::kAuxiliary;
    }
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      const auto clause = model_.clauses[c];
      if (is_satisfied(c) || state_of(clause)) continue;
      for (const auto literal : clause) {
        if (is_fixed(literal) || literal.is_positive()) continue;
        const auto slot = static_cast<std::size_t>(slot_of(literal));
        if (slot < copied_.size()) copied_[slot] = false;
      }
    }
  }
  bool has_copied(std::span<const Literal> clause) const {
    return std::any_of(clause.begin(), clause.end(), [&](Literal literal) {
      return !is_fixed(literal) && static_cast<std::size_t>(slot_of(literal)) < copied_.size() &&
             copied_[static_cast<std::size_t>(slot_of(literal))];
    });
  }

  /// Writes every clause into its window.
  void collect() {
    std::vector<WindowClauses> windows(static_cast<std::size_t>(model_.horizon) + 1);
    std::vector<std::map<std::int32_t, std::int32_t>> locals(windows.size());
    const auto frame = static_cast<std::int32_t>(out_.state_slots + out_.stride);
    for (std::size_t i = 0; i < windows.size(); ++i) {
      windows[i].variables = i == 0 ? static_cast<std::int32_t>(out_.state_slots) : frame;
      if (i > 0) keep_carried(windows[i]);
    }
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      if (is_satisfied(c)) continue;
      const auto clause = model_.clauses[c];
      auto window = *window_of(clause);
      for (const auto literal : clause) {
        if (window != kNoWindow || !is_fixed(literal) || fixed_value(literal) != 0) continue;
        const auto v = static_cast<std::size_t>(literal.var()) - 1;
        window = carried_.contains(v) ? kNoWindow : components_.window(v);
      }
      if (window == kNoWindow && is_carried(clause)) window = kStart;
      if (window == kNoWindow && !clause.empty()) {
        out_.has_unplaced = true;
        continue;
      }
      window = std::max(window, kStart);
      const auto index = static_cast<std::size_t>(window + 1);
      write(clause, window, windows[index], locals[index]);
      const auto state = state_of(clause);
      if (state && *state < model_.horizon && has_copied(clause)) {
        const auto next = static_cast<std::size_t>(*state + 1);
        write(clause, *state, windows[next], locals[next]);
      }
    }
    group(std::move(windows));
  }

  /// Are all of its open variables carried?
  bool is_carried(std::span<const Literal> clause) const {
    std::size_t open = 0, carried = 0;
    for (const auto literal : clause) {
      if (is_fixed(literal) && fixed_value(literal) != 0) continue;
      ++open;
      if (is_fixed(literal)) carried += carried_.count(static_cast<std::size_t>(literal.var()) - 1);
    }
    return open > 0 && open == carried;
  }

  /// Adds clauses by which no step changes the carried slots.
  void keep_carried(WindowClauses& step) const {
    for (std::uint32_t k = 0; k < carried_.size(); ++k) {
      const auto before = static_cast<std::int32_t>(model_.state_slots + k + 1);
      const auto after = before + static_cast<std::int32_t>(out_.state_slots);
      step.clauses.push_back({-before, after});
      step.clauses.push_back({-after, before});
    }
  }

  void write(std::span<const Literal> clause, std::int64_t window, WindowClauses& target,
             std::map<std::int32_t, std::int32_t>& locals) const {
    auto& written = target.clauses.emplace_back();
    for (const auto literal : clause) {
      if (is_fixed(literal) && fixed_value(literal) != 0) continue;
      written.push_back(local(literal, window, target, locals));
    }
    // Negative literals first: most atoms are false, so most clauses are seen to hold at once.
    std::sort(written.begin(), written.end());
  }

  std::int32_t local(Literal literal, std::int64_t window, WindowClauses& target,
                     std::map<std::int32_t, std::int32_t>& locals) const {
    std::int32_t v = 0;
    const auto fixed = static_cast<std::size_t>(literal.var()) - 1;
    if (is_fixed(literal) && carried_.contains(fixed)) {
      v = static_cast<std::int32_t>(model_.state_slots + carried_.at(fixed) + 1);
    } else if (is_fixed(literal)) {
      const auto [entry, added] = locals.try_emplace(literal.var(), target.variables + 1);
      if (added) ++target.variables;
      v = entry->second;
    } else {
      const auto place = literal.var() - model_.base() - 1;
      const auto slot = place % model_.stride();
      const auto slots = static_cast<std::int32_t>(out_.state_slots);
      if (slot >= static_cast<std::int32_t>(model_.state_slots)) {
        v = slots + slot + static_cast<std::int32_t>(carried_.size()) + 1;
      } else {
        const bool after = window != kStart && place / model_.stride() != window;
        v = slot + 1 + (after ? slots : 0);
      }
    }
    return literal.is_positive() ? v : -v;
  }

  /// Steps with the same clauses are one.
  void group(std::vector<WindowClauses> windows) {
    out_.start = std::move(windows[0]);
    std::map<std::vector<std::vector<std::int32_t>>, std::uint32_t> known;
    for (std::size_t i = 1; i < windows.size(); ++i) {
      auto& clauses = windows[i].clauses;
      std::sort(clauses.begin(), clauses.end());
      const auto [entry, added] =
          known.try_emplace(clauses, static_cast<std::uint32_t>(out_.steps.size()));
      if (added) out_.steps.push_back(std::move(windows[i]));
      out_.step_at.push_back(entry->second);
    }
  }

  void find_hidden() {
    const auto slots = out_.state_slots;
    const auto own = model_.state_slots;
    std::vector<bool> before(slots, false), after(slots, false);
    const auto note = [&](const WindowClauses& window, bool is_start) {
      for (const auto& clause : window.clauses) {
        for (const auto literal : clause) {
          const auto v = static_cast<std::uint32_t>(std::abs(literal)) - 1;
          if (v < slots) (is_start ? after : before)[v] = true;
          if (!is_start && v >= slots && v < 2 * slots) after[v - slots] = true;
        }
      }
    };
    note(out_.start, true);
    for (const auto& step : out_.steps) note(step, false);
    std::vector<bool> seen(slots, false);
    for (const auto slot : out_.observed) seen[slot] = true;
    for (std::uint32_t slot = own; slot < slots; ++slot) out_.hidden.push_back(slot);
    for (std::uint32_t slot = 0; slot < own; ++slot) {
      if (seen[slot] || copied_[slot]) continue;
      if (before[slot] && after[slot]) {
        out_.hidden.push_back(slot);
      } else if ((before[slot] || after[slot]) &&
                 model_.slots[slot].kind == AtomKind::kReleasedAt) {
        out_.loose_releases.push_back(slot);
      }
    }
  }

  const CompiledModel& model_;
  Distinct distinct_;
  std::vector<std::int8_t> values_;
  FixedTies ties_;
  Components components_;
  std::map<std::size_t, std::uint32_t>
      carried_;                    // by fixed variable - 1: which state slot of these
  std::vector<std::size_t> tied_;  // the variable at which a clause could not be placed
  std::vector<bool> copied_;       // by state slot
  LayeredModel out_;
  std::string reason_;
};

}  // namespace

std::vector<Literal> LayeredModel::state_before() const {
  std::vector<Literal> out;
  for (const auto slot : observed) out.push_back(before(slot));
  for (const auto slot : hidden) out.push_back(before(slot));
  return out;
}

std::vector<Literal> LayeredModel::state_after() const {
  auto out = state_before();
  for (auto& literal : out) literal = after(static_cast<std::uint32_t>(literal.var()) - 1);
  return out;
}

std::variant<LayeredModel, std::string> split_into_windows(const CompiledModel& model,
                                                           Distinct distinct, FixedTies ties) {
  auto split = Splitter(model, distinct, unit_values(model), ties).run();
  if (ties == FixedTies::kRefused || std::holds_alternative<LayeredModel>(split)) return split;
  const auto tied = with_far_atoms_fixed(model, kMostCarried);
  if (!tied) return split;
  auto again = Splitter(*tied, distinct, unit_values(*tied), ties).run();
  if (!std::holds_alternative<LayeredModel>(again)) return split;
  // Variables that were added are no atoms of the model.
  const auto is_added = [&](std::int32_t v) { return v > model.base(); };
  std::erase_if(std::get<LayeredModel>(again).true_fixed, is_added);
  return again;
}

std::variant<LayeredModel, std::string> split_into_windows(const CompiledModel& model,
                                                           Distinct distinct,
                                                           std::vector<std::int8_t> values) {
  return Splitter(model, distinct, std::move(values), FixedTies::kRefused).run();
}

}  // namespace parallax::runtime
