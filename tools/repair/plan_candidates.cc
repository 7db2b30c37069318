#include "tools/repair/plan_candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <string_view>

#include "compiler/repair/axiom_form.h"
#include "compiler/sema/check.h"

namespace parallax::tools {

using compiler::BindingEntry;
using compiler::DatumId;
using compiler::PlanEdit;
using compiler::PlanText;

namespace {

constexpr std::size_t kMostInsertions = 320;
constexpr std::size_t kMostOfEntry = 64;  // actions that one entry of the binding table gives

/// The events that are performed by designators of these types.
bool performs_one_of(const PlanScope& scope, const std::set<std::string>& types,
                     const std::set<std::string>& events) {
  const auto& entries = scope.binding->entries;
  return std::any_of(entries.begin(), entries.end(), [&](const BindingEntry& entry) {
    return types.contains(entry.type) && events.contains(entry.event_symbol);
  });
}

/// A constant may be written as `:d-mid` or `d-mid`; both mean the same.
std::string without_colons(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = i == 0 || text[i - 1] == ' ' || text[i - 1] == '(' || text[i - 1] == '\'';
    if (text[i] != ':' || !begins) out += text[i];
  }
  return out;
}

std::vector<std::string> constants_of_argument(const PlanScope& scope, const std::string& symbol,
                                               std::size_t argument) {
  std::vector<std::string> out;
  const auto found = scope.typed->find_symbol(symbol);
  if (!found || argument >= scope.typed->symbols[*found].arguments.size()) return out;
  const auto sort = scope.typed->symbols[*found].arguments[argument];
  for (const auto& object : scope.typed->objects) {
    const bool fits = std::any_of(object.sorts.begin(), object.sorts.end(),
                                  [&](auto of) { return scope.typed->is_subsort(of, sort); });
    if (fits) out.push_back(object.name);
  }
  return out;
}

/// `(perform (an action (type closing) (arm left) ...))` for every choice of constants.
std::vector<std::string> actions_of_entry(const PlanScope& scope, const BindingEntry& entry) {
  std::vector<std::map<std::string, std::string>> ways = {{}};
  for (std::size_t i = 0; i < entry.event_arguments.size(); ++i) {
    const auto& variable = entry.event_arguments[i].text;
    // An entry with an argument of a mapping function gives no actions: the plan's own ones are
    // copied instead.
    if (!variable.starts_with('?')) return {};
    std::vector<std::map<std::string, std::string>> more;
    for (const auto& way : ways) {
      for (const auto& constant : constants_of_argument(scope, entry.event_symbol, i)) {
        auto& next = more.emplace_back(way);
        next[variable] = compiler::plan_name(constant);
      }
    }
    if (more.size() > kMostOfEntry) return {};
    ways = std::move(more);
  }
  const auto& plan = *scope.plan;
  std::vector<std::string> out;
  for (const auto& way : ways) {
    const bool motion = entry.kind == compiler::PerformKind::kMotion;
    std::string text =
        fmt::format("({} ({} {} (type {})", plan.prefixed("perform"),
                    plan.prefixed(motion ? "a" : "an"), motion ? "motion" : "action", entry.type);
    bool complete = true;
    for (const auto& key : entry.keys) {
      const auto value = way.find(key.variable);
      complete = complete && value != way.end();
      if (!complete) break;
      const auto property = key.property.value_or(key.key == "object" ? "name" : "");
      text += property.empty() ? fmt::format(" ({} {})", key.key, value->second)
                               : fmt::format(" ({} ({} object ({} {})))", key.key,
                                             plan.prefixed("an"), property, value->second);
    }
    if (complete) out.push_back(text + "))");
  }
  return out;
}

}  // namespace

std::vector<PlanEdit> plan_insertions(const PlanScope& scope, const std::set<std::string>& events) {
  std::vector<PlanEdit> out;
  int distance = 0;
  for (const auto site : scope.sites) {
    std::set<std::string> known;
    const auto add = [&](const std::string& text, int oddity) {
      if (out.size() == kMostInsertions || !known.insert(without_colons(text)).second) return;
      PlanEdit edit;
      edit.at = site;
      edit.action = text;
      edit.oddity = 1 + oddity + distance;  // a move adds nothing to the plan
      out.push_back(std::move(edit));
    };
    for (const auto& action : scope.plan->actions_for(site)) {
      if (performs_one_of(scope, action.types, events)) add(action.text, action.substituted);
    }
    for (const auto& entry : scope.binding->entries) {
      if (entry.plan || !events.contains(entry.event_symbol)) continue;
      for (const auto& text : actions_of_entry(scope, entry)) add(text, 2);
    }
    distance += 4;
  }
  return out;
}

std::vector<PlanEdit> plan_moves(const PlanScope& scope, const std::set<std::string>& events) {
  const auto& plan = *scope.plan;
  std::vector<PlanEdit> out;
  const auto count = static_cast<std::uint32_t>(plan.data().size());
  int distance = 0;
  for (const auto site : scope.sites) {
    const auto visible = plan.scope(site);
    for (std::uint32_t i = 0; i < count && i < plan.data().end_id().index(); ++i) {
      const DatumId form(i);
      const auto own = plan.data().is_list(form) ? plan.statement_around(form) : std::nullopt;
      if (own != form || form == site || !plan.same_body(form, site)) continue;
      if (plan.is_last_of_body(form) || plan.jumps(form)) continue;
      if (!performs_one_of(scope, plan.performed_types(form), events)) continue;
      PlanEdit edit;
      edit.kind = PlanEdit::Kind::kMove;
      edit.at = site;
      edit.moved = form;
      edit.oddity = distance;
      out.push_back(std::move(edit));
    }
    distance += 4;
  }
  return out;
}

