#include "tools/suite/since_last_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <vector>

#include "compiler/base/file_io.h"
#include "compiler/base/file_names.h"
#include "compiler/base/json.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/temporary_folder.h"
#include "compiler/base/utf8.h"
#include "tools/suite/case_process.h"
#include "tools/suite/input_hashes.h"
#include "tools/suite/last_pass.h"
#include "tools/suite/scratch_copy.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kShownChanges = 5;
constexpr std::size_t kShownLines = 80;
constexpr const char* kBefore = "before";  // a folder, in the copy and in what is printed

/// A path as a user would write it here.
std::string shown(const fs::path& absolute) {
  std::error_code error;
  const auto relative = absolute.lexically_relative(fs::current_path(error));
  const bool inside = !relative.empty() && relative.begin()->string() != "..";
  return (inside ? relative : absolute).generic_string();
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

/// The first lines, and how many more there are.
std::string cut(const std::string& text) {
  std::size_t lines = 0, end = 0;
  for (std::size_t at = 0; at < text.size(); ++lines) {
    at = std::min(text.find('\n', at), text.size() - 1) + 1;
    if (lines < kShownLines) end = at;
  }
  auto out = text.substr(0, end);
  while (out.ends_with('\n')) out.pop_back();
  return lines <= kShownLines ? out : out + fmt::format("\n... {} more lines", lines - kShownLines);
}

/// The current texts of files, by absolute name, as far as they are texts.
SuiteTexts read_now(const std::set<std::string>& paths) {
  SuiteTexts out;
  for (const auto& path : paths) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) continue;
    base::DiagnosticSink unread;
    if (auto text = base::read_file(path, unread)) out.emplace(base::absolute_name(path), *text);
  }
  return out;
}

/// "a.e, b.e and 3 more changed"
std::string changes(const SuiteCase& one, const LastPass& before) {
  std::vector<std::string> changed;
  if (before.definition != LastPasses::definition_of(one)) {
    changed.push_back(fmt::format("the case in {}", one.file));
  }
  for (const auto& [name, text] : before.texts) {
    base::DiagnosticSink unread;
    std::error_code error;
    if (!fs::exists(name, error)) {
      changed.push_back(shown(name) + " (gone)");
    } else if (const auto now = base::read_file(name, unread); !now || *now != text) {
      changed.push_back(shown(name));
    }
  }
  if (changed.empty()) return {};
  std::string out;
  for (std::size_t i = 0; i < std::min(changed.size(), kShownChanges); ++i) {
    out += (i > 0 ? ", " : "") + changed[i];
  }
  if (changed.size() <= kShownChanges) return out + " changed";
  return fmt::format("{} and {} more changed", out, changed.size() - kShownChanges);
}

/// The input of `parallax diff` for one side: the scenario, the model, or a file that loads all of
/// several models. None where a file is missing.
std::optional<fs::path> model_in(const ScratchCopy& copy, const SuiteCase& one) {
  std::vector<fs::path> models;
  if (const auto* traces = std::get_if<harness::ManifestCase>(&one.check)) {
    for (const auto& model : traces->models) models.push_back(copy.place_of(model.text));
  } else {
    models.push_back(copy.place_of(one.file));
  }
  std::string loads;
  for (const auto& model : models) {
    std::error_code error;
    if (!base::lies_below(model, copy.folder()) || !fs::exists(model, error)) return std::nullopt;
    loads += fmt::format("load {}\n", model.lexically_relative(copy.folder()).generic_string());
  }
  if (models.size() == 1) return models.front();
  auto file = copy.folder() / "models.e";
  for (std::error_code error; fs::exists(file, error);)
    file.replace_filename("_" + file.filename().string());
  base::DiagnosticSink unread;
  if (!base::write_file_atomically(file, loads, unread)) return std::nullopt;
  return file;
}

/// Output of `parallax diff MORE` about the models, with the files as they were and those at
/// `paths`; empty if there is none.
std::string difference_of(const SuiteCase& one, const LastPass& before,
                          const std::set<std::string>& paths, const std::vector<std::string>& more,
                          const RunnerOptions& options, const std::atomic<bool>& stop) {
  const base::TemporaryFolder scratch("since");
  if (scratch.path().empty()) return {};
  base::DiagnosticSink unread;
  const auto then = ScratchCopy::make(before.texts, scratch.path() / kBefore, unread);
  const auto now = ScratchCopy::make(read_now(paths), scratch.path() / "now", unread);
  if (!then || !now) return {};
  const auto old_model = model_in(*then, one), new_model = model_in(*now, one);
  if (!old_model || !new_model) return {};
  CommandWords words{{"diff", "--quiet", "--color=never"}, {*old_model, *new_model}};
  words.options.insert(words.options.end(), more.begin(), more.end());
  auto limit = kBlameLimitS;
  if (const auto* traces = std::get_if<harness::ManifestCase>(&one.check)) {
    limit = traces->time_limit_s;
    if (traces->horizon) {
      words.options.insert(words.options.end(), {"--horizon", std::to_string(*traces->horizon)});
    }
    if (traces->memory_limit_mb) {
      words.options.insert(words.options.end(),
                           {"--memory-limit", std::to_string(*traces->memory_limit_mb)});
    }
  }
  words.options.insert(words.options.end(), {"--time-limit", fmt::format("{}", limit)});
  add_permissions(options, false, words.options);
  Footprint own(one, options.out);  // copies are no inputs of the case
  auto text = run_this_program(words, own, stop).out;
  const auto show = [&](const ScratchCopy& copy, const std::string& mark) {
    auto root = shown(copy.root());
    if (!mark.empty() && root.starts_with('/')) root.erase(0, 1);
    const auto folder = root == "." ? mark : mark + root + '/';
    replace_all(text, copy.folder().generic_string() + '/', folder);
  };
  show(*then, fmt::format("{}/", kBefore));
  show(*now, "");
  return text;
}

