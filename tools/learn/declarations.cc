#include "tools/learn/declarations.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "compiler/repair/axiom_form.h"
#include "compiler/syntax/printer.h"

namespace parallax::tools {
namespace {

using compiler::Ast;
using compiler::NodeId;
using compiler::NodeKind;
using compiler::Statement;
using compiler::StatementKind;

constexpr std::array<std::string_view, 6> kAboutEvents = {
    "Happens", "Initiates", "Terminates", "Releases", "Trajectory", "AntiTrajectory"};
constexpr std::array<std::string_view, 2> kImplicit = {"foundations/Root.e", "foundations/EC.e"};

enum class About : std::uint8_t { kStates, kStart, kEvents };

About about_formula(const Ast& ast, const Statement& statement) {
  auto out = About::kStates;
  for (auto i = statement.first_node.index(); i <= statement.formula.index(); ++i) {
    const auto& node = ast[NodeId(i)];
    if (node.kind != NodeKind::kApply) continue;
    const auto name = ast.name(node);
    if (std::find(kAboutEvents.begin(), kAboutEvents.end(), name) != kAboutEvents.end()) {
      return About::kEvents;
    }
    const bool timed = (name == "HoldsAt" || name == "ReleasedAt") && node.child_count == 2;
    if (timed && ast[ast.child(node, 1)].kind == NodeKind::kNumber) out = About::kStart;
  }
  return out;
}

bool mentions(const Ast& ast, const Statement& statement, std::string_view word) {
  for (auto i = statement.first_node.index(); i <= statement.formula.index(); ++i) {
    const auto& node = ast[NodeId(i)];
    if (node.kind == NodeKind::kApply && ast.name(node) == word) return true;
  }
  return false;
}

/// "time2" is a variable of the sort `time`.
bool is_time(std::string_view variable) {
  const auto last = variable.find_last_not_of("0123456789");
  return last != std::string_view::npos && variable.substr(0, last + 1) == "time";
}

/// `HoldsAt(F(x1,..,xn),time) <-> right`, with the variables that are quantified in front.
std::optional<StateFormula::Definition> definition_of(const Ast& ast, NodeId body,
                                                      const StateFormula& formula,
                                                      const compiler::TypedModel& typed) {
  const auto& root = ast[body];
  const bool iff = root.kind == NodeKind::kBinary && root.op == compiler::Operator::kIff &&
                   root.child_count == 2;
  if (!iff || formula.time.empty()) return std::nullopt;
  const auto& left = ast[ast.child(root, 0)];
  const bool holds =
      left.kind == NodeKind::kApply && ast.name(left) == "HoldsAt" && left.child_count == 2;
  if (!holds || ast.name(ast[ast.child(left, 1)]) != formula.time) return std::nullopt;
  const auto& fluent = ast[ast.child(left, 0)];
  StateFormula::Definition out;
  out.fluent = std::string(ast.name(fluent));
  const auto declared = std::find_if(typed.symbols.begin(), typed.symbols.end(),
                                     [&](const auto& symbol) { return symbol.name == out.fluent; });
  if (fluent.kind != NodeKind::kApply || declared == typed.symbols.end() ||
      !declared->noninertial) {
    return std::nullopt;
  }
  for (std::uint32_t i = 0; i < fluent.child_count; ++i) {
    const auto& argument = ast[ast.child(fluent, i)];
    if (argument.kind != NodeKind::kName) return std::nullopt;
    const std::string name(ast.name(argument));
    const auto& known = formula.variables;
    if (std::find(known.begin(), known.end(), name) == known.end()) return std::nullopt;
    const auto& others = out.arguments;
    if (std::find(others.begin(), others.end(), name) != others.end()) return std::nullopt;
    out.arguments.push_back(name);
  }
  // Other variables quantified in front would be quantified in each half separately.
  if (out.arguments.size() + 1 != formula.variables.size()) return std::nullopt;
  out.left = compiler::print_formula(ast, ast.child(root, 0));
  out.right = compiler::print_formula(ast, ast.child(root, 1));
  return out;
}

StateFormula state_formula(const DomainModel& model, const Ast& ast, const Statement& statement,
                           std::string text) {
  StateFormula out;
  out.text = std::move(text);
  out.place = model.files.place(ast.source(statement.source));
  auto body = statement.formula;
  while (ast[body].kind == NodeKind::kForall) {
    const auto& node = ast[body];
    for (std::uint32_t i = 0; i + 1 < node.child_count; ++i) {
      out.variables.emplace_back(ast.name(ast[ast.child(node, i)]));
      if (out.time.empty() && is_time(out.variables.back())) out.time = out.variables.back();
    }
    body = ast.child(node, node.child_count - 1);
  }
  out.body = compiler::print_formula(ast, body);
  out.definition = definition_of(ast, body, out, *model.typed);
  return out;
}

About about(const Ast& ast, const Statement& statement) {
  const auto kind = statement.kind;
  if (kind == StatementKind::kFormula) return about_formula(ast, statement);
  const bool events = kind == StatementKind::kXor || kind == StatementKind::kMutex ||
                      kind == StatementKind::kCompletion;
  return events ? About::kEvents : About::kStates;
}

}  // namespace

std::string StateFormula::quantifier() const {
  std::string out;
  for (const auto& variable : variables) out += (out.empty() ? "[" : ",") + variable;
  return out.empty() ? out : out + "] ";
}

Declarations declarations_of(const DomainModel& model) {
  Declarations out;
  std::set<std::string> foundations;
  auto last = StatementKind::kOption;
  for (const auto& place : model.ast.order) {
    const auto& ast = model.ast.ast(place);
    const auto& statement = model.ast.statement(place);
    const auto& file = model.files[ast.file()];
    if (model.ast.files[place.file].built_in) {
      const bool implicit =
          std::find(kImplicit.begin(), kImplicit.end(), file.name()) != kImplicit.end();
      if (!implicit && foundations.insert(file.name()).second) {
        out.states.push_back({"load " + file.name() + "\n", std::nullopt});
      }
      continue;
    }
    const auto kind = about(ast, statement);
    if (kind == About::kEvents) {
      ++out.dropped;
      continue;
    }
    const auto whole = file.text();
    const auto end = statement.kind == StatementKind::kFormula
                         ? compiler::end_of_formula(whole, statement.source.end)
                         : statement.source.end;
    std::string text(whole.substr(statement.source.begin, end - statement.source.begin));
    text += "\n";
    if (kind == About::kStart) {
      out.start += text;
      continue;
    }
    Declarations::Piece piece;
    // A blank line between kinds of statements, as a person would leave it.
    if (statement.kind != last && !out.states.empty()) piece.text = "\n";
    last = statement.kind;
    if (statement.kind == StatementKind::kFormula && mentions(ast, statement, "HoldsAt")) {
      piece.formula = out.formulas.size();
      out.formulas.push_back(state_formula(model, ast, statement, text));
    } else {
      piece.text += text;
    }
    out.states.push_back(std::move(piece));
  }
  return out;
}

}  // namespace parallax::tools
