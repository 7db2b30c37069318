#include "harness/import/sdf_includes.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "harness/import/plain_path.h"

namespace parallax::harness {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxIncluded = 500;

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == text.npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1));
}

}  // namespace

std::optional<TextFault> IncludeGate::check(const XmlOutline& outline,
                                            std::vector<std::string>& around) {
  elements_ += outline.elements.size();
  parts_ += static_cast<std::size_t>(
      std::count_if(outline.elements.begin(), outline.elements.end(), &is_part));
  if (elements_ > kMaxImportElements || parts_ > kMaxImportParts) {
    return TextFault{0, fmt::format("what is included comes to more than {} elements, or to more "
                                    "than {} models, links, joints and frames",
                                    kMaxImportElements, kMaxImportParts)};
  }
  for (const XmlElement& element : outline.elements) {
    if (element.tag != "uri" || !element.parent) continue;
    if (outline.elements[*element.parent].tag != "include") continue;
    if (around.empty()) here_ = element.offset;
    if (auto message = follow(trimmed(element.text), around)) {
      return TextFault{element.offset, *std::move(message)};
    }
  }
  return std::nullopt;
}

std::optional<std::string> IncludeGate::follow(const std::string& uri,
                                               std::vector<std::string>& around) {
  const auto shown = uri.substr(0, 120);
  const auto part = package_part(uri);
  if (!part || !is_plain_path(part->name) || !(part->rest.empty() || is_plain_path(part->rest))) {
    return fmt::format(
        "`{}` is not included: only `model://NAME`, `package://NAME` and addresses "
        "of Fuel are, without `..`",
        shown);
  }
  for (const auto& [root, package] : package_places(part->name, folders_, packages_)) {
    const fs::path there = part->rest.empty() ? package : package / part->rest;
    if (!exists(there)) continue;
    std::error_code error;
    if (leads_through_link(root, there)) return fmt::format("`{}` leads through a link", shown);
    if (root == package || !uri.starts_with("model://")) {
      addresses_[uri.substr(0, uri.size() - part->rest.size())] = package;
    }
    return fs::is_directory(there, error) ? check_folder(there, shown, around)
                                          : check_file(there, shown, around);
  }
  return fmt::format("`{}` is in none of the folders under `models` and `packages`", shown);
}

std::optional<std::string> IncludeGate::check_folder(const fs::path& folder, const std::string& uri,
                                                     std::vector<std::string>& around) {
  for (const char* const name : {"model.config", "manifest.xml"}) {
    const fs::path manifest = folder / name;
    if (!exists(manifest)) continue;
    std::string text;
    if (auto message = read(manifest, text)) return message;
    const XmlOutline outline = outline_of(text);
    if (outline.fault) return fmt::format("{} of `{}`: {}", name, uri, outline.fault->message);
    bool any = false;
    for (const XmlElement& element : outline.elements) {
      if (element.tag != "sdf") continue;
      const std::string file = trimmed(element.text);
      if (!is_plain_path(file) || file.find('/') != file.npos) {
        return fmt::format("{} of `{}` names no file of its folder", name, uri);
      }
      any = true;
      if (auto message = check_file(folder / file, uri, around)) return message;
    }
    if (!any) return fmt::format("{} of `{}` names no SDF file", name, uri);
    return std::nullopt;
  }
  return fmt::format("`{}` has no model.config", uri);
}

std::optional<std::string> IncludeGate::check_file(const fs::path& path, const std::string& uri,
                                                   std::vector<std::string>& around) {
  const std::string key = path.lexically_normal().string();
  if (std::find(around.begin(), around.end(), key) != around.end()) {
    return fmt::format("`{}` includes itself", uri);
  }
  if (++followed_ > kMaxIncluded) {
    return fmt::format("more than {} models are included", kMaxIncluded);
  }
  std::string text;
  if (auto message = read(path, text)) return message;
  const XmlOutline outline = outline_of(text);
  if (outline.fault) return fmt::format("`{}`: {}", uri, outline.fault->message);
  texts_.emplace(text, here_);
  around.push_back(key);
  const auto fault = check(outline, around);
  around.pop_back();
  if (fault) return fmt::format("in `{}`: {}", uri, fault->message);
  return std::nullopt;
}

bool IncludeGate::exists(const fs::path& path) {
  std::error_code error;
  if (fs::exists(fs::symlink_status(path, error))) return true;
  absent_.insert(path.lexically_normal().string());
  return false;
}

std::optional<std::string> IncludeGate::read(const fs::path& path, std::string& text) {
  if (auto message = read_bounded(path, kMaxImportBytes, text)) return message;
  files_.insert(path.string());
  return std::nullopt;
}

}  // namespace parallax::harness
