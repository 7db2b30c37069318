#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/codes/texts.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/path_gate.h"
#include "harness/campaign/judge.h"
#include "harness/campaign/replay.h"
#include "harness/campaign/sample_record.h"
#include "harness/draw/action_recorder.h"
#include "harness/draw/difference.h"
#include "harness/draw/recorded_actions.h"
#include "harness/draw/robot_drawing.h"
#include "harness/draw/scene_svg.h"
#include "harness/report/run_report.h"
#include "harness/robot/ode_simulator.h"
#include "tools/app/file_kind.h"
#include "tools/app/recorded_run.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"
#include "tools/cli/recording_to_draw.h"
#include "tools/cli/replaceable.h"
#include "tools/cli/shared_options.h"
#include "tools/page/picture_index.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

struct DrawOptions {
  std::string what;  // scenario file or run folder
  std::string out;
  std::string sample, scenario;
  bool no_regions = false;
  bool robot = false;
};

/// Text above a picture.
struct Caption {
  std::string title, subtitle;
  bool warns = false, parts = false;
  std::vector<std::string> differences = {};
};

/// The pictures of one simulation.
struct Album {
  std::vector<Caption> captions;
  std::vector<harness::Picture> pictures;
};

/// A picture that this command made, by an earlier version, too.
bool is_picture(std::string_view head) {
  return head.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\"") &&
         (head.find(" class=\"scene\" ") != std::string_view::npos ||
          head.find(" font-family=\"sans-serif\">\n<rect width=\"100%\"") !=
              std::string_view::npos);
}

std::string picture_name(std::size_t timepoint) { return fmt::format("{:02}.svg", timepoint); }

class Writer {
 public:
  explicit Writer(Invocation& invocation) : invocation_(invocation) {}

  bool write(const fs::path& path, const std::string& text) {
    std::error_code error;
    if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
    if (!base::write_output(path, text, invocation_.files(), invocation_.sink(),
                            base::TextForm::kMarkup)) {
      return false;
    }
    written_.push_back(path.string());
    return true;
  }

  /// `index`: the page over them; empty: there is none.
  void report(const std::string& index) const {
    if (invocation_.options().json) {
      nlohmann::ordered_json document = {{"status", "ok"}, {"pictures", written_}};
      if (!index.empty()) document["index"] = index;
      return invocation_.document(base::json_text(document) + "\n");
    }
    for (const auto& path : written_) invocation_.result(base::printable(path) + "\n");
    if (!index.empty()) invocation_.result(base::printable(index) + "\n");
  }

 private:
  Invocation& invocation_;
  std::vector<std::string> written_;
};

/// The world as it stands at a reset without a drawn start.
int draw_start(const DrawOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  if (!options.sample.empty() || !options.scenario.empty()) {
    sink.error_about(codes::kUsage, "", "--sample and --scenario are for folders of runs");
    return 0;
  }
  if (!expect_kind(options.what, {FileKind::kScenario}, "a scenario", invocation)) return 0;
  const auto scenario = harness::load_scenario(options.what, invocation.files(), sink,
                                               invocation.form().allow_outside);
  if (!scenario) return 0;
  if (scenario->world.bodies.empty()) {
    sink.error_about(codes::kUsage, options.what, "the scenario has no `world` to draw");
    return 0;
  }
  const std::unique_ptr<const harness::PhysicsWorld> owned = harness::make_world(scenario->world);
  const harness::PhysicsWorld& world = *owned;
  const std::vector<harness::Picture> pictures = {{harness::scene_of(world, scenario->world), {}}};
  const fs::path out = options.out.empty() ? fs::path("scene.svg") : fs::path(options.out);
  if (!check_replaceable(out.string(), is_picture, invocation.files(), sink)) return 0;
  harness::SvgOptions svg;
  svg.title = scenario->title.empty() ? scenario->name : scenario->title;
  svg.subtitle = "before a start is drawn";
  if (!options.no_regions) svg.regions = &scenario->mapping->regions();
  const auto frame = harness::frame_around(pictures, svg.regions);
  Writer writer(invocation);
  if (writer.write(out, harness::scene_svg(pictures.front(), frame, svg))) writer.report({});
  return 0;
}

/// The robot of a file that holds what a scenario has under `world`.
int draw_robot(const DrawOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto world =
      harness::load_world(options.what, invocation.files(), sink, invocation.form().allow_outside);
  if (!world) return 0;
  if (harness::base_body(*world).empty()) {
    sink.error_about(codes::kUsage, options.what, "the file has no `robot` to draw");
    return 0;
  }
  const fs::path out = options.out.empty() ? fs::path("robot.svg") : fs::path(options.out);
  if (!check_replaceable(out.string(), is_picture, invocation.files(), sink)) return 0;
  Writer writer(invocation);
  const auto title = fs::path(options.what).filename().string();
  if (writer.write(out, harness::robot_svg(*world, title))) writer.report({});
  return 0;
}

