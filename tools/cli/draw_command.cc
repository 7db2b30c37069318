#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"
#include "compiler/base/path_gate.h"
#include "harness/campaign/replay.h"
#include "harness/campaign/sample_record.h"
#include "harness/draw/action_recorder.h"
#include "harness/draw/scene_svg.h"
#include "harness/robot/ode_simulator.h"
#include "tools/app/file_kind.h"
#include "tools/app/recorded_run.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;
using base::DiagnosticCode;

struct DrawOptions {
  std::string what;  // scenario file or run folder
  std::string out;
  std::string sample, scenario;
  bool no_regions = false;
};

/// What stands above a picture.
struct Caption {
  std::string title, subtitle;
  bool warns = false;
};

/// The pictures of one simulation.
struct Album {
  std::vector<Caption> captions;
  std::vector<harness::Picture> pictures;
};

class Writer {
 public:
  Writer(const DrawOptions& options, const harness::Scenario& scenario,
         const std::vector<harness::Picture>& pictures, Invocation& invocation)
      : invocation_(invocation) {
    if (!options.no_regions) svg_.regions = &scenario.mapping->regions();
    frame_ = harness::frame_around(pictures, svg_.regions);
  }

  bool write(const fs::path& path, const Caption& caption, const harness::Picture& picture) {
    svg_.title = caption.title;
    svg_.subtitle = caption.subtitle;
    svg_.warns = caption.warns;
    std::error_code error;
    if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
    const auto text = harness::scene_svg(picture, frame_, svg_);
    if (!base::write_output(path, text, invocation_.files(), invocation_.sink())) return false;
    written_.push_back(path.string());
    return true;
  }

  void report() const {
    if (invocation_.options().json) {
      const nlohmann::ordered_json document = {{"status", "ok"}, {"pictures", written_}};
      return invocation_.document(document.dump() + "\n");
    }
    for (const auto& path : written_) invocation_.result(path + "\n");
  }

 private:
  Invocation& invocation_;
  harness::SvgOptions svg_;
  harness::SceneFrame frame_;
  std::vector<std::string> written_;
};

/// The world as it stands at a reset without a drawn start.
int draw_start(const DrawOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  if (!options.sample.empty() || !options.scenario.empty()) {
    sink.error_about(DiagnosticCode::kUsage, "", "--sample and --scenario are for folders of runs");
    return 0;
  }
  if (!expect_kind(options.what, {FileKind::kScenario}, "a scenario", invocation)) return 0;
  const auto scenario = harness::load_scenario(options.what, invocation.files(), sink,
                                               invocation.form().allow_outside);
  if (!scenario) return 0;
  if (scenario->world.bodies.empty()) {
    sink.error_about(DiagnosticCode::kUsage, options.what, "the scenario has no `world` to draw");
    return 0;
  }
  const harness::OdeWorld world(scenario->world);
  const std::vector<harness::Picture> pictures = {{harness::scene_of(world, scenario->world), {}}};
  Writer writer(options, *scenario, pictures, invocation);
  const auto& title = scenario->title.empty() ? scenario->name : scenario->title;
  const fs::path out = options.out.empty() ? fs::path("scene.svg") : fs::path(options.out);
  if (writer.write(out, {title, "before a start is drawn"}, pictures.front())) writer.report();
  return 0;
}

Caption caption_of(std::size_t number, const std::string& event, const std::string& controller,
                   const harness::Outcome& outcome, double begin_s) {
  return {fmt::format("event {}: {} ({})", number, event, controller),
          fmt::format("{} after {:.2f} s, at {:.2f} s{}{}", to_string(outcome.status),
                      outcome.sim_time_s, begin_s + outcome.sim_time_s,
                      outcome.reason.empty() ? "" : ": ", outcome.reason),
          outcome.status != harness::SimStatus::kOk};
}

