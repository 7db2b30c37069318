#include "compiler/artifact/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "compiler/artifact/clause_runs.h"
#include "compiler/base/ascii.h"
#include "compiler/base/hash.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMaxText = 2000;  // bytes of an axiom that are kept

std::string without_comments(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const auto line = text.substr(0, text.find('\n'));
    out += line.substr(0, line.find(';'));
    out += ' ';
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return out;
}

TextPlace place_of(const base::SourceRange& range, const base::SourceFiles& files) {
  const auto& file = files[range.file];
  return {file.name(), file.position(range.begin), file.position(range.end)};
}

/// Sorts origins by place and renumbers what names them.
void sort_origins(CompiledModel& model) {
  std::vector<std::uint32_t> order(model.origins.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const auto key = [&](std::uint32_t i) {
      const auto& source = model.origins[i].source;
      return std::tuple(source.file.index(), source.begin, source.end,
                        to_string(model.origins[i].kind));
    };
    return key(a) < key(b);
  });
  std::vector<std::uint32_t> renumbered(order.size());
  std::vector<Origin> sorted;
  for (const auto old : order) {
    renumbered[old] = static_cast<std::uint32_t>(sorted.size());
    sorted.push_back(std::move(model.origins[old]));
  }
  model.origins = std::move(sorted);
  for (auto& origin : model.clause_origins) origin = renumbered[origin];
}

}  // namespace

std::string one_line(std::string_view text) {
  std::string out;
  for (const char c : without_comments(text)) {
    if (!base::is_space(c)) {
      out += c;
    } else if (!out.empty() && out.back() != ' ') {
      out += ' ';
    }
  }
  if (out.ends_with(' ')) out.pop_back();
  if (out.size() > kMaxText) out = out.substr(0, kMaxText) + "...";
  return out;
}

void assign_ids(std::vector<Origin>& origins) {
  std::map<std::string, std::uint32_t> used;
  for (auto& origin : origins) {
    auto key = std::string(to_string(origin.kind)) + '\n';
    std::copy_if(origin.text.begin(), origin.text.end(), std::back_inserter(key),
                 [](char c) { return !base::is_space(c); });
    const auto hash = base::fnv1a64(key);
    origin.id = fmt::format("{:08x}", static_cast<std::uint32_t>(hash ^ (hash >> 32U)));
    const auto count = ++used[origin.id];
    if (count > 1) origin.id += fmt::format(".{}", count);
  }
}

void describe_sources(CompiledModel& model, const base::SourceFiles& files) {
  model.sources.clear();
  for (std::uint32_t i = 0; i < files.size(); ++i) {
    const auto& file = files[base::FileId(i)];
    // Texts that were made from a file (a binding's formula with its arguments) bear its name.
    const auto is_same = [&](const SourceText& text) { return text.name == file.name(); };
    if (std::any_of(model.sources.begin(), model.sources.end(), is_same)) continue;
    model.sources.push_back({file.name(), base::fnv1a64(file.text())});
  }
  sort_origins(model);
  for (auto& origin : model.origins) {
    origin.place = place_of(origin.source, files);
    origin.text = one_line(files.text(origin.source));
  }
  assign_ids(model.origins);
  for (auto& step : model.plan) step.place = place_of(step.source, files);
  for (auto& cut : model.plan_cuts) cut.place = place_of(cut.source, files);
}

void sort_clauses(CompiledModel& model) {
  CompiledModel sorted;  // only the clauses of it
  std::vector<std::size_t> order;
  for (const auto& section : model.sections) {
    order.resize(section.copies == 0 ? 0 : section.clauses);
    std::iota(order.begin(), order.end(), section.begin);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      const auto key = [&](std::size_t i) {
        return std::tuple(model.clause_origins[i], model.clause_timepoints[i],
                          bool{model.clause_is_definition[i]});
      };
      if (key(a) != key(b)) return key(a) < key(b);
      const auto first = model.clauses[a], second = model.clauses[b];
      return std::lexicographical_compare(
          first.begin(), first.end(), second.begin(), second.end(), [](Literal x, Literal y) {
            return std::pair(x.var(), x.dimacs()) < std::pair(y.var(), y.dimacs());
          });
    });
    for (std::int64_t copy = 0; copy < model.stored_copies(section); ++copy) {
      for (auto i : order) {
        i += section.clauses * static_cast<std::size_t>(copy);
        sorted.clauses.add(model.clauses[i]);
        sorted.clause_timepoints.push_back(model.clause_timepoints[i]);
        sorted.clause_origins.push_back(model.clause_origins[i]);
        sorted.clause_is_definition.push_back(model.clause_is_definition[i]);
      }
    }
  }
  model.clauses = std::move(sorted.clauses);
  model.clause_timepoints = std::move(sorted.clause_timepoints);
  model.clause_origins = std::move(sorted.clause_origins);
  model.clause_is_definition = std::move(sorted.clause_is_definition);
}

}  // namespace parallax::compiler
