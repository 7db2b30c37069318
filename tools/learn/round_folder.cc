#include "tools/learn/round_folder.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "tools/app/own_identity.h"
#include "tools/app/simulator_factory.h"

namespace parallax::tools {

namespace fs = std::filesystem;

base::Result<RoundFolder> RoundFolder::make(const LearnOptions& options,
                                            const ScenarioModel& loaded,
                                            harness::SimulatorFactory simulator, Context& context) {
  auto& sink = context.sink();
  const auto rounds = options.out / "rounds";
  std::error_code error;
  if (fs::exists(rounds, error)) {
    return sink.error_about(
        codes::kUsage, "--out",
        fmt::format("{} has rounds of an earlier call; name another folder", options.out.string()));
  }
  fs::create_directories(rounds, error);
  if (error) {
    return sink.error_about(codes::kFileNotWritable, options.out.string(), error.message());
  }
  return RoundFolder(options, loaded, std::move(simulator), context);
}

std::optional<OpenRound> RoundFolder::begin(const LearnRound& told, std::string_view model,
                                            harness::Execution execution, std::string& why) const {
  OpenRound round;
  round.told = told;
  round.folder = options_->out / "rounds" / std::to_string(told.number);
  if (!write_scenario(round.folder, model, "model.e", "scenario.yaml")) {
    why = "a file cannot be written";
    return std::nullopt;
  }
  // The names in the user's scenario were checked when it was loaded.
  auto form = context_->form();
  form.allow_outside = true;
  round.context = std::make_unique<Context>(form, context_->stop());
  auto loaded = load_scenario_model(round.folder / "scenario.yaml", *round.context,
                                    {.as_run = true, .execution = execution});
  if (!loaded) {
    why = fmt::format("the model of round {} cannot be run: {}", told.number,
                      first_error(round.context->sink()));
    return std::nullopt;
  }
  round.loaded = *std::move(loaded);
  round.simulator =
      round.loaded->world ? simulator_factory(*round.loaded, {}, context_->stop()) : simulator_;
  return round;
}

harness::CampaignOptions RoundFolder::campaign(const OpenRound& round) const {
  harness::CampaignOptions out;
  // Every round uses other starts: the same ones would teach nothing.
  out.seed = options_->seed + static_cast<std::uint64_t>(round.told.number) - 1;
  out.jobs = options_->jobs;
  out.run_dir = round.folder / "run";
  std::error_code error;
  out.start_folder = fs::current_path(error).string();
  out.scenario_hash = round.loaded->sources_hash;
  out.tool_version = options_->tool_version;
  record_identity(round.loaded->scenario, out);
  out.stop = &context_->stop();
  out.progress = options_->progress;
  return out;
}

bool RoundFolder::write_scenario(const fs::path& folder, std::string_view model,
                                 const std::string& model_name, const std::string& scenario_name,
                                 bool closed_loop) const {
  std::error_code error;
  fs::create_directories(folder, error);
  const auto& file = loaded_->scenario.file;
  const auto from = fs::relative(file, folder, error);
  const auto include = error || from.empty() ? file : from;
  const auto scenario = fmt::format(
      "# A model that was learned from runs of this scenario.\n\n"
      "include: {}\nmodel: [{}]\n{}expect:\n",
      base::json_quoted(include.generic_string()), model_name,
      closed_loop ? "execution: closed-loop\n" : "");
  auto& sink = context_->sink();
  return base::write_file_atomically(folder / model_name, model, sink).has_value() &&
         base::write_file_atomically(folder / scenario_name, scenario, sink).has_value();
}

std::string first_error(const base::DiagnosticSink& sink) {
  for (const auto& diagnostic : sink.sorted()) {
    if (base::info(diagnostic.code).severity == base::Severity::kError) return diagnostic.message;
  }
  return "it was stopped";
}

}  // namespace parallax::tools
