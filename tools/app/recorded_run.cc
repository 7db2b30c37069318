#include "tools/app/recorded_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <system_error>

#include "compiler/artifact/path_map.h"
#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/texts.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/hash.h"
#include "compiler/base/temporary_folder.h"
#include "harness/campaign/trial.h"
#include "harness/sampling/sampler.h"
#include "harness/simulator/command_files.h"
#include "runtime/replay/trace_replay.h"
#include "tools/app/execution_check.h"
#include "tools/app/kept_inputs.h"

namespace parallax::tools {

namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// The recorded trace in the ids of the model. None if it has names that the model does not have.
std::optional<harness::CampaignTrace> in_ids_of(const compiler::CompiledModel& model,
                                                const harness::CampaignTrace& recorded) {
  const auto symbols = std::make_shared<compiler::SymbolTable>(model);
  auto trace = recorded;
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    const auto holds = recorded.holds(t), happens = recorded.happens(t);
    trace.points[t] =
        runtime::point_of_names(std::vector<std::string>(holds.begin(), holds.end()),
                                std::vector<std::string>(happens.begin(), happens.end()), *symbols);
  }
  if (symbols->fluent_count() != model.fluents.size() ||
      symbols->event_count() != model.events.size()) {
    return std::nullopt;
  }
  trace.symbols = symbols;
  return trace;
}

runtime::AtomClaims only(const runtime::Names& names) {
  runtime::AtomClaims claims{true, {}};
  for (const auto& name : names) claims.listed.emplace(std::string(name), runtime::AtomClaim{});
  return claims;
}

/// Is this a key of the trace? It has the events, the objects that they returned, of which the
/// journal has nothing else, and perhaps the start (`run --split-initial`).
bool is_key_of(const harness::CampaignTrace& trace, std::string_view key) {
  for (std::size_t t = 0; t < trace.event_count(); ++t) {
    const auto events = fmt::format("{}", fmt::join(trace.happens(t), "+"));
    if (!key.starts_with(events)) return false;
    key.remove_prefix(events.size());
    const auto end = key.find(';');
    if (end == std::string_view::npos || (end > 0 && key.front() != '=')) return false;
    key.remove_prefix(end + 1);
  }
  return key.empty() || key == fmt::format(" from {}", fmt::join(trace.holds(0), ";"));
}

/// Describes why a trace of a journal is not one of the model; empty: it is, or that is not known.
std::string wrong_trace(const compiler::CompiledModel& model, const harness::CampaignTrace& trace,
                        const Context& context) {
  runtime::TraceReplay replay(model,
                              [&context] { return runtime::make_cadical_solver(&context.stop()); });
  const auto [least, most] = replay.lengths();
  const auto length = static_cast<compiler::Timepoint>(trace.event_count());
  if (length < least || length > most) {
    return fmt::format("no trace of the model has {} events", length);
  }
  if (!is_key_of(trace, trace.key)) return fmt::format("`{}` is not its key", trace.key);
  runtime::ClaimedTrace claimed;
  claimed.number = trace.number;
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    claimed.points.push_back({only(trace.holds(t)), only(trace.happens(t)), {}, {}});
  }
  using Kind = runtime::ReplayVerdict::Kind;
  const auto verdict = replay.replay(claimed);
  if (verdict.kind == Kind::kFails) {
    return fmt::format("the model has no trace that goes so up to timepoint {}", verdict.timepoint);
  }
  // A run with --hits=all has traces that go on behind their first hit.
  if (verdict.kind == Kind::kNoFirstHit && verdict.timepoint == length) {
    return "the state constraints do not hold at its end";
  }
  return {};
}

/// Describes the first wrong call, as far as calls do not depend on the plan's arguments; empty:
/// none.
std::string wrong_calls(const harness::Scenario& scenario, const harness::TraceLine& line) {
  for (std::size_t t = 0; t < line.calls.size(); ++t) {
    const auto event = harness::ground_fluent(line.trace->event(t));
    const auto& actions = scenario.actions;
    const auto action = std::find_if(actions.begin(), actions.end(), [&](const auto& binding) {
      return binding.event == event.symbol;
    });
    const auto& call = line.calls[t];
    if (action == actions.end() ||
        harness::with_arguments(action->controller, event) != call.controller ||
        action->time_limit_s != call.time_limit_s) {
      return fmt::format("`{}` is not what the scenario does for `{}`", call.controller,
                         event.text);
    }
  }
  return {};
}

/// The sampler for the starts of the trace's simulations; ids are the model's. None: nothing can
/// draw them.
std::optional<harness::Sampler> sampler_of(const harness::Scenario& scenario,
                                           const harness::CampaignTrace& trace) {
  base::DiagnosticSink unread;
  const harness::ModelFluents fluents(*trace.symbols);
  const auto holds = trace.holds(0);
  auto sampler = harness::start_sampler(scenario, fluents.ground(),
                                        std::set<std::string>(holds.begin(), holds.end()), unread);
  if (!sampler) return std::nullopt;
  return *std::move(sampler);
}