/// The place where model and simulation part, and the differences.
struct DrawnParting {
  std::optional<std::size_t> event;
  std::vector<harness::ShownDifference> differences;
  std::string words;  // in a sentence, as the report has it
  /// States were compared on the way: up to the parting they are as predicted.
  bool every_step = false;
  bool is_clean = false;  // it is known that they do not part
};

/// The parting by the recorded observations, compared with the trace; for an executed plan, by the
/// report, which may be missing.
DrawnParting drawn_parting(const harness::RecordedRun& run, const ScenarioModel& loaded,
                           const harness::CampaignTrace& trace, const std::string& folder,
                           Invocation& invocation) {
  DrawnParting out;
  Context own(invocation.form(), invocation.stop());  // a report that cannot be read is no matter
  const auto text = base::read_file_of(folder, "report.json", own.sink());
  const auto report = text ? harness::read_run_report(*text) : std::nullopt;
  const bool is_over = report && report->traces;
  const harness::Discrepancy* told = nullptr;
  if (is_over && report->discrepancies) {
    for (const auto& one : *report->discrepancies) {
      if (one.found.trace != run.id.trace || one.found.sample != run.id.sample) continue;
      told = &one.found;
      out.words = one.words;
    }
  }
  const auto comparison = recorded_comparison(run.header).value_or(loaded.scenario.comparison());
  out.every_step = comparison == harness::Comparison::kEveryStep;
  if (run.record.path) {
    if (told == nullptr || told->first_divergence < 1) return out;
    out.event = static_cast<std::size_t>(told->first_divergence) - 1;
    for (const auto& one : told->first) {
      out.differences.push_back({one.fluent, one.predicted, one.observed});
    }
    return out;
  }
  if (run.record.observations.size() != trace.points.size()) return out;
  const compiler::SymbolTable symbols(loaded.compilation.model);
  const harness::ModelFluents fluents(symbols);
  const auto judgement =
      harness::judge(*loaded.scenario.mapping, fluents, trace, run.record.observations);
  // An execution that left the trace may still be one of the model: the report tells.
  out.is_clean = judgement.matches(comparison) || (is_over && told == nullptr);
  if (out.is_clean || trace.event_count() == 0) return out;
  out.event = static_cast<std::size_t>(harness::event_of(judgement, comparison));
  for (const auto& one : out.every_step ? judgement.first : judgement.at_parting) {
    out.differences.push_back({one.fluent, one.predicted, one.observed});
  }
  return out;
}

/// The differences in words, the first of them.
std::vector<std::string> lines_of(const std::vector<harness::ShownDifference>& differences) {
  constexpr std::size_t kMost = 4;
  std::vector<std::string> out;
  for (const auto& one : differences) {
    if (out.size() == kMost) {
      out.push_back(fmt::format("and {} more", differences.size() - kMost));
      break;
    }
    out.push_back(fmt::format("predicted: {}{}; observed: {}", one.predicted ? "" : "not ",
                              one.fluent, one.observed ? "it holds" : "it does not hold"));
  }
  return out;
}

Caption caption_of(std::size_t number, const std::string& event, const std::string& controller,
                   const harness::Outcome& outcome, double begin_s, const DrawnParting& parting) {
  const bool parts = parting.event == number;
  const bool failed = outcome.status != harness::SimStatus::kOk;
  const bool before = parting.event ? number < *parting.event : parting.is_clean;
  const bool foreseen = failed && before && parting.every_step;
  Caption caption;
  caption.title = fmt::format("event {}: {} ({})", number, event, controller);
  caption.subtitle = fmt::format("{} after {:.2f} s, at {:.2f} s{}{}{}",
                                 parts && !failed ? "not as predicted" : to_string(outcome.status),
                                 outcome.sim_time_s, begin_s + outcome.sim_time_s,
                                 outcome.reason.empty() ? "" : ": ", outcome.reason,
                                 foreseen ? " (the states are as predicted)" : "");
  caption.warns = parts || failed;
  caption.parts = parts;
  if (parts) caption.differences = lines_of(parting.differences);
  return caption;
}

