// Which files of a folder a gate compares, and what belongs to each.
#include "tools/diff/gate_tree.h"

#include <algorithm>
#include <system_error>

#include "compiler/base/ascii.h"
#include "compiler/base/file_io.h"
#include "compiler/base/file_names.h"
#include "compiler/base/path_gate.h"
#include "compiler/syntax/loader.h"
#include "tools/diff/rates_revision.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

bool lies_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// Names of all that lies in a folder, relative to it.
std::set<std::string> names_below(const fs::path& folder) {
  std::set<std::string> out;
  std::error_code error;
  fs::recursive_directory_iterator at(folder, error), end;
  for (; !error && at != end; at.increment(error)) {
    out.insert(at->path().lexically_relative(folder).string());
  }
  if (error) out.insert(folder.string());  // differs from the other side in any case
  return out;
}

bool are_same(const fs::path& a, const fs::path& b) {
  std::error_code error;
  const auto kind = fs::status(a, error).type();
  if (kind != fs::status(b, error).type()) return false;
  if (kind == fs::file_type::not_found) return true;
  // Files that count in a named folder are inputs themselves, but only on the side that has them.
  if (kind == fs::file_type::directory) return names_below(a) == names_below(b);
  base::DiagnosticSink unread;
  const auto x = base::read_file(a, unread), y = base::read_file(b, unread);
  return x && y && *x == *y;
}

/// The ending in small letters: a suite takes `.YAML`, too.
std::string ending_of(const std::string& name) {
  auto out = fs::path(name).extension().string();
  std::transform(out.begin(), out.end(), out.begin(), base::to_lower);
  return out;
}

}  // namespace

bool is_run_folder(const fs::path& folder) {
  return lies_there(folder / "journal.ndjson") || lies_there(folder / "report.json");
}

bool SameFiles::all(const std::set<std::string>& names) {
  return std::all_of(names.begin(), names.end(), [&](const auto& name) { return one(name); });
}

bool SameFiles::one(const std::string& name) {
  const auto known = known_.find(name);
  if (known != known_.end()) return known->second;
  return known_[name] = are_same(before_ / name, after_ / name);
}

// Suites look for cases everywhere, also in hidden folders and beside the results of a run, and so
// does a gate; only git's own folder is no part of a project. Models that nothing names are looked
// for elsewhere alone: parts of others lie there.
GateTree::GateTree(const std::string& folder, LoadRevision options, const harness::GateRules& rules,
                   SameFiles& same, const GateTree* twin, Context& context)
    : folder_(base::absolute_name(folder)),
      options_(std::move(options)),
      rules_(rules),
      same_(same),
      twin_(twin),
      context_(context) {
  std::error_code error;
  std::set<fs::path> aside;
  fs::recursive_directory_iterator at(folder_, error), end;
  for (; !error && at != end; at.increment(error)) {
    std::error_code unread;
    const bool is_aside =
        aside.contains(at->path().parent_path()) || at->path().filename().string().starts_with('.');
    if (at->is_directory(unread)) {
      if (at->path().filename() == ".git") at.disable_recursion_pending();
      if (is_aside || is_run_folder(at->path())) aside.insert(at->path());
    } else if (at->is_regular_file(unread)) {
      files_.insert(name_of(at->path()));
      if (is_aside) aside_.insert(name_of(at->path()));
    }
  }
  if (error) broken_.insert(".");
  for (const auto& name : files_) note_subjects(name);
  if (rules_.models) note_models_of_no_one();
}

std::shared_ptr<const harness::SuiteManifest> GateTree::manifest(const std::string& name) const {
  const auto found = roles_.find(name);
  return found == roles_.end() ? nullptr : found->second.manifest;
}

std::string GateTree::name_of(const fs::path& path) const {
  return path.lexically_relative(folder_).generic_string();
}

std::optional<RevisionKind> GateTree::kind_at(const std::string& name) const {
  const auto found = subjects_.find(name);
  if (found != subjects_.end()) return found->second;
  std::error_code error;
  if (fs::symlink_status(path_of(name), error).type() == fs::file_type::not_found) return {};
  return kind_of(path_of(name).string());
}

const GateTree::Inputs& GateTree::inputs_of(const std::string& name) const {
  const auto known = inputs_.find(name);
  if (known != inputs_.end()) return known->second;
  return inputs_.emplace(name, read_inputs(name)).first->second;
}

GateTree::Inputs GateTree::inputs_of_models(const std::vector<harness::LocatedText>& models,
                                            const fs::path& named_by) const {
  base::SourceFiles files;
  base::DiagnosticSink unread;
  Inputs out;
  read_models(models, named_by, files, unread);
  out.is_read = !unread.has_errors();
  note_names(files, out);
  return out;
}

