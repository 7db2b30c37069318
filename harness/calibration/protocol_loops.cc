#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <span>

#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/temporary_folder.h"
#include "harness/calibration/calibration.h"
#include "harness/campaign/campaign.h"
#include "harness/simulator/process_simulator.h"

namespace parallax::harness {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kJobsOfSlow = 4;

/// The world of SyntheticSimulator. A simulator that is lost wherever it should show a discrepancy
/// is often lost several times in a row, which would end a campaign.
constexpr const char* kSyntheticScenario = R"(model: domain.e
horizon: 1
simulator: {command: [synthetic]}
regions:
  cells: {goal: {x: [0, 1]}, start: {x: [3, 4]}, second: {x: [4, 5]}, third: {x: [5, 6]}}
  gaps: allowed
mapping:
  BoxIn(region): {inside: region, body: box}
actions:
  PushLeft(): {controller: push-left}
  PushRight(): {controller: push-right}
limits: {max_lost_in_a_row: 1000}
)";

constexpr std::array<const char*, kSyntheticStates> kStartFluents = {
    "BoxIn(start)", "BoxIn(second)", "BoxIn(third)"};

/// One push for each trace, from one initial state or from any of them.
class SyntheticTraces final : public TraceFeed {
 public:
  SyntheticTraces(std::int64_t count, SyntheticKind kind)
      : count_(count),
        has_states_(has_states(kind)),
        has_weights_(kind == SyntheticKind::kWeightedStates),
        symbols_(table()) {}

  base::Result<std::optional<CampaignTrace>> next() override {
    if (given_ == count_) return std::optional<CampaignTrace>();
    return std::optional(trace(++given_, kStartFluents.front()));
  }
  std::string exploration() const override { return "all traces explored"; }
  runtime::Symbols symbols() const override { return symbols_; }

  base::Result<std::optional<TraceStarts>> starts(
      const CampaignTrace& trace, std::span<const compiler::FluentId> fluents) override {
    if (!has_states_) return TraceFeed::starts(trace, fluents);
    TraceStarts out;
    for (const auto* fluent : kStartFluents) out.states.push_back({*symbols_->fluent(fluent)});
    if (has_weights_) out.weights.assign(kSyntheticWeights.begin(), kSyntheticWeights.end());
    return std::optional(std::move(out));
  }
  base::Result<std::pair<base::Known, std::optional<CampaignTrace>>> from(
      const CampaignTrace& of, std::span<const compiler::FluentId>,
      const std::vector<compiler::FluentId>& state) override {
    return std::pair(base::Known::kYes,
                     std::optional(trace(of.number, symbols_->name(state.front()))));
  }

 private:
  CampaignTrace trace(std::int64_t number, const std::string& starts_in) const {
    const std::string event = number == 1 ? "PushLeft()" : "PushRight()";
    CampaignTrace out;
    out.number = number;
    out.key = event;
    auto names = std::make_shared<compiler::SymbolTable>(*symbols_);
    const std::vector<std::string> start = {starts_in}, goal = {"BoxIn(goal)"};
    out.points.push_back(runtime::point_of_names(start, std::vector{event}, *names));
    out.points.push_back(runtime::point_of_names(goal, {}, *names));
    out.symbols = std::move(names);
    out.plan.emplace_back();
    if (has_states_) out.other_initial_states = base::Known::kYes;
    return out;
  }

  static runtime::Symbols table() {
    auto out = std::make_shared<compiler::SymbolTable>();
    out->add_fluent("BoxIn(goal)");
    for (const auto* fluent : kStartFluents) out->add_fluent(fluent);
    return out;
  }

  std::int64_t count_, given_ = 0;
  bool has_states_, has_weights_;
  runtime::Symbols symbols_;
};

base::Result<Scenario> synthetic_scenario(const fs::path& folder, base::SourceFiles& files,
                                          base::DiagnosticSink& sink) {
  const auto file = folder / "scenario.yaml";
  if (!base::write_file_atomically(folder / "domain.e", "sort region\n", sink) ||
      !base::write_file_atomically(file, kSyntheticScenario, sink)) {
    return sink.already_reported();
  }
  return load_scenario(file, files, sink);
}

}  // namespace

std::vector<std::string> synthetic_arguments(const SyntheticSimulator::Options& options) {
  return {"--serve",       std::string(to_string(options.kind)),
          "--probability", fmt::format("{}", options.probability),
          "--seed",        fmt::format("{}", options.key),
          "--draws",       options.draws.string()};
}

base::Result<CalibrationCell> protocol_cell(const CalibratedCriterion& criterion,
                                            const CalibratedWorld& world,
                                            const CalibrationOptions& options, std::int64_t loops,
                                            base::DiagnosticSink& sink) {
  CalibrationCell cell{world.name, criterion.name, 0, 0, 0.0, allowed_share(criterion, world)};
  const base::TemporaryFolder folder("calibrate");
  if (folder.path().empty()) {
    std::error_code unknown;
    return sink.error_about(codes::kFileNotWritable, fs::temp_directory_path(unknown).string(),
                            "no folder can be made there");
  }
  base::SourceFiles files;
  auto scenario = synthetic_scenario(folder.path(), files, sink);
  if (!scenario) return sink.already_reported();
  scenario->criterion = criterion.spec;
  scenario->criterion.family = world.family.value_or(Family::kAllTraces);
  if (world.kind == SyntheticKind::kWeightedStates) scenario->initial = Initial::kWeights;
  std::int64_t runs = 0;
  while (cell.loops < loops && (options.stop == nullptr || !options.stop->load())) {
    // Files of one loop alone, so that nothing grows with their number.
    base::SourceFiles own;
    base::DiagnosticSink told;
    CampaignOptions campaign;
    campaign.seed = options.seed * 1'000'003U + static_cast<std::uint64_t>(cell.loops);
    campaign.jobs = world.kind == SyntheticKind::kSlow ? kJobsOfSlow : 1;
    campaign.keep_going = true;  // every trace is claimed, or not
    campaign.run_dir = folder.path() / "run";
    campaign.stop = options.stop;
    ProcessOptions process;
    process.command = options.command;
    const int count = world.family ? 2 : 1;
    const auto more =
        synthetic_arguments({world.kind, calibrated_probability(criterion, world, count),
                             campaign.seed, folder.path() / "draws", true});
    process.command.insert(process.command.end(), more.begin(), more.end());
    process.stop = options.stop;
    SyntheticTraces traces(count, world.kind);
    const auto result = run_campaign(
        *scenario, traces, [&] { return std::make_unique<ProcessSimulator>(process); }, campaign,
        own, told);
    if (options.stop != nullptr && options.stop->load()) break;
    if (!result) {
      for (const auto& diagnostic : told.sorted()) {
        return sink.error_about(diagnostic.code, criterion.name, diagnostic.message);
      }
    }
    std::vector<CalibratedTrace> ends;
    for (const auto& trace : result->traces) {
      ends.push_back(
          {trace.verdict == CampaignVerdict::kDiscrepancy, trace.is_decided, trace.stated,
           trace.shared,
           calibrated_probability(criterion, world, static_cast<int>(trace.trace->number))});
    }
    ++cell.loops;
    cell.false_claims += is_false_claim(criterion, world, ends) ? 1 : 0;
    runs += result->simulations;
    std::error_code ignored;
    fs::remove_all(campaign.run_dir, ignored);
    fs::remove(folder.path() / "draws", ignored);
  }
  if (cell.loops > 0) cell.mean_runs = static_cast<double>(runs) / static_cast<double>(cell.loops);
  return cell;
}

}  // namespace parallax::harness
