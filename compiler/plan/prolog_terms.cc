#include "compiler/plan/prolog_terms.h"

namespace parallax::compiler {

TermId TermStore::atom(ValueId value) {
  nodes_.push_back({Kind::kAtom, false, value.index(), 0});
  return TermId(static_cast<std::uint32_t>(nodes_.size() - 1));
}

TermId TermStore::variable() {
  nodes_.push_back({Kind::kVariable, false, 0, 0});
  return TermId(static_cast<std::uint32_t>(nodes_.size() - 1));
}

TermId TermStore::pair(TermId head, TermId tail) {
  nodes_.push_back({Kind::kPair, false, head.index(), tail.index()});
  return TermId(static_cast<std::uint32_t>(nodes_.size() - 1));
}

TermId TermStore::list(const std::vector<TermId>& items) {
  auto out = nil();
  for (auto item = items.rbegin(); item != items.rend(); ++item) out = pair(*item, out);
  return out;
}

TermId TermStore::from_data(ValueId data, std::map<std::string, TermId>& variables) {
  // A list is built from its end, so its elements wait on a stack; depth is that of the text.
  const auto& value = values_[data];
  if (value.kind == ValueKind::kSymbol && !value.keyword && value.text.starts_with('?')) {
    if (value.text == "?_") return variable();
    const auto found = variables.find(value.text);
    if (found != variables.end()) return found->second;
    return variables.emplace(value.text, variable()).first->second;
  }
  if (value.kind != ValueKind::kCons) return atom(data);
  std::vector<TermId> items;
  auto rest = data;
  while (values_.kind(rest) == ValueKind::kCons) {
    items.push_back(from_data(values_[rest].head, variables));
    rest = values_[rest].tail;
  }
  auto out = from_data(rest, variables);
  for (auto item = items.rbegin(); item != items.rend(); ++item) out = pair(*item, out);
  return out;
}

TermId TermStore::walk(TermId term) const {
  for (;;) {
    ++work_;
    const auto& node = nodes_[term.index()];
    if (node.kind != Kind::kVariable || !node.bound) return term;
    term = TermId(node.first);
  }
}

std::optional<ValueId> TermStore::atom_value(TermId term) const {
  const auto& node = nodes_[walk(term).index()];
  if (node.kind != Kind::kAtom) return std::nullopt;
  return ValueId(node.first);
}

std::optional<std::pair<TermId, TermId>> TermStore::split(TermId term) {
  const auto node = nodes_[walk(term).index()];
  if (node.kind == Kind::kPair) return std::pair(TermId(node.first), TermId(node.second));
  if (node.kind != Kind::kAtom) return std::nullopt;
  const auto& value = values_[ValueId(node.first)];
  if (value.kind != ValueKind::kCons) return std::nullopt;
  const auto head = atom(value.head);
  return std::pair(head, atom(value.tail));
}

bool TermStore::is_nil(TermId term) const {
  const auto value = atom_value(term);
  return value && values_.is_nil(*value);
}

std::optional<std::vector<TermId>> TermStore::elements(TermId term) {
  std::vector<TermId> out;
  auto rest = term;
  while (const auto parts = split(rest)) {
    out.push_back(parts->first);
    rest = parts->second;
  }
  if (!is_nil(rest)) return std::nullopt;
  return out;
}

std::optional<std::string> TermStore::symbol(TermId term) const {
  const auto value = atom_value(term);
  if (!value || values_.kind(*value) != ValueKind::kSymbol) return std::nullopt;
  return values_[*value].text;
}

bool TermStore::occurs(TermId variable, TermId term) const {
  std::vector<TermId> open = {term};
  while (!open.empty() && ++work_ <= kMaxWork) {
    const auto here = walk(open.back());
    open.pop_back();
    if (here == variable) return true;
    const auto& node = nodes_[here.index()];
    if (node.kind != Kind::kPair) continue;
    open.emplace_back(node.first);
    open.emplace_back(node.second);
  }
  return false;
}

bool TermStore::unify(TermId left, TermId right) {
  std::vector<std::pair<TermId, TermId>> open = {{left, right}};
  while (!open.empty()) {
    if (++work_ > kMaxWork) return false;
    auto [a, b] = open.back();
    open.pop_back();
    a = walk(a), b = walk(b);
    if (a == b) continue;
    if (nodes_[a.index()].kind != Kind::kVariable) std::swap(a, b);
    if (nodes_[a.index()].kind == Kind::kVariable) {
      if (occurs(a, b)) return false;
      nodes_[a.index()].bound = true;
      nodes_[a.index()].first = b.index();
      trail_.push_back(a.index());
      continue;
    }
    const auto x = atom_value(a), y = atom_value(b);
    if (x && y) {
      if (!values_.equal(*x, *y)) return false;
      continue;
    }
    const auto parts = split(a), others = split(b);
    if (!parts || !others) return false;
    open.emplace_back(parts->second, others->second);
    open.emplace_back(parts->first, others->first);
  }
  return true;
}

void TermStore::undo(std::size_t mark) {
  while (trail_.size() > mark) {
    nodes_[trail_.back()].bound = false;
    trail_.pop_back();
  }
}

std::optional<ValueId> TermStore::value(TermId term) {
  // Parts first: a pair that is met again finds the values of its parts on top.
  std::vector<std::pair<TermId, bool>> open = {{term, false}};
  std::vector<ValueId> done;
  while (!open.empty()) {
    const auto [next, parts_done] = open.back();
    open.pop_back();
    if (parts_done) {
      const auto tail = done.back();
      done.pop_back();
      done.back() = values_.cons(done.back(), tail);
      continue;
    }
    const auto here = walk(next);
    const auto node = nodes_[here.index()];
    if (node.kind == Kind::kVariable || values_.full() || ++work_ > kMaxWork) return std::nullopt;
    if (node.kind == Kind::kAtom) {
      done.emplace_back(node.first);
      continue;
    }
    open.emplace_back(here, true);
    open.emplace_back(TermId(node.second), false);
    open.emplace_back(TermId(node.first), false);
  }
  return done.back();
}

TermId TermStore::copy(TermId term) {
  if (const auto whole = value(term)) return atom(*whole);
  std::map<std::uint32_t, TermId> renamed;
  std::vector<std::pair<TermId, bool>> open = {{term, false}};
  std::vector<TermId> done;
  while (!open.empty()) {
    if (++work_ > kMaxWork) return term;
    const auto [next, parts_done] = open.back();
    open.pop_back();
    if (parts_done) {
      const auto tail = done.back();
      done.pop_back();
      done.back() = pair(done.back(), tail);
      continue;
    }
    const auto here = walk(next);
    const auto node = nodes_[here.index()];
    if (node.kind == Kind::kAtom) {
      done.push_back(here);
    } else if (node.kind == Kind::kVariable) {
      const auto known = renamed.find(here.index());
      done.push_back(known != renamed.end()
                         ? known->second
                         : renamed.emplace(here.index(), variable()).first->second);
    } else {
      open.emplace_back(here, true);
      open.emplace_back(TermId(node.second), false);
      open.emplace_back(TermId(node.first), false);
    }
  }
  return done.back();
}

}  // namespace parallax::compiler
