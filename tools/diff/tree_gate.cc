// A gate over two folders.
//
// Each scenario, each model of a manifest, and each that nothing reads, is read as far as needed to
// know which files belong to it, wherever these lie. That is done in the old folder; in the new one
// only where one of these files differs, as equal texts name equal files. Only there are the two
// revisions compiled and compared. Cost: reading what belongs to the old scenarios and models, and
// one comparison for each that changed.

#include "tools/diff/tree_gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <system_error>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/file_io.h"
#include "compiler/base/file_names.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/words.h"
#include "compiler/syntax/loader.h"
#include "harness/config/suite_manifest.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

bool lies_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

bool is_run_folder(const fs::path& folder) {
  return lies_there(folder / "journal.ndjson") || lies_there(folder / "report.json");
}

/// Whether files of both folders are the same, each compared once, links followed. A file that only
/// one side has, or that cannot be read, is not.
class SameFiles {
 public:
  SameFiles(fs::path before, fs::path after)
      : before_(std::move(before)), after_(std::move(after)) {}

  bool all(const std::set<std::string>& names) {
    return std::all_of(names.begin(), names.end(), [&](const auto& name) { return one(name); });
  }

 private:
  bool one(const std::string& name) {
    const auto known = known_.find(name);
    if (known != known_.end()) return known->second;
    return known_[name] = same(before_ / name, after_ / name);
  }

  static bool same(const fs::path& a, const fs::path& b) {
    std::error_code error;
    const auto kind = fs::status(a, error).type();
    if (kind != fs::status(b, error).type()) return false;
    if (kind == fs::file_type::not_found) return true;
    // Files that count in a named folder are inputs themselves, but only on the side that has them.
    if (kind == fs::file_type::directory) return listing(a) == listing(b);
    base::DiagnosticSink unread;
    const auto x = base::read_file(a, unread), y = base::read_file(b, unread);
    return x && y && *x == *y;
  }

  /// Names of all that lies in a folder, relative to it.
  static std::set<std::string> listing(const fs::path& folder) {
    std::set<std::string> out;
    std::error_code error;
    fs::recursive_directory_iterator at(folder, error), end;
    for (; !error && at != end; at.increment(error)) {
      out.insert(at->path().lexically_relative(folder).string());
    }
    if (error) out.insert(folder.string());  // differs from the other side in any case
    return out;
  }

  fs::path before_, after_;
  std::map<std::string, bool> known_;
};

/// One folder: its files, and what of them is compared. Names are relative to it.
class Tree {
 public:
  /// `twin`: the other folder. What was read there and is the same here is not read again.
  Tree(const std::string& folder, LoadRevision options, const harness::GateRules& rules,
       SameFiles& same, const Tree* twin, Context& context)
      : folder_(base::absolute_name(folder)),
        options_(std::move(options)),
        rules_(rules),
        same_(same),
        twin_(twin),
        context_(context) {
    std::error_code error;
    fs::recursive_directory_iterator at(folder_, error), end;
    for (; !error && at != end; at.increment(error)) {
      std::error_code unread;
      const bool is_hidden = at->path().filename().string().starts_with('.');
      if (at->is_directory(unread)) {
        if (is_hidden || is_run_folder(at->path())) at.disable_recursion_pending();
      } else if (!is_hidden && at->is_regular_file(unread)) {
        files_.insert(name_of(at->path()));
      }
    }
    if (error) broken_.insert(".");
    for (const auto& name : files_) note_subjects(name);
    if (rules_.models) note_models_of_no_one();
  }

  const std::map<std::string, RevisionKind>& subjects() const { return subjects_; }
  /// Files that may be or name models and cannot be read; `.`: a folder in the tree.
  const std::set<std::string>& broken() const { return broken_; }
  fs::path path_of(const std::string& name) const { return folder_ / name; }
  /// How a file is compared; none if there is none. One that is a scenario or model on the other
  /// side alone is compared as that.
  std::optional<RevisionKind> kind_at(const std::string& name) const {
    const auto found = subjects_.find(name);
    if (found != subjects_.end()) return found->second;
    std::error_code error;
    if (fs::symlink_status(path_of(name), error).type() == fs::file_type::not_found) return {};
    return kind_of(path_of(name).string());
  }

  /// The files that belong to a scenario or model.
  struct Inputs {
    std::set<std::string> names;       // also of files that were looked for in vain
    std::vector<std::string> command;  // of a simulator
    std::string command_hash;          // over the files that it names
    std::string foreign;               // a file that is read from the other side instead of this
    bool is_read = true;               // false: there may be more
  };
  const Inputs& inputs_of(const std::string& name) const {
    const auto known = inputs_.find(name);
    if (known != inputs_.end()) return known->second;
    return inputs_.emplace(name, read_inputs(name)).first->second;
  }

