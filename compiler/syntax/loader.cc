#include "compiler/syntax/loader.h"

#include <algorithm>
#include <array>
#include <string>
#include <system_error>
#include <unordered_map>

#include "compiler/base/codes/texts.h"
#include "compiler/base/file_io.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/suggest.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/parser.h"

namespace parallax::compiler {

namespace {

// The axioms DEC1 to DEC12 are no text: grounding applies them as rules. What a model may name is
// declared here, so that a redeclaration can point at it.
constexpr std::array<Foundation, 5> kFoundations = {{
    {"foundations/Root.e", R"(; What every model needs.
sort boolean
sort integer
reified sort predicate
reified sort function
)"},
    {"foundations/EC.e", R"(; The event calculus: timepoints, fluents, events and their predicates.
load foundations/Root.e
sort time: integer
sort offset: integer
reified sort fluent
reified sort event
predicate Happens(event,time)
predicate HoldsAt(fluent,time)
predicate ReleasedAt(fluent,time)
predicate Initiates(event,fluent,time)
predicate Terminates(event,fluent,time)
predicate Releases(event,fluent,time)
predicate Trajectory(fluent,time,fluent,offset)
predicate AntiTrajectory(fluent,time,fluent,offset)
)"},
    {"foundations/DEC.e", R"(; The same, with the interval predicates of encoding 3.
load foundations/EC.e
predicate Clipped(time,fluent,time)
predicate Declipped(time,fluent,time)

[time1,fluent,time2]
Clipped(time1,fluent,time2) <->
{event,time} time1<=time & time<time2 & Happens(event,time) & Terminates(event,fluent,time).

[time1,fluent,time2]
Declipped(time1,fluent,time2) <->
{event,time} time1<=time & time<time2 & Happens(event,time) & Initiates(event,fluent,time).
)"},
    {"foundations/ECTraj.e",
     R"(; Trajectories and antitrajectories (DEC3, DEC4) need no text of their own.
load foundations/DEC.e
)"},
    {"foundations/ECCausal.e",
     R"(; Causal constraints: what a fluent is made to be at a timepoint by the events there.
load foundations/EC.e
predicate Started(fluent,time)
predicate Stopped(fluent,time)
predicate Initiated(fluent,time)
predicate Terminated(fluent,time)

[fluent,time]
Started(fluent,time) <->
HoldsAt(fluent,time) | ({event} Happens(event,time) & Initiates(event,fluent,time)).

[fluent,time]
Stopped(fluent,time) <->
!HoldsAt(fluent,time) | ({event} Happens(event,time) & Terminates(event,fluent,time)).

[fluent,time]
Initiated(fluent,time) <->
Started(fluent,time) & !({event} Happens(event,time) & Terminates(event,fluent,time)).

[fluent,time]
Terminated(fluent,time) <->
Stopped(fluent,time) & !({event} Happens(event,time) & Initiates(event,fluent,time)).
)"},
}};

namespace fs = std::filesystem;

fs::path canonical_or_empty(const fs::path& path) {
  std::error_code error;
  auto real = fs::canonical(path.empty() ? fs::path(".") : path, error);
  return error ? fs::path() : real;
}

class ModelLoader {
 public:
  ModelLoader(const LoadOptions& options, base::SourceFiles& files, base::DiagnosticSink& sink)
      : options_(options), files_(files), sink_(sink), gate_(options.allow_outside, &files) {
    for (const auto& folder : options.include_dirs) gate_.admit_folder(folder);
    for (const auto& file : options.named_by) gate_.admit_beside(file);
    gate_.admit_current_folder();
  }

  base::PathGate& gate() { return gate_; }

  /// A file that the user named on the command line.
  void load_main(const fs::path& path) {
    const auto real = canonical_or_empty(path);
    if (!real.empty() && index_of_.contains(real.string())) return;
    const auto file = base::load_text(path, files_, sink_);
    if (!file) {
      unreadable_ = true;
      return;
    }
    open(*file, path.parent_path(), false);
    if (!real.empty()) index_of_.emplace(real.string(), model_.files.size() - 1);
    run();
  }

