#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/lisp/lisp_data.h"
#include "compiler/plan/failure_classes.h"

namespace parallax::compiler {

/// A structure or class of the plan as the functions that it stands for.
struct PlanStructure {
  std::string name;
  std::vector<std::string> types;  // its own name, then those that it includes
  struct Slot {
    std::string name;
    std::optional<DatumId> initial;
    std::string keyword;  // that gives it to the maker; empty: none
  };
  std::vector<Slot> slots;         // inherited ones first
  std::vector<DatumId> functions;  // (defun name parameters form...): maker, accessors, tests
  std::vector<std::pair<std::string, std::string>>
      accessors;  // with the `type slot` that each sets
};

/// Reads a `defstruct` or `defclass`; `known` are those above it. The functions are added to the
/// data. A text: what is wrong with it.
struct StructureError {
  DatumId at;
  std::string text;
};
std::optional<StructureError> read_structure(LispData& data, DatumId form,
                                             const std::vector<PlanStructure>& known,
                                             PlanStructure& out);

/// Those that a `defgeneric` writes out, each as a `defmethod`.
std::vector<DatumId> methods_of_generic(LispData& data, DatumId form);

/// The type whose making a `defmethod` of `initialize-instance` or its like changes; else none.
std::optional<std::string> type_it_makes(const LispData& data, DatumId form);

/// Reads the methods of one generic function, `(defmethod name (parameter or (parameter type)...)
/// form...)`, as one function: the first method whose types fit, the most special ones first. A
/// method without fit is a Lisp error.
std::optional<StructureError> read_methods(LispData& data, const std::vector<DatumId>& methods,
                                           const std::vector<PlanStructure>& known,
                                           const FailureClasses& classes, DatumId& out);

}  // namespace parallax::compiler
