#include "tools/app/formula_argument.h"

#include "compiler/base/diagnostic_codes.h"
#include "compiler/syntax/lexer.h"

namespace parallax::tools {

base::Result<base::SourceRange> formula_argument(const std::string& option, const std::string& text,
                                                 Context& context) {
  using compiler::Lexer;
  auto& files = context.files();
  const auto file = files.add(option, text);
  const base::SourceRange range{file, 0, static_cast<std::uint32_t>(text.size())};
  base::DiagnosticSink unread;  // whoever parses the formula reports what is wrong with it
  const Lexer lexer(range, files[file].text(), Lexer::Mode::kFormulaOnly, unread);
  if (lexer.peek().kind == compiler::TokenKind::kEnd && unread.error_count() == 0) {
    return context.sink().error_about(base::DiagnosticCode::kUsage, option, "the formula is empty");
  }
  return range;
}

}  // namespace parallax::tools
