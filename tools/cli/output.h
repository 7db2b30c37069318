#pragma once

#include <string>

#include "compiler/base/shown_text.h"

namespace parallax::tools {

// Standard output and standard error. Nothing else in the program writes there
// (tests/tools/output_gate_test.cc): what comes from files, simulators and logs is escaped here
// (compiler/base/shown_text.h), and what could not be written is known at the end.

/// Prints at once. False if that failed, now or before.
bool print(const std::string& text, const base::LinesStyle& style = {});
/// Prints bytes for another program: a model, a proof. On a terminal as `print`.
bool print_exact(const std::string& text);
/// Prints unless another thread is printing at this moment: for a limit that ends the process.
void print_if_free(const std::string& text);

/// The `errno` of the first write that failed, 0 if none did.
int output_error();
/// Records that the user was told of it.
void output_error_is_told();
/// Ends standard output, at the end of the program. Returns `code` if all that was printed was
/// written, else tells so and returns another than 0.
int close_output(int code);

/// Writes to standard error; a stream that is closed or full loses the text, never the program.
void write_error(const std::string& text, const base::LinesStyle& style = {});
/// Replaces the last line of a terminal by this one, which stays until it is cleared.
void show_progress(const std::string& line);
void clear_progress();

}  // namespace parallax::tools
