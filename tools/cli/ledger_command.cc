#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "harness/config/ledger.h"
#include "harness/report/text_layout.h"
#include "tools/app/discrepancy.h"
#include "tools/app/evidence.h"
#include "tools/cli/command.h"
#include "tools/cli/shared_options.h"
#include "tools/history/git.h"
#include "tools/ledger/ledger_check.h"
#include "tools/ledger/ledger_text.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

using harness::Ledger;
using harness::LedgerEntry;
using harness::LedgerStatus;
using nlohmann::ordered_json;

struct LedgerOptions {
  std::string action;
  std::vector<std::string> words;
  std::string ledger = "ledger.yaml";
  std::string scenario, status, in, because, revision;
};

base::Reported usage(const std::string& message, Invocation& invocation) {
  return invocation.sink().error_about(codes::kUsage, "", message);
}

/// A run folder, with its comparison to the ledger.
struct NamedRun {
  std::string folder;
  std::string scenario;  // its name in the ledger
  ShownRun run;
};

/// Finds the run's scenario: the first line of its journal says in which folder it was started.
fs::path scenario_of(const std::string& folder, const ShownRun& run) {
  std::ifstream file(fs::path(folder) / harness::kJournalName, std::ios::binary);
  constexpr std::size_t kLongestHeader = std::size_t{1} << 20U;
  std::string line(kLongestHeader, '\0');
  file.read(line.data(), static_cast<std::streamsize>(line.size()));
  line.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  line.resize(std::min(line.find('\n'), line.size()));
  const auto header = harness::decode_header(line);
  const auto* known = std::get_if<harness::JournalHeader>(&header);
  return known == nullptr ? fs::path(run.scenario) : scenario_path(*known);
}

base::Result<NamedRun> load_run(const std::string& folder, const LedgerOptions& options,
                                Invocation& invocation) {
  auto& sink = invocation.sink();
  std::error_code error;
  if (!fs::is_directory(folder, error) || !fs::exists(fs::path(folder) / "report.json", error)) {
    return sink.error_about(codes::kUsage, folder, "the folder holds no report of a run")
        .note("name the --out folder of a run that has ended");
  }
  const auto text = base::read_file_of(folder, "report.json", sink);
  if (!text) return sink.already_reported();
  auto run = shown_run(*text);
  const auto path = (fs::path(folder) / "report.json").string();
  if (!run) {
    return sink.error_about(codes::kReplayImpossible, path, "this is no report of a run");
  }
  invocation.files().note_input(path);
  const auto scenario =
      options.scenario.empty() ? scenario_of(folder, *run) : fs::path(options.scenario);
  return NamedRun{folder, harness::ledger_name(scenario, options.ledger), *std::move(run)};
}

base::Result<std::vector<NamedRun>> load_runs(const LedgerOptions& options,
                                              Invocation& invocation) {
  if (options.words.empty()) {
    return usage(fmt::format("ledger {} takes the folders of runs", options.action), invocation);
  }
  std::vector<NamedRun> out;
  for (const auto& folder : options.words) {
    auto run = load_run(folder, options, invocation);
    if (!run) return invocation.sink().already_reported();
    out.push_back(*std::move(run));
  }
  return out;
}

ordered_json entry_json(const LedgerEntry& entry) {
  ordered_json out = {{"id", entry.id}, {"scenario", entry.scenario}, {"event", entry.event}};
  if (entry.outcome) out["outcome"] = *entry.outcome;
  if (entry.fluents) out["fluents"] = *entry.fluents;
  if (entry.trace) out["trace"] = *entry.trace;
  const auto told = [&](const char* name, const std::string& value) {
    if (!value.empty()) out[name] = value;
  };
  told("says", entry.says);
  told("cause", entry.cause);
  told("model", entry.model);
  told("first_seen", entry.first_seen);
  out["status"] = to_string(entry.status);
  told(entry.status == LedgerStatus::kRepaired ? "in" : "because", entry.decision);
  return out;
}

void print(const ordered_json& document, Invocation& invocation) {
  invocation.document(base::json_text(document) + '\n');
}

// list

