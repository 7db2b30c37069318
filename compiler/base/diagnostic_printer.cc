#include "compiler/base/diagnostic_printer.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>

#include "compiler/base/ascii.h"
#include "compiler/base/hash.h"
#include "compiler/base/json.h"
#include "compiler/base/utf8.h"

namespace parallax::base {
namespace {

constexpr std::size_t kExcerptColumns = 160;

/// Appends `text`, one column per code point, and returns nothing wider than the excerpt.
std::string excerpt(std::string_view line) {
  std::string out;
  std::size_t columns = 0;
  while (!line.empty() && columns < kExcerptColumns) {
    const auto point = front_code_point(line);
    if (!point.valid || steers_display(point.value)) {
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

using Json = nlohmann::ordered_json;

/// RFC 3986: characters that are neither unreserved nor a slash are percent-encoded.
std::string encoded(std::string_view path) {
  std::string out;
  for (const char c : path) {
    const bool plain =
        is_letter(c) || is_digit(c) || std::string_view("-._~/").find(c) != std::string_view::npos;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

std::string uri(const std::string& name) {
  namespace fs = std::filesystem;
  const fs::path path(name);
  if (!path.is_absolute()) return encoded(path.lexically_normal().generic_string());
  std::error_code error;
  const auto below = path.lexically_normal().lexically_relative(fs::current_path(error));
  const bool inside = !error && !below.empty() && *below.begin() != "..";
  return inside ? encoded(below.generic_string()) : "file://" + encoded(path.generic_string());
}

Json message(const std::string& text) { return Json{{"text", printable(text)}}; }

Json physical_location(const SourceRange& range, const SourceFiles& files) {
  const auto& file = files[range.file];
  const auto begin = file.position(range.begin);
  const auto end = file.position(range.end);
  Json region;
  region["startLine"] = begin.line;
  region["startColumn"] = begin.column;
  region["endLine"] = end.line;
  region["endColumn"] = end.column;  // one past the last
  return {{"artifactLocation", {{"uri", uri(file.name())}}}, {"region", std::move(region)}};
}

Json locations(const Diagnostic& d, const SourceFiles& files) {
  auto out = Json::array();
  if (d.range) {
    out.push_back({{"physicalLocation", physical_location(*d.range, files)}});
  } else if (!d.subject.empty()) {
    out.push_back({{"physicalLocation", {{"artifactLocation", {{"uri", uri(d.subject)}}}}}});
  }
  return out;
}

Json related_locations(const Diagnostic& d, const SourceFiles& files) {
  auto out = Json::array();
  for (const auto& note : d.notes) {
    Json location;
    location["id"] = out.size();
    if (note.range) location["physicalLocation"] = physical_location(*note.range, files);
    location["message"] = message(note.text);
    out.push_back(std::move(location));
  }
  return out;
}

/// Text that identifies a result even after its line has moved.
std::string identity(const Diagnostic& d, const SourceFiles& files) {
  std::string text = std::string(info(d.code).id) + '\n' + d.message + '\n';
  if (!d.range) return text + d.subject;
  const auto& file = files[d.range->file];
  text += uri(file.name());
  // Blanks are layout.
  for (const char c : file.line(file.position(d.range->begin).line)) {
    if (c != ' ' && c != '\t' && c != '\r') text += c;
  }
  return text;
}

Json rule(const DiagnosticInfo& code) {
  Json out;
  out["id"] = code.id;
  out["name"] = code.name.substr(1);  // without the k
  out["shortDescription"] = message(std::string(code.format));
  out["help"] = message(std::string(code.help));
  out["defaultConfiguration"] = {
      {"level", code.severity == Severity::kError ? "error" : "warning"}};
  return out;
}

/// The codes that occur, in the order of the registry, with their rules.
std::map<DiagnosticCode, std::size_t> collect_rules(const std::vector<Diagnostic>& diagnostics,
                                                    Json& rules) {
  std::map<DiagnosticCode, std::size_t> index;
  for (const auto& d : diagnostics) index.emplace(d.code, 0);
  for (auto& [code, position] : index) {
    position = rules.size();
    rules.push_back(rule(info(code)));
  }
  return index;
}

Json result(const Diagnostic& d, const SourceFiles& files, std::size_t rule_index) {
  Json out;
  out["ruleId"] = info(d.code).id;
  out["ruleIndex"] = rule_index;
  out["level"] = info(d.code).severity == Severity::kError ? "error" : "warning";
  out["message"] = message(d.fix.empty() ? d.message : d.message + "; " + d.fix);
  out["locations"] = locations(d, files);
  if (!d.notes.empty()) out["relatedLocations"] = related_locations(d, files);
  return out;
}

}  // namespace

std::string_view help_of(const Diagnostic& d) {
  return d.help.empty() ? info(d.code).help : std::string_view(d.help);
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
      const Diagnostic at{d.code, note.range, {}, {}, {}, {}, {}};
      out += fmt::format("{}: note: {}\n", location(at, files), printable(note.text));
    } else {
      out += fmt::format("note: {}\n", printable(note.text));
    }
  }
  if (!d.fix.empty()) {
    out += fmt::format("fix: {}\n", printable(d.fix));
  } else if (const auto help = help_of(d); style.help && !help.empty()) {
    out += fmt::format("help: {}\n", printable(help));
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
    if (const auto help = help_of(d); !help.empty()) entry["help"] = printable(help);
    out.push_back(std::move(entry));
  }
  return base::json_text(out);
}

std::string to_sarif(const std::vector<Diagnostic>& diagnostics, const SourceFiles& files,
                     std::string_view tool_version) {
  auto rules = Json::array();
  const auto index = collect_rules(diagnostics, rules);
  auto results = Json::array();
  std::map<std::uint64_t, int> seen;
  for (const auto& d : diagnostics) {
    auto entry = result(d, files, index.at(d.code));
    const auto hash = fnv1a64(identity(d, files));
    entry["partialFingerprints"] = {
        {"parallaxLine/v1", fmt::format("{:016x}:{}", hash, ++seen[hash])}};
    results.push_back(std::move(entry));
  }
  Json driver;
  driver["name"] = "parallax";
  driver["version"] = tool_version;
  driver["rules"] = std::move(rules);
  Json run;
  run["tool"] = {{"driver", std::move(driver)}};
  run["columnKind"] = "unicodeCodePoints";
  run["results"] = std::move(results);
  Json log;
  log["$schema"] = "https://json.schemastore.org/sarif-2.1.0.json";
  log["version"] = "2.1.0";
  log["runs"] = Json::array({std::move(run)});
  return base::json_text(log);
}

}  // namespace parallax::base
