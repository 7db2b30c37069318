#include "compiler/asp/formula_writer.h"

#include <algorithm>
#include <utility>

namespace parallax::compiler {
namespace {

bool is_leaf(FormulaKind kind) {
  return kind == FormulaKind::kTrue || kind == FormulaKind::kFalse || kind == FormulaKind::kAtom ||
         kind == FormulaKind::kCompare;
}

/// `more` behind `body`, in the order given, without copying the longer of the two.
void move_behind(AspBody& body, AspBody more) {
  if (body.empty()) {
    body = std::move(more);
    return;
  }
  body.insert(body.end(), std::make_move_iterator(more.begin()),
              std::make_move_iterator(more.end()));
}

const char* comparison_sign(CompareOp op, bool value) {
  switch (op) {
    case CompareOp::kEqual:
      return value ? " = " : " != ";
    case CompareOp::kNotEqual:
      return value ? " != " : " = ";
    case CompareOp::kLess:
      return value ? " < " : " >= ";
    case CompareOp::kLessEqual:
      return value ? " <= " : " > ";
    case CompareOp::kGreater:
      return value ? " > " : " <= ";
    case CompareOp::kGreaterEqual:
      return value ? " >= " : " < ";
  }
  return " = ";
}

}  // namespace

struct FormulaWriter::Frame {
  const TypedFormula* formula = nullptr;
  bool want_true = false;
  bool want_false = false;
  std::vector<Part> parts;
};

FormulaWriter::FormulaWriter(const TypedModel& model, AspNames& names, TermWriter& terms,
                             std::string& rules)
    : model_(model), names_(names), terms_(terms), rules_(rules), mentioned_(model.symbols.size()) {
  // A part is added to the store before the formula around it.
  const auto& core = model.core;
  for (const auto& formula : model.formulas) {
    const bool is_effect =
        formula.kind == FormulaKind::kAtom &&
        (formula.predicate == core.initiates || formula.predicate == core.terminates ||
         formula.predicate == core.releases);
    has_effect_.push_back(is_effect ||
                          std::any_of(formula.children.begin(), formula.children.end(),
                                      [&](auto child) { return has_effect_[child.index()]; }));
  }
}

const std::string& FormulaWriter::mentioned(SymbolId predicate) {
  auto& name = mentioned_[predicate.index()];
  if (name.empty()) name = names_.fresh("mentioned_" + names_.symbol(predicate));
  return name;
}

AspFormula FormulaWriter::write(TypedFormulaId root, bool wanted, const AspPoint* point) {
  point_ = point;
  hidden_.clear();
  std::vector<Frame> stack;
  std::optional<Part> done;
  const auto enter = [&](TypedFormulaId id, bool want_true, bool want_false) {
    const auto& formula = model_.formulas[id];
    if (is_leaf(formula.kind)) {
      done = leaf(formula, want_true, want_false);
      return;
    }
    // A quantifier is read for the value of its instances that decides it.
    if ((formula.kind == FormulaKind::kForall || formula.kind == FormulaKind::kExists) &&
        !mentions_effect(formula)) {
      want_true = formula.kind == FormulaKind::kExists;
      want_false = !want_true;
    }
    stack.push_back({&formula, want_true, want_false, {}});
  };
  enter(root, wanted, !wanted);
  while (!stack.empty()) {
    auto& frame = stack.back();
    if (done) frame.parts.push_back(*std::exchange(done, std::nullopt));
    const auto next = frame.parts.size();
    if (next == frame.formula->children.size()) {
      done = combine(frame);
      stack.pop_back();
      continue;
    }
    const auto kind = frame.formula->kind;
    if (kind == FormulaKind::kAggregate) {
      enter(frame.formula->children[next], true, false);
      continue;
    }
    const bool both = kind == FormulaKind::kIff;
    const bool turned = kind == FormulaKind::kNot || (kind == FormulaKind::kImplies && next == 0);
    const bool want_true = turned ? frame.want_false : frame.want_true;
    const bool want_false = turned ? frame.want_true : frame.want_false;
    enter(frame.formula->children[next], both || want_true, both || want_false);
  }
  return {std::move(done->exists), std::move(done->when(wanted)), std::move(hidden_)};
}

void FormulaWriter::add_free(const std::vector<VariableId>& variables, Part& part) {
  for (const auto variable : variables) {
    if (std::find(part.free.begin(), part.free.end(), variable) == part.free.end()) {
      part.free.push_back(variable);
    }
  }
}

/// In the order in which they stand.
std::vector<VariableId> FormulaWriter::variables_of(TermId root) const {
  std::vector<VariableId> found;
  std::vector<TermId> visit = {root};
  while (!visit.empty()) {
    const auto& term = model_.terms[visit.back()];
    visit.pop_back();
    visit.insert(visit.end(), term.arguments.rbegin(), term.arguments.rend());
    if (term.kind == TermKind::kVariable) found.push_back(term.variable);
  }
  return found;
}

void FormulaWriter::inherit(Part& whole, Part& part) const {
  add_free(part.free, whole);
  whole.completed.insert(part.completed.begin(), part.completed.end());
  move_behind(whole.exists, std::move(part.exists));
}

FormulaWriter::Part FormulaWriter::combine(Frame& frame) {
  const auto kind = frame.formula->kind;
  if (kind == FormulaKind::kForall || kind == FormulaKind::kExists) return quantified(frame);
  if (kind == FormulaKind::kAggregate) return aggregate(frame);
  Part whole;
  auto& parts = frame.parts;
  if (kind == FormulaKind::kNot || kind == FormulaKind::kImplies) {
    std::swap(parts[0].when_true, parts[0].when_false);
  }
  for (const bool value : {false, true}) {
    if (!(value ? frame.want_true : frame.want_false)) continue;
    if (kind == FormulaKind::kIff) {
      whole.when(value) = equivalence(parts, value);
    } else if (kind == FormulaKind::kNot) {
      whole.when(value) = std::move(parts[0].when(value));
    } else {
      // Conjunctions are true, disjunctions false, if all parts are.
      const bool all = (kind == FormulaKind::kAnd) == value;
      whole.when(value) = all ? conjunction(parts, value) : disjunction(parts, value);
    }
  }
  for (auto& part : parts) inherit(whole, part);
  return whole;
}

AspAlternatives FormulaWriter::conjunction(std::vector<Part>& parts, bool value) {
  AspBody all;
  for (auto& part : parts) {
    auto body = single(part, value);
    if (!body) return {};
    move_behind(all, *std::move(body));
  }
  return {std::move(all)};
}

AspAlternatives FormulaWriter::disjunction(std::vector<Part>& parts, bool value) const {
  AspAlternatives any;
  for (auto& part : parts) {
    for (auto& body : part.when(value)) any.push_back(std::move(body));
  }
  return any;
}

AspAlternatives FormulaWriter::equivalence(std::vector<Part>& parts, bool value) {
  AspAlternatives any;
  for (const bool first : {false, true}) {
    // Copies: each value of each side is needed for either value of the whole.
    auto left = single(parts[0], first);
    auto right = single(parts[1], first == value);
    if (left) parts[0].when(first) = {*left};
    if (right) parts[1].when(first == value) = {*right};
    if (!left || !right) continue;
    move_behind(*left, *std::move(right));
    any.push_back(*std::move(left));
  }
  return any;
}

/// The part as a single conjunction, through an auxiliary where necessary; none if it never has the
/// value.
std::optional<AspBody> FormulaWriter::single(Part& part, bool value) {
  auto& alternatives = part.when(value);
  if (alternatives.empty()) return std::nullopt;
  if (alternatives.size() == 1) return std::move(alternatives[0]);
  return AspBody{auxiliary("part", part, terms_.domains(part.free), alternatives)};
}

/// Rules for `kind_N(free variables)`, true where one of the alternatives is.
AspLiteral FormulaWriter::auxiliary(const char* kind, const Part& part, const AspBody& domain,
                                    const AspAlternatives& alternatives) {
  std::vector<std::string> arguments;
  for (const auto variable : part.free) arguments.push_back(terms_.variable(variable));
  AspBody bound;
  if (point_ != nullptr && part.completed.contains(point_->predicate)) {
    arguments.insert(arguments.end(), point_->arguments.begin(), point_->arguments.end());
    bound = point_->domain;
  }
  append(bound, domain);
  hidden_.insert(part.completed.begin(), part.completed.end());
  const auto name = names_.fresh(std::string(kind) + "_" + std::to_string(++auxiliaries_));
  const auto head = applied(name, arguments);
  for (const auto& alternative : alternatives) {
    auto body = bound;
    append(body, alternative);
    rules_ += rule_text(head, body);
  }
  return plain_literal(head);
}

/// An existing instance of the value looked for decides. Without any existing instance there is
/// no formula, unless there is no instance at all.
FormulaWriter::Part FormulaWriter::quantified(Frame& frame) {
  const auto& variables = frame.formula->variables;
  const bool exists = frame.formula->kind == FormulaKind::kExists;
  auto& body = frame.parts[0];
  Part whole;
  whole.completed = body.completed;
  for (const auto variable : body.free) {
    if (std::find(variables.begin(), variables.end(), variable) == variables.end()) {
      whole.free.push_back(variable);
    }
  }
  auto domain = terms_.domains(whole.free);
  append(domain, terms_.domains(variables));
  append(domain, body.exists);
  auto& deciding = body.when(exists);
  if (mentions_effect(*frame.formula)) {
    if (exists ? frame.want_false : frame.want_true) {
      whole.when(!exists) = {AspBody{all_instances(whole, body, !exists, variables, domain)}};
    }
    if ((exists ? frame.want_true : frame.want_false) && !deciding.empty()) {
      whole.when(exists) = {AspBody{auxiliary("some", whole, domain, deciding)}};
    }
  } else if (deciding.empty()) {
    whole.when_true = constant(!exists);
    whole.when_false = constant(exists);
  } else {
    const auto decided = auxiliary(exists ? "some" : "fails", whole, domain, deciding);
    const auto open = plain_literal("not " + decided.text);
    whole.when(exists) = {AspBody{decided}};
    whole.when(!exists) = {AspBody{open}};
  }
  if (!body.exists.empty()) note_existence(frame, domain, whole);
  return whole;
}

/// The whole exists where `domain` has an instance, or there can be none at all.
void FormulaWriter::note_existence(const Frame& frame, const AspBody& domain, Part& whole) {
  const auto& variables = frame.formula->variables;
  if (std::any_of(variables.begin(), variables.end(),
                  [&](VariableId id) { return terms_.is_empty(model_.variables[id].sort); })) {
    return;
  }
  Part fixed;  // existence does not depend on the point
  fixed.free = whole.free;
  whole.exists.push_back(auxiliary("exists", fixed, domain, constant(true)));
}

/// `#count{X : counted_N(free variables,X)} >= K`; a sum has its weight in front of X.
FormulaWriter::Part FormulaWriter::aggregate(Frame& frame) {
  const auto& formula = *frame.formula;
  auto& body = frame.parts[0];
  Part instance;  // with the variables of the aggregate
  instance.completed = body.completed;
  add_free(body.free, instance);
  const auto number = terms_.term(formula.terms[0]);
  std::optional<AspTerm> weight;
  if (formula.terms.size() == 2) {
    weight = terms_.term(formula.terms[1]);
    add_free(variables_of(formula.terms[1]), instance);
    append(body.exists, weight->needs);
  }
  Part whole;
  whole.completed = body.completed;
  std::string tuple = weight ? weight->text : std::string();
  for (const auto variable : formula.variables) {
    tuple += (tuple.empty() ? "" : ",") + terms_.variable(variable);
  }
  for (const auto variable : instance.free) {
    const auto& own = formula.variables;
    if (std::find(own.begin(), own.end(), variable) == own.end()) whole.free.push_back(variable);
  }
  add_free(formula.variables, instance);
  auto domain = terms_.domains(whole.free);
  append(domain, terms_.domains(formula.variables));
  append(domain, body.exists);
  std::string elements;
  if (!body.when_true.empty()) {
    elements = tuple + " : " + auxiliary("counted", instance, domain, body.when_true).text;
    if (weight) {
      for (const auto& literal : weight->lookups) elements += ", " + literal.text;
    }
  }
  if (!body.exists.empty()) note_existence(frame, domain, whole);
  append(whole.exists, number.needs);
  add_free(variables_of(formula.terms[0]), whole);
  for (const bool value : {false, true}) {
    AspBody all = number.lookups;
    all.push_back(plain_literal((weight ? "#sum{ " : "#count{ ") + elements + " }" +
                                comparison_sign(formula.compare, value) + number.text));
    whole.when(value) = {std::move(all)};
  }
  if (!frame.want_true) whole.when_true.clear();
  if (!frame.want_false) whole.when_false.clear();
  return whole;
}

bool FormulaWriter::mentions_effect(const TypedFormula& formula) const {
  return std::any_of(formula.children.begin(), formula.children.end(),
                     [&](auto child) { return has_effect_[child.index()]; });
}

/// `all_N(free variables)`: every instance that exists has the value. A conditional literal asks
/// for each, where `not fails_N` would be a negation.
AspLiteral FormulaWriter::all_instances(const Part& whole, Part& body, bool value,
                                        const std::vector<VariableId>& variables,
                                        const AspBody& domain) {
  Part instance;  // with the quantifier's variables
  instance.free = whole.free;
  instance.completed = whole.completed;
  add_free(variables, instance);
  Part nothing;
  nothing.free = instance.free;
  const auto exists = auxiliary("instance", nothing, domain, constant(true));
  const auto holds = auxiliary("each", instance, domain, body.when(value));
  const auto conditional = plain_literal(holds.text + " : " + exists.text);
  return auxiliary("all", whole, terms_.domains(whole.free), {AspBody{conditional}});
}

FormulaWriter::Part FormulaWriter::leaf(const TypedFormula& formula, bool want_true,
                                        bool want_false) {
  Part part;
  if (formula.kind == FormulaKind::kTrue || formula.kind == FormulaKind::kFalse) {
    const bool value = formula.kind == FormulaKind::kTrue;
    part.when_true = constant(value);
    part.when_false = constant(!value);
  } else {
    part = formula.kind == FormulaKind::kAtom ? atom(formula) : compare(formula);
    for (const auto term : formula.terms) add_free(variables_of(term), part);
  }
  if (!want_true) part.when_true.clear();
  if (!want_false) part.when_false.clear();
  return part;
}

FormulaWriter::Part FormulaWriter::compare(const TypedFormula& formula) {
  const auto left = terms_.term(formula.terms[0]);
  const auto right = terms_.term(formula.terms[1]);
  Part part;
  part.exists = left.needs;
  append(part.exists, right.needs);
  for (const bool value : {false, true}) {
    AspBody body = left.lookups;
    append(body, right.lookups);
    body.push_back(plain_literal(left.text + comparison_sign(formula.compare, value) + right.text));
    part.when(value) = {std::move(body)};
  }
  return part;
}

/// Memberships; the time of an event must have a successor.
AspBody FormulaWriter::needs_of_atom(const TypedFormula& formula, std::vector<AspTerm>& arguments) {
  const auto& symbol = model_.symbols[formula.predicate];
  const auto& core = model_.core;
  const bool event = formula.predicate == core.happens;
  const bool effect = formula.predicate == core.initiates || formula.predicate == core.terminates ||
                      formula.predicate == core.releases;
  AspBody needs;
  for (std::size_t i = 0; i < formula.terms.size(); ++i) {
    const bool last = i + 1 == formula.terms.size();
    auto value = last && (effect || event) ? terms_.term(formula.terms[i])
                                           : terms_.member(formula.terms[i], symbol.arguments[i]);
    if (last && (effect || event)) {
      value.needs.push_back(plain_literal(applied("step", {value.text})));
    }
    append(needs, value.needs);
    arguments.push_back(std::move(value));
  }
  return needs;
}

FormulaWriter::Part FormulaWriter::atom(const TypedFormula& formula) {
  Part part;
  std::vector<AspTerm> arguments;
  part.exists = needs_of_atom(formula, arguments);
  AspLiteral literal;
  literal.predicate = formula.predicate;
  AspBody lookups;
  for (const auto& argument : arguments) {
    literal.arguments.push_back(argument.text);
    append(lookups, argument.lookups);
  }
  literal.text = applied(names_.symbol(formula.predicate), literal.arguments);
  note_mention(formula, part, literal);
  for (const auto& completion : model_.completions) {
    if (completion.predicate == formula.predicate) part.completed.insert(formula.predicate);
  }
  auto negative = literal;
  negative.text = "not " + literal.text;
  negative.positive = false;
  AspBody when_true = lookups;
  AspBody when_false = lookups;
  when_true.push_back(literal);
  when_false.push_back(std::move(negative));
  part.when_false.push_back(std::move(when_false));
  part.when_true.push_back(std::move(when_true));
  if (point_ != nullptr && point_->predicate == formula.predicate) {
    except_point(literal, lookups, part);
  }
  return part;
}

/// Makes the atom at the point false and leaves the others as they are.
void FormulaWriter::except_point(const AspLiteral& literal, const AspBody& lookups,
                                 Part& part) const {
  if (literal.arguments.empty()) {  // the only atom of the predicate is the one taken for false
    part.when_true = constant(false);
    part.when_false = constant(true);
    return;
  }
  AspBody same = lookups;
  std::string here, there;
  for (std::size_t i = 0; i < literal.arguments.size(); ++i) {
    same.push_back(plain_literal(literal.arguments[i] + " = " + point_->arguments[i]));
    here += literal.arguments[i] + ",";
    there += point_->arguments[i] + ",";
  }
  part.when_false.push_back(std::move(same));
  part.when_true[0].push_back(plain_literal("(" + here + ") != (" + there + ")"));
}

void FormulaWriter::note_mention(const TypedFormula& formula, const Part& part,
                                 const AspLiteral& literal) {
  const auto& symbol = model_.symbols[formula.predicate];
  if (point_ != nullptr || std::none_of(symbol.arguments.begin(), symbol.arguments.end(),
                                        [&](SortId sort) { return terms_.is_unbounded(sort); })) {
    return;
  }
  std::vector<VariableId> variables;
  std::vector<TermId> visit = formula.terms;
  while (!visit.empty()) {
    const auto& term = model_.terms[visit.back()];
    visit.pop_back();
    visit.insert(visit.end(), term.arguments.begin(), term.arguments.end());
    if (term.kind == TermKind::kVariable) variables.push_back(term.variable);
  }
  auto body = terms_.domains(variables);
  append(body, part.exists);
  rules_ += rule_text(applied(mentioned(formula.predicate), literal.arguments), body);
}

}  // namespace parallax::compiler
