#include "tools/cli/sample_option.h"

#include <fmt/format.h>

#include "compiler/base/diagnostic_codes.h"

namespace parallax::tools {

base::Result<std::optional<harness::SampleId>> parse_sample_option(const std::string& text,
                                                                   base::DiagnosticSink& sink) {
  if (text.empty()) return std::optional<harness::SampleId>();
  const auto id = harness::parse_sample_id(text);
  if (id) return id;
  return sink.error_about(base::DiagnosticCode::kUsage, "",
                          fmt::format("--sample takes TRACE.SAMPLE such as 2.4, not `{}`", text));
}

}  // namespace parallax::tools
