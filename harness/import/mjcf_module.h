#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "harness/import/mjcf_model.h"

namespace parallax::harness {

// MuJoCo's reader is in a module that is loaded where a world in MJCF is read, as the reader of SDF
// is (sdf_module.h).

inline constexpr const char* kMjcfModule = "parallax_mjcf.so";
inline constexpr const char* kMjcfReader = "parallax_read_mjcf";

/// A file as the reader gets it: it sees these, and opens none.
struct MjcfFile {
  std::string name;
  std::string bytes;
};

/// The module's only function: the world is in the first of the files. False, and nothing done,
/// where `version` is not its own. It changes what MuJoCo does with its errors, so it is called in
/// a process that does nothing else.
using ReadMjcf = bool(const char* version, const std::vector<MjcfFile>& files, MjcfModel& model);

/// Reads MJCF with the module, in a process with limits (limited_child.h).
MjcfModel read_mjcf(const std::vector<MjcfFile>& files, const std::atomic<bool>* stop = nullptr);

}  // namespace parallax::harness
