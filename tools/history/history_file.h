#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/base/diagnostic.h"

namespace parallax::tools {

/// Number of occurrences in a fixed number of simulations.
struct MeasuredRate {
  std::string of;  // "trace 1: any discrepancy", "trace 1: Place(r1): not BoxIn(r1)"
  std::int64_t count = 0, runs = 0;
  std::int64_t lost = 0;                               // may have shown it or not
  double lower = 0.0, upper = 1.0, confidence = 0.95;  // Clopper and Pearson 1934
  bool fixed = true;  // the number of runs; else it depends on them, and the bounds allow for it
};

struct HistoryCase {
  std::string outcome;  // "passed", "failed", "error", "not finished"
  std::string verdict;  // of a scenario's run; may be empty
  std::vector<MeasuredRate> rates;
  std::string files;  // a hash of all that the case read; empty: not known
  bool flaky = false;
  double wall_s = 0.0;
  /// What changed in the files since the line before, by value, where its texts were kept.
  std::vector<std::string> changes = {};
};

/// One suite, as a line of a history tells it.
struct HistoryLine {
  std::string revision;       // as the user or git calls it; may be empty
  std::string subject, date;  // of the commit, "2026-03-01"; may be empty
  // These identify the suite.
  std::vector<std::string> paths;
  std::string only;
  bool fast = false;
  // These tell how it was run.
  std::uint64_t seed = 1;
  std::string version, program;
  std::map<std::string, HistoryCase> cases;  // by name
  double wall_s = 0.0;

  bool is_same_suite(const HistoryLine& other) const;
  /// "scenarios --fast": for people.
  std::string suite_text() const;
};

/// A history as read, and the lines that could not be read.
struct History {
  std::vector<HistoryLine> lines;
  std::vector<std::size_t> numbers;     // of these lines in the file, from 1
  std::vector<std::size_t> unreadable;  // numbers of lines in another format
  bool half_written = false;            // the last one has no end
};

std::string encode(const HistoryLine& line);

/// Rates as a JSON array, and back; malformed rates are left out.
std::string encode_rates(const std::vector<MeasuredRate>& rates);
std::vector<MeasuredRate> decode_rates(std::string_view text);

/// Reads a history of suites. A line that is half written, or in another format, is skipped and
/// noted. Reports a file that is not empty and has no line of a history.
base::Result<History> read_history(const std::filesystem::path& path, base::DiagnosticSink& sink);

/// Appends one line, as one write under a lock, so that suites may do so at the same time. After a
/// half-written line it begins a new one. Makes the file if there is none; a link is not followed.
base::Status append_history(const std::filesystem::path& path, const HistoryLine& line,
                            base::DiagnosticSink& sink);

/// Problems of the file, a sentence each; empty if all of it was read.
std::vector<std::string> remarks_on(const History& history, const std::string& path);

/// The suites that a history has, in order of their first lines, each as indices of its lines.
std::vector<std::vector<std::size_t>> suites_of(const History& history);

}  // namespace parallax::tools
