#pragma once

#include <string>

namespace parallax::harness {

/// Sixteen hexadecimal digits that tell processors apart on which one program gives other results:
/// a hash of what functions of the mathematical library return for fixed arguments. The library
/// chooses an implementation by what the processor has (AVX2, FMA), and they differ in last digits,
/// which a simulation with contacts makes large.
std::string arithmetic_digits();

}  // namespace parallax::harness
