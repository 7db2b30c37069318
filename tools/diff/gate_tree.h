#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/config/gate_rules.h"
#include "harness/config/suite_manifest.h"
#include "tools/app/context.h"
#include "tools/diff/revision.h"

namespace parallax::tools {

/// Is it the folder of a run?
bool is_run_folder(const std::filesystem::path& folder);

/// Whether files of both folders are the same, each compared once, links followed. A file that only
/// one side has, or that cannot be read, is not.
class SameFiles {
 public:
  SameFiles(std::filesystem::path before, std::filesystem::path after)
      : before_(std::move(before)), after_(std::move(after)) {}

  bool all(const std::set<std::string>& names);

 private:
  bool one(const std::string& name);

  std::filesystem::path before_, after_;
  std::map<std::string, bool> known_;
};

/// One folder of a gate over two: its files, and what of them is compared. Names are relative to
/// it. What it refers to outlives it.
class GateTree {
 public:
  /// `twin`: the other folder, or null. What was read there and is the same here is not read again.
  GateTree(const std::string& folder, LoadRevision options, const harness::GateRules& rules,
           SameFiles& same, const GateTree* twin, Context& context);

  const std::map<std::string, RevisionKind>& subjects() const { return subjects_; }
  /// Files that may be or name models and cannot be read; `.`: a folder in the tree.
  const std::set<std::string>& broken() const { return broken_; }
  /// Names of the manifests.
  const std::set<std::string>& manifests() const { return manifests_; }
  /// Null: there is none of this name that can be read.
  std::shared_ptr<const harness::SuiteManifest> manifest(const std::string& name) const;
  std::filesystem::path path_of(const std::string& name) const { return folder_ / name; }
  std::string name_of(const std::filesystem::path& path) const;
  /// How a file is compared; none if there is none. One that is a scenario or model on the other
  /// side alone is compared as that.
  std::optional<RevisionKind> kind_at(const std::string& name) const;

  /// The files that belong to a scenario or model.
  struct Inputs {
    std::set<std::string> names;       // also of files that were looked for in vain
    std::vector<std::string> command;  // of a simulator
    std::string command_hash;          // over the files that it names
    std::string foreign;               // a file that is read from the other side instead of this
    bool is_read = true;               // false: there may be more
  };
  const Inputs& inputs_of(const std::string& name) const;
  /// The files of models that are compiled together.
  Inputs inputs_of_models(const std::vector<harness::LocatedText>& models,
                          const std::filesystem::path& named_by) const;

 private:
  /// The kind of a YAML file; a manifest that cannot be read is broken.
  struct Role {
    harness::SuiteFileKind kind = harness::SuiteFileKind::kOther;
    std::shared_ptr<const harness::SuiteManifest> manifest{};
    std::set<std::string> names{};  // of the files that say so
  };

  Inputs read_inputs(const std::string& name) const;
  void note_names(const base::SourceFiles& files, Inputs& out) const;
  void read_models(const std::vector<harness::LocatedText>& models,
                   const std::filesystem::path& named_by, base::SourceFiles& files,
                   base::DiagnosticSink& sink) const;
  bool is_foreign(const std::filesystem::path& path) const;
  void note_subjects(const std::string& name);
  void note_rates(const std::string& name);
  Role role_of(const std::string& name) const;
  void note_models_of_no_one();
  void note_model(const std::string& name);

  std::filesystem::path folder_;
  LoadRevision options_;
  const harness::GateRules& rules_;
  SameFiles& same_;
  const GateTree* twin_;
  Context& context_;
  std::set<std::string> files_, broken_, manifests_;
  std::set<std::string> aside_;     // files in hidden folders and in those of runs
  std::set<std::string> of_cases_;  // models of manifests that are compiled with others
  std::map<std::string, RevisionKind> subjects_;
  std::map<std::string, Role> roles_;  // of YAML files
  mutable std::map<std::string, Inputs> inputs_;
};

}  // namespace parallax::tools
