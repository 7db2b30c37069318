#pragma once

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace parallax::test {

/// A DRAT checker that can be read in one go: clauses are sets in a list, unit propagation looks at
/// all of them until nothing changes. Binary proofs only. For small proofs; the oracle of the real
/// one.
class NaiveDrat {
 public:
  using Clause = std::vector<long>;  // the first literal is the one to resolve on

  NaiveDrat(std::vector<Clause> formula, long max_variable)
      : clauses_(std::move(formula)), max_variable_(max_variable) {}

  bool accepts(const std::string& proof) {
    std::size_t at = 0;
    bool refuted = closure({}) == std::nullopt;
    while (at < proof.size()) {
      const char kind = proof[at++];
      if (kind != 'a' && kind != 'd') return false;
      const auto clause = read(proof, at);
      if (!clause) return false;
      if (refuted) continue;
      if (kind == 'd') {
        erase(*clause);
        continue;
      }
      if (!follows(*clause)) return false;
      clauses_.push_back(*clause);
      refuted = closure({}) == std::nullopt;
    }
    return refuted;
  }

 private:
  std::optional<Clause> read(const std::string& proof, std::size_t& at) const {
    Clause clause;
    while (true) {
      unsigned long number = 0;
      for (unsigned shift = 0;; shift += 7) {
        if (at == proof.size() || shift > 28) return std::nullopt;
        const auto byte = static_cast<unsigned char>(proof[at++]);
        number += (byte % 128UL) << shift;
        if (byte >= 128) continue;
        if (shift > 0 && byte == 0) return std::nullopt;
        break;
      }
      if (number == 0) return clause;
      const long literal =
          number % 2 == 0 ? static_cast<long>(number / 2) : -static_cast<long>(number / 2);
      if (literal == 0 || std::labs(literal) > max_variable_) return std::nullopt;
      clause.push_back(literal);
    }
  }

  /// The literals that unit propagation makes true; none: a clause became false.
  std::optional<std::set<long>> closure(std::set<long> truths) const {
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& clause : clauses_) {
        std::set<long> open;
        bool satisfied = false;
        for (const auto literal : clause) {
          satisfied = satisfied || truths.count(literal) != 0;
          if (truths.count(-literal) == 0) open.insert(literal);
        }
        if (satisfied) continue;
        if (open.empty()) return std::nullopt;
        if (open.size() > 1) continue;
        changed = true;
        truths.insert(*open.begin());
      }
    }
    return truths;
  }

  bool implied(const Clause& clause) const {
    std::set<long> truths;
    for (const auto literal : clause) truths.insert(-literal);
    for (const auto literal : clause) {
      if (truths.count(literal) != 0) return true;
    }
    return closure(truths) == std::nullopt;
  }

  bool follows(const Clause& clause) const {
    if (implied(clause)) return true;
    if (clause.empty()) return false;
    return std::all_of(clauses_.begin(), clauses_.end(), [&](const Clause& other) {
      if (std::count(other.begin(), other.end(), -clause.front()) == 0) return true;
      Clause resolvent = clause;
      for (const auto literal : other) {
        if (literal != -clause.front()) resolvent.push_back(literal);
      }
      return implied(resolvent);
    });
  }

  /// Removes one clause with these literals, unless it supports a literal.
  void erase(const Clause& clause) {
    const std::set<long> wanted(clause.begin(), clause.end());
    const auto truths = *closure({});
    for (auto it = clauses_.begin(); it != clauses_.end(); ++it) {
      if (std::set<long>(it->begin(), it->end()) != wanted) continue;
      const auto is_true = [&](long literal) { return truths.count(literal) != 0; };
      const auto is_false = [&](long literal) { return truths.count(-literal) != 0; };
      const auto trues = std::count_if(wanted.begin(), wanted.end(), is_true);
      const auto falses = std::count_if(wanted.begin(), wanted.end(), is_false);
      const bool supports = trues == 1 && falses + 1 == static_cast<long>(wanted.size());
      if (!supports) clauses_.erase(it);
      return;
    }
  }

  std::vector<Clause> clauses_;
  long max_variable_;
};

}  // namespace parallax::test
