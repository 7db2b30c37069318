#include "compiler/lisp/lisp_packages.h"

#include <fmt/core.h>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/plans.h"

namespace parallax::compiler {
namespace {

using NameSet = std::set<std::string, std::less<>>;

constexpr std::string_view kUserPackage = "common-lisp-user";

struct LispPackage {
  bool is_defined = false;  // by a `defpackage` of the files
  std::optional<DatumId> form;
  std::vector<std::string> uses;
  NameSet exports, shadows;
  std::map<std::string, std::string, std::less<>> imports;  // name -> package
  std::map<std::string, std::string, std::less<>> local_nicknames;
};

class PackageResolver {
 public:
  PackageResolver(LispText& text, base::DiagnosticSink& sink)
      : text_(text), data_(text.data), sink_(sink) {}

  base::Status resolve() {
    const auto errors_before = sink_.error_count();
    read_packages();
    if (sink_.error_count() == errors_before && speaks_of_packages_) {
      check_uses();
      if (sink_.error_count() == errors_before) give_keys();
    }
    if (sink_.error_count() != errors_before) return sink_.already_reported();
    return base::Unit{};
  }

 private:
  base::DiagnosticBuilder wrong(DatumId at, std::string_view what, std::string_view text) {
    return sink_.error(codes::kPlanPackage, data_.source(at), what, text);
  }

  /// Name of a package or of one of its symbols, given as a symbol, a keyword or a string in any
  /// case.
  std::optional<std::string> designated(DatumId datum) {
    if (data_.is_symbol(datum) || data_.is_keyword(datum)) return data_.name(datum);
    if (!data_.is_string(datum)) return std::nullopt;
    auto text = data_.name(datum);
    for (auto& c : text) c = base::to_lower(c);
    return text;
  }

  std::string package_named(std::string_view name, std::string_view current) const {
    if (const auto here = packages_.find(current); here != packages_.end()) {
      const auto local = here->second.local_nicknames.find(name);
      if (local != here->second.local_nicknames.end()) return local->second;
    }
    const auto found = nicknames_.find(name);
    return found == nicknames_.end() ? std::string(name) : found->second;
  }

  void read_packages();
  void read_package(DatumId form);
  void read_option(const std::string& name, LispPackage& package, DatumId option);
  void read_names(std::span<const DatumId> items, NameSet& out);
  void read_imports(LispPackage& package, DatumId option, bool shadowing);
  void read_local_nicknames(LispPackage& package, DatumId option);
  void claim(const std::string& name, const std::string& package, DatumId at);
  void enter(DatumId form, std::string& current);
  void export_names(DatumId form, const std::string& current);
  void check_uses();
  void give_keys();
  void give_keys(DatumId form, const std::string& current);

  const std::string& home(const std::string& package, const std::string& name);
  std::string home_of(DatumId symbol, const std::string& current);

