#include "compiler/plan/plan_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <string>
#include <system_error>
#include <utility>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/plans.h"
#include "compiler/base/codes/texts.h"
#include "compiler/base/file_io.h"
#include "compiler/lisp/system_definition.h"

namespace parallax::compiler {
namespace {

namespace fs = std::filesystem;
using base::DiagnosticCode;

/// "cram_pick_place" and "cram-pick-place.asd" are called alike.
std::string folded_name(const fs::path& path) {
  auto name = path.stem().string();
  for (auto& c : name) c = c == '_' ? '-' : base::to_lower(c);
  return name;
}

class PlanFileLoader {
 public:
  PlanFileLoader(const base::PathGate& gate, base::SourceFiles& files, base::DiagnosticSink& sink)
      : gate_(gate), files_(files), sink_(sink) {}

  void load(const PlanEntry& named) {
    std::error_code error;
    if (fs::is_directory(named.path, error)) return load_folder(named);
    load_file(named.path, named.place);
  }

  std::vector<base::FileId> take() { return std::move(loaded_); }

 private:
  template <typename... Args>
  base::DiagnosticBuilder report(DiagnosticCode code, const fs::path& path,
                                 const std::optional<base::SourceRange>& place,
                                 const Args&... args) {
    return place ? sink_.error(code, *place, args...)
                 : sink_.error_about(code, path.string(), args...);
  }

  void load_folder(const PlanEntry& named) {
    auto plans = plan_files_in(named.path);
    const auto is_system = [](const fs::path& path) { return path.extension() == ".asd"; };
    const auto middle = std::stable_partition(plans.begin(), plans.end(), is_system);
    std::vector<fs::path> systems(plans.begin(), middle);
    plans.erase(plans.begin(), middle);
    if (systems.size() > 1) {
      const auto wanted = folded_name(base::real_path(named.path).filename());
      std::erase_if(systems, [&](const fs::path& path) { return folded_name(path) != wanted; });
      if (systems.size() != 1) {
        report(codes::kPlanFolder, named.path, named.place, named.path.string(),
               "it holds several system definitions, and not one of them is called like it");
        return;
      }
    }
    if (!systems.empty()) return load_system(systems.front(), named);
    if (plans.empty()) {
      report(codes::kPlanFolder, named.path, named.place, named.path.string(),
             "it holds no system definition (.asd) and no Lisp file");
      return;
    }
    if (plans.size() > kMaxPlanFiles) return too_many(named.path, named.place);
    if (plans.size() > 1) {
      report(codes::kPlanOrder, named.path, named.place, named.path.string(), plans.size());
    }
    for (const auto& path : plans) {
      if (!load_file(path, named.place)) return;
    }
  }

  void load_system(const fs::path& definition, const PlanEntry& named) {
    if (!admitted(definition, named.place)) return;
    const auto file = base::load_text(definition, files_, sink_);
    if (!file) return;
    const auto listed = read_system(files_, *file, sink_);
    if (!listed) return;
    if (listed->empty()) {
      report(codes::kPlanFolder, named.path, named.place, definition.string(),
             "the system has no Lisp file");
    }
    for (const auto& item : *listed) {
      const auto path = (definition.parent_path() / item.path).lexically_normal();
      if (!gate_.check(path, item.place, sink_)) continue;
      if (!base::check_file(path, item.place, sink_)) continue;
      if (!load_file(path, item.place)) return;
    }
  }

  void too_many(const fs::path& path, const std::optional<base::SourceRange>& place) {
    report(codes::kPlanFolder, path, place, path.string(),
           fmt::format("the plan has more than {} files", kMaxPlanFiles));
  }

  bool admitted(const fs::path& path, const std::optional<base::SourceRange>& place) {
    if (gate_.admits(path)) return true;
    if (place) return static_cast<bool>(gate_.check(path, *place, sink_));
    sink_.error_about(codes::kLoadOutside, path.string(), path.string());
    return false;
  }

  /// False if no further file can be read.
  bool load_file(const fs::path& path, const std::optional<base::SourceRange>& place) {
    if (loaded_.size() >= kMaxPlanFiles) {
      too_many(path, place);
      return false;
    }
    if (!admitted(path, place)) return true;
    if (place && !base::check_file(path, *place, sink_)) return true;
    const auto [first, added] = seen_.emplace(base::real_path(path), path);
    if (!added) {
      report(codes::kPlanFolder, path, place, path.string(), "the plan names this file twice");
      return true;
    }
    if (const auto file = base::load_text(path, files_, sink_)) loaded_.push_back(*file);
    return true;
  }

  const base::PathGate& gate_;
  base::SourceFiles& files_;
  base::DiagnosticSink& sink_;
  std::map<fs::path, fs::path> seen_;
  std::vector<base::FileId> loaded_;
};

}  // namespace

std::vector<fs::path> plan_files_in(const fs::path& folder) {
  std::vector<fs::path> out;
  std::size_t plans = 0, systems = 0;
  std::error_code error;
  for (auto at = fs::directory_iterator(folder, error); !error && at != fs::directory_iterator();
       at.increment(error)) {
    const auto& path = at->path();
    const bool hidden = path.filename().string().starts_with('.');
    const bool system = path.extension() == ".asd";
    if (hidden || (!system && path.extension() != ".lisp")) continue;
    std::error_code ignored;
    auto& count = system ? systems : plans;
    if (count > kMaxPlanFiles || fs::is_directory(path, ignored)) continue;
    ++count;
    out.push_back(path);
  }
  std::sort(out.begin(), out.end());
  return out;
}

base::Result<std::vector<base::FileId>> load_plan_files(std::span<const PlanEntry> paths,
                                                        const base::PathGate& gate,
                                                        base::SourceFiles& files,
                                                        base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  PlanFileLoader loader(gate, files, sink);
  for (const auto& path : paths) loader.load(path);
  if (sink.error_count() != errors_before) return sink.already_reported();
  return loader.take();
}

}  // namespace parallax::compiler
