#include "harness/engine/mujoco_errors.h"

#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>

#include "harness/engine/mujoco_engine.h"

namespace parallax::harness {
namespace {

thread_local std::jmp_buf* t_back = nullptr;
thread_local std::array<char, 1024> t_error;

}  // namespace

void leave_engine(const char* text) {
  if (t_back == nullptr) {
    std::fprintf(stderr, "parallax: MuJoCo failed: %s\n", text);
    std::abort();
  }
  std::snprintf(t_error.data(), t_error.size(), "%s", text);
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
