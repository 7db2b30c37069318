#include <filesystem>
#include <fstream>
#include <memory>

#include "compiler/base/diagnostic_codes.h"
#include "harness/campaign/recorded_run.h"
#include "harness/draw/scene_svg.h"
#include "harness/world/ode_simulator.h"
#include "tools/cli/command.h"
#include "tools/cli/sample_option.h"
#include "tools/cli/scenario_model.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string what;  // scenario file or run folder
  std::string out;
  std::string sample;
  bool no_regions = false;
};

bool write_picture(const fs::path& path, const std::string& text, Invocation& invocation) {
  std::error_code error;
  if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (file) return true;
  invocation.sink().error_about(base::DiagnosticCode::kFileNotWritable, path.string(),
                                "the picture was not written");
  return false;
}

/// The world as it stands at a reset without a drawn start.
int draw_start(const Options& options, Invocation& invocation) {
  const auto scenario = harness::load_scenario(options.what, invocation.files(), invocation.sink());
  if (!scenario) return 0;
  const harness::OdeWorld world(scenario->world);
  const auto scene = harness::scene_of(world, scenario->world);
  harness::SvgOptions svg;
  svg.title = scenario->title.empty() ? scenario->name : scenario->title;
  svg.subtitle = "left: from above; right: from the side. Metres: x to the right.";
  if (!options.no_regions) svg.regions = &scenario->mapping->regions();
  const fs::path out = options.out.empty() ? fs::path("scene.svg") : fs::path(options.out);
  if (write_picture(out, harness::scene_svg(scene, harness::frame_around(scene), svg),
                    invocation)) {
    invocation.result(out.string() + "\n");
  }
  return 0;
}

/// A picture of the start and one after each action of a recorded simulation.
int draw_run(const Options& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto id = parse_sample_option(options.sample, sink);
  if (!id) return 0;
  const auto run = harness::read_recorded_run(options.what, *id, invocation.files(), sink);
  if (!run) return 0;
  const auto scenario = harness::load_scenario(run->header.scenario, invocation.files(), sink);
  if (!scenario) return 0;
  if (!scenario->simulator.command.empty()) {
    sink.error_about(base::DiagnosticCode::kUsage, "",
                     "only worlds of the built-in simulator can be drawn");
    return 0;
  }
  harness::OdeSimulator simulator(scenario->world);
  const auto start = simulator.reset(run->record.initial, run->record.seed);
  if (start.status != harness::SimStatus::kOk) {
    sink.error_about(base::DiagnosticCode::kReplayImpossible, options.what, start.reason);
    return 0;
  }
  const fs::path folder =
      options.out.empty() ? fs::path(options.what) / "pictures" : fs::path(options.out);
  harness::SvgOptions svg;
  if (!options.no_regions) svg.regions = &scenario->mapping->regions();
  const auto frame = harness::frame_around(harness::scene_of(simulator.world(), scenario->world));
  std::string written;
  const auto draw = [&](std::size_t number, const std::string& title, const std::string& subtitle) {
    svg.title = title;
    svg.subtitle = subtitle;
    const auto path = folder / fmt::format("{:02}.svg", number);
    const auto scene = harness::scene_of(simulator.world(), scenario->world);
    if (!write_picture(path, harness::scene_svg(scene, frame, svg), invocation)) return false;
    written += path.string() + "\n";
    return true;
  };
  if (!draw(0, "start", "")) return 0;
  for (std::size_t i = 0; i < run->calls.size(); ++i) {
    const auto& call = run->calls[i];
    const auto outcome = simulator.act(call.controller, call.arguments, call.time_limit_s);
    const auto title = fmt::format("{}: {} ({})", i + 1, run->events.at(i), call.controller);
    const auto subtitle = fmt::format("{}, {:.2f} s {}", to_string(outcome.status),
                                      outcome.sim_time_s, outcome.reason);
    if (!draw(i + 1, title, subtitle)) return 0;
  }
  invocation.result(written);
  return 0;
}

int draw(const Options& options, Invocation& invocation) {
  std::error_code error;
  return fs::is_directory(options.what, error) ? draw_run(options, invocation)
                                               : draw_start(options, invocation);
}

}  // namespace

Command add_draw_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "draw", "Pictures of a scenario's world, or of each action of a recorded simulation (SVG)");
  command->footer(
      "Examples:\n"
      "  parallax draw scenarios/kitchen/plan2.yaml -o kitchen.svg\n"
      "  parallax draw out/plan2                      the run's first discrepancy, action by "
      "action\n"
      "  parallax draw out/plan2 --sample 1.3 -o pictures\n"
      "Each picture shows the world from above and from the side.");
  command->add_option("what", options->what, "Scenario file, or folder of a run")->required();
  command->add_option("-o,--out", options->out,
                      "File (of a scenario; default scene.svg) or folder (of a run; default "
                      "pictures in its folder)");
  command->add_option("--sample", options->sample,
                      "TRACE.SAMPLE of a run; default: the first discrepancy");
  command->add_flag("--no-regions", options->no_regions, "Leave the regions out");
  return {command, [options](Invocation& invocation) { return draw(*options, invocation); }};
}

}  // namespace parallax::tools
