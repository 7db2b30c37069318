#include "compiler/pipeline/compile_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>

#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"
#include "compiler/ground/expansion_size.h"

namespace parallax::compiler {
namespace {

constexpr auto kGreatest = std::numeric_limits<std::uint64_t>::max();

using CostKey = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::string>;

CostKey key_of(base::SourceRange source, const std::string& what) {
  return {source.file.index(), source.begin, source.end, what};
}

class CostCounter {
 public:
  CostCounter(const GroundModel& ground, const CompiledModel& compiled)
      : ground_(ground), compiled_(compiled) {}

  std::vector<AxiomCost> run() && {
    count_products();
    for (const auto& [source, count] : ground_.charges()) {
      const auto found = by_source_.find({source.file.index(), source.begin, source.end});
      if (found != by_source_.end()) costs_[found->second].instances += count;
    }
    count_clauses();
    std::vector<AxiomCost> result;
    for (auto& [key, cost] : costs_) result.push_back(std::move(cost));
    std::stable_sort(result.begin(), result.end(), [](const AxiomCost& a, const AxiomCost& b) {
      return std::tie(a.clauses, a.instances) > std::tie(b.clauses, b.instances);
    });
    return result;
  }

 private:
  AxiomCost& cost(base::SourceRange source, const std::string& what) {
    auto key = key_of(source, what);
    auto& entry = costs_[key];
    entry.source = source;
    entry.what = what;
    by_source_.try_emplace({source.file.index(), source.begin, source.end}, std::move(key));
    return entry;
  }

  void count_products() {
    const auto& typed = ground_.typed();
    const auto& universe = ground_.universe();
    const auto add = [&](base::SourceRange source, OriginKind kind, std::uint64_t size) {
      auto& entry = cost(source, std::string(to_string(kind)));
      entry.product = size > kGreatest - entry.product ? kGreatest : entry.product + size;
    };
    for (const auto& axiom : typed.axioms) {
      add(axiom.source, OriginKind::kAxiom, expansion_size(typed, universe, axiom.formula));
    }
    const auto with_head = [&](const auto& axiom) {
      return expansion_size(typed, universe, axiom.condition, axiom.variables);
    };
    for (const auto& effect : typed.effects)
      add(effect.source, OriginKind::kEffectAxiom, with_head(effect));
    for (const auto& axiom : typed.trajectories) {
      add(axiom.source, OriginKind::kTrajectoryAxiom, with_head(axiom));
    }
  }

  /// The copies of a section are as large as its first block.
  void count_clauses() {
    for (const auto& section : compiled_.sections) {
      const auto copies = static_cast<std::size_t>(section.copies);
      for (auto i = section.begin; i < section.begin + section.clauses; ++i) {
        const auto& origin = compiled_.origins[compiled_.clause_origins[i]];
        auto& entry = cost(origin.source, std::string(to_string(origin.kind)));
        entry.clauses += copies;
        entry.literals += copies * compiled_.clauses[i].size();
      }
    }
  }

  const GroundModel& ground_;
  const CompiledModel& compiled_;
  std::map<CostKey, AxiomCost> costs_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, CostKey> by_source_;
};

std::string place_of(const AxiomCost& cost, const base::SourceFiles& files) {
  if (cost.source.end == 0) return "-";
  const auto& file = files[cost.source.file];
  return fmt::format("{}:{}", base::printable(file.name()), file.position(cost.source.begin).line);
}

}  // namespace

std::vector<AxiomCost> axiom_costs(const GroundModel& ground, const CompiledModel& compiled) {
  return CostCounter(ground, compiled).run();
}

std::string cost_table(const std::vector<AxiomCost>& costs, const base::SourceFiles& files) {
  std::size_t width = 5;
  for (const auto& cost : costs) width = std::max(width, place_of(cost, files).size());
  auto table = fmt::format("{:<{}}  {:<18}{:>21}{:>12}{:>12}{:>12}\n", "place", width, "what",
                           "full expansion", "instances", "clauses", "literals");
  std::size_t clauses = 0, literals = 0;
  std::int64_t instances = 0;
  for (const auto& cost : costs) {
    const auto product = cost.product == 0           ? std::string("-")
                         : cost.product == kGreatest ? std::string("> 1.8e19")
                                                     : std::to_string(cost.product);
    table += fmt::format("{:<{}}  {:<18}{:>21}{:>12}{:>12}{:>12}\n", place_of(cost, files), width,
                         cost.what, product, cost.instances, cost.clauses, cost.literals);
    clauses += cost.clauses;
    literals += cost.literals;
    instances += cost.instances;
  }
  return table + fmt::format("{:<{}}  {:<18}{:>21}{:>12}{:>12}{:>12}\n", "all", width, "", "",
                             instances, clauses, literals);
}

std::string cost_json(const std::vector<AxiomCost>& costs, const base::SourceFiles& files) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& cost : costs) {
    list.push_back({{"place", place_of(cost, files)},
                    {"what", cost.what},
                    {"full_expansion", cost.product},
                    {"instances", cost.instances},
                    {"clauses", cost.clauses},
                    {"literals", cost.literals}});
  }
  return base::json_text(list);
}

std::string pass_table(const PassLog& log) {
  auto table = fmt::format("{:<18}{:>10}{:>12}{:>12}{:>13}{:>12}\n", "pass", "seconds", "atoms",
                           "nodes", "constraints", "clauses");
  for (const auto& run : log.runs) {
    const auto seconds = run.applied ? fmt::format("{:.3f}", run.seconds) : std::string("-");
    table += fmt::format("{:<18}{:>10}{:>12}{:>12}{:>13}{:>12}\n", run.pass.name, seconds,
                         run.size.atoms, run.size.nodes, run.size.constraints, run.size.clauses);
  }
  return table;
}

std::string pass_json(const PassLog& log) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& run : log.runs) {
    list.push_back({{"name", run.pass.name},
                    {"applied", run.applied},
                    {"atoms", run.size.atoms},
                    {"nodes", run.size.nodes},
                    {"constraints", run.size.constraints},
                    {"clauses", run.size.clauses},
                    {"timing", {{"seconds", run.seconds}}}});
  }
  return base::json_text(list);
}

}  // namespace parallax::compiler
