#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/import/xml_outline.h"

namespace parallax::harness {

/// Looks at every file that the library would open, before it does: those that `<include>` names,
/// and what these name in turn.
class IncludeGate {
 public:
  using Packages = std::map<std::string, std::filesystem::path>;
  IncludeGate(const std::vector<std::filesystem::path>& folders, const Packages& packages)
      : folders_(folders), packages_(packages) {}

  std::optional<TextFault> check(const XmlOutline& outline) {
    std::vector<std::string> around;
    return check(outline, around);
  }
  std::vector<std::string> files() const { return {files_.begin(), files_.end()}; }
  std::vector<std::string> absent() const { return {absent_.begin(), absent_.end()}; }
  /// How the addresses that no folder answers to begin, and the folder in place of that.
  const std::map<std::string, std::filesystem::path>& addresses() const { return addresses_; }
  /// The descriptions that are included, each with where the file itself begins to include it.
  const std::map<std::string, std::size_t>& texts() const { return texts_; }

 private:
  std::optional<TextFault> check(const XmlOutline& outline, std::vector<std::string>& around);
  std::optional<std::string> follow(const std::string& uri, std::vector<std::string>& around);
  std::optional<std::string> check_folder(const std::filesystem::path& folder,
                                          const std::string& uri, std::vector<std::string>& around);
  std::optional<std::string> check_file(const std::filesystem::path& path, const std::string& uri,
                                        std::vector<std::string>& around);
  bool exists(const std::filesystem::path& path);
  std::optional<std::string> read(const std::filesystem::path& path, std::string& text);

  const std::vector<std::filesystem::path>& folders_;
  const Packages& packages_;
  std::map<std::string, std::filesystem::path> addresses_;
  std::set<std::string> files_, absent_;
  std::map<std::string, std::size_t> texts_;
  std::size_t here_ = 0;                                 // the outermost include
  std::size_t followed_ = 0, elements_ = 0, parts_ = 0;  // of all files together
};

}  // namespace parallax::harness