int list(const LedgerOptions& options, Invocation& invocation) {
  const auto ledger = harness::load_ledger(options.ledger, invocation.files(), invocation.sink());
  if (!ledger) return 0;
  const auto is_wanted = [&](const LedgerEntry& entry) {
    return options.status.empty() || to_string(entry.status) == options.status;
  };
  if (invocation.options().json) {
    auto entries = ordered_json::array();
    for (const auto& entry : ledger->entries) {
      if (is_wanted(entry)) entries.push_back(entry_json(entry));
    }
    print({{"status", "ok"}, {"discrepancies", entries}}, invocation);
    return 0;
  }
  std::string out;
  for (const auto& entry : ledger->entries) {
    if (!is_wanted(entry)) continue;
    out += fmt::format("{}  {}\n", entry.id, base::printable(status_text(entry)));
    const auto line = [&](std::string_view label, const std::string& text) {
      if (!text.empty()) out += harness::wrapped(fmt::format("  {:<10}", label), text, 12);
    };
    line("scenario", entry.scenario);
    line("says", entry.says.empty() ? entry.event : entry.says);
    line("cause", entry.cause);
    line("model", entry.model);
    line("seen", entry.first_seen);
  }
  invocation.result(out.empty() ? "no discrepancies\n" : out);
  return 0;
}

// check

int check(const LedgerOptions& options, Invocation& invocation) {
  const auto ledger = harness::load_ledger(options.ledger, invocation.files(), invocation.sink());
  if (!ledger) return 0;
  const auto runs = load_runs(options, invocation);
  if (!runs) return 0;
  bool wrong = false;
  std::string text;
  auto findings = ordered_json::array();
  std::map<std::string, const LedgerEntry*> gone;
  std::set<std::string> shown;
  for (const auto& one : *runs) {
    const auto verdict = hold_against(*ledger, one.scenario, one.run);
    wrong = wrong || verdict.is_wrong();
    for (const auto& finding : verdict.findings) {
      static constexpr std::string_view kKinds[] = {"unknown", "known", "back"};
      const auto kind = kKinds[static_cast<std::size_t>(finding.kind)];
      text += harness::wrapped(fmt::format("{:<8}{}: ", kind, base::printable(one.folder)),
                               finding.words(), 8);
      findings.push_back({{"run", one.folder},
                          {"scenario", one.scenario},
                          {"is", kind},
                          {"sample", finding.shown.sample},
                          {"identity", identity_text(finding.shown)},
                          {"words", finding.shown.words}});
      if (finding.entry != nullptr) {
        findings.back()["id"] = finding.entry->id;
        shown.insert(finding.entry->id);
      }
    }
    for (const auto* entry : verdict.gone) gone.emplace(entry->id, entry);
  }
  std::erase_if(gone, [&](const auto& one) { return shown.contains(one.first); });
  auto stale = ordered_json::array();
  const auto note = [&](const std::string& id, const std::string& words) {
    stale.push_back({{"id", id}, {"words", words}});
    text += harness::wrapped("gone    ", words, 8);
  };
  for (const auto& [id, entry] : gone) note(id, gone_text(*entry));
  for (const auto& entry : ledger->entries) {
    if (lacks_scenario(entry, options.ledger)) note(entry.id, lost_text(entry));
  }
  if (invocation.options().json) {
    print({{"status", "ok"}, {"known", !wrong}, {"findings", findings}, {"stale", stale}},
          invocation);
  } else {
    invocation.result(text.empty() ? "no discrepancies\n" : text);
  }
  return wrong ? 1 : 0;
}

// add

/// The axiom that contradicts the observations, and the kind of cause, as far as they can be found.
void add_blame(const NamedRun& run, const std::string& sample, const LedgerOptions& options,
               Invocation& invocation, LedgerEntry& entry) {
  Context own(invocation.form(), invocation.stop());
  const auto found = load_discrepancy({run.folder, options.scenario}, sample, own);
  if (!found || !*found) {
    const auto why = own.sink().sorted();
    invocation.remark(fmt::format("{}: no model line is told for it{}", entry.id,
                                  why.empty() ? "" : ": " + why.front().message));
    return;
  }
  const auto& model = (*found)->loaded.compilation.model;
  ContradictionSearch search(model, observed_run(**found), own);
  if (const auto sets = (*found)->parting
                            ? blamed_sets(**found, {}, search)
                            : base::Result<runtime::MinimalSets>(runtime::MinimalSets{});
      sets && !sets->sets.empty()) {
    for (const auto& axiom : search.look_at(sets->sets.front()).axioms) {
      const auto& place = model.origins[axiom.origin].place;
      if (place.file.empty()) continue;
      entry.model =
          fmt::format("{}:{}", harness::ledger_name(place.file, options.ledger), place.begin.line);
      break;
    }
  }
  if (const auto evidence = gather_evidence(run.folder, **found, {}, own)) {
    entry.cause = to_string(evidence->finding.kind);
  }
}

