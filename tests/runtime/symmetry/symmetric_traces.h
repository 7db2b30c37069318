#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "runtime/graph/model_traces.h"
#include "runtime/trace/trace.h"

namespace parallax::test {

/// The atoms of a trace as words, each with its timepoint: `2:In(T1,P2)`. Of everything that
/// exchanging constants is about nothing but the texts is used here.
using TraceWords = std::set<std::string>;

inline TraceWords words_of(const runtime::Trace& trace, bool all_atoms = false) {
  TraceWords words;
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    const auto add = [&](const char* kind, const auto& names) {
      for (const auto name : names) words.insert(std::to_string(t) + kind + std::string(name));
    };
    add(":", trace.holds(t));
    add(">", trace.happens(t));
    if (all_atoms) add("~", trace.released(t));
  }
  if (all_atoms) words.insert(trace.predicates.begin(), trace.predicates.end());
  return words;
}

/// Every constant replaced by another, word by word.
inline TraceWords renamed(const TraceWords& words, const std::map<std::string, std::string>& to) {
  TraceWords out;
  for (const auto& word : words) {
    std::string text, name;
    for (const char c : word + '\n') {
      if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
        name += c;
        continue;
      }
      const auto found = to.find(name);
      text += found == to.end() ? name : found->second;
      name.clear();
      if (c != '\n') text += c;
    }
    out.insert(text);
  }
  return out;
}

/// All ways to permute the constants within their sets.
inline std::vector<std::map<std::string, std::string>> permutations(
    const std::vector<std::vector<std::string>>& sets) {
  std::vector<std::map<std::string, std::string>> all = {{}};
  for (const auto& set : sets) {
    auto sorted = set;
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::map<std::string, std::string>> more;
    auto image = sorted;
    do {
      for (auto one : all) {
        for (std::size_t i = 0; i < sorted.size(); ++i) one[sorted[i]] = image[i];
        more.push_back(std::move(one));
      }
    } while (std::next_permutation(image.begin(), image.end()));
    all = std::move(more);
  }
  return all;
}

inline std::set<TraceWords> orbit_of(const TraceWords& words,
                                     const std::vector<std::vector<std::string>>& sets) {
  std::set<TraceWords> orbit;
  for (const auto& to : permutations(sets)) orbit.insert(renamed(words, to));
  return orbit;
}

/// Models with more traces are left out.
inline constexpr std::size_t kMostTraces = 200;

/// Every trace, by blocking clauses alone; one more than kMostTraces where there are more.
inline std::vector<TraceWords> all_traces(const compiler::CompiledModel& model,
                                          bool all_atoms = false) {
  runtime::TraceQuery query;
  query.strategy = runtime::Strategy::kBlocking;
  if (all_atoms) query.distinct = runtime::Distinct::kAll;
  runtime::ModelTraces traces(model, query);
  std::vector<TraceWords> out;
  while (out.size() <= kMostTraces) {
    const auto trace = traces.next();
    if (!trace) break;
    out.push_back(words_of(*trace, all_atoms));
  }
  return out;
}

}  // namespace parallax::test
