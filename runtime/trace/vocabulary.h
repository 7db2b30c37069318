#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

/// The ground atoms of one declared symbol, in declaration order.
struct SymbolInstances {
  std::string symbol;
  std::vector<std::string> atoms;  // printed
  std::vector<std::uint32_t> ids;  // of the fluent or event; of predicates the place among all
};

/// The names that traces of a model are written with.
struct Vocabulary {
  std::vector<SymbolInstances> fluents, events;
  std::vector<SymbolInstances> releasable;  // the fluents that can be released
  std::vector<SymbolInstances> predicates;  // user predicates that some formula mentions
};

Vocabulary vocabulary_of(const compiler::CompiledModel& model);

/// 16 hexadecimal digits over the texts that a model was compiled from, in the order of loading,
/// and the options that its meaning depends on; file names and the horizon do not count. FNV-1a: it
/// finds accidents, it is no protection against forgery.
std::string model_hash(const compiler::CompiledModel& model);

}  // namespace parallax::runtime
