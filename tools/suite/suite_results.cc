#include "tools/suite/suite_results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::json;

template <typename T>
void read(const Json& object, const char* name, T& into) {
  const auto* member = base::json_member(object, name);
  if (member == nullptr) return;
  if (auto value = base::json_as<T>(*member)) into = *std::move(value);
}

void read_texts(const Json& object, const char* name, std::vector<std::string>& into) {
  const auto* member = base::json_member(object, name);
  if (member == nullptr || !member->is_array()) return;
  for (const auto& item : *member) {
    if (item.is_string()) into.push_back(item.get<std::string>());
  }
}

Json to_json(const SuiteIdentity& identity) {
  return {{"tool_version", identity.version},
          {"program", identity.program},
          {"arithmetic", identity.arithmetic},
          {"seed", identity.seed},
          {"shard", to_string(identity.shard)},
          {"paths", identity.paths},
          {"only", identity.only},
          {"fast", identity.fast},
          {"allow_commands", identity.allow_commands},
          {"allow_outside", identity.allow_outside},
          {"ledger", identity.ledger}};
}

SuiteIdentity identity_from_json(const Json& json) {
  SuiteIdentity out;
  read(json, "tool_version", out.version);
  read(json, "program", out.program);
  read(json, "arithmetic", out.arithmetic);
  read(json, "seed", out.seed);
  std::string shard;
  read(json, "shard", shard);
  out.shard = parse_shard(shard).value_or(Shard{});
  read_texts(json, "paths", out.paths);
  read(json, "only", out.only);
  read(json, "fast", out.fast);
  read(json, "allow_commands", out.allow_commands);
  read(json, "allow_outside", out.allow_outside);
  read(json, "ledger", out.ledger);
  return out;
}

constexpr std::array kOutcomes = {Outcome::kPassed,       Outcome::kFailed,      Outcome::kError,
                                  Outcome::kInconclusive, Outcome::kNotFinished, Outcome::kSkipped,
                                  Outcome::kRemoved};

std::optional<Outcome> outcome_of(const std::string& text) {
  for (const auto outcome : kOutcomes) {
    if (text == to_string(outcome)) return outcome;
  }
  return std::nullopt;
}

/// A case in the first format of these files, which has the outcome alone.
std::optional<StoredCase> bare_case(const std::string& name, const std::string& outcome) {
  const auto known = outcome_of(outcome);
  if (!known) return std::nullopt;
  StoredCase out{{name, name, name, harness::Expectation{}}, {}};
  out.result.outcome = *known;
  return out;
}

Json to_json(const CaseResult& result) {
  auto inputs = Json::object();
  for (const auto& input : result.inputs) inputs[input.path] = input.sha256;
  return {{"outcome", to_string(result.outcome)},
          {"problems", result.problems},
          {"messages", result.messages},
          {"golden_written", result.golden_written},
          {"wall_s", result.wall_s},
          {"attempts", result.attempts},
          {"answer", result.answer},
          {"inputs", inputs},
          {"peak_memory_mb", result.peak_memory_mb},
          {"repeatable", result.repeatable},
          {"ledger", result.ledger},
          {"verdict", result.verdict},
          {"where", result.where},
          {"standing", result.standing},
          {"rates", base::parse_json(encode_rates(result.rates))},
          {"shown", result.shown},
          {"gone", result.gone}};
}

std::optional<CaseResult> result_from_json(const Json& json) {
  std::string outcome;
  read(json, "outcome", outcome);
  const auto known = outcome_of(outcome);
  if (!known) return std::nullopt;
  CaseResult out;
  out.outcome = *known;
  read_texts(json, "problems", out.problems);
  read(json, "messages", out.messages);
  read(json, "golden_written", out.golden_written);
  read(json, "wall_s", out.wall_s);
  std::uint64_t attempts = 1;
  read(json, "attempts", attempts);
  out.attempts = static_cast<std::uint32_t>(std::min<std::uint64_t>(attempts, 1000));
  read(json, "answer", out.answer);
  read(json, "peak_memory_mb", out.peak_memory_mb);
  read(json, "repeatable", out.repeatable);
  read(json, "ledger", out.ledger);
  read(json, "verdict", out.verdict);
  read(json, "where", out.where);
  read(json, "standing", out.standing);
  if (const auto* rates = base::json_member(json, "rates")) {
    out.rates = decode_rates(base::json_text(*rates));
  }
  read_texts(json, "shown", out.shown);
  read_texts(json, "gone", out.gone);
  if (const auto* inputs = base::json_member(json, "inputs"); inputs != nullptr) {
    if (!inputs->is_object()) return std::nullopt;
    for (const auto& [path, hash] : inputs->items()) {
      if (!hash.is_string()) return std::nullopt;
      out.inputs.push_back({path, hash.get<std::string>()});
    }
  }
  return out;
}

std::optional<StoredCase> case_from_json(const std::string& name, const Json& json) {
  if (json.is_string()) return bare_case(name, json.get<std::string>());
  auto result = result_from_json(json);
  if (!result) return std::nullopt;
  StoredCase out{{"", "", "", harness::Expectation{}}, *std::move(result)};
  read(json, "file", out.one.file);
  read(json, "id", out.one.id);
  read(json, "group", out.one.group);
  read(json, "revision", out.one.revision);
  std::uint64_t line = 0;
  read(json, "line", line);
  out.one.line = static_cast<std::uint32_t>(std::min<std::uint64_t>(line, UINT32_MAX));
  if (out.one.file.empty() || out.one.name() != name) return std::nullopt;
  return out;
}

