#include "harness/engine/mujoco_errors.h"

#include <unistd.h>

#include <array>
#include <csetjmp>
#include <cstdlib>
#include <string_view>

#include "harness/engine/mujoco_engine.h"

namespace parallax::harness {
namespace {

thread_local std::jmp_buf* t_back = nullptr;
thread_local std::array<char, 1024> t_error;

}  // namespace

void leave_engine(const char* text) {
  const std::string_view words(text);
  if (t_back == nullptr) {
    // No exception may leave the C frames, and no message has anybody to take it.
    for (const auto part :
         {std::string_view("parallax: MuJoCo failed: "), words, std::string_view("\n")}) {
      if (::write(STDERR_FILENO, part.data(), part.size()) < 0) break;
    }
    std::abort();
  }
  const auto length = words.copy(t_error.data(), t_error.size() - 1);
  t_error[length] = '\0';
  std::longjmp(*t_back, 1);
}

void ask_engine(void (*call)(const void*) noexcept, const void* what) {
  std::jmp_buf here;
  std::jmp_buf* const before = t_back;
  t_back = &here;
  if (setjmp(here) == 0) {
    call(what);
    t_back = before;
    return;
  }
  t_back = before;
  throw EngineFault(t_error.data());
}

}  // namespace parallax::harness
