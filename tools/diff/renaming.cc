// Names that changed, found by how they are used.
//
// A name is a word of the canonical facts and of the settings. For each name that one side alone
// has, its uses are collected: every text that has it, with a mark in its place and another one in
// the place of all other names that this side alone has. Two names are the same thing renamed if
// more than half of their uses are equal. Cost: the texts times the names of one side alone, and a
// comparison of uses for each pair of them.

#include "tools/diff/renaming.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <set>

#include "compiler/base/ascii.h"
#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kMostNames = 64;  // that one side alone has
constexpr std::size_t kLeastUses = 2;   // a name that is only declared says too little
constexpr double kAlike = 0.5;

using Replace = std::function<std::string_view(std::string_view word)>;

bool begins_name(char c) { return base::is_name_character(c) && !base::is_digit(c); }

/// The text with every word replaced.
std::string replaced(std::string_view text, const Replace& replace) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    auto end = at;
    while (end < text.size() && base::is_name_character(text[end])) ++end;
    if (end == at) {
      out += text[at++];
      continue;
    }
    const auto word = text.substr(at, end - at);
    out += begins_name(word.front()) ? replace(word) : word;
    at = end;
  }
  return out;
}

/// Calls `take` with each text that says something: facts, and settings with their paths.
void for_each_text(const ModelRevision& side, const std::function<void(const std::string&)>& take) {
  for (const auto& fact : side.facts) take(fact.text);
  if (!side.settings) return;
  for (const auto& setting : side.settings->all) {
    if (setting.given) take(harness::path_text(setting.path) + " = " + setting.value);
  }
}

std::set<std::string> names_of(const ModelRevision& side) {
  std::set<std::string> out;
  for_each_text(side, [&](const std::string& text) {
    (void)replaced(text, [&](std::string_view word) {
      out.emplace(word);
      return word;
    });
  });
  return out;
}

/// Sorted texts by name.
using Uses = std::map<std::string, std::vector<std::string>>;

Uses uses_of(const ModelRevision& side, const std::set<std::string>& names) {
  Uses out;
  for_each_text(side, [&](const std::string& text) {
    std::set<std::string> here;
    (void)replaced(text, [&](std::string_view word) {
      if (names.contains(std::string(word))) here.emplace(word);
      return word;
    });
    for (const auto& name : here) {
      out[name].push_back(replaced(text, [&](std::string_view word) -> std::string_view {
        if (word == name) return "$";
        return here.contains(std::string(word)) ? "?" : word;
      }));
    }
  });
  for (auto& [name, texts] : out) std::sort(texts.begin(), texts.end());
  return out;
}

double likeness(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  std::vector<std::string> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return static_cast<double>(both.size()) / static_cast<double>(std::max(a.size(), b.size()));
}

std::set<std::string> names_without(const std::set<std::string>& from,
                                    const std::set<std::string>& what) {
  std::set<std::string> out;
  std::set_difference(from.begin(), from.end(), what.begin(), what.end(),
                      std::inserter(out, out.end()));
  return out;
}

/// The digits behind `name` in `longer`; empty: it is another name.
std::string_view number_behind(std::string_view name, std::string_view longer) {
  if (!longer.starts_with(name) || longer.size() == name.size()) return {};
  const auto rest = longer.substr(name.size());
  return std::all_of(rest.begin(), rest.end(), base::is_digit) ? rest : std::string_view();
}

/// Are both numbered in the same way after two names that are one?
bool is_numbered_after(const Renaming& sort, const std::string& before, const std::string& after) {
  const auto number = number_behind(sort.before, before);
  return !number.empty() && number == number_behind(sort.after, after);
}

std::vector<Renaming> told_ones(const std::vector<Renaming>& renamings) {
  std::vector<Renaming> out;
  for (const auto& one : renamings) {
    if (!one.is_variable) out.push_back(one);
  }
  return out;
}

}  // namespace

std::optional<Renaming> parse_renaming(std::string_view text) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  const auto is_name = [](std::string_view name) {
    return !name.empty() && begins_name(name.front()) &&
           std::all_of(name.begin(), name.end(), base::is_name_character);
  };
  const auto before = text.substr(0, equals), after = text.substr(equals + 1);
  if (!is_name(before) || !is_name(after)) return std::nullopt;
  return Renaming{std::string(before), std::string(after), false};
}

