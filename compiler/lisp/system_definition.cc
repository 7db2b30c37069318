#include "compiler/lisp/system_definition.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/plans.h"
#include "compiler/lisp/lisp_reader.h"

namespace parallax::compiler {
namespace {

namespace fs = std::filesystem;

/// Keys by which a system describes itself or names other systems; they are not evaluated.
constexpr std::array<std::string_view, 17> kRemarks = {"name",
                                                       "author",
                                                       "maintainer",
                                                       "licence",
                                                       "license",
                                                       "version",
                                                       "homepage",
                                                       "description",
                                                       "long-description",
                                                       "mailto",
                                                       "encoding",
                                                       "bug-tracker",
                                                       "long-name",
                                                       "defsystem-depends-on",
                                                       "source-control",
                                                       "in-order-to",
                                                       "weakly-depends-on"};

struct Component {
  std::string name;
  DatumId place;
  std::vector<SystemFile> files;
  std::vector<std::pair<std::string, DatumId>> needs;
  bool visiting = false, done = false;
};

class SystemReader {
 public:
  SystemReader(const LispData& data, base::DiagnosticSink& sink) : data_(data), sink_(sink) {}

  base::Result<std::vector<SystemFile>> read(std::span<const DatumId> forms, base::FileId file) {
    const auto errors_before = sink_.error_count();
    std::vector<SystemFile> out;
    std::optional<DatumId> system;
    for (const auto form : forms) {
      const auto head = data_.head(form).value_or("");
      if (head == "in-package" || head == "defpackage") continue;
      if (head != "defsystem") {
        wrong(form, "it is read as data, and this is code");
      } else if (system) {
        wrong(form, "one file defines one system").note(data_.source(*system), "the first one");
      } else {
        system = form;
        const auto items = data_.children(form);
        if (items.size() < 2 || !name_of(items[1])) {
          wrong(form, "expected the name of the system");
        } else {
          out = read_group(items.subspan(2), {}, true);
        }
      }
    }
    if (!system && sink_.error_count() == errors_before) {
      sink_.error(codes::kPlanSystem, base::SourceRange{file, 0, 0}, "it has no `defsystem`");
    }
    if (sink_.error_count() != errors_before) return sink_.already_reported();
    return out;
  }

 private:
  base::DiagnosticBuilder wrong(DatumId at, std::string_view text) {
    return sink_.error(codes::kPlanSystem, data_.source(at), text);
  }

  std::optional<std::string> name_of(DatumId datum) const {
    if (!data_.is_string(datum) && !data_.is_symbol(datum) && !data_.is_keyword(datum)) {
      return std::nullopt;
    }
    return data_.name(datum);
  }

  /// The options of a system or a module. Nesting is bounded by the reader.
  std::vector<SystemFile> read_group(std::span<const DatumId> options, fs::path folder,
                                     bool is_system) {
    std::vector<DatumId> listed;
    bool serial = false;
    for (std::size_t i = 0; i < options.size(); i += 2) {
      const auto key = data_.is_keyword(options[i]) ? data_.name(options[i]) : std::string();
      if (key.empty() || i + 1 == options.size()) {
        wrong(options[i], "expected an option with a value");
        return {};
      }
      const auto value = options[i + 1];
      if (key == "components") {
        const auto items = data_.children(value);
        listed.assign(items.begin(), items.end());
      } else if (key == "serial") {
        serial = !data_.is_nil(value);
      } else if (key == "pathname") {
        if (!data_.is_string(value)) {
          wrong(value, "it is read as data, and this is no text");
        } else if (is_system) {
          folder = data_.name(value);
        }  // of a module: read_module has seen it
      } else if (key != "depends-on" &&
                 std::find(kRemarks.begin(), kRemarks.end(), key) == kRemarks.end()) {
        wrong(options[i],
              fmt::format("the option `:{}` is code or unknown; it is read as data", key));
      }
    }
    return in_order(listed, folder, serial);
  }