/// Pictures of the actions of a run, as `watched` shows them; fails, having reported, where that is
/// another simulation than the one on record. `act` does the call of this number.
template <typename Watched, typename Act>
base::Result<Album> album_of(const harness::RecordedRun& run, const harness::Scenario& scenario,
                             const DrawnParting& parting, const std::string& folder,
                             base::DiagnosticSink& sink, Watched& watched, const Act& act) {
  Album album;
  album.captions.push_back(
      {"start", fmt::format("simulation {}.{}, at 0.00 s", run.id.trace, run.id.sample)});
  album.pictures.push_back({watched.scene(), {}});
  double time_s = 0.0;
  for (std::size_t i = 0; i < run.line.calls.size() && !stop_flag().load(); ++i) {
    const auto& call = run.line.calls[i];
    const harness::Outcome outcome = act(i, call);
    if (outcome.status == harness::SimStatus::kLost) break;  // there is no state to draw
    const auto& recorded = run.record.outcomes;
    if (i < recorded.size() && (recorded[i].status != outcome.status ||
                                !harness::bit_equal(recorded[i].sim_time_s, outcome.sim_time_s))) {
      return sink.error_about(
          codes::kReplayImpossible, folder,
          fmt::format("event {}, {}, ended otherwise than recorded", i, run.line.trace->event(i)));
    }
    album.captions.push_back(
        caption_of(i, run.line.trace->event(i), call.controller, outcome, time_s, parting));
    album.pictures.push_back({watched.scene(), watched.action()});
    if (parting.event == i) {
      harness::add_differences(*scenario.mapping, scenario.world, parting.differences,
                               watched.before(), album.pictures.back());
    }
    time_s += outcome.sim_time_s;
  }
  return album;
}

/// Simulates a recorded run again.
base::Result<Album> simulate(const harness::RecordedRun& run, const harness::Scenario& scenario,
                             const DrawnParting& parting, const std::string& folder,
                             base::DiagnosticSink& sink) {
  harness::OdeSimulator simulator(scenario.world);
  const auto obstacle = harness::simulator_change(run.header, simulator.info());
  if (!obstacle.empty()) {
    return sink.error_about(codes::kReplayImpossible, folder, obstacle);
  }
  const auto reset = simulator.reset(run.record.initial, run.record.seed);
  if (reset.status != harness::SimStatus::kOk) {
    return sink.error_about(codes::kReplayImpossible, folder, reset.reason);
  }
  harness::ActionRecorder recorder(simulator, scenario.world);
  return album_of(run, scenario, parting, folder, sink, recorder,
                  [&](std::size_t, const harness::ActionCall& call) {
                    return recorder.act(call.controller, call.arguments, call.time_limit_s);
                  });
}

/// From its recording, without a simulator; simulated again where that cannot stand for it.
base::Result<Album> album_of_run(const harness::RecordedRun& run, const harness::Scenario& scenario,
                                 const DrawnParting& parting, const std::string& folder,
                                 Invocation& invocation) {
  std::string why;
  const bool is_external = !scenario.simulator.is_built_in();
  const auto recording =
      recording_to_draw(folder, run, is_external ? nullptr : &scenario.world, why);
  if (!recording && is_external) {
    return invocation.sink().error_about(
        codes::kUsage, folder,
        fmt::format("simulation {}.{} cannot be drawn: its simulator is another program, and {}",
                    run.id.trace, run.id.sample, why));
  }
  if (!recording) {
    invocation.remark(fmt::format("simulation {}.{} is simulated again, without its recording: {}",
                                  run.id.trace, run.id.sample, why));
    return simulate(run, scenario, parting, folder, invocation.sink());
  }
  harness::RecordedActions recorded(*recording, scenario.world);
  return album_of(run, scenario, parting, folder, invocation.sink(), recorded,
                  [&](std::size_t i, const harness::ActionCall& call) {
                    auto outcome = recorded.act(call.controller, call.arguments);
                    // The difference of two times would not be the same to the last bit.
                    const auto& known = run.record.outcomes;
                    if (i < known.size()) outcome.sim_time_s = known[i].sim_time_s;
                    return outcome;
                  });
}

/// The pictures as SVG; each shows where its action was, the first one where all of them were.
std::vector<std::string> svgs_of(const Album& album, const harness::RegionMap& regions,
                                 bool with_regions, bool with_style) {
  std::vector<harness::SceneFrame> frames;
  for (const auto& picture : album.pictures) {
    frames.push_back(harness::action_frame(picture, regions));
  }
  for (std::size_t i = 1; i < frames.size(); ++i) {
    frames[0] = harness::frame_of_both(frames[0], frames[i]);
  }
  std::vector<std::string> out;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto& caption = album.captions[i];
    harness::SvgOptions svg;
    svg.title = caption.title;
    svg.subtitle = caption.subtitle;
    svg.warns = caption.warns;
    svg.differences = caption.differences;
    svg.is_of_action = true;
    svg.has_style = with_style;
    if (with_regions) svg.regions = &regions;
    out.push_back(harness::scene_svg(album.pictures[i], frames[i], svg));
  }
  return out;
}

