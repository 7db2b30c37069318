#include "compiler/interpreter/prolog_terms.h"

namespace parallax::compiler {

PrologTermId TermStore::atom(ValueId value) {
  nodes_.push_back({Kind::kAtom, false, value.index(), 0});
  return PrologTermId(static_cast<std::uint32_t>(nodes_.size() - 1));
}

PrologTermId TermStore::variable() {
  nodes_.push_back({Kind::kVariable, false, 0, 0});
  return PrologTermId(static_cast<std::uint32_t>(nodes_.size() - 1));
}

PrologTermId TermStore::pair(PrologTermId head, PrologTermId tail) {
  nodes_.push_back({Kind::kPair, false, head.index(), tail.index()});
  return PrologTermId(static_cast<std::uint32_t>(nodes_.size() - 1));
}

PrologTermId TermStore::list(const std::vector<PrologTermId>& items) {
  auto out = nil();
  for (auto item = items.rbegin(); item != items.rend(); ++item) out = pair(*item, out);
  return out;
}

PrologTermId TermStore::from_data(ValueId data, std::map<std::string, PrologTermId>& variables) {
  // A list is built from its end, so its elements wait on a stack; depth is that of the text.
  const auto& value = values_[data];
  if (value.kind == ValueKind::kSymbol && !value.keyword && value.text.starts_with('?')) {
    if (value.text == "?_") return variable();
    const auto found = variables.find(value.text);
    if (found != variables.end()) return found->second;
    return variables.emplace(value.text, variable()).first->second;
  }
  if (value.kind != ValueKind::kCons) return atom(data);
  std::vector<PrologTermId> items;
  auto rest = data;
  while (values_.kind(rest) == ValueKind::kCons) {
    items.push_back(from_data(values_[rest].head, variables));
    rest = values_[rest].tail;
  }
  auto out = from_data(rest, variables);
  for (auto item = items.rbegin(); item != items.rend(); ++item) out = pair(*item, out);
  return out;
}

PrologTermId TermStore::walk(PrologTermId term) const {
  for (;;) {
    ++work_;
    const auto& node = nodes_[term.index()];
    if (node.kind != Kind::kVariable || !node.bound) return term;
    term = PrologTermId(node.first);
  }
}

std::optional<ValueId> TermStore::atom_value(PrologTermId term) const {
  const auto& node = nodes_[walk(term).index()];
  if (node.kind != Kind::kAtom) return std::nullopt;
  return ValueId(node.first);
}

std::optional<std::pair<PrologTermId, PrologTermId>> TermStore::split(PrologTermId term) {
  const auto node = nodes_[walk(term).index()];
  if (node.kind == Kind::kPair)
    return std::pair(PrologTermId(node.first), PrologTermId(node.second));
  if (node.kind != Kind::kAtom) return std::nullopt;
  const auto& value = values_[ValueId(node.first)];
  if (value.kind != ValueKind::kCons) return std::nullopt;
  const auto head = atom(value.head);
  return std::pair(head, atom(value.tail));
}

bool TermStore::is_nil(PrologTermId term) const {
  const auto value = atom_value(term);
  return value && values_.is_nil(*value);
}

std::optional<std::vector<PrologTermId>> TermStore::elements(PrologTermId term) {
  std::vector<PrologTermId> out;
  auto rest = term;
  while (const auto parts = split(rest)) {
    out.push_back(parts->first);
    rest = parts->second;
  }
  if (!is_nil(rest)) return std::nullopt;
  return out;
}

std::optional<std::string> TermStore::symbol(PrologTermId term) const {
  const auto value = atom_value(term);
  if (!value || values_.kind(*value) != ValueKind::kSymbol) return std::nullopt;
  return values_[*value].text;
}

bool TermStore::occurs(PrologTermId variable, PrologTermId term) const {
  std::vector<PrologTermId> open = {term};
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

bool TermStore::unify(PrologTermId left, PrologTermId right) {
  std::vector<std::pair<PrologTermId, PrologTermId>> open = {{left, right}};
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

std::optional<ValueId> TermStore::value(PrologTermId term) {
  // Parts first: a pair that is met again finds the values of its parts on top.
  std::vector<std::pair<PrologTermId, bool>> open = {{term, false}};
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
    open.emplace_back(PrologTermId(node.second), false);
    open.emplace_back(PrologTermId(node.first), false);
  }
  return done.back();
}

PrologTermId TermStore::copy(PrologTermId term) {
  if (const auto whole = value(term)) return atom(*whole);
  std::map<std::uint32_t, PrologTermId> renamed;
  std::vector<std::pair<PrologTermId, bool>> open = {{term, false}};
  std::vector<PrologTermId> done;
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
      open.emplace_back(PrologTermId(node.second), false);
      open.emplace_back(PrologTermId(node.first), false);
    }
  }
  return done.back();
}

}  // namespace parallax::compiler
