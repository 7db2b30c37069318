#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/ascii.h"
#include "compiler/plan/binding_text.h"
#include "compiler/plan/plan_binding.h"

namespace parallax::compiler {

/// A parameter `?x` at the start of `text`: its length, 0 if there is none.
std::size_t variable_length(std::string_view text);

/// Reads the entries one by one and recovers at the next one.
class BindingParser {
 public:
  BindingParser(const base::SourceFiles& files, base::FileId file, base::DiagnosticSink& sink)
      : file_(file),
        sink_(sink),
        cleaned_(clean_binding(files[file].text())),
        text_(cleaned_.text) {}

  base::Result<PlanBinding> parse();

 private:
  struct Alias {
    PerformKind kind = PerformKind::kMotion;
    std::vector<std::string> types;
    std::optional<PerformKind> target_kind;
    std::string target;
    base::SourceRange source;
    std::size_t position = 0;  // number of entries before it
  };
  base::SourceRange range(std::size_t begin, std::size_t end) const {
    return {file_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
  }
  void skip_blanks() {
    while (i_ < end_ && base::is_space(text_[i_])) ++i_;
  }
  std::string_view peek_name() const;
  bool take(std::string_view literal) {
    skip_blanks();
    if (!std::string_view(text_).substr(i_, end_ - i_).starts_with(literal)) return false;
    i_ += literal.size();
    return true;
  }
  bool take_word(std::string_view word) {
    skip_blanks();
    if (peek_name() != word) return false;
    i_ += word.size();
    return true;
  }
  bool expected(std::string_view what);
  bool name(std::string_view what, std::string& out);
  void parse_entry();
  bool types_of(std::vector<std::string>& types);
  bool parse_alias(Alias alias);
  bool parse_keys(BindingEntry& entry);
  bool parse_key(BindingEntry& entry);
  bool parse_event(BindingEntry& entry);
  bool parse_arguments(BindingEntry& entry);
  bool parse_formula(BindingEntry& entry);
  bool parse_tail(BindingEntry& entry);
  // binding_declarations.cc
  void parse_query(std::size_t begin);
  void parse_object(std::size_t begin);
  bool parse_plan_call(BindingEntry& entry);
  bool variable(std::string& out);
  bool variables(std::vector<std::string>& out);
  bool parse_formula_now(BindingEntry& entry);
  bool at_end();
  bool repeat_mapping(BindingEntry& entry);
  bool check_variables(const BindingEntry& entry);
  bool add(const BindingEntry& entry);
  void expand_aliases();

  base::FileId file_;
  base::DiagnosticSink& sink_;
  BindingText cleaned_;
  const std::string& text_;
  std::size_t i_ = 0;
  std::size_t end_ = 0;  // of the entry
  PlanBinding out_;
  std::vector<Alias> aliases_;
  bool failed_ = false;
};

}  // namespace parallax::compiler
