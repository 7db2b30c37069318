#include "tools/suite/footprint.h"

#include <algorithm>
#include <system_error>

#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/path_gate.h"
#include "compiler/base/sha256.h"
#include "tools/suite/input_hashes.h"

namespace parallax::tools {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::json;

void remove_timings(Json& json) {
  if (json.is_object()) json.erase("timing");
  for (auto& item : json) {
    if (item.is_structured()) remove_timings(item);
  }
}

}  // namespace

Footprint::Footprint(const SuiteCase& one, const fs::path& out)
    : out_(out),
      file_(out / ("footprint-" + base::sha256_hex(one.name()).substr(0, 16) + ".json")),
      begin_(fs::file_time_type::clock::now()) {
  // A case with a command depends on a foreign simulator, whose inputs are unknown.
  repeatable_ = one.command.empty();
}

Footprint::~Footprint() {
  std::error_code error;
  fs::remove(file_, error);
}

void Footprint::add(const base::Captured& child) {
  // Exit code 4: the answer depends on a limit of time or memory.
  repeatable_ = repeatable_ && (child.code == 0 || child.code == 1);
  answers_ += base::sha256_hex(without_timings(child.out));
  base::DiagnosticSink unread;
  const auto text = base::read_file(file_, unread);
  const auto json = text ? base::parse_json(*text) : Json();
  std::error_code error;
  fs::remove(file_, error);
  const auto* inputs = base::json_member(json, "inputs");
  if (inputs == nullptr || !inputs->is_array()) {
    complete_ = false;
    return;
  }
  for (const auto& path : *inputs) {
    if (path.is_string()) inputs_.insert(path.get<std::string>());
  }
  if (const auto* absent = base::json_member(json, "absent"); absent != nullptr) {
    for (const auto& path : *absent) {
      if (!path.is_string()) continue;
      inputs_.insert(path.get<std::string>());
      absent_.insert(path.get<std::string>());
    }
  }
  const auto* memory = base::json_member(json, "peak_memory_mb");
  if (memory == nullptr) return;
  const auto peak = base::json_as<std::int64_t>(*memory).value_or(0);
  peak_memory_mb_ = std::max(peak_memory_mb_, peak);
}

void Footprint::into(CaseResult& result) const {
  result.answer = base::sha256_hex(answers_);
  result.peak_memory_mb = peak_memory_mb_;
  result.repeatable = repeatable_ && complete_;
  result.inputs.clear();
  if (!complete_) return;
  InputHashes hashes;
  std::vector<InputFile> inputs;
  for (const auto& path : inputs_) {
    if (base::lies_below(path, out_)) continue;
    std::error_code error;
    const auto written = fs::last_write_time(path, error);
    if (!error && written >= begin_) {
      result.repeatable = false;
      return;
    }
    // A file that has appeared since, with an older time, was not read.
    inputs.push_back({path, absent_.contains(path) ? std::string() : hashes.of(path)});
  }
  result.inputs = std::move(inputs);
}

std::string without_timings(const std::string& answer) {
  auto json = base::parse_json(answer);
  if (!json.is_structured()) return answer;
  remove_timings(json);
  return base::json_text(json);
}

}  // namespace parallax::tools
