#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/folder_lock.h"
#include "compiler/base/source_file.h"
#include "harness/campaign/journal_format.h"

namespace parallax::harness {

/// The folder of one run, claimed for as long as the object lives.
class RunFolder {
 public:
  /// Makes the folder if it is missing. Reports kFolderInUse when another process holds it,
  /// kRunFolderInUse when it has a journal and is not to be continued (`resume`), else
  /// kFileNotWritable.
  static base::Result<RunFolder> claim(const std::filesystem::path& path, bool resume,
                                       base::DiagnosticSink& sink);

  const std::filesystem::path& path() const { return lock_.path(); }

 private:
  explicit RunFolder(base::FolderLock lock) : lock_(std::move(lock)) {}

  base::FolderLock lock_;
};

inline constexpr std::string_view kJournalName = "journal.ndjson";

using SampleKey = std::tuple<std::int64_t, std::int64_t, DrawPhase>;  // trace, sample

/// A trace, and one of its initial states as TraceLine has it.
using StartKey = std::pair<std::int64_t, std::int64_t>;

/// A journal as it was read.
struct JournalText {
  /// None when the run was ended before its first line was complete.
  std::optional<JournalHeader> header;
  std::map<std::int64_t, TraceLine> traces;
  std::map<StartKey, TraceLine> starts;  // of traces, from their other initial states
  std::map<SampleKey, SampleRecord> samples;
  std::map<SampleKey, base::SourceRange> places;  // their lines, without the newline
  std::map<std::int64_t, base::SourceRange> trace_places;
  std::map<StartKey, base::SourceRange> start_places;
  base::FileId file;
  std::size_t complete_bytes = 0;  // up to the end of the last whole line

  /// The trace of a simulation, from its initial state, which is there.
  const TraceLine& line_of(const SampleRecord& record) const;
  /// Null where it is not.
  const TraceLine* find_line_of(const SampleRecord& record) const;
  const base::SourceRange& line_place_of(const SampleRecord& record) const;
};

/// Reads RUN_DIR/journal.ndjson. A last line without its newline is dropped with kJournalTruncated;
/// any other line that is not a journal line is kForeignJournalLine; no file: kNoJournal.
base::Result<JournalText> read_journal(const std::filesystem::path& run_dir,
                                       base::SourceFiles& files, base::DiagnosticSink& sink);

/// Returns the recorded part of the run in `folder`; empty where there is no record. Reports what
/// read_journal reports, and kJournalMismatch where `header` differs from the recorded one in
/// anything but the simulator, which need not be known yet.
base::Result<JournalText> read_for_continuation(const RunFolder& folder,
                                                const JournalHeader& header,
                                                base::SourceFiles& files,
                                                base::DiagnosticSink& sink);

/// The record of a run on disk: one line per finished simulation, synced before `append` returns.
/// `append` may be called from several threads, whose lines are then synced together.
class Journal {
 public:
  /// Starts a journal in `folder`, or continues the one that was `recorded` there. The losses at
  /// which it would end at once again (the last ones, and `max_lost_in_a_row` of them in a row) are
  /// dropped from it if the simulator of the header may repeat them. Reports kJournalMismatch and
  /// kFileNotWritable.
  static base::Result<std::unique_ptr<Journal>> open(RunFolder folder, const JournalHeader& header,
                                                     JournalText recorded,
                                                     std::int64_t max_lost_in_a_row,
                                                     const base::SourceFiles& files,
                                                     base::DiagnosticSink& sink);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The lines that were there when the journal was opened and are still to be used.
  const JournalText& recorded() const { return recorded_; }
  /// Returns null if the line was not there.
  const TraceLine* find(std::int64_t trace, std::int64_t start_state = 0) const;
  const SampleRecord* find(std::int64_t trace, std::int64_t sample, DrawPhase phase) const;

  /// Takes simulations of another journal for recorded ones, too, which are not written here.
  void know(const std::map<SampleKey, SampleRecord>& samples);

  void append(const TraceLine& trace);
  void append(const SampleRecord& record);
  /// The reason why a line could not be written; empty as long as all is well.
  std::string write_error() const;
  /// How often lines were synced so far.
  std::int64_t batches() const;

  /// Replaces the file by header, traces and `consumed`, sorted by trace, sample and phase. It then
  /// no longer shows the order in which simulations ended, nor those that ran ahead without being
  /// used.
  base::Status rewrite(const std::vector<TraceLine>& traces, std::vector<SampleRecord> consumed,
                       base::DiagnosticSink& sink);

 private:
  Journal(RunFolder folder, JournalHeader header, JournalText recorded);
  bool open_file(std::size_t keep_bytes);
  void write_line(const std::string& line);

  RunFolder folder_;
  std::filesystem::path path_;
  JournalHeader header_;
  JournalText recorded_;
  mutable std::mutex mutex_;  // guards what follows
  int fd_ = -1;
  std::string write_error_;
  std::condition_variable synced_;
  std::string waiting_;  // lines that are not written yet
  std::int64_t lines_given_ = 0, lines_synced_ = 0, batches_ = 0;
  bool is_writing_ = false;  // somebody is, without the lock
};

}  // namespace parallax::harness
