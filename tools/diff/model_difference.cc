#include "tools/diff/model_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <functional>
#include <set>
#include <system_error>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/shown_text.h"
#include "compiler/cnf/encoder.h"
#include "compiler/compare/model_facts.h"
#include "compiler/ground/grounder.h"
#include "compiler/sema/check.h"
#include "runtime/session/solver_session.h"

namespace parallax::tools {

using compiler::AtomKind;
using compiler::CompiledModel;
using compiler::Fact;
using compiler::Literal;
using compiler::Timepoint;

namespace {

/// None if the text is not a valid model.
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
                    const std::vector<RevisionEdit>& undone) {
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

/// For each origin: is it on the line of an edited fact?
std::vector<bool> edited_origins(const compiler::CompiledModel& model,
                                 const std::vector<Fact>& facts,
                                 const std::vector<std::size_t>& edited) {
  std::set<std::pair<std::string, std::uint32_t>> places;
  for (const auto i : edited) places.emplace(facts[i].place.file, facts[i].place.line);
  std::vector<bool> out;
  for (const auto& origin : model.origins) {
    out.push_back(places.contains({origin.place.file, origin.place.begin.line}));
  }
  return out;
}

/// The facts of one side that the other has not.
std::vector<std::size_t> edited_facts(const compiler::FactDifference& facts, bool old_side) {
  auto out = old_side ? facts.removed : facts.added;
  for (const auto& [i, j] : facts.changed) out.push_back(old_side ? i : j);
  return out;
}

/// `kept`: the side that has the trace.
std::vector<RevisionEdit> edits_of(const compiler::FactDifference& facts, bool old_is_kept) {
  std::vector<RevisionEdit> out;
  const auto add = [&](std::optional<std::size_t> i, std::optional<std::size_t> j) {
    out.push_back(old_is_kept ? RevisionEdit{i, j} : RevisionEdit{j, i});
  };
  for (const auto i : facts.removed) add(i, std::nullopt);
  for (const auto j : facts.added) add(std::nullopt, j);
  for (const auto& [i, j] : facts.changed) add(i, j);
  return out;
}

class ModelComparison {
 public:
  ModelComparison(const ModelDiffOptions& options, Context& context)
      : options_(options), context_(context) {
    options_.load.compile = options.traces;
  }

  base::Result<ModelDifference> run(const std::string& old_path, RevisionKind old_kind,
                                    const std::string& new_path, RevisionKind new_kind) {
    auto a = load_model_revision(old_path, old_kind, load_of(true), context_);
    auto b = load_model_revision(new_path, new_kind, load_of(false), context_);
    if (!a || !b) return context_.sink().already_reported();
    out_.old_side = *std::move(a);
    out_.new_side = *std::move(b);
    if (options_.traces) {
      out_.old_horizon = out_.old_side.compiled->horizon;
      out_.new_horizon = out_.new_side.compiled->horizon;
    }
    if (!align_horizons()) return context_.sink().already_reported();
    if (!align_facts()) return context_.sink().already_reported();
    if (!align_names()) return context_.sink().already_reported();
    if (options_.facts) {
      compiler::drop_equal_order(out_.old_side.facts, out_.new_side.facts);
      out_.facts = compiler::compare_facts(out_.old_side.facts, out_.new_side.facts);
      compare_settings();
    }
    if (options_.traces) compare_traces();
    return std::move(out_);
  }

 private:
  LoadRevision load_of(bool is_old) const {
    auto out = options_.load;
    const auto& commands = is_old ? options_.old_commands : options_.new_commands;
    const auto& model = is_old ? options_.old_model : options_.new_model;
    if (commands) out.commands = commands;
    if (model) out.model = *model;
    return out;
  }

  /// A text is compiled for the shorter horizon; a compiled model is cut.
  bool align_horizons() {
    auto& a = out_.old_side;
    auto& b = out_.new_side;
    if (!options_.traces || a.compiled->horizon == b.compiled->horizon) return true;
    const auto shorter = std::min(a.compiled->horizon, b.compiled->horizon);
    out_.remarks.push_back(
        fmt::format("the horizons differ ({} and {}): traces are compared up to the smaller one",
                    a.compiled->horizon, b.compiled->horizon));
    for (auto* side : {&a, &b}) {
      if (side->kind != RevisionKind::kModel || side->compiled->horizon == shorter) continue;
      auto load = load_of(side == &a);
      load.model.horizon = shorter;
      auto again = load_model_revision(side->name, side->kind, load, context_);
      if (!again) return false;
      *side = *std::move(again);
    }
    return true;
  }

  /// Compiled models and texts have different facts: then both are compared as compiled.
  bool align_facts() {
    const bool mixed = (out_.old_side.kind == RevisionKind::kArtifact) !=
                       (out_.new_side.kind == RevisionKind::kArtifact);
    if (!mixed) return true;
    if (!options_.traces) {
      context_.sink().error_about(
          codes::kUsage, out_.old_side.name,
          "a text and a compiled model have only compiled facts in common; leave --no-traces out");
      return false;
    }
    use_artifact_facts(out_.old_side);
    use_artifact_facts(out_.new_side);
    return true;
  }

  bool align_names() {
    for (const auto& one : options_.renamings) {
      const auto refuse = [&](const ModelRevision& side, const std::string& name) {
        context_.sink().error_about(
            codes::kUsage, side.name,
            fmt::format("--rename: the name `{}` does not occur here", base::printable(name)));
        return false;
      };
      if (!has_name(out_.old_side, one.before)) return refuse(out_.old_side, one.before);
      if (!has_name(out_.new_side, one.after)) return refuse(out_.new_side, one.after);
    }
    if (!are_one_to_one()) return false;
    out_.renamings = with_variables(options_.renamings, out_.old_side, out_.new_side);
    rename(out_.old_side, out_.renamings);
    if (!options_.find_renamings || !options_.facts) return true;
    const auto found = find_renamings(out_.old_side, out_.new_side);
    rename(out_.old_side, found);
    out_.renamings.insert(out_.renamings.end(), found.begin(), found.end());
    return true;
  }

  /// Two names that became one would be told as no difference.
  bool are_one_to_one() {
    std::set<std::string> before, after;
    for (const auto& one : options_.renamings) {
      const bool is_new = before.insert(one.before).second && after.insert(one.after).second;
      if (is_new) continue;
      context_.sink().error_about(
          codes::kUsage, out_.old_side.name,
          fmt::format("--rename: `{}={}` names one that another rule names, too",
                      base::printable(one.before), base::printable(one.after)));
      return false;
    }
    for (const auto& name : after) {
      if (before.contains(name) || !has_name(out_.old_side, name)) continue;
      context_.sink().error_about(
          codes::kUsage, out_.old_side.name,
          fmt::format("--rename: `{}` occurs here, too, and would be two names in one",
                      base::printable(name)));
      return false;
    }
    return true;
  }

  /// Remarks on files of a command that both sides have as one file, or that are not there.
  void note_command() {
    const auto& a = out_.old_side.command;
    const auto& b = out_.new_side.command;
    const auto folder = [](const ModelRevision& side) {
      return base::real_path(side.name).parent_path();
    };
    const bool is_one_folder = folder(out_.old_side) == folder(out_.new_side);
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
      std::error_code error;
      const bool in_old = std::filesystem::is_regular_file(a[i], error);
      const bool in_new = std::filesystem::is_regular_file(b[i], error);
      // A program of the system is that of both.
      const bool is_system = i == 0 && !base::lies_below(a[i], base::real_path("."));
      if (is_system) continue;
      if (in_old && in_new && !is_one_folder && base::real_path(a[i]) == base::real_path(b[i])) {
        out_.remarks.push_back(fmt::format(
            "the command names {}, the same file for both sides: what changed in it is not seen",
            base::printable(a[i])));
      }
      if (in_old || in_new || i == 0 || !looks_like_file(a[i])) continue;
      out_.remarks.push_back(fmt::format(
          "the command names {}, which was not found: it was not compared", base::printable(a[i])));
    }
  }

  static bool looks_like_file(const std::string& word) {
    const auto name = std::filesystem::path(word).filename().string();
    const auto dot = name.rfind('.');
    return !word.starts_with('-') && dot != name.npos && dot > 0 && dot + 1 < name.size() &&
           base::is_name_character(name[dot + 1]) && !base::is_digit(name[dot + 1]);
  }

  void compare_settings() {
    const auto& a = out_.old_side;
    const auto& b = out_.new_side;
    if (a.settings && b.settings) note_command();
    if (a.settings && b.settings) {
      out_.settings = tools::compare_settings(*a.settings, *b.settings);
    } else if (a.settings || b.settings) {
      out_.remarks.push_back(fmt::format(
          "only {} is a scenario: what is simulated and how it is judged was not compared",
          (a.settings ? a : b).name));
    }
  }

  void compare_traces() {
    const auto& a = *out_.old_side.compiled;
    const auto& b = *out_.new_side.compiled;
    if (a.has_constraints || b.has_constraints) {
      out_.remarks.emplace_back(
          "state constraints do not end a trace here: executions are compared up to the horizon");
    }
    for (const auto* side : {&out_.old_side, &out_.new_side}) {
      if (side->reservation.empty()) continue;
      out_.remarks.push_back(fmt::format("the traces of {} are {}: its plan may have others",
                                         side->name, side->reservation));
    }
    runtime::DifferenceOptions options;
    options.list_limit = options_.list_limit;
    // Whoever asks for more may wait for more.
    options.graph = {10 * options_.list_limit, 20 * options_.list_limit};
    options.stop = &context_.stop();
    options.first_edited = edited_origins(a, out_.old_side.facts, edited_facts(out_.facts, true));
    options.second_edited = edited_origins(b, out_.new_side.facts, edited_facts(out_.facts, false));
    out_.traces = runtime::compare_traces(a, b, options);
    out_.lost_edits = attribute(out_.traces->lost, true);
    out_.gained_edits = attribute(out_.traces->gained, false);
  }

  std::optional<std::vector<RevisionEdit>> attribute(const runtime::OneSided& side, bool lost) {
    const bool texts = out_.old_side.is_text && out_.new_side.is_text;
    if (!side.witness || !texts || !options_.facts) return std::nullopt;
    const auto& kept = lost ? out_.old_side : out_.new_side;
    const auto& refused = lost ? out_.new_side : out_.old_side;
    return responsible_edits(kept.facts, refused.facts, edits_of(out_.facts, lost),
                             side.witness->trace, out_.traces->vocabulary, options_.load.model,
                             context_);
  }

  ModelDiffOptions options_;
  Context& context_;
  ModelDifference out_;
};

constexpr std::size_t kMaxEditsForSubsets = 6;

/// The first of the smallest proper parts that are not empty and suffice.
std::optional<std::vector<RevisionEdit>> smallest_part(
    const std::vector<RevisionEdit>& edits,
    const std::function<bool(const std::vector<RevisionEdit>&)>& suffices) {
  for (std::size_t size = 1; size + 1 < edits.size(); ++size) {  // one less was tried before
    for (std::uint32_t mask = 0; mask < (1U << edits.size()); ++mask) {
      if (static_cast<std::size_t>(std::popcount(mask)) != size) continue;
      std::vector<RevisionEdit> part;
      for (std::size_t i = 0; i < edits.size(); ++i) {
        if ((mask >> i & 1U) != 0) part.push_back(edits[i]);
      }
      if (suffices(part)) return part;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::vector<RevisionEdit>> responsible_edits(
    const std::vector<Fact>& kept, const std::vector<Fact>& refused,
    const std::vector<RevisionEdit>& edits, const runtime::Trace& trace,
    const runtime::SharedVocabulary& vocabulary, const ModelOptions& options, Context& context) {
  if (edits.size() > kMaxTriedEdits) return std::nullopt;
  bool stopped = false;
  const auto suffices = [&](const std::vector<RevisionEdit>& undone) {
    const auto model =
        compile_text(variant(kept, refused, undone), trace.length(), options, context);
    const auto admitted = model ? admits(*model, trace, vocabulary, context) : base::Known::kNo;
    stopped = stopped || admitted == base::Known::kUndecided || context.stopped();
    return admitted == base::Known::kYes;
  };
  auto undone = edits;
  // Repeats until nothing changes: once an edit is dropped, an edit that it needed (the declaration
  // of a name) may be dropped as well. A single edit is responsible for what it brings.
  for (bool again = true; again && undone.size() > 1 && !stopped;) {
    again = false;
    for (std::size_t i = 0; i < undone.size() && undone.size() > 1 && !stopped;) {
      auto fewer = undone;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
      if (suffices(fewer)) {
        undone = std::move(fewer);
        again = true;
      } else {
        ++i;
      }
    }
  }
  // Several edits together may be dispensable though none is alone.
  if (undone.size() <= kMaxEditsForSubsets && !stopped) {
    if (auto smaller = smallest_part(undone, suffices)) undone = *std::move(smaller);
  }
  if (stopped) return std::nullopt;
  return undone;
}

void add_scenario_folders(const std::string& old_path, const std::string& new_path,
                          ModelDiffOptions& options) {
  if (options.old_commands || options.new_commands) return;
  const auto before = base::real_path(old_path).parent_path();
  const auto after = base::real_path(new_path).parent_path();
  if (before == after) return;
  const auto side = [](const std::filesystem::path& folder, const std::filesystem::path& other) {
    CommandFolder out{folder, {folder}, {other}};
    for (auto above = folder; above.has_relative_path(); above = above.parent_path()) {
      if (!base::is_marked_root(above)) continue;
      if (above != folder) out.current.push_back(above);
      break;
    }
    out.current.push_back(base::real_path("."));
    return out;
  };
  options.old_commands = side(before, after);
  options.new_commands = side(after, before);
}

base::Result<ModelDifference> compare_models(const std::string& old_path, RevisionKind old_kind,
                                             const std::string& new_path, RevisionKind new_kind,
                                             const ModelDiffOptions& options, Context& context) {
  auto with = options;
  const bool are_scenarios =
      old_kind == RevisionKind::kScenario && new_kind == RevisionKind::kScenario;
  if (are_scenarios) add_scenario_folders(old_path, new_path, with);
  return ModelComparison(with, context).run(old_path, old_kind, new_path, new_kind);
}

}  // namespace parallax::tools
