#include "compiler/asp/asp_export.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "compiler/asp/completion_rules.h"
#include "compiler/asp/formula_writer.h"
#include "compiler/asp/term_writer.h"
#include "compiler/base/ground_name.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {
namespace {

class DomainWriter {
 public:
  DomainWriter(const TypedModel& model, const AspNames& names, TermWriter& terms)
      : model_(model), names_(names), terms_(terms) {}

  std::string write() {
    text_ = "% Sorts\n";
    for (std::size_t i = 0; i < model_.sorts.size(); ++i) sort(model_.sorts.id_at(i));
    text_ += "step(T) :- time(T), time(T+1).\n#defined step/1.\n";
    if (!model_.function_values.empty()) text_ += "\n% Functions: the value comes last\n";
    for (const auto& entry : model_.function_values) function_value(entry);
    for (const auto& symbol : model_.symbols) {
      if (symbol.kind != SymbolKind::kFunction) continue;
      text_ += "#defined " + names_.symbol(*model_.find_symbol(symbol.name)) + "/" +
               std::to_string(symbol.arguments.size() + 1) + ".\n";
    }
    properties();
    return std::move(text_);
  }

 private:
  void sort(SortId id) {
    const auto& declared = model_.sorts[id];
    const auto& name = names_.sort(id);
    const bool time = id == model_.core.time;
    if (time && declared.ranges.size() == 1) {
      text_ += "#const horizon = " + upper(declared.ranges[0]) + ".\n" +
               applied(name, {lower(declared.ranges[0]) + "..horizon"}) + ".\n";
    } else {
      for (const auto& range : declared.ranges) {
        text_ += applied(name, {lower(range) + ".." + upper(range)}) + ".\n";
      }
    }
    std::string constants;
    for (const auto object : declared.constants) {
      constants += (constants.empty() ? "" : ";") + names_.object(object);
    }
    if (!constants.empty()) text_ += name + "(" + constants + ").\n";
    for (std::size_t i = 0; i < model_.sorts.size(); ++i) {
      const auto below = model_.sorts.id_at(i);
      const auto& parents = model_.sorts[below].parents;
      if (std::find(parents.begin(), parents.end(), id) == parents.end()) continue;
      text_ += rule_text(name + "(X)", {plain_literal(names_.sort(below) + "(X)")});
    }
    constructors(id);
    text_ += "#defined " + name + "/1.\n";
  }

  std::string lower(const Sort::Range& range) const {
    return terms_.number(range.lower, range.declared);
  }
  std::string upper(const Sort::Range& range) const {
    return terms_.number(range.upper, range.declared);
  }

  void constructors(SortId id) {
    for (std::size_t i = 0; i < model_.symbols.size(); ++i) {
      const auto symbol_id = model_.symbols.id_at(i);
      const auto& symbol = model_.symbols[symbol_id];
      if (symbol.result != id || symbol.kind == SymbolKind::kFunction) continue;
      const auto [variables, body] = arguments(symbol);
      text_ +=
          rule_text(applied(names_.sort(id), {applied(names_.symbol(symbol_id), variables)}), body);
    }
  }

  /// `X1`, `X2`, ... and the sorts that they range over.
  std::pair<std::vector<std::string>, AspBody> arguments(const Symbol& symbol) const {
    std::vector<std::string> variables;
    AspBody body;
    for (std::size_t i = 0; i < symbol.arguments.size(); ++i) {
      variables.push_back("X" + std::to_string(i + 1));
      body.push_back(plain_literal(applied(names_.sort(symbol.arguments[i]), {variables.back()})));
    }
    return {variables, body};
  }

  void function_value(const FunctionValue& entry) {
    std::vector<std::string> arguments;
    for (const auto argument : entry.arguments) arguments.push_back(terms_.term(argument).text);
    arguments.push_back(terms_.term(entry.value).text);
    text_ += applied(names_.symbol(entry.function), arguments) + ".\n";
  }

