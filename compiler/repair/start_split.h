#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "compiler/base/source_file.h"
#include "compiler/repair/axiom_form.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// A fluent that says how a thing began, and that no event changes: one half of what the model took
/// for one start.
struct StartFluent {
  std::string name;      // "FarX"
  std::string sort;      // of its argument; empty: it has none
  std::string constant;  // the only one that it can hold for
  std::string means;     // what its line in the model says

  std::string ground() const { return name + "(" + constant + ")"; }
};

/// `wanted`, with a digit where the model has the name.
std::string unused_symbol(const TypedModel& typed, const std::string& wanted);

/// Its declaration, behind the last fluent of the model. With nothing else changed the model says
/// the same as before of each half.
TextChange declare(const StartFluent& fluent, const ModelAst& model, const TypedModel& typed,
                   const base::SourceFiles& files);

/// An event in the part of the starts where all fluents hold, and what was seen behind it in each
/// run, as far as the model says otherwise.
struct PartStep {
  std::string event;  // "Go(bTable)"
  std::vector<std::map<std::string, bool>> differing;
};

/// What the event does in the part, told by what was seen there: effects that never came are
/// confined to the rest, those that came at times are open, others are new.
struct PartEffects {
  std::vector<TextChange> changes;
  std::vector<std::string> not_there;  // heads of axioms that the part is taken out of
  std::vector<std::string> open, added;
};
PartEffects effects_in_part(const ModelAst& model, const TypedModel& typed,
                            const base::SourceFiles& files, const std::vector<AxiomForm>& forms,
                            const std::vector<StartFluent>& part, const PartStep& step);

}  // namespace parallax::compiler
