#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>

#include "compiler/base/codes/files.h"
#include "harness/calibration/calibration.h"
#include "harness/simulator/worker.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"

namespace parallax::tools {
namespace {

struct CalibrateOptions {
  harness::CalibrationOptions calibration;
  std::vector<std::string> criteria, simulators;  // empty: all
  std::string serve, draws;
  double probability = 0.0;
};

int serve_synthetic(const CalibrateOptions& options) {
  harness::SyntheticSimulator simulator({harness::kSyntheticWords.find(options.serve).value(),
                                         options.probability, options.calibration.seed,
                                         options.draws, true});
  return harness::serve(simulator, STDIN_FILENO, STDOUT_FILENO) == 0 ? 0 : 5;
}

/// Keeps what is named; all where nothing is.
template <typename T, typename Name>
void keep_named(const std::vector<std::string>& names, std::vector<T>& all, Name name_of) {
  if (names.empty()) return;
  std::erase_if(all, [&](const T& one) {
    return std::find(names.begin(), names.end(), name_of(one)) == names.end();
  });
}

int run_calibrate(const CalibrateOptions& options, Invocation& invocation) {
  auto calibration = options.calibration;
  calibration.command = {"/proc/self/exe", "calibrate"};
  calibration.stop = &stop_flag();
  calibration.progress = [&](const harness::CalibrationCell& cell) {
    invocation.remark(fmt::format("{}, {}: {} of {} loops", cell.world, cell.criterion,
                                  cell.false_claims, cell.loops));
  };
  auto criteria = harness::calibrated_criteria(calibration.confidence_level, calibration.epsilon);
  keep_named(options.criteria, criteria, [](const auto& one) { return one.name; });
  auto worlds = harness::calibrated_worlds();
  keep_named(options.simulators, worlds,
             [](const auto& one) { return std::string(to_string(one.kind)); });
  const auto result = harness::calibrate(calibration, criteria, worlds, invocation.sink());
  if (!result) return 0;
  if (result->complete && result->in_process.empty() && result->protocol.empty()) {
    invocation.sink().error_about(codes::kUsage, "--loops",
                                  "nothing is measured with it; name another number of loops, "
                                  "--protocol-loops, or other simulators");
    return 0;
  }
  if (invocation.options().json) {
    invocation.document(harness::calibration_json(*result));
  } else {
    invocation.result(harness::calibration_markdown(*result));
  }
  if (!result->is_within()) return 1;
  return result->complete ? 0 : 4;
}

}  // namespace

Command calibrate_command() {
  auto options = std::make_shared<CalibrateOptions>();
  auto& calibration = options->calibration;
  OptionTable command("calibrate",
                      "How often do the criteria claim what is false? Measured with simulators "
                      "whose discrepancy probability is known: epsilon itself");
  command.footer(
      "Examples:\n"
      "  parallax calibrate\n"
      "  parallax calibrate --criterion clean-runs --confidence 0.9 --epsilon 0.2\n"
      "  parallax calibrate --simulator crash-first --protocol-loops 100 --json\n"
      "The tables of docs/internals/statistics.md are from the first one. Its second part writes "
      "much: with\n"
      "TMPDIR in memory it takes half an hour, else hours.\n"
      "Exit codes: 0 each criterion errs as rarely as it says, 1 one does not, 4 interrupted.");
  std::vector<std::string> criteria;
  for (const auto& one : harness::calibrated_criteria(0.99, 0.05)) criteria.push_back(one.name);
  command.option("--loops", calibration.loops, "Loops of each cell in process")
      .check(WholeNumber{0, 10'000'000})
      .show_default();
  command
      .option("--protocol-loops", calibration.protocol_loops,
              "Campaigns of each cell with simulators behind the protocol")
      .check(WholeNumber{0, 10'000'000})
      .show_default();
  command.option("--confidence", calibration.confidence_level, "Confidence level C of the claims")
      .check(FiniteNumber{0.5, 0.999999})
      .show_default();
  command
      .option("--epsilon", calibration.epsilon,
              "Discrepancy probability to exclude, which the simulators have")
      .check(FiniteNumber{1e-6, 0.5})
      .show_default();
  command.option("--seed", calibration.seed, "Seed of every random choice")
      .check(WholeNumber{0, kMaxSeed})
      .show_default();
  command.option("--criterion", options->criteria, "Only these criteria")
      .check(OneOf{criteria})
      .list(ListForm::kOneEachTime);
  command.option("--simulator", options->simulators, "Only these simulators")
      .list(ListForm::kOneEachTime)
      .check(one_of(harness::kSyntheticWords));
  command
      .option("--serve", options->serve, "Be one of the simulators, on standard input and output")
      .check(one_of(harness::kSyntheticWords));
  command.option("--probability", options->probability, "Of a run of --serve to go wrong")
      .check(FiniteNumber{0.0, 1.0});
  command.option("--draws", options->draws, "The file by whose size --serve counts its own draws")
      .file();
  return {std::move(command), [options](Invocation& invocation) {
            return options->serve.empty() ? run_calibrate(*options, invocation)
                                          : serve_synthetic(*options);
          }};
}

}  // namespace parallax::tools