  /// noninertial(F): released at every timepoint. free_start(F): not said to be unreleased at 0.
  void properties() {
    text_ += "\n% Fluents that inertia does not hold for, or not from the start\n";
    for (std::size_t i = 0; i < model_.symbols.size(); ++i) {
      const auto id = model_.symbols.id_at(i);
      const auto& symbol = model_.symbols[id];
      if (symbol.kind != SymbolKind::kFluent) continue;
      const auto [variables, body] = arguments(symbol);
      const auto fluent = applied(names_.symbol(id), variables);
      if (symbol.noninertial) text_ += rule_text(applied("noninertial", {fluent}), body);
      if (symbol.noninertial || symbol.manual_release) {
        text_ += rule_text(applied("free_start", {fluent}), body);
      }
    }
    text_ += "#defined noninertial/1.\n#defined free_start/1.\n";
  }

  const TypedModel& model_;
  const AspNames& names_;
  TermWriter& terms_;
  std::string text_;
};

constexpr const char* kInertia = R"(
% What the events at T do
initiated(F,T) :- happens(E,T), initiates(E,F,T).
terminated(F,T) :- happens(E,T), terminates(E,F,T).
released(F,T) :- happens(E,T), releases(E,F,T).
#defined initiates/3.
#defined terminates/3.
#defined releases/3.

% ReleasedAt at the start and of noninertial fluents
:- fluent(F), not free_start(F), released_at(F,0).
:- noninertial(F), time(T), not released_at(F,T).

% DEC5, DEC6: what is not released keeps its value without a cause
:- fluent(F), step(T), not noninertial(F), holds_at(F,T), not released_at(F,T+1),
   not terminated(F,T), not holds_at(F,T+1).
:- fluent(F), step(T), not noninertial(F), not holds_at(F,T), not released_at(F,T+1),
   not initiated(F,T), holds_at(F,T+1).
% DEC7, DEC8: so does being released
:- fluent(F), step(T), not noninertial(F), released_at(F,T), not initiated(F,T),
   not terminated(F,T), not released_at(F,T+1).
:- fluent(F), step(T), not noninertial(F), not released_at(F,T), not released(F,T),
   released_at(F,T+1).
% DEC9 to DEC12: effects
:- initiated(F,T), not holds_at(F,T+1).
:- terminated(F,T), holds_at(F,T+1).
:- released(F,T), not released_at(F,T+1).
:- initiated(F,T), released_at(F,T+1).
:- terminated(F,T), released_at(F,T+1).
)";

constexpr const char* kIntervals = R"(
% DEC1, DEC2: strictly between two timepoints
stopped_in(T1,F,T2) :- time(T1), time(T2), terminated(F,T), T1 < T, T < T2.
started_in(T1,F,T2) :- time(T1), time(T2), initiated(F,T), T1 < T, T < T2.
)";

/// Facts and rules for the elements of every sort, the tables of functions, the properties of
/// fluents. Timepoints go from 0 to the constant `horizon`, which `clingo -c horizon=N` replaces.
std::string domain_rules(const TypedModel& model, const AspNames& names, TermWriter& terms) {
  return DomainWriter(model, names, terms).write();
}

bool is_users_predicate(const TypedModel& model, SymbolId id) {
  const auto& core = model.core;
  return model.symbols[id].kind == SymbolKind::kPredicate && id != core.holds_at &&
         id != core.happens && id != core.released_at && id != core.initiates &&
         id != core.terminates && id != core.releases && id != core.trajectory &&
         id != core.anti_trajectory;
}

/// Which atoms of user predicates tell traces apart: facts for the model's own horizon. For another
/// one, which `clingo -c horizon=N` gives, nothing is known, and all are.
class OpenAtomRules {
 public:
  OpenAtomRules(const TypedModel& model, AspNames& names, const AspOptions& options)
      : model_(model), names_(names), given_(options.open_atoms.has_value()) {
    if (!given_) return;
    for (const auto& atom : *options.open_atoms) {
      const auto symbol = model.find_symbol(base::symbol_of(atom));
      const auto written = names.printed(atom);
      const auto arguments = std::min(written.find('('), written.size());
      if (symbol) atoms_[symbol->index()].push_back(written.substr(arguments));
    }
  }