/// Simulates a recorded run again; fails, having reported, where it is another one than recorded.
base::Result<Album> simulate(const harness::RecordedRun& run, const harness::Scenario& scenario,
                             harness::OdeSimulator& simulator, const std::string& folder,
                             base::DiagnosticSink& sink) {
  const auto reset = simulator.reset(run.record.initial, run.record.seed);
  if (reset.status != harness::SimStatus::kOk) {
    return sink.error_about(DiagnosticCode::kReplayImpossible, folder, reset.reason);
  }
  harness::ActionRecorder recorder(simulator, scenario.world);
  Album album;
  album.captions.push_back(
      {"start", fmt::format("simulation {}.{}, at 0.00 s", run.id.trace, run.id.sample)});
  album.pictures.push_back({recorder.scene(), {}});
  double time_s = 0.0;
  for (std::size_t i = 0; i < run.line.calls.size() && !stop_flag().load(); ++i) {
    const auto& call = run.line.calls[i];
    const auto outcome = recorder.act(call.controller, call.arguments, call.time_limit_s);
    if (outcome.status == harness::SimStatus::kLost) break;  // there is no state to draw
    const auto& recorded = run.record.outcomes;
    if (i < recorded.size() && (recorded[i].status != outcome.status ||
                                !harness::bit_equal(recorded[i].sim_time_s, outcome.sim_time_s))) {
      return sink.error_about(
          DiagnosticCode::kReplayImpossible, folder,
          fmt::format("event {}, {}, ended otherwise than recorded", i, run.line.trace->event(i)));
    }
    album.captions.push_back(
        caption_of(i, run.line.trace->event(i), call.controller, outcome, time_s));
    album.pictures.push_back({recorder.scene(), recorder.action()});
    time_s += outcome.sim_time_s;
  }
  return album;
}

/// A picture of the start and one after each action of a recorded simulation.
int draw_run(const DrawOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto id = parse_sample_option(options.sample, sink);
  if (!id) return 0;
  const auto run = harness::read_recorded_run(options.what, *id, invocation.files(), sink);
  if (!run) return 0;
  const auto loaded = load_recorded_scenario({options.what, options.scenario}, run->header,
                                             ScenarioUse::kRun, invocation);
  if (!loaded || !check_recorded_run(*loaded, *run, invocation)) return 0;
  const auto& scenario = loaded->scenario;
  if (!scenario.simulator.is_built_in()) {
    sink.error_about(DiagnosticCode::kUsage, options.what,
                     "only worlds of the built-in simulator can be drawn");
    return 0;
  }
  harness::OdeSimulator simulator(scenario.world);
  const auto obstacle = harness::simulator_change(run->header, simulator.info());
  if (!obstacle.empty()) {
    sink.error_about(DiagnosticCode::kReplayImpossible, options.what, obstacle);
    return 0;
  }
  const auto album = simulate(*run, scenario, simulator, options.what, sink);
  if (!album) return 0;
  Writer writer(options, scenario, album->pictures, invocation);
  const fs::path folder =
      options.out.empty() ? fs::path(options.what) / "pictures" : fs::path(options.out);
  if (options.out.empty() && !base::lies_below(folder, options.what)) {  // by a link
    sink.error_about(DiagnosticCode::kLoadOutside, folder.string(),
                     base::real_path(folder).string());
    return 0;
  }
  for (std::size_t i = 0; i < album->pictures.size(); ++i) {
    const auto path = folder / fmt::format("{:02}.svg", i);
    if (!writer.write(path, album->captions[i], album->pictures[i])) return 0;
  }
  writer.report();
  return 0;
}

int draw(const DrawOptions& options, Invocation& invocation) {
  std::error_code error;
  return fs::is_directory(options.what, error) ? draw_run(options, invocation)
                                               : draw_start(options, invocation);
}

}  // namespace

Command draw_command() {
  auto options = std::make_shared<DrawOptions>();
  OptionTable command(
      "draw", "Pictures of a scenario's world, or of each action of a recorded simulation (SVG)");
  command.footer(
      "Examples:\n"
      "  parallax draw scenarios/kitchen/plan2.yaml -o kitchen.svg\n"
      "  parallax draw out/plan2                      the run's first discrepancy, action by "
      "action\n"
      "  parallax draw out/plan2 --sample 1.3 -o pictures\n"
      "Each picture shows the world from above and from the side, dotted where something nearer\n"
      "covers it; after an action also its way, a moment of it (dashed), the camera's cone, the\n"
      "goal of a drive (cross) and, in red, what went wrong.\n"
      "Exit codes: 0 drawn, 3 the scenario has changed since the run.");
  command.option("what", options->what, "Scenario file, or folder of a run").required();
  command.option("-o,--out", options->out,
                 "File (of a scenario; default scene.svg) or folder (of a run; default "
                 "pictures in its folder)");
  command.option("--sample", options->sample,
                 "TRACE.SAMPLE of a run; default: the first discrepancy");
  add_recorded_scenario_option(command, options->scenario);
  command.flag("--no-regions", options->no_regions, "Leave the regions out");
  return {std::move(command),
          [options](Invocation& invocation) { return draw(*options, invocation); }};
}

}  // namespace parallax::tools
