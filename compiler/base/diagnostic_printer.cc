#include "compiler/base/diagnostic_printer.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compiler/base/utf8.h"

namespace parallax::base {
namespace {

constexpr std::size_t kExcerptColumns = 160;

bool is_bidirectional_control(char32_t c) {
  return (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069) || c == 0x200E ||
         c == 0x200F || c == 0x061C || c == 0xFEFF;
}

/// Appends `text`, one column per code point, and returns nothing wider than the excerpt.
std::string excerpt(std::string_view line) {
  std::string out;
  std::size_t columns = 0;
  while (!line.empty() && columns < kExcerptColumns) {
    const auto point = front_code_point(line);
    if (!point.valid || point.value < 0x20 || point.value == 0x7F ||
        is_bidirectional_control(point.value)) {
      out += point.valid && point.value == '\t' ? ' ' : '?';
    } else {
      out.append(line.substr(0, point.length));
    }
    line.remove_prefix(point.valid ? point.length : 1);
    ++columns;
  }
  if (!line.empty()) out += " ...";
  return out;
}

std::string location(const Diagnostic& d, const SourceFiles& files) {
  if (!d.range) return d.subject.empty() ? std::string("parallax") : printable(d.subject);
  const auto& file = files[d.range->file];
  const auto name = printable(file.name());
  const auto begin = file.position(d.range->begin);
  const auto end = file.position(d.range->end);
  if (end.line == begin.line && end.column > begin.column + 1) {
    return fmt::format("{}:{}:{}-{}", name, begin.line, begin.column, end.column - 1);
  }
  if (end.line > begin.line) {
    return fmt::format("{}:{}:{}-{}:{}", name, begin.line, begin.column, end.line,
                       end.column > 1 ? end.column - 1 : 1);
  }
  return fmt::format("{}:{}:{}", name, begin.line, begin.column);
}

std::string source_excerpt(const SourceRange& range, const SourceFiles& files) {
  const auto& file = files[range.file];
  const auto begin = file.position(range.begin);
  if (begin.column > kExcerptColumns) return {};
  const auto line = file.line(begin.line);
  const auto end = file.position(range.end);
  const std::uint32_t last =
      end.line == begin.line ? std::max(end.column, begin.column + 1) : begin.column + 1;
  const auto number = fmt::format("{:>5}", begin.line);
  std::string out = fmt::format("{} | {}\n", number, excerpt(line));
  out += std::string(number.size(), ' ') + " | " + std::string(begin.column - 1, ' ') + '^';
  const auto limit = std::min<std::size_t>(last, kExcerptColumns + 1);
  if (limit > begin.column + 1) out += std::string(limit - begin.column - 1, '~');
  return out + '\n';
}

nlohmann::ordered_json place_json(const std::optional<SourceRange>& range,
                                  const std::string& subject, const SourceFiles& files) {
  nlohmann::ordered_json out;
  if (!range) {
    if (!subject.empty()) out["path"] = printable(subject);
    return out;
  }
  const auto& file = files[range->file];
  const auto begin = file.position(range->begin);
  const auto end = file.position(range->end);
  out["path"] = printable(file.name());
  out["line"] = begin.line;
  out["column"] = begin.column;
  out["end_line"] = end.line;
  out["end_column"] = end.column;
  return out;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const auto point = front_code_point(text);
    if (!point.valid) {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
    } else if (point.value < 0x20 || point.value == 0x7F || is_bidirectional_control(point.value)) {
      out += fmt::format("\\u{:04x}", static_cast<std::uint32_t>(point.value));
    } else {
      out.append(text.substr(0, point.length));
    }
    text.remove_prefix(point.valid ? point.length : 1);
  }
  return out;
}

std::string to_text(const Diagnostic& d, const SourceFiles& files, const DiagnosticStyle& style) {
  const auto& code = info(d.code);
  const bool is_error = code.severity == Severity::kError;
  const char* paint = !style.color ? "" : is_error ? "\x1b[1;31m" : "\x1b[1;33m";
  const char* plain = style.color ? "\x1b[0m" : "";
  std::string out =
      fmt::format("{}: {}{}[{}]{}: {}\n", location(d, files), paint, is_error ? "error" : "warning",
                  code.id, plain, printable(d.message));
  if (d.range) out += source_excerpt(*d.range, files);
  for (const auto& note : d.notes) {
    if (note.range) {
      const Diagnostic at{d.code, note.range, {}, {}, {}, {}};
      out += fmt::format("{}: note: {}\n", location(at, files), printable(note.text));
    } else {
      out += fmt::format("note: {}\n", printable(note.text));
    }
  }
  if (!d.fix.empty()) {
    out += fmt::format("fix: {}\n", printable(d.fix));
  } else if (!d.range && !code.help.empty()) {
    // No source line shows what is meant, so say what to do.
    out += fmt::format("help: {}\n", code.help);
  }
  return out;
}

std::string to_json(const std::vector<Diagnostic>& diagnostics, const SourceFiles& files) {
  auto out = nlohmann::ordered_json::array();
  for (const auto& d : diagnostics) {
    auto entry = place_json(d.range, d.subject, files);
    const auto& code = info(d.code);
    entry["severity"] = code.severity == Severity::kError ? "error" : "warning";
    entry["code"] = code.id;
    entry["message"] = printable(d.message);
    auto notes = nlohmann::ordered_json::array();
    for (const auto& note : d.notes) {
      auto item = place_json(note.range, {}, files);
      item["message"] = printable(note.text);
      notes.push_back(std::move(item));
    }
    entry["notes"] = std::move(notes);
    if (!d.fix.empty()) entry["fix"] = printable(d.fix);
    out.push_back(std::move(entry));
  }
  return out.dump();
}

}  // namespace parallax::base
