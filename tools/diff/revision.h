#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/compare/fact.h"
#include "compiler/compare/plan_facts.h"
#include "harness/config/scenario_settings.h"
#include "tools/app/context.h"
#include "tools/app/model_options.h"

namespace parallax::tools {

/// Prefix of the facts of a world that is a model.
inline constexpr std::string_view kWorldFact = "world: ";

enum class RevisionKind : std::uint8_t {
  kModel,     // .e
  kArtifact,  // .dec.cnf
  kScenario,  // .yaml: its models, plan, binding table, constraints and world model
  kPlan,      // .lisp
  kBinding,   // .bind
  kTraces,    // .jsonl, .ndjson
  kRun,       // a folder, or its report.json
  kRates,     // .json: what `parallax rates --json` prints
};

/// Kind of a revision by the name of its file or folder; none for other names.
std::optional<RevisionKind> kind_of(const std::string& path);
/// Models, compiled models and scenarios can be compared with one another.
bool has_traces(RevisionKind kind);

/// One side of a comparison of models.
struct ModelRevision {
  std::string name;  // as the user wrote it
  RevisionKind kind = RevisionKind::kModel;
  std::vector<compiler::Fact> facts;
  /// All further settings of a scenario.
  std::optional<harness::ScenarioSettings> settings = std::nullopt;
  std::optional<compiler::CompiledModel> compiled = std::nullopt;  // if traces are compared
  /// The facts are those of texts, so that a variant can be written from them and compiled.
  bool is_text = false;
  /// The command of an external simulator, with its files as the side has them.
  std::vector<std::string> command = {};
  /// The part of a plan that the compiled traces do not cover; empty: nothing is left out.
  std::string reservation = {};
};

/// Where one side of a comparison has the files that the command of a simulator names.
struct CommandFolder {
  std::filesystem::path root;  // of the side's files
  /// Folders that stand for the current one, where relative words are looked up.
  std::vector<std::filesystem::path> current;
  /// A file below one of these is at the same place below `root` on this side.
  std::vector<std::filesystem::path> others;
};

/// The command with its files as the side has them.
std::vector<std::string> command_of(std::vector<std::string> command, const CommandFolder& side);

/// SHA-256 over the contents of the files that the command names, as the side has them; without a
/// side, as they would be started here.
std::string hash_of_command(const std::vector<std::string>& command,
                            const std::optional<CommandFolder>& side);

struct LoadRevision {
  ModelOptions model;  // include folders, horizon, compat; `models` are put to every model (.e)
  bool compile = true;
  std::optional<CommandFolder> commands = std::nullopt;  // empty: the current folder
};

/// Reads and, if asked for, compiles one side.
base::Result<ModelRevision> load_model_revision(const std::string& path, RevisionKind kind,
                                                const LoadRevision& options, Context& context);

/// The facts of a compiled model, for comparing one with texts.
void use_artifact_facts(ModelRevision& revision);

/// A plan or a binding table.
struct PlanRevision {
  std::string name;
  std::vector<compiler::Fact> facts;
  std::optional<compiler::LispText> lisp;  // of a plan; its form i is fact i
};
base::Result<PlanRevision> load_plan_revision(const std::string& path, RevisionKind kind,
                                              Context& context);

}  // namespace parallax::tools
