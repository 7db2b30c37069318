#include "tools/suite/suite_case.h"

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"
#include "compiler/base/hash.h"
#include "compiler/base/whole_number.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

bool is_yaml(const fs::path& path) {
  return path.extension() == ".yaml" || path.extension() == ".yml";
}

/// The YAML files below the paths, sorted, each once.
std::vector<std::string> yaml_files(const std::vector<std::string>& paths,
                                    base::DiagnosticSink& sink) {
  std::vector<std::string> files;
  for (const auto& path : paths) {
    std::error_code error;
    if (fs::is_regular_file(path, error)) {
      files.push_back(fs::path(path).lexically_normal().string());
      continue;
    }
    fs::recursive_directory_iterator walk(path, error);
    if (error) {
      sink.error_about(base::DiagnosticCode::kFileNotFound, path, error.message());
      continue;
    }
    for (const auto& entry : walk) {
      if (entry.is_regular_file(error) && is_yaml(entry.path())) {
        files.push_back(entry.path().lexically_normal().string());
      }
    }
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

/// Has the text a key `expect` at its outermost level?
bool says_what_it_expects(std::string_view text) {
  return text.starts_with("expect:") || text.find("\nexpect:") != std::string_view::npos;
}

void add_scenario(const std::string& file, std::string_view text, std::vector<SuiteCase>& cases) {
  base::SourceFiles files;
  base::DiagnosticSink unread;  // the run of the case will say it
  const auto scenario = harness::load_scenario(file, files, unread);
  const auto folder = fs::path(file).parent_path();
  const auto group = folder.empty() ? std::string(".") : folder.generic_string();
  if (scenario && scenario->expect) {
    cases.push_back({file, file, group, *scenario->expect});
  } else if (!scenario && says_what_it_expects(text)) {
    cases.push_back({file, file, group, harness::Expectation{}});
  }
}

}  // namespace

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::kPassed:
      return "passed";
    case Outcome::kFailed:
      return "failed";
    case Outcome::kError:
      return "error";
    case Outcome::kNotFinished:
      return "not finished";
    case Outcome::kSkipped:
      return "skipped";
  }
  return "";
}

base::Result<std::vector<SuiteCase>> find_cases(const std::vector<std::string>& paths,
                                                base::SourceFiles& files,
                                                base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  std::vector<SuiteCase> cases;
  for (const auto& file : yaml_files(paths, sink)) {
    base::DiagnosticSink unread;
    const auto text = base::read_file(file, unread);
    if (!text) continue;
    if (!harness::looks_like_manifest(*text)) {
      add_scenario(file, *text, cases);
      continue;
    }
    auto manifest = harness::load_manifest(file, files, sink);
    if (!manifest) continue;
    for (auto& one : manifest->cases) {
      auto id = one.id;
      cases.push_back({file, std::move(id), file, std::move(one)});
    }
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  std::sort(cases.begin(), cases.end(), [](const SuiteCase& a, const SuiteCase& b) {
    return std::tie(a.group, a.id) < std::tie(b.group, b.id);
  });
  return cases;
}

std::optional<Shard> parse_shard(std::string_view text) {
  const auto slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  Shard shard;
  const auto index = base::whole_number<std::uint32_t>(text.substr(0, slash));
  const auto count = base::whole_number<std::uint32_t>(text.substr(slash + 1));
  if (!index || !count) return std::nullopt;
  shard.index = *index;
  shard.count = *count;
  if (shard.index < 1 || shard.index > shard.count || shard.count > kMaxShards) {
    return std::nullopt;
  }
  return shard;
}

bool in_shard(std::string_view id, const Shard& shard) {
  auto hash = base::fnv1a64(id);
  // The low bits of FNV mix badly; the high half is folded in.
  hash ^= hash >> 32U;
  return hash % shard.count == shard.index - 1;
}

}  // namespace parallax::tools
