#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "compiler/base/open_texts.h"
#include "tools/lsp/compiled_texts.h"
#include "tools/lsp/name_map.h"
#include "tools/lsp/positions.h"
#include "tools/lsp/project.h"
#include "tools/lsp/rpc.h"

namespace parallax::tools::lsp {

struct OpenDocument {
  std::string uri, text;
  std::int64_t version = 0;
};

/// The texts that the editor has open, and the names in them and in the files around them. Paths
/// are those of `file:` addresses.
class Documents {
 public:
  /// Columns count these units from now on; the default is UTF-16.
  void count_columns_in(ColumnUnit unit) { unit_ = unit; }
  ColumnUnit unit() const { return unit_; }

  // Take over what the editor tells. False where nothing changed: the address is no file, or the
  // file is not open. A malformed message is Refused, and then nothing changed either.
  bool open(const Json& params);
  bool change(const Json& params);
  bool close(const Json& params);
  /// Files may have changed on disk.
  void forget_names() {
    names_.clear();
    compiled_.clear();
  }

  const std::map<std::string, OpenDocument>& all() const { return documents_; }
  const base::OpenTexts& texts() const { return texts_; }
  /// Null if it is not open.
  const OpenDocument* find(const std::string& path) const;
  /// Texts as they are edited, other files as they lie on disk. Must not outlive the object.
  TextOf text_of() const;
  /// The address that the editor gave the file, or made of its path.
  std::string uri(const std::string& path) const;

  /// The path of the document that a request is about. Throws Refused if it is not open.
  std::string asked_path(const Json& params) const;
  /// The text of an open document.
  const std::string& text(const std::string& path) const { return documents_.at(path).text; }
  Positions positions(const std::string& path) const { return {text(path), unit_}; }
  /// The declared names that a file sees; made at the first question after a change.
  const NameMap& names(const std::string& path);
  /// The clauses of the first scenario or model that reads the file, likewise.
  const CompiledTexts& compiled(const std::string& path);

 private:
  ColumnUnit unit_ = ColumnUnit::kUtf16;
  std::map<std::string, OpenDocument> documents_;  // by path
  base::OpenTexts texts_;                          // the same texts
  std::map<std::string, std::unique_ptr<NameMap>> names_;
  std::map<std::string, std::unique_ptr<CompiledTexts>> compiled_;  // by scenario or model
};

}  // namespace parallax::tools::lsp
