#include "compiler/compare/fact.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "compiler/base/ascii.h"
#include "compiler/base/shown_text.h"
#include "compiler/base/utf8.h"

namespace parallax::compiler {
namespace {

using Indices = std::vector<std::size_t>;

bool is_word(char c) { return base::is_name_character(c) || static_cast<unsigned char>(c) >= 0x80; }

/// The first of every text that the other list has not.
Indices only_in(std::span<const Fact> facts, std::span<const Fact> others) {
  std::set<std::pair<FactKind, std::string_view>> known;
  for (const auto& fact : others) known.emplace(fact.kind, fact.text);
  Indices out;
  for (std::size_t i = 0; i < facts.size(); ++i) {
    if (known.emplace(facts[i].kind, facts[i].text).second) out.push_back(i);
  }
  return out;
}

/// Twice the number of common words over the number of all (Dice 1945), in thousandths.
std::size_t similarity(const std::vector<std::string_view>& a,
                       const std::vector<std::string_view>& b) {
  std::size_t common = 0;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    if (a[i] == b[j]) {
      ++common;
      ++i;
      ++j;
    } else if (a[i] < b[j]) {
      ++i;
    } else {
      ++j;
    }
  }
  return a.empty() && b.empty() ? 1000 : 2000 * common / (a.size() + b.size());
}

class Matcher {
 public:
  Matcher(std::span<const Fact> old_facts, std::span<const Fact> new_facts)
      : old_(old_facts), new_(new_facts) {
    out_.removed = only_in(old_, new_);
    out_.added = only_in(new_, old_);
  }

  FactDifference run() && {
    match_keys();
    if (out_.removed.size() <= kMaxMatched / std::max<std::size_t>(1, out_.added.size())) {
      match_similar();
    }
    std::sort(out_.changed.begin(), out_.changed.end());
    return std::move(out_);
  }

 private:
  void match(std::size_t removed, std::size_t added) {
    out_.changed.emplace_back(removed, added);
    std::erase(out_.removed, removed);
    std::erase(out_.added, added);
  }

  void match_keys() {
    std::map<std::pair<FactKind, std::string_view>, Indices> by_key;
    for (const auto i : out_.added) {
      if (!new_[i].key.empty()) by_key[{new_[i].kind, new_[i].key}].push_back(i);
    }
    for (const auto i : Indices(out_.removed)) {
      const auto found = by_key.find({old_[i].kind, old_[i].key});
      if (found == by_key.end() || found->second.empty()) continue;
      match(i, found->second.front());
      found->second.erase(found->second.begin());
    }
  }

  void match_similar() {
    const auto words = [](const Fact& fact) {
      auto all = words_of(fact.text);
      // Brackets and commas are everywhere.
      std::erase_if(all, [](std::string_view word) {
        return std::string_view("()[]{},.").find(word) != std::string_view::npos;
      });
      std::sort(all.begin(), all.end());
      return all;
    };
    std::map<std::size_t, std::vector<std::string_view>> of_added;
    for (const auto i : out_.added) of_added[i] = words(new_[i]);
    using Pair = std::tuple<std::size_t, std::size_t, std::size_t>;  // 1000 - similarity, old, new
    std::vector<Pair> pairs;
    for (const auto i : out_.removed) {
      const auto of_removed = words(old_[i]);
      for (const auto j : out_.added) {
        // Declarations are distinguished by the thing that they declare.
        if (old_[i].kind != FactKind::kAxiom || new_[j].kind != FactKind::kAxiom) continue;
        const auto alike = similarity(of_removed, of_added[j]);
        if (alike > 500) pairs.emplace_back(1000 - alike, i, j);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    const auto has = [](const Indices& list, std::size_t i) {
      return std::binary_search(list.begin(), list.end(), i);
    };
    for (const auto& [unlike, i, j] : pairs) {
      if (has(out_.removed, i) && has(out_.added, j)) match(i, j);
    }
  }

  std::span<const Fact> old_, new_;
  FactDifference out_;
};

}  // namespace

std::string to_string(const FactPlace& place) {
  const auto file = base::printable(place.file);
  return place.line == 0 ? file : file + ":" + std::to_string(place.line);
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < text.size();) {
    auto end = i + 1;
    if (is_word(text[i])) {
      while (end < text.size() && is_word(text[end])) ++end;
    }
    if (text[i] != ' ') words.push_back(text.substr(i, end - i));
    i = end;
  }
  return words;
}

std::pair<std::string, std::string> changed_parts(const std::string& old_text,
                                                  const std::string& new_text) {
  constexpr std::size_t kMaxShown = 200, kContext = 40;
  if (old_text.size() <= kMaxShown && new_text.size() <= kMaxShown) return {old_text, new_text};
  const auto shorter = std::min(old_text.size(), new_text.size());
  std::size_t before = 0, behind = 0;
  while (before < shorter && old_text[before] == new_text[before]) ++before;
  while (behind < shorter - before &&
         old_text[old_text.size() - 1 - behind] == new_text[new_text.size() - 1 - behind]) {
    ++behind;
  }
  const auto part = [&](const std::string& text) {
    auto begin = before > kContext ? text.find_last_of(' ', before - kContext) : 0;
    begin = begin == std::string::npos || begin == 0 ? 0 : begin + 1;
    auto end = std::min(text.size() - behind + kContext, text.size());
    end = std::min(text.find(' ', end), text.size());
    end = std::min(end, begin + 2 * kMaxShown);
    while (begin > 0 && base::continues_code_point(text[begin])) --begin;
    while (end < text.size() && base::continues_code_point(text[end])) --end;
    return (begin > 0 ? "... " : "") + text.substr(begin, end - begin) +
           (end < text.size() ? " ..." : "");
  };
  return {part(old_text), part(new_text)};
}

FactDifference compare_facts(std::span<const Fact> old_facts, std::span<const Fact> new_facts) {
  return Matcher(old_facts, new_facts).run();
}

}  // namespace parallax::compiler
