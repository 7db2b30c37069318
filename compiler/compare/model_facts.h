#pragma once

#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/source_file.h"
#include "compiler/compare/fact.h"
#include "compiler/syntax/ast.h"
#include "compiler/syntax/loader.h"

namespace parallax::compiler {

/// Facts of one text: one for every sort, constant, symbol, option and so on, and one for every
/// formula. A `load` is a fact of its own. In the order of the text.
std::vector<Fact> text_facts(const Ast& ast, const base::SourceFiles& files);

/// The same for a whole model: the facts of all its files. Each built-in foundation is a single
/// fact, its name.
std::vector<Fact> model_facts(const ModelAst& model, const base::SourceFiles& files);

/// The facts one a line, declarations first, each group sorted by bytes, no line twice.
std::string canonical_text(const std::vector<Fact>& facts);

/// Facts of a compiled model, without its numbering: options, horizon, ground fluents and events,
/// and the axioms with the number of clauses made from each. Places are those of the texts.
std::vector<Fact> artifact_facts(const CompiledModel& model);

}  // namespace parallax::compiler
