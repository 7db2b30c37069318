#include "tools/ledger/ledger_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "compiler/base/ascii.h"
#include "compiler/base/json.h"

namespace parallax::tools {
namespace {

using harness::Ledger;
using harness::LedgerEntry;

/// A scalar of YAML on one line: plain where nothing in it could be read as anything else.
std::string scalar(const std::string& text) {
  const auto is_plain = [&](std::size_t i) {
    if (text[i] == ':') return i + 1 < text.size() && text[i + 1] != ' ';
    return base::is_name_character(text[i]) ||
           std::string_view(" ()/.,-+=<>`'").find(text[i]) != std::string_view::npos;
  };
  bool looks_like_a_word =
      !text.empty() && (base::is_letter(text.front()) || text.front() == '_') && text.back() != ' ';
  for (std::size_t i = 0; i < text.size(); ++i) {
    looks_like_a_word = looks_like_a_word && is_plain(i);
  }
  static constexpr std::string_view kOther[] = {"true", "false", "null", "yes", "no", "on", "off"};
  const auto is_other = [&](std::string_view word) {
    return text.size() == word.size() &&
           std::equal(text.begin(), text.end(), word.begin(),
                      [](char a, char b) { return base::to_lower(a) == b; });
  };
  if (looks_like_a_word && std::none_of(std::begin(kOther), std::end(kOther), is_other)) {
    return text;
  }
  return base::json_quoted(text);
}

/// Where the line of this byte begins.
std::size_t line_begin(std::string_view text, std::size_t at) {
  const auto newline = at == 0 ? std::string_view::npos : text.rfind('\n', at - 1);
  return newline == std::string_view::npos ? 0 : newline + 1;
}

/// The blanks before the dash of an entry that begins a line of its own; none where it does not.
std::optional<std::size_t> indent_of(std::string_view text, const LedgerEntry& entry) {
  const auto begin = line_begin(text, entry.source.begin);
  const auto head = text.substr(begin, entry.source.begin - begin);
  const auto dash = head.find('-');
  const auto has_only = [](std::string_view part, const char* characters) {
    return part.find_first_not_of(characters) == std::string_view::npos;
  };
  const bool is_own_line = dash != std::string_view::npos && has_only(head.substr(0, dash), " ") &&
                           has_only(head.substr(dash + 1), " {");
  return is_own_line ? std::optional(dash) : std::nullopt;
}

/// Where an entry begins, with the comments right above it.
std::size_t block_begin(std::string_view text, const LedgerEntry& entry) {
  auto begin = line_begin(text, entry.source.begin);
  while (begin > 0) {
    const auto above = line_begin(text, begin - 1);
    const auto line = text.substr(above, begin - above);
    const auto first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos || line[first] != '#') break;
    begin = above;
  }
  return begin;
}

bool is_same(const LedgerEntry& a, const LedgerEntry& b) {
  const auto fields = [](const LedgerEntry& one) {
    return std::tie(one.id, one.scenario, one.event, one.outcome, one.fluents, one.trace, one.says,
                    one.cause, one.model, one.first_seen, one.status, one.decision);
  };
  return fields(a) == fields(b);
}

/// Does the text parse to exactly this? An edited text is read again before it is used.
bool says(const std::string& text, const std::vector<LedgerEntry>& expected) {
  base::SourceFiles files;
  base::DiagnosticSink unread;
  const auto file = files.add("ledger", text);
  const auto read = harness::parse_ledger(file, files, unread);
  return read && std::equal(read->entries.begin(), read->entries.end(), expected.begin(),
                            expected.end(), is_same);
}

/// `discrepancies: []` has no place for an entry.
std::string without_empty_list(std::string text) {
  const auto key = text.find("discrepancies:");
  if (key == std::string::npos) return text;
  const auto open = text.find_first_not_of(" \t", text.find(':', key) + 1);
  if (open == std::string::npos || text[open] != '[') return text;
  const auto close = text.find(']', open);
  if (close == std::string::npos) return text;
  const auto colon = text.find(':', key);
  return text.erase(colon + 1, close - colon);
}

std::string slug(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (base::is_name_character(c)) {
      out += base::to_lower(c);
    } else if (!out.empty() && out.back() != '-') {
      out += '-';
    }
  }
  while (out.ends_with('-')) out.pop_back();
  constexpr std::size_t kLongest = 40;
  return out.substr(0, kLongest);
}

}  // namespace

