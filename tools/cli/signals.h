#pragma once

#include <atomic>

namespace parallax::tools {

/// Raised by SIGINT, SIGTERM and the time limit; whoever works in a loop looks at it.
std::atomic<bool>& stop_flag();
/// Installs the handlers. A second signal ends the program at once.
void install_signal_handlers();
/// 130 or 143 after a signal, else 0.
int signal_exit_code();

}  // namespace parallax::tools
