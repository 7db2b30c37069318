#pragma once

#include <doctest/doctest.h>
#include <fmt/core.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/source_file.h"
#include "compiler/sema/check.h"
#include "compiler/syntax/loader.h"
#include "compiler/syntax/parser.h"

namespace parallax::test {

/// A text and what the front end said about it.
struct FrontEnd {
  base::SourceFiles files;
  base::DiagnosticSink sink{1000};

  base::FileId add(std::string text) { return files.add("m.e", std::move(text)); }

  /// "E1003 2:5-7", sorted; line and column where it begins, column of its last character.
  std::vector<std::string> places() const {
    std::vector<std::string> out;
    for (const auto& d : sink.sorted()) {
      const auto id = base::info(d.code).id;
      if (!d.range) {
        out.emplace_back(id);
        continue;
      }
      const auto& file = files[d.range->file];
      const auto begin = file.position(d.range->begin);
      const auto end = file.position(d.range->end);
      out.push_back(fmt::format("{} {}:{}-{}", id, begin.line, begin.column,
                                end.line == begin.line ? end.column - 1 : begin.column));
    }
    return out;
  }
  /// The codes alone.
  std::vector<std::string> codes() const {
    std::vector<std::string> out;
    for (const auto& d : sink.sorted()) out.emplace_back(base::info(d.code).id);
    return out;
  }
  std::string text() const {
    std::string out;
    for (const auto& d : sink.sorted()) out += base::to_text(d, files, {});
    return out;
  }
};

using Strings = std::vector<std::string>;

/// A model text after the whole front end.
struct CheckedText : FrontEnd {
  std::optional<compiler::TypedModel> model;

  explicit CheckedText(std::string source, const compiler::CheckOptions& options = {}) {
    const auto file = add(std::move(source));
    auto ast = compiler::load_model_text(file, ".", {}, files, sink);
    if (!ast) return;
    auto checked = compiler::check_model(*ast, files, sink, options);
    if (checked) model = std::move(*checked);
  }
};

}  // namespace parallax::test

template <>
struct doctest::StringMaker<std::vector<std::string>> {
  static doctest::String convert(const std::vector<std::string>& strings) {
    std::string out;
    for (const auto& item : strings) out += "\"" + item + "\", ";
    return out.c_str();
  }
};
