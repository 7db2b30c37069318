#include "compiler/asp/names.h"

#include <algorithm>
#include <array>

#include "compiler/base/ascii.h"

namespace parallax::compiler {
namespace {

/// What the program uses itself, and the one word that clingo keeps.
constexpr std::array<std::string_view, 20> kReserved = {
    "not",        "holds_at", "happens",    "released_at",  "initiates",
    "terminates", "releases", "initiated",  "terminated",   "released",
    "stopped_in", "horizon",  "started_in", "step",         "noninertial",
    "trajectory", "inertial", "free_start", "axiom_exists", "antitrajectory"};

std::string identifier(std::string_view wanted) {
  std::string name;
  for (const char c : wanted) name += base::is_name_character(c) ? c : '_';
  const auto first = name.find_first_not_of('_');
  if (first == std::string::npos || !base::is_letter(name[first])) return "x" + name;
  name[first] = base::to_lower(name[first]);
  return name;
}

}  // namespace

AspNames::AspNames(const TypedModel& model) {
  for (const auto word : kReserved) taken_.emplace(word);
  const auto& core = model.core;
  const std::array<std::pair<std::optional<SymbolId>, std::string_view>, 8> fixed = {
      {{core.holds_at, "holds_at"},
       {core.happens, "happens"},
       {core.released_at, "released_at"},
       {core.initiates, "initiates"},
       {core.terminates, "terminates"},
       {core.releases, "releases"},
       {core.trajectory, "trajectory"},
       {core.anti_trajectory, "antitrajectory"}}};
  for (const auto& sort : model.sorts) sorts_.push_back(fresh(sort.name));
  for (std::size_t i = 0; i < model.symbols.size(); ++i) {
    const auto id = model.symbols.id_at(i);
    const auto known = std::find_if(fixed.begin(), fixed.end(),
                                    [&](const auto& entry) { return entry.first == id; });
    if (known != fixed.end()) {
      symbols_.emplace_back(known->second);
    } else {
      symbols_.push_back(fresh(model.symbols[id].name));
      originals_.emplace(symbols_.back(), model.symbols[id].name + "()");
    }
  }
  for (const auto& object : model.objects) {
    objects_.push_back(fresh(object.name));
    originals_.emplace(objects_.back(), object.name);
  }
}

std::string AspNames::fresh(std::string_view wanted) {
  auto name = identifier(wanted);
  while (!taken_.insert(name).second) name += '_';
  return name;
}

std::string AspNames::original(std::string_view printed) const {
  std::string out;
  for (std::size_t i = 0; i < printed.size();) {
    if (!base::is_name_character(printed[i])) {
      out += printed[i++];
      continue;
    }
    std::size_t end = i;
    while (end < printed.size() && base::is_name_character(printed[end])) ++end;
    const auto word = printed.substr(i, end - i);
    const auto known = originals_.find(word);
    const bool applied = end < printed.size() && printed[end] == '(';
    if (known == originals_.end()) {
      out += word;
    } else {
      const auto& name = known->second;
      out += applied ? name.substr(0, name.find('(')) : name;
    }
    i = end;
  }
  return out;
}

}  // namespace parallax::compiler
