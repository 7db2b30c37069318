#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace parallax::harness {

// Names of files in files of strangers.

/// A way down from a folder: plain names, no `..`, nothing hidden, no other scheme.
bool is_plain_path(const std::string& path);

/// A file or folder in a package or model, named `model://NAME/REST`, `package://NAME/REST` or by
/// its address at a server of Fuel, `https://HOST/1.0/OWNER/models/NAME/VERSION/files/REST`.
struct PackagePart {
  std::string name, rest;
};
std::optional<PackagePart> package_part(const std::string& uri);

/// A folder where such a part may lie.
struct PackagePlace {
  std::filesystem::path root, package;  // the folder that bounds it, that of the package
};
/// Those of a package, in order: below each folder of packages, then the folder given for it.
std::vector<PackagePlace> package_places(
    const std::string& package, const std::vector<std::filesystem::path>& folders,
    const std::map<std::string, std::filesystem::path>& packages);

/// Is anything on the way from `root` down to `path` a link? Links could lead out.
bool leads_through_link(const std::filesystem::path& root, const std::filesystem::path& path);

/// Reads all bytes of a regular file. Returns the fault if that fails: "there is no regular file
/// `x`".
std::optional<std::string> read_bounded(const std::filesystem::path& path, std::size_t most_bytes,
                                        std::string& bytes);

}  // namespace parallax::harness
