#include "tools/app/scenario_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <system_error>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "compiler/base/ground_name.h"
#include "compiler/plan/plan_files.h"
#include "compiler/syntax/lexer.h"
#include "harness/campaign/campaign.h"
#include "harness/campaign/replay.h"
#include "harness/config/load_limits.h"
#include "harness/discrete/model_simulator.h"
#include "harness/simulator/command_files.h"
#include "tools/app/edited_scenario.h"
#include "tools/app/file_kind.h"
#include "tools/app/region_locator.h"
#include "tools/app/start_weights.h"
#include "tools/app/version.h"
#include "tools/app/world_model.h"

namespace parallax::tools {

namespace {

/// Traces are to end where the property does not hold, also right at the start.
base::Status look_for_violations(const std::string& property, compiler::CompileInput& input,
                                 Context& context) {
  const auto range = formula_argument("--property", property, context);
  if (!range) return context.sink().already_reported();
  input.constraints = {{*range, *range, true}};
  input.hits_at_start = true;
  return base::Unit{};
}

base::Status add_objectives(const std::vector<std::string>& objectives,
                            compiler::CompileInput& input, Context& context) {
  for (const auto& objective : objectives) {
    const auto range = formula_argument("--minimize", objective, context);
    if (!range) return context.sink().already_reported();
    input.objectives.push_back(*range);
  }
  return base::Unit{};
}

}  // namespace

compiler::ConstraintText constraint_text(const harness::LocatedText& text,
                                         base::SourceFiles& files) {
  const auto size = static_cast<std::uint32_t>(text.text.size());
  const auto offset = files.text(text.source).find(text.text);
  if (offset != std::string_view::npos) {
    const auto begin = text.source.begin + static_cast<std::uint32_t>(offset);
    const base::SourceRange range{text.source.file, begin, begin + size};
    return {range, range, false};
  }
  const auto file = files.add(files[text.source.file].name(), text.text);
  return {{file, 0, size}, text.source, false};
}

base::Result<std::vector<base::FileId>> load_scenario_plan(const harness::Scenario& scenario,
                                                           Context& context) {
  base::PathGate gate(context.form().allow_outside, &context.files());
  gate.admit_beside(scenario.file);
  std::vector<compiler::PlanEntry> paths;
  for (const auto& plan : scenario.plan) paths.push_back({plan.text, plan.source});
  return compiler::load_plan_files(paths, gate, context.files(), context.sink());
}

namespace {

/// Steps of unrolling grow with the locations that are asked for.
compiler::UnrollLimits plan_limits(const ModelOptions& options) {
  constexpr std::int64_t kSteps = 250;  // for each location
  auto limits = options.unroll;
  limits.max_steps = std::max(limits.max_steps, kSteps * limits.max_locations);
  return limits;
}

base::Result<compiler::CompileInput> compile_input(const harness::Scenario& scenario,
                                                   const RegionLocator& locator, Context& context) {
  auto& files = context.files();
  auto& sink = context.sink();
  compiler::CompileInput input;
  for (const auto& model : scenario.models) input.models.emplace_back(model.text);
  input.load.named_by = {scenario.file};
  input.load.allow_outside = context.form().allow_outside;
  input.horizon = scenario.horizon;
  input.ground.stop = &context.stop();
  input.producer = fmt::format("parallax {}", kVersion);
  for (const auto& text : scenario.constraints) {
    input.constraints.push_back(constraint_text(text, files));
  }
  if (!scenario.plan.empty()) {
    const auto plan = load_scenario_plan(scenario, context);
    const auto bind = base::load_text(scenario.bind->text, files, sink);
    if (!plan || !bind) return sink.already_reported();
    input.plan = compiler::PlanInput{*plan, *bind, std::nullopt, &locator};
  }
  return input;
}

/// Applies the options of the command line that go for a scenario: how its plan is unrolled, where
/// `load` looks, and another horizon.
void apply_given(const ModelOptions& given, compiler::CompileInput& input) {
  for (const auto& folder : given.include_dirs) input.load.include_dirs.emplace_back(folder);
  if (given.horizon >= 0) input.horizon = given.horizon;
  if (!input.plan) return;
  input.plan->limits = plan_limits(given);
  input.plan->interleave = given.par == "interleave";
}

/// How a model is compiled beyond what the user says.
struct Switches {
  bool costs = false;
  std::string emit_pass = {};
  bool folded = false;
  ScenarioNeeds needs = {};
  const ModelOptions* given = nullptr;  // with a scenario
  void apply(compiler::CompileInput& input) const {
    input.costs = costs;
    input.emit_pass = emit_pass;
    input.folded = folded;
    input.lint = input.lint || needs.lint;
    if (given != nullptr) apply_given(*given, input);
    if (needs.horizon) input.horizon = *needs.horizon;
    if (!needs.with_plan) input.plan.reset();
    if (!needs.plain) return;
    input.ground.relevance = false;
    input.ground.invariants = false;
  }
};

std::vector<harness::GroundFluent> ground_fluents(const std::vector<std::string>& names) {
  std::vector<harness::GroundFluent> out;
  for (const auto& name : names) out.push_back(harness::ground_fluent(name));
  return out;
}

/// Notes the files that the simulator's command names: with another program the results may differ.
void note_command(const std::vector<std::string>& command, base::SourceFiles& files) {
  const auto named = harness::files_of_command(command);
  for (const auto* places : {&named.found, &named.absent}) {
    for (const auto& place : *places) files.note_input(place);
  }
}

/// An executed plan goes on to its end, whether or not the constraints hold on its way.
void execute(const harness::Scenario& scenario, compiler::CompileInput& input) {
  input.plan->failures_by_reason = true;
  input.constraints.clear();
  input.horizon.reset();
  if (scenario.limits.max_performs > 0) input.horizon = scenario.limits.max_performs;
}

base::Result<ScenarioModel> load(const std::filesystem::path& path, Context& context,
                                 const Switches& switches,
                                 const std::optional<std::string>& property = std::nullopt,
                                 const std::vector<std::string>& minimize = {}, bool best = false) {
  auto& sink = context.sink();
  const auto& needs = switches.needs;
  if (!expect_kind(path.string(), {FileKind::kScenario}, "a scenario", context)) {
    return sink.already_reported();
  }
  const auto first = context.files().size();  // what was read before is no part of it
  auto scenario = harness::load_scenario(
      path, context.files(), sink,
      harness::LoadLimits{context.form().allow_outside, &context.stop(), needs.settings});
  if (!scenario) return sink.already_reported();
  auto scenario_hash = harness::hash_of_sources(context.files(), first);
  note_command(scenario->simulator.command, context.files());
  const RegionLocator locator(scenario->mapping->regions());
  auto input = compile_input(*scenario, locator, context);
  if (!input) return sink.already_reported();
  switches.apply(*input);
  if (needs.execution) scenario->execution = *needs.execution;
  const bool closed = needs.as_run && scenario->execution == harness::Execution::kClosedLoop;
  if (closed && switches.given != nullptr && switches.given->horizon >= 0) {
    return sink.error_about(codes::kUsage, path.string(),
                            "an executed plan goes on to its end: --horizon does not go with it");
  }
  if (closed) {
    if (!input->plan) {
      const auto& key = scenario->execution_source;
      const bool written = !needs.execution;
      return sink.error(codes::kNoPlanToExecute,
                        written ? key : base::SourceRange{scenario->source, 0, 0});
    }
    execute(*scenario, *input);
  } else if (needs.watched && input->plan) {
    input->plan->failures_by_reason = scenario->execution == harness::Execution::kClosedLoop;
  }
  if (property && !look_for_violations(*property, *input, context)) {
    return sink.already_reported();
  }
  if (!add_objectives(minimize, *input, context)) return sink.already_reported();
  input->objectives_of_model = best;
  auto compilation = compiler::compile_model(*input, context.files(), sink);
  if (!compilation) return sink.already_reported();
  if (!scenario->start_weights.empty() &&
      !check_start_weights(*scenario, *compilation->typed, context)) {
    return sink.already_reported();
  }
  const bool other_horizon = switches.given != nullptr && switches.given->horizon >= 0;
  if (closed || other_horizon) scenario->horizon = compilation->model.horizon;
  const auto fluents = compiler::names_of(compilation->model.fluents);
  auto events = compiler::names_of(compilation->model.events);
  std::shared_ptr<const harness::SteppedModel> world;
  std::string world_hash;
  if (!scenario->simulator.models.empty()) {
    const auto before = context.files().size();
    auto loaded = load_world_model(*scenario, context);
    if (!loaded) return sink.already_reported();
    world = *std::move(loaded);
    world_hash = harness::hash_of_sources(context.files(), before);
    const auto info = harness::ModelSimulator::info_of(*world);
    if (!harness::bind_by_name(*scenario, fluents, events, info, sink) ||
        !harness::check_against_simulator(*scenario, ground_fluents(fluents), info, sink)) {
      return sink.already_reported();
    }
  }
  if (needs.watched) {
    std::erase_if(events, [&](const std::string& event) {
      const auto symbol = base::symbol_of(event);
      const auto& unobserved = scenario->unobserved;
      const auto& actions = scenario->actions;
      return std::find(unobserved.begin(), unobserved.end(), symbol) != unobserved.end() &&
             std::none_of(actions.begin(), actions.end(),
                          [&](const auto& action) { return action.event == symbol; });
    });
  }
  if (!harness::check_against_model(*scenario, fluents, events, sink)) {
    return sink.already_reported();
  }
  return ScenarioModel{*std::move(scenario),
                       *std::move(compilation),
                       harness::hash_of_sources(context.files(), first),
                       std::move(scenario_hash),
                       std::move(world),
                       std::move(world_hash)};
}

/// Reads plan, binding table and regions; without --regions no pose lies anywhere. `regions` holds
/// what the locator points to.
base::Status add_plan(const ModelOptions& options, std::optional<harness::Scenario>& regions,
                      std::optional<RegionLocator>& locator, compiler::CompileInput& input,
                      Context& context) {
  auto& sink = context.sink();
  static const harness::RegionMap kNowhere{harness::RegionSet()};
  if (!options.regions.empty()) {
    auto scenario =
        harness::load_scenario(options.regions, context.files(), sink,
                               harness::LoadLimits{context.form().allow_outside, &context.stop()});
    if (!scenario) return sink.already_reported();
    regions = *std::move(scenario);
  }
  locator.emplace(regions ? regions->mapping->regions() : kNowhere);
  std::vector<compiler::PlanEntry> paths;
  base::PathGate gate(context.form().allow_outside, &context.files());
  for (const auto& path : options.plan) {
    paths.push_back({path, std::nullopt});
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) {
      gate.admit_from(path);
    } else {
      // The user named it, whatever it leads to.
      gate.admit_folder(path);
    }
  }
  const auto plan = compiler::load_plan_files(paths, gate, context.files(), sink);
  const auto bind = base::load_text(options.bind, context.files(), sink);
  if (!plan || !bind) return sink.already_reported();
  input.plan = compiler::PlanInput{.plan = *plan,
                                   .binding = *bind,
                                   .entry = std::nullopt,
                                   .locator = &*locator,
                                   .limits = plan_limits(options),
                                   .interleave = options.par == "interleave",
                                   .max_horizon = options.max_horizon};
  if (!options.plan_entry.empty()) input.plan->entry = options.plan_entry;
  return base::Unit{};
}

/// Is every file what its place on the command line asks for?
base::Status expect_kinds(const ModelOptions& options, Context& context) {
  auto& sink = context.sink();
  const auto errors_before = sink.error_count();
  for (const auto& path : options.models) {
    (void)expect_kind(path, {FileKind::kModel}, "a model", context);
  }
  for (const auto& path : options.plan) {
    (void)expect_kind(path, {FileKind::kPlan}, "a plan", context);
  }
  if (!options.plan.empty()) {
    (void)expect_kind(options.bind, {FileKind::kBinding}, "a binding table", context);
  }
  if (!options.regions.empty()) {
    (void)expect_kind(options.regions, {FileKind::kScenario}, "a scenario", context);
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return base::Unit{};
}

base::Result<compiler::Compilation> compile(const ModelOptions& options, Context& context,
                                            const Switches& switches) {
  const auto& first = options.models.front();
  if (names_artifact(options)) {
    auto model = load_artifact(options, context);
    if (!model) return context.sink().already_reported();
    compiler::Compilation compiled;
    compiled.model = *std::move(model);
    return compiled;
  }
  if (options.models.size() == 1 && (first.ends_with(".yaml") || first.ends_with(".yml"))) {
    if (!fits_scenario(options, context)) return context.sink().already_reported();
    auto with_options = switches;
    with_options.given = &options;
    auto loaded =
        load(first, context, with_options, options.property, options.minimize, options.best);
    if (!loaded) return context.sink().already_reported();
    return std::move(loaded->compilation);
  }
  if (!expect_kinds(options, context)) return context.sink().already_reported();
  auto input = compile_input(options, context);
  switches.apply(input);
  for (const auto& formula : options.until) {
    const auto range = formula_argument("--until", formula, context);
    if (!range) return context.sink().already_reported();
    input.constraints.push_back({*range, *range, false});
    input.hits_at_start = true;
  }
  if (!add_objectives(options.minimize, input, context)) return context.sink().already_reported();
  std::optional<harness::Scenario> regions;
  std::optional<RegionLocator> locator;
  if (!options.plan.empty() && !add_plan(options, regions, locator, input, context)) {
    return context.sink().already_reported();
  }
  if (options.property && !look_for_violations(*options.property, input, context)) {
    return context.sink().already_reported();
  }
  return compiler::compile_model(input, context.files(), context.sink());
}

}  // namespace

base::Result<ScenarioModel> load_scenario_model(const std::filesystem::path& path, Context& context,
                                                const ScenarioNeeds& needs) {
  return load(path, context, {.needs = needs, .given = needs.given});
}

std::optional<compiler::CompiledModel> compile_variant(const harness::Scenario& scenario,
                                                       std::int64_t horizon, bool with_plan,
                                                       Context& context) {
  Context own(context.form(), context.stop());
  auto loaded = load_scenario_model(scenario.file, own,
                                    {.execution = scenario.execution,
                                     .watched = true,
                                     .with_plan = with_plan,
                                     .horizon = horizon});
  if (!loaded) return std::nullopt;
  return std::move(loaded->compilation.model);
}

base::Result<compiler::Compilation> compile_with_model(const harness::Scenario& scenario,
                                                       std::string model,
                                                       harness::Execution execution,
                                                       bool constraints, Context& context) {
  const RegionLocator locator(scenario.mapping->regions());
  auto input = compile_input(scenario, locator, context);
  if (!input) return context.sink().already_reported();
  input->text = context.files().add("edited.e", std::move(model));
  if (execution == harness::Execution::kClosedLoop && input->plan) execute(scenario, *input);
  if (!constraints) input->constraints.clear();
  return compiler::compile_model(*input, context.files(), context.sink());
}

base::Result<compiler::Compilation> compile_edited(const harness::Scenario& scenario,
                                                   const EditedTexts& texts, Context& context) {
  const RegionLocator locator(scenario.mapping->regions());
  auto input = compile_input(scenario, locator, context);
  if (!input) return context.sink().already_reported();
  if (texts.model) input->text = context.files().add("edited.e", *texts.model);
  if (input->plan) {
    for (auto& file : input->plan->plan) {
      const auto& name = context.files()[file].name();
      const auto edited = texts.plan.find(name);
      if (edited != texts.plan.end()) file = context.files().add(name, edited->second);
    }
  }
  auto constraints = std::move(input->constraints);
  input->constraints.clear();
  if (scenario.execution == harness::Execution::kClosedLoop && input->plan) {
    execute(scenario, *input);
  }
  if (texts.horizon) input->horizon = *texts.horizon;
  if (texts.constraints) input->constraints = std::move(constraints);
  if (!texts.property.empty() && !look_for_violations(texts.property, *input, context)) {
    return context.sink().already_reported();
  }
  return compiler::compile_model(*input, context.files(), context.sink());
}

base::Result<compiler::Compilation> compile_models(const ModelOptions& options, Context& context) {
  return compile(options, context, {options.stats, options.emit_pass, options.folded});
}

base::Result<compiler::Compilation> compile_plain_models(const ModelOptions& options,
                                                         Context& context) {
  return compile(options, context, {.needs = {.plain = true}});
}

base::Result<base::SourceRange> formula_argument(const std::string& option, const std::string& text,
                                                 Context& context) {
  using compiler::Lexer;
  auto& files = context.files();
  const auto file = files.add(option, text);
  const base::SourceRange range{file, 0, static_cast<std::uint32_t>(text.size())};
  base::DiagnosticSink unread;  // whoever parses the formula reports what is wrong with it
  const Lexer lexer(range, files[file].text(), Lexer::Mode::kFormulaOnly, unread);
  if (lexer.peek().kind == compiler::TokenKind::kEnd && unread.error_count() == 0) {
    return context.sink().error_about(codes::kUsage, option, "the formula is empty");
  }
  return range;
}

}  // namespace parallax::tools
