#include "tools/cli/roff.h"

#include <fmt/format.h>

namespace parallax::tools {
namespace {

/// Escapes characters that `man` would replace by typographic ones although they are meant to be
/// typed.
std::string roff_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '`':
        out += "\\(ga";
        break;
      case '^':
        out += "\\(ha";
        break;
      case '~':
        out += "\\(ti";
        break;
      case '"':
        out += "\\(dq";
        break;
      default:
        out += c;
    }
  }
  return out;
}

}  // namespace

Roff::Roff(const std::string& title, const std::string& date, const std::string& source) {
  page_ = fmt::format(".TH {} 1 \"{}\" \"{}\" \"User Commands\"\n", roff_text(title), date,
                      roff_text(source));
  // Words are not broken, as options would be, nor lines stretched.
  page_ += ".nh\n.ad l\n";
}

/// A line that begins with a dot would be a request.
void Roff::line(std::string_view text) {
  if (text.starts_with('.')) page_ += "\\&";
  page_ += roff_text(text);
  page_ += '\n';
}

void Roff::new_paragraph() {
  if (!fresh_) page_ += ".PP\n";
  fresh_ = false;
}

void Roff::section(std::string_view name) {
  page_ += fmt::format(".SH {}\n", roff_text(name));
  fresh_ = true;
}

void Roff::subsection(std::string_view name) {
  page_ += fmt::format(".SS {}\n", roff_text(name));
  fresh_ = true;
}

void Roff::text(std::string_view words) {
  new_paragraph();
  line(words);
}

void Roff::block(std::string_view lines) {
  if (!fresh_) page_ += ".PP\n";
  fresh_ = false;
  page_ += ".RS 4\n.nf\n";
  while (!lines.empty()) {
    const auto end = lines.find('\n');
    line(lines.substr(0, end));
    lines.remove_prefix(end == std::string_view::npos ? lines.size() : end + 1);
  }
  page_ += ".fi\n.RE\n";
}

void Roff::mixed(std::string_view lines) {
  std::string words, kept;
  const auto write = [&] {
    if (!words.empty()) text(words);
    if (!kept.empty()) block(kept);
    words.clear();
    kept.clear();
  };
  while (!lines.empty()) {
    const auto end = lines.find('\n');
    auto one = lines.substr(0, end);
    lines.remove_prefix(end == std::string_view::npos ? lines.size() : end + 1);
    if (one.starts_with(' ')) {
      one.remove_prefix(one.starts_with("    ") ? 4 : 2);
      kept += fmt::format("{}\n", one);
      continue;
    }
    if (!kept.empty()) write();
    words += fmt::format("{}{}", words.empty() ? "" : " ", one);
  }
  write();
}

void Roff::entry(std::string_view name, std::string_view value, std::string_view words) {
  page_ += fmt::format(".TP\n\\fB{}\\fR", roff_text(name));
  if (!value.empty()) page_ += fmt::format(" \\fI{}\\fR", roff_text(value));
  page_ += '\n';
  line(words);
  fresh_ = false;
}

void Roff::title_line(std::string_view name, std::string_view words) {
  page_ += fmt::format("{} \\- {}\n", roff_text(name), roff_text(words));
}

void Roff::synopsis(std::string_view command, std::string_view arguments) {
  page_ += fmt::format("\\fB{}\\fR {}\n", roff_text(command), roff_text(arguments));
}

}  // namespace parallax::tools