namespace {

std::vector<PlanEdit> around(const PlanScope& scope, PlanEdit edit) {
  std::vector<PlanEdit> out;
  for (std::size_t i = 0; i < scope.failing.size(); ++i) {
    if (scope.plan->jumps(scope.failing[i])) continue;
    edit.at = scope.failing[i];
    edit.oddity = static_cast<int>(i);
    out.push_back(edit);
  }
  return out;
}

}  // namespace

std::vector<PlanEdit> plan_guards(const PlanScope& scope) {
  std::vector<PlanEdit> out;
  for (const auto& condition : scope.conditions) {
    PlanEdit edit;
    edit.kind = PlanEdit::Kind::kGuard;
    edit.condition = condition;
    for (auto& each : around(scope, edit)) out.push_back(std::move(each));
  }
  return out;
}

std::vector<PlanEdit> plan_handlers(const PlanScope& scope) {
  std::vector<PlanEdit> out;
  for (const auto kind : {PlanEdit::Kind::kRetry, PlanEdit::Kind::kHandle}) {
    PlanEdit edit;
    edit.kind = kind;
    edit.failure = scope.failure;
    for (auto& each : around(scope, edit)) out.push_back(std::move(each));
  }
  return out;
}

namespace {

void add_symbols(const compiler::Ast& ast, compiler::NodeId root, std::set<std::string>& out) {
  std::vector<compiler::NodeId> todo = {root};
  while (!todo.empty()) {
    const auto& node = ast[todo.back()];
    todo.pop_back();
    if (node.name_length > 0) out.emplace(ast.name(node));
    for (std::uint32_t i = 0; i < node.child_count; ++i) todo.push_back(ast.child(node, i));
  }
}

/// Does a formula with these symbols concern events, not states alone?
bool is_dynamic(const std::set<std::string>& symbols) {
  constexpr std::string_view kDynamic[] = {"Happens", "Initiates", "Terminates", "Releases"};
  return std::any_of(std::begin(kDynamic), std::end(kDynamic),
                     [&](auto name) { return symbols.contains(std::string(name)); });
}

/// The symbols in the conditions of the event's axioms.
std::set<std::string> asked_by(const compiler::ModelAst& ast,
                               const std::vector<compiler::AxiomForm>& forms,
                               const std::string& event) {
  std::set<std::string> out;
  for (const auto& form : forms) {
    if (form.event_symbol != event) continue;
    const auto& tree = ast.ast(form.place);
    if (form.condition) add_symbols(tree, *form.condition, out);
    if (form.kind == compiler::AxiomForm::Kind::kPrecondition) add_symbols(tree, form.head, out);
  }
  return out;
}

}  // namespace

std::set<std::string> events_that_matter(const std::string& model, const std::string& original,
                                         const std::string& event,
                                         const std::set<std::string>& fluents,
                                         const std::set<std::string>& defined, bool wide) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto ast = compiler::load_model_text(files.add("edited.e", model), ".", {}, files, sink);
  const auto old = compiler::load_model_text(files.add("old.e", original), ".", {}, files, sink);
  if (!ast || !old) return {};
  const auto forms = compiler::axiom_forms(*ast, files);
  auto asked = asked_by(*ast, forms, event);
  // Leaves out what the original model asks for already: it predicted that the step would go well.
  if (!wide) {
    for (const auto& name : asked_by(*old, compiler::axiom_forms(*old, files), event)) {
      asked.erase(name);
    }
  }
  asked.insert(fluents.begin(), fluents.end());
  // Fluents that define a relevant fluent are relevant, too.
  const auto define = [&] {
    for (std::size_t before = 0; before != asked.size();) {
      before = asked.size();
      for (const auto& place : ast->order) {
        const auto& statement = ast->statement(place);
        if (statement.kind != compiler::StatementKind::kFormula) continue;
        std::set<std::string> symbols;
        add_symbols(ast->ast(place), statement.formula, symbols);
        if (is_dynamic(symbols)) continue;
        const bool defines = std::any_of(defined.begin(), defined.end(), [&](const auto& name) {
          return asked.contains(name) && symbols.contains(name);
        });
        if (defines) asked.insert(symbols.begin(), symbols.end());
      }
    }
  };
  const auto acting = [&] {
    std::set<std::string> out;
    for (const auto& form : forms) {
      if (form.kind != compiler::AxiomForm::Kind::kEffects) continue;
      const auto& tree = ast->ast(form.place);
      for (const auto effect : form.effects) {
        const auto parts = compiler::effect_parts(tree, effect);
        if (parts && asked.contains(std::string(tree.name(tree[parts->fluent])))) {
          out.insert(form.event_symbol);
        }
      }
    }
    return out;
  };
  define();
  auto out = acting();
  if (!wide) return out;
  for (const auto& symbol : out) {
    const auto more = asked_by(*ast, forms, symbol);
    asked.insert(more.begin(), more.end());
  }
  define();
  return acting();
}

}  // namespace parallax::tools
