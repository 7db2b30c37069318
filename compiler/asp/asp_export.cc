#include "compiler/asp/asp_export.h"

#include <algorithm>
#include <utility>

#include "compiler/asp/completion_rules.h"
#include "compiler/asp/domain_rules.h"
#include "compiler/asp/formula_writer.h"

namespace parallax::compiler {
namespace {

/// The source text of an axiom on one line, cut where it is long.
std::string comment(const base::SourceFiles& files, const base::SourceRange& source) {
  static constexpr std::size_t kMaxLength = 300;
  std::string text = "\n% " + files.place(source) + ": ";
  const auto quoted = files.text(source);
  for (const char c : quoted.substr(0, kMaxLength)) {
    const bool blank = static_cast<unsigned char>(c) <= ' ';
    if (!blank) text += c;
    if (blank && text.back() != ' ') text += ' ';
  }
  return text + (quoted.size() > kMaxLength ? " ...\n" : "\n");
}

class Exporter {
 public:
  Exporter(const TypedModel& model, const base::SourceFiles& files, AspNames& names,
           const AspOptions& options, base::DiagnosticSink& sink)
      : model_(model),
        files_(files),
        names_(names),
        options_(options),
        terms_(model, names, sink),
        formulas_(model, names, terms_, rules_),
        completion_(model, names, terms_, formulas_, rules_) {}

  std::string write() {
    rules_ = domain_rules(model_, names_, terms_);
    rules_ += choice_rules(model_, names_, terms_);
    rules_ += calculus_rules(model_);
    for (const auto& effect : model_.effects) write_effect(effect);
    for (const auto& trajectory : model_.trajectories) write_trajectory(trajectory);
    for (std::size_t i = 0; i < model_.axioms.size(); ++i) write_axiom(model_.axioms[i], i);
    completion_.write();
    write_mentions();
    if (options_.report_existence) rules_ += "#show axiom_exists/1.\n#defined axiom_exists/1.\n";
    return std::move(rules_);
  }

 private:
  void start(const base::SourceRange& source) {
    rules_ += comment(files_, source);
    terms_.start();
  }

  void write_effect(const EffectAxiom& effect) {
    start(effect.source);
    auto body = terms_.domains(effect.variables);
    const auto event = terms_.member(effect.event, *model_.core.event);
    const auto fluent = terms_.member(effect.fluent, *model_.core.fluent);
    const auto time = terms_.term(effect.time);
    for (const auto* term : {&event, &fluent, &time}) append(body, term->needs);
    body.push_back(plain_literal(applied("step", {time.text})));
    const char* name = effect.kind == EffectKind::kInitiates    ? "initiates"
                       : effect.kind == EffectKind::kTerminates ? "terminates"
                                                                : "releases";
    write_rules(applied(name, {event.text, fluent.text, time.text}), body, effect.condition);
  }

  /// DEC3 and DEC4.
  void write_trajectory(const TrajectoryAxiom& axiom) {
    start(axiom.source);
    const bool forward = axiom.kind == TrajectoryKind::kTrajectory;
    auto body = terms_.domains(axiom.variables);
    const auto& core = model_.core;
    const auto& sorts =
        model_.symbols[forward ? *core.trajectory : *core.anti_trajectory].arguments;
    const auto fluent = terms_.member(axiom.fluent, sorts[0]);
    const auto time = terms_.term(axiom.time);
    const auto target = terms_.member(axiom.target, sorts[2]);
    const auto offset = terms_.member(axiom.offset, sorts[3]);
    for (const auto* term : {&fluent, &time, &target, &offset}) append(body, term->needs);
    const auto end = time.text + "+" + offset.text;
    for (const auto& literal :
         {applied(forward ? "initiated" : "terminated", {fluent.text, time.text}),
          "0 < " + offset.text, applied("time", {end}),
          "not " + applied(forward ? "stopped_in" : "started_in", {time.text, fluent.text, end}),
          "not " + applied("holds_at", {target.text, end})}) {
      body.push_back(plain_literal(literal));
    }
    body.push_back(plain_literal(applied("step", {time.text})));
    write_rules("", body, axiom.condition);
  }

  void write_rules(const std::string& head, const AspBody& body, TypedFormulaId condition) {
    const auto written = formulas_.write(condition, true);
    for (const auto& alternative : written.alternatives) {
      auto all = body;
      append(all, written.exists);
      append(all, alternative);
      rules_ += rule_text(head, all);
    }
  }

  void write_axiom(const Axiom& axiom, std::size_t number) {
    start(axiom.source);
    std::vector<VariableId> variables;
    auto body = axiom.formula;
    while (model_.formulas[body].kind == FormulaKind::kForall) {
      const auto& own = model_.formulas[body].variables;
      variables.insert(variables.end(), own.begin(), own.end());
      body = model_.formulas[body].children[0];
    }
    const auto written = formulas_.write(body, false);
    auto instance = terms_.domains(variables);
    append(instance, written.exists);
    for (const auto& alternative : written.alternatives) {
      auto all = instance;
      append(all, alternative);
      rules_ += rule_text("", all);
    }
    if (options_.report_existence) {
      const bool no_instance = std::any_of(
          variables.begin(), variables.end(),
          [&](VariableId variable) { return terms_.is_empty(model_.variables[variable].sort); });
      rules_ += rule_text(applied("axiom_exists", {std::to_string(number)}),
                          no_instance ? AspBody{} : instance);
    }
    completion_.note(axiom, variables, body, written);
  }

  /// Predicates over all integers have the atoms that formulas mention.
  void write_mentions() {
    for (std::size_t i = 0; i < model_.symbols.size(); ++i) {
      const auto id = model_.symbols.id_at(i);
      const auto& symbol = model_.symbols[id];
      if (symbol.kind != SymbolKind::kPredicate || symbol.result ||
          std::none_of(symbol.arguments.begin(), symbol.arguments.end(),
                       [&](SortId sort) { return terms_.is_unbounded(sort); })) {
        continue;
      }
      if (id == model_.core.trajectory || id == model_.core.anti_trajectory) continue;
      std::vector<std::string> variables;
      for (std::size_t k = 0; k < symbol.arguments.size(); ++k) {
        variables.push_back("X" + std::to_string(k + 1));
      }
      const auto& mentioned = formulas_.mentioned(id);
      rules_ += rule_text("{ " + applied(names_.symbol(id), variables) + " }",
                          {plain_literal(applied(mentioned, variables))}) +
                "#defined " + mentioned + "/" + std::to_string(variables.size()) + ".\n";
    }
  }

  const TypedModel& model_;
  const base::SourceFiles& files_;
  AspNames& names_;
  const AspOptions& options_;
  std::string rules_;
  TermWriter terms_;
  FormulaWriter formulas_;
  CompletionRules completion_;
};

}  // namespace

base::Result<AspProgram> to_asp(const TypedModel& model, const base::SourceFiles& files,
                                const AspOptions& options, base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  AspProgram program{{}, AspNames(model)};
  program.text = Exporter(model, files, program.names, options, sink).write();
  if (sink.error_count() != errors_before) return sink.already_reported();
  return program;
}

}  // namespace parallax::compiler