  LispText& text_;
  LispData& data_;
  base::DiagnosticSink& sink_;
  bool speaks_of_packages_ = false;
  std::map<std::string, LispPackage, std::less<>> packages_;
  // Also each name itself; the first ones are Lisp's own.
  std::map<std::string, std::string, std::less<>> nicknames_ = {
      {"cl-user", std::string(kUserPackage)}, {"cl", "common-lisp"}};
  std::map<std::string, DatumId, std::less<>> claimed_;
  std::map<std::pair<std::string, std::string>, std::string> homes_;
  std::map<std::string, NameSet, std::less<>> defined_;  // name -> homes
  std::vector<std::string> package_of_;                  // by top-level form
};

std::string text_of_names(std::string_view left, std::string_view right, std::string_view name) {
  return fmt::format("`{}` and `{}` both give it a symbol `{}`", left, right, name);
}

bool defines_name(std::string_view head) {
  return head == "defun" || head == "def-cram-function" || head == "def-top-level-cram-function" ||
         head == "defparameter" || head == "defvar" || head == "defconstant" || head == "defmacro";
}

void PackageResolver::read_packages() {
  std::string current(kUserPackage);
  std::optional<base::FileId> file;
  for (const auto form : text_.forms) {
    if (file != data_.source(form).file) current = kUserPackage;  // each file starts there
    file = data_.source(form).file;
    const auto head = data_.head(form).value_or("");
    if (head == "defpackage" || head == "define-package") {
      read_package(form);
    } else if (head == "in-package") {
      enter(form, current);
    } else if (head == "export") {
      export_names(form, current);
    }
    package_of_.push_back(current);
  }
}

void PackageResolver::read_package(DatumId form) {
  speaks_of_packages_ = true;
  const auto items = data_.children(form);
  const auto name = items.size() < 2 ? std::nullopt : designated(items[1]);
  if (!name) {
    wrong(form, "defpackage", "expected the name of the package");
    return;
  }
  if (packages_.size() >= kMaxPlanPackages) {
    wrong(form, "defpackage", fmt::format("there are more than {} packages", kMaxPlanPackages));
    return;
  }
  claim(*name, *name, items[1]);
  auto& package = packages_[*name];
  package.is_defined = true;
  package.form = form;
  for (const auto option : items.subspan(2)) read_option(*name, package, option);
}

/// A name or a nickname, which only one package may have.
void PackageResolver::claim(const std::string& name, const std::string& package, DatumId at) {
  const auto [first, added] = claimed_.emplace(name, at);
  if (added) {
    nicknames_[name] = package;
    return;
  }
  const auto entered = packages_.find(name);
  const bool early = entered != packages_.end() && entered->second.form &&
                     !entered->second.is_defined &&
                     data_.head(*entered->second.form) == "in-package";
  wrong(at, name, early ? "it is entered before it is defined" : "two packages have this name")
      .note(data_.source(first->second), early ? "entered here" : "the first one is here");
}

void PackageResolver::read_option(const std::string& name, LispPackage& package, DatumId option) {
  const auto items = data_.children(option);
  const bool keyed = !items.empty() && data_.is_keyword(items.front());
  const std::string_view key = keyed ? std::string_view(data_.name(items.front())) : "";
  if (key == "use" || key == "mix" || key == "use-reexport") {
    for (const auto item : items.subspan(1)) {
      if (const auto used = designated(item)) {
        package.uses.push_back(*used);
      } else {
        wrong(item, "defpackage", "expected the name of a package");
      }
    }
  } else if (key == "export") {
    read_names(items.subspan(1), package.exports);
  } else if (key == "shadow" || key == "intern") {
    NameSet own;
    read_names(items.subspan(1), own);
    if (key == "shadow") package.shadows.insert(own.begin(), own.end());
  } else if (key == "nicknames") {
    for (const auto item : items.subspan(1)) {
      if (const auto nickname = designated(item); nickname && *nickname != name) {
        claim(*nickname, name, item);
      }
    }
  } else if (key == "import-from" || key == "shadowing-import-from") {
    read_imports(package, option, key != "import-from");
  } else if (key == "local-nicknames") {
    read_local_nicknames(package, option);
  } else if (key != "documentation" && key != "size") {
    wrong(option, "defpackage", "no option of this kind is read");
  }
}

void PackageResolver::read_names(std::span<const DatumId> items, NameSet& out) {
  for (const auto item : items) {
    if (auto name = designated(item)) {
      out.insert(*std::move(name));
    } else {
      wrong(item, "defpackage", "expected the name of a symbol");
    }
  }
}

void PackageResolver::read_imports(LispPackage& package, DatumId option, bool shadowing) {
  const auto items = data_.children(option);
  const auto from = items.size() < 2 ? std::nullopt : designated(items[1]);
  if (!from) {
    wrong(option, "defpackage", "expected the name of a package");
    return;
  }
  NameSet names;
  read_names(items.subspan(2), names);
  for (const auto& name : names) {
    const auto [known, added] = package.imports.emplace(name, *from);
    if (!added && known->second != *from) {
      wrong(option, "defpackage", text_of_names(known->second, *from, name));
    }
    if (shadowing) package.shadows.insert(name);
  }
}

void PackageResolver::read_local_nicknames(LispPackage& package, DatumId option) {
  for (const auto pair : data_.children(option).subspan(1)) {
    const auto parts = data_.children(pair);
    const auto nickname = parts.size() == 2 ? designated(parts[0]) : std::nullopt;
    const auto meant = parts.size() == 2 ? designated(parts[1]) : std::nullopt;
    if (!nickname || !meant) {
      wrong(pair, "defpackage", "a local nickname is (nickname package)");
    } else {
      package.local_nicknames[*nickname] = *meant;
    }
  }
}

void PackageResolver::enter(DatumId form, std::string& current) {
  speaks_of_packages_ = true;
  const auto items = data_.children(form);
  const auto name = items.size() == 2 ? designated(items[1]) : std::nullopt;
  if (!name) {
    wrong(form, "in-package", "expected the name of a package");
    return;
  }
  if (packages_.size() >= kMaxPlanPackages && !packages_.contains(*name)) {
    wrong(form, "in-package", fmt::format("there are more than {} packages", kMaxPlanPackages));
    return;
  }
  current = package_named(*name, "");
  auto& package = packages_[current];
  if (!package.form) package.form = form;
  // A later defpackage of it is a clash: Lisp reads this form first.
  claimed_.emplace(current, items[1]);
  nicknames_.emplace(current, current);
}

/// (export 'name), (export '(name ...)), perhaps with a package.
void PackageResolver::export_names(DatumId form, const std::string& current) {
  const auto items = data_.children(form);
  const auto quoted = [&](DatumId datum) {
    const bool is_quote = data_.head(datum) == "quote" && data_[datum].count == 2;
    return is_quote ? data_.children(datum)[1] : datum;
  };
  if (items.size() < 2) return;
  auto package = current;
  if (items.size() > 2) {
    if (const auto named = designated(quoted(items[2]))) package = package_named(*named, current);
  }
  const auto names = quoted(items[1]);
  const DatumId single[] = {names};
  const auto list = data_.children(names);
  read_names(data_.is_list(names) ? list : std::span<const DatumId>(single),
             packages_[package].exports);
}

/// The package whose symbol `name` is in `package`.
const std::string& PackageResolver::home(const std::string& package, const std::string& name) {
  // Entered first: packages that use each other in a circle end here.
  const auto [known, added] = homes_.try_emplace({package, name}, package);
  auto& out = known->second;
  const auto found = packages_.find(package);
  if (!added || found == packages_.end()) return out;
  const auto& here = found->second;
  if (const auto imported = here.imports.find(name); imported != here.imports.end()) {
    return out = home(package_named(imported->second, package), name);
  }
  if (here.shadows.contains(name)) return out;
  for (const auto& use : here.uses) {
    const auto used = packages_.find(package_named(use, package));
    if (used == packages_.end() || !used->second.exports.contains(name)) continue;
    return out = home(used->first, name);
  }
  return out;
}

/// Two packages that one uses must not give it different symbols of one name.
void PackageResolver::check_uses() {
  std::size_t inherited = 0;
  for (const auto& [name, package] : packages_) {
    std::map<std::string_view, std::string_view> from;
    for (const auto& use : package.uses) {
      const auto used = packages_.find(package_named(use, name));
      if (used == packages_.end() || used->first == name) continue;
      inherited += used->second.exports.size();
      if (inherited > kMaxInheritedNames) {
        wrong(*package.form, name,
              fmt::format("packages inherit more than {} names", kMaxInheritedNames));
        return;
      }
      for (const auto& symbol : used->second.exports) {
        if (package.shadows.contains(symbol)) continue;
        const auto& source = home(used->first, symbol);
        const auto imported = package.imports.find(symbol);
        if (imported != package.imports.end()) from.emplace(symbol, home(name, symbol));
        const auto [first, added] = from.emplace(symbol, source);
        if (added || first->second == source) continue;
        wrong(*package.form, name, text_of_names(first->second, source, symbol))
            .fix(fmt::format("say which: (:shadowing-import-from {} {})", source, symbol));
      }
    }
  }
}

std::string PackageResolver::home_of(DatumId symbol, const std::string& current) {
  const auto& prefix = data_.package(symbol);
  return home(prefix.empty() ? current : package_named(prefix, current), data_.name(symbol));
}

void PackageResolver::give_keys() {
  for (std::size_t i = 0; i < text_.forms.size(); ++i) {
    const auto items = data_.children(text_.forms[i]);
    if (items.size() < 2 || !defines_name(data_.head(text_.forms[i]).value_or(""))) continue;
    if (!data_.is_symbol(items[1])) continue;
    defined_[data_.name(items[1])].insert(home_of(items[1], package_of_[i]));
  }
  for (std::size_t i = 0; i < text_.forms.size(); ++i) give_keys(text_.forms[i], package_of_[i]);
  for (const auto& [name, homes] : defined_) {
    for (const auto& home : homes) {
      const auto full = home + "::" + name;
      text_.keys.emplace(full, homes.size() == 1 ? name : full);
    }
  }
}

void PackageResolver::give_keys(DatumId form, const std::string& current) {
  const auto head = data_.head(form).value_or("");
  if (head == "defpackage" || head == "in-package") return;
  std::vector<DatumId> open = {form};
  while (!open.empty()) {
    const auto datum = open.back();
    open.pop_back();
    const auto items = data_.children(datum);
    open.insert(open.end(), items.begin(), items.end());
    if (!data_.is_symbol(datum)) continue;
    const auto& name = data_.name(datum);
    if (data_[datum].external) {
      const auto package = packages_.find(package_named(data_.package(datum), current));
      if (package != packages_.end() && package->second.is_defined && package->first != current &&
          !package->second.exports.contains(name)) {
        wrong(datum, data_.package(datum), fmt::format("it does not export `{}`", name))
            .fix(fmt::format("write `{}::{}`, or export it", data_.package(datum), name));
        continue;
      }
    }
    const auto homes = defined_.find(name);
    if (homes == defined_.end()) continue;
    const auto home = home_of(datum, current);
    if (homes->second.size() > 1 || !homes->second.contains(home)) {
      data_.set_key(datum, home + "::" + name);
    }
  }
}

}  // namespace

base::Status resolve_packages(LispText& text, base::DiagnosticSink& sink) {
  return PackageResolver(text, sink).resolve();
}

}  // namespace parallax::compiler
