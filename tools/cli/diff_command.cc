#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <tuple>

#include "compiler/base/codes/files.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/words.h"
#include "tools/cli/command.h"
#include "tools/cli/diff_gate.h"
#include "tools/cli/diff_markdown.h"
#include "tools/cli/shared_options.h"
#include "tools/diff/kept_difference.h"
#include "tools/diff/model_difference.h"
#include "tools/diff/rates_revision.h"
#include "tools/diff/revision.h"
#include "tools/diff/textconv.h"
#include "tools/diff/trace_set.h"

namespace parallax::tools {
namespace {

using compiler::FactKind;
using Json = nlohmann::ordered_json;

struct DiffOptions {
  std::string old_path, new_path, tree;
  std::string textconv;
  std::string gate, markdown;
  bool fallback = false;
  bool stat = false;
  bool exit_code = false;
  ModelDiffOptions models;
  bool no_traces = false;
  bool traces_only = false;
  std::vector<std::string> renamings;
  CommandPermission commands;
  std::int64_t jobs = 1;
};

std::string quoted(const std::string& text) { return base::json_text(Json(base::printable(text))); }

/// The result of every kind of comparison: a text, or the fields of a document.
struct ComparedRevisions {
  bool differs = false;
  std::string text;
  std::string kind;    // "model"
  std::string fields;  // `"axioms":{...},...`
};

int print(const DiffOptions& options, const ComparedRevisions& outcome, Invocation& invocation) {
  if (invocation.options().json) {
    invocation.document(
        fmt::format("{{\"status\":\"ok\",\"equal\":{},\"kind\":\"{}\",\"old\":{},\"new\":{},{}}}\n",
                    !outcome.differs, outcome.kind, quoted(options.old_path),
                    quoted(options.new_path), outcome.fields));
  } else {
    const auto text = outcome.text + (outcome.differs ? "" : "no difference\n");
    invocation.result(text);
    if (!write_diff_markdown({options.markdown, options.old_path, options.new_path, text},
                             invocation)) {
      return 0;
    }
  }
  return outcome.differs ? 1 : 0;
}

std::string facts_text(const FactReport& report, const char* declarations, const char* axioms,
                       bool stat) {
  return to_text(report, FactKind::kDeclaration, declarations, stat) +
         to_text(report, FactKind::kAxiom, axioms, stat);
}

std::string facts_fields(const FactReport& report, const char* declarations, const char* axioms) {
  return fmt::format("\"{}\":{},\"{}\":{}", declarations, to_json(report, FactKind::kDeclaration),
                     axioms, to_json(report, FactKind::kAxiom));
}

/// Reports a question that no call could answer; the other answers still count.
void report_unknown(const ModelDifference& found, Invocation& invocation) {
  const auto report = [&](const ModelRevision& kept, const ModelRevision& other) {
    invocation.sink().error_about(
        codes::kLimitReached, "",
        fmt::format("for deciding whether {} has a trace that {} has not",
                    base::printable(kept.name), base::printable(other.name)));
  };
  if (found.traces->lost.answer == runtime::DifferenceAnswer::kUnknown) {
    report(found.old_side, found.new_side);
  }
  if (found.traces->gained.answer == runtime::DifferenceAnswer::kUnknown) {
    report(found.new_side, found.old_side);
  }
}

int diff_models(const DiffOptions& options, RevisionKind old_kind, RevisionKind new_kind,
                Invocation& invocation) {
  const auto found = compare_models(options.old_path, old_kind, options.new_path, new_kind,
                                    options.models, invocation);
  if (!found) return 0;
  const auto report = found->report();
  ComparedRevisions out;
  out.kind = "model";
  out.differs = !found->renamings.empty() || !found->facts.empty() ||
                (found->settings && !found->settings->empty());
  if (found->traces) {
    out.differs = out.differs || found->traces->lost.answer == runtime::DifferenceAnswer::kFound ||
                  found->traces->gained.answer == runtime::DifferenceAnswer::kFound;
    report_unknown(*found, invocation);
  }
  if (invocation.options().json) {
    out.fields = "\"renamed\":" + renamings_json(found->renamings) + ',' +
                 facts_fields(report, "declarations", "axioms") +
                 ",\"settings\":" + (found->settings ? settings_json(*found->settings) : "null") +
                 ",\"traces\":" + traces_json(*found) +
                 ",\"remarks\":" + base::json_text(Json(found->remarks));
  } else {
    out.text = renamings_text(found->renamings, options.stat) +
               facts_text(report, "declarations", "axioms", options.stat);
    if (found->settings) out.text += settings_text(*found->settings, options.stat);
    for (const auto& remark : found->remarks) out.text += remark + '\n';
    out.text += traces_text(*found, options.stat);
  }
  // No difference was found, but not everything was decided: that is not "equal".
  if (!out.differs && invocation.sink().has_errors()) {
    if (!invocation.options().json) invocation.result(out.text);
    return 0;
  }
  return print(options, out, invocation);
}

/// A changed form and the smallest pieces in which it differs.
struct FormEdits {
  std::string form;
  std::vector<compiler::DatumEdit> edits;
};

std::vector<FormEdits> form_edits(const FactReport& report, const PlanRevision& before,
                                  const PlanRevision& after, const base::SourceFiles& files) {
  std::vector<FormEdits> out;
  if (!before.lisp || !after.lisp) return out;
  for (const auto& [i, j] : report.difference.changed) {
    const auto& fact = report.new_facts[j];
    if (fact.kind != FactKind::kAxiom) continue;
    out.push_back({fact.key.empty() ? fact.shown : fact.key + ")",
                   datum_edits(*before.lisp, before.lisp->forms[i], *after.lisp,
                               after.lisp->forms[j], files)});
  }
  return out;
}

std::string edits_text(const std::vector<FormEdits>& forms) {
  std::string out;
  for (const auto& [form, edits] : forms) {
    out += fmt::format("in {}\n", form);
    for (const auto& edit : edits) {
      const auto around = edit.around.empty() ? "" : "  around  " + edit.around;
      if (!edit.removed.empty()) {
        out += fmt::format("  - {}  {}{}\n", to_string(edit.old_place), edit.removed, around);
      }
      if (!edit.added.empty()) {
        out += fmt::format("  + {}  {}{}\n", to_string(edit.new_place), edit.added, around);
      }
    }
  }
  return out;
}

Json edits_json(const std::vector<FormEdits>& forms) {
  Json out = Json::array();
  const auto side = [](const std::string& text, const compiler::FactPlace& place) {
    return text.empty() ? Json(nullptr)
                        : Json{{"text", text}, {"file", place.file}, {"line", place.line}};
  };
  for (const auto& [form, edits] : forms) {
    for (const auto& edit : edits) {
      out.push_back({{"form", form},
                     {"old", side(edit.removed, edit.old_place)},
                     {"new", side(edit.added, edit.new_place)},
                     {"around", edit.around.empty() ? Json(nullptr) : Json(edit.around)}});
    }
  }
  return out;
}

/// Shortens changed long forms to the parts that changed.
void show_changes(const FactReport& report, PlanRevision& before, PlanRevision& after) {
  if (!before.lisp) return;  // entries of binding tables are shown whole
  for (const auto& [i, j] : report.difference.changed) {
    auto& x = before.facts[i];
    auto& y = after.facts[j];
    std::tie(x.shown, y.shown) = compiler::changed_parts(x.text, y.text);
  }
}

int diff_plans(const DiffOptions& options, RevisionKind kind, Invocation& invocation) {
  auto before = load_plan_revision(options.old_path, kind, invocation);
  auto after = load_plan_revision(options.new_path, kind, invocation);
  if (!before || !after) return 0;
  compiler::drop_equal_order(before->facts, after->facts);
  const auto report = compare(before->facts, after->facts);
  ComparedRevisions out;
  out.kind = "plan";
  out.differs = !report.difference.empty();
  show_changes(report, *before, *after);
  const auto edits = form_edits(report, *before, *after, invocation.files());
  out.fields =
      facts_fields(report, "order", "forms") + ",\"edits\":" + base::json_text(edits_json(edits));
  out.text = facts_text(report, "order", "forms", options.stat);
  if (!options.stat) out.text += edits_text(edits);
  return print(options, out, invocation);
}

base::Result<std::vector<compiler::Fact>> result_facts(const std::string& path, RevisionKind kind,
                                                       Invocation& invocation) {
  if (kind == RevisionKind::kRun) return load_run_facts(path, invocation);
  const auto rates = load_rates(path, invocation);
  if (!rates) return invocation.sink().already_reported();
  return rates_facts(*rates);
}

/// Adds what differs between the texts that two runs kept.
void add_kept(const DiffOptions& options, ComparedRevisions& out, Invocation& invocation) {
  const auto compared = compare_kept(options.old_path, options.new_path, invocation);
  const auto& kept = compared.difference;
  if (!kept) {
    out.fields += ",\"inputs\":null,\"inputs_refused\":" + quoted(compared.refused);
    std::error_code error;
    const bool folders = std::filesystem::is_directory(options.old_path, error) &&
                         std::filesystem::is_directory(options.new_path, error);
    if (!folders) return;  // a report alone has no texts beside it
    out.text += fmt::format("the texts of the scenarios were not compared: {}\n", compared.refused);
    return;
  }
  const auto text = kept_text(*kept, options.stat);
  out.differs = out.differs || !text.empty();
  if (!text.empty()) out.text += "what changed in the scenario\n" + text;
  out.fields += fmt::format(",\"inputs\":{{{},\"settings\":{}}}",
                            facts_fields(kept->report(), "declarations", "axioms"),
                            kept->settings ? settings_json(*kept->settings) : "[]");
}

/// Runs, or results of `parallax rates`.
int diff_results(const DiffOptions& options, RevisionKind kind, Invocation& invocation) {
  const auto before = result_facts(options.old_path, kind, invocation);
  const auto after = result_facts(options.new_path, kind, invocation);
  if (!before || !after) return 0;
  const auto report = compare(*before, *after);
  ComparedRevisions out;
  out.kind = kind == RevisionKind::kRun ? "run" : "rates";
  out.differs = !report.difference.empty();
  out.fields = facts_fields(report, "settings", "results");
  out.text = facts_text(report, "settings", "results", options.stat);
  if (kind == RevisionKind::kRun) add_kept(options, out, invocation);
  return print(options, out, invocation);
}

std::string side_text(const char* what, const TraceSet& set, const TraceSet& other,
                      const TraceSetSide& side, bool stat) {
  auto out = fmt::format("{}: {}\n", what, side.count);
  if (!side.witness || stat) return out;
  out += fmt::format("  a shortest such trace of {}, which leaves all of {} at timepoint {}:\n",
                     base::printable(set.name), base::printable(other.name), side.leaves_at);
  return out + to_text(*side.witness);
}

/// `set` is the one that has the traces.
Json side_json(const TraceSetSide& side, const TraceSet& set) {
  Json out = {{"count", side.count}, {"witness", nullptr}};
  if (!side.witness) return out;
  out["witness"] = base::parse_ordered_json(observable_jsonl(*side.witness));
  if (!set.tells_last_events && side.witness->points.back().happens.empty()) {
    out["witness"]["timepoints"].back().erase("happens");
  }
  out["witness"]["leaves_at"] = side.leaves_at;
  return out;
}

int diff_trace_files(const DiffOptions& options, Invocation& invocation) {
  const auto before = load_trace_set(options.old_path, invocation);
  const auto after = load_trace_set(options.new_path, invocation);
  if (!before || !after) return 0;
  const auto lost = only_in(*before, *after), gained = only_in(*after, *before);
  ComparedRevisions out;
  out.kind = "traces";
  out.differs = lost.count + gained.count != 0;
  const Json document = {
      {"old", {{"count", before->traces.size()}, {"complete", before->complete}}},
      {"new", {{"count", after->traces.size()}, {"complete", after->complete}}},
      {"lost", side_json(lost, *before)},
      {"gained", side_json(gained, *after)}};
  out.fields = "\"traces\":" + base::json_text(document);
  for (const auto* set : {&*before, &*after}) {
    out.text +=
        fmt::format("{}: {}{}\n", set->name, base::counted(std::ssize(set->traces), "trace"),
                    set->complete ? "" : ", not known to be all");
  }
  out.text += side_text("lost", *before, *after, lost, options.stat);
  out.text += side_text("gained", *after, *before, gained, options.stat);
  return print(options, out, invocation);
}

int convert(const DiffOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  if (invocation.options().json) {
    sink.error_about(codes::kUsage, "",
                     "--json and the canonical text cannot both go to the output");
    return 0;
  }
  if (!options.fallback) {
    const auto text = canonical_text_of(options.textconv, invocation);
    if (text) invocation.result(*text);
    return 0;
  }
  // A revision that was committed with a mistake in it must not stop `git log -p`.
  Invocation attempt(invocation.options());
  if (const auto text = canonical_text_of(options.textconv, attempt)) {
    invocation.result(*text);
  } else if (const auto raw = base::read_file(options.textconv, sink)) {
    invocation.result(*raw);
  }
  return 0;
}

bool is_usable(const DiffOptions& options, Invocation& invocation) {
  const auto refuse = [&](const char* why) {
    invocation.sink().error_about(codes::kUsage, "", why);
    return false;
  };
  if (!options.textconv.empty() && !options.old_path.empty()) {
    return refuse("--textconv takes one file and goes with no other");
  }
  if (options.textconv.empty() && options.new_path.empty()) {
    return refuse("two revisions are needed, or --textconv FILE");
  }
  if (!options.tree.empty() && options.gate.empty()) {
    return refuse("a third path goes with --gate and two revisions of git");
  }
  if (options.no_traces && options.traces_only) {
    return refuse("--no-traces and --traces-only leave nothing to compare");
  }
  if (!options.markdown.empty() && options.gate.empty() && invocation.options().json) {
    return refuse("--markdown goes with --json only under --gate");
  }
  if (!options.gate.empty() && (options.no_traces || options.traces_only || options.stat)) {
    return refuse("--gate compares what its rules ask for: no --stat, --no-traces, --traces-only");
  }
  return true;
}

/// Are OLD and NEW revisions of git? Files and folders of these names come first.
bool names_revisions(const DiffOptions& options) {
  if (options.gate.empty()) return false;
  std::error_code error;
  const auto is_there = [&](const std::string& path) {
    return std::filesystem::exists(path, error);
  };
  const bool no_files = !is_there(options.old_path) && !is_there(options.new_path) &&
                        !kind_of(options.old_path) && !kind_of(options.new_path);
  return !options.tree.empty() || no_files;
}

int run_diff(const DiffOptions& given, Invocation& invocation) {
  if (!is_usable(given, invocation)) return 0;
  if (!given.textconv.empty()) return convert(given, invocation);
  auto options = given;
  options.models.facts = !options.traces_only;
  options.models.traces = !options.no_traces;
  options.models.find_renamings = options.gate.empty();
  for (const auto& text : options.renamings) {
    const auto renaming = parse_renaming(text);
    if (!renaming) {
      invocation.sink().error_about(
          codes::kUsage, "--rename",
          fmt::format("`{}` is not of the form OLD=NEW, two names", base::printable(text)));
      return 0;
    }
    options.models.renamings.push_back(*renaming);
  }
  Rerunner rerunner(gate_simulator(options.commands.allow, invocation), options.jobs);
  GateInput input;
  input.models = options.models;
  input.rerunner = &rerunner;
  if (names_revisions(options)) {
    return run_revision_gate({options.old_path, options.new_path, options.tree}, input,
                             {options.gate, options.markdown}, invocation);
  }
  if (options.gate.empty() && !may_write_diff_markdown(options.markdown, invocation)) return 0;
  const auto old_kind = kind_of(options.old_path), new_kind = kind_of(options.new_path);
  const bool models = old_kind && new_kind && has_traces(*old_kind) && has_traces(*new_kind);
  if (!options.gate.empty() && old_kind && (models || old_kind == new_kind)) {
    input.old_path = options.old_path;
    input.new_path = options.new_path;
    input.old_kind = *old_kind;
    input.new_kind = *new_kind;
    return run_gate(input, {options.gate, options.markdown}, invocation);
  }
  if (models) return diff_models(options, *old_kind, *new_kind, invocation);
  if (!old_kind || old_kind != new_kind) {
    invocation.sink().error_about(
        codes::kUsage, options.new_path,
        fmt::format("cannot be compared with {}: name two models (.e, .dec.cnf, .yaml), two plans "
                    "(.lisp), two tables (.bind), two trace files (.jsonl), two run folders or two "
                    "results of `rates --json` (.json)",
                    base::printable(options.old_path)));
    return 0;
  }
  if (*old_kind == RevisionKind::kRun || *old_kind == RevisionKind::kRates) {
    return diff_results(options, *old_kind, invocation);
  }
  if (*old_kind == RevisionKind::kTraces) return diff_trace_files(options, invocation);
  return diff_plans(options, *old_kind, invocation);
}

void add_model_diff_options(OptionTable& command, DiffOptions& options) {
  auto& model = options.models.load.model;
  command.option("--with", model.models, "Model file that belongs to both models")
      .list(ListForm::kOneEachTime)
      .file({"e"});
  command.option("-I,--include", model.include_dirs, "Folder in which `load` looks")
      .list(ListForm::kOneEachTime)
      .folder();
  command.option("--compat", model.compat, "Meaning of the 2005 reasoner where it differs")
      .check(OneOf{{"decreasoner"}});
  command.option("--horizon", model.horizon, "Compare traces up to this timepoint")
      .check(IntRange{0, 1'000'000});
  command
      .option("--rename", options.renamings,
              "OLD=NEW: a name (constant, region, body, ...) that is called NEW in the new model")
      .list(ListForm::kOneEachTime);
  command.flag("--no-traces", options.no_traces,
               "Compare declarations and axioms only; nothing is solved");
  command.flag("--traces-only", options.traces_only, "Compare traces only");
  command
      .option("--count-limit", options.models.list_limit,
              "Most lost and gained traces that are counted one by one")
      .details("A graph counts more of them if it has at most 20 times as many transitions.")
      .check(IntRange{1, 1'000'000})
      .show_default();
}

}  // namespace

Command diff_command() {
  auto options = std::make_shared<DiffOptions>();
  OptionTable command("diff", "Compare two revisions of a model, a plan, a trace file or a run");
  command.footer(
      "Examples:\n"
      "  parallax diff old.e new.e --horizon 6\n"
      "  parallax diff old.dec.cnf new.dec.cnf --json\n"
      "  parallax diff out/monday out/tuesday --stat\n"
      "  parallax diff old/scenario.yaml new/scenario.yaml --markdown changes.md\n"
      "  parallax diff --textconv domain.e\n"
      "  parallax diff --gate rules.yaml old.e new.e --markdown gate.md\n"
      "  parallax diff --gate rules.yaml ../base .\n"
      "  parallax diff --gate rules.yaml main HEAD cases\n"
      "Exit code 1 if there is a difference, 0 if there is none. docs/guide/regression.md shows "
      "how git uses "
      "it.");
  command
      .option("old", options->old_path,
              "Model (.e, .dec.cnf, .yaml), plan (.lisp, .bind), traces (.jsonl), run or rates "
              "(.json)")
      .file();
  command.option("new", options->new_path, "The other revision").file();
  command
      .option("path", options->tree,
              "With --gate and two revisions of git: the folder that is looked at")
      .folder();
  command.heading("What is told");
  command.option("--textconv", options->textconv, "Print the canonical text of one file instead")
      .file();
  command
      .option("--gate", options->gate,
              "Say instead which of these rules (YAML) the change keeps; exit code 1 unless all")
      .file({"yaml"});
  command
      .option("--markdown", options->markdown,
              "Write what is told to this file as Markdown, for a pull request")
      .file();
  command
      .option("-j,--jobs", options->jobs,
              "With --gate: simulations at the same time, for rules that demand runs")
      .needs("--gate")
      .check(WholeNumber{1, 256})
      .show_default();
  command.flag("--fallback", options->fallback,
               "With --textconv: print a file that has errors as it is");
  command.flag("--stat", options->stat, "Print numbers only");
  command.flag("--exit-code", options->exit_code,
               "Accepted for those who know it from git; the exit code always tells");
  add_model_diff_options(command, *options);
  add_command_options(command, options->commands, false);
  return command_of(std::move(command), options, run_diff);
}

}  // namespace parallax::tools
