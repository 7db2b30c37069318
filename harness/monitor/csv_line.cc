#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include "compiler/base/ascii.h"
#include "harness/monitor/log_entry.h"

namespace parallax::harness {
namespace {

template <typename Number>
std::optional<Number> whole_cell(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The cell as what the mapping asks for; none: it is something else.
std::optional<Value> value_of(const std::string& text, ObservationReader::Kind kind) {
  switch (kind) {
    case ObservationReader::Kind::kNumber:
      if (const auto number = whole_cell<double>(text)) return *number;
      return std::nullopt;
    case ObservationReader::Kind::kFlag:
      if (text == "true" || text == "1") return true;
      if (text == "false" || text == "0") return false;
      return std::nullopt;
    case ObservationReader::Kind::kText:
      return text;
  }
  return std::nullopt;
}

constexpr std::string_view kColumns[] = {"t", "event", "outcome", "reason", "started"};

bool is_key(std::string_view name) {
  return std::find(std::begin(kColumns), std::end(kColumns), name) != std::end(kColumns);
}

/// The key that a column of another spelling is meant to be: taken for somebody's own column, a
/// `Event` would leave out every event without a word.
std::optional<std::string_view> meant_key(std::string_view name) {
  std::string letters;
  for (const char c : name) {
    if (c != ' ' && c != '\t') letters += base::to_lower(c);
  }
  for (const auto key : kColumns) {
    if (letters == key && name != key) return key;
  }
  return std::nullopt;
}

}  // namespace

std::optional<LogError> CsvLog::split(std::string_view line) {
  cells_.clear();
  std::size_t i = 0;
  while (true) {
    auto& cell = cells_.emplace_back();
    cell.column = i + 1;
    if (i < line.size() && line[i] == '"') {
      for (++i;; ++i) {
        if (i >= line.size()) return LogError{cell.column, "a quoted cell does not end"};
        if (line[i] != '"') {
          cell.text += line[i];
        } else if (i + 1 < line.size() && line[i + 1] == '"') {
          cell.text += line[i++];
        } else {
          break;
        }
      }
      ++i;
      if (i < line.size() && line[i] != ',') {
        return LogError{i + 1, "something stands behind a quoted cell"};
      }
    } else {
      while (i < line.size() && line[i] != ',') cell.text += line[i++];
    }
    if (i >= line.size()) return std::nullopt;
    ++i;
  }
}

std::optional<LogError> CsvLog::read_header(std::string_view line, const ObservationReader& reader,
                                            ForeignNames& foreign) {
  if (auto error = split(line)) return error;
  bool has_t = false;
  for (const auto& cell : cells_) {
    for (const auto& name : names_) {
      if (name == cell.text) {
        return LogError{cell.column, fmt::format("the column `{}` is there twice", name)};
      }
    }
    names_.push_back(cell.text);
    variables_.push_back(is_key(cell.text) ? std::nullopt : reader.variable(cell.text));
    has_t = has_t || cell.text == "t";
    if (!variables_.back() && !is_key(cell.text) && foreign.size() < kMaxForeignNames) {
      foreign.insert(cell.text);
    }
  }
  for (const auto& cell : cells_) {
    const auto key = meant_key(cell.text);
    if (!key || std::find(names_.begin(), names_.end(), *key) != names_.end()) continue;
    return LogError{cell.column, fmt::format("write the column `{}` as `{}`", cell.text, *key)};
  }
  if (!has_t) {
    return LogError{
        1, "neither a JSON object nor a header of CSV with a column `t`, the time in seconds"};
  }
  return std::nullopt;
}

std::optional<LogError> CsvLog::take(const Cell& cell, const std::string& name,
                                     std::optional<std::size_t> variable,
                                     const ObservationReader& reader, LogEntry& entry,
                                     bool& has_t) {
  const auto fine = [&](std::string problem) -> std::optional<LogError> {
    if (problem.empty()) return std::nullopt;
    return LogError{cell.column, std::move(problem)};
  };
  if (variable) {
    auto value = value_of(cell.text, reader.kind(*variable));
    // A value of another kind is refused with the name of its variable.
    return fine(
        take_value(reader, name, value ? *std::move(value) : Value(cell.text), entry, unread_));
  }
  if (name == "t") {
    const auto t = whole_cell<double>(cell.text);
    if (!t || !std::isfinite(*t)) {
      return fine(fmt::format("`{}` is no time in seconds", cell.text));
    }
    entry.t = *t;
    has_t = true;
  } else if (name == "event") {
    entry.events.emplace();
    std::size_t begin = 0;
    while (begin <= cell.text.size() && !cell.text.empty()) {
      const auto end = std::min(cell.text.find(';', begin), cell.text.size());
      entry.events->push_back(event_name(cell.text.substr(begin, end - begin)));
      begin = end + 1;
    }
  } else if (name == "started") {
    entry.started = event_name(cell.text);
  } else if (name == "outcome") {
    return fine(take_outcome(cell.text, entry));
  } else if (name == "reason") {
    entry.reason = cell.text;
  } else {
    entry.has_state = true;
  }
  return std::nullopt;
}

std::optional<LogError> CsvLog::read_line(std::string_view line, const ObservationReader& reader,
                                          LogEntry& entry) {
  entry.clear(reader.variables().size());
  if (auto error = split(line)) return error;
  if (cells_.size() != names_.size()) {
    return LogError{
        1, fmt::format("it has {} cells, and the header {}", cells_.size(), names_.size())};
  }
  bool has_t = false;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (!cells_[i].says_something()) continue;
    if (auto error = take(cells_[i], names_[i], variables_[i], reader, entry, has_t)) return error;
  }
  auto problem = incomplete(entry, has_t);
  if (!problem.empty()) return LogError{1, std::move(problem)};
  return std::nullopt;
}

}  // namespace parallax::harness
