#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/repair/axiom_form.h"
#include "compiler/repair/edit_grammar.h"

namespace parallax::compiler {

/// Columns of a line of a model that is written anew; longer ones are broken.
inline constexpr std::size_t kLineWidth = 100;

/// Chosen edits of one model, as changes of its texts and as words. Everything referred to outlives
/// it.
class EditText {
 public:
  /// `shared`: files, by number, that a world reads as well. The first axiom of an event is not
  /// written there if the model has another file.
  EditText(const ModelAst& model, const base::SourceFiles& files,
           const std::vector<AxiomForm>& forms, const std::vector<Edit>& edits,
           std::set<std::uint32_t> shared = {})
      : model_(model), files_(files), forms_(forms), edits_(edits), shared_(std::move(shared)) {}

  /// Changes as few characters as possible; a new axiom stands after the last one of its event.
  std::vector<TextChange> changes(const std::vector<std::size_t>& chosen) const;
  /// One sentence: "`Go(base)` happens only where `Parked(left)` holds". No period.
  std::string words(const std::vector<std::size_t>& chosen) const;

 private:
  const Ast& ast(std::size_t axiom) const { return model_.ast(forms_[axiom].place); }
  std::string place(std::size_t axiom) const;
  std::string literal(const Edit& edit, std::size_t axiom) const;
  TextChange add_condition(std::size_t axiom, const std::string& condition) const;
  TextChange drop_condition(std::size_t axiom, NodeId node) const;
  TextChange drop_axiom(std::size_t axiom) const;
  TextChange add_axiom(const std::string& event, std::string text) const;
  const ModelAst::Place* last_statement(const ModelAst::Place& place) const;
  std::string new_axiom(const Edit& effect, const std::vector<std::size_t>& chosen,
                        std::size_t number, bool wrapped) const;

  const ModelAst& model_;
  const base::SourceFiles& files_;
  const std::vector<AxiomForm>& forms_;
  const std::vector<Edit>& edits_;
  const std::set<std::uint32_t> shared_;
};

/// Literals that an edit adds to the condition of one of its axioms, whose event may have other
/// arguments: one literal, or two of which one is enough. Empty: the edit adds a text.
std::vector<ConditionLiteral> literals_in(const ModelAst& model,
                                          const std::vector<AxiomForm>& forms, const Edit& edit,
                                          std::size_t axiom);
/// The same printed, in the words of one of its axioms, whose event may have other arguments.
std::string literal_in(const ModelAst& model, const std::vector<AxiomForm>& forms, const Edit& edit,
                       std::size_t axiom);

}  // namespace parallax::compiler
