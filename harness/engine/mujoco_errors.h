#pragma once

namespace parallax::harness {

/// The engine's error handler. It must not return, and an exception must not cross the engine's C
/// frames, so it jumps back to the `ask_engine` around the call. Without one the process ends with
/// the engine's message.
[[noreturn]] void leave_engine(const char* text);

/// Calls `call(what)`. Throws EngineFault where the engine reported an error.
void ask_engine(void (*call)(const void*) noexcept, const void* what);

/// Calls the engine. Throws EngineFault, from outside of the engine, where it reported an error;
/// its data are then unusable until they are reset. Our code in `call` and in the engine's hooks
/// holds only trivially destructible objects where it calls the engine, since no destructor runs.
template <typename Call>
void ask_engine(const Call& call) {
  ask_engine([](const void* what) noexcept { (*static_cast<const Call*>(what))(); }, &call);
}

}  // namespace parallax::harness
