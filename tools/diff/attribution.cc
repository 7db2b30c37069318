#include "tools/diff/attribution.h"

#include <algorithm>
#include <set>

#include "compiler/cnf/encoder.h"
#include "compiler/compare/model_facts.h"
#include "compiler/ground/grounder.h"
#include "compiler/sema/check.h"
#include "runtime/session/solver_session.h"

namespace parallax::tools {
namespace {

using compiler::AtomKind;
using compiler::CompiledModel;
using compiler::Fact;
using compiler::Literal;
using compiler::Timepoint;

/// None if the text is no right model.
std::optional<CompiledModel> compile_text(const std::string& text, Timepoint horizon,
                                          const ModelOptions& options, Context& context) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto input = compile_input(options, context);
  const auto file = files.add("variant.e", text);
  const auto ast = compiler::load_model_text(file, ".", input.load, files, sink);
  if (!ast) return std::nullopt;
  compiler::CheckOptions check;
  check.time_lower = 0;
  check.time_upper = horizon;
  const auto typed = compiler::check_model(*ast, files, sink, check);
  if (!typed) return std::nullopt;
  auto ground = compiler::ground_model(*typed, input.ground, sink);
  if (!ground) return std::nullopt;
  return compiler::encode(*ground);
}

/// Has the model a trace with these observables?
base::Known admits(const CompiledModel& model, const runtime::Trace& trace,
                   const runtime::SharedVocabulary& vocabulary, const Context& context) {
  const compiler::AtomIndex index(model);
  std::vector<Literal> observation;
  for (const auto& atom : vocabulary.shared) {
    const auto& name = vocabulary.names[atom.name];
    const auto& point = trace.points[static_cast<std::size_t>(atom.time)];
    // The trace is of another model: it has ids of its own.
    bool is_true = false;
    if (atom.kind == AtomKind::kHoldsAt) {
      const auto fluent = trace.symbols->fluent(name);
      is_true = fluent && runtime::contains(point.holds, *fluent);
    } else {
      const auto event = trace.symbols->event(name);
      is_true = event && runtime::contains(point.happens, *event);
    }
    const auto literal = index.find(atom.kind, name, atom.time);
    if (!literal && is_true) return base::Known::kNo;
    if (literal) observation.push_back(is_true ? *literal : ~*literal);
  }
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()));
  return runtime::possible(session.solve(model.horizon, observation));
}

/// The refusing revision with some edits undone, as a text.
std::string variant(const std::vector<Fact>& kept, const std::vector<Fact>& refused,
                    const std::vector<Edit>& undone) {
  std::set<std::pair<compiler::FactKind, std::string>> without;
  std::vector<Fact> facts;
  for (const auto& edit : undone) {
    if (edit.kept) facts.push_back(kept[*edit.kept]);
    if (edit.refused) without.emplace(refused[*edit.refused].kind, refused[*edit.refused].text);
  }
  for (const auto& fact : refused) {
    if (!without.contains({fact.kind, fact.text})) facts.push_back(fact);
  }
  return compiler::canonical_text(facts);
}

}  // namespace

std::optional<std::vector<Edit>> responsible_edits(const std::vector<Fact>& kept,
                                                   const std::vector<Fact>& refused,
                                                   const std::vector<Edit>& edits,
                                                   const runtime::Trace& trace,
                                                   const runtime::SharedVocabulary& vocabulary,
                                                   const ModelOptions& options, Context& context) {
  if (edits.size() > kMaxTriedEdits) return std::nullopt;
  auto undone = edits;
  // One edit alone is responsible for what it brings.
  for (std::size_t i = 0; i < undone.size() && undone.size() > 1;) {
    auto fewer = undone;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
    const auto model =
        compile_text(variant(kept, refused, fewer), trace.length(), options, context);
    const auto admitted = model ? admits(*model, trace, vocabulary, context) : base::Known::kNo;
    if (admitted == base::Known::kUndecided || context.stopped()) return std::nullopt;
    if (admitted == base::Known::kYes) {
      undone = std::move(fewer);
    } else {
      ++i;
    }
  }
  return undone;
}

}  // namespace parallax::tools
