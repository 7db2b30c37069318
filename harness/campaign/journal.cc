#include "harness/campaign/journal.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/contract.h"
#include "compiler/base/file_io.h"
#include "harness/campaign/sample_runner.h"

namespace parallax::harness {

using base::SourceRange;

namespace {

constexpr std::size_t kMaxJournalBytes = std::size_t{1} << 30U;

/// Takes the lines apart; reports the first foreign one only, as the rest is then no better.
class JournalReader {
 public:
  JournalReader(base::FileId file, const base::SourceFiles& files, base::DiagnosticSink& sink)
      : text_(files[file].text()), sink_(sink) {
    journal_.file = file;
  }

  base::Result<JournalText> read() {
    for (std::size_t begin = 0; begin < text_.size();) {
      const auto end = text_.find('\n', begin);
      if (end == std::string_view::npos) {
        sink_.warning(codes::kJournalTruncated, range(begin, text_.size()));
        break;
      }
      line_ = range(begin, end);
      if (auto why = take(text_.substr(begin, end - begin))) {
        return sink_.error(codes::kForeignJournalLine, line_, *why);
      }
      begin = end + 1;
      journal_.complete_bytes = begin;
    }
    return std::move(journal_);
  }

 private:
  SourceRange range(std::size_t begin, std::size_t end) const {
    return {journal_.file, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
  }

  /// Reads a line. Returns the fault of the line, or nothing if it is good.
  std::optional<std::string> take(std::string_view line) {
    if (!journal_.header) {
      auto decoded = decode_header(line);
      if (const auto* foreign = std::get_if<ForeignLine>(&decoded)) return foreign->why;
      journal_.header = std::get<JournalHeader>(std::move(decoded));
      return std::nullopt;
    }
    auto decoded = decode_line(line, symbols_);
    if (const auto* foreign = std::get_if<ForeignLine>(&decoded)) return foreign->why;
    if (auto* trace = std::get_if<TraceLine>(&decoded)) {
      const auto number = trace->trace->number;
      if (trace->start_state > 0) return take_start(*std::move(trace));
      const bool fresh = journal_.traces.emplace(number, std::move(*trace)).second;
      if (!fresh) return "trace " + std::to_string(number) + " stands there twice";
      journal_.trace_places.emplace(number, line_);
      return std::nullopt;
    }
    return take_record(std::get<SampleRecord>(std::move(decoded)));
  }

  /// The same trace from another of its initial states.
  std::optional<std::string> take_start(TraceLine line) {
    const auto first = journal_.traces.find(line.trace->number);
    if (first == journal_.traces.end()) return "its trace was not announced before it";
    if (first->second.trace->key != line.trace->key) return "its key is not that of its trace";
    const StartKey key(line.trace->number, line.start_state);
    if (!journal_.starts.emplace(key, std::move(line)).second) {
      return "this initial state of the trace stands there twice";
    }
    journal_.start_places.emplace(key, line_);
    return std::nullopt;
  }

  std::optional<std::string> take_record(SampleRecord record) {
    const auto trace = journal_.traces.find(record.trace);
    const auto& asked = journal_.header->asked;
    // Random sequences of events are simulated as traces are, whatever the scenario says.
    const bool is_executed = asked.execution == Execution::kClosedLoop && !asked.random_sequences;
    if (record.path.has_value() != is_executed) {
      return is_executed ? "`path` is missing, and the run executed a plan"
                         : "it has a `path`, and the run executed no plan";
    }
    if (trace == journal_.traces.end() && !record.path) {
      return "its trace was not announced before it";
    }
    if (record.start_state > 1 && !journal_.starts.contains({record.trace, record.start_state})) {
      return "its initial state was not announced before it";
    }
    const auto events = record.path ? record.path->steps.size() : trace->second.calls.size();
    const bool whole = record.observations.size() == events + 1 && record.outcomes.size() == events;
    if (record.status == SampleStatus::kOk && !whole) {
      return "it has not one observation for every timepoint of its trace";
    }
    if (record.status == SampleStatus::kOk && record.digest != digest_of(record)) {
      return "its digest is not that of its last observation";
    }
    const SampleKey key(record.trace, record.sample, record.phase);
    if (record.phase == DrawPhase::kConfirm) {
      const auto first = journal_.samples.find({record.trace, record.sample, DrawPhase::kCertify});
      if (first == journal_.samples.end()) return "it repeats a simulation that is not there";
      if (auto why = wrong_repetition(record, first->second)) return why;
      // The digest is one of all that happened, if the simulator keeps its promise.
      const bool same = journal_.header->simulator.determinism == "bitwise" &&
                        !record.digest.empty() && record.digest == first->second.digest;
      if (same && first_difference(first->second, record)) {
        return "it differs from the simulation that it repeats, but for the digest";
      }
    }
    // One that ran ahead may have been made anew from another initial state.
    const auto before = journal_.samples.find(key);
    const bool anew = before != journal_.samples.end() &&
                      (record.visit || (record.start_state > 0 && before->second.start_state > 0));
    if (before != journal_.samples.end() && !anew) return "this simulation stands there twice";
    journal_.samples.insert_or_assign(key, std::move(record));
    journal_.places.insert_or_assign(key, line_);
    return std::nullopt;
  }

  /// A repetition is the same actions from the same start: only what came of them may differ.
  static std::optional<std::string> wrong_repetition(const SampleRecord& again,
                                                     const SampleRecord& first) {
    if (first.status != SampleStatus::kOk) return "it repeats a simulation that was lost";
    if (again.initial != first.initial || again.seed != first.seed) {
      return "it repeats a simulation with another start or seed";
    }
    if (again.start_state != first.start_state) {
      return "it repeats a simulation from another initial state";
    }
    if (again.attempt != first.attempt || again.rejected != first.rejected ||
        again.redrawn != first.redrawn) {
      return "it repeats a simulation with other counts of what was drawn";
    }
    if (again.path != first.path) return "it repeats a simulation with another path";
    return std::nullopt;
  }

  std::string_view text_;
  base::DiagnosticSink& sink_;
  SourceRange line_;  // the one that is read
  std::shared_ptr<compiler::SymbolTable> symbols_ = std::make_shared<compiler::SymbolTable>();
  JournalText journal_;
};

/// A range for a field of the header line: the whole line, as that is what was compared.
SourceRange header_line(const JournalText& journal, const base::SourceFiles& files) {
  const auto end = files[journal.file].text().find('\n');
  return {journal.file, 0, static_cast<std::uint32_t>(end)};
}

base::Status check_header(const JournalText& recorded, const JournalHeader& header,
                          const base::SourceFiles& files, base::DiagnosticSink& sink) {
  if (!recorded.header) return base::Unit{};
  const auto differs = header_difference(*recorded.header, header);
  if (!differs) return base::Unit{};
  return sink.error(codes::kJournalMismatch, header_line(recorded, files), differs->field,
                    differs->recorded, differs->now);
}

/// The lost simulations at which a continued run would end again at once: those that stand last,
/// and as many in a row as end a run, where others that ran ahead stand behind them.
std::vector<SampleKey> losses_to_repeat(const JournalText& journal, std::int64_t max_in_a_row) {
  std::vector<SampleKey> out, row;
  const auto end_row = [&](bool is_last) {
    if (is_last || std::ssize(row) >= max_in_a_row) out.insert(out.end(), row.begin(), row.end());
    row.clear();
  };
  for (const auto& [key, record] : journal.samples) {
    if (record.phase == DrawPhase::kConfirm) continue;
    if (record.status == SampleStatus::kLost) {
      row.push_back(key);
    } else {
      end_row(false);
    }
  }
  end_row(true);
  return out;
}

/// Removes records from the journal text, and returns the text of the remaining lines.
std::string without(const std::vector<SampleKey>& keys, JournalText& journal,
                    const base::SourceFiles& files) {
  std::vector<SourceRange> lines;
  for (const auto& key : keys) {
    lines.push_back(journal.places.at(key));
    journal.places.erase(key);
    journal.samples.erase(key);
  }
  std::sort(lines.begin(), lines.end(),
            [](const SourceRange& a, const SourceRange& b) { return a.begin < b.begin; });
  const auto text = files[journal.file].text().substr(0, journal.complete_bytes);
  std::string out;
  std::size_t begin = 0;
  for (const auto& line : lines) {
    out += text.substr(begin, line.begin - begin);
    begin = line.end + 1;  // with its newline
  }
  return out += text.substr(begin);
}

}  // namespace

base::Result<RunFolder> RunFolder::claim(const std::filesystem::path& path, bool resume,
                                         base::DiagnosticSink& sink) {
  auto lock = base::FolderLock::claim(path, sink);
  if (!lock) return sink.already_reported();
  RunFolder folder(*std::move(lock));
  std::error_code error;
  const auto taken = [&](const char* name) {
    return std::filesystem::exists(std::filesystem::symlink_status(path / name, error));
  };
  const bool has_run = taken(kJournalName.data());
  if (!resume && has_run) {
    return sink.error_about(codes::kRunFolderInUse, path.string());
  }
  // The journal comes first: without it these belong to somebody else.
  for (const auto* name : {"report.txt", "report.json", "recordings"}) {
    if (has_run || !taken(name)) continue;
    return sink.error_about(codes::kFileNotWritable, (path / name).string(),
                            "it is there already, and no run to which it belongs");
  }
  return folder;
}

base::Result<JournalText> read_journal(const std::filesystem::path& run_dir,
                                       base::SourceFiles& files, base::DiagnosticSink& sink) {
  const auto path = run_dir / kJournalName;
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return sink.error_about(codes::kNoJournal, run_dir.string());
  }
  auto text = base::read_file_of(run_dir, kJournalName, sink, kMaxJournalBytes);
  if (!text) return sink.already_reported();
  files.note_input(path.string());
  const auto file = files.add(path.string(), std::move(*text));
  return JournalReader(file, files, sink).read();
}

Journal::Journal(RunFolder folder, JournalHeader header, JournalText recorded)
    : folder_(std::move(folder)),
      path_(folder_.path() / kJournalName),
      header_(std::move(header)),
      recorded_(std::move(recorded)) {}

Journal::~Journal() {
  if (fd_ >= 0) ::close(fd_);
}

bool Journal::open_file(std::size_t keep_bytes) {
  fd_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
  return fd_ >= 0 && ::ftruncate(fd_, static_cast<off_t>(keep_bytes)) == 0 &&
         ::lseek(fd_, 0, SEEK_END) >= 0;
}

base::Result<JournalText> read_for_continuation(const RunFolder& folder,
                                                const JournalHeader& header,
                                                base::SourceFiles& files,
                                                base::DiagnosticSink& sink) {
  std::error_code error;
  if (!std::filesystem::exists(folder.path() / kJournalName, error)) return JournalText();
  auto recorded = read_journal(folder.path(), files, sink);
  if (!recorded) return sink.already_reported();
  auto expected = header;
  if (recorded->header) expected.simulator = recorded->header->simulator;
  if (!check_header(*recorded, expected, files, sink)) return sink.already_reported();
  return recorded;
}

base::Result<std::unique_ptr<Journal>> Journal::open(RunFolder folder, const JournalHeader& header,
                                                     JournalText recorded,
                                                     std::int64_t max_lost_in_a_row,
                                                     const base::SourceFiles& files,
                                                     base::DiagnosticSink& sink) {
  const auto path = folder.path() / kJournalName;
  if (!check_header(recorded, header, files, sink)) return sink.already_reported();
  std::vector<SampleKey> lost;
  if (may_repeat_losses(header.simulator)) lost = losses_to_repeat(recorded, max_lost_in_a_row);
  if (!lost.empty()) {
    // They will be simulated again, and no simulation may stand there twice.
    const auto kept = without(lost, recorded, files);
    recorded.complete_bytes = kept.size();
    if (!base::write_file_atomically(path, kept, sink)) return sink.already_reported();
  }
  const bool fresh = !recorded.header;
  const auto keep_bytes = recorded.complete_bytes;
  std::unique_ptr<Journal> journal(new Journal(std::move(folder), header, std::move(recorded)));
  if (!journal->open_file(keep_bytes)) {
    return sink.error_about(codes::kFileNotWritable, path.string(), std::strerror(errno));
  }
  if (fresh) journal->write_line(encode(header));
  return journal;
}

const TraceLine* JournalText::find_line_of(const SampleRecord& record) const {
  if (record.start_state > 1) {
    const auto found = starts.find({record.trace, record.start_state});
    return found == starts.end() ? nullptr : &found->second;
  }
  const auto found = traces.find(record.trace);
  return found == traces.end() ? nullptr : &found->second;
}

const TraceLine& JournalText::line_of(const SampleRecord& record) const {
  const auto* line = find_line_of(record);
  PARALLAX_REQUIRE(line != nullptr, "the reader holds each simulation against its trace");
  return *line;
}

const SourceRange& JournalText::line_place_of(const SampleRecord& record) const {
  if (record.start_state > 1) return start_places.at({record.trace, record.start_state});
  return trace_places.at(record.trace);
}

const TraceLine* Journal::find(std::int64_t trace, std::int64_t start_state) const {
  if (start_state > 1) {
    const auto found = recorded_.starts.find({trace, start_state});
    return found == recorded_.starts.end() ? nullptr : &found->second;
  }
  const auto found = recorded_.traces.find(trace);
  return found == recorded_.traces.end() ? nullptr : &found->second;
}

const SampleRecord* Journal::find(std::int64_t trace, std::int64_t sample, DrawPhase phase) const {
  const auto found = recorded_.samples.find({trace, sample, phase});
  return found == recorded_.samples.end() ? nullptr : &found->second;
}

void Journal::know(const std::map<SampleKey, SampleRecord>& samples) {
  for (const auto& [key, record] : samples) recorded_.samples.insert_or_assign(key, record);
}

// To sync takes milliseconds, and hundreds of workers may have a line at the same time. One of them
// writes and syncs all lines that wait, while the others come together for the next batch. Nobody
// goes on before the own line is on disk. A kill leaves whole lines and at most one that is cut
// short, the last: all lines of a batch are one write.
void Journal::write_line(const std::string& line) {
  std::unique_lock lock(mutex_);
  waiting_ += line + '\n';
  const auto mine = ++lines_given_;
  while (lines_synced_ < mine && write_error_.empty()) {
    if (is_writing_) {
      synced_.wait(lock);
      continue;
    }
    is_writing_ = true;
    const auto batch = std::exchange(waiting_, {});
    const auto last = lines_given_;
    lock.unlock();
    const bool is_on_disk = base::write_all(fd_, batch) && ::fdatasync(fd_) == 0;
    const int error = errno;
    lock.lock();
    is_writing_ = false;
    if (is_on_disk) {
      lines_synced_ = last;
      ++batches_;
    } else {
      write_error_ = std::strerror(error);
    }
    synced_.notify_all();
  }
}

std::int64_t Journal::batches() const {
  const std::lock_guard lock(mutex_);
  return batches_;
}

void Journal::append(const TraceLine& trace) { write_line(encode(trace)); }
void Journal::append(const SampleRecord& record) { write_line(encode(record)); }

std::string Journal::write_error() const {
  const std::lock_guard lock(mutex_);
  return write_error_;
}

base::Status Journal::rewrite(const std::vector<TraceLine>& traces,
                              std::vector<SampleRecord> consumed, base::DiagnosticSink& sink) {
  std::sort(consumed.begin(), consumed.end(), [](const SampleRecord& a, const SampleRecord& b) {
    return std::tuple(a.trace, a.sample, a.phase) < std::tuple(b.trace, b.sample, b.phase);
  });
  std::string text = encode(header_) + '\n';
  auto record = consumed.begin();
  for (std::size_t i = 0; i < traces.size(); ++i) {
    text += encode(traces[i]) + '\n';
    const auto number = traces[i].trace->number;
    // Its other initial states come before its simulations.
    if (i + 1 < traces.size() && traces[i + 1].trace->number == number) continue;
    for (; record != consumed.end() && record->trace == number; ++record) {
      text += encode(*record) + '\n';
    }
  }
  // Executions of a plan have no trace.
  for (; record != consumed.end(); ++record) text += encode(*record) + '\n';
  return base::write_file_atomically(path_, text, sink);
}

}  // namespace parallax::harness
