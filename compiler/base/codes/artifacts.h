#pragma once

#include "compiler/base/diagnostic_code.h"

namespace parallax::codes {

#define PARALLAX_DIAGNOSTIC(name, id, severity, klass, format, help) \
  inline constexpr base::DiagnosticCode name = base::code_of(id);
#include "compiler/base/codes/artifacts.def"
#undef PARALLAX_DIAGNOSTIC

}  // namespace parallax::codes
