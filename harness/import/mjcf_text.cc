#include "harness/import/mjcf_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "compiler/base/utf8.h"
#include "harness/import/description.h"
#include "harness/import/mesh.h"
#include "harness/import/mjcf_census.h"
#include "harness/import/plain_path.h"
#include "harness/import/way_within.h"

namespace parallax::harness {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxMjcfFiles = 500;
constexpr std::size_t kMaxMjcfBytes = std::size_t{256} << 20U;  // of all meshes

constexpr std::string_view kMeshName = "file_of_mesh_";

std::string shortened(std::string_view text) { return std::string(text.substr(0, 120)); }

bool is_word(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

/// Finds text that XML readers take differently, beyond what outline_of refuses: characters that
/// some take for spaces, and names of elements and attributes that are not plain words.
std::optional<TextFault> oddity(const std::string& text, const XmlOutline& outline) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if ((c >= 0 && c < ' ' && c != '\t' && c != '\n' && c != '\r') || c == '\x7f') {
      return TextFault{i, "holds a control character"};
    }
  }
  if (const auto odd = base::first_invalid_utf8(text); odd < text.size()) {
    return TextFault{odd, "is no UTF-8"};
  }
  for (const XmlElement& element : outline.elements) {
    const auto odd = [&](std::string_view name) {
      return TextFault{element.offset, fmt::format("`{}` is no name of MJCF", shortened(name))};
    };
    if (!is_word(element.tag)) return odd(element.tag);
    for (const XmlAttribute& attribute : element.attributes) {
      if (!is_word(attribute.name)) return odd(attribute.name);
    }
  }
  return std::nullopt;
}

/// Finds files where a description may have them, and reads them once.
class FileShelf {
 public:
  explicit FileShelf(const ImportInput& input) : input_(input) {
    folders_.push_back(input.folder);
    folders_.insert(folders_.end(), input.folders.begin(), input.folders.end());
  }

  struct Found {
    std::optional<std::string> fault;
    std::string path, bytes;
  };

  /// `name` as the description has it, from one of the folders on.
  Found read(const std::string& name, std::size_t most_bytes) {
    Found out;
    const auto fault = [&](std::string_view why) {
      out.fault = fmt::format("`{}` {}", shortened(name), why);
      return out;
    };
    const fs::path written(name);
    const bool leads_up = std::find(written.begin(), written.end(), "..") != written.end();
    bool is_within = false;
    for (const fs::path& folder : folders_) {
      // A way up begins where the description lies, and nowhere else.
      if (leads_up && &folder != &folders_.front()) break;
      std::error_code error;
      const auto way = way_within(folder, name, folders_);
      if (!way) continue;
      is_within = true;
      const auto& [path, root] = *way;
      if (leads_through_link(root, path)) return fault("leads through a link");
      if (!fs::exists(fs::symlink_status(path, error))) {
        absent_.insert(path.lexically_normal().string());
        continue;
      }
      if (input_.admits && !input_.admits(path)) return fault("lies where no file may be named");
      out.fault = read_bounded(path, most_bytes, out.bytes);
      out.path = path.lexically_normal().string();
      if (!out.fault) read_.insert(out.path);
      return out;
    }
    if (!is_within) {
      return fault(
          "is not read: only files below the folder of the description and those of "
          "`models` are, by plain names");
    }
    return fault("is neither beside the description nor in a folder of `models`");
  }
  std::vector<std::string> files() const { return {read_.begin(), read_.end()}; }
  std::vector<std::string> absent() const { return {absent_.begin(), absent_.end()}; }

 private:
  const ImportInput& input_;
  std::vector<fs::path> folders_;
  std::set<std::string> read_, absent_;
};

/// Replaces each include by the included text.
class Includer {
 public:
  Includer(FileShelf& shelf, MjcfText& out) : shelf_(shelf), out_(out) {}