std::string wrong_start(const std::optional<harness::Sampler>& sampler,
                        const harness::SampleRecord& record, std::uint64_t seed,
                        const harness::CampaignTrace& trace) {
  if (!sampler) return "its trace starts where no start can be drawn";
  return harness::wrong_draw(record, *sampler, seed, base::fnv1a64(trace.key));
}

}  // namespace

/// Holds what a scenario of kept texts needs as long as it is used.
struct KeptTexts {
  explicit KeptTexts(const std::string& purpose) : folder(purpose) {}

  base::TemporaryFolder folder;
  base::SourceFiles unmapped;  // the model has views into these
};

namespace {

/// Gives the texts the names that the run knew them by. Those from `stale` to `fresh`, of the files
/// as they are now, lose theirs: whoever looks for a name is to find what was run.
void map_names(const compiler::PathMap& map, std::size_t stale, std::size_t fresh, Context& context,
               KeptTexts& kept) {
  kept.unmapped = std::move(context.files());
  base::SourceFiles mapped;
  for (std::uint32_t i = 0; i < kept.unmapped.size(); ++i) {
    const auto& file = kept.unmapped[base::FileId(i)];
    const bool is_stale = i >= stale && i < fresh;
    mapped.add(is_stale ? file.name() + " (not as it was run)" : map.mapped(file.name()),
               std::string(file.text()));
  }
  for (const auto& input : kept.unmapped.inputs()) {
    if (map.mapped(input) == input) mapped.note_input(input);
  }
  context.files() = std::move(mapped);
}

/// The scenario as the run folder has it; none if it has not, or cannot be loaded. Then nothing is
/// reported. `stale`: number of the first text that was read of the files as they are now.
std::optional<ScenarioModel> load_kept_scenario(const std::string& folder,
                                                const harness::JournalHeader& header,
                                                const ScenarioNeeds& needs, std::size_t stale,
                                                Context& context) {
  auto kept = std::make_shared<KeptTexts>("inputs");
  if (kept->folder.path().empty()) return std::nullopt;
  const auto root = kept->folder.path() / "run";
  const auto unpacked = unpack_inputs(folder, header.scenario_hash, header.scenario, root);
  if (!unpacked) return std::nullopt;
  const auto before = context.sink();
  const auto fresh = context.files().size();
  auto loaded = load_scenario_model(unpacked->scenario, context, needs);
  if (!loaded || !harness::scenario_change(header, loaded->sources_hash).empty()) {
    context.sink() = before;
    return std::nullopt;
  }
  compiler::PathMap map{fs::path()};
  map.add(root.string() + "=" + unpacked->named);
  map_names(map, stale, fresh, context, *kept);
  compiler::map_paths(loaded->compilation.model, map);
  loaded->scenario.name = header.scenario;
  loaded->kept = std::move(kept);
  return *std::move(loaded);
}

}  // namespace

fs::path scenario_path(const harness::JournalHeader& header) {
  const fs::path named(header.scenario);
  if (header.start_folder.empty() || named.is_absolute()) return named;
  std::error_code error;
  const fs::path start(header.start_folder);
  // Where the run was started it is called as it was then.
  if (fs::equivalent(start, fs::current_path(error), error)) return named;
  return is_file(start / named) || !is_file(named) ? start / named : named;
}

std::optional<harness::Comparison> recorded_comparison(const harness::JournalHeader& header) {
  return header.asked.compare;
}

harness::Execution recorded_execution(const harness::JournalHeader& header) {
  return header.asked.execution;
}

RunFolderOptions found_again(const std::string& folder, const ScenarioModel& loaded) {
  if (loaded.kept) return {folder, {}};
  return {folder, loaded.scenario.file.string()};
}

