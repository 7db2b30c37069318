#include "compiler/sema/model_text.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/base/word_table.h"
#include "compiler/sema/name_advice.h"

namespace parallax::compiler {
namespace {

constexpr auto kArithmeticSigns = base::word_table<ArithmeticOp>("+", "-", "*", "/", "%");

constexpr auto kCompareSigns = base::word_table<CompareOp>("=", "!=", "<", "<=", ">", ">=");

/// Writes formulas and terms with an explicit stack of pending nodes.
class TreeWriter {
 public:
  explicit TreeWriter(const TypedModel& model) : model_(model) {}

  std::string write(TypedFormulaId root) {
    formula(root, false);
    return run();
  }
  std::string write(TermId root) {
    term(root, false);
    return run();
  }

 private:
  enum class Kind : std::uint8_t { kText, kFormula, kTerm };
  struct Task {
    Kind kind = Kind::kText;
    std::string text;
    TypedFormulaId formula;
    TermId term;
    bool inside = false;  // an operand, which may need parentheses
  };

  void text(std::string_view piece) { tasks_.push_back({Kind::kText, std::string(piece), {}, {}}); }
  void formula(TypedFormulaId id, bool inside) {
    tasks_.push_back({Kind::kFormula, {}, id, {}, inside});
  }
  void term(TermId id, bool inside) { tasks_.push_back({Kind::kTerm, {}, {}, id, inside}); }

  std::string run() {
    std::string out;
    while (!tasks_.empty()) {
      const Task task = std::move(tasks_.back());
      tasks_.pop_back();
      const auto begin = tasks_.size();
      if (task.kind == Kind::kText) {
        out += task.text;
      } else if (task.kind == Kind::kFormula) {
        expand(model_.formulas[task.formula], task.inside);
      } else {
        expand(model_.terms[task.term], task.inside);
      }
      // Written in source order, popped from the end.
      std::reverse(tasks_.begin() + static_cast<std::ptrdiff_t>(begin), tasks_.end());
    }
    return out;
  }

  void expand(const TypedFormula& what, bool inside) {
    switch (what.kind) {
      case FormulaKind::kTrue:
        return text("0=0");
      case FormulaKind::kFalse:
        return text("0!=0");
      case FormulaKind::kAtom:
        return call(model_.symbols[what.predicate].name, what.terms);
      case FormulaKind::kCompare:
        return comparison(what, inside);
      case FormulaKind::kNot:
        text("!");
        return formula(what.children[0], true);
      case FormulaKind::kAnd:
        return connective(what, " & ", inside);
      case FormulaKind::kOr:
        return connective(what, " | ", inside);
      case FormulaKind::kImplies:
        return connective(what, " -> ", inside);
      case FormulaKind::kIff:
        return connective(what, " <-> ", inside);
      case FormulaKind::kForall:
        return quantifier(what, "[", "] ", inside);
      case FormulaKind::kExists:
        return quantifier(what, "{", "} ", inside);
      case FormulaKind::kAggregate:
        return aggregate(what, inside);
      case FormulaKind::kTemporal:
        return;  // no axiom has one
    }
  }

  void comparison(const TypedFormula& what, bool inside) {
    if (inside) text("(");
    term(what.terms[0], true);
    text(kCompareSigns.of(what.compare));
    term(what.terms[1], true);
    if (inside) text(")");
  }

  void aggregate(const TypedFormula& what, bool inside) {
    if (inside) text("(");
    text(what.terms.size() == 1 ? "count{" : "sum{");
    variables(what.variables);
    text(": ");
    if (what.terms.size() == 2) {
      term(what.terms[1], false);
      text(": ");
    }
    formula(what.children[0], false);
    text("}");
    text(kCompareSigns.of(what.compare));
    term(what.terms[0], true);
    if (inside) text(")");
  }

  void connective(const TypedFormula& what, std::string_view op, bool inside) {
    const bool parentheses = inside && what.children.size() > 1;
    if (parentheses) text("(");
    for (std::size_t i = 0; i < what.children.size(); ++i) {
      if (i != 0) text(op);
      // A comparison binds stronger than every connective but `!`.
      const auto kind = model_.formulas[what.children[i]].kind;
      formula(what.children[i], kind != FormulaKind::kCompare);
    }
    if (parentheses) text(")");
  }

  void quantifier(const TypedFormula& what, std::string_view open, std::string_view close,
                  bool inside) {
    if (inside) text("(");
    text(open);
    variables(what.variables);
    text(close);
    formula(what.children[0], false);
    if (inside) text(")");
  }

  void variables(const std::vector<VariableId>& list) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (i != 0) text(",");
      text(name(list[i]));
    }
  }

  void call(const std::string& symbol, const std::vector<TermId>& arguments) {
    text(symbol);
    text("(");
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      if (i != 0) text(",");
      term(arguments[i], false);
    }
    text(")");
  }

  void expand(const Term& what, bool inside) {
    switch (what.kind) {
      case TermKind::kVariable:
        return text(name(what.variable));
      case TermKind::kObject:
        return text(model_.objects[what.object].name);
      case TermKind::kInteger:
        return text(std::to_string(what.integer));
      case TermKind::kApply:
        return call(model_.symbols[what.symbol].name, what.arguments);
      case TermKind::kArithmetic:
        if (inside) text("(");
        term(what.arguments[0], true);
        text(kArithmeticSigns.of(what.op));
        term(what.arguments[1], true);
        if (inside) text(")");
        return;
    }
  }

  /// The timepoint that `mutex` adds has a name that no variable of a text can have.
  std::string name(VariableId id) const {
    auto out = model_.variables[id].name;
    std::replace(out.begin(), out.end(), ' ', '0');
    return out;
  }

  const TypedModel& model_;
  std::vector<Task> tasks_;
};

