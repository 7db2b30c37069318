#include "tools/app/emit_stage.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "compiler/asp/asp_export.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/word_table.h"
#include "compiler/cnf/encoder.h"
#include "compiler/ground/grounder.h"
#include "compiler/sema/check.h"
#include "compiler/sema/model_text.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/loader.h"
#include "compiler/syntax/printer.h"
#include "harness/config/scenario.h"
#include "tools/app/file_kind.h"

namespace parallax::tools {
namespace {

constexpr auto kTokenWords = base::word_table<compiler::TokenKind>(
    "name", "number", "operator", "bracket", "bracket", "bracket", "bracket", "bracket", "bracket",
    "comma", "period", "colon", "statement", "end");

void append_tokens(base::FileId id, Context& context, std::string& out) {
  const auto& file = context.files()[id];
  const auto size = static_cast<std::uint32_t>(file.text().size());
  compiler::Lexer lexer({id, 0, size}, file.text(), compiler::Lexer::Mode::kFile, context.sink());
  out += "; " + file.name() + '\n';
  while (lexer.peek().kind != compiler::TokenKind::kEnd) {
    const auto token = lexer.peek();
    const bool statement = token.kind == compiler::TokenKind::kStatementLine;
    auto text = file.text({id, token.begin, token.end});
    while (!text.empty() && compiler::is_blank(text.back())) text.remove_suffix(1);
    const auto place = file.position(token.begin);
    out += fmt::format("{}:{} {} {}\n", place.line, place.column, kTokenWords.of(token.kind), text);
    if (statement) {
      lexer.skip_statement();
    } else {
      lexer.next();
    }
  }
}

std::string tokens(const ModelOptions& options, Context& context) {
  std::string out;
  for (const auto& path : options.models) {
    const auto file = base::load_text(path, context.files(), context.sink());
    if (file) append_tokens(*file, context, out);
  }
  return out;
}

std::string statements(const compiler::ModelAst& ast, const base::SourceFiles& files) {
  std::string out;
  for (const auto& file : ast.files) {
    if (file.built_in) continue;
    out += "; " + files[file.ast.file()].name() + '\n' + compiler::print_file(file.ast);
  }
  return out;
}

std::string typed(const compiler::ModelAst& ast, const compiler::CheckOptions& check,
                  Context& context) {
  const auto model = compiler::check_model(ast, context.files(), context.sink(), check);
  if (!model) return {};
  std::string loads;
  for (const auto& file : ast.files) {
    if (file.built_in) loads += "load " + context.files()[file.ast.file()].name() + '\n';
  }
  return loads + compiler::to_text(*model, [&](const base::SourceRange& range) {
           return std::none_of(ast.files.begin(), ast.files.end(), [&](const auto& file) {
             return !file.built_in && file.ast.file() == range.file;
           });
         });
}

/// The atoms of user predicates that the compiled model has. None: it cannot be grounded, but may
/// still be handed to another solver.
std::optional<std::vector<std::string>> open_atoms(const compiler::TypedModel& model,
                                                   const compiler::GroundOptions& options) {
  base::DiagnosticSink silent;
  auto ground = compiler::ground_model(model, options, silent);
  if (!ground) return std::nullopt;
  std::vector<std::string> atoms;
  for (const auto& atom : compiler::encode(*ground).fixed) {
    if (atom.kind == compiler::AtomKind::kPredicate) atoms.push_back(atom.name);
  }
  std::sort(atoms.begin(), atoms.end());
  return atoms;
}

std::string logic_program(const compiler::ModelAst& ast, const compiler::CheckOptions& check,
                          const ModelOptions& options, Context& context) {
  auto& sink = context.sink();
  if (!options.compat.empty()) {
    sink.error_about(codes::kUsage, "", "--emit=lp has the standard meaning only; drop --compat");
    return {};
  }
  const auto model = compiler::check_model(ast, context.files(), sink, check);
  if (!model) return {};
  compiler::AspOptions asp;
  std::string remark;
  if (compiler::has_user_predicates(*model)) {
    asp.open_atoms = open_atoms(*model, compile_input(options, context).ground);
    if (!asp.open_atoms) {
      remark = "% The model could not be grounded: every atom of its predicates may be true.\n";
    }
  }
  auto program = compiler::to_asp(*model, context.files(), asp, sink);
  return program ? remark + program->text : std::string();
}

/// The options as if the model of the scenario had been named.
ModelOptions model_of(const harness::Scenario& scenario, ModelOptions options) {
  options.models.clear();
  for (const auto& model : scenario.models) options.models.push_back(model.text);
  if (options.horizon < 0) options.horizon = scenario.horizon;
  return options;
}

}  // namespace

std::vector<compiler::PassInfo> emit_stages() {
  std::vector<compiler::PassInfo> stages = {
      {"tokens", "words of the files with their places"},
      {"ast", "statements, one a line"},
      {"typed", "the checked model; a model again"},
      {"lp", "the checked model as a logic program for clingo"}};
  const auto passes = compiler::compile_passes();
  stages.insert(stages.end(), passes.begin(), passes.end());
  stages.push_back({"cnf", "the compiled model: DIMACS with symbols"});
  stages.push_back({"cfg", "the plan's control flow"});
  stages.push_back({"cfg-dot", "the same as a picture for Graphviz"});
  return stages;
}

std::string stage_list() {
  std::string list;
  for (const auto& stage : emit_stages()) {
    list += fmt::format("{:<18}{}\n", stage.name, stage.description);
  }
  return list;
}

bool is_front_end_stage(std::string_view stage) {
  return stage == "tokens" || stage == "ast" || stage == "typed" || stage == "lp";
}

base::Result<std::string> front_end_text(std::string_view stage, const ModelOptions& options,
                                         Context& context) {
  auto& sink = context.sink();
  if (file_kind(options.models.front()) == FileKind::kScenario && options.models.size() == 1) {
    const auto scenario = harness::load_scenario(options.models.front(), context.files(), sink);
    if (!scenario) return sink.already_reported();
    if (!scenario->plan.empty() || !scenario->constraints.empty()) {
      context.remark(
          fmt::format("--emit={} shows the model alone, without plan and constraints", stage));
    }
    return front_end_text(stage, model_of(*scenario, options), context);
  }
  for (const auto& path : options.models) {
    (void)expect_kind(path, {FileKind::kModel}, "a model", context);
  }
  if (sink.has_errors()) return sink.already_reported();
  std::string text;
  if (stage == "tokens") {
    text = tokens(options, context);
  } else {
    const auto input = compile_input(options, context);
    const auto ast = compiler::load_model(input.models, input.load, context.files(), sink);
    if (!ast) return sink.already_reported();
    compiler::CheckOptions check;
    if (input.horizon) {
      check.time_lower = 0;
      check.time_upper = input.horizon;
    }
    text = stage == "ast"  ? statements(*ast, context.files())
           : stage == "lp" ? logic_program(*ast, check, options, context)
                           : typed(*ast, check, context);
  }
  if (sink.has_errors()) return sink.already_reported();
  return text;
}

}  // namespace parallax::tools