LedgerEntry new_entry(const NamedRun& run, const ShownDiscrepancy& shown, const Ledger& ledger) {
  LedgerEntry entry;
  entry.scenario = run.scenario;
  entry.event = shown.event;
  if (!shown.outcome.empty()) entry.outcome = shown.outcome;
  if (shown.outcome.empty()) entry.fluents = shown.fluents;
  entry.trace = shown.trace;
  entry.says = shown.words;
  entry.id = free_id(ledger, entry);
  return entry;
}

/// The ledger as it stands on disk.
struct OpenLedger {
  Ledger ledger;
  std::string text;

  /// Takes over an edited text, which was checked when it was made.
  void take(std::string edited, base::SourceFiles& files, base::DiagnosticSink& sink) {
    text = std::move(edited);
    if (auto read = harness::parse_ledger(files.add("ledger", text), files, sink)) ledger = *read;
  }
};

base::Result<OpenLedger> open_ledger(const LedgerOptions& options, bool or_new,
                                     Invocation& invocation) {
  OpenLedger out;
  std::error_code error;
  const bool is_new = !fs::exists(fs::symlink_status(options.ledger, error));
  if (is_new && or_new) {
    out.take(new_ledger_text(), invocation.files(), invocation.sink());
    return out;
  }
  auto ledger = harness::load_ledger(options.ledger, invocation.files(), invocation.sink());
  if (!ledger) return invocation.sink().already_reported();
  out.text = invocation.files()[ledger->file].text();
  out.ledger = *std::move(ledger);
  return out;
}

/// Writes the edited text, unless somebody else has written the file meanwhile.
bool save(const LedgerOptions& options, const std::string& before, const std::string& text,
          Invocation& invocation) {
  auto& sink = invocation.sink();
  base::DiagnosticSink unread;
  const auto now = base::read_file(options.ledger, unread);
  if (now && *now != before) {
    sink.error_about(codes::kFileNotWritable, options.ledger,
                     "it was changed meanwhile; try again");
    return false;
  }
  return base::write_file_atomically(options.ledger, text, sink).has_value();
}

/// The additions of `add` so far.
struct Additions {
  OpenLedger ledger;
  std::string text;
  ordered_json added = ordered_json::array();
  bool back = false;
};

/// Adds the discrepancies of one run that the ledger does not know; false if its layout does not
/// allow that.
bool add_run(const NamedRun& run, const LedgerOptions& options, const std::string& revision,
             Invocation& invocation, Additions& all) {
  constexpr std::size_t kMostAdded = 100, kMostBlamed = 20;
  // Points into the ledger as it was.
  const auto known = all.ledger.ledger;
  for (const auto& finding : hold_against(known, run.scenario, run.run).findings) {
    if (finding.kind != LedgerFinding::Kind::kUnknown) {
      all.back = all.back || finding.is_wrong();
      if (finding.is_wrong()) all.text += base::printable(finding.words()) + '\n';
      continue;
    }
    if (all.added.size() == kMostAdded) {
      invocation.remark(fmt::format("{} are added at a time; there are more in {}", kMostAdded,
                                    base::printable(run.folder)));
      return true;
    }
    auto entry = new_entry(run, finding.shown, all.ledger.ledger);
    entry.first_seen = revision;
    if (all.added.size() < kMostBlamed) {
      add_blame(run, finding.shown.sample, options, invocation, entry);
    }
    auto edited = with_entry(all.ledger.text, all.ledger.ledger, entry);
    if (!edited) {
      invocation.sink()
          .error_about(codes::kUsage, options.ledger,
                       "its layout does not let an entry be added line by line")
          .note("write it by hand:\n" + entry_text(entry, 2));
      return false;
    }
    all.ledger.take(*std::move(edited), invocation.files(), invocation.sink());
    all.text += fmt::format("{}  {}\n", entry.id, base::printable(entry.says));
    all.added.push_back(entry_json(entry));
  }
  return true;
}

