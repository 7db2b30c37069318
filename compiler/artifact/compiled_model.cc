#include "compiler/artifact/compiled_model.h"

#include <tuple>

namespace parallax::compiler {
namespace {
constexpr Timepoint kRigid = -1;  // sorts before every timepoint
}

AtomIndex::AtomIndex(const CompiledModel& model) {
  for (std::size_t i = 0; i < model.atoms.size(); ++i) {
    const auto& atom = model.atoms[i];
    variables_.emplace(std::tuple(atom.kind, atom.time.value_or(kRigid), atom.name),
                       static_cast<std::int32_t>(i + 1));
  }
}

std::optional<Literal> AtomIndex::find(AtomKind kind, std::string_view name,
                                       std::optional<Timepoint> time) const {
  const auto found = variables_.find(std::tuple(kind, time.value_or(kRigid), std::string(name)));
  if (found == variables_.end()) return std::nullopt;
  return Literal::positive(found->second);
}

}  // namespace parallax::compiler
