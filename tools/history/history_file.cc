#include "tools/history/history_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "compiler/base/codes/files.h"
#include "compiler/base/descriptor.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/words.h"

namespace parallax::tools {
namespace {

using Json = nlohmann::json;
using nlohmann::ordered_json;

constexpr std::int64_t kFormat = 1;
constexpr std::size_t kMaxHistoryBytes = std::size_t{256} << 20U;

template <typename T>
void take(const Json& object, const char* name, T& into) {
  const auto* member = base::json_member(object, name);
  if (member == nullptr) return;
  if (auto value = base::json_as<T>(*member)) into = *std::move(value);
}

ordered_json rate_json(const MeasuredRate& rate) {
  ordered_json out = {{"of", rate.of},       {"count", rate.count},
                      {"runs", rate.runs},   {"lower", rate.lower},
                      {"upper", rate.upper}, {"confidence", rate.confidence}};
  if (rate.lost > 0) out["lost"] = rate.lost;
  if (!rate.fixed) out["fixed"] = false;
  return out;
}

/// None if the counts are malformed.
std::optional<MeasuredRate> rate_of(const Json& object) {
  constexpr std::int64_t kMostRuns = 1'000'000'000;
  MeasuredRate out;
  take(object, "of", out.of);
  take(object, "count", out.count);
  take(object, "runs", out.runs);
  take(object, "lost", out.lost);
  take(object, "fixed", out.fixed);
  take(object, "lower", out.lower);
  take(object, "upper", out.upper);
  take(object, "confidence", out.confidence);
  const bool counts = out.count >= 0 && out.lost >= 0 && out.runs > 0 && out.runs <= kMostRuns &&
                      out.count <= out.runs && out.lost <= out.runs;
  const bool bounds = out.lower >= 0.0 && out.lower <= out.upper && out.upper <= 1.0;
  if (!counts || !bounds || out.of.empty()) return std::nullopt;
  return out;
}

std::vector<MeasuredRate> rates_of(const Json& list) {
  std::vector<MeasuredRate> out;
  for (const auto& one : list.is_array() ? list : Json::array()) {
    if (auto rate = rate_of(one)) out.push_back(*std::move(rate));
  }
  return out;
}

std::vector<std::string> texts_of(const Json& list) {
  constexpr std::size_t kMostTexts = 1000;
  std::vector<std::string> out;
  for (const auto& one : list.is_array() ? list : Json::array()) {
    if (one.is_string() && out.size() < kMostTexts) out.push_back(one.get<std::string>());
  }
  return out;
}

double wall_of(const Json& object) {
  double wall_s = 0.0;
  if (const auto* timing = base::json_member(object, "timing")) take(*timing, "wall_s", wall_s);
  return wall_s;
}

HistoryCase case_of(const Json& object) {
  HistoryCase out;
  take(object, "outcome", out.outcome);
  take(object, "verdict", out.verdict);
  take(object, "files", out.files);
  take(object, "flaky", out.flaky);
  if (const auto* changes = base::json_member(object, "changes")) out.changes = texts_of(*changes);
  out.wall_s = wall_of(object);
  if (const auto* rates = base::json_member(object, "rates")) out.rates = rates_of(*rates);
  return out;
}

std::optional<HistoryLine> decode(std::string_view text) {
  const auto object = base::parse_json(text);
  std::int64_t format = 0;
  take(object, "history", format);
  const auto* cases = base::json_member(object, "cases");
  if (format != kFormat || cases == nullptr || !cases->is_object()) return std::nullopt;
  HistoryLine out;
  take(object, "revision", out.revision);
  take(object, "subject", out.subject);
  take(object, "date", out.date);
  take(object, "only", out.only);
  take(object, "fast", out.fast);
  take(object, "seed", out.seed);
  take(object, "tool_version", out.version);
  take(object, "program", out.program);
  out.wall_s = wall_of(object);
  if (const auto* paths = base::json_member(object, "paths")) out.paths = texts_of(*paths);
  for (const auto& [name, value] : cases->items()) out.cases.emplace(name, case_of(value));
  return out;
}

base::Reported cannot_write(const std::filesystem::path& path, base::DiagnosticSink& sink) {
  return sink.error_about(codes::kFileNotWritable, path.string(), std::strerror(errno));
}

/// Does the file end in the middle of a line?
bool ends_inside(int fd) {
  const auto end = ::lseek(fd, 0, SEEK_END);
  char last = '\n';
  return end > 0 && ::pread(fd, &last, 1, end - 1) == 1 && last != '\n';
}

std::string listed(const std::vector<std::size_t>& numbers) {
  constexpr std::size_t kMost = 5;
  std::string out;
  for (std::size_t i = 0; i < numbers.size() && i < kMost; ++i) {
    out += fmt::format("{}{}", i > 0 ? ", " : "", numbers[i]);
  }
  return numbers.size() > kMost ? out + fmt::format(" and {} more", numbers.size() - kMost) : out;
}

}  // namespace

bool HistoryLine::is_same_suite(const HistoryLine& other) const {
  return paths == other.paths && only == other.only && fast == other.fast;
}

std::string HistoryLine::suite_text() const {
  std::string out;
  for (const auto& path : paths) out += (out.empty() ? "" : " ") + path;
  if (fast) out += " --fast";
  if (!only.empty()) out += " --only " + only;
  return out;
}

std::string encode_rates(const std::vector<MeasuredRate>& rates) {
  auto out = ordered_json::array();
  for (const auto& rate : rates) out.push_back(rate_json(rate));
  return base::json_text(out);
}

std::vector<MeasuredRate> decode_rates(std::string_view text) {
  return rates_of(base::parse_json(text));
}

std::string encode(const HistoryLine& line) {
  ordered_json out = {{"history", kFormat}, {"revision", line.revision}};
  if (!line.subject.empty()) out["subject"] = line.subject;
  if (!line.date.empty()) out["date"] = line.date;
  out.update({{"paths", line.paths},
              {"only", line.only},
              {"fast", line.fast},
              {"seed", line.seed},
              {"tool_version", line.version},
              {"program", line.program}});
  auto cases = ordered_json::object();
  for (const auto& [name, one] : line.cases) {
    auto& item = cases[name];
    item["outcome"] = one.outcome;
    if (!one.verdict.empty()) item["verdict"] = one.verdict;
    for (const auto& rate : one.rates) item["rates"].push_back(rate_json(rate));
    if (!one.files.empty()) item["files"] = one.files;
    if (!one.changes.empty()) item["changes"] = one.changes;
    if (one.flaky) item["flaky"] = true;
    item["timing"] = {{"wall_s", one.wall_s}};
  }
  out["cases"] = std::move(cases);
  out["timing"] = {{"wall_s", line.wall_s}};
  return base::json_text(out);
}

base::Result<History> read_history(const std::filesystem::path& path, base::DiagnosticSink& sink) {
  const auto text = base::read_file(path, sink, kMaxHistoryBytes);
  if (!text) return sink.already_reported();
  History out;
  std::size_t number = 0;
  for (std::size_t at = 0; at < text->size();) {
    const auto newline = text->find('\n', at);
    const auto end = std::min(newline, text->size());
    const auto line = std::string_view(*text).substr(at, end - at);
    ++number;
    at = end + 1;
    // A line without its end may be readable and wrong: a prefix of a number is a number.
    if (newline == std::string::npos) {
      out.half_written = true;
    } else if (auto read = decode(line)) {
      out.lines.push_back(*std::move(read));
      out.numbers.push_back(number);
    } else if (!line.empty()) {
      out.unreadable.push_back(number);
    }
  }
  constexpr std::string_view kHead = "{\"history\":";
  const bool is_begun = out.half_written && text->starts_with(kHead);
  if (out.lines.empty() && (!out.unreadable.empty() || (out.half_written && !is_begun))) {
    return sink.error_about(codes::kUsage, path.string(),
                            "this file is there already and is no history of suites");
  }
  return out;
}

base::Status append_history(const std::filesystem::path& path, const HistoryLine& line,
                            base::DiagnosticSink& sink) {
  const base::Descriptor fd(
      ::open(path.c_str(), O_RDWR | O_APPEND | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644));
  if (fd.get() < 0 || ::flock(fd.get(), LOCK_EX) != 0) return cannot_write(path, sink);
  auto text = encode(line) + '\n';
  if (ends_inside(fd.get())) text.insert(0, "\n");
  if (!base::write_all(fd.get(), text) || ::fsync(fd.get()) != 0) return cannot_write(path, sink);
  return base::Unit{};
}

std::vector<std::string> remarks_on(const History& history, const std::string& path) {
  std::vector<std::string> out;
  if (!history.unreadable.empty()) {
    out.push_back(fmt::format("{}: line{} {} could not be read and {} passed over", path,
                              base::agreed(std::ssize(history.unreadable), "", "s"),
                              listed(history.unreadable),
                              base::agreed(std::ssize(history.unreadable), "is", "are")));
  }
  if (history.half_written) {
    out.push_back(fmt::format("{}: the last line is half written and is passed over", path));
  }
  return out;
}

std::vector<std::vector<std::size_t>> suites_of(const History& history) {
  std::vector<std::vector<std::size_t>> out;
  for (std::size_t i = 0; i < history.lines.size(); ++i) {
    const auto is_its = [&](const std::vector<std::size_t>& suite) {
      return history.lines[suite.front()].is_same_suite(history.lines[i]);
    };
    const auto at = std::find_if(out.begin(), out.end(), is_its);
    if (at == out.end()) {
      out.push_back({i});
    } else {
      at->push_back(i);
    }
  }
  return out;
}

}  // namespace parallax::tools