 private:
  Inputs read_inputs(const std::string& name) const {
    if (twin_ != nullptr && twin_->kind_at(name) == kind_at(name)) {
      auto out = twin_->inputs_of(name);
      if (out.is_read && out.foreign.empty() && same_.all(out.names)) {
        out.command_hash = hash_of_command(out.command, options_.commands);
        return out;
      }
    }
    base::SourceFiles files;
    base::DiagnosticSink unread;  // who compares it reports
    const auto path = path_of(name);
    Inputs out;
    const auto kind = kind_at(name);
    if (kind == RevisionKind::kScenario) {
      const auto scenario =
          harness::load_scenario(path, files, unread, context_.form().allow_outside);
      out.is_read = scenario.has_value();
      if (scenario) {
        read_models(scenario->models, path, files, unread);
        read_models(scenario->simulator.models, path, files, unread);
        out.command = scenario->simulator.command;
        out.command_hash = hash_of_command(out.command, options_.commands);
      }
    } else if (kind == RevisionKind::kModel) {
      read_models({{path.string(), {}}}, path, files, unread);
    }
    out.is_read = out.is_read && !unread.has_errors();
    out.names.insert(name);
    for (const auto& input : files.inputs()) {
      const auto absolute = base::absolute_name(input);
      out.names.insert(name_of(absolute));
      if (out.foreign.empty() && is_foreign(absolute)) out.foreign = input;
    }
    return out;
  }

  void read_models(const std::vector<harness::LocatedText>& models, const fs::path& named_by,
                   base::SourceFiles& files, base::DiagnosticSink& sink) const {
    std::vector<fs::path> paths;
    for (const auto& model : models) paths.emplace_back(model.text);
    compiler::LoadOptions load;
    load.allow_outside = context_.form().allow_outside;
    load.named_by = {named_by};
    if (named_by.extension() == ".e") {
      const auto& folders = options_.model.include_dirs;
      load.include_dirs.assign(folders.begin(), folders.end());
    }
    if (!paths.empty()) (void)compiler::load_model(paths, load, files, sink);
  }

  /// A `load` that is looked up from the current folder leads there for both sides.
  bool is_foreign(const fs::path& path) const {
    const auto& side = options_.commands;
    if (!side || path.filename() == base::kRootMarker || !lies_there(path)) return false;
    return !base::lies_below(path, side->root) &&
           std::any_of(side->others.begin(), side->others.end(),
                       [&](const auto& other) { return base::lies_below(path, other); });
  }

  std::string name_of(const fs::path& path) const {
    return path.lexically_relative(folder_).generic_string();
  }

  void note_subjects(const std::string& name) {
    const auto ending = fs::path(name).extension();
    if (rules_.rates && ending == ".json") note_rates(name);
    if (!rules_.models || (ending != ".yaml" && ending != ".yml")) return;
    auto role = role_of(name);
    if (role.kind == harness::SuiteFileKind::kScenario) {
      subjects_.emplace(name, RevisionKind::kScenario);
    } else if (role.kind == harness::SuiteFileKind::kBroken) {
      broken_.insert(name);
    }
    for (const auto& model : role.models) note_model(model);
    roles_.emplace(name, std::move(role));
  }

  void note_rates(const std::string& name) {
    Context own(context_.form(), context_.stop());
    if (load_rates(path_of(name).string(), own)) subjects_.emplace(name, RevisionKind::kRates);
  }

  /// What a YAML file is; a manifest that cannot be read is broken.
  struct Role {
    harness::SuiteFileKind kind = harness::SuiteFileKind::kOther;
    std::vector<std::string> models;  // of a manifest, by name
    std::set<std::string> names;      // of the files that say so
  };
  Role role_of(const std::string& name) const {
    if (twin_ != nullptr) {
      const auto other = twin_->roles_.find(name);
      if (other != twin_->roles_.end() && same_.all(other->second.names)) return other->second;
    }
    const bool allow_outside = context_.form().allow_outside;
    base::SourceFiles files;
    Role out{harness::suite_file_kind(path_of(name), allow_outside, files), {}, {name}};
    if (out.kind == harness::SuiteFileKind::kManifest) {
      base::DiagnosticSink unread;
      const auto manifest = harness::load_manifest(path_of(name), files, unread, allow_outside);
      if (!manifest) out.kind = harness::SuiteFileKind::kBroken;
      if (manifest) {
        for (const auto& one : manifest->cases) {
          for (const auto& model : one.models) {
            out.models.push_back(name_of(base::absolute_name(model.text)));
          }
        }
      }
    }
    for (const auto& input : files.inputs()) out.names.insert(name_of(base::absolute_name(input)));
    return out;
  }