void GateTree::note_names(const base::SourceFiles& files, Inputs& out) const {
  for (const auto& input : files.inputs()) {
    const auto absolute = base::absolute_name(input);
    out.names.insert(name_of(absolute));
    if (out.foreign.empty() && is_foreign(absolute)) out.foreign = input;
  }
}

GateTree::Inputs GateTree::read_inputs(const std::string& name) const {
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
  note_names(files, out);
  return out;
}

void GateTree::read_models(const std::vector<harness::LocatedText>& models,
                           const fs::path& named_by, base::SourceFiles& files,
                           base::DiagnosticSink& sink) const {
  std::vector<fs::path> paths;
  for (const auto& model : models) paths.emplace_back(model.text);
  compiler::LoadOptions load;
  load.allow_outside = context_.form().allow_outside;
  load.named_by = {named_by};
  const auto& folders = options_.model.include_dirs;
  if (named_by.extension() == ".e") load.include_dirs.assign(folders.begin(), folders.end());
  if (!paths.empty()) (void)compiler::load_model(paths, load, files, sink);
}

/// A `load` that is looked up from the current folder leads there for both sides.
bool GateTree::is_foreign(const fs::path& path) const {
  const auto& side = options_.commands;
  if (!side || path.filename() == base::kRootMarker || !lies_there(path)) return false;
  return !base::lies_below(path, side->root) &&
         std::any_of(side->others.begin(), side->others.end(),
                     [&](const auto& other) { return base::lies_below(path, other); });
}

void GateTree::note_subjects(const std::string& name) {
  const auto ending = ending_of(name);
  if (rules_.rates && ending == ".json") note_rates(name);
  if (rules_.plans && (ending == ".lisp" || ending == ".bind")) {
    subjects_.emplace(name, ending == ".lisp" ? RevisionKind::kPlan : RevisionKind::kBinding);
  }
  if (!rules_.models || (ending != ".yaml" && ending != ".yml")) return;
  auto role = role_of(name);
  if (role.kind == harness::SuiteFileKind::kScenario) {
    subjects_.emplace(name, RevisionKind::kScenario);
  } else if (role.kind == harness::SuiteFileKind::kBroken) {
    broken_.insert(name);
  } else if (role.kind == harness::SuiteFileKind::kManifest) {
    manifests_.insert(name);
    for (const auto& one : role.manifest->cases) {
      for (const auto& model : one.models) {
        const auto of_case = name_of(base::absolute_name(model.text));
        if (one.models.size() == 1) {
          note_model(of_case);
        } else {
          of_cases_.insert(of_case);
        }
      }
    }
  }
  roles_.emplace(name, std::move(role));
}

void GateTree::note_rates(const std::string& name) {
  Context own(context_.form(), context_.stop());
  if (load_rates(path_of(name).string(), own)) subjects_.emplace(name, RevisionKind::kRates);
}

GateTree::Role GateTree::role_of(const std::string& name) const {
  if (twin_ != nullptr) {
    // The paths in a manifest are those of its own side.
    const auto other = twin_->roles_.find(name);
    const bool is_known = other != twin_->roles_.end() && !other->second.manifest;
    if (is_known && same_.all(other->second.names)) return other->second;
  }
  const bool allow_outside = context_.form().allow_outside;
  base::SourceFiles files;
  Role out{harness::suite_file_kind(path_of(name), allow_outside, files), {}, {name}};
  if (out.kind == harness::SuiteFileKind::kManifest) {
    base::DiagnosticSink unread;
    auto manifest = harness::load_manifest(path_of(name), files, unread, allow_outside);
    if (manifest) {
      out.manifest = std::make_shared<const harness::SuiteManifest>(*std::move(manifest));
    } else {
      out.kind = harness::SuiteFileKind::kBroken;
    }
  }
  for (const auto& input : files.inputs()) out.names.insert(name_of(base::absolute_name(input)));
  return out;
}

/// Models that neither a scenario nor a manifest nor another model reads.
void GateTree::note_models_of_no_one() {
  auto read = of_cases_;
  std::set<std::string> unread;
  for (const auto& [name, kind] : subjects_) {
    const auto& names = inputs_of(name).names;
    read.insert(names.begin(), names.end());
  }
  for (const auto& name : manifests_) {
    for (const auto& one : roles_.at(name).manifest->cases) {
      if (one.models.size() > 1) read.merge(inputs_of_models(one.models, path_of(name)).names);
    }
  }
  for (const auto& name : files_) {
    const bool is_model = fs::path(name).extension() == ".e" && !aside_.contains(name);
    if (is_model && !read.contains(name)) unread.insert(name);
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

void GateTree::note_model(const std::string& name) {
  const auto kind = kind_of(name);
  if (kind && has_traces(*kind) && lies_there(path_of(name))) subjects_.emplace(name, *kind);
}

}  // namespace parallax::tools