  void run(const std::string& text) {
    out_.sources.push_back({"", text, 0});
    const XmlOutline outline = checked(0);
    if (out_.fault) return;
    if (outline.elements.front().tag != "mujoco") {
      return fail(0, outline.elements.front().offset, "the outermost element is no <mujoco>");
    }
    copy(0, outline, 0, text.size());
  }

 private:
  void fail(std::size_t source, std::size_t offset, const std::string& message) {
    if (out_.fault) return;
    const auto& from = out_.sources[source];
    if (source == 0) {
      out_.fault = TextFault{offset, message};
    } else {
      out_.fault = TextFault{from.offset, fmt::format("in `{}`: {}", from.name, message)};
    }
  }

  XmlOutline checked(std::size_t source) {
    const std::string& text = out_.sources[source].text;
    XmlOutline outline = outline_of(text);
    if (!outline.fault) outline.fault = oddity(text, outline);
    if (outline.fault) {
      fail(source, outline.fault->offset, outline.fault->message);
      return outline;
    }
    elements_ += outline.elements.size();
    bytes_ += text.size();
    parts_ += static_cast<std::size_t>(
        std::count_if(outline.elements.begin(), outline.elements.end(), [](const XmlElement& e) {
          return e.tag == "body" || e.tag == "joint" || e.tag == "freejoint";
        }));
    if (elements_ > kMaxImportElements || parts_ > kMaxImportParts || bytes_ > kMaxImportBytes) {
      fail(source, 0,
           fmt::format("all comes to more than {} elements, {} bodies and joints, or {} MiB",
                       kMaxImportElements, kMaxImportParts, kMaxImportBytes >> 20U));
    }
    return outline;
  }

  /// The text of a source from `begin` to `end`. No deeper than there are files.
  void copy(std::size_t source, const XmlOutline& outline, std::size_t begin, std::size_t end) {
    std::size_t at = begin;
    const auto up_to = [&](std::size_t next) {
      out_.included.copy(std::string_view(out_.sources[source].text).substr(at, next - at), source,
                         at);
    };
    for (const XmlElement& element : outline.elements) {
      if (element.tag != "include" || element.offset < at || element.offset >= end) continue;
      up_to(element.offset);
      include(source, element);
      if (out_.fault) return;
      at = element.end;
    }
    up_to(end);
  }

  void include(std::size_t source, const XmlElement& element) {
    const auto wrong = [&](const std::string& message) { fail(source, element.offset, message); };
    const XmlAttribute* file = element.find("file");
    if (file == nullptr) return wrong("an <include> names no file");
    auto found = shelf_.read(std::string(file->value), kMaxImportBytes);
    if (found.fault) return wrong(*found.fault);
    const std::string name = shortened(file->value);
    if (!included_.insert(found.path).second) {
      return wrong(fmt::format("`{}` is included a second time, or includes itself", name));
    }
    if (included_.size() > kMaxMjcfFiles) {
      return wrong(fmt::format("more than {} files are included", kMaxMjcfFiles));
    }
    const auto here = source == 0 ? element.offset : out_.sources[source].offset;
    out_.sources.push_back({name, std::move(found.bytes), here});
    const std::size_t number = out_.sources.size() - 1;
    const XmlOutline outline = checked(number);
    if (out_.fault) return;
    const XmlElement& root = outline.elements.front();
    if (root.text.empty()) return;
    const auto inside =
        static_cast<std::size_t>(root.text.data() - out_.sources[number].text.data());
    copy(number, outline, inside, inside + root.text.size());
  }

  FileShelf& shelf_;
  MjcfText& out_;
  std::set<std::string> included_;
  std::size_t elements_ = 0, parts_ = 0, bytes_ = 0;
};

/// Makes the one text name no file but meshes, which it reads.
class FileNamer {
 public:
  FileNamer(FileShelf& shelf, MjcfText& out) : shelf_(shelf), out_(out) {}