std::vector<Renaming> find_renamings(const ModelRevision& old_side, const ModelRevision& new_side) {
  const auto old_names = names_of(old_side), new_names = names_of(new_side);
  const auto gone = names_without(old_names, new_names), came = names_without(new_names, old_names);
  if (gone.size() > kMostNames || came.size() > kMostNames) return {};
  const auto old_uses = uses_of(old_side, gone), new_uses = uses_of(new_side, came);
  struct Pair {
    double likeness = 0.0;
    std::string before, after;
  };
  std::vector<Pair> pairs;
  for (const auto& [before, a] : old_uses) {
    for (const auto& [after, b] : new_uses) {
      if (std::min(a.size(), b.size()) < kLeastUses) continue;
      const double alike = likeness(a, b);
      if (alike > kAlike) pairs.push_back({alike, before, after});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.likeness > b.likeness; });
  std::vector<Renaming> out;
  std::set<std::string> taken_before, taken_after;
  for (const auto& pair : pairs) {
    if (taken_before.contains(pair.before) || taken_after.contains(pair.after)) continue;
    taken_before.insert(pair.before);
    taken_after.insert(pair.after);
    out.push_back({pair.before, pair.after, false});
  }
  const auto is_variable = [all = out](const Renaming& one) {
    return std::any_of(all.begin(), all.end(), [&](const Renaming& sort) {
      return is_numbered_after(sort, one.before, one.after);
    });
  };
  std::erase_if(out, is_variable);
  return with_variables(std::move(out), old_side, new_side);
}

std::vector<Renaming> with_variables(std::vector<Renaming> renamings, const ModelRevision& old_side,
                                     const ModelRevision& new_side) {
  const auto old_names = names_of(old_side), new_names = names_of(new_side);
  const auto gone = names_without(old_names, new_names);
  const auto came = names_without(new_names, old_names);
  const auto sorts = renamings;
  for (const auto& sort : sorts) {
    for (const auto& name : gone) {
      const auto number = number_behind(sort.before, name);
      const auto after = sort.after + std::string(number);
      if (!number.empty() && came.contains(after)) renamings.push_back({name, after, true});
    }
  }
  return renamings;
}

bool has_name(const ModelRevision& side, const std::string& name) {
  return names_of(side).contains(name);
}

void rename(ModelRevision& side, const std::vector<Renaming>& renamings) {
  std::map<std::string, std::string, std::less<>> names;
  for (const auto& one : renamings) names.emplace(one.before, one.after);
  const auto apply = [&](std::string& text) {
    text = replaced(text, [&](std::string_view word) -> std::string_view {
      const auto at = names.find(word);
      return at == names.end() ? word : std::string_view(at->second);
    });
  };
  for (auto& fact : side.facts) {
    for (auto* text : {&fact.key, &fact.text, &fact.shown}) apply(*text);
    for (auto& name : fact.sequence) apply(name);
  }
  if (side.settings) {
    auto& all = side.settings->all;
    for (auto& setting : all) {
      for (auto& key : setting.path) apply(key);
      apply(setting.value);
    }
    std::stable_sort(
        all.begin(), all.end(),
        [](const harness::Setting& a, const harness::Setting& b) { return a.path < b.path; });
  }
  if (!side.compiled) return;
  for (auto& fluent : side.compiled->fluents) apply(fluent.name);
  for (auto& event : side.compiled->events) apply(event.name);
  for (auto& slot : side.compiled->slots) apply(slot.name);
  for (auto& atom : side.compiled->fixed) apply(atom.name);
}

std::string renamings_text(const std::vector<Renaming>& renamings, bool stat) {
  const auto told = told_ones(renamings);
  if (told.empty()) return {};
  auto out = fmt::format("names: {} renamed\n", told.size());
  if (stat) return out;
  for (const auto& one : told) {
    out += fmt::format("  ~ {} -> {}\n", base::printable(one.before), base::printable(one.after));
  }
  return out;
}

std::string renamings_json(const std::vector<Renaming>& renamings) {
  auto out = nlohmann::ordered_json::array();
  for (const auto& one : told_ones(renamings))
    out.push_back({{"old", one.before}, {"new", one.after}});
  return base::json_text(out);
}

}  // namespace parallax::tools
