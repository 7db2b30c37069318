#include "compiler/syntax/parser.h"

#include "compiler/base/diagnostic_codes.h"
#include "compiler/syntax/formula_parser.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/statement_parser.h"

namespace parallax::compiler {

using base::DiagnosticCode;

namespace {

base::SourceRange whole(base::FileId file, const base::SourceFiles& files) {
  return {file, 0, static_cast<std::uint32_t>(files[file].text().size())};
}

Word word(const Token& token) { return {token.begin, token.end}; }

/// `[LABEL:] formula.`
void parse_labelled(Ast& ast, Lexer& lexer, FormulaParser& parser) {
  Statement statement;
  statement.kind = StatementKind::kFormula;
  const Token first = lexer.peek();
  const bool may_be_label = first.kind == TokenKind::kName || first.kind == TokenKind::kNumber;
  if (may_be_label && lexer.colon_follows()) {
    statement.label = word(first);
    lexer.next();
    lexer.next();
  }
  statement.first_node = NodeId(static_cast<std::uint32_t>(ast.node_count()));
  const auto root = parser.parse(FormulaParser::Period::kRequired);
  if (!root) return;
  statement.formula = *root;
  statement.source = {first.begin, ast[*root].end};
  ast.add(statement);
}

}  // namespace

Ast parse_file(base::FileId file, const base::SourceFiles& files, base::DiagnosticSink& sink) {
  const auto text = files[file].text();
  Ast ast(file, text);
  Lexer lexer(whole(file, files), text, Lexer::Mode::kFile, sink);
  FormulaParser parser(ast, lexer, sink);
  while (lexer.peek().kind != TokenKind::kEnd) {
    if (lexer.peek().kind == TokenKind::kStatementLine) {
      parse_statement(ast, text, {lexer.peek().begin, lexer.statement_end()}, sink);
      lexer.skip_statement();
    } else {
      parse_labelled(ast, lexer, parser);
    }
  }
  return ast;
}

base::Result<ParsedFormula> parse_formula(const base::SourceRange& range,
                                          const base::SourceFiles& files,
                                          base::DiagnosticSink& sink) {
  PARALLAX_REQUIRE(range.begin <= range.end && range.end <= files[range.file].text().size(),
                   "the formula lies inside its file");
  const auto text = files[range.file].text();
  ParsedFormula parsed{Ast(range.file, text), NodeId()};
  const auto errors_before = sink.error_count();
  Lexer lexer(range, text, Lexer::Mode::kFormulaOnly, sink);
  FormulaParser parser(parsed.ast, lexer, sink);
  const auto root = parser.parse(FormulaParser::Period::kOptional);
  if (root && lexer.peek().kind != TokenKind::kEnd) {
    return sink.error(DiagnosticCode::kTextAfterFormula, lexer.range(lexer.peek()),
                      lexer.describe(lexer.peek()));
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  parsed.root = *root;
  return parsed;
}

base::Result<ParsedFormula> parse_formula(base::FileId file, const base::SourceFiles& files,
                                          base::DiagnosticSink& sink) {
  return parse_formula(whole(file, files), files, sink);
}

}  // namespace parallax::compiler
