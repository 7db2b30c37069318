#pragma once

#include <map>
#include <string>
#include <vector>

#include "compiler/base/source_file.h"
#include "compiler/repair/axiom_form.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// A fluent that tells how a thing began and that no event changes: one half of a start that the
/// model took for a single one.
struct StartFluent {
  std::string name;      // "FarX"
  std::string sort;      // of its argument; empty: it has none
  std::string constant;  // the only one that it can hold for
  std::string means;     // explanation in its line of the model

  std::string ground() const { return name + "(" + constant + ")"; }
};

/// `wanted`, with a digit where the model has the name.
std::string unused_symbol(const TypedModel& typed, const std::string& wanted);

/// Declaration of the fluent, after the last fluent of the model. With nothing else changed the
/// model says the same as before about each half.
TextChange declare(const StartFluent& fluent, const ModelAst& model, const TypedModel& typed,
                   const base::SourceFiles& files);

/// An event in the part of the starts where all fluents hold, and the observations behind it in
/// each run that differ from the model.
struct PartStep {
  std::string event;  // "Go(bTable)"
  std::vector<std::map<std::string, bool>> differing;
};

/// Effects of the event in the part, derived from the observations there: effects that never came
/// are confined to the rest, those that came at times are left open, others are new.
struct PartEffects {
  std::vector<TextChange> changes;
  std::vector<std::string> not_there;  // heads of axioms that the part is taken out of
  std::vector<std::string> open, added;
};
PartEffects effects_in_part(const ModelAst& model, const TypedModel& typed,
                            const base::SourceFiles& files, const std::vector<AxiomForm>& forms,
                            const std::vector<StartFluent>& part, const PartStep& step);

}  // namespace parallax::compiler
