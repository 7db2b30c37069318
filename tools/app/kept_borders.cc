#include "tools/app/kept_borders.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "compiler/base/file_io.h"
#include "compiler/base/json.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kMostKeptBytes = std::size_t{16} << 20U;

template <typename T>
std::optional<T> kept_member(const nlohmann::json& object, const char* name) {
  const auto* value = base::json_member(object, name);
  return value == nullptr ? std::nullopt : base::json_as<T>(*value);
}

/// The entry of a parameter; none if it is malformed, or about another start.
std::optional<harness::CauseBorder> kept_border_of(const nlohmann::json& entry,
                                                   const harness::State& start, bool& is_of_start) {
  const auto name = kept_member<std::string>(entry, "parameter");
  const auto value = kept_member<double>(entry, "value");
  const auto found = name ? start.find(*name) : start.end();
  is_of_start = value && found != start.end() && found->second == harness::Value(*value);
  const auto* border = base::json_member(entry, "border");
  if (!is_of_start || border == nullptr) return std::nullopt;
  const auto fails = kept_member<double>(*border, "fails_at"),
             other = kept_member<double>(*border, "not_at");
  if (!fails || !other) return std::nullopt;
  return harness::CauseBorder{*name, *fails, *other};
}

}  // namespace

std::vector<harness::CauseBorder> kept_borders(const std::string& run_dir, harness::SampleId sample,
                                               const harness::State& start) {
  std::vector<harness::CauseBorder> out;
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::path(run_dir) / kConfirmFile, error)) return out;
  base::DiagnosticSink unread;
  const auto text = base::read_file_of(run_dir, kConfirmFile, unread, kMostKeptBytes);
  if (!text) return out;
  const auto kept = base::parse_json(*text);
  const auto* parameters = base::json_member(kept, "parameters");
  if (kept_member<std::string>(kept, "sample") !=
          fmt::format("{}.{}", sample.trace, sample.sample) ||
      kept_member<std::string>(kept, "verdict") != "confirmed" ||
      kept_member<bool>(kept, "finished") != true || parameters == nullptr ||
      !parameters->is_array()) {
    return out;
  }
  for (const auto& entry : *parameters) {
    bool is_of_start = false;
    if (auto border = kept_border_of(entry, start, is_of_start)) out.push_back(*std::move(border));
    if (!is_of_start) return {};
  }
  return out;
}

}  // namespace parallax::tools