  void load_main_text(base::FileId file, const fs::path& folder) {
    open(file, folder, false);
    run();
  }

  base::Result<ModelAst> finish() {
    if (unreadable_) return sink_.already_reported();
    if (options_.implicit_foundations && !foundation_loaded_) add_implicit_foundations();
    return std::move(model_);
  }

 private:
  /// A file whose statements are being put in order.
  struct Open {
    std::uint32_t file = 0;
    std::uint32_t next = 0;
  };

  void open(base::FileId file, fs::path folder, bool built_in) {
    model_.files.push_back({parse_file(file, files_, sink_), built_in});
    folders_.push_back(std::move(folder));
    stack_.push_back({static_cast<std::uint32_t>(model_.files.size() - 1), 0});
  }

  void run() {
    while (!stack_.empty()) {
      Open& top = stack_.back();
      const Ast& ast = model_.files[top.file].ast;
      if (top.next == ast.statements().size()) {
        stack_.pop_back();
        continue;
      }
      const ModelAst::Place place{top.file, top.next++};
      const Statement& statement = ast.statements()[place.statement];
      if (statement.kind == StatementKind::kLoad) {
        load(place);
        continue;
      }
      if (statement.kind == StatementKind::kOption) note_option(ast, statement);
      model_.order.push_back(place);
    }
  }

  /// The two options that choose which foundation a later `load` means.
  void note_option(const Ast& ast, const Statement& statement) {
    const auto name = ast.text(statement.name);
    const auto value = ast.text(statement.value);
    if (name == "encoding") encoding3_ = value == "3";
    if (name == "trajectory") trajectory_ = value == "on";
  }

  void load(const ModelAst::Place& place) {
    // Copies: what `statement` refers to moves when a file is added.
    const Ast& ast = model_.files[place.file].ast;
    const Word word = ast.statements()[place.statement].value;
    const auto range = ast.source(word);
    const fs::path path(std::string(ast.text(word)));
    const fs::path folder = folders_[place.file];
    const auto normal = path.lexically_normal();
    if (find_foundation(normal.string())) return load_foundation(normal.string(), place, range);
    if (load_from_disk(path, folder, range)) return;
    report_missing(path, range);
  }

  /// True if the file was found (and loaded or refused).
  bool load_from_disk(const fs::path& path, const fs::path& folder, const base::SourceRange& range,
                      bool repeats_foundation = false) {
    std::vector<fs::path> candidates = {folder / path};
    if (path.is_relative()) {
      for (const auto& include : options_.include_dirs) candidates.push_back(include / path);
      candidates.push_back(path);
    }
    for (const auto& named : candidates) {
      // One name for looking up, admitting and reading a file, also where it leads through a link.
      const auto candidate = named.lexically_normal();
      // A file that appears here later would be loaded instead.
      files_.note_input(candidate.string());
      std::error_code error;
      const auto status = fs::status(candidate, error);
      if (error || !fs::exists(status)) continue;
      if (!fs::is_regular_file(status)) {
        sink_.error(codes::kLoadNotAFile, range, candidate.string());
        unreadable_ = true;
        return true;
      }
      load_found(candidate, range, repeats_foundation);
      return true;
    }
    return false;
  }

  void load_found(const fs::path& candidate, const base::SourceRange& range,
                  bool repeats_foundation) {
    const auto real = canonical_or_empty(candidate);
    if (!gate_.check(candidate, range, sink_)) {
      unreadable_ = true;
      return;
    }
    if (real.parent_path().filename() == "foundations") foundation_loaded_ = true;
    const auto loaded = index_of_.find(real.string());
    if (loaded != index_of_.end()) {  // once is enough
      const bool is_open = std::any_of(stack_.begin(), stack_.end(), [&](const Open& open) {
        return open.file == loaded->second;
      });
      if (is_open) {
        sink_.warning(codes::kLoadCycle, range, candidate.string());
      }
      return;
    }
    const auto file = base::load_text(candidate, files_, sink_);
    if (!file) {
      unreadable_ = true;
      return;
    }
    index_of_.emplace(real.string(), model_.files.size());
    open(*file, candidate.parent_path(), false);
    model_.files.back().repeats_foundation = repeats_foundation;
  }