  void run() {
    const std::string& text = out_.included.text();
    const XmlOutline outline = outline_of(text);
    if (outline.fault) return fail(outline.fault->offset, outline.fault->message);
    note_compiler(outline);
    list_unread_mjcf(
        outline, [&](std::size_t offset) { return out_.place_of_included(offset); }, left_out_);
    for (const XmlElement& element : outline.elements) {
      if (element.offset < at_) continue;  // in what was taken out
      edit(element);
      if (out_.fault) return;
    }
    copy_to(text.size());
    out_.files.insert(out_.files.begin(), MjcfFile{"world.xml", out_.edited.text()});
    out_.left_out = left_out_.take();
  }

 private:
  void fail(std::size_t offset, const std::string& message) {
    const auto origin = out_.included.origin_of(offset);
    const auto& from = out_.sources[origin.source];
    out_.fault = origin.source == 0
                     ? TextFault{origin.offset, message}
                     : TextFault{from.offset, fmt::format("in `{}`: {}", from.name, message)};
  }

  /// Notes where meshes are; the last `compiler` element counts, as with the reader.
  void note_compiler(const XmlOutline& outline) {
    for (const XmlElement& element : outline.elements) {
      if (element.tag != "compiler") continue;
      if (const auto* folder = element.find("meshdir")) mesh_folder_ = folder->value;
      if (const auto* strips = element.find("strippath")) strips_ = strips->value == "true";
    }
  }

  void edit(const XmlElement& element) {
    if (element.tag == "composite") {
      return fail(element.offset, "things of many small parts (<composite>) are not taken over");
    }
    if (element.tag == "compiler") {
      for (const XmlAttribute& one : element.attributes) {
        if (one.name == "meshdir" || one.name == "texturedir") replace(one, "");
      }
    } else if (element.tag == "skin") {
      leave("skins", element);
      replace(element, "");
    } else if (element.tag == "texture") {
      leave("pictures (textures)", element);
      replace(element, fmt::format("<texture{} builtin=\"flat\" width=\"1\" height=\"1\"/>",
                                   kept(element, {"type"})));
    } else if (element.tag == "hfield") {
      replace(element, fmt::format("<hfield{} nrow=\"2\" ncol=\"2\"/>", kept(element, {"size"})));
    } else {
      edit_files(element);
    }
  }

  void edit_files(const XmlElement& element) {
    for (const XmlAttribute& one : element.attributes) {
      if (!one.name.starts_with("file")) continue;
      if (element.tag != "mesh" || one.name != "file") {
        return fail(element.offset, fmt::format("a <{}> names a file", element.tag));
      }
      read_mesh(element, one);
      if (out_.fault) return;
    }
  }

  void read_mesh(const XmlElement& element, const XmlAttribute& file) {
    fs::path way{std::string(file.value)};
    if (strips_) way = way.filename();
    if (!mesh_folder_.empty()) way = fs::path(mesh_folder_) / way;
    const auto extension = fs::path(way).extension().string();
    if (!is_word(extension.substr(extension.empty() ? 0 : 1))) {
      return fail(element.offset, fmt::format("`{}` has no format", shortened(file.value)));
    }
    auto& name = names_[way.string()];
    if (name.empty()) {
      auto found = shelf_.read(way.string(), kMaxMeshBytes);
      if (found.fault) return fail(element.offset, *found.fault);
      bytes_ += found.bytes.size();
      if (names_.size() > kMaxMjcfFiles || bytes_ > kMaxMjcfBytes) {
        return fail(element.offset, fmt::format("the meshes are more than {} files, or {} MiB",
                                                kMaxMjcfFiles, kMaxMjcfBytes >> 20U));
      }
      if (found.bytes.empty()) {
        return fail(element.offset, fmt::format("`{}` is empty", shortened(file.value)));
      }
      name = fmt::format("{}{}{}", kMeshName, names_.size(), extension);
      out_.mesh_names.emplace(name, shortened(file.value));
      out_.files.push_back({name, std::move(found.bytes)});
    }
    std::string text = fmt::format("file=\"{}\"", name);
    if (element.find("name") == nullptr) text += fmt::format(" name=\"{}\"", stem_of(file.value));
    replace(file, text);
  }

