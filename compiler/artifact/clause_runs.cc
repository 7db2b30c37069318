#include "compiler/artifact/clause_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>

namespace parallax::compiler {
namespace {

/// Adds the group that is complete, as a repetition if it equals the one before.
void close(ClauseGroup& open, std::vector<ClauseGroup>& groups) {
  if (open.size() == 0) return;
  if (!groups.empty() && groups.back().plain == open.plain &&
      groups.back().definitions == open.definitions) {
    ++groups.back().repeat;
  } else {
    groups.push_back(open);
  }
  open = {};
}

}  // namespace

Timepoint derived_timepoint(const CompiledModel& model, std::span<const Literal> clause) {
  Timepoint needed = 0;
  const auto base = model.base();
  for (const auto literal : clause) {
    const auto v = literal.var();
    if (v <= base) {
      const auto& atom = model.fixed[static_cast<std::size_t>(v) - 1];
      needed = std::max(needed, std::min(needed_horizon(atom), model.horizon));
      continue;
    }
    const auto place = v - base - 1;
    const auto slot = static_cast<std::uint32_t>(place % model.stride());
    const auto time = place / model.stride();
    needed = std::max(needed, slot < model.state_slots ? time : time + 1);
  }
  return needed;
}

Timepoint usual_timepoint(const CompiledModel& model, const Section& section,
                          std::span<const Literal> clause) {
  return section.repeated ? section.width : derived_timepoint(model, clause);
}

Occurrences occurrences(const CompiledModel& model) {
  Occurrences found{std::vector<bool>(model.fixed.size()), std::vector<bool>(model.slots.size())};
  const auto base = model.base();
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    for (const auto literal : model.clauses[i]) {
      const auto v = literal.var();
      if (v <= base) {
        found.fixed[static_cast<std::size_t>(v) - 1] = true;
      } else {
        found.slots[static_cast<std::size_t>((v - base - 1) % model.stride())] = true;
      }
    }
  }
  return found;
}

void for_each_observable(const CompiledModel& model,
                         const std::function<void(std::int32_t)>& visit) {
  std::set<std::string_view> events;
  std::vector<std::uint32_t> slots;
  for (const auto& fluent : model.fluents) {
    if (fluent.slot) slots.push_back(*fluent.slot);
  }
  for (const auto& event : model.events) {
    events.insert(event.name);
    if (event.slot) slots.push_back(*event.slot);
  }
  std::sort(slots.begin(), slots.end());
  for (std::size_t i = 0; i < model.fixed.size(); ++i) {
    const auto& atom = model.fixed[i];
    const bool observable = atom.kind == AtomKind::kHoldsAt ||
                            (atom.kind == AtomKind::kHappens && events.contains(atom.name));
    if (observable) visit(static_cast<std::int32_t>(i) + 1);
  }
  for (Timepoint t = 0; t <= model.horizon; ++t) {
    for (const auto slot : slots) {
      if (t < model.horizon || slot < model.state_slots) visit(model.variable(slot, t));
    }
  }
}

bool is_shifted(const CompiledModel& model, std::span<const Literal> first,
                std::span<const Literal> later, std::int64_t steps) {
  const auto moved = [&](Literal a, Literal b) {
    const std::int64_t by = a.var() <= model.base() ? 0 : steps * model.stride();
    return a.is_positive() == b.is_positive() && a.var() + by == b.var();
  };
  return std::equal(first.begin(), first.end(), later.begin(), later.end(), moved);
}

std::vector<ClauseRun> clause_runs(const CompiledModel& model, const Section& section) {
  std::vector<ClauseRun> runs;
  ClauseGroup open;
  for (std::size_t i = section.begin; i < section.begin + section.clauses; ++i) {
    std::optional<Timepoint> stated = model.clause_timepoints[i];
    if (*stated == usual_timepoint(model, section, model.clauses[i])) stated.reset();
    const auto origin = model.clause_origins[i];
    if (runs.empty() || runs.back().origin != origin || runs.back().timepoint != stated) {
      if (!runs.empty()) close(open, runs.back().groups);
      runs.push_back({origin, stated, {}});
    }
    if (model.clause_is_definition[i]) {
      ++open.definitions;
      continue;
    }
    if (open.definitions > 0) close(open, runs.back().groups);
    ++open.plain;
  }
  if (!runs.empty()) close(open, runs.back().groups);
  return runs;
}

void append_counts(const std::vector<ClauseGroup>& groups, std::string& out) {
  char separator = ' ';
  for (const auto& group : groups) {
    fmt::format_to(std::back_inserter(out), "{}{}", separator, group.plain);
    if (group.definitions > 0) fmt::format_to(std::back_inserter(out), "+{}", group.definitions);
    if (group.repeat > 1) fmt::format_to(std::back_inserter(out), "x{}", group.repeat);
    separator = ',';
  }
}

bool read_counts(ArtifactCursor& cursor, std::vector<ClauseGroup>& groups) {
  constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();
  auto rest = cursor.raw_word();
  if (rest.empty()) return cursor.expected("numbers of clauses");
  for (bool more = true; more;) {
    const auto comma = rest.find(',');
    auto text = rest.substr(0, comma);
    more = comma != std::string_view::npos;
    rest = more ? rest.substr(comma + 1) : std::string_view();
    std::int64_t plain = 0, definitions = 0, repeat = 1;
    if (const auto at = text.find('x'); at != std::string_view::npos) {
      if (!cursor.parse_number(text.substr(at + 1), "a repetition", 1, kMost, repeat)) return false;
      text = text.substr(0, at);
    }
    if (const auto at = text.find('+'); at != std::string_view::npos) {
      if (!cursor.parse_number(text.substr(at + 1), "a number of clauses", 1, kMost, definitions)) {
        return false;
      }
      text = text.substr(0, at);
    }
    if (!cursor.parse_number(text, "a number of clauses", definitions > 0 ? 0 : 1, kMost, plain)) {
      return false;
    }
    groups.push_back({static_cast<std::uint32_t>(plain), static_cast<std::uint32_t>(definitions),
                      static_cast<std::uint32_t>(repeat)});
  }
  return true;
}

}  // namespace parallax::compiler
