#include "tools/cli/replaceable.h"

#include <filesystem>
#include <fstream>

#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "tools/page/write_page.h"

namespace parallax::tools {

base::Status check_replaceable(const std::string& path, bool (*is_ours)(std::string_view head),
                               const base::SourceFiles& files, base::DiagnosticSink& sink) {
  if (!base::check_output(path, files, sink)) return sink.already_reported();
  namespace fs = std::filesystem;
  std::error_code error;
  const auto status = fs::status(path, error);
  if (!fs::exists(status)) return base::Unit{};
  if (!fs::is_regular_file(status)) {
    return sink.error_about(codes::kNotARegularFile, path);
  }
  if (fs::file_size(path, error) == 0) return base::Unit{};
  std::ifstream file(path, std::ios::binary);
  std::string head(512, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (is_ours(head)) return base::Unit{};
  return sink.error_about(codes::kFileNotWritable, path,
                          "it is there already, and no file of this command; name another file");
}

bool is_earlier_page(std::string_view head) {
  return head.find(kPageMark) != std::string_view::npos;
}

}  // namespace parallax::tools
