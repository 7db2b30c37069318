#include "tools/page/markup.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compiler/base/ascii.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/json.h"
#include "compiler/base/utf8.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kLongestName = 300;

constexpr std::array<std::string_view, 35> kModelWords = {
    "sort",       "fluent",     "event",          "predicate", "function",   "range",
    "option",     "completion", "noninertial",    "xor",       "mutex",      "load",
    "reified",    "HoldsAt",    "Happens",        "Initiates", "Terminates", "Releases",
    "ReleasedAt", "Trajectory", "AntiTrajectory", "Started",   "Stopped",    "Clipped",
    "Declipped",  "true",       "false",          "agent",     "integer",    "boolean",
    "predicates", "fluents",    "events",         "import",    "minimize"};
constexpr std::array<std::string_view, 30> kPlanWords = {"def-cram-function",
                                                         "defun",
                                                         "defparameter",
                                                         "defmacro",
                                                         "let",
                                                         "let*",
                                                         "if",
                                                         "when",
                                                         "unless",
                                                         "cond",
                                                         "case",
                                                         "dolist",
                                                         "dotimes",
                                                         "loop",
                                                         "progn",
                                                         "return",
                                                         "return-from",
                                                         "perform",
                                                         "exe:perform",
                                                         "seq",
                                                         "par",
                                                         "try-in-order",
                                                         "with-failure-handling",
                                                         "cpl:with-failure-handling",
                                                         "cpl:fail",
                                                         "fail",
                                                         "retry",
                                                         "with-retry-counters",
                                                         "cpl:with-retry-counters",
                                                         "a"};

bool is_word(char c) {
  return base::is_letter(c) || base::is_digit(c) || c == '_' || c == '-' || c == '*' || c == ':' ||
         c == '?' || static_cast<unsigned char>(c) >= 0x80U;
}

template <typename Words>
bool is_one_of(const Words& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string marked(char kind, std::string_view text) {
  return fmt::format("<b class=\"s{}\">{}</b>", kind, html(text));
}

}  // namespace

std::string html(std::string_view text) {
  std::string out;
  for (const char c : base::printable(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string html_words(std::string_view text) {
  constexpr std::size_t kLongest = 8000;
  if (text.size() > kLongest) return html_short(text);
  std::string out;
  for (;;) {
    const auto begin = text.find('`');
    const auto end = begin == std::string_view::npos ? begin : text.find('`', begin + 1);
    out += html(text.substr(0, end == std::string_view::npos ? end : begin));
    if (end == std::string_view::npos) return out;
    out += "<code>" + html(text.substr(begin + 1, end - begin - 1)) + "</code>";
    text.remove_prefix(end + 1);
  }
}

std::string html_lines(std::string_view text) {
  std::string out;
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = std::min(text.find('\n', begin), text.size());
    out += html(text.substr(begin, end - begin)) + '\n';
    begin = end + 1;
  }
  return out;
}

std::string html_short(std::string_view text) {
  if (text.size() <= kLongestName) return html(text);
  auto cut = kLongestName - 100;
  while (cut > 0 && base::continues_code_point(text[cut])) --cut;
  return html(text.substr(0, cut)) + fmt::format("&hellip; ({} bytes)", text.size());
}

std::string number(double value, int digits) {
  if (!std::isfinite(value)) return "?";
  if (value == 0.0) return "0";
  return fmt::format("{:.{}g}", value, digits);
}

std::string percent(double share) { return number(100.0 * share) + " %"; }

std::string json_word(std::string_view text) {
  std::string out;
  for (const char c : base::json_quoted(base::printable(text))) {
    if (c == '<' || c == '>' || c == '&') {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out;
}

std::string coloured(std::string_view line, std::string_view file) {
  const bool is_yaml = file.ends_with(".yaml"), is_model = file.ends_with(".e");
  const bool is_plan = file.ends_with(".lisp");
  const char comment = is_yaml ? '#' : ';';
  std::string out;
  for (std::size_t i = 0; i < line.size();) {
    const char c = line[i];
    auto end = i + 1;
    if (c == comment) {
      out += marked('c', line.substr(i));
      break;
    }
    if (c == '"') {
      while (end < line.size() && line[end] != '"') end += line[end] == '\\' ? 2 : 1;
      end = std::min(end + 1, line.size());
      out += marked('s', line.substr(i, end - i));
    } else if (is_word(c)) {
      while (end < line.size() && is_word(line[end])) ++end;
      const auto word = line.substr(i, end - i);
      const bool known = (is_model && is_one_of(kModelWords, word)) ||
                         (is_plan && is_one_of(kPlanWords, word)) ||
                         (is_yaml && word.ends_with(':'));
      out += known                                           ? marked('k', word)
             : base::is_digit(c)                             ? marked('n', word)
             : is_plan && (c == ':' || c == '?' || c == '*') ? marked('v', word)
                                                             : html(word);
    } else if (c == '\t') {
      out += "    ";
    } else {
      out += html(line.substr(i, 1));
    }
    i = end;
  }
  return out;
}

}  // namespace parallax::tools
