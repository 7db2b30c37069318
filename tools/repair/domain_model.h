#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/repair/axiom_form.h"
#include "compiler/sema/typed_model.h"
#include "harness/config/scenario.h"
#include "tools/app/context.h"

namespace parallax::tools {

/// The texts of a scenario's model, parsed and checked, as the basis of edits.
struct DomainModel {
  base::SourceFiles files;  // of the model alone; the rest refers to it
  compiler::ModelAst ast;
  std::optional<compiler::TypedModel> typed;
  std::vector<compiler::AxiomForm> forms;
};
/// None where the texts are not a valid model any more; that was reported when the scenario was
/// loaded.
std::unique_ptr<DomainModel> load_domain(const harness::Scenario& scenario, const Context& context);

/// The same of a text. None: it is not a valid model.
std::unique_ptr<DomainModel> domain_of_text(const std::string& text);

/// Compiles the model in a text, without plan and constraints, for this horizon. None: it is not a
/// valid model; `why` is then the first error.
std::optional<compiler::CompiledModel> compile_text(const std::string& text, std::int64_t horizon,
                                                    const Context& context, std::string& why);

}  // namespace parallax::tools
