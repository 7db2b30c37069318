#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tools/lsp/diagnosis.h"
#include "tools/lsp/documents.h"

namespace parallax::tools::lsp {

/// The messages that the editor was told, by file.
class Publishing {
 public:
  using Notify = std::function<void(const char* method, Json params)>;

  /// Checks what is open and tells the messages of every file that has some or had some. False if
  /// `stop` was raised meanwhile; nothing is told then.
  bool publish(const Documents& documents, std::atomic<bool>& stop, const Notify& notify);
  /// A text changed: what was told is old until the next publish().
  void outdate() { is_current_ = false; }
  bool is_current() const { return is_current_; }
  /// The messages about a file, as they were told last.
  const std::vector<EditorMessage>& told(const std::string& path) const;

 private:
  std::map<std::string, std::vector<EditorMessage>> told_;  // by path; none without a message
  bool is_current_ = true;
};

}  // namespace parallax::tools::lsp