  std::vector<SystemFile> in_order(std::span<const DatumId> listed, const fs::path& folder,
                                   bool serial) {
    std::vector<Component> parts;
    std::map<std::string, std::size_t, std::less<>> by_name;
    for (const auto item : listed) {
      if (++components_ > kMaxPlanFiles) {
        wrong(item, fmt::format("there are more than {} components", kMaxPlanFiles));
        return {};
      }
      auto part = read_component(item, folder);
      if (!part) continue;
      if (serial && !parts.empty()) part->needs.emplace_back(parts.back().name, item);
      const auto [first, added] = by_name.emplace(part->name, parts.size());
      if (!added) {
        wrong(part->place, fmt::format("the component `{}` is named twice", part->name))
            .note(data_.source(parts[first->second].place), "first named here");
      }
      parts.push_back(*std::move(part));
    }
    std::vector<SystemFile> out;
    for (auto& part : parts) visit(part, parts, by_name, out);
    return out;
  }

  /// Visits the components that this one needs before it. The recursion is at most as deep as there
  /// are components.
  void visit(Component& part, std::vector<Component>& parts,
             const std::map<std::string, std::size_t, std::less<>>& by_name,
             std::vector<SystemFile>& out) {
    if (part.done) return;
    part.visiting = true;
    for (const auto& [name, place] : part.needs) {
      const auto needed = by_name.find(name);
      if (needed == by_name.end()) {
        wrong(place, fmt::format("there is no component `{}` beside this one", name));
      } else if (parts[needed->second].visiting) {
        wrong(place, fmt::format("`{}` and `{}` depend on each other", part.name, name));
      } else {
        visit(parts[needed->second], parts, by_name, out);
      }
    }
    part.visiting = false;
    part.done = true;
    out.insert(out.end(), part.files.begin(), part.files.end());
  }

  std::optional<Component> read_component(DatumId item, const fs::path& folder) {
    const auto items = data_.children(item);
    const auto kind = items.empty() || !data_.is_keyword(items.front()) ? std::string()
                                                                        : data_.name(items.front());
    const auto name = items.size() < 2 ? std::nullopt : name_of(items[1]);
    if (!name || kind.empty()) {
      wrong(item, "a component is (:file \"name\" option...)");
      return std::nullopt;
    }
    Component part{*name, items[1], {}, {}};
    std::optional<std::string> path;
    for (std::size_t i = 2; i + 1 < items.size(); i += 2) {
      const auto value = items[i + 1];
      if (!data_.is_keyword(items[i])) continue;
      if (data_.name(items[i]) == "pathname" && data_.is_string(value)) path = data_.name(value);
      if (data_.name(items[i]) != "depends-on") continue;
      for (const auto needed : data_.children(value)) {
        if (const auto other = name_of(needed)) {
          part.needs.emplace_back(*other, needed);
        } else {
          wrong(needed, "expected the name of a component");
        }
      }
    }
    if (kind == "module") {
      part.files = read_group(items.subspan(2), folder / path.value_or(*name), false);
    } else if (kind == "file" || kind == "cl-source-file") {
      part.files.push_back({folder / (path ? *path : *name + ".lisp"), data_.source(items[1])});
      (void)only_data(items.subspan(2));
    } else if (kind != "static-file" && kind != "doc-file" && kind != "html-file") {
      wrong(item, fmt::format("there are no components of the kind `:{}`", kind));
    }
    return part;
  }

  bool only_data(std::span<const DatumId> options) {
    for (std::size_t i = 0; i < options.size(); i += 2) {
      const auto key = data_.is_keyword(options[i]) ? data_.name(options[i]) : std::string();
      const bool known = key == "depends-on" || key == "pathname" || key == "encoding" ||
                         key == "description" || key == "version";
      if (known && i + 1 < options.size()) continue;
      wrong(options[i], "an option of this kind is code or unknown; it is read as data");
      return false;
    }
    return true;
  }

  const LispData& data_;
  base::DiagnosticSink& sink_;
  std::size_t components_ = 0;
};

}  // namespace

base::Result<std::vector<SystemFile>> read_system(const base::SourceFiles& files, base::FileId file,
                                                  base::DiagnosticSink& sink) {
  const auto text = read_lisp(files, file, sink);
  if (!text) return sink.already_reported();
  return SystemReader(text->data, sink).read(text->forms, file);
}

}  // namespace parallax::compiler