std::string index_of(const Album& album, const std::vector<std::string>& svgs,
                     const harness::RecordedRun& run, const DrawnParting& parting) {
  PictureIndex index;
  index.scenario = run.header.scenario;
  index.simulation = fmt::format("{}.{}, seed {}", run.id.trace, run.id.sample, run.record.seed);
  index.words = parting.words;
  index.is_clean = parting.is_clean;
  index.style = harness::scene_style();
  for (std::size_t i = 0; i < svgs.size(); ++i) {
    const auto& caption = album.captions[i];
    auto& step = index.steps.emplace_back();
    step.file = picture_name(i);
    step.title = caption.title;
    if (i > 0 && i <= run.line.trace->plan.size()) step.place = run.line.trace->plan[i - 1].source;
    step.outcome = caption.subtitle;
    step.warns = caption.warns;
    step.parts = caption.parts;
    step.svg = svgs[i];
  }
  return picture_index(index);
}

/// A picture of the start and one after each action of a recorded simulation, and a page over them.
int draw_run(const DrawOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto id = parse_sample_option(options.sample, sink);
  if (!id) return 0;
  const auto run = harness::read_recorded_run(options.what, *id, invocation.files(), sink);
  if (!run) return 0;
  const auto loaded = load_recorded_scenario({options.what, options.scenario}, run->header,
                                             ScenarioUse::kRun, invocation);
  if (!loaded) return 0;
  const auto trace = check_recorded_run(*loaded, *run, invocation);
  if (!trace) return 0;
  const auto& scenario = loaded->scenario;
  const fs::path folder =
      options.out.empty() ? fs::path(options.what) / "pictures" : fs::path(options.out);
  if (options.out.empty() && !base::lies_below(folder, options.what)) {  // by a link
    sink.error_about(codes::kLoadOutside, folder.string(), base::real_path(folder).string());
    return 0;
  }
  for (std::size_t i = 0; i <= run->line.calls.size(); ++i) {
    if (!check_replaceable((folder / picture_name(i)).string(), is_picture, invocation.files(),
                           sink))
      return 0;
  }
  if (!check_replaceable((folder / "index.html").string(), is_earlier_page, invocation.files(),
                         sink))
    return 0;
  const auto parting = drawn_parting(*run, *loaded, *trace, options.what, invocation);
  const auto album = album_of_run(*run, scenario, parting, options.what, invocation);
  if (!album) return 0;
  const auto& regions = scenario.mapping->regions();
  Writer writer(invocation);
  const auto svgs = svgs_of(*album, regions, !options.no_regions, true);
  for (std::size_t i = 0; i < svgs.size(); ++i) {
    if (!writer.write(folder / picture_name(i), svgs[i])) return 0;
  }
  const auto inline_svgs = svgs_of(*album, regions, !options.no_regions, false);
  const auto page = index_of(*album, inline_svgs, *run, parting);
  const auto path = folder / "index.html";
  if (!base::write_output(path, page, invocation.files(), sink, base::TextForm::kMarkup)) return 0;
  writer.report(path.string());
  return 0;
}

int draw(const DrawOptions& options, Invocation& invocation) {
  std::error_code error;
  if (options.robot) return draw_robot(options, invocation);
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
      "Each picture shows the world from above and from the side; of an action the part where it\n"
      "was, its way, a moment of it (dashed), the camera's cone, the goal of a drive (cross) and, "
      "in\n"
      "red, what went wrong and by how much. Where model and simulation part: predicted dashed in\n"
      "violet, observed in red. index.html in the folder shows them all. What moved is taken from\n"
      "the run's recording; without one it is simulated again.\n"
      "Exit codes: 0 drawn, 3 the scenario has changed since the run.");
  command.option("what", options->what, "Scenario file, or folder of a run")
      .required()
      .file({"yaml"});
  command
      .option(
          "-o,--out", options->out,
          "File (default scene.svg), or folder for a run (default: pictures, in the run's folder)")
      .file();
  command.option("--sample", options->sample,
                 "TRACE.SAMPLE of a run; default: the first discrepancy");
  add_recorded_scenario_option(command, options->scenario);
  command.flag("--no-regions", options->no_regions, "Leave the regions out");
  command.flag("--robot", options->robot,
               "The robot of a file as scenarios include it, with its frames and numbers");
  return command_of(std::move(command), options, draw);
}

}  // namespace parallax::tools
