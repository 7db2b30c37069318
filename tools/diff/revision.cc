#include "tools/diff/revision.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "compiler/artifact/artifact_writer.h"
#include "compiler/base/ascii.h"
#include "compiler/base/codes/artifacts.h"
#include "compiler/base/file_io.h"
#include "compiler/base/ground_name.h"
#include "compiler/compare/model_facts.h"
#include "compiler/compare/plan_calls.h"
#include "harness/simulator/command_files.h"
#include "tools/app/plan_reservations.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;
using compiler::Fact;
using compiler::FactKind;

/// The facts of model texts that are known to be valid: everything about them was reported before.
void add_text_facts(const std::vector<std::string>& models, const compiler::LoadOptions& load,
                    std::vector<Fact>& facts) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const std::vector<fs::path> paths(models.begin(), models.end());
  const auto ast = compiler::load_model(paths, load, files, sink);
  if (!ast) return;
  auto more = compiler::model_facts(*ast, files);
  facts.insert(facts.end(), more.begin(), more.end());
}

base::Result<ModelRevision> load_texts(const std::string& path, const LoadRevision& options,
                                       Context& context) {
  ModelRevision out{path, RevisionKind::kModel, {}, std::nullopt, std::nullopt, true};
  auto model = options.model;
  model.models.insert(model.models.begin(), path);
  const auto load = compile_input(model, context).load;
  if (options.compile) {
    auto compilation = compile_models(model, context);
    if (!compilation) return context.sink().already_reported();
    out.reservation = reservations_of(*compilation).words();
    out.compiled = std::move(compilation->model);
    add_text_facts(model.models, load, out.facts);
    return out;
  }
  const std::vector<fs::path> paths(model.models.begin(), model.models.end());
  const auto ast = compiler::load_model(paths, load, context.files(), context.sink());
  if (!ast || context.sink().has_errors()) return context.sink().already_reported();
  out.facts = compiler::model_facts(*ast, context.files());
  return out;
}

base::Result<ModelRevision> load_compiled(const std::string& path, const LoadRevision& options,
                                          Context& context) {
  ModelRevision out{path, RevisionKind::kArtifact, {}, std::nullopt, std::nullopt, false};
  auto model = compiler::load_artifact(path, context.files(), context.sink());
  if (!model) return context.sink().already_reported();
  const auto horizon = options.model.horizon;
  if (horizon > model->horizon) {
    return context.sink().error_about(
        codes::kHorizonNotExtensible, path, horizon,
        fmt::format("it was compiled for the horizon {}", model->horizon));
  }
  if (goes_behind_cut(*model)) out.reservation = PlanReservations{.cut = true}.words();
  out.compiled = *std::move(model);
  use_artifact_facts(out);
  return out;
}

/// Adds the facts of a world that is a model, each marked as the world's. They have no part in the
/// traces.
void add_world_facts(const harness::Scenario& scenario, const compiler::LoadOptions& load,
                     std::vector<Fact>& facts) {
  std::vector<std::string> models;
  for (const auto& model : scenario.simulator.models) models.push_back(model.text);
  if (models.empty()) return;
  std::vector<Fact> world;
  add_text_facts(models, load, world);
  for (auto& fact : world) {
    for (auto* text : {&fact.key, &fact.text, &fact.shown}) {
      if (!text->empty()) text->insert(0, kWorldFact);
    }
    facts.push_back(std::move(fact));
  }
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// Where the side has the file that a word of a command names.
std::string word_of_side(const std::string& word, const CommandFolder& side) {
  std::vector<fs::path> places;
  for (const auto& folder : side.current) {
    auto place = (folder / word).lexically_normal();
    const auto lies_in = [&](const fs::path& root) {
      return std::mismatch(root.begin(), root.end(), place.begin(), place.end()).first ==
             root.end();
    };
    const auto other = std::find_if(side.others.begin(), side.others.end(), lies_in);
    if (!lies_in(side.root) && other != side.others.end()) {
      place = side.root / place.lexically_relative(*other);
    }
    places.push_back(std::move(place));
  }
  places.push_back(side.root / word);
  const auto found = std::find_if(places.begin(), places.end(), is_file);
  return (found == places.end() ? places.front() : *found).string();
}

/// Adds the hash of the files that an external simulator's command names. The command's words are
/// a setting of their own.
void add_command_files(const std::string& path, const harness::Scenario& scenario,
                       const std::optional<CommandFolder>& side,
                       harness::ScenarioSettings& settings) {
  const auto& command = scenario.simulator.command;
  if (command.empty()) return;
  harness::insert(settings, {{"simulator", "command", "files"},
                             "SHA-256 " + hash_of_command(command, side),
                             std::nullopt,
                             true,
                             path,
                             0});
}

/// Does the action of the event take the plan's argument?
bool takes_from_plan(const harness::Scenario& scenario, const std::string& event,
                     const std::string& argument) {
  const auto symbol = base::symbol_of(event);
  for (const auto& action : scenario.actions) {
    if (action.event != symbol || !action.from_plan) continue;
    return std::any_of(action.from_plan->begin(), action.from_plan->end(), [&](const auto& taken) {
      return argument == taken.first || argument.starts_with(taken.first + '.');
    });
  }
  return true;
}

/// Adds what the plan hands to controllers, which overrides the arguments under `actions`.
void add_plan_calls(const harness::Scenario& scenario, const compiler::CompiledModel& model,
                    harness::ScenarioSettings& settings) {
  const auto calls = compiler::plan_calls(model);
  std::set<std::string> seen;
  for (const auto& call : calls) {
    if (!seen.insert(call.event).second) continue;
    for (const auto& [name, value] : compiler::call_values(calls, call.event)) {
      if (!takes_from_plan(scenario, call.event, name)) continue;
      harness::insert(settings, {{"actions", call.event, "from the plan", name},
                                 value,
                                 std::nullopt,
                                 true,
                                 call.place.file,
                                 call.place.line});
    }
  }
}

base::Result<ModelRevision> load_scenario_revision(const std::string& path,
                                                   const LoadRevision& options, Context& context) {
  ModelRevision out{path, RevisionKind::kScenario, {}, harness::ScenarioSettings(), std::nullopt,
                    false};
  auto loaded = load_scenario_model(path, context, {.settings = &*out.settings});
  if (!loaded) return context.sink().already_reported();
  const auto& scenario = loaded->scenario;
  add_command_files(path, scenario, options.commands, *out.settings);
  out.command = options.commands ? command_of(scenario.simulator.command, *options.commands)
                                 : scenario.simulator.command;
  std::vector<std::string> models;
  for (const auto& model : scenario.models) models.push_back(model.text);
  compiler::LoadOptions load;
  load.named_by = {path};
  load.allow_outside = context.form().allow_outside;
  add_text_facts(models, load, out.facts);
  if (scenario.initial == harness::Initial::kFirst) {
    out.facts.push_back(compiler::declaration_order(out.facts));
  }
  if (!scenario.plan.empty()) {
    const auto files = load_scenario_plan(scenario, context);
    if (!files) return context.sink().already_reported();
    const auto lisp = compiler::read_lisp(context.files(), *files, context.sink());
    if (!lisp) return context.sink().already_reported();
    const auto plan = compiler::plan_facts(*lisp, context.files());
    out.facts.insert(out.facts.end(), plan.begin(), plan.end());
    const auto bind = load_plan_revision(scenario.bind->text, RevisionKind::kBinding, context);
    if (!bind) return context.sink().already_reported();
    out.facts.insert(out.facts.end(), bind->facts.begin(), bind->facts.end());
  }
  for (const auto& constraint : scenario.constraints) {
    const auto& file = context.files()[constraint.source.file];
    out.facts.push_back({FactKind::kAxiom,
                         "",
                         "constraint " + constraint.text,
                         "constraint " + constraint.text,
                         {file.name(), file.position(constraint.source.begin).line}});
  }
  add_world_facts(scenario, load, out.facts);
  add_plan_calls(scenario, loaded->compilation.model, *out.settings);
  out.reservation = reservations_of(loaded->compilation).words();
  out.compiled = std::move(loaded->compilation.model);
  return out;
}

}  // namespace

