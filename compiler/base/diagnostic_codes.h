#pragma once

#include "compiler/base/diagnostic.h"

namespace parallax::base {

/// One enumerator for each line of diagnostic_codes.def.
enum class DiagnosticCode : std::uint16_t {
#define PARALLAX_DIAGNOSTIC(name, code, severity, klass, format, help) name,
#include "compiler/base/diagnostic_codes.def"
#undef PARALLAX_DIAGNOSTIC
};

}  // namespace parallax::base