std::string new_ledger_text() {
  return "# Discrepancies between model and world that are known, and what was decided about\n"
         "# them: docs/reference/suites.md. Edit it by hand, or with `parallax ledger`.\n"
         "discrepancies:\n";
}

std::string entry_text(const LedgerEntry& entry, std::size_t indent) {
  const std::string blanks(indent, ' ');
  std::string out;
  const auto field = [&](std::string_view key, const std::string& value) {
    if (value.empty()) return;
    out += fmt::format("{}{}{}: {}\n", blanks, out.empty() ? "- " : "  ", key, scalar(value));
  };
  const auto list = [&](std::string_view key, const std::optional<std::vector<std::string>>& all) {
    if (!all) return;
    out += fmt::format("{}  {}:{}\n", blanks, key, all->empty() ? " []" : "");
    for (const auto& item : *all) out += fmt::format("{}    - {}\n", blanks, scalar(item));
  };
  field("id", entry.id);
  field("scenario", entry.scenario);
  list("trace", entry.trace);
  field("event", entry.event);
  if (entry.outcome) field("outcome", *entry.outcome);
  list("fluents", entry.fluents);
  field("says", entry.says);
  field("cause", entry.cause);
  field("model", entry.model);
  field("first_seen", entry.first_seen);
  field("status", status_text(entry));
  return out;
}

std::optional<std::string> with_entry(std::string_view text, const Ledger& ledger,
                                      const LedgerEntry& entry) {
  const auto comes_behind = [&](const LedgerEntry& one) {
    return std::tie(one.scenario, one.id) > std::tie(entry.scenario, entry.id);
  };
  auto expected = ledger.entries;
  const auto at = std::find_if(expected.begin(), expected.end(), comes_behind);
  std::string out;
  if (expected.empty()) {
    out = without_empty_list(std::string(text));
    if (!out.ends_with('\n')) out += '\n';
    out += entry_text(entry, 2);
  } else {
    const auto indent = indent_of(text, at == expected.end() ? expected.back() : *at);
    if (!indent) return std::nullopt;
    out = text;
    if (at == expected.end()) {
      if (!out.ends_with('\n')) out += '\n';
      out += entry_text(entry, *indent);
    } else {
      out.insert(block_begin(text, *at), entry_text(entry, *indent));
    }
  }
  expected.insert(at, entry);
  return says(out, expected) ? std::optional(std::move(out)) : std::nullopt;
}

std::optional<std::string> with_status(std::string_view text, const Ledger& ledger,
                                       const LedgerEntry& entry) {
  auto expected = ledger.entries;
  std::string out(text);
  for (auto& one : expected) {
    if (one.id != entry.id) continue;
    std::size_t begin = one.status_source.begin, end = one.status_source.end;
    const auto is_quote = [&](std::size_t i) {
      return i < text.size() && (text[i] == '"' || text[i] == '\'');
    };
    if (begin > 0 && is_quote(begin - 1) && is_quote(end)) {
      --begin;
      ++end;
    }
    out.replace(begin, end - begin, scalar(status_text(entry)));
    one = entry;
  }
  return says(out, expected) ? std::optional(std::move(out)) : std::nullopt;
}

std::string free_id(const Ledger& ledger, const LedgerEntry& entry) {
  const std::filesystem::path scenario(entry.scenario);
  auto stem = scenario.stem().string();
  if (stem == "scenario" && scenario.has_parent_path()) {
    stem = scenario.parent_path().filename().string();
  }
  auto head = slug(stem);
  while (!head.empty() && !base::is_letter(head.front()) && !base::is_digit(head.front())) {
    head.erase(0, 1);
  }
  const auto wanted = fmt::format("{}.{}", head.empty() ? "scenario" : head, slug(entry.event));
  auto out = wanted;
  for (int i = 2; ledger.find(out) != nullptr; ++i) out = fmt::format("{}-{}", wanted, i);
  return out;
}

}  // namespace parallax::tools
