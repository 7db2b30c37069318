#pragma once

#include <string>

#include "compiler/artifact/compiled_model.h"

namespace parallax::tools {

/// `domain.e:14`; empty for what no text says.
inline std::string place_text(const compiler::Origin& origin) {
  if (origin.place.file.empty()) return {};
  return origin.place.file + ':' + std::to_string(origin.place.begin.line);
}

/// The text of an axiom; of a frame axiom what its declaration stands for.
inline std::string axiom_text(const compiler::Origin& origin) {
  if (origin.kind == compiler::OriginKind::kFrameAxiom) return "inertia of " + origin.text;
  return origin.text.empty() ? std::string(to_string(origin.kind)) : origin.text;
}

}  // namespace parallax::tools
