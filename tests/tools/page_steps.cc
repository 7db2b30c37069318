#include "tests/tools/page_steps.h"

#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tests/tools/rounded.h"

namespace parallax::test {
namespace {

/// What comments say of the next block.
struct Remarks {
  int exit_code = -1;
  std::string not_run;
};

class PageReader {
 public:
  explicit PageReader(std::istream& in) : in_(in) {}

  std::vector<PageStep> read() {
    std::string line;
    while (next(line)) {
      if (line.empty()) {
        ++empty_;
      } else if (line.starts_with("<!-- ")) {
        comment(line);
      } else if (line.starts_with("    ")) {
        block_line(line.substr(4));
      } else {
        // A paragraph ends a block, and what was said of it.
        if (std::exchange(inside_, false)) remarks_ = {};
        text_ = line;
      }
    }
    return std::move(steps_);
  }

 private:
  bool next(std::string& line) {
    ++number_;
    return static_cast<bool>(std::getline(in_, line));
  }

  void comment(const std::string& line) {
    static const std::regex remark("<!-- (not run: .+|run by [a-z_]+|exit code [0-9]+) -->");
    static const std::regex file("<!-- file ([^ ]+)");
    if (std::exchange(inside_, false)) remarks_ = {};
    std::smatch part;
    if (std::regex_match(line, part, file)) {
      steps_.push_back({.file = part[1], .line = number_});
      for (std::string text; next(text) && text != "-->";) steps_.back().lines.push_back(text);
    } else if (std::regex_match(line, part, remark)) {
      const std::string said = part[1];
      if (said.starts_with("exit code ")) {
        remarks_.exit_code = std::stoi(said.substr(10));
      } else {
        remarks_.not_run = said;
      }
    }
  }

  void block_line(std::string line) {
    static const std::regex saved("[Ss]ave this as `([^`]+)`:$");
    const bool first = !std::exchange(inside_, true);
    if (first) {
      empty_ = 0;
      takes_output_ = false;
    }
    std::smatch name;
    if (first && std::regex_search(text_, name, saved)) {
      steps_.push_back({.file = name[1], .line = number_});
      takes_output_ = true;
    } else if (line.starts_with("$ ")) {
      PageStep step{.command = line.substr(2),
                    .exit_code = remarks_.exit_code,
                    .not_run = remarks_.not_run,
                    .line = number_};
      while (step.command.ends_with('\\') && next(line)) step.command += '\n' + line;
      steps_.push_back(std::move(step));
      takes_output_ = true;
      empty_ = 0;
      return;
    }
    if (!takes_output_) return;  // a block without commands
    auto& lines = steps_.back().lines;
    lines.insert(lines.end(), std::exchange(empty_, 0), "");
    lines.push_back(std::move(line));
  }

  std::istream& in_;
  int number_ = 0;
  std::string text_;           // the last line of prose
  bool inside_ = false;        // a block
  bool takes_output_ = false;  // the block has a command or is a file
  std::size_t empty_ = 0;      // empty lines since its last line
  Remarks remarks_;
  std::vector<PageStep> steps_;
};

/// What is compared of a line: blanks at its end are not shown on a page.
std::string compared(const std::string& line) {
  return rounded(line.substr(0, line.find_last_not_of(' ') + 1));
}

bool fits_from(const std::vector<std::string>& shown, std::size_t s,
               const std::vector<std::string>& printed, std::size_t p) {
  for (; s < shown.size(); ++s, ++p) {
    if (shown[s].ends_with("...") && shown[s].find_first_not_of(" .") == std::string::npos) {
      for (auto next = p; next <= printed.size(); ++next) {
        if (fits_from(shown, s + 1, printed, next)) return true;
      }
      return false;
    }
    if (p == printed.size() || compared(shown[s]) != compared(printed[p])) return false;
  }
  return p == printed.size();
}

}  // namespace

std::vector<PageStep> page_steps(const std::string& page) {
  std::ifstream in(std::string(PARALLAX_SOURCE_DIR) + "/docs/" + page);
  if (!in) throw std::runtime_error("no page docs/" + page);
  return PageReader(in).read();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

bool fits(const std::vector<std::string>& shown, const std::vector<std::string>& printed) {
  return fits_from(shown, 0, printed, 0);
}

}  // namespace parallax::test
