#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

namespace parallax::test {

/// One model of a recorded answer, as it stands there and as it reads when written out.
struct RecordedModel {
  std::vector<std::string> lines;  // below `model K:`
  std::string printed;  // `model K:` or `model K diff:` and the lines after it, line ends too
};

/// The model part of an answer that the Discrete Event Calculus Reasoner 1.0 recorded.
class RecordedAnswer {
 public:
  explicit RecordedAnswer(const std::filesystem::path& path) {
    static const std::regex head("model \\d+:|model \\d+ diff:.*"),
        trailer("[A-Za-z0-9]+: \\d+ predicates.*");
    std::ifstream in(path);
    bool inside = false;
    for (std::string line; std::getline(in, line);) {
      near_miss_ = near_miss_ || line == "near miss:";
      if (std::regex_match(line, head)) {
        models_.emplace_back();
        inside = true;
      } else if (std::regex_match(line, trailer) || line == "near miss:") {
        inside = false;
      } else if (inside && line == "---" && !in_diff_hunk()) {
        inside = false;
      } else if (inside) {
        models_.back().lines.push_back(line);
      }
      if (inside) models_.back().printed += line + '\n';
    }
    for (std::size_t i = 0; i < models_.size(); ++i) write_out(i);
  }
  /// The assignment that comes nearest to a model, where there is none.
  bool is_near_miss() const { return near_miss_; }
  const std::vector<RecordedModel>& models() const { return models_; }

 private:
  /// `---` also separates old from new lines within a difference, which ends with an empty line.
  bool in_diff_hunk() const {
    return models_.back().printed.find(" diff:") != std::string::npos &&
           !models_.back().lines.empty() && models_.back().lines.back().starts_with("< ");
  }

  void write_out(std::size_t i) {
    static const std::regex diff("model \\d+ diff:(.*)");
    std::smatch parts;
    const auto first = models_[i].printed.substr(0, models_[i].printed.find('\n'));
    if (!std::regex_match(first, parts, diff)) return;
    auto edits = std::move(models_[i].lines);
    edits.insert(edits.begin(), parts[1].str());
    models_[i].lines = patched(models_[i - 1].lines, edits);
  }

 public:
  /// `before`, changed by the commands of a normal diff.
  static std::vector<std::string> patched(const std::vector<std::string>& before,
                                          const std::vector<std::string>& edits) {
    static const std::regex command("(\\d+)(?:,(\\d+))?([acd])(\\d+)(?:,(\\d+))?");
    std::vector<std::string> out;
    std::size_t next = 0;  // the first line of `before` that was not looked at
    for (const auto& line : edits) {
      std::smatch parts;
      if (std::regex_match(line, parts, command)) {
        const std::size_t from = std::stoul(parts[1]);
        const std::size_t to = parts[2].matched ? std::stoul(parts[2]) : from;
        const auto kept = parts[3] == "a" ? from : from - 1;
        while (next < kept) out.push_back(before.at(next++));
        if (parts[3] != "a") next = to;
      } else if (line.starts_with("> ")) {
        out.push_back(line.substr(2));
      } else if (!line.starts_with("< ") && line != "---" && !line.empty()) {
        throw std::runtime_error("no line of a difference: " + line);
      }
    }
    while (next < before.size()) out.push_back(before[next++]);
    return out;
  }

 private:
  std::vector<RecordedModel> models_;
  bool near_miss_ = false;
};

}  // namespace parallax::test
