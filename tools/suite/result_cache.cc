#include "tools/suite/result_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <system_error>

#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/sha256.h"
#include "tools/suite/sealed_text.h"
#include "tools/suite/suite_results.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxEntryBytes = std::size_t{4} << 20U;
constexpr std::size_t kMaxEntries = 16;  // of one case: the last states of its files

Json texts(const std::vector<harness::LocatedText>& located) {
  auto out = Json::array();
  for (const auto& one : located) out.push_back(one.text);
  return out;
}

template <typename T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

/// The entries of a case, the newest first.
std::vector<std::pair<std::int64_t, fs::path>> entries_in(const fs::path& folder) {
  std::vector<std::pair<std::int64_t, fs::path>> out;
  std::error_code error;
  fs::directory_iterator at(folder, error);
  for (; !error && at != fs::directory_iterator(); at.increment(error)) {
    std::error_code unread;
    if (!at->is_regular_file(unread) || at->path().extension() != ".json") continue;
    const auto time = at->last_write_time(unread).time_since_epoch();
    out.emplace_back(std::chrono::duration_cast<std::chrono::nanoseconds>(time).count(),
                     at->path());
  }
  std::sort(out.rbegin(), out.rend());
  return out;
}

/// The result in an entry; none if the entry is damaged or not a repeatable pass.
std::optional<CaseResult> read_entry(const fs::path& path) {
  base::DiagnosticSink unread;
  const auto text = base::read_file(path, unread, kMaxEntryBytes);
  const auto inner = text ? unsealed(*text) : std::nullopt;
  if (!inner) return std::nullopt;
  auto result = result_from_text(*inner);
  if (!result || result->outcome != Outcome::kPassed || !result->repeatable) return std::nullopt;
  return result;
}

}  // namespace

std::string case_definition(const SuiteCase& one, const CaseKey& key) {
  Json json = {{"program", key.program},
               {"seed", key.seed},
               {"allow_outside", key.allow_outside},
               {"case", one.name()},
               {"ledger", ledger_digest_of(key.ledger, one)}};
  if (const auto* traces = std::get_if<harness::ManifestCase>(&one.check)) {
    const auto& expect = traces->expect;
    json["models"] = texts(traces->models);
    json["horizon"] = or_null(traces->horizon);
    json["constraints"] = texts(traces->constraints);
    json["time_limit_s"] = traces->time_limit_s;
    json["memory_limit_mb"] = or_null(traces->memory_limit_mb);
    json["traces"] = or_null(expect.traces);
    json["complete"] = expect.complete;
    json["golden"] = expect.golden ? Json(expect.golden->text) : Json();
    json["holds"] = texts(expect.holds);
    json["violated"] = texts(expect.violated);
  }
  return base::sha256_hex(base::json_text(json));
}

fs::path ResultCache::folder_of(const SuiteCase& one) const {
  const auto definition = case_definition(one, key_);
  return folder_ / definition.substr(0, 2) / definition.substr(2);
}

std::optional<ResultCache::Hit> ResultCache::find(const SuiteCase& one, InputHashes& hashes,
                                                  std::size_t& damaged) const {
  for (const auto& [time, path] : entries_in(folder_of(one))) {
    auto result = read_entry(path);
    if (!result) {
      ++damaged;
    } else if (!result->inputs.empty() && hashes.unchanged(result->inputs)) {
      result->reused = "cached";
      return Hit{*std::move(result), path, time};
    }
  }
  return std::nullopt;
}

bool ResultCache::store(const SuiteCase& one, const CaseResult& result) const {
  if (result.outcome != Outcome::kPassed || !result.repeatable || result.flaky() ||
      result.inputs.empty() || !one.command.empty() || !result.golden_written.empty()) {
    return true;
  }
  const auto folder = folder_of(one);
  std::error_code error;
  fs::create_directories(folder, error);
  const auto entry = result_text(result);
  std::string inputs;
  for (const auto& input : result.inputs) inputs += input.path + '\0' + input.sha256 + '\0';
  base::DiagnosticSink unread;  // a cache that cannot be kept harms no suite
  const auto path = folder / (base::sha256_hex(inputs) + ".json");
  if (!base::write_file_atomically(path, sealed(entry), unread)) return false;
  const auto kept = entries_in(folder);
  for (std::size_t i = kMaxEntries; i < kept.size(); ++i) fs::remove(kept[i].second, error);
  return true;
}

std::string disagreement(const CaseResult& cached, const CaseResult& again) {
  if (cached.outcome != again.outcome) {
    return fmt::format("the cached result is `{}`, the case run again is `{}`",
                       to_string(cached.outcome), to_string(again.outcome));
  }
  if (cached.answer == again.answer) return {};
  return fmt::format(
      "the cached answer ({:.12}) and that of the case run again ({:.12}) are not the same bytes",
      cached.answer, again.answer);
}

}  // namespace parallax::tools
