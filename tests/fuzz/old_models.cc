#include "tests/fuzz/old_models.h"

#include <algorithm>
#include <map>
#include <utility>

namespace parallax::test {
namespace {

using Kind = OldTree::Kind;

constexpr std::size_t kMaxSteps = 3'000'000;

/// A formula over numbers of atoms.
struct Compact {
  Kind kind = Kind::kTrue;
  std::size_t atom = 0;
  std::vector<Compact> parts;
};

enum class Truth : std::uint8_t { kFalse, kTrue, kOpen };

Truth opposite(Truth value) {
  if (value == Truth::kOpen) return value;
  return value == Truth::kTrue ? Truth::kFalse : Truth::kTrue;
}

class Search {
 public:
  Search(const std::vector<OldTree>& formulas, std::size_t horizon, std::size_t limit)
      : horizon_(horizon), limit_(limit) {
    std::vector<std::string> atoms;
    for (const auto& formula : formulas) {
      for (auto& atom : atoms_in(formula)) {
        if (numbers_.emplace(atom, 0).second) atoms.push_back(std::move(atom));
      }
    }
    // By timepoint, so that the consequences of a state are known soon.
    const auto time = [](const std::string& atom) {
      return atom[0] == 'p' ? std::int64_t{1'000'000} : std::int64_t{std::stol(atom.substr(2))};
    };
    std::stable_sort(atoms.begin(), atoms.end(), [&](const std::string& a, const std::string& b) {
      return std::pair(time(a), a) < std::pair(time(b), b);
    });
    for (std::size_t i = 0; i < atoms.size(); ++i) numbers_[atoms[i]] = i;
    names_ = std::move(atoms);
    values_.assign(names_.size(), Truth::kOpen);
    by_atom_.resize(names_.size());
    for (const auto& formula : formulas) {
      compact_.push_back(compact(formula));
      for (const auto& atom : atoms_in(formula)) {
        by_atom_[numbers_.at(atom)].push_back(compact_.size() - 1);
      }
    }
  }

  OldAnswer run() {
    OldAnswer answer;
    answer.found.complete = extend(0);
    answer.found.traces = std::move(found_);
    if (steps_ > kMaxSteps) answer.beyond = "too many assignments to try";
    return answer;
  }

 private:
  Compact compact(const OldTree& tree) const {
    Compact made{tree.kind, 0, {}};
    if (tree.is(Kind::kAtom)) made.atom = numbers_.at(tree.atom);
    for (const auto& part : tree.parts) made.parts.push_back(compact(part));
    return made;
  }

  Truth value(const Compact& formula) const {
    switch (formula.kind) {
      case Kind::kTrue:
        return Truth::kTrue;
      case Kind::kFalse:
        return Truth::kFalse;
      case Kind::kAtom:
        return values_[formula.atom];
      case Kind::kNot:
        return opposite(value(formula.parts[0]));
      case Kind::kImplies:
        break;
      case Kind::kAnd:
      case Kind::kOr: {
        const auto decides = formula.kind == Kind::kAnd ? Truth::kFalse : Truth::kTrue;
        auto all = opposite(decides);
        for (const auto& part : formula.parts) {
          const auto own = value(part);
          if (own == decides) return decides;
          if (own == Truth::kOpen) all = own;
        }
        return all;
      }
      case Kind::kEquiv: {
        const auto a = value(formula.parts[0]), b = value(formula.parts[1]);
        if (a == Truth::kOpen || b == Truth::kOpen) return Truth::kOpen;
        return a == b ? Truth::kTrue : Truth::kFalse;
      }
    }
    return Truth::kOpen;
  }

  /// False: ended by a limit.
  bool extend(std::size_t atom) {
    if (atom == names_.size()) {
      if (found_.size() == limit_) return false;
      found_.push_back(valuation());
      return true;
    }
    if (++steps_ > kMaxSteps) return false;
    for (const auto choice : {Truth::kFalse, Truth::kTrue}) {
      values_[atom] = choice;
      const bool possible = std::all_of(
          by_atom_[atom].begin(), by_atom_[atom].end(),
          [&](std::size_t formula) { return value(compact_[formula]) != Truth::kFalse; });
      if (possible && !extend(atom + 1)) return false;
    }
    values_[atom] = Truth::kOpen;
    return true;
  }

  compiler::Valuation valuation() const {
    compiler::Valuation trace;
    trace.holds.resize(horizon_ + 1);
    trace.happens.resize(horizon_ + 1);
    trace.released.resize(horizon_ + 1);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (values_[i] != Truth::kTrue) continue;
      const auto& text = names_[i];
      if (text[0] == 'p') {
        trace.predicates.insert(text.substr(2));
        continue;
      }
      const auto bar = text.find('|', 2);
      const auto t = static_cast<std::size_t>(std::stol(text.substr(2, bar - 2)));
      auto& where = text[0] == 'h' ? trace.holds : text[0] == 'e' ? trace.happens : trace.released;
      where[t].insert(text.substr(bar + 1));
    }
    return trace;
  }

  std::size_t horizon_, limit_;
  std::map<std::string, std::size_t> numbers_;
  std::vector<std::string> names_;
  std::vector<Truth> values_;
  std::vector<Compact> compact_;
  std::vector<std::vector<std::size_t>> by_atom_;
  std::vector<compiler::Valuation> found_;
  std::size_t steps_ = 0;
};

void collect(const OldTree& tree, std::vector<std::string>& found) {
  if (tree.is(Kind::kAtom) && std::find(found.begin(), found.end(), tree.atom) == found.end()) {
    found.push_back(tree.atom);
  }
  for (const auto& part : tree.parts) collect(part, found);
}

}  // namespace

std::string timed_atom(char kind, std::int64_t t, const std::string& name) {
  return std::string(1, kind) + "|" + std::to_string(t) + "|" + name;
}

std::string predicate_atom(const std::string& name) { return "p|" + name; }

std::vector<std::string> atoms_in(const OldTree& formula) {
  std::vector<std::string> found;
  collect(formula, found);
  return found;
}

OldAnswer old_models(const std::vector<OldTree>& formulas, std::size_t horizon, std::size_t limit) {
  return Search(formulas, horizon, limit).run();
}

}  // namespace parallax::test
