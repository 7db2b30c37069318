// Finds the places of declared names. The compiler's own parser, which goes on after errors, gives
// the names; their places are words of models, tables and scenarios outside of comments.
// Names of plans come from tools/lsp/plan_names. Linear in the texts.

#include "tools/lsp/name_map.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "compiler/base/diagnostic.h"
#include "compiler/base/source_file.h"
#include "compiler/syntax/ast.h"
#include "compiler/syntax/parser.h"
#include "tools/lsp/file_text.h"
#include "tools/lsp/plan_names.h"

namespace parallax::tools::lsp {
namespace {

/// The name without digits at its end: a variable's sort.
std::string_view stem(std::string_view word) {
  while (!word.empty() && std::isdigit(static_cast<unsigned char>(word.back())) != 0)
    word.remove_suffix(1);
  return word;
}

NameKind kind_of(std::string_view sort) {
  if (sort == "fluent") return NameKind::kFluent;
  if (sort == "event") return NameKind::kEvent;
  if (sort == "predicate") return NameKind::kPredicate;
  return NameKind::kFunction;
}

/// Keys of scenarios whose values are words for people.
bool is_prose(std::string_view line) {
  constexpr std::array<std::string_view, 5> kKeys = {
      "name:", "title:", "because:", "reason:", "about:"};
  while (line.starts_with(' ') || line.starts_with('-')) line.remove_prefix(1);
  return std::any_of(kKeys.begin(), kKeys.end(), [&](auto key) { return line.starts_with(key); });
}

}  // namespace

NameMap::NameMap(const std::vector<std::string>& paths, const TextOf& text_of) {
  std::vector<std::pair<std::string, std::string>> texts;
  for (const auto& path : paths) {
    if (auto text = text_of(path)) texts.emplace_back(path, *std::move(text));
  }
  for (const auto& [path, text] : texts) {
    if (is_model(path)) declare(path, text);
    auto of_plans = is_table(path)  ? designators_of(path, text)
                    : is_plan(path) ? functions_of(path, text)
                                    : std::vector<DeclaredName>();
    for (auto& name : of_plans) declared_.emplace(name.key, std::move(name));
  }
  for (const auto& [path, text] : texts) add_words(path, text);
}

void NameMap::declare(const std::string& path, const std::string& text) {
  base::SourceFiles files;
  base::DiagnosticSink unread;
  const auto ast = compiler::parse_file(files.add(path, text), files, unread);
  const auto add = [&](const compiler::Word& word, NameKind kind, std::string declaration) {
    if (word.empty()) return;
    const auto spelling = std::string(ast.text(word));
    declared_.try_emplace(
        spelling, DeclaredName{spelling, spelling, kind, std::move(declaration),
                               comment_above(text, word.begin), path, word.begin, word.end, ""});
  };
  for (const auto& statement : ast.statements()) {
    using Kind = compiler::StatementKind;
    const auto* items = ast.items(statement);
    if (statement.kind == Kind::kSort || statement.kind == Kind::kReifiedSort) {
      for (std::uint32_t i = 0; i < statement.item_count; ++i) {
        const auto parent = std::string(ast.text(items[i].parent));
        add(items[i].name, NameKind::kSort,
            "sort " + std::string(ast.text(items[i].name)) + (parent.empty() ? "" : ": " + parent));
      }
    } else if (statement.kind == Kind::kConstants) {
      for (std::uint32_t i = 0; i < statement.item_count; ++i) {
        add(items[i].name, NameKind::kConstant,
            std::string(ast.text(statement.sort)) + " " + std::string(ast.text(items[i].name)));
      }
    } else if (statement.kind == Kind::kConstructor) {
      add(statement.name, kind_of(ast.text(statement.sort)),
          std::string(ast.text(statement.source)));
    } else if (statement.kind == Kind::kFormula) {
      note_effects(ast, statement);
    }
  }
}

void NameMap::note_effects(const compiler::Ast& ast, const compiler::Statement& statement) {
  for (auto i = statement.first_node.index(); i <= statement.formula.index(); ++i) {
    const auto& node = ast[compiler::NodeId(i)];
    if (node.kind != compiler::NodeKind::kApply) continue;
    const auto name = ast.name(node);
    if (name != "Initiates" && name != "Terminates" && name != "Releases") continue;
    for (std::uint32_t k = 0; k < std::min(node.child_count, 2U); ++k) {
      const auto& term = ast[ast.child(node, k)];
      if (term.kind != compiler::NodeKind::kApply) continue;
      effects_.emplace_back(std::string(ast.name(term)), std::string(ast.text(statement.source)));
    }
  }
}

const DeclaredName* NameMap::resolve(std::string_view word) const {
  if (const auto* name = find(word)) return name;
  const auto* sort = find(stem(word));
  return sort != nullptr && sort->kind == NameKind::kSort ? sort : nullptr;
}

void NameMap::add_words(const std::string& path, const std::string& text) {
  auto& words = words_[path];
  if (is_plan(path)) {
    words = words_of_plan(text);
    std::erase_if(words, [&](const auto& word) { return find(word.key) == nullptr; });
    return;
  }
  const auto add = [&](std::size_t begin, std::size_t end) {
    const auto* name = resolve(std::string_view(text).substr(begin, end - begin));
    if (name != nullptr) words.push_back({begin, end, name->key});
  };
  const bool yaml = is_yaml(path);
  if (!yaml && !is_model(path) && !is_table(path)) return;
  // In models every name outside of comments is one of the language's; in tables and scenarios,
  // too, but for what is written for people.
  each_line(text, [&](std::size_t begin, std::string_view whole) {
    if (yaml && is_prose(whole)) return;
    const auto line = without_comment(whole, yaml);
    for (std::size_t i = 0; i < line.size();) {
      if (!is_word(line[i])) {
        ++i;
        continue;
      }
      auto end = i;
      while (end < line.size() && is_word(line[end])) ++end;
      // A variable of the table (?p), a part of a path or of a hyphenated word is no name of the
      // model.
      const char before = i == 0 ? ' ' : line[i - 1], after = end < line.size() ? line[end] : ' ';
      const bool is_part =
          before == '?' || (!is_model(path) && (before == '-' || before == '/' || before == '.' ||
                                                after == '-' || after == '/' || after == '.'));
      if (!is_part) add(begin + i, begin + end);
      i = end;
    }
  });
  if (!is_table(path)) return;
  // The name of an entry wins over a name of the model with the same spelling.
  auto entries = words_of_table(text);
  std::erase_if(entries, [&](const auto& word) { return find(word.key) == nullptr; });
  std::erase_if(words, [&](const Word& word) {
    return std::any_of(entries.begin(), entries.end(), [&](const Word& entry) {
      return entry.begin < word.end && word.begin < entry.end;
    });
  });
  words.insert(words.end(), entries.begin(), entries.end());
  std::sort(words.begin(), words.end(),
            [](const Word& a, const Word& b) { return a.begin < b.begin; });
}

const DeclaredName* NameMap::find(std::string_view key) const {
  const auto found = declared_.find(key);
  return found == declared_.end() ? nullptr : &found->second;
}

const std::vector<NameMap::Word>& NameMap::words(const std::string& path) const {
  static const std::vector<Word> kNone;
  const auto found = words_.find(path);
  return found == words_.end() ? kNone : found->second;
}

const DeclaredName* NameMap::at(const std::string& path, std::size_t offset) const {
  for (const auto& word : words(path)) {
    if (word.begin <= offset && offset <= word.end) return find(word.key);
  }
  return nullptr;
}

std::vector<NamedPlace> NameMap::places(const DeclaredName& name) const {
  std::vector<NamedPlace> out;
  for (const auto& [path, words] : words_) {
    for (const auto& word : words) {
      if (word.key == name.key) out.push_back({path, word.begin, word.end});
    }
  }
  return out;
}

std::vector<NamedPlace> NameMap::performs(const DeclaredName& event) const {
  std::vector<NamedPlace> out;
  if (event.kind != NameKind::kEvent) return out;
  for (const auto& [path, words] : words_) {
    if (!is_plan(path)) continue;
    for (const auto& word : words) {
      const auto* entry = find(word.key);
      if (entry != nullptr && entry->event == event.name)
        out.push_back({path, word.begin, word.end});
    }
  }
  return out;
}

std::vector<std::string> NameMap::effects(const DeclaredName& name) const {
  std::vector<std::string> out;
  for (const auto& [of, axiom] : effects_) {
    if (of == name.name && (out.empty() || out.back() != axiom)) out.push_back(axiom);
  }
  return out;
}

}  // namespace parallax::tools::lsp