  /// Models that neither a scenario nor a manifest nor another model reads.
  void note_models_of_no_one() {
    std::set<std::string> read, unread;
    for (const auto& [name, kind] : subjects_) {
      const auto& names = inputs_of(name).names;
      read.insert(names.begin(), names.end());
    }
    for (const auto& name : files_) {
      if (fs::path(name).extension() == ".e" && !read.contains(name)) unread.insert(name);
    }
    read.clear();
    for (const auto& name : unread) {
      auto inputs = inputs_of(name).names;
      inputs.erase(name);
      // Where models read one another, the first stands for all.
      if (!read.contains(name)) read.merge(inputs);
    }
    for (const auto& name : unread) {
      if (!read.contains(name)) subjects_.emplace(name, RevisionKind::kModel);
    }
  }

  void note_model(const std::string& name) {
    const auto kind = kind_of(name);
    if (kind && has_traces(*kind) && lies_there(path_of(name))) subjects_.emplace(name, *kind);
  }

  fs::path folder_;
  LoadRevision options_;
  const harness::GateRules& rules_;
  SameFiles& same_;
  const Tree* twin_;
  Context& context_;
  std::set<std::string> files_, broken_;
  std::map<std::string, RevisionKind> subjects_;
  std::map<std::string, Role> roles_;  // of YAML files
  mutable std::map<std::string, Inputs> inputs_;
};

/// Compares what is at one place of both folders.
std::vector<RuleResult> rules_at(const std::string& name, const Tree& before, const Tree& after,
                                 const harness::GateRules& rules, const GateInput& folders,
                                 GateReport& all, Context& context) {
  Context own(context.form(), context.stop());
  auto input = folders;
  input.old_path = before.path_of(name).string();
  input.new_path = after.path_of(name).string();
  input.old_kind = *before.kind_at(name);
  input.new_kind = *after.kind_at(name);
  std::vector<RuleResult> out;
  const bool are_rates =
      input.old_kind == RevisionKind::kRates && input.new_kind == RevisionKind::kRates;
  if (!are_rates && (!has_traces(input.old_kind) || !has_traces(input.new_kind))) {
    out.push_back({name, RuleOutcome::kUndecided, "it is no model on both sides"});
    return out;
  }
  auto report = hold_gate(input, rules, own);
  if (!report) {
    const auto said = own.sink().sorted();
    out.push_back({name, RuleOutcome::kUndecided,
                   "it cannot be compared: " +
                       (said.empty() ? std::string("it was stopped") : said.front().message)});
    return out;
  }
  for (auto& rule : report->rules) {
    // Evidence is shown in any case.
    if (rule.outcome == RuleOutcome::kKept && !rule.rerun && !are_rates) continue;
    rule.rule = fmt::format("{}: {}", name, rule.rule);
    out.push_back(std::move(rule));
  }
  for (const auto& remark : report->remarks) all.remarks.push_back(name + ": " + remark);
  if (out.empty()) {
    out.push_back({name, RuleOutcome::kKept,
                   fmt::format("it changed, and {} kept",
                               report->rules.size() == 1
                                   ? "the rule is"
                                   : fmt::format("all {} rules are", report->rules.size()))});
  }
  return out;
}

/// Results of rates that both folders have and that differ: they share the error of a gate.
std::size_t count_changed_rates(const Tree& before, const Tree& after, SameFiles& same) {
  std::size_t out = 0;
  for (const auto& [name, kind] : before.subjects()) {
    const bool is_pair = kind == RevisionKind::kRates && after.kind_at(name) == kind;
    out += is_pair && !same.all({name}) ? 1 : 0;
  }
  return out;
}

