#include "tools/lsp/diagnosis.h"

#include <filesystem>
#include <system_error>

#include "compiler/base/diagnostic_printer.h"
#include "tools/app/context.h"
#include "tools/app/file_check.h"

namespace parallax::tools::lsp {
namespace {

std::string normal(const std::string& path) {
  return std::filesystem::path(path).lexically_normal().string();
}

std::string text_of(const base::Diagnostic& diagnostic, const base::SourceFiles& files) {
  auto text = diagnostic.message;
  for (const auto& note : diagnostic.notes) {
    text += "\nnote: " + (note.range ? files.place(*note.range) + ": " : "") + note.text;
  }
  if (!diagnostic.fix.empty()) return text + "\nfix: " + diagnostic.fix;
  const auto help = base::help_of(diagnostic);
  return help.empty() ? text : text + "\nhelp: " + std::string(help);
}

/// The text between the quotes that follow `before`.
std::optional<std::string> quoted_after(const std::string& sentence, std::string_view before) {
  const auto at = sentence.find(before);
  if (at == std::string::npos) return std::nullopt;
  const auto begin = at + before.size();
  const auto end = sentence.find('`', begin);
  if (end == std::string::npos) return std::nullopt;
  return sentence.substr(begin, end - begin);
}

}  // namespace

std::optional<std::map<std::string, std::vector<EditorMessage>>> checked(
    const std::string& root, const base::OpenTexts& texts, std::atomic<bool>& stop) {
  const base::ReadOpenTexts reading(texts);
  Context context({}, stop);
  ModelOptions options;
  options.models = {root};
  options.lint = true;
  check_files(options, context);
  if (stop.load()) return std::nullopt;
  std::map<std::string, std::vector<EditorMessage>> out;
  out[normal(root)];
  for (const auto& diagnostic : context.sink().sorted()) {
    const auto& info = base::info(diagnostic.code);
    EditorMessage message;
    message.is_error = info.severity == base::Severity::kError;
    message.code = info.id;
    message.fix = diagnostic.fix;
    message.text = text_of(diagnostic, context.files());
    auto path = root;
    if (diagnostic.range) {
      const auto name = context.files()[diagnostic.range->file].name();
      if (std::filesystem::path(name).is_absolute()) {
        path = name;
        message.begin = diagnostic.range->begin;
        message.end = diagnostic.range->end;
      } else {
        message.text = name + ": " + message.text;  // inside of the program
      }
    } else if (!diagnostic.subject.empty()) {
      message.text = diagnostic.subject + ": " + message.text;
    }
    out[normal(path)].push_back(std::move(message));
  }
  return out;
}

std::optional<EditorFix> fix_of(const EditorMessage& message, const std::string& text) {
  const auto& fix = message.fix;
  if (message.end > text.size() || message.begin > message.end) return std::nullopt;
  if (fix.starts_with("replace `")) {
    const auto old = quoted_after(fix, "replace `");
    const auto fresh = quoted_after(fix, "` with `");
    if (!old || !fresh || old->empty()) return std::nullopt;
    const auto place = text.substr(message.begin, message.end - message.begin);
    const auto at = place.find(*old);
    // Only where it can mean one place.
    if (at == std::string::npos || place.find(*old, at + 1) != std::string::npos)
      return std::nullopt;
    return EditorFix{message.begin + at, message.begin + at + old->size(), *fresh};
  }
  if (fix.starts_with("add `")) {
    const auto added = quoted_after(fix, "add `");
    const auto behind = quoted_after(fix, "` after `");
    if (!added || !behind || behind->empty()) return std::nullopt;
    const auto at = text.rfind(*behind, message.end);
    if (at == std::string::npos || at + behind->size() > message.end + behind->size())
      return std::nullopt;
    const auto place = at + behind->size();
    return EditorFix{place, place, *added};
  }
  if (fix == "remove the period") {
    const auto at = text.find('.', message.begin);
    if (at == std::string::npos || at > message.end) return std::nullopt;
    return EditorFix{at, at + 1, ""};
  }
  return std::nullopt;
}

}  // namespace parallax::tools::lsp
