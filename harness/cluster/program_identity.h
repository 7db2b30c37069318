#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::harness {

/// The identity of a program at work: two with the same identity give the same runs.
struct ProgramIdentity {
  std::string version;     // "0.2.0"
  std::string build;       // tells builds apart: a hash over `objects`
  std::string arithmetic;  // tells processors apart (arithmetic_digits); empty: it does not say
  /// The program (""), its libraries and its modules by file name, with eight digits of the number
  /// that the linker gave them. For messages; `build` says whether they differ.
  std::map<std::string, std::string> objects = {};

  /// "BUILD/ARITHMETIC": simulations of different kinds may differ in their last digits.
  std::string kind() const { return build + '/' + arithmetic; }
  friend bool operator==(const ProgramIdentity& a, const ProgramIdentity& b) {
    return a.version == b.version && a.build == b.build && a.arithmetic == b.arithmetic;
  }
};

/// The identity of this process with all that it has loaded so far: to be asked when a scenario has
/// loaded the modules that it needs. `arithmetic` as in ProgramIdentity.
ProgramIdentity this_program(std::string version, std::string arithmetic);

/// The objects that are not the same in both: "libode.so.8", "parallax_sdf.so (there only)". Empty
/// where one of the two does not say.
std::vector<std::string> differing_objects(const ProgramIdentity& there,
                                           const ProgramIdentity& here);

/// "0.2.0 (build 5f2c..., arithmetic 81d0...)".
std::string to_string(const ProgramIdentity& identity);

/// The line with which a worker says who it is, before it is asked anything.
std::string greeting_line(const ProgramIdentity& identity);
/// None for a line that is no such line.
std::optional<ProgramIdentity> parse_greeting(std::string_view line);

}  // namespace parallax::harness
