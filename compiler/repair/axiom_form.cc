#include "compiler/repair/axiom_form.h"

#include <algorithm>
#include <set>

#include "compiler/base/ascii.h"

namespace parallax::compiler {
namespace {

constexpr std::string_view kStartTime = "0";

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// The first character from `at` on that is neither blank nor part of a comment.
std::uint32_t skip(std::string_view text, std::uint32_t at) {
  while (at < text.size()) {
    if (text[at] == ';') {
      while (at < text.size() && text[at] != '\n') ++at;
    } else if (is_space(text[at])) {
      ++at;
    } else {
      break;
    }
  }
  return at;
}

std::uint32_t end_of(const ModelAst& model, const base::SourceFiles& files,
                     const ModelAst::Place& place) {
  const auto& statement = model.statement(place);
  if (statement.kind != StatementKind::kFormula) return statement.source.end;
  return end_of_formula(files[model.ast(place).file()].text(), statement.source.end);
}

void flatten(const Ast& ast, NodeId node, std::vector<NodeId>& out) {
  if (ast[node].kind != NodeKind::kBinary || ast[node].op != Operator::kAnd) {
    out.push_back(node);
    return;
  }
  for (std::uint32_t i = 0; i < ast[node].child_count; ++i) {
    flatten(ast, ast.child(ast[node], i), out);
  }
}

std::vector<NodeId> conjuncts_of(const Ast& ast, NodeId node) {
  std::vector<NodeId> out;
  flatten(ast, node, out);
  return out;
}

bool is_call(const Ast& ast, NodeId node, std::string_view name, std::uint32_t arguments) {
  return ast[node].kind == NodeKind::kApply && ast[node].child_count == arguments &&
         ast.name(ast[node]) == name;
}

/// Event, and time as a variable, of the form; false if they are anything else.
bool name_event(const Ast& ast, NodeId event, NodeId time, AxiomForm& form) {
  if (ast[event].kind != NodeKind::kApply || ast[time].kind != NodeKind::kName) return false;
  const std::string variable(ast.name(ast[time]));
  if (std::find(form.variables.begin(), form.variables.end(), variable) == form.variables.end()) {
    return false;
  }
  const std::string symbol(ast.name(ast[event]));
  if (!form.event_symbol.empty() && (form.event_symbol != symbol || form.time != variable)) {
    return false;
  }
  form.event = event;
  form.event_symbol = symbol;
  form.time = variable;
  return true;
}

bool read_effects(const Ast& ast, AxiomForm& form) {
  form.effects = conjuncts_of(ast, form.head);
  return std::all_of(form.effects.begin(), form.effects.end(), [&](NodeId effect) {
    const auto parts = effect_parts(ast, effect);
    return parts && name_event(ast, parts->event, parts->time, form);
  });
}

/// `Happens(E,time-k) & ... -> Initiates(E2,F,time) & ...`: E is the event of the form.
bool read_late_effects(const Ast& ast, AxiomForm& form) {
  form.effects = conjuncts_of(ast, form.head);
  for (const auto effect : form.effects) {
    const auto parts = effect_parts(ast, effect);
    if (!parts || ast[parts->time].kind != NodeKind::kName) return false;
    form.time = ast.name(ast[parts->time]);
  }
  for (const auto conjunct : form.conjuncts) {
    if (!is_call(ast, conjunct, "Happens", 2)) continue;
    const auto event = ast.child(ast[conjunct], 0);
    const auto& time = ast[ast.child(ast[conjunct], 1)];
    const bool earlier = time.kind == NodeKind::kBinary && time.op == Operator::kSubtract &&
                         ast.name(ast[ast.child(time, 0)]) == form.time;
    if (!earlier || ast[event].kind != NodeKind::kApply) continue;
    form.kind = AxiomForm::Kind::kLateEffects;
    form.event = event;
    form.event_symbol = ast.name(ast[event]);
    return true;
  }
  return false;
}

bool read_precondition(const Ast& ast, AxiomForm& form) {
  if (!form.condition) return false;
  for (const auto conjunct : form.conjuncts) {
    if (!is_call(ast, conjunct, "Happens", 2)) continue;
    const auto& node = ast[conjunct];
    if (!name_event(ast, ast.child(node, 0), ast.child(node, 1), form)) return false;
  }
  form.kind = AxiomForm::Kind::kPrecondition;
  return !form.event_symbol.empty();
}

bool read_trigger(const Ast& ast, AxiomForm& form) {
  if (!form.condition || !is_call(ast, form.head, "Happens", 2)) return false;
  const auto& node = ast[form.head];
  form.kind = AxiomForm::Kind::kTrigger;
  return name_event(ast, ast.child(node, 0), ast.child(node, 1), form);
}

/// `Terminates(event,F,time) & ... -> Initiates(event,G,time) & ...`, with one variable for the
/// event of all effects.
bool read_ramification(const Ast& ast, AxiomForm& form) {
  if (!form.condition) return false;
  form.effects = conjuncts_of(ast, form.head);
  std::string event;
  const auto is_of_event = [&](NodeId atom) {
    const auto parts = effect_parts(ast, atom);
    if (!parts || ast[parts->event].kind != NodeKind::kName ||
        ast[parts->time].kind != NodeKind::kName) {
      return false;
    }
    const std::string name(ast.name(ast[parts->event])), time(ast.name(ast[parts->time]));
    const bool same = event.empty() || (event == name && form.time == time);
    event = name;
    form.time = time;
    form.event = parts->event;
    return same;
  };
  const auto is_variable = [&](const std::string& name) {
    return std::find(form.variables.begin(), form.variables.end(), name) != form.variables.end();
  };
  if (!std::all_of(form.effects.begin(), form.effects.end(), is_of_event)) return false;
  form.kind = AxiomForm::Kind::kRamification;
  return is_variable(event) && is_variable(form.time) &&
         std::any_of(form.conjuncts.begin(), form.conjuncts.end(), is_of_event);
}

/// Is it about fluents at the time of one variable, or at timepoint 0, and about nothing that
/// happens? Sets the time.
bool is_about_states(const Ast& ast, NodeId root, AxiomForm& form) {
  std::vector<NodeId> open = {root};
  while (!open.empty()) {
    const auto& node = ast[open.back()];
    open.pop_back();
    if (node.kind == NodeKind::kUnary && is_temporal(node.op)) return false;
    if (node.kind == NodeKind::kApply && ast.name(node) == "HoldsAt") {
      if (node.child_count != 2) return false;
      const auto& time = ast[ast.child(node, 1)];
      const bool start = time.kind == NodeKind::kNumber && ast.name(time) == kStartTime;
      if (time.kind != NodeKind::kName && !start) return false;
      const std::string variable(ast.name(time));
      if (!form.time.empty() && form.time != variable) return false;
      form.time = variable;
      continue;
    }
    if (node.kind == NodeKind::kApply) {
      for (const auto* name : {"Happens", "Initiates", "Terminates", "Releases", "ReleasedAt",
                               "Trajectory", "AntiTrajectory"}) {
        if (ast.name(node) == name) return false;
      }
    }
    for (std::uint32_t i = 0; i < node.child_count; ++i) open.push_back(ast.child(node, i));
  }
  return form.time == kStartTime ||
         std::find(form.variables.begin(), form.variables.end(), form.time) != form.variables.end();
}

/// Variables, condition and head of a formula.
AxiomForm outline(const Ast& ast, const Statement& statement) {
  AxiomForm form;
  form.kind = AxiomForm::Kind::kOther;
  auto node = statement.formula;
  while (ast[node].kind == NodeKind::kForall) {
    const auto count = ast[node].child_count;
    for (std::uint32_t i = 0; i + 1 < count; ++i) {
      form.variables.emplace_back(ast.name(ast[ast.child(ast[node], i)]));
    }
    node = ast.child(ast[node], count - 1);
  }
  form.head = form.body = node;
  if (ast[node].kind == NodeKind::kBinary && ast[node].op == Operator::kImplies) {
    form.condition = ast.child(ast[node], 0);
    form.conjuncts = conjuncts_of(ast, *form.condition);
    form.head = ast.child(ast[node], 1);
  }
  return form;
}

AxiomForm read_form(const Ast& ast, const Statement& statement) {
  auto form = outline(ast, statement);
  form.kind = AxiomForm::Kind::kEffects;
  if (read_effects(ast, form)) return form;
  form.effects.clear();
  form.event_symbol.clear();
  if (read_late_effects(ast, form)) return form;
  form.effects.clear();
  form.event_symbol.clear();
  if (auto of_any = outline(ast, statement); read_ramification(ast, of_any)) return of_any;
  if (read_precondition(ast, form)) return form;
  form.event_symbol.clear();
  if (read_trigger(ast, form)) return form;
  form = outline(ast, statement);
  auto about_states = form;
  if (!is_about_states(ast, form.body, about_states)) return form;
  about_states.kind =
      about_states.time == kStartTime ? AxiomForm::Kind::kStart : AxiomForm::Kind::kState;
  return about_states;
}

}  // namespace

std::optional<EffectParts> effect_parts(const Ast& ast, NodeId atom) {
  if (!is_call(ast, atom, "Initiates", 3) && !is_call(ast, atom, "Terminates", 3) &&
      !is_call(ast, atom, "Releases", 3)) {
    return std::nullopt;
  }
  const auto& node = ast[atom];
  return EffectParts{ast.child(node, 0), ast.child(node, 1), ast.child(node, 2)};
}

TextExtent with_parentheses(std::string_view text, const Node& node, std::uint32_t from,
                            std::uint32_t to) {
  TextExtent out{node.begin, node.end};
  while (true) {
    auto before = out.begin, after = out.end;
    while (before > from && is_space(text[before - 1])) --before;
    while (after < to && is_space(text[after])) ++after;
    if (before <= from || after >= to || text[before - 1] != '(' || text[after] != ')') return out;
    out = {before - 1, after + 1};
  }
}

std::uint32_t end_of_formula(std::string_view text, std::uint32_t end) {
  auto at = end;
  while (true) {
    at = skip(text, at);
    if (at >= text.size() || (text[at] != ')' && text[at] != '.')) return end;
    end = ++at;
    if (text[at - 1] == '.') return end;
  }
}

std::vector<AxiomForm> all_forms(const ModelAst& model, const base::SourceFiles& files) {
  std::vector<AxiomForm> out;
  for (const auto& place : model.order) {
    const auto& statement = model.statement(place);
    if (model.files[place.file].built_in || statement.kind != StatementKind::kFormula) continue;
    auto form = read_form(model.ast(place), statement);
    form.place = place;
    form.begin = statement.source.begin;
    form.end = end_of(model, files, place);
    out.push_back(std::move(form));
  }
  return out;
}

std::vector<AxiomForm> axiom_forms(const ModelAst& model, const base::SourceFiles& files) {
  auto out = repairable_forms(model, files);
  std::erase_if(out, [](const auto& form) {
    return form.event_symbol.empty() || form.kind == AxiomForm::Kind::kLateEffects;
  });
  return out;
}

std::vector<AxiomForm> repairable_forms(const ModelAst& model, const base::SourceFiles& files) {
  auto out = all_forms(model, files);
  std::erase_if(out, [](const auto& form) { return form.kind == AxiomForm::Kind::kOther; });
  return out;
}

std::string changed_text(std::string_view text, base::FileId file,
                         std::vector<TextChange> changes) {
  std::erase_if(changes, [&](const auto& change) { return change.file != file; });
  std::stable_sort(changes.begin(), changes.end(), [](const auto& a, const auto& b) {
    return a.begin != b.begin ? a.begin < b.begin : a.end < b.end;
  });
  std::string out;
  std::size_t at = 0;
  for (const auto& change : changes) {
    const auto begin = std::max<std::size_t>(at, change.begin);
    out += text.substr(at, begin - at);
    out += change.text;
    at = std::max<std::size_t>(begin, change.end);
  }
  return out.append(text.substr(at));
}

std::string flat_text(const ModelAst& model, const base::SourceFiles& files,
                      const std::vector<TextChange>& changes) {
  std::string out;
  std::set<std::uint32_t> foundations;
  for (const auto& place : model.order) {
    const auto& ast = model.ast(place);
    const auto& source = model.statement(place).source;
    if (model.files[place.file].built_in) {
      if (foundations.insert(place.file).second) {
        out += "load " + files[ast.file()].name() + "\n";
      }
      continue;
    }
    const auto end = end_of(model, files, place);
    // Moved to the statement's own text; a change may take the line's end with it.
    std::vector<TextChange> own;
    for (auto change : changes) {
      if (change.file != ast.file() || change.begin < source.begin || change.begin > end) continue;
      change.begin -= source.begin;
      change.end = std::min(change.end, end) - source.begin;
      own.push_back(std::move(change));
    }
    const auto text = files[ast.file()].text().substr(source.begin, end - source.begin);
    out += changed_text(text, ast.file(), std::move(own)) + "\n";
  }
  return out;
}

}  // namespace parallax::compiler