/// Where each of two folders has what a command names from the current one: a command that is
/// started in one of them is started at the same place of the other.
void add_command_folders(const fs::path& before, const fs::path& after, ModelDiffOptions& options) {
  const auto here = base::real_path(".");
  const bool in_old = base::lies_below(here, before), in_new = base::lies_below(here, after);
  // Where one folder lies in the other, both hold what lies in the inner one.
  const bool old_is_inner = base::lies_below(before, after);
  const auto& anchor = in_old && (!in_new || old_is_inner) ? before : after;
  const auto side = [&](const fs::path& root) {
    CommandFolder out{root, {}, {before, after}};
    const bool is_above = base::lies_below(anchor, here);
    if (in_old || in_new || is_above) {
      out.current.push_back((root / here.lexically_relative(anchor)).lexically_normal());
    }
    if (!in_old && !in_new) out.current.push_back(here);
    return out;
  };
  options.old_commands = side(before);
  options.new_commands = side(after);
}

}  // namespace

bool is_tree(const std::string& path) {
  std::error_code error;
  return fs::is_directory(path, error) && !is_run_folder(path);
}

base::Result<GateReport> hold_tree_gate(const GateInput& folders, const harness::GateRules& rules,
                                        Context& context) {
  if (!rules.models && !rules.rates) {
    return context.sink().error(codes::kNoGateRules, rules.source, "models");
  }
  const auto &old_folder = folders.old_path, &new_folder = folders.new_path;
  auto input = folders;
  auto& options = input.models;
  if (!options.old_commands || !options.new_commands) {
    add_command_folders(base::real_path(old_folder), base::real_path(new_folder), options);
  }
  auto old_load = options.load, new_load = options.load;
  old_load.commands = options.old_commands;
  new_load.commands = options.new_commands;
  SameFiles same(base::absolute_name(old_folder), base::absolute_name(new_folder));
  const Tree before(old_folder, old_load, rules, same, nullptr, context);
  const Tree after(new_folder, new_load, rules, same, &before, context);
  input.results = count_changed_rates(before, after, same);
  GateReport out;
  out.kind = "tree";
  out.old_name = old_folder;
  out.new_name = new_folder;
  out.undecided_passes = rules.undecided_passes;
  std::int64_t untouched = 0;
  std::set<std::string> subjects, broken = before.broken(), added;
  for (const auto* tree : {&before, &after}) {
    for (const auto& [name, kind] : tree->subjects()) subjects.insert(name);
    broken.insert(tree->broken().begin(), tree->broken().end());
  }
  for (const auto& name : broken) {
    const bool in_old = before.broken().contains(name), in_new = after.broken().contains(name);
    out.rules.push_back({name, RuleOutcome::kUndecided,
                         in_old && in_new ? "it cannot be read on either side"
                         : in_old         ? "it cannot be read on the old side"
                                          : "it cannot be read on the new side"});
  }
  if (subjects.empty() && broken.empty()) {
    out.rules.push_back(
        {rules.models ? "models" : "rates", RuleOutcome::kUndecided,
         fmt::format("neither folder has {}: nothing can be compared",
                     rules.models ? "a scenario or a model" : "a result of `rates --json`")});
  }
  for (const auto& name : subjects) {
    if (broken.contains(name)) continue;
    if (!after.kind_at(name)) {
      out.rules.push_back(
          {name, RuleOutcome::kUndecided, "it is gone: nothing is left to compare"});
      continue;
    }
    const auto& new_inputs = after.inputs_of(name);
    if (!before.kind_at(name)) {
      added.insert(name);
      if (!new_inputs.is_read) {
        out.rules.push_back({name, RuleOutcome::kUndecided, "it is new, and cannot be read"});
      }
      continue;
    }
    const auto& old_inputs = before.inputs_of(name);
    if (!old_inputs.foreign.empty() || !new_inputs.foreign.empty()) {
      out.rules.push_back(
          {name, RuleOutcome::kUndecided,
           fmt::format("{} is looked up from the current folder, for both sides the same: name it "
                       "from the folder of the file that loads it",
                       old_inputs.foreign.empty() ? new_inputs.foreign : old_inputs.foreign)});
      continue;
    }
    if (old_inputs.is_read && new_inputs.is_read &&
        old_inputs.command_hash == new_inputs.command_hash && same.all(old_inputs.names) &&
        same.all(new_inputs.names)) {
      untouched += before.kind_at(name) == RevisionKind::kRates ? 0 : 1;
      continue;
    }
    auto found = rules_at(name, before, after, rules, input, out, context);
    std::move(found.begin(), found.end(), std::back_inserter(out.rules));
  }
  judge_reruns(out.rules);
  for (const auto& name : added) out.remarks.push_back(name + " is new");
  if (untouched > 0) {
    out.remarks.push_back(
        fmt::format("no file of {} changed",
                    base::counted(untouched, "scenario or model", "scenarios and models")));
  }
  return out;
}

}  // namespace parallax::tools
