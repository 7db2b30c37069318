#include "tests/tools/cli_fixture.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace parallax::test {
namespace fs = std::filesystem;

namespace {

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

}  // namespace

CliFixture::CliFixture() {
  std::string name = (fs::temp_directory_path() / "parallax_cli_XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp");
  folder_ = name;
  fs::copy(fs::path(PARALLAX_SOURCE_DIR) / "scenarios" / "two_regions", folder_,
           fs::copy_options::recursive);
}

CliFixture::~CliFixture() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

ProcessResult CliFixture::parallax(std::vector<std::string> arguments,
                                   ProcessOptions options) const {
  arguments.insert(arguments.begin(), program());
  if (options.folder.empty()) options.folder = folder_.string();
  return run_process(arguments, options);
}

std::string CliFixture::program() { return std::string(PARALLAX_BINARY_DIR) + "/parallax"; }

void CliFixture::write(const std::string& name, const std::string& text) const {
  std::ofstream(folder_ / name, std::ios::binary) << text;
}

std::string CliFixture::read(const std::string& name) const { return content(folder_ / name); }

void CliFixture::replace(const std::string& name, const std::string& from,
                         const std::string& to) const {
  auto text = read(name);
  const auto at = text.find(from);
  if (at == std::string::npos || text.find(from, at + 1) != std::string::npos) {
    throw std::runtime_error(name + " does not hold exactly one `" + from + "`");
  }
  write(name, text.replace(at, from.size(), to));
}

std::string without_timing(std::string text) {
  static const std::regex timing("\"timing\":\\{[^}]*\\}");
  return std::regex_replace(text, timing, "\"timing\":{}");
}

std::vector<std::pair<std::string, std::string>> files_below(const fs::path& folder) {
  std::vector<std::pair<std::string, std::string>> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files.emplace_back(fs::relative(entry.path(), folder).string(), content(entry.path()));
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace parallax::test
