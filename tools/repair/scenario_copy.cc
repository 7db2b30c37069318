#include "tools/repair/scenario_copy.h"

#include <algorithm>
#include <system_error>

#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/file_names.h"
#include "tools/app/scenario_model.h"
#include "tools/repair/world_files.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFrozenWorld = "world-of-the-run";

base::Status write_copy(const fs::path& target, const std::string& text, Context& context) {
  std::error_code error;
  fs::create_directories(target.parent_path(), error);
  return base::write_file_atomically(target, text, context.sink());
}

}  // namespace

base::Result<ScenarioCopy> ScenarioCopy::make(const harness::Scenario& scenario,
                                              const fs::path& folder, std::size_t first_file,
                                              std::size_t first_input, Context& context) {
  auto& sink = context.sink();
  const auto& files = context.files();
  std::map<std::string, std::string> texts;
  std::map<std::string, std::string> names;  // as they are told
  const auto add = [&](const std::string& name) -> base::Status {
    std::error_code error;
    const auto place = base::absolute_name(name);
    if (texts.contains(place) || !fs::is_regular_file(name, error)) return base::Unit{};
    auto text = base::read_file(name, sink);
    if (!text) return sink.already_reported();
    texts.emplace(place, *std::move(text));
    names.emplace(place, name);
    return base::Unit{};
  };
  for (auto i = first_file; i < files.size(); ++i) {
    if (!add(files[base::FileId(static_cast<std::uint32_t>(i))].name())) {
      return sink.already_reported();
    }
  }
  for (auto i = first_input; i < files.inputs().size(); ++i) {
    if (!add(files.inputs()[i])) return sink.already_reported();
  }
  const auto root = base::common_folder(texts);
  ScenarioCopy out;
  for (const auto& [place, text] : texts) {
    const auto target = folder / fs::path(place).lexically_relative(root);
    if (!write_copy(target, text, context)) return sink.already_reported();
    out.copies_.emplace(place, Copy{names.at(place), target, text, text});
  }
  out.scenario_ =
      folder / fs::path(base::absolute_name(scenario.file.string())).lexically_relative(root);
  if (!out.freeze_world(scenario, root, context) || !out.look_at_reads(context)) {
    return sink.already_reported();
  }
  return out;
}

/// Otherwise a repair of the model would change the world as well, and confirm itself.
base::Status ScenarioCopy::freeze_world(const harness::Scenario& scenario, const fs::path& root,
                                        Context& context) {
  std::set<std::string> model, world;
  const auto add = [&](const std::string& name, std::set<std::string>& places) {
    // Built-in foundations have no file.
    const auto place = base::absolute_name(name);
    if (copies_.contains(place)) places.insert(place);
  };
  for (const auto& name : model_files(scenario, context)) add(name, model);
  for (const auto& name : world_files(scenario, context)) add(name, world);
  const bool apart = std::none_of(world.begin(), world.end(),
                                  [&](const std::string& place) { return model.contains(place); });
  if (apart) return base::Unit{};
  auto frozen = scenario_.parent_path() / kFrozenWorld;
  std::error_code error;
  while (fs::exists(frozen, error)) frozen += "-2";
  for (const auto& place : world) {
    const auto target = frozen / fs::path(place).lexically_relative(root);
    if (!write_copy(target, copies_.at(place).text, context)) {
      return context.sink().already_reported();
    }
  }
  // From the end, so that the places before stay what they are.
  auto named = scenario.simulator.models;
  std::sort(named.begin(), named.end(), [](const auto& a, const auto& b) {
    return std::pair(a.source.file.index(), a.source.begin) >
           std::pair(b.source.file.index(), b.source.begin);
  });
  for (const auto& text : named) {
    const auto& file = context.files()[text.source.file].name();
    const auto copy = copies_.find(base::absolute_name(file));
    if (copy == copies_.end()) continue;
    auto& [name, target, original, now] = copy->second;
    const auto to = frozen / fs::path(base::absolute_name(text.text)).lexically_relative(root);
    now.replace(text.source.begin, text.source.end - text.source.begin,
                to.lexically_relative(target.parent_path()).generic_string());
    if (!write_copy(target, now, context)) return context.sink().already_reported();
  }
  return base::Unit{};
}

/// Finds the files that the copied scenario reads: an absolute name leads to the original.
base::Status ScenarioCopy::look_at_reads(Context& context) {
  auto& sink = context.sink();
  const auto first = context.files().size();
  const auto copied =
      harness::load_scenario(scenario_, context.files(), sink, context.form().allow_outside);
  if (!copied) return sink.already_reported();
  if (!copied->plan.empty() && !load_scenario_plan(*copied, context)) {
    return sink.already_reported();
  }
  const auto add = [&](const std::string& name) { read_.insert(base::absolute_name(name)); };
  for (auto i = first; i < context.files().size(); ++i) {
    add(context.files()[base::FileId(static_cast<std::uint32_t>(i))].name());
  }
  for (const auto& name : model_files(*copied, context)) add(name);
  if (copied->bind) add(copied->bind->text);
  // The world must not read files that are changed.
  for (const auto& name : world_files(*copied, context)) {
    if (!read_.contains(base::absolute_name(name)) || !is_copy(name)) continue;
    return sink.error_about(codes::kFileNotWritable, name,
                            "the world reads it as the model does, and cannot be given a copy of "
                            "its own: give the world files of its own, named relative to the "
                            "scenario");
  }
  return base::Unit{};
}

bool ScenarioCopy::is_copy(const std::string& name) const {
  return std::any_of(copies_.begin(), copies_.end(), [&](const auto& each) {
    return base::absolute_name(each.second.target.string()) == base::absolute_name(name);
  });
}

base::Result<std::vector<ChangedFile>> ScenarioCopy::in_copies(std::vector<ChangedFile> files,
                                                               Context& context) const {
  for (auto& file : files) {
    const auto copy = copies_.find(base::absolute_name(file.name));
    const auto target = copy == copies_.end() ? file.name : copy->second.target.string();
    if (!is_copy(target) || !read_.contains(base::absolute_name(target))) {
      return context.sink().error_about(
          codes::kFileNotWritable, file.name,
          "--loop changes copies, and this file was not read from its copy: name it relative to "
          "the scenario");
    }
    file.name = target;
  }
  return files;
}

base::Result<std::vector<ChangedFile>> ScenarioCopy::changes(Context& context) const {
  std::vector<ChangedFile> out;
  for (const auto& [place, copy] : copies_) {
    auto now = base::read_file(copy.target, context.sink());
    if (!now) return context.sink().already_reported();
    if (*now != copy.text) out.push_back({copy.name, copy.original, *std::move(now)});
  }
  return out;
}

}  // namespace parallax::tools
