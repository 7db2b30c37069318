#include "compiler/asp/domain_rules.h"

#include <algorithm>

#include "compiler/asp/rule.h"

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
      text_ += "#const horizon = " + std::to_string(declared.ranges[0].upper) + ".\n" +
               applied(name, {std::to_string(declared.ranges[0].lower) + "..horizon"}) + ".\n";
    } else {
      for (const auto& range : declared.ranges) {
        text_ += applied(name, {std::to_string(range.lower) + ".." + std::to_string(range.upper)}) +
                 ".\n";
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

}  // namespace

std::string domain_rules(const TypedModel& model, const AspNames& names, TermWriter& terms) {
  return DomainWriter(model, names, terms).write();
}

std::string choice_rules(const TypedModel& model, const AspNames& names, TermWriter& terms) {
  const auto& core = model.core;
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
    if (symbol.kind != SymbolKind::kPredicate || id == core.holds_at || id == core.happens ||
        id == core.released_at || id == core.initiates || id == core.terminates ||
        id == core.releases || id == core.trajectory || id == core.anti_trajectory) {
      continue;
    }
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
    text += rule_text("{ " + applied(names.symbol(id), variables) + " }", body);
  }
  return text + shown;
}

std::string calculus_rules(const TypedModel& model) {
  std::string text = kInertia;
  if (!model.trajectories.empty()) text += kIntervals;
  return text;
}

}  // namespace parallax::compiler
