#include <cstdint>
#include <utility>
#include <vector>

#include "compiler/base/whole_number.h"
#include "tools/bench/families/families.h"
#include "tools/bench/families/tuned.h"

namespace parallax::tools {
namespace {

using Parameters = std::vector<int>;

struct Family {
  std::string_view name;
  std::size_t parameters = 0;
  std::size_t may_be_negative = 0;  // number of last parameters
  bool (*fits)(const Parameters&) = nullptr;
  std::string (*model)(const Parameters&) = nullptr;
  std::string (*program)(const Parameters&) = nullptr;
  FamilyTask (*task)(const Parameters&) = nullptr;  // if it has a goal that can be left out
};

using P = const Parameters&;

bool any(P) { return true; }

BankSize bank(P p) { return {p[0], p[1], p[2], p[3]}; }

/// Else there is nobody to pay, or every share is zero.
bool has_transfers(P p) { return p[0] >= 2 && p[1] >= p[0]; }

bool has_steps(P p) {
  const std::int64_t horizon = p[1] * (std::int64_t{p[0]} + 1) + p[2];
  return p[0] >= 2 && horizon >= 1 && horizon <= kMaxFamilyParameter;
}

/// One for each robot.
bool has_cells(P p) { return p[0] <= 1000 && p[1] <= p[0] * p[0]; }

const Family kFamilies[] = {
    {"lamps", 2, 0, any, [](P p) { return lamps_model(p[0], p[1]); },
     [](P p) { return tuned_lamps(p[0], p[1]); }},
    {"distant", 2, 0, [](P p) { return p[1] >= 3; }, [](P p) { return distant_model(p[0], p[1]); },
     [](P p) { return tuned_distant(p[0], p[1]); }},
    {"robot", 3, 1, has_steps, [](P p) { return robot_model(p[0], p[1], p[2]); },
     [](P p) { return tuned_robot(p[0], p[1], p[2]); }},
    {"roaming", 3, 0, [](P p) { return p[0] >= 2; },
     [](P p) { return roaming_model(p[0], p[1], p[2]); },
     [](P p) { return tuned_roaming(p[0], p[1], p[2]); }},
    {"pigeon", 2, 0, any, [](P p) { return pigeon_model(p[0], p[1]); },
     [](P p) { return tuned_pigeon(p[0], p[1]); }},
    {"ringed", 2, 0, any, [](P p) { return ringed_model(p[0], p[1]); },
     [](P p) { return tuned_ringed(p[0], p[1]); }},
    {"chain", 1, 0, [](P p) { return p[0] >= 2; }, [](P p) { return chain_model(p[0]); },
     [](P p) { return tuned_chain(p[0]); }},
    {"bankproj", 4, 0, has_transfers, [](P p) { return bank_projection_model(bank(p)); },
     [](P p) { return tuned_bank_projection(bank(p)); }},
    {"bankplan", 4, 0, has_transfers, [](P p) { return bank_planning_model(bank(p)); },
     [](P p) { return tuned_bank_planning(bank(p)); }},
    {"falling", 1, 0, [](P p) { return p[0] >= 3; }, [](P p) { return falling_model(p[0]); },
     [](P p) { return tuned_falling(p[0]); }},
    {"grid", 3, 0, has_cells, [](P p) { return grid_task(p[0], p[1], p[2]).model; },
     [](P p) { return tuned_grid(p[0], p[1], p[2]); },
     [](P p) { return grid_task(p[0], p[1], p[2]); }},
    {"hanoi", 2, 0, any, [](P p) { return hanoi_task(p[0], p[1]).model; },
     [](P p) { return tuned_hanoi(p[0], p[1]); }, [](P p) { return hanoi_task(p[0], p[1]); }},
    {"logistics", 4, 0, [](P p) { return p[2] >= 2; },
     [](P p) { return logistics_task(p[0], p[1], p[2], p[3]).model; },
     [](P p) { return tuned_logistics(p[0], p[1], p[2], p[3]); },
     [](P p) { return logistics_task(p[0], p[1], p[2], p[3]); }},
};

/// `7`, or `m1` for -1 (a name that is also a file name).
std::optional<int> parameter(std::string_view word) {
  const bool negative = word.starts_with('m');
  if (negative) word.remove_prefix(1);
  const auto value = base::whole_number<int>(word);
  if (!value || *value < 0 || *value > kMaxFamilyParameter) return std::nullopt;
  return negative ? -*value : *value;
}

/// `robot`, `4`, `2`, `8`.
std::vector<std::string_view> words_of(std::string_view name) {
  std::vector<std::string_view> words;
  while (true) {
    const auto end = name.find('_');
    words.push_back(name.substr(0, end));
    if (end == std::string_view::npos) return words;
    name.remove_prefix(end + 1);
  }
}

/// The family of a name and its parameters, if they fit.
std::optional<std::pair<const Family*, Parameters>> parsed(std::string_view name) {
  const auto words = words_of(name);
  for (const auto& family : kFamilies) {
    if (family.name != words.front() || family.parameters + 1 != words.size()) continue;
    Parameters parameters;
    for (std::size_t i = 1; i < words.size(); ++i) {
      const auto value = parameter(words[i]);
      const bool any_sign = i + family.may_be_negative >= words.size();
      if (!value || (!any_sign && *value < 1)) return std::nullopt;
      parameters.push_back(*value);
    }
    if (!family.fits(parameters)) return std::nullopt;
    return std::pair(&family, std::move(parameters));
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> family_model(std::string_view name) {
  const auto found = parsed(name);
  if (!found) return std::nullopt;
  return found->first->model(found->second);
}

std::optional<std::string> family_program(std::string_view name) {
  const auto found = parsed(name);
  if (!found) return std::nullopt;
  return found->first->program(found->second);
}

std::optional<FamilyTask> family_task(std::string_view name) {
  const auto found = parsed(name);
  if (!found || found->first->task == nullptr) return std::nullopt;
  return found->first->task(found->second);
}

}  // namespace parallax::tools