std::optional<RevisionKind> kind_of(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return RevisionKind::kRun;
  const auto name = fs::path(path).filename().string();
  if (name == "report.json") return RevisionKind::kRun;
  if (compiler::is_artifact_name(name)) return RevisionKind::kArtifact;
  const auto extension = fs::path(path).extension().string();
  if (extension == ".e") return RevisionKind::kModel;
  // As suites find them.
  auto small = extension;
  std::transform(small.begin(), small.end(), small.begin(), base::to_lower);
  if (small == ".yaml" || small == ".yml") return RevisionKind::kScenario;
  if (extension == ".lisp") return RevisionKind::kPlan;
  if (extension == ".bind") return RevisionKind::kBinding;
  if (extension == ".json") return RevisionKind::kRates;
  if (extension == ".jsonl" || extension == ".ndjson") return RevisionKind::kTraces;
  return std::nullopt;
}

bool has_traces(RevisionKind kind) {
  return kind == RevisionKind::kModel || kind == RevisionKind::kArtifact ||
         kind == RevisionKind::kScenario;
}

std::vector<std::string> command_of(std::vector<std::string> command, const CommandFolder& side) {
  for (std::size_t i = 0; i < command.size(); ++i) {
    // A program without a slash is looked up in PATH.
    const bool is_file_name = i > 0 || command[i].find('/') != std::string::npos;
    if (!is_file_name) continue;
    auto file = word_of_side(command[i], side);
    // One that only another side has is missing here.
    if (is_file(file) || is_file(command[i])) command[i] = std::move(file);
  }
  return command;
}

std::string hash_of_command(const std::vector<std::string>& command,
                            const std::optional<CommandFolder>& side) {
  return harness::hash_of_command(side ? command_of(command, *side) : command);
}

base::Result<ModelRevision> load_model_revision(const std::string& path, RevisionKind kind,
                                                const LoadRevision& options, Context& context) {
  if (kind == RevisionKind::kArtifact) return load_compiled(path, options, context);
  if (kind == RevisionKind::kScenario) return load_scenario_revision(path, options, context);
  return load_texts(path, options, context);
}

void use_artifact_facts(ModelRevision& revision) {
  revision.facts = compiler::artifact_facts(*revision.compiled);
  revision.is_text = false;
}

base::Result<PlanRevision> load_plan_revision(const std::string& path, RevisionKind kind,
                                              Context& context) {
  PlanRevision out{path, {}, std::nullopt};
  const auto file = base::load_text(path, context.files(), context.sink());
  if (!file) return context.sink().already_reported();
  if (kind == RevisionKind::kBinding) {
    out.facts = compiler::binding_facts(*file, context.files());
    return out;
  }
  auto lisp = compiler::read_lisp(context.files(), *file, context.sink());
  if (!lisp) return context.sink().already_reported();
  out.facts = compiler::plan_facts(*lisp, context.files());
  out.lisp = *std::move(lisp);
  return out;
}

}  // namespace parallax::tools