int add(const LedgerOptions& options, Invocation& invocation) {
  auto ledger = open_ledger(options, true, invocation);
  if (!ledger) return 0;
  const auto runs = load_runs(options, invocation);
  if (!runs) return 0;
  const auto before = ledger->text;
  const auto here = fs::absolute(options.ledger).string();
  const auto revision =
      options.revision.empty() ? revision_at(here).value_or("") : options.revision;
  Additions all;
  all.ledger = *std::move(ledger);
  for (const auto& one : *runs) {
    if (!add_run(one, options, revision, invocation, all)) return 0;
  }
  if (!all.added.empty() && !save(options, before, all.ledger.text, invocation)) return 0;
  if (invocation.options().json) {
    print({{"status", "ok"}, {"added", all.added}}, invocation);
  } else {
    invocation.result(all.text.empty() ? "nothing new\n" : all.text);
  }
  return all.back ? 1 : 0;
}

// status

int set_status(const LedgerOptions& options, Invocation& invocation) {
  constexpr std::string_view kForms =
      "ledger status takes ID open, ID repaired --in REVISION, or ID accepted --because TEXT";
  if (options.words.size() != 2) return usage(std::string(kForms), invocation), 0;
  auto ledger = open_ledger(options, false, invocation);
  if (!ledger) return 0;
  const auto* known = ledger->ledger.find(options.words[0]);
  if (known == nullptr) {
    invocation.sink().error_about(codes::kUsage, options.ledger,
                                  fmt::format("it has no entry `{}`", options.words[0]));
    return 0;
  }
  auto entry = *known;
  const auto& word = options.words[1];
  const bool repaired = word == "repaired", accepted = word == "accepted";
  const bool says_why = !base::is_all_space(options.because);
  const bool fits = (word == "open" && options.in.empty() && options.because.empty()) ||
                    (repaired && !base::is_all_space(options.in) && options.because.empty()) ||
                    (accepted && says_why && options.in.empty());
  if (!fits) return usage(std::string(kForms), invocation), 0;
  entry.status = repaired   ? LedgerStatus::kRepaired
                 : accepted ? LedgerStatus::kAccepted
                            : LedgerStatus::kOpen;
  entry.decision = repaired ? options.in : options.because;
  const auto edited = with_status(ledger->text, ledger->ledger, entry);
  if (!edited) {
    invocation.sink().error_about(
        codes::kUsage, options.ledger,
        fmt::format("its layout does not let the status of `{}` be replaced; edit it by hand",
                    entry.id));
    return 0;
  }
  if (*edited != ledger->text && !save(options, ledger->text, *edited, invocation)) return 0;
  if (invocation.options().json) {
    print({{"status", "ok"}, {"entry", entry_json(entry)}}, invocation);
  } else {
    invocation.result(fmt::format("{}  {}\n", entry.id, base::printable(status_text(entry))));
  }
  return 0;
}

int run_ledger(const LedgerOptions& options, Invocation& invocation) {
  if (options.action == "add") return add(options, invocation);
  if (options.action == "check") return check(options, invocation);
  if (options.action == "status") return set_status(options, invocation);
  if (!options.words.empty()) return usage("ledger list takes nothing more", invocation), 0;
  return list(options, invocation);
}

}  // namespace

Command ledger_command() {
  auto options = std::make_shared<LedgerOptions>();
  OptionTable command(
      "ledger",
      "The known discrepancies of a project in one reviewed file (docs/reference/suites.md)");
  command.footer(
      "Examples:\n"
      "  parallax ledger add out/edge                      what the run shows and nobody knew\n"
      "  parallax ledger list --status open\n"
      "  parallax ledger check out/edge out/plan2          exit 1: something is not known\n"
      "  parallax ledger status edge.place-r1 repaired --in 3f2a1c0\n"
      "  parallax ledger status edge.place-r1 accepted --because \"the cup never stands there\"\n"
      "The same file is understood by `suite`, `verify` and `report` (--ledger FILE).\n"
      "Exit codes: 0 all known, 1 a discrepancy that the ledger does not know, or one that was\n"
      "repaired and comes back; entries that no run shows any more are named.");
  command.option("action", options->action, "list, add, check or status")
      .required()
      .check(OneOf{{"list", "add", "check", "status"}});
  command.option("words", options->words, "Folders of runs; of `status` an id and what it is")
      .folder();
  command.option("--ledger", options->ledger, "The file").show_default().file({"yaml"});
  command.option("--status", options->status, "list: only these")
      .check(one_of(harness::kLedgerStatusWords));
  command.option("--in", options->in, "status repaired: the revision");
  command.option("--because", options->because, "status accepted: the reason");
  command.option("--revision", options->revision,
                 "add: where it was first seen; else what git says of the ledger's folder");
  add_recorded_scenario_option(command, options->scenario);
  return command_of(std::move(command), options, run_ledger);
}

}  // namespace parallax::tools
