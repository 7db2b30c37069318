#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "harness/campaign/replay.h"
#include "harness/recording/export_recording.h"
#include "harness/recording/recording_file.h"
#include "harness/report/text_layout.h"
#include "tools/app/file_kind.h"
#include "tools/cli/command.h"
#include "tools/cli/replaceable.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

struct ExportOptions {
  std::string folder;
  std::string sample;
  std::string format = "csv";
  std::string output;
};

/// The named simulation, else the one that `replay` takes.
std::optional<harness::SampleId> sample_to_export(const ExportOptions& options,
                                                  Invocation& invocation) {
  const auto named = parse_sample_option(options.sample, invocation.sink());
  if (!named) return std::nullopt;
  if (*named) return **named;
  const auto run = harness::read_recorded_run(options.folder, std::nullopt, invocation.files(),
                                              invocation.sink());
  if (!run) return std::nullopt;
  return run->id;
}

std::int64_t frame_count(const harness::Recording& recording) {
  std::int64_t frames = 0;
  for (harness::Playback at(recording); at.next();) ++frames;
  return frames;
}

/// Where the journal knows the simulation, the recording has its seed; one that was copied from
/// another run has not.
bool is_of_the_run(const harness::Recording& recording, const std::string& folder,
                   harness::SampleId id, base::DiagnosticSink& sink) {
  base::SourceFiles own;
  base::DiagnosticSink unread;  // a recording is of use without a journal, too
  const auto run = harness::read_recorded_run(folder, id, own, unread);
  if (!run || recording.seed == run->record.seed) return true;
  const auto file = std::filesystem::path(folder) / harness::recording_name(id.trace, id.sample);
  sink.error_about(codes::kBadRecording, file.string(),
                   fmt::format("it is that of another run, of seed {}", recording.seed));
  return false;
}

int export_motion(const ExportOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  if (!expect_kind(options.folder, {FileKind::kRun}, "the folder of a run", invocation)) return 0;
  const auto id = sample_to_export(options, invocation);
  if (!id) return 0;
  std::error_code error;
  const auto file =
      std::filesystem::path(options.folder) / harness::recording_name(id->trace, id->sample);
  // One that the run never made cannot be recorded afterwards either.
  if (!std::filesystem::exists(file, error) &&
      !harness::read_recorded_run(options.folder, *id, invocation.files(), sink)) {
    return 0;
  }
  const auto make = fmt::format("parallax replay {} --sample {}.{} --record",
                                harness::shell_word(options.folder), id->trace, id->sample);
  const auto recording = harness::read_recording(options.folder, id->trace, id->sample, make, sink);
  if (!recording || !is_of_the_run(*recording, options.folder, *id, sink)) return 0;
  if (!recording->missing.empty()) {
    sink.error_about(codes::kRecordingLost, options.folder, 1, recording->missing);
  }
  const bool is_csv = options.format == "csv";
  const auto text = is_csv ? harness::csv_of(*recording) : harness::mcap_of(*recording);
  auto output = options.output;
  const bool json = invocation.options().json;
  if (output.empty() && (json || !is_csv)) {
    output = (std::filesystem::path(options.folder) /
              fmt::format("{}.{}.{}", id->trace, id->sample, options.format))
                 .string();
  }
  if (output.empty() || output == "-") {
    if (json) {
      sink.error_about(codes::kUsage, "-o",
                       "the export and the document of --json cannot both go to the standard "
                       "output; name a file");
      return 0;
    }
    invocation.result(text);
    return 0;
  }
  if (!check_replaceable(output, is_csv ? harness::is_motion_csv : harness::is_motion_mcap,
                         invocation.files(), sink))
    return 0;
  const auto form = is_csv ? base::TextForm::kLines : base::TextForm::kExact;
  if (!base::write_output(output, text, invocation.files(), sink, form)) return 0;
  const auto sample = fmt::format("{}.{}", id->trace, id->sample);
  if (json) {
    const nlohmann::ordered_json document{{"status", "ok"},
                                          {"sample", sample},
                                          {"format", options.format},
                                          {"output", output},
                                          {"bodies", recording->scene.moving().size()},
                                          {"frames", frame_count(*recording)},
                                          {"bytes", text.size()}};
    invocation.document(base::json_text(document) + "\n");
  } else {
    invocation.result(fmt::format("{}: simulation {}, {} frames, {:.0f} kB\n",
                                  base::printable(output), sample, frame_count(*recording),
                                  static_cast<double>(text.size()) / 1e3));
  }
  return 0;
}

}  // namespace

Command export_command() {
  auto options = std::make_shared<ExportOptions>();
  OptionTable command("export", "What moved in a recorded simulation, for other programs");
  command.footer(
      "Examples:\n"
      "  parallax export out/edge --sample 1.4 -o motion.csv\n"
      "  parallax export out/edge --sample 1.4 --format mcap   writes out/edge/1.4.mcap, for "
      "Foxglove\n"
      "  parallax replay out/edge --sample 1.4 --record        makes a recording that is missing\n"
      "Exit codes: 0, 2 without a recording, 3 for a broken one.");
  command.option("run_dir", options->folder, "Folder of a run").required().folder();
  command.option("--sample", options->sample, "TRACE.SAMPLE; default: the first discrepancy");
  command
      .option("--format", options->format,
              "csv (a row for each body that moved) or mcap (scene, transforms, events, "
              "observations)")
      .check(OneOf{{"csv", "mcap"}})
      .show_default();
  command
      .option("-o,--output", options->output,
              "File to write, -: standard output; default: csv there, mcap in the run folder")
      .file();
  return command_of(std::move(command), options, export_motion);
}

}  // namespace parallax::tools
