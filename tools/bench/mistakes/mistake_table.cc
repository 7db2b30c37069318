#include "tools/bench/mistakes/mistake_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace parallax::tools {
namespace {

constexpr const char* kDouble = "two mistakes";

void count(const MistakeOutcome& outcome, MistakeCounts& counts) {
  if (outcome.shown == Shown::kNoModel) return;
  ++counts.all;
  if (outcome.shown == Shown::kInvisible) ++counts.invisible;
  if (outcome.shown == Shown::kPermissive) ++counts.permissive;
  if (!outcome.counts()) return;
  ++counts.shown;
  if (outcome.right_rank == 1) ++counts.first;
  if (outcome.right_rank >= 1) ++counts.three;
  if (outcome.right_rank >= 1 && outcome.right_second) ++counts.second;
  if (outcome.right_rank >= 1 && outcome.right_random) ++counts.random;
  if (outcome.proposals > 0 && outcome.right_rank != 1 && !outcome.first_is_marked) ++counts.silent;
  counts.list_s.push_back(outcome.list_s);
}

double percent(int part, int whole) { return whole == 0 ? 0.0 : 100.0 * part / whole; }

std::string share(int part, int whole) {
  return whole == 0 ? "" : fmt::format("{} ({:.0f} %)", part, percent(part, whole));
}

double middle(const std::vector<double>& sorted) {
  return sorted.empty() ? 0.0 : sorted[sorted.size() / 2];
}

}  // namespace

std::vector<MistakeCounts> count_mistakes(const std::vector<MistakeOutcome>& outcomes) {
  std::vector<MistakeCounts> out;
  const auto add = [&](const std::string& name, const auto& belongs) {
    MistakeCounts counts;
    counts.name = name;
    for (const auto& outcome : outcomes) {
      if (belongs(outcome)) count(outcome, counts);
    }
    std::sort(counts.list_s.begin(), counts.list_s.end());
    if (counts.all > 0) out.push_back(std::move(counts));
  };
  const auto is_single = [](const MistakeOutcome& outcome) { return outcome.kind != kDouble; };
  const auto is_held_out = [](const MistakeOutcome& outcome) {
    const auto& worlds = mistake_worlds();
    return std::any_of(worlds.begin(), worlds.end(), [&](const MistakeWorld& world) {
      return world.held_out && world.name == outcome.world;
    });
  };
  for (const auto& world : mistake_worlds()) {
    add(world.name, [&](const MistakeOutcome& outcome) {
      return is_single(outcome) && outcome.world == world.name;
    });
  }
  add("worlds in sight",
      [&](const MistakeOutcome& outcome) { return is_single(outcome) && !is_held_out(outcome); });
  add("held-out worlds",
      [&](const MistakeOutcome& outcome) { return is_single(outcome) && is_held_out(outcome); });
  for (int kind = 0; kind < kMistakeKinds; ++kind) {
    const std::string name = to_string(static_cast<MistakeKind>(kind));
    add(name, [&](const MistakeOutcome& outcome) { return outcome.kind == name; });
  }
  add("axioms of triggered events",
      [&](const MistakeOutcome& outcome) { return is_single(outcome) && outcome.of_demanded; });
  add("all single mistakes", is_single);
  add(kDouble, [&](const MistakeOutcome& outcome) { return !is_single(outcome); });
  return out;
}

std::string to_words(const MistakeCounts& counts) {
  return fmt::format(
      "{} shown of {}; first right {:.0f} %, within three {:.0f} %, other plan {:.0f} %, random "
      "{:.0f} %; first wrong and unmarked {:.1f} %; list {:.2f} s, worst {:.1f} s",
      counts.shown, counts.all, percent(counts.first, counts.shown),
      percent(counts.three, counts.shown), percent(counts.second, counts.three),
      percent(counts.random, counts.three), percent(counts.silent, counts.shown),
      middle(counts.list_s), counts.list_s.empty() ? 0.0 : counts.list_s.back());
}

std::string to_markdown(const std::vector<MistakeCounts>& counts) {
  std::string text =
      "| | mistakes | invisible | not provoked | shown | first right | within three | other plan "
      "too | random too | first wrong, unmarked | median list | worst |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& row : counts) {
    text += fmt::format(
        "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.2f} s | {:.1f} s |\n", row.name,
        row.all, row.invisible, row.permissive, row.shown, share(row.first, row.shown),
        share(row.three, row.shown), share(row.second, row.three), share(row.random, row.three),
        share(row.silent, row.shown), middle(row.list_s),
        row.list_s.empty() ? 0.0 : row.list_s.back());
  }
  return text;
}

std::string to_json(const std::vector<MistakeCounts>& counts) {
  auto rows = nlohmann::json::array();
  for (const auto& row : counts) {
    rows.push_back({{"name", row.name},
                    {"mistakes", row.all},
                    {"invisible", row.invisible},
                    {"not_provoked", row.permissive},
                    {"shown", row.shown},
                    {"first_right", row.first},
                    {"first_right_percent", percent(row.first, row.shown)},
                    {"within_three", row.three},
                    {"within_three_percent", percent(row.three, row.shown)},
                    {"other_plan_too", row.second},
                    {"other_plan_percent", percent(row.second, row.three)},
                    {"random_too", row.random},
                    {"first_wrong_unmarked", row.silent},
                    {"first_wrong_unmarked_percent", percent(row.silent, row.shown)},
                    {"median_list_cpu_s", middle(row.list_s)},
                    {"worst_list_cpu_s", row.list_s.empty() ? 0.0 : row.list_s.back()}});
  }
  return nlohmann::json{{"rows", rows}}.dump(1) + "\n";
}

}  // namespace parallax::tools
