#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "tools/cli/command.h"
#include "tools/cli/shared_options.h"
#include "tools/diff/kept_difference.h"
#include "tools/history/change_points.h"
#include "tools/page/gather.h"
#include "tools/page/history_page.h"
#include "tools/page/write_page.h"

namespace parallax::tools {
namespace {

struct ReportOptions {
  std::vector<std::string> folders, properties;
  std::string out, scenario, ledger, history;
  bool explain = false, repair = false, watch = false;
};

namespace fs = std::filesystem;

/// The place of the page: beside the run's other reports, or for a comparison in the current
/// folder.
std::string page_path(const ReportOptions& options) {
  if (!options.out.empty()) return options.out;
  if (options.folders.size() > 1) return "comparison.html";
  return (std::filesystem::path(options.folders.front()) / "report.html").string();
}

/// Has the run written its report since it recorded something? It does so last of all.
bool is_over(const std::string& folder) {
  std::error_code error;
  const auto report = fs::last_write_time(fs::path(folder) / "report.json", error);
  if (error) return false;
  const auto journal = fs::last_write_time(fs::path(folder) / harness::kJournalName, error);
  return error || journal <= report;
}

/// A folder with files of a run, or one that is held by a run which has recorded nothing yet.
bool is_run(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) return false;
  if (fs::exists(fs::path(folder) / harness::kJournalName, error)) return true;
  if (fs::exists(fs::path(folder) / "report.json", error)) return true;
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool is_held = ::flock(fd, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(fd);
  return is_held;
}

/// A page replaces an earlier page only: never one of its inputs or another file.
bool may_write(const std::string& path, base::DiagnosticSink& sink) {
  std::error_code error;
  if (!fs::is_regular_file(path, error) || fs::file_size(path, error) == 0) return true;
  std::ifstream file(path, std::ios::binary);
  std::string head(512, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (head.find(kPageMark) != std::string::npos) return true;
  sink.error_about(codes::kFileNotWritable, path,
                   "it is there already, and no page of this command; name another file");
  return false;
}

/// Rewrites the page again and again while the run goes on, and for the last time when it is over.
int watch(const ReportOptions& options, Invocation& invocation) {
  constexpr auto kPause = std::chrono::milliseconds(200);
  if (options.folders.size() > 1) {
    invocation.sink().error_about(codes::kUsage, "--watch",
                                  "one run is watched at a time; name one folder");
    return 0;
  }
  const auto& folder = options.folders.front();
  if (!is_run(folder)) {
    invocation.sink().error_about(codes::kNoJournal, folder);
    return 0;
  }
  const auto journal = fs::path(folder) / harness::kJournalName;
  std::uintmax_t seen = 0;
  while (!is_over(folder) && !invocation.stopped()) {
    std::error_code error;
    // Removed while it was watched: it will never be over.
    if (!fs::is_directory(folder, error)) {
      invocation.sink().error_about(codes::kNoJournal, folder);
      return 0;
    }
    const auto size = fs::file_size(journal, error);
    if (!error && size != seen) {
      seen = size;
      // A line that is still being written cannot be read yet: its errors are dropped.
      Context own(invocation.form(), invocation.stop());
      const auto page = gather_page({folder, options.scenario, false, false, {}, {}}, own);
      if (page && !base::write_output(page_path(options), run_page(*page, {2}), invocation.files(),
                                      invocation.sink(), base::TextForm::kMarkup)) {
        return 0;
      }
    }
    // Not more often than the page reloads itself.
    for (int i = 0; i < 10 && !is_over(folder) && !invocation.stopped(); ++i) {
      std::this_thread::sleep_for(kPause);
    }
  }
  return 0;
}

/// A history of suites as a page, and what changed as text.
int report_history(const ReportOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto path = options.out.empty() ? std::string("history.html") : options.out;
  if (!options.folders.empty() || options.explain || options.repair || options.watch ||
      !options.ledger.empty()) {
    sink.error_about(codes::kUsage, "--history",
                     "a page is about a history or about runs; leave the others out");
    return 0;
  }
  if (!may_write(path, sink)) return 0;
  const auto history = read_history(options.history, sink);
  if (!history) return 0;
  invocation.files().note_input(options.history);
  const auto remarks = remarks_on(*history, options.history);
  for (const auto& remark : remarks) invocation.remark(base::printable(remark));
  const auto page = history_page(*history, options.history, kHistoryConfidence);
  if (!base::write_output(path, page, invocation.files(), sink, base::TextForm::kMarkup)) return 0;
  std::string text;
  auto list = nlohmann::ordered_json::array();
  for (const auto& suite : suites_of(*history)) {
    const auto name = history->lines[suite.front()].suite_text();
    for (const auto& point : find_changes(*history, suite, kHistoryConfidence).points) {
      const auto& line = history->lines[suite[point.line]];
      text += base::printable(change_text(point, *history, suite)) + '\n';
      list.push_back({{"suite", name},
                      {"line", history->numbers[suite[point.line]]},
                      {"revision", line.revision},
                      {"case", point.name},
                      {"words", point.words}});
      if (point.kind == ChangePoint::Kind::kRate) list.back()["p_value"] = point.p_value;
    }
  }
  if (invocation.options().json) {
    const nlohmann::ordered_json document = {
        {"status", "ok"},       {"page", path},
        {"bytes", page.size()}, {"lines", history->lines.size()},
        {"changes", list},      {"missing", remarks}};
    invocation.document(base::json_text(document) + '\n');
  } else {
    invocation.result((text.empty() ? "nothing changed\n" : text) + base::printable(path) + '\n');
  }
  return 0;
}

int report(const ReportOptions& options, Invocation& invocation) {
  if (!options.history.empty()) return report_history(options, invocation);
  if (options.folders.empty()) {
    invocation.sink().error_about(codes::kUsage, "",
                                  "name the folders of runs, or a file with --history");
    return 0;
  }
  if (!options.ledger.empty() && options.folders.size() > 1) {
    invocation.sink().error_about(codes::kUsage, "--ledger",
                                  "one run is held against a ledger at a time; name one folder");
    return 0;
  }
  if (!may_write(page_path(options), invocation.sink())) return 0;
  if (options.watch) watch(options, invocation);
  if (invocation.sink().has_errors() || (options.watch && invocation.stopped())) return 0;
  std::vector<PageData> pages;
  for (const auto& folder : options.folders) {
    auto page = gather_page({folder, options.scenario, options.explain, options.repair,
                             options.ledger, options.properties},
                            invocation);
    if (!page) return 0;
    for (const auto& banner : page->banners) invocation.remark(folder + ": " + banner);
    for (const auto* name : {"report.json", "journal.ndjson"}) {
      invocation.files().note_input((std::filesystem::path(folder) / name).string());
    }
    pages.push_back(std::move(*page));
  }
  std::vector<std::string> changes;
  for (std::size_t i = 1; i < pages.size(); ++i) {
    const auto kept = compare_kept(options.folders.front(), options.folders[i], invocation);
    const auto refused = "the texts of the scenarios were not compared: " + kept.refused;
    if (kept.is_altered) invocation.remark(refused);
    changes.push_back(kept.difference ? kept_text(*kept.difference, false) : refused + '\n');
  }
  const auto text = pages.size() == 1 ? run_page(pages.front()) : comparison_page(pages, changes);
  const auto path = page_path(options);
  if (!base::write_output(path, text, invocation.files(), invocation.sink(),
                          base::TextForm::kMarkup)) {
    return 0;
  }
  if (invocation.options().json) {
    auto missing = nlohmann::ordered_json::array();
    for (const auto& page : pages) {
      for (const auto& banner : page.banners) missing.push_back(page.folder + ": " + banner);
    }
    const nlohmann::ordered_json document = {
        {"status", "ok"}, {"page", path}, {"bytes", text.size()}, {"missing", missing}};
    invocation.document(base::json_text(document) + '\n');
  } else {
    invocation.result(base::printable(path) + '\n');
  }
  return 0;
}

}  // namespace

Command report_command() {
  auto options = std::make_shared<ReportOptions>();
  OptionTable command("report",
                      "A page about a run, or about how several runs differ (one HTML file)");
  command.footer(
      "Examples:\n"
      "  parallax report out/plan2                         writes out/plan2/report.html\n"
      "  parallax report out/plan2 --explain --repair -o plan2.html\n"
      "  parallax report out/plan2 --watch                 while `parallax run` is at it\n"
      "  parallax report out/plan2 --ledger ledger.yaml --property \"!HoldsAt(Spilled(),time)\"\n"
      "  parallax report --history history.jsonl -o history.html\n"
      "  parallax report out/before out/after -o comparison.html\n"
      "The page needs no network and can be read without scripts. Nothing is simulated for it.\n"
      "Exit codes: 0 written; what could not be shown is told on the page and on standard error.");
  command.option("run_dirs", options->folders, "Folders of runs; of several, what differs")
      .folder();
  command
      .option("-o,--out", options->out,
              "The page; default report.html in the run folder, comparison.html of several")
      .file({"html"});
  command.heading("What is on the page");
  command
      .flag("--explain", options->explain,
            "Say which axioms contradict the first discrepancy, as `parallax explain` does")
      .details("Always done if an explanation lies in the folder.");
  command.flag("--repair", options->repair,
               "Propose changes of the model, as `parallax repair` does");
  command
      .option("--history", options->history,
              "No run: draw a history of suites (`suite --history`) and say what changed")
      .file();
  command
      .option("--ledger", options->ledger,
              "Say what this file of known discrepancies has of the run (docs/reference/suites.md)")
      .file({"yaml"});
  command
      .option(
          "--property", options->properties,
          "Say whether this formula holds in the scenario's model at all times; may be repeated")
      .details("Also says on which known discrepancies the answer rests.")
      .list(ListForm::kOneEachTime)
      .needs("--ledger");
  command.flag(
      "--watch", options->watch,
      "While the run goes on: write a page that loads itself again, until the run is over");
  add_recorded_scenario_option(command, options->scenario);
  return command_of(std::move(command), options, report);
}

}  // namespace parallax::tools