class ModelWriter {
 public:
  ModelWriter(const TypedModel& model, const std::function<bool(const base::SourceRange&)>& skip)
      : model_(model), skip_(skip) {}

  std::string run() {
    options();
    for (const auto& sort : model_.sorts) declare(sort);
    for (std::size_t i = 0; i < model_.sorts.size(); ++i) members(model_.sorts.id_at(i));
    for (const auto& symbol : model_.symbols) declare(symbol);
    for (const auto& symbol : model_.symbols) properties(symbol);
    for (const auto& entry : model_.function_values) value(entry);
    for (const auto& axiom : model_.axioms) {
      if (!skip_(axiom.source)) line(labelled(axiom.label) + to_text(model_, axiom.formula) + ".");
    }
    for (const auto& effect : model_.effects) write(effect);
    for (const auto& path : model_.trajectories) write(path);
    for (const auto& completion : model_.completions) write(completion);
    for (const auto& objective : model_.objectives) line("minimize " + objective.text);
    return std::move(out_);
  }

 private:
  void line(const std::string& text) { (out_ += text) += '\n'; }
  static std::string labelled(const std::string& label) {
    return label.empty() ? std::string() : label + ": ";
  }

  void options() {
    if (model_.options.encoding != 2) {
      line("option encoding " + std::to_string(model_.options.encoding));
    }
    if (model_.options.trajectory) line("option trajectory on");
    if (!model_.options.renaming) line("option renaming off");
    if (model_.options.founded) line("option founded on");
  }

  void declare(const Sort& sort) {
    if (skip_(sort.declared)) return;
    const std::string word = sort.reified && sort.parents.empty() ? "reified sort " : "sort ";
    if (sort.parents.empty()) return line(word + sort.name);
    for (const auto parent : sort.parents) {
      const bool reified = sort.reified;
      line((reified ? "reified sort " : "sort ") + sort.name + ": " + model_.sorts[parent].name);
    }
  }

  void members(SortId id) {
    const auto& sort = model_.sorts[id];
    for (const auto constant : sort.constants) {
      const auto& object = model_.objects[constant];
      line(sort.name + (object.sorts.front() == id ? " " : "! ") + object.name);
    }
    for (const auto& range : sort.ranges) {
      line("range " + sort.name + " " + std::to_string(range.lower) + " " +
           std::to_string(range.upper));
    }
  }

  void declare(const Symbol& symbol) {
    if (skip_(symbol.declared)) return;
    std::string kind(kind_word(symbol.kind));
    const bool function = symbol.kind == SymbolKind::kFunction;
    if (symbol.result && !function) kind = model_.sorts[*symbol.result].name;
    std::string text = kind + " " + symbol.name + "(";
    for (std::size_t i = 0; i < symbol.arguments.size(); ++i) {
      if (i != 0) text += ',';
      text += model_.sorts[symbol.arguments[i]].name;
    }
    line(text + (function ? "): " + model_.sorts[*symbol.result].name : ")"));
  }

  void properties(const Symbol& symbol) {
    if (symbol.noninertial) line("noninertial " + symbol.name);
    if (symbol.manual_release) line("manualrelease " + symbol.name);
  }

  void value(const FunctionValue& entry) {
    std::string text = model_.symbols[entry.function].name + "(";
    for (std::size_t i = 0; i < entry.arguments.size(); ++i) {
      if (i != 0) text += ',';
      text += to_text(model_, entry.arguments[i]);
    }
    line(text + ")=" + to_text(model_, entry.value) + ".");
  }

  template <typename Axiom>
  std::string condition(const Axiom& axiom) const {
    std::string text = labelled(axiom.label);
    for (std::size_t i = 0; i < axiom.variables.size(); ++i) {
      text += i == 0 ? '[' : ',';
      text += model_.variables[axiom.variables[i]].name;
    }
    if (!axiom.variables.empty()) text += "] ";
    if (model_.formulas[axiom.condition].kind == FormulaKind::kTrue) return text;
    return text + "(" + to_text(model_, axiom.condition) + ") -> ";
  }

  void write(const EffectAxiom& effect) {
    constexpr std::string_view kNames[] = {"Initiates(", "Terminates(", "Releases("};
    line(condition(effect) + std::string(kNames[static_cast<std::size_t>(effect.kind)]) +
         to_text(model_, effect.event) + "," + to_text(model_, effect.fluent) + "," +
         to_text(model_, effect.time) + ").");
  }

  void write(const TrajectoryAxiom& path) {
    const bool anti = path.kind == TrajectoryKind::kAntiTrajectory;
    line(condition(path) + (anti ? "AntiTrajectory(" : "Trajectory(") +
         to_text(model_, path.fluent) + "," + to_text(model_, path.time) + "," +
         to_text(model_, path.target) + "," + to_text(model_, path.offset) + ").");
  }

  void write(const Completion& completion) {
    line("completion " + (completion.label ? *completion.label + " " : std::string()) +
         model_.symbols[completion.predicate].name);
  }

  const TypedModel& model_;
  const std::function<bool(const base::SourceRange&)>& skip_;
  std::string out_;
};

}  // namespace

std::string to_text(const TypedModel& model, TypedFormulaId formula) {
  return TreeWriter(model).write(formula);
}
std::string to_text(const TypedModel& model, TermId term) { return TreeWriter(model).write(term); }

std::string to_text(const TypedModel& model,
                    const std::function<bool(const base::SourceRange&)>& leave_out) {
  return ModelWriter(model, leave_out).run();
}

}  // namespace parallax::compiler