base::Result<ScenarioModel> load_recorded_scenario(const RunFolderOptions& options,
                                                   const harness::JournalHeader& header,
                                                   ScenarioUse use, Context& context) {
  auto& sink = context.sink();
  const bool is_recorded = options.scenario.empty();
  const auto path = is_recorded ? scenario_path(header) : fs::path(options.scenario);
  const auto refuse = [&](const std::string& why) {
    return sink.error_about(codes::kReplayImpossible, options.folder, why);
  };
  const auto before = sink;
  const auto first_text = context.files().size();
  const ScenarioNeeds needs{.as_run = true,
                            .execution = recorded_execution(header),
                            .plain = use == ScenarioUse::kExplain};
  const auto kept = [&]() -> std::optional<ScenarioModel> {
    if (!is_recorded || !options.may_use_kept) return std::nullopt;
    auto found = load_kept_scenario(options.folder, header, needs, first_text, context);
    if (found) {
      context.remark(fmt::format(
          "{} or a file that it reads is not as it was run; the texts that the run kept count",
          base::printable(header.scenario)));
    }
    return found;
  };
  if (is_recorded && !is_file(path)) {
    if (auto found = kept()) return *std::move(found);
    return refuse(fmt::format("there is no scenario `{}`", base::printable(path.string())));
  }
  auto loaded = load_scenario_model(path, context, needs);
  const auto change =
      loaded ? harness::scenario_change(header, loaded->sources_hash) : std::string();
  if (loaded && change.empty()) {
    const auto command = harness::hash_of_command(loaded->scenario.simulator.command);
    if (harness::command_changed(header, command)) {
      sink.error_about(codes::kSimulatorFilesChanged, options.folder);
    }
    if (is_recorded && path != fs::path(header.scenario)) {
      context.remark(
          fmt::format("the scenario is {}, where the run was started; --scenario names another",
                      base::printable(path.string())));
    }
    return loaded;
  }
  const auto said = sink.sorted();
  const bool outside = std::any_of(said.begin(), said.end(), [](const auto& diagnostic) {
    return diagnostic.code == codes::kLoadOutside;
  });
  if (is_recorded) sink = before;
  if (auto found = kept()) return *std::move(found);
  if (!loaded && !is_recorded) return sink.already_reported();
  const auto name = base::printable(path.string());
  if (loaded) {
    return refuse(fmt::format(
        "{}; as it is now it is run by `parallax run {} --out DIR`, DIR being a new folder", change,
        name));
  }
  if (outside) {
    return refuse(fmt::format(
        "the scenario `{}` reads a file that lies outside of its folder, which --allow-outside "
        "permits; `parallax check {}` says which",
        name, name));
  }
  return refuse(fmt::format(
      "the scenario `{}` cannot be loaded any more; `parallax check {}` says why", name, name));
}

base::Status expect_traces(const RunFolderOptions& options, const harness::JournalHeader& header,
                           base::DiagnosticSink& sink) {
  if (!header.asked.random_sequences) return base::Unit{};
  return sink.error_about(codes::kReplayImpossible, options.folder,
                          "it has random sequences of events, which no trace of the model and no "
                          "plan has; `parallax replay` repeats them");
}

base::Result<harness::CampaignTrace> check_recorded_run(const ScenarioModel& loaded,
                                                        const harness::RecordedRun& run,
                                                        Context& context) {
  auto& sink = context.sink();
  const auto foreign = [&](const base::SourceRange& line, const std::string& why) {
    return sink.error(codes::kForeignJournalLine, line, why);
  };
  const auto& model = loaded.compilation.model;
  auto trace = in_ids_of(model, *run.line.trace);
  if (!trace) return foreign(run.trace_source, "it names what the model has not");
  auto why = wrong_calls(loaded.scenario, run.line);
  if (why.empty() && run.record.path) {
    // An executed plan has no trace: its course need not be one that the model admits.
    const auto check = ExecutionCheck::make(loaded, run.header.seed, context);
    if (!check) return sink.already_reported();
    if (*check) why = (*check)->wrong(run.record);
    if (!why.empty()) return foreign(run.source, why);
    return *std::move(trace);
  }
  if (why.empty() && !run.header.asked.random_sequences) why = wrong_trace(model, *trace, context);
  if (!why.empty()) return foreign(run.trace_source, why);
  why = wrong_start(sampler_of(loaded.scenario, *trace), run.record, run.header.seed, *trace);
  if (!why.empty()) return foreign(run.source, why);
  return *std::move(trace);
}

base::Status check_recorded_starts(const ScenarioModel& loaded, const harness::JournalText& journal,
                                   Context& context) {
  auto& sink = context.sink();
  std::map<harness::StartKey, std::optional<harness::Sampler>> samplers;
  for (const auto& [key, record] : journal.samples) {
    const auto* line = journal.find_line_of(record);
    if (record.path || record.phase != harness::DrawPhase::kCertify) continue;
    if (line == nullptr) continue;
    const auto& recorded = *line->trace;
    const harness::StartKey start(record.trace, record.start_state);
    if (!samplers.contains(start)) {
      const auto trace = in_ids_of(loaded.compilation.model, recorded);
      if (!trace) {
        return sink.error(codes::kForeignJournalLine, journal.line_place_of(record),
                          "it names what the model has not");
      }
      samplers.emplace(start, sampler_of(loaded.scenario, *trace));
    }
    const auto why = wrong_start(samplers.at(start), record, journal.header->seed, recorded);
    if (why.empty()) continue;
    return sink.error(codes::kForeignJournalLine, journal.places.at(key), why);
  }
  return base::Unit{};
}

}  // namespace parallax::tools
