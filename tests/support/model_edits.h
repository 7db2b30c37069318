#pragma once

#include <string>

#include "tests/support/random_model.h"

namespace parallax::test {

/// The same model written differently: bound variables renamed, the variables of quantifiers, the
/// operands of `&`, `|` and `<->` and the formulas in another order, some formulas twice.
RandomModel rewritten(RandomModel model, FuzzRandom& random);

/// The model with one formula changed, dropped or added, as an author would: an operand dropped, a
/// negation put in or taken out, a connective or a number changed, two parts exchanged, one fluent
/// or event for another. Declarations stay; the result may be refused.
RandomModel edited(RandomModel model, FuzzRandom& random);

}  // namespace parallax::test
