#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "harness/monitor/observation_reader.h"

namespace parallax::harness {

/// One line of a log: what happened, what was begun, and then what was seen.
struct LogEntry {
  double t = 0.0;  // [s]
  /// The events of one step of the model, printed without blanks; none: no step was made.
  std::optional<std::vector<std::string>> events;
  std::optional<bool> ok;  // what the step's action came to, if that is said
  std::string reason;
  std::optional<std::string> started;  // an action is under way
  bool has_state = false;
  ReportedValues values;

  /// Clears the entry for the next line, with `variables` values.
  void clear(std::size_t variables);
};

/// A fault in a line of a log.
struct LogError {
  std::size_t column = 1;  // of its first byte, from 1
  std::string text;        // "`t` is missing"
};

/// Names that a log has and the mapping does not ask for, for suggestions; a bounded number.
using ForeignNames = std::set<std::string, std::less<>>;
inline constexpr std::size_t kMaxForeignNames = 1000;

/// Stores a value. Returns its fault; empty: none. For a variable that the mapping does not ask
/// for, only the name is kept.
std::string take_value(const ObservationReader& reader, std::string_view name, Value value,
                       LogEntry& entry, ForeignNames& foreign);
/// Stores "ok" or "failed". Returns the fault of another word; empty: none.
std::string take_outcome(std::string_view word, LogEntry& entry);
/// The name of an event as the model prints it: without blanks.
std::string event_name(std::string_view text);
/// Names what the entry lacks after all of it was read; empty: nothing. `has_t`: there was a time.
std::string incomplete(const LogEntry& entry, bool has_t);

/// Reads `{"t": 1.5, "event": "Go(bTable)", "outcome": "ok"}` or `{"t": 1.6, "state": {..}}`.
std::optional<LogError> read_json_line(std::string_view line, const ObservationReader& reader,
                                       LogEntry& entry, ForeignNames& foreign);

/// Comma-separated values after RFC 4180, one record a line, with a header: t, event (several are
/// separated by semicolons), outcome, reason, started; other columns are variables. An empty cell
/// says nothing.
class CsvLog {
 public:
  std::optional<LogError> read_header(std::string_view line, const ObservationReader& reader,
                                      ForeignNames& foreign);
  std::optional<LogError> read_line(std::string_view line, const ObservationReader& reader,
                                    LogEntry& entry);

 private:
  struct Cell {
    std::string text;
    std::size_t column = 1;
    /// An empty cell says nothing, in quotes or not: CSV knows no difference.
    bool says_something() const { return !text.empty(); }
  };
  std::optional<LogError> split(std::string_view line);
  std::optional<LogError> take(const Cell& cell, const std::string& name,
                               std::optional<std::size_t> variable, const ObservationReader& reader,
                               LogEntry& entry, bool& has_t);

  std::vector<std::string> names_;
  std::vector<std::optional<std::size_t>>
      variables_;            // by column, where it is one that is asked for
  std::vector<Cell> cells_;  // of the line at hand
  ForeignNames unread_;
};

}  // namespace parallax::harness
