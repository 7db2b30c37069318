#include "compiler/pipeline/compile.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

#include "compiler/artifact/describe.h"
#include "compiler/base/codes/grounding.h"
#include "compiler/base/codes/names.h"
#include "compiler/base/codes/plans.h"
#include "compiler/base/contract.h"
#include "compiler/base/words.h"
#include "compiler/cnf/encoder.h"
#include "compiler/ground/check_grounding.h"
#include "compiler/ground/formula_grounder.h"
#include "compiler/ground/grounder.h"
#include "compiler/interpreter/unroller.h"
#include "compiler/lint/lint.h"
#include "compiler/pipeline/check_texts.h"
#include "compiler/pipeline/objective.h"
#include "compiler/pipeline/plan_encoder.h"
#include "compiler/pipeline/plan_formulas.h"
#include "compiler/pipeline/state_constraint.h"
#include "compiler/pipeline/temporal_encoder.h"
#include "compiler/plan/plan_binding.h"
#include "compiler/sema/check.h"
#include "compiler/sema/name_advice.h"
#include "compiler/syntax/parser.h"

namespace parallax::compiler {
namespace {

/// A plan, unrolled, with its formulas checked against the model.
struct CheckedPlan {
  PlanGraph graph;
  PlanFormulas formulas;
  std::set<std::string> events;
};

/// The constants that a variable of an entry can be: those of the sort of its place in the formula;
/// none if the formula says nothing of it.
std::optional<std::vector<std::string>> constants_of(const FormulaTree& formula,
                                                     std::string_view variable,
                                                     const TypedModel& model) {
  const auto sort = sort_by_use(model, formula, [&](const FormulaNode& node) {
    return node.leaf == LeafKind::kParameter &&
           formula.parameters[node.number].variable == variable;
  });
  if (!sort) return std::nullopt;
  std::vector<std::string> out;
  for (const auto& object : model.objects) {
    const auto fits = [&](SortId of) { return model.is_subsort(of, *sort); };
    if (std::any_of(object.sorts.begin(), object.sorts.end(), fits)) out.push_back(object.name);
  }
  return out;
}

/// The constants that the object of an entry can be.
base::Result<std::vector<std::string>> candidates(const ObjectBinding& binding,
                                                  const TypedModel& model,
                                                  base::DiagnosticSink& sink) {
  auto out = constants_of(binding.formula, binding.variable, model);
  if (out) return *std::move(out);
  return sink.error(codes::kBindingSyntax, binding.formula_source,
                    fmt::format("a formula that says something of {}", binding.variable),
                    "another one");
}

/// The range of `time` where nobody gives one: up to the longest path of the
/// plan.
void set_horizon(const PlanGraph& graph, std::int64_t max_horizon, TypedModel& model) {
  auto& time = model.sorts[*model.core.time];
  const bool given =
      time.ranges.size() != 1 || time.ranges[0].declared.begin != time.declared.begin;
  if (given) return;
  const auto longest = longest_path(graph).value_or(max_horizon);
  time.ranges[0].upper = std::clamp(longest, std::int64_t{1}, max_horizon);
}

std::string counted_arguments(std::size_t count) {
  if (count == 0) return "no arguments";
  return base::counted(count, "argument");
}

/// Reports why `entry` names no event of the model: a symbol of another kind, another number of
/// arguments, or a name that is not there.
base::DiagnosticBuilder report_performed(const BindingEntry& entry, const Symbol* symbol,
                                         base::DiagnosticSink& sink) {
  if (symbol == nullptr) {
    return sink.error(codes::kPlanEventUnknown, entry.source, entry.event_symbol);
  }
  if (symbol->kind != SymbolKind::kEvent) {
    return sink.error(codes::kPlanPerformsOther, entry.source, entry.event_symbol,
                      kind_word(symbol->kind));
  }
  return sink.error(codes::kPlanEventArity, entry.source, entry.event_symbol,
                    counted_arguments(entry.event_arguments.size()),
                    counted_arguments(symbol->arguments.size()));
}

/// Are the events that the plan performs events of the model, as far as one can tell from their
/// names? Reported at the binding table, where they are named.
base::Status check_performed(const PlanGraph& graph, const PlanBinding& binding,
                             const TypedModel& model, base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  constexpr std::array<SymbolKind, 1> kEvents = {SymbolKind::kEvent};
  for (const auto& entry : binding.entries) {
    if (entry.plan) continue;
    const auto performed = std::find_if(
        graph.locations.begin(), graph.locations.end(),
        [&](const auto& location) { return location.event_symbol == entry.event_symbol; });
    const auto symbol = model.find_symbol(entry.event_symbol);
    const bool fits = symbol && model.symbols[*symbol].kind == SymbolKind::kEvent &&
                      model.symbols[*symbol].arguments.size() == entry.event_arguments.size();
    if (performed == graph.locations.end() || fits) continue;
    auto error = report_performed(entry, symbol ? &model.symbols[*symbol] : nullptr, sink);
    error.note(performed->source, "performed here");
    const auto near = symbol ? symbol : NameAdvice(model, sink).symbol(entry.event_symbol, kEvents);
    if (!near) continue;
    const auto& found = model.symbols[*near];
    error.note(found.declared, fmt::format("`{}` declared here", signature(model, found)));
    if (!symbol) error.fix(NameAdvice::replace(entry.event_symbol, found.name));
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return base::Unit{};
}

/// Does the model know the regions that poses of the plan lie in? Reported where a region is said.
base::Status check_regions(const PlanGraph& graph, const PoseLocator& locator,
                           const TypedModel& model, base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  for (const auto& location : graph.locations) {
    for (const auto& node : location.event.nodes) {
      const auto name = location.event.name(node);
      if (name.empty() || model.find_object(name) || model.find_symbol(name)) continue;
      const auto place = locator.place_of(name);
      if (!place) continue;
      auto error = sink.error(codes::kUnknownName, *place, "constant", std::string(name), "");
      error.note(location.source, "a pose of this perform lies in it");
      if (const auto near = NameAdvice(model, sink).object(name)) {
        error.note(model.objects[*near].declared,
                   fmt::format("`{}` declared here", model.objects[*near].name));
        error.fix(NameAdvice::replace(name, model.objects[*near].name));
      }
    }
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return base::Unit{};
}

base::Result<CheckedPlan> check_plan(const PlanInput& input, const std::atomic<bool>* stop,
                                     TypedModel& model, base::SourceFiles& files,
                                     base::DiagnosticSink& sink) {
  auto binding = parse_plan_binding(files, input.binding, sink);
  if (!binding) return sink.already_reported();
  UnrollOptions options;
  auto plan_texts = input.plan;
  const auto beginning = base::one_line(input.entry.value_or(""));
  if (input.entry && (beginning.empty() || beginning.starts_with('('))) {
    options.entry_forms = plan_texts.emplace_back(files.add("--plan-entry", *input.entry));
  } else if (input.entry) {
    options.entry = beginning;
  }
  options.limits = input.limits;
  options.interleave = input.interleave;
  options.stop = stop;
  const auto& time = model.sorts[*model.core.time];
  if (time.ranges.size() == 1) options.horizon = time.ranges[0].upper;
  options.failures_by_reason = input.failures_by_reason;
  for (const auto& object : model.objects) options.constants.push_back(object.name);
  for (const auto& symbol : model.symbols) {
    if (symbol.kind == SymbolKind::kFluent) options.fluents.push_back(symbol.name);
  }
  for (const auto& object : binding->objects) {
    auto names = candidates(object, model, sink);
    if (!names) return sink.already_reported();
    options.candidates.push_back(*std::move(names));
  }
  for (const auto& query : binding->queries) {
    auto& variables = options.query_candidates.emplace_back();
    for (const auto& name : query.variables) {
      variables.push_back(
          constants_of(query.formula, name, model).value_or(std::vector<std::string>()));
    }
  }
  const NoRegions no_regions;
  const PoseLocator& locator = input.locator != nullptr ? *input.locator : no_regions;
  auto graph = unroll_plan(files, plan_texts, *binding, locator, options, sink);
  if (!graph || !check_performed(*graph, *binding, model, sink) ||
      !check_regions(*graph, locator, model, sink)) {
    return sink.already_reported();
  }
  auto formulas = check_plan_formulas(*graph, model, files, sink);
  if (!formulas) return sink.already_reported();
  std::set<std::string> events;
  for (const auto& entry : binding->entries) {
    if (!entry.plan) events.insert(entry.event_symbol);
  }
  return CheckedPlan{*std::move(graph), *std::move(formulas), std::move(events)};
}

/// Made on the tree: in a text the formula could end the negation early.
NodeId negation(Ast& ast, NodeId formula) {
  Node node;
  node.kind = NodeKind::kUnary;
  node.op = Operator::kNot;
  node.begin = ast[formula].begin;
  node.end = ast[formula].end;
  return ast.add(node, &formula, 1);
}

bool has_temporal_operator(const Ast& ast) {
  for (std::size_t i = 0; i < ast.node_count(); ++i) {
    const auto& node = ast[NodeId(static_cast<std::uint32_t>(i))];
    const bool has_operator = node.kind == NodeKind::kUnary || node.kind == NodeKind::kBinary;
    if (has_operator && is_temporal(node.op)) return true;
  }
  return false;
}

base::Result<StateConstraint> check_constraint(const ConstraintText& constraint, Constraints about,
                                               TypedModel& model, const base::SourceFiles& files,
                                               base::DiagnosticSink& sink) {
  auto parsed = about == Constraints::kTraces ? parse_temporal_formula(constraint.text, files, sink)
                                              : parse_formula(constraint.text, files, sink);
  if (!parsed) return sink.already_reported();
  const bool temporal = has_temporal_operator(parsed->ast);
  const bool negate = constraint.negated && !temporal;
  const auto root = negate ? negation(parsed->ast, parsed->root) : parsed->root;
  const auto checked = check_formula(model, parsed->ast, root, {}, sink);
  if (!checked) return sink.already_reported();
  return StateConstraint{*checked, constraint.place, temporal, temporal && constraint.negated};
}

}  // namespace

base::Result<std::vector<StateConstraint>> check_constraints(
    const std::vector<ConstraintText>& constraints, Constraints about, TypedModel& model,
    const base::SourceFiles& files, base::DiagnosticSink& sink) {
  std::vector<StateConstraint> checked;
  for (const auto& constraint : constraints) {
    const bool in_place = constraint.text.file == constraint.place.file;
    base::DiagnosticSink own;
    const auto formula = check_constraint(constraint, about, model, files, in_place ? sink : own);
    if (formula) checked.push_back(*formula);
    if (!in_place) sink.adopt(own, constraint.place, std::string(files.text(constraint.text)));
  }
  if (checked.size() != constraints.size()) return sink.already_reported();
  return checked;
}

namespace {

/// By timepoint, from `first` on: does the constraint hold there? None where an instance names a
/// timepoint before 0.
base::Result<std::vector<std::optional<FormulaId>>> ground_constraint(
    const StateConstraint& constraint, std::uint32_t origin, Timepoint first, GroundModel& model,
    FormulaGrounder& grounder, base::DiagnosticSink& sink) {
  if (constraint.temporal) {
    auto fulfilled = TemporalEncoder(constraint, origin, model, grounder, sink).fulfilled();
    if (!fulfilled) return sink.already_reported();
    return *std::move(fulfilled);
  }
  std::vector<std::optional<FormulaId>> out(static_cast<std::size_t>(first));
  for (Timepoint t = first; t <= model.horizon(); ++t) {
    grounder.start(constraint.source);
    if (constraint.formula.time) {
      grounder.bind(*constraint.formula.time, model.terms().integer(t));
    }
    out.push_back(grounder.ground(constraint.formula.formula));
    if (grounder.failed()) return sink.already_reported();
    if (out.back() && model.needed_horizon_of(*out.back()) > t) {
      return sink.error(codes::kConstraintLooksAhead, constraint.source);
    }
  }
  return out;
}

/// By timepoint n: may an execution end there, given where control is at a cut (encode_plan)? The
/// state in which the plan comes to a cut is one of an execution; later ones are not.
std::vector<FormulaId> known_ends(const std::vector<FormulaId>& cut, GroundModel& model) {
  std::vector<FormulaId> known(static_cast<std::size_t>(model.horizon()) + 1,
                               model.formulas().truth());
  for (std::size_t n = 1; n < known.size() && n <= cut.size(); ++n) known[n] = ~cut[n - 1];
  return known;
}

/// Defines an atom `hit` for every timepoint from `first` on: all constraints
/// hold there, and an execution may end there (`known`). An instance that names a timepoint before
/// 0 does not hold.
base::Status encode_constraints(const std::vector<StateConstraint>& constraints, Timepoint first,
                                const std::vector<FormulaId>& known, GroundModel& model,
                                FormulaGrounder& grounder, base::DiagnosticSink& sink) {
  const auto origin = model.add_origin(constraints.front().source, OriginKind::kStateConstraint);
  auto& formulas = model.formulas();
  std::vector<std::vector<FormulaId>> parts(static_cast<std::size_t>(model.horizon()) + 1);
  for (const auto& constraint : constraints) {
    const auto values = ground_constraint(constraint, origin, first, model, grounder, sink);
    if (!values) return sink.already_reported();
    bool ever = false;
    for (auto t = static_cast<std::size_t>(first); t < values->size(); ++t) {
      ever = ever || (*values)[t];
      parts[t].push_back((*values)[t].value_or(formulas.falsity()));
    }
    if (!ever) return sink.error(codes::kNothingToSay, constraint.source, model.horizon());
  }
  for (Timepoint t = first; t <= model.horizon(); ++t) {
    const auto n = static_cast<std::size_t>(t);
    parts[n].push_back(known[n]);
    const auto hit = model.plan_atom(AtomKind::kHit, {}, t);
    const auto all = formulas.conjunction(std::move(parts[n]));
    model.require(formulas.equivalence(hit, all), origin);
  }
  return base::Unit{};
}

/// The atoms `hit` of a property about traces, which ends them where it is violated.
base::Status encode_violation(const StateConstraint& property, bool has_plan,
                              const std::vector<FormulaId>& known, GroundModel& model,
                              FormulaGrounder& grounder, base::DiagnosticSink& sink) {
  const auto origin = model.add_origin(property.source, OriginKind::kStateConstraint);
  std::vector<FormulaId> hit, complete;
  for (Timepoint t = 0; t <= model.horizon(); ++t) {
    hit.push_back(model.plan_atom(AtomKind::kHit, {}, t));
    complete.push_back(has_plan ? ~model.plan_atom(AtomKind::kRunning, {}, t)
                                : model.formulas().constant(t == model.horizon()));
  }
  return TemporalEncoder(property, origin, model, grounder, sink)
      .require_violation(hit, complete, known);
}

/// Records how the model was made (producer, options, sources), so that it can be read without the
/// texts.
void describe(const CompileInput& input, const base::SourceFiles& files, CompiledModel& model) {
  model.producer = input.producer;
  if (input.ground.meaning == Meaning::kDecreasoner) model.options["compat"] = "decreasoner";
  describe_sources(model, files);
  sort_clauses(model);
}

}  // namespace

std::vector<PassInfo> compile_passes() {
  auto passes = ground_passes();
  const auto more = encode_passes();
  passes.insert(passes.end(), more.begin(), more.end());
  return passes;
}

namespace {

/// Loads, checks and lints the model.
base::Result<TypedModel> typed_model(const CompileInput& input, base::SourceFiles& files,
                                     base::DiagnosticSink& sink) {
  // In the old meaning, only differences that are not reproduced are reported.
  if (input.ground.meaning == Meaning::kDecreasoner) {
    for (const auto code : reproduced_differences()) sink.mute(code);
  }
  const auto ast = input.text ? load_model_text(*input.text, ".", input.load, files, sink)
                              : load_model(input.models, input.load, files, sink);
  if (!ast) return sink.already_reported();
  CheckOptions check;
  if (input.horizon) {
    check.time_lower = 0;
    check.time_upper = input.horizon;
  }
  if (input.plan) check.usual_time_upper = input.plan->max_horizon;
  check.old_reasoner = input.ground.meaning == Meaning::kDecreasoner;
  auto typed = check_model(*ast, files, sink, check);
  if (!typed) return sink.already_reported();
  const bool is_property = !input.constraints.empty() && input.constraints.front().negated;
  if (input.lint) {
    lint_model(lint_rules(), *ast, *typed, sink);
  } else if (is_property) {
    lint_model(horizon_rules(), *ast, *typed, sink);
  }
  lint_model(difference_rules(), *ast, *typed, sink);
  return typed;
}

}  // namespace

base::Status check_texts(const CompileInput& input, base::SourceFiles& files,
                         base::DiagnosticSink& sink) {
  PARALLAX_REQUIRE(!input.plan && input.constraints.empty() && input.objectives.empty() &&
                       !input.objectives_of_model,
                   "a model alone");
  const auto typed = typed_model(input, files, sink);
  if (!typed) return sink.already_reported();
  auto ground_options = input.ground;
  ground_options.lint = input.lint;
  return check_grounding(*typed, ground_options, sink);
}

base::Result<Compilation> compile_model(const CompileInput& input, base::SourceFiles& files,
                                        base::DiagnosticSink& sink) {
  auto typed = typed_model(input, files, sink);
  if (!typed) return sink.already_reported();

  // Constraints and the plan are independent: report the errors of both.
  auto constraints =
      check_constraints(input.constraints, Constraints::kTraces, *typed, files, sink);
  std::vector<CheckedObjective> objectives;
  auto wanted = input.objectives;
  if (input.objectives_of_model) {
    for (const auto& statement : typed->objectives) wanted.push_back(statement.source);
  }
  for (const auto& text : wanted) {
    auto objective = check_objective(text, *typed, files, sink);
    if (objective) objectives.push_back(*std::move(objective));
  }
  std::optional<CheckedPlan> plan;
  if (input.plan) {
    auto checked = check_plan(*input.plan, input.ground.stop, *typed, files, sink);
    if (checked) plan = *std::move(checked);
    if (plan && !input.horizon) set_horizon(plan->graph, input.plan->max_horizon, *typed);
  }
  if (!constraints || objectives.size() != wanted.size() || (input.plan && !plan))
    return sink.already_reported();

  PassLog log{input.emit_pass, &files};
  auto ground_options = input.ground;
  ground_options.lint = input.lint;
  auto ground = ground_model(*typed, ground_options, sink, &log);
  if (!ground) return sink.already_reported();
  FormulaGrounder grounder(*ground, input.ground, sink);
  const bool is_temporal = !constraints->empty() && constraints->front().violated;
  const auto running = is_temporal ? RunningAtoms::kEverywhere : RunningAtoms::kAtHorizon;
  std::vector<FormulaId> cut;
  if (plan) {
    auto encoded =
        encode_plan(plan->graph, plan->formulas, plan->events, running, *ground, grounder, sink);
    if (!encoded) return sink.already_reported();
    cut = *std::move(encoded);
  }
  const auto known = known_ends(cut, *ground);
  if (is_temporal) {
    if (!encode_violation(constraints->front(), plan.has_value(), known, *ground, grounder, sink)) {
      return sink.already_reported();
    }
  } else if (!constraints->empty() && !encode_constraints(*constraints, input.hits_at_start ? 0 : 1,
                                                          known, *ground, grounder, sink)) {
    return sink.already_reported();
  }
  for (const auto& objective : objectives) {
    if (!encode_objective(objective, *ground, grounder, sink)) return sink.already_reported();
  }
  Compilation result;
  result.model = encode(*ground, &log, input.folded);
  result.passes = std::move(log);
  if (input.costs) result.costs = axiom_costs(*ground, result.model);
  result.model.has_constraints = !constraints->empty();
  if (plan) {
    result.model.plan = plan_steps(plan->graph);
    result.model.plan_cuts = plan_cuts(plan->graph);
    result.plan = std::move(plan->graph);
    result.plan_formulas = std::make_shared<const PlanFormulas>(std::move(plan->formulas));
  }
  result.constraints = *std::move(constraints);
  describe(input, files, result.model);
  result.typed = std::make_unique<TypedModel>(*std::move(typed));
  return result;
}

}  // namespace parallax::compiler
