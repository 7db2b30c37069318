#include "tools/learn/declarations.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "compiler/repair/axiom_form.h"

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

About about(const Ast& ast, const Statement& statement) {
  const auto kind = statement.kind;
  if (kind == StatementKind::kFormula) return about_formula(ast, statement);
  const bool events = kind == StatementKind::kXor || kind == StatementKind::kMutex ||
                      kind == StatementKind::kCompletion;
  return events ? About::kEvents : About::kStates;
}

}  // namespace

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
        out.states += "load " + file.name() + "\n";
      }
      continue;
    }
    const auto kind = about(ast, statement);
    if (kind == About::kEvents) {
      ++out.dropped;
      continue;
    }
    const auto text = file.text();
    const auto end = statement.kind == StatementKind::kFormula
                         ? compiler::end_of_formula(text, statement.source.end)
                         : statement.source.end;
    auto& to = kind == About::kStart ? out.start : out.states;
    // A blank line between kinds of statements, as a person would leave it.
    if (kind == About::kStates && statement.kind != last && !to.empty()) to += "\n";
    if (kind == About::kStates) last = statement.kind;
    to += std::string(text.substr(statement.source.begin, end - statement.source.begin)) + "\n";
  }
  return out;
}

}  // namespace parallax::tools
