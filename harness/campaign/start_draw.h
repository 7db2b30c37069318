#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "compiler/artifact/symbol_table.h"

namespace parallax::harness {

/// An initial state: its true fluents, ascending.
using FluentSet = std::vector<compiler::FluentId>;

/// The number, from 1, of the one of `states` initial states whose share of the unit interval has
/// `u`: by these weights, or in equal parts if there are none.
std::int64_t state_at(double u, std::size_t states, std::span<const double> weights);

/// The fluents that are true in each of the states.
FluentSet common_fluents(std::span<const FluentSet> states);
/// The true fluents of a state without the common ones, sorted by name: "TrolleyAt(onWay)".
std::string state_text(const FluentSet& state, const FluentSet& common,
                       const compiler::SymbolTable& symbols);

}  // namespace parallax::harness