  /// As the reader names what has a file and no name.
  static std::string stem_of(std::string_view file) {
    return fs::path(std::string(file)).stem().string();
  }

  /// The name of an element, given or that of its file, and some of its attributes.
  static std::string kept(const XmlElement& element, std::initializer_list<const char*> names) {
    std::string out;
    const auto* name = element.find("name");
    const auto* file = element.find("file");
    const auto put = [&](std::string_view key, std::string_view value) {
      const char quote = value.find('"') == value.npos ? '"' : '\'';
      out += fmt::format(" {}={}{}{}", key, quote, value, quote);
    };
    if (name != nullptr) {
      put("name", name->value);
    } else if (file != nullptr) {
      put("name", stem_of(file->value));
    }
    for (const char* one : names) {
      if (const auto* attribute = element.find(one)) put(one, attribute->value);
    }
    return out;
  }

  void leave(const char* what, const XmlElement& element) {
    const auto* name = element.find("name");
    const auto* file = element.find("file");
    const auto* shown = name != nullptr ? name : file;
    left_out_.add(what, shown == nullptr ? "unnamed" : shortened(shown->value),
                  out_.place_of_included(element.offset));
  }

  void copy_to(std::size_t next) {
    const std::string_view text = out_.included.text();
    out_.edited.copy(text.substr(at_, next - at_), 0, at_);
    at_ = next;
  }
  void replace(const XmlElement& element, const std::string& text) {
    copy_to(element.offset);
    out_.edited.put(text, 0, element.offset);
    at_ = element.end;
  }
  void replace(const XmlAttribute& attribute, const std::string& text) {
    const std::string& all = out_.included.text();
    const auto begin = static_cast<std::size_t>(attribute.name.data() - all.data());
    copy_to(begin);
    out_.edited.put(text, 0, begin);
    at_ =
        static_cast<std::size_t>(attribute.value.data() - all.data()) + attribute.value.size() + 1;
  }

  FileShelf& shelf_;
  MjcfText& out_;
  LeftOutList left_out_;
  std::map<std::string, std::string> names_;  // of meshes, by way
  std::string mesh_folder_;
  bool strips_ = false;
  std::size_t bytes_ = 0, at_ = 0;
};

}  // namespace

std::size_t MjcfText::place_of_included(std::size_t offset) const {
  const auto origin = included.origin_of(offset);
  return origin.source == 0 ? origin.offset : sources[origin.source].offset;
}

MjcfText::Place MjcfText::place_of(std::size_t offset) const {
  const auto origin = included.origin_of(edited.origin_of(offset).offset);
  const Source& source = sources[origin.source];
  if (origin.source == 0) return {origin.offset, ""};
  const auto line = 1 + std::count(source.text.begin(),
                                   source.text.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                             origin.offset, source.text.size())),
                                   '\n');
  return {source.offset, fmt::format("in `{}`, line {}: ", source.name, line)};
}

std::string MjcfText::in_names_given(const std::string& said) const {
  std::string out;
  for (std::size_t at = 0; at < said.size();) {
    // The longest that stands here: one name may be how another begins.
    const std::pair<const std::string, std::string>* best = nullptr;
    if (said.compare(at, kMeshName.size(), kMeshName) == 0) {
      for (const auto& one : mesh_names) {
        if (said.compare(at, one.first.size(), one.first) != 0) continue;
        if (best == nullptr || one.first.size() > best->first.size()) best = &one;
      }
    }
    out += best == nullptr ? std::string(1, said[at]) : best->second;
    at += best == nullptr ? 1 : best->first.size();
  }
  return out;
}

MjcfText vetted_mjcf(const ImportInput& input) {
  MjcfText out;
  FileShelf shelf(input);
  Includer(shelf, out).run(input.text);
  if (!out.fault) FileNamer(shelf, out).run();
  out.read = shelf.files();
  out.absent = shelf.absent();
  return out;
}

}  // namespace parallax::harness