/// A text of a line, cut.
std::string cut_line(std::string_view text) {
  constexpr std::size_t kLongest = 120;
  if (text.size() <= kLongest) return std::string(text);
  auto end = kLongest;
  while (end > 0 && base::continues_code_point(text[end])) --end;
  return std::string(text.substr(0, end)) + "...";
}

/// "[time] A(), now [time] B()"; of long texts the part that differs: "(defparameter *pose* ...:
/// 0.7, now 0.5".
std::string changed_text(const std::string& before, const std::string& after) {
  constexpr std::size_t kShort = 90;
  if (std::max(before.size(), after.size()) <= kShort) {
    return fmt::format("{}, now {}", before, after);
  }
  const auto is_between = [](char c) { return c == ' ' || c == '(' || c == ')' || c == ','; };
  const auto shorter = std::min(before.size(), after.size());
  std::size_t same = 0, behind = 0;
  while (same < shorter && before[same] == after[same]) ++same;
  while (same > 0 && !is_between(before[same - 1])) --same;
  const auto at_end = [](const std::string& text, std::size_t i) {
    return text[text.size() - 1 - i];
  };
  while (behind < shorter - same && at_end(before, behind) == at_end(after, behind)) ++behind;
  while (behind > 0 && !is_between(at_end(before, behind - 1))) --behind;
  const auto part = [&](const std::string& text) {
    const auto middle = std::string_view(text).substr(same, text.size() - same - behind);
    return middle.empty() ? std::string("nothing") : cut_line(middle);
  };
  // Two words say which form or axiom it is.
  const auto head = before.substr(0, std::min(same, before.find(' ', before.find(' ') + 1)));
  return fmt::format("{} ...: {}, now {}", cut_line(head), part(before), part(after));
}

/// A fact that only one side has, or that changed, in a line.
void add_facts(const nlohmann::json& document, const char* kind, std::vector<std::string>& out) {
  const auto* facts = base::json_member(document, kind);
  if (facts == nullptr || !facts->is_object()) return;
  const auto text_of = [](const nlohmann::json& fact) {
    const auto* text = base::json_member(fact, "text");
    return text != nullptr && text->is_string() ? text->get<std::string>() : std::string();
  };
  for (const auto& [mark, list] : facts->items()) {
    for (const auto& fact : list.is_array() ? list : nlohmann::json::array()) {
      const auto* before = base::json_member(fact, "old");
      const auto* after = base::json_member(fact, "new");
      out.push_back(before != nullptr && after != nullptr
                        ? changed_text(text_of(*before), text_of(*after))
                        : fmt::format("{}: {}", mark, cut_line(text_of(fact))));
    }
  }
}

}  // namespace

std::string since_last_pass(const SuiteCase& one, const RunnerOptions& options,
                            const Footprint& footprint, const std::atomic<bool>& stop) {
  const auto before =
      options.last_passes == nullptr ? std::nullopt : options.last_passes->find(one);
  if (!before) return {};
  const bool same_program = before->program == program_hash();
  auto out = changes(one, *before);
  if (out.empty()) {
    return fmt::format("since it passed last, none of its files changed{}",
                       same_program ? ", nor did the program" : "; the program did");
  }
  out = "since it passed last, " + out;
  if (!same_program) out += ", and so did the program";
  const auto difference = cut(difference_of(one, *before, footprint.inputs(), {}, options, stop));
  if (difference.empty()) return out;
  return fmt::format("{}; {} is what it was then\n{}", out, fmt::format("{}/...", kBefore),
                     difference);
}

std::vector<std::string> changed_values(const SuiteCase& one, const LastPass& before,
                                        const CaseResult& result, const RunnerOptions& options,
                                        const std::atomic<bool>& stop) {
  std::vector<std::string> out;
  if (before.definition != LastPasses::definition_of(one)) {
    out.push_back(fmt::format("the case in {}", one.file));
  }
  std::set<std::string> paths;
  for (const auto& input : result.inputs) paths.insert(input.path);
  const auto document =
      base::parse_json(difference_of(one, before, paths, {"--no-traces", "--json"}, options, stop));
  const auto value = [](const nlohmann::json& change, const char* side) {
    const auto* text = base::json_member(change, side);
    return text != nullptr && text->is_string() ? text->get<std::string>() : std::string();
  };
  const auto* settings = base::json_member(document, "settings");
  if (settings != nullptr && settings->is_array()) {
    for (const auto& change : *settings) {
      const auto old = value(change, "old"), now = value(change, "new");
      out.push_back(fmt::format("{} {} -> {}", value(change, "path"),
                                old.empty() ? "nothing" : cut_line(old),
                                now.empty() ? "nothing" : cut_line(now)));
    }
  }
  add_facts(document, "declarations", out);
  add_facts(document, "axioms", out);
  return out;
}

}  // namespace parallax::tools
