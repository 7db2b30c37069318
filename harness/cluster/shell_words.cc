#include "harness/cluster/shell_words.h"

#include <optional>

namespace parallax::harness {
namespace {

constexpr std::string_view kBlanks = " \t\n\r";
constexpr std::string_view kOfShell = "|&;<>()$`*?[";  // unquoted, a shell acts on them
constexpr std::string_view kOfShellInFront = "~#";     // likewise, where a word begins
constexpr std::string_view kEscapedInQuotes = "$`\"\\";

bool is_one_of(char c, std::string_view set) { return set.find(c) != std::string_view::npos; }

/// Reads a text from the left.
class Splitter {
 public:
  explicit Splitter(std::string_view text) : text_(text) {}

  ShellWords split() {
    while (at_ < text_.size() && out_.fault.empty()) next();
    end_word();
    return std::move(out_);
  }

 private:
  void next() {
    const char c = text_[at_];
    if (is_one_of(c, kBlanks)) {
      end_word();
      ++at_;
    } else if (c == '\'') {
      single_quotes();
    } else if (c == '"') {
      double_quotes();
    } else if (c == '\\') {
      escape();
    } else if (is_one_of(c, kOfShell) || (!word_ && is_one_of(c, kOfShellInFront))) {
      fail(at_, std::string("`") + c + "` means something to a shell, and there is none here");
    } else {
      word() += c;
      ++at_;
    }
  }

  void single_quotes() {
    const auto end = text_.find('\'', at_ + 1);
    if (end == std::string_view::npos) return fail(at_, "the quote is not closed");
    word() += text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
  }

  void double_quotes() {
    const auto begin = at_++;
    word();
    while (at_ < text_.size() && text_[at_] != '"') {
      if (text_[at_] == '$' || text_[at_] == '`') {
        return fail(at_, std::string("`") + text_[at_] +
                             "` means something to a shell in these quotes, and there is none "
                             "here; use single quotes");
      }
      const bool escaped = text_[at_] == '\\' && at_ + 1 < text_.size() &&
                           is_one_of(text_[at_ + 1], kEscapedInQuotes);
      if (escaped) ++at_;
      word() += text_[at_++];
    }
    if (at_ == text_.size()) return fail(begin, "the quote is not closed");
    ++at_;
  }

  void escape() {
    if (at_ + 1 == text_.size()) return fail(at_, "nothing follows the backslash");
    word() += text_[at_ + 1];
    at_ += 2;
  }

  std::string& word() {
    if (!word_) word_.emplace();
    return *word_;
  }
  void end_word() {
    if (word_) out_.words.push_back(*std::move(word_));
    word_.reset();
  }
  void fail(std::size_t at, std::string why) {
    out_.fault = std::move(why);
    out_.fault_at = at;
    word_.reset();
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::optional<std::string> word_;
  ShellWords out_;
};

}  // namespace

ShellWords split_shell_words(std::string_view text) { return Splitter(text).split(); }

}  // namespace parallax::harness
