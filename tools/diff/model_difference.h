#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/compare/fact.h"
#include "runtime/compare/trace_difference.h"
#include "tools/app/model_options.h"
#include "tools/diff/renaming.h"
#include "tools/diff/revision.h"
#include "tools/diff/settings_difference.h"

namespace parallax::tools {

/// A fact of one revision that the other lacks, or one that replaces another.
struct RevisionEdit {
  std::optional<std::size_t> kept;     // of the revision that has the trace
  std::optional<std::size_t> refused;  // of the revision that has it not
};

/// Limit on edits in the search for responsible ones; each tried one costs a compilation.
inline constexpr std::size_t kMaxTriedEdits = 24;

/// A minimal set of edits such that the revision without the trace has it when these are undone and
/// all others stay ("sufficient" in the sense of Maoz and Ringert 2018, and no proper subset is).
/// Found by undoing all and restoring them one by one, as long as any can be restored; the subsets
/// of a small set are all tried. A variant that is not a valid model counts as one without the
/// trace. None if there are more than kMaxTriedEdits.
std::optional<std::vector<RevisionEdit>> responsible_edits(
    const std::vector<compiler::Fact>& kept, const std::vector<compiler::Fact>& refused,
    const std::vector<RevisionEdit>& edits, const runtime::Trace& trace,
    const runtime::SharedVocabulary& vocabulary, const ModelOptions& options, Context& context);

/// Two lists of facts and their differences; the lists outlive it.
struct FactReport {
  const std::vector<compiler::Fact>& old_facts;
  const std::vector<compiler::Fact>& new_facts;
  compiler::FactDifference difference;
};
FactReport compare(const std::vector<compiler::Fact>& old_facts,
                   const std::vector<compiler::Fact>& new_facts);

/// The part of the difference that is of one kind.
compiler::FactDifference of_kind(const FactReport& report, compiler::FactKind kind);

/// "TITLE: 1 removed, 2 added" and a line for each, in the order of the texts; with `stat` the
/// first line alone. Empty if there is no difference of the kind.
std::string to_text(const FactReport& report, compiler::FactKind kind, const std::string& title,
                    bool stat);

/// {"removed": [{"text", "file", "line"}], "added": [...], "changed": [{"old": {...}, "new":
/// {...}}]}
std::string to_json(const FactReport& report, compiler::FactKind kind);

struct ModelDiffOptions {
  LoadRevision load;
  /// Where each side has the files of a simulator's command, instead of `load.commands`.
  std::optional<CommandFolder> old_commands = std::nullopt, new_commands = std::nullopt;
  /// The models and options of each side, where they differ, instead of `load.model`.
  std::optional<ModelOptions> old_model = std::nullopt, new_model = std::nullopt;
  bool facts = true;   // compare declarations, axioms and, of scenarios, settings
  bool traces = true;  // compare meaning
  /// Names of the old side that have others in the new one; and whether more of them are looked
  /// for, if facts are compared. A gate does not look for them: a rule is about what is written.
  std::vector<Renaming> renamings = {};
  bool find_renamings = false;
  std::size_t list_limit = 200;
};

/// Each of two scenarios has the files of its simulator's command beside it, or from the marked
/// root of its project; only what is not there counts from the current folder. Does nothing where
/// the options say it already, or both lie in one folder.
void add_scenario_folders(const std::string& old_path, const std::string& new_path,
                          ModelDiffOptions& options);

/// Everything that is known of the difference of two models.
struct ModelDifference {
  ModelRevision old_side, new_side;
  /// The horizons of both sides; traces are compared up to the smaller one.
  compiler::Timepoint old_horizon = 0, new_horizon = 0;
  std::vector<Renaming> renamings;  // the old side has the new names
  compiler::FactDifference facts;
  /// Differences of the settings, where two scenarios and their facts are compared.
  std::optional<std::vector<SettingChange>> settings;
  std::optional<runtime::TraceDifference> traces;
  /// The edits that the witnesses depend on; none where it was not tried.
  std::optional<std::vector<RevisionEdit>> lost_edits, gained_edits;
  std::vector<std::string> remarks;  // what was not compared, and why

  FactReport report() const { return {old_side.facts, new_side.facts, facts}; }
};

base::Result<ModelDifference> compare_models(const std::string& old_path, RevisionKind old_kind,
                                             const std::string& new_path, RevisionKind new_kind,
                                             const ModelDiffOptions& options, Context& context);

/// A witness up to the timepoint that rules it out, in indented lines.
std::string beginning_text(const runtime::Witness& witness);
/// The first trace that one side alone has, as the part about traces shows it; there is one.
std::string witness_text(const ModelDifference& difference, bool lost);
/// "10", "at least 200"
std::string count_text(const runtime::TraceNumber& number);

/// The part about traces, for people and as JSON. `stat`: numbers without witnesses.
std::string traces_text(const ModelDifference& difference, bool stat);
std::string traces_json(const ModelDifference& difference);

}  // namespace parallax::tools