  /// `{ P(X1,..) } :- domain.`, for atoms that are open.
  std::string choice(SymbolId predicate, const std::vector<std::string>& variables,
                     AspBody domain) {
    const auto atom = applied(names_.symbol(predicate), variables);
    if (!given_) return rule_text("{ " + atom + " }", domain);
    const auto name = names_.fresh("open_" + names_.symbol(predicate));
    std::string text;
    const auto known = atoms_.find(predicate.index());
    if (known != atoms_.end()) {
      for (const auto& arguments : known->second) text += name + arguments + ".\n";
    }
    text += "#defined " + name + "/" + std::to_string(variables.size()) + ".\n";
    const auto open = applied(name, variables);
    const auto& ranges = model_.sorts[*model_.core.time].ranges;
    if (ranges.size() == 1) {
      auto elsewhere = domain;
      elsewhere.push_back(plain_literal("horizon != " + std::to_string(ranges[0].upper)));
      text += rule_text(open, elsewhere);
    }
    domain.push_back(plain_literal(open));
    return text + rule_text("{ " + atom + " }", domain);
  }

 private:
  const TypedModel& model_;
  AspNames& names_;
  bool given_;
  std::map<std::size_t, std::vector<std::string>> atoms_;  // arguments, by predicate
};

/// The atoms that may be true: HoldsAt, Happens, ReleasedAt, user predicates.
std::string choice_rules(const TypedModel& model, const AspNames& names, TermWriter& terms,
                         OpenAtomRules& open) {
  std::string text =
      "\n% Every trace is possible that nothing forbids\n"
      "{ holds_at(F,T) } :- fluent(F), time(T).\n"
      "{ happens(E,T) } :- event(E), step(T).\n"
      "{ released_at(F,T) } :- fluent(F), time(T).\n";
  std::string shown =
      "#show holds_at/2.\n#show happens/2.\n#show released_at/2.\n"
      "#project holds_at/2.\n#project happens/2.\n";
  for (std::size_t i = 0; i < model.symbols.size(); ++i) {
    const auto id = model.symbols.id_at(i);
    const auto& symbol = model.symbols[id];
    if (!is_users_predicate(model, id)) continue;
    shown += "#show " + names.symbol(id) + "/" + std::to_string(symbol.arguments.size()) + ".\n";
    if (std::any_of(symbol.arguments.begin(), symbol.arguments.end(),
                    [&](SortId sort) { return terms.is_unbounded(sort); })) {
      continue;  // made where a formula mentions them
    }
    std::vector<std::string> variables;
    AspBody body;
    for (std::size_t k = 0; k < symbol.arguments.size(); ++k) {
      variables.push_back("X" + std::to_string(k + 1));
      body.push_back(plain_literal(applied(names.sort(symbol.arguments[k]), {variables.back()})));
    }
    text += open.choice(id, variables, std::move(body));
  }
  return text + shown;
}

/// DEC5 to DEC12 over initiates, terminates and releases; the auxiliaries of DEC3 and DEC4 if the
/// model has trajectories.
std::string calculus_rules(const TypedModel& model) {
  std::string text = kInertia;
  if (!model.trajectories.empty()) text += kIntervals;
  return text;
}

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
        completion_(model, names, terms_, formulas_, rules_, sink),
        open_(model, names, options) {}

  std::string write() {
    rules_ = domain_rules(model_, names_, terms_);
    rules_ += choice_rules(model_, names_, terms_, open_);
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
      rules_ += open_.choice(id, variables, {plain_literal(applied(mentioned, variables))}) +
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
  OpenAtomRules open_;
};

}  // namespace

bool has_user_predicates(const TypedModel& model) {
  for (std::size_t i = 0; i < model.symbols.size(); ++i) {
    if (is_users_predicate(model, model.symbols.id_at(i))) return true;
  }
  return false;
}

base::Result<AspProgram> to_asp(const TypedModel& model, const base::SourceFiles& files,
                                const AspOptions& options, base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  AspProgram program{{}, AspNames(model)};
  program.text = Exporter(model, files, program.names, options, sink).write();
  if (sink.error_count() != errors_before) return sink.already_reported();
  return program;
}

}  // namespace parallax::compiler
