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

/// The orbit of the words under the symmetries: exchanges of any two constants of a set, and the
/// cycles of constants that are replaced together.
inline std::set<TraceWords> orbit_of(const TraceWords& words,
                                     const runtime::Interchangeables& constants) {
  std::vector<std::map<std::string, std::string>> replacements;
  for (const auto& set : constants.sets) {
    for (std::size_t i = 1; i < set.size(); ++i) {
      replacements.push_back({{set[i], set[i - 1]}, {set[i - 1], set[i]}});
    }
  }
  for (const auto& cycles : constants.together) {
    auto& to = replacements.emplace_back();
    for (const auto& cycle : cycles) {
      for (std::size_t i = 0; i < cycle.size(); ++i) to[cycle[i]] = cycle[(i + 1) % cycle.size()];
    }
  }
  std::set<TraceWords> orbit = {words};
  std::vector<TraceWords> open = {words};
  while (!open.empty()) {
    const auto one = std::move(open.back());
    open.pop_back();
    for (const auto& to : replacements) {
      auto next = renamed(one, to);
      if (orbit.insert(next).second) open.push_back(std::move(next));
    }
  }
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
