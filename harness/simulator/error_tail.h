#pragma once

#include <string>
#include <string_view>

namespace parallax::harness {

/// "; the end of its standard error:" and the lines that another program wrote last, each behind a
/// mark, so that none reads as one of ours; empty if it wrote nothing.
std::string error_tail_words(std::string_view tail);

}  // namespace parallax::harness