  void load_foundation(std::string path, const ModelAst::Place& place,
                       const base::SourceRange& range) {
    foundation_loaded_ = true;
    const auto& by = model_.files[place.file];
    const bool by_user = !by.built_in && !by.repeats_foundation;
    if (path == "foundations/EC.e" && encoding3_ && by_user) {
      if (trajectory_) open_foundation("foundations/ECTraj.e", place, range);
      path = "foundations/DEC.e";
    }
    open_foundation(path, place, range);
  }

  /// Opens a foundation. The text opened last acts first.
  void open_foundation(const std::string& path, const ModelAst::Place& place,
                       const base::SourceRange& range) {
    if (!model_.files[place.file].built_in) {
      const fs::path folder = folders_[place.file];
      load_from_disk(path, folder, range, true);
    }
    open_foundation(path);
  }

  void open_foundation(const std::string& path) {
    // Built-in texts have no real path; a colon keeps the two kinds of key apart.
    if (!index_of_.emplace("built-in:" + path, model_.files.size()).second) return;
    const auto foundation = find_foundation(path);
    open(files_.add(path, std::string(foundation->text)), {}, true);
  }

  void report_missing(const fs::path& path, const base::SourceRange& range) {
    auto report = sink_.error(codes::kLoadNotFound, range, shortened(path.string()));
    report.note(
        "looked beside the loading file, in the -I folders, in the current folder and "
        "among the built-in foundations");
    std::vector<std::string> known;
    for (const auto& foundation : foundations()) known.emplace_back(foundation.path);
    if (const auto near = base::nearest_name(path.lexically_normal().string(), known)) {
      report.fix("replace `" + path.string() + "` with `" + *near + "`");
    }
    unreadable_ = true;
  }

  void add_implicit_foundations() {
    // They come first, so their declarations do too.
    const auto of_model = std::move(model_.order);
    model_.order.clear();
    if (encoding3_ && trajectory_) open_foundation("foundations/ECTraj.e");
    open_foundation(encoding3_ ? "foundations/DEC.e" : "foundations/EC.e");
    run();
    model_.order.insert(model_.order.end(), of_model.begin(), of_model.end());
  }

  const LoadOptions& options_;
  base::SourceFiles& files_;
  base::DiagnosticSink& sink_;
  base::PathGate gate_;
  ModelAst model_;
  std::vector<fs::path> folders_;  // where each file of the model stands
  std::vector<Open> stack_;
  std::unordered_map<std::string, std::size_t> index_of_;  // by real path; look-up only
  bool encoding3_ = false;
  bool trajectory_ = false;
  bool foundation_loaded_ = false;
  bool unreadable_ = false;
};

}  // namespace

std::span<const Foundation> foundations() { return kFoundations; }

std::optional<Foundation> find_foundation(std::string_view path) {
  for (const auto& foundation : kFoundations) {
    if (foundation.path == path) return foundation;
  }
  return std::nullopt;
}

base::Result<ModelAst> load_model(std::span<const std::filesystem::path> paths,
                                  const LoadOptions& options, base::SourceFiles& files,
                                  base::DiagnosticSink& sink) {
  ModelLoader loader(options, files, sink);
  for (const auto& path : paths) loader.gate().admit_beside(path);
  for (const auto& path : paths) loader.load_main(path);
  return loader.finish();
}

base::Result<ModelAst> load_model_text(base::FileId main, const std::filesystem::path& folder,
                                       const LoadOptions& options, base::SourceFiles& files,
                                       base::DiagnosticSink& sink) {
  ModelLoader loader(options, files, sink);
  loader.gate().admit_from(folder);
  loader.load_main_text(main, folder);
  return loader.finish();
}

}  // namespace parallax::compiler
