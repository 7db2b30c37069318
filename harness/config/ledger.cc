#include "harness/config/ledger.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/codes/scenarios.h"
#include "compiler/base/file_io.h"
#include "compiler/base/path_gate.h"
#include "harness/config/sections.h"

namespace parallax::harness {
namespace {

constexpr std::string_view kRepairedIn = "repaired in ", kAcceptedBecause = "accepted because ";

/// `open`, `repaired in REVISION`, `accepted because TEXT`.
bool read_status(const YamlNode& node, LedgerEntry& entry, base::DiagnosticSink& sink) {
  const auto text = read_text(node, key_text(Key::kStatus), sink);
  if (!text) return false;
  if (*text == "open") return true;
  const auto take = [&](std::string_view head, LedgerStatus status) {
    if (!text->starts_with(head) || base::is_all_space(text->substr(head.size()))) return false;
    entry.status = status;
    entry.decision = text->substr(head.size());
    return true;
  };
  if (take(kRepairedIn, LedgerStatus::kRepaired) || take(kAcceptedBecause, LedgerStatus::kAccepted))
    return true;
  sink.error(codes::kWrongYamlKind, node.range, key_text(Key::kStatus), describe(node),
             "`open`, `repaired in REVISION` or `accepted because TEXT`");
  return false;
}

/// Reads the fields by which an entry is recognized, and those that describe it.
void read_fields(const YamlFields& fields, LedgerEntry& entry) {
  fields.text(Key::kOutcome, entry.outcome);
  const auto list = [&](std::string_view key, std::optional<std::vector<std::string>>& into) {
    if (fields.find(key) == nullptr) return;
    std::vector<std::string> out;
    fields.texts(key, out);
    into = std::move(out);
  };
  list(Key::kFluents, entry.fluents);
  list(Key::kTrace, entry.trace);
  fields.text(Key::kSays, entry.says);
  fields.text(Key::kCause, entry.cause);
  fields.text(Key::kModel, entry.model);
  fields.text(Key::kFirstSeen, entry.first_seen);
}

std::optional<LedgerEntry> read_entry(const YamlNode& node, base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  YamlFields fields(node, "the entry", sink);
  fields.only({Key::kId, Key::kScenario, Key::kEvent, Key::kOutcome, Key::kFluents, Key::kTrace,
               Key::kSays, Key::kCause, Key::kModel, Key::kStatus, Key::kFirstSeen});
  LedgerEntry entry;
  entry.source = node.range;
  const auto require = [&](std::string_view key, std::string& into) {
    const auto* value = fields.require(key);
    if (value == nullptr) return base::SourceRange{};
    if (auto text = read_text(*value, key_text(key), sink)) into = *std::move(text);
    return value->range;
  };
  entry.id_source = require(Key::kId, entry.id);
  require(Key::kScenario, entry.scenario);
  require(Key::kEvent, entry.event);
  if (const auto* status = fields.require(Key::kStatus)) {
    entry.status_source = status->range;
    read_status(*status, entry, sink);
  }
  read_fields(fields, entry);
  if (const auto problem = id_problem(entry.id); !entry.id.empty() && !problem.empty()) {
    sink.error(codes::kWrongYamlKind, entry.id_source, key_text(Key::kId),
               fmt::format("`{}`", entry.id), "an id: " + problem);
  }
  if (sink.error_count() != errors_before) return std::nullopt;
  return entry;
}

base::Result<Ledger> ledger_of(const YamlNode& root, base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  YamlFields fields(root, "the ledger", sink);
  fields.only({Key::kDiscrepancies});
  Ledger out;
  const auto* entries = fields.require(Key::kDiscrepancies);
  const bool none = entries == nullptr || entries->kind == YamlNode::Kind::kNull;
  if (!none && !entries->is_list()) {
    sink.error(codes::kWrongYamlKind, entries->range, key_text(Key::kDiscrepancies),
               describe(*entries), "a list of discrepancies");
    return sink.already_reported();
  }
  std::map<std::string, base::SourceRange> known;
  for (const auto& node : none ? std::vector<YamlNode>{} : entries->items) {
    auto entry = read_entry(node, sink);
    if (!entry) continue;
    const auto [first, is_new] = known.emplace(entry->id, entry->id_source);
    if (!is_new) {
      sink.error(codes::kWrongYamlKind, entry->id_source, key_text(Key::kId),
                 fmt::format("`{}` a second time", entry->id), "distinct")
          .note(first->second, "the first is here");
      continue;
    }
    out.entries.push_back(*std::move(entry));
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return out;
}

}  // namespace

std::string status_text(const LedgerEntry& entry) {
  switch (entry.status) {
    case LedgerStatus::kOpen:
      return "open";
    case LedgerStatus::kRepaired:
      return std::string(kRepairedIn) + entry.decision;
    case LedgerStatus::kAccepted:
      return std::string(kAcceptedBecause) + entry.decision;
  }
  return "";
}

const LedgerEntry* Ledger::find(std::string_view id) const {
  const auto at = std::find_if(entries.begin(), entries.end(),
                               [&](const LedgerEntry& one) { return one.id == id; });
  return at == entries.end() ? nullptr : &*at;
}

base::Result<Ledger> parse_ledger(base::FileId file, base::SourceFiles& files,
                                  base::DiagnosticSink& sink) {
  const auto root = parse_yaml(file, files, sink);
  if (!root) return sink.already_reported();
  auto out = ledger_of(*root, sink);
  if (out) out->file = file;
  return out;
}

base::Result<Ledger> load_ledger(const std::filesystem::path& path, base::SourceFiles& files,
                                 base::DiagnosticSink& sink) {
  const auto file = base::load_text(path, files, sink);
  if (!file) return sink.already_reported();
  if (files[*file].text().size() > kMaxYamlBytes) {
    return sink.error_about(codes::kFileTooLarge, path.string(), kMaxYamlBytes);
  }
  return parse_ledger(*file, files, sink);
}

std::string ledger_name(const std::filesystem::path& scenario,
                        const std::filesystem::path& ledger) {
  std::error_code error;
  const auto here = std::filesystem::absolute(ledger, error).parent_path();
  const auto from = base::real_path(here), to = base::real_path(scenario);
  const auto way = to.lexically_relative(from);
  return (way.empty() ? to : way).generic_string();
}

}  // namespace parallax::harness
