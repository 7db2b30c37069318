#pragma once

#include <string>
#include <vector>

namespace parallax::test {

/// One step of a page of the documentation: a file to write, or a command with the lines below it.
struct PageStep {
  std::string file = {};
  std::string command = {};
  std::vector<std::string> lines = {};
  int exit_code = -1;        // as the page says; -1: 0 or 1
  std::string not_run = {};  // why the command is not run here, or which test runs it
  int line = 0;              // of the page, from 1
};

/// The steps of docs/PAGE, in their order. Blocks are indented by four blanks.
///
/// A block is a file's content if the paragraph above it ends with "Save this as `NAME`:". In other
/// blocks `$ ` begins a command, which a backslash at the end of the line continues; the lines up
/// to the next command are what it prints. Comments that no reader sees say more, of the next
/// block:
///
///     <!-- not run: REASON -->      its commands are left out
///     <!-- run by NAME_test -->     likewise; another test runs them
///     <!-- exit code 3 -->          how its commands end
///     <!-- file NAME
///     ...                           a file that the commands need and the page does not show
///     -->
std::vector<PageStep> page_steps(const std::string& page);

std::vector<std::string> lines_of(const std::string& text);

/// Whether the printed lines are those shown, where `...` stands for any lines, and the last digits
/// of decimal numbers do not count.
bool fits(const std::vector<std::string>& shown, const std::vector<std::string>& printed);

}  // namespace parallax::test