std::string words(const std::vector<std::string>& texts) {
  return fmt::format("`{}`", fmt::join(texts, " "));
}

}  // namespace

std::vector<std::string> normal_paths(std::vector<std::string> paths) {
  for (auto& path : paths) {
    path = fs::path(path).lexically_normal().string();
    while (path.size() > 1 && path.ends_with('/')) path.pop_back();
  }
  std::sort(paths.begin(), paths.end());
  paths.erase(std::unique(paths.begin(), paths.end()), paths.end());
  return paths;
}

std::string difference(const SuiteIdentity& a, const SuiteIdentity& b) {
  // Files of the first form say nothing of it.
  if (a.program.empty() || b.program.empty()) return "one was made by an older version";
  if (a.version != b.version) return fmt::format("version {} and {}", a.version, b.version);
  if (a.program != b.program) {
    return fmt::format("another build of version {} (program {:.12} and {:.12})", a.version,
                       a.program, b.program);
  }
  if (!a.arithmetic.empty() && !b.arithmetic.empty() && a.arithmetic != b.arithmetic) {
    return fmt::format("processors that calculate differently (arithmetic {} and {})", a.arithmetic,
                       b.arithmetic);
  }
  if (a.seed != b.seed) return fmt::format("seed {} and {}", a.seed, b.seed);
  if (a.shard.count != b.shard.count) {
    return fmt::format("{} shards and {}", a.shard.count, b.shard.count);
  }
  if (normal_paths(a.paths) != normal_paths(b.paths))
    return fmt::format("{} and {}", words(a.paths), words(b.paths));
  if (a.only != b.only) return fmt::format("--only `{}` and `{}`", a.only, b.only);
  const auto one_with = [](const char* option) {
    return fmt::format("one with {} and one without", option);
  };
  if (a.fast != b.fast) return one_with("--fast");
  if (a.allow_commands != b.allow_commands) return one_with("--allow-commands");
  if (a.allow_outside != b.allow_outside) return one_with("--allow-outside");
  return {};
}

bool SuiteIdentity::permits_more_than(const SuiteIdentity& other) const {
  return allow_commands >= other.allow_commands && allow_outside >= other.allow_outside &&
         (allow_commands != other.allow_commands || allow_outside != other.allow_outside);
}

std::string result_text(const CaseResult& result) { return base::json_text(to_json(result)); }

std::optional<CaseResult> result_from_text(std::string_view text) {
  return result_from_json(base::parse_json(text));
}

base::Result<StoredResults> read_results(const fs::path& folder, base::DiagnosticSink& sink) {
  const auto path = folder / kResultsFile;
  base::DiagnosticSink unread;
  const auto text = base::read_file(path, unread);
  const auto json = text ? base::parse_json(*text) : Json();
  const auto* cases = base::json_member(json, "cases");
  const auto refused = [&] { return sink.error_about(codes::kNoEarlierResults, path.string()); };
  if (cases == nullptr || !cases->is_object()) return refused();
  StoredResults out;
  if (const auto* suite = base::json_member(json, "suite")) {
    out.identity = identity_from_json(*suite);
  }
  for (const auto& [name, value] : cases->items()) {
    auto stored = case_from_json(name, value);
    if (!stored) return refused();
    out.cases.emplace(name, *std::move(stored));
  }
  std::vector<std::string> known;
  read_texts(json, "known", known);
  out.known.insert(known.begin(), known.end());
  std::vector<std::string> removed;
  read_texts(json, "removed", removed);
  out.removed.insert(removed.begin(), removed.end());
  return out;
}

base::Status write_results(const fs::path& folder, StoredResults stored,
                           const std::vector<SuiteCase>& cases,
                           const std::vector<CaseResult>& results, base::DiagnosticSink& sink) {
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (cases[i].is_removed) continue;  // in `stored` until it has been told
    StoredCase one{cases[i], results[i]};
    if (results[i].outcome == Outcome::kSkipped) {
      stored.cases.try_emplace(cases[i].name(), std::move(one));
    } else {
      stored.cases.insert_or_assign(cases[i].name(), std::move(one));
    }
  }
  auto list = Json::object();
  for (const auto& [name, one] : stored.cases) {
    auto& item = list[name] = to_json(one.result);
    item["file"] = one.one.file;
    item["id"] = one.one.id;
    item["group"] = one.one.group;
    item["revision"] = one.one.revision;
    item["line"] = one.one.line;
  }
  std::error_code error;
  fs::create_directories(folder, error);
  Json json = {
      {"schema_version", 2}, {"suite", to_json(stored.identity)}, {"cases", std::move(list)}};
  if (!stored.known.empty()) json["known"] = stored.known;
  if (!stored.removed.empty()) json["removed"] = stored.removed;
  // Names are bytes of paths: what is no UTF-8 is replaced rather than refused.
  return base::write_file_atomically(folder / kResultsFile, base::json_text(json, 2) + '\n', sink);
}

}  // namespace parallax::tools
