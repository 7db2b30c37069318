#include "tools/mutate/judged_mutants.h"

#include <cerrno>
#include <cstring>
#include <sstream>
#include <system_error>

#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/sha256.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

constexpr const char* kSuite = "mutants_of";

std::string key_of(const Mutant& mutant) {
  return base::sha256_hex(mutant.file + '\0' + mutant.text);
}

/// Decodes a line; none if it is half written or not a judgement.
std::optional<std::pair<std::string, MutantJudgement>> read_line(const std::string& line) {
  const auto json = base::parse_ordered_json(line);
  if (!json.is_object()) return std::nullopt;
  const auto text = [&](const char* name) {
    const auto at = json.find(name);
    return at != json.end() && at->is_string() ? at->get<std::string>() : std::string();
  };
  const auto outcome = kMutantOutcomeWords.find(text("outcome"));
  if (!outcome || *outcome == MutantOutcome::kOpen || text("mutant").empty()) return std::nullopt;
  MutantJudgement out{*outcome, text("by"), text("why"), text("told_in")};
  const auto gained = json.find("gained");
  out.gained = gained != json.end() && gained->is_boolean() && gained->get<bool>();
  const auto by = json.find("excluded_by");
  if (by != json.end()) out.excluded_by = base::json_as<std::int64_t>(*by).value_or(0);
  out.trace = text("trace");
  out.trace_json = text("trace_json");
  return std::pair(text("mutant"), std::move(out));
}

std::string line_of(const Mutant& mutant, const MutantJudgement& judgement) {
  return base::json_text(OrderedJson{{"mutant", key_of(mutant)},
                                     {"outcome", to_string(judgement.outcome)},
                                     {"by", judgement.by},
                                     {"why", judgement.why},
                                     {"told_in", judgement.told_in},
                                     {"gained", judgement.gained},
                                     {"excluded_by", judgement.excluded_by},
                                     {"trace", judgement.trace},
                                     {"trace_json", judgement.trace_json}}) +
         '\n';
}

}  // namespace

base::Result<JudgedMutants> JudgedMutants::open(const fs::path& file, const std::string& suite,
                                                bool resume, base::DiagnosticSink& sink) {
  JudgedMutants out;
  std::error_code error;
  const auto refuse = [&](const char* why) {
    return sink.error_about(codes::kUsage, file.string(), why);
  };
  std::string kept = base::json_text(OrderedJson{{kSuite, suite}}) + '\n';
  if (fs::exists(fs::symlink_status(file, error))) {
    const auto text = base::read_file(file, sink);
    if (!text) return sink.already_reported();
    std::istringstream lines(*text);
    std::string line;
    std::getline(lines, line);
    const auto head = base::parse_ordered_json(line);
    if (!head.is_object() || !head.contains(kSuite)) {
      return refuse("this file is there already and was not written by --mutate");
    }
    if (resume && head[kSuite] != suite) {
      return refuse(
          "--resume: that were mutants of other files, other cases or another program; leave "
          "--resume out to begin anew");
    }
    while (resume && std::getline(lines, line)) {
      auto read = read_line(line);
      if (!read) continue;
      kept += line + '\n';
      out.known_.insert(*std::move(read));
    }
  } else if (resume) {
    return refuse("--resume: no mutants were judged there");
  }
  fs::create_directories(file.parent_path(), error);
  if (!base::write_file_atomically(file, kept, sink)) return sink.already_reported();
  out.out_ = base::Descriptor(::open(file.c_str(), O_WRONLY | O_APPEND | O_NOFOLLOW | O_CLOEXEC));
  if (!out.out_.valid()) {
    return sink.error_about(codes::kFileNotWritable, file.string(), std::strerror(errno));
  }
  return out;
}

std::optional<MutantJudgement> JudgedMutants::find(const Mutant& mutant) const {
  const auto at = known_.find(key_of(mutant));
  if (at == known_.end()) return std::nullopt;
  return at->second;
}

void JudgedMutants::add(const Mutant& mutant, const MutantJudgement& judgement) {
  const std::lock_guard lock(*mutex_);
  if (error_ == 0 && !base::write_all(out_.get(), line_of(mutant, judgement))) error_ = errno;
}

int JudgedMutants::write_error() const {
  const std::lock_guard lock(*mutex_);
  return error_;
}

}  // namespace parallax::tools
