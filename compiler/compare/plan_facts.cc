#include "compiler/compare/plan_facts.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "compiler/plan/binding_text.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMaxFormShown = 200;    // bytes of a form that are shown
constexpr std::size_t kWidth = 100;           // columns of the canonical layout
constexpr std::size_t kMaxAligned = 1000000;  // pairs of children that are compared
constexpr const char* kOrderKey = "order of the forms";

FactPlace place_of(const base::SourceRange& range, const base::SourceFiles& files) {
  return {files[range.file].name(), files[range.file].position(range.begin).line};
}

std::string shortened(std::string text) {
  return text.size() <= kMaxFormShown ? text : text.substr(0, kMaxFormShown) + "...";
}

/// With single blanks, as its author wrote it otherwise.
std::string one_line(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  std::string out;
  for (std::size_t at = 0; (at = text.find_first_not_of(kBlanks, at)) != std::string_view::npos;) {
    const auto end = std::min(text.find_first_of(kBlanks, at), text.size());
    if (!out.empty()) out += ' ';
    out += text.substr(at, end - at);
    at = end;
  }
  return out;
}

/// "(def-cram-function fetch-box" of a definition, else empty.
std::string key_of(const LispData& data, DatumId form) {
  const auto head = data.head(form);
  const auto items = data.children(form);
  if (!head || !head->starts_with("def") || items.size() < 2) return {};
  return "(" + std::string(*head) + " " + print_datum(data, items[1]);
}

/// Indices of children that stay, by the longest common subsequence of their texts.
std::vector<std::pair<std::size_t, std::size_t>> aligned(const std::vector<std::string>& a,
                                                         const std::vector<std::string>& b) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  if (b.size() + 1 > kMaxAligned / (a.size() + 1)) return out;
  const auto width = b.size() + 1;
  std::vector<std::size_t> best((a.size() + 1) * width, 0);
  for (auto i = a.size(); i-- > 0;) {
    for (auto j = b.size(); j-- > 0;) {
      best[i * width + j] = a[i] == b[j]
                                ? best[(i + 1) * width + j + 1] + 1
                                : std::max(best[(i + 1) * width + j], best[i * width + j + 1]);
    }
  }
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    if (a[i] == b[j]) {
      out.emplace_back(i++, j++);
    } else if (best[(i + 1) * width + j] >= best[i * width + j + 1]) {
      ++i;
    } else {
      ++j;
    }
  }
  return out;
}

class EditFinder {
 public:
  EditFinder(const LispText& a, const LispText& b, const base::SourceFiles& files)
      : a_(a), b_(b), files_(files) {}

  std::vector<DatumEdit> run(DatumId left, DatumId right) {
    open_.emplace_back(left, right);
    while (!open_.empty()) {
      const auto [x, y] = open_.back();
      open_.pop_back();
      if (x && y) {
        compare(*x, *y);
      } else {
        report(x, y);
      }
    }
    return std::move(edits_);
  }

 private:
  using MaybeDatum = std::optional<DatumId>;

  void report(MaybeDatum x, MaybeDatum y) {
    DatumEdit edit;
    if (x) {
      edit.removed = shortened(print_datum(a_.data, *x));
      edit.old_place = place_of(a_.data.source(*x), files_);
    }
    if (y) {
      edit.added = shortened(print_datum(b_.data, *y));
      edit.new_place = place_of(b_.data.source(*y), files_);
    }
    edits_.push_back(std::move(edit));
  }

  void compare(DatumId x, DatumId y) {
    if (equal_data(a_.data, x, b_.data, y)) return;
    const auto xs = a_.data.children(x), ys = b_.data.children(y);
    // Lists with different heads have little in common.
    const bool alike = !xs.empty() && !ys.empty() && equal_data(a_.data, xs[0], b_.data, ys[0]);
    if (!alike) return report(x, y);
    const auto begin = open_.size();
    std::size_t i = 0, j = 0;
    auto stays = aligned(texts(a_.data, xs), texts(b_.data, ys));
    stays.emplace_back(xs.size(), ys.size());
    for (const auto& [next_i, next_j] : stays) {
      const bool paired = next_i - i == next_j - j;
      while (i < next_i || j < next_j) {
        const auto left = i < next_i ? MaybeDatum(xs[i]) : std::nullopt;
        const auto right = j < next_j && (paired || !left) ? MaybeDatum(ys[j]) : std::nullopt;
        if (left) ++i;
        if (right) ++j;
        open_.emplace_back(left, right);
      }
      i = next_i + 1;
      j = next_j + 1;
    }
    // Found in the order of the text, taken from the end.
    std::reverse(open_.begin() + static_cast<std::ptrdiff_t>(begin), open_.end());
  }

  static std::vector<std::string> texts(const LispData& data, std::span<const DatumId> items) {
    std::vector<std::string> out;
    for (const auto item : items) out.push_back(print_datum(data, item));
    return out;
  }

  const LispText& a_;
  const LispText& b_;
  const base::SourceFiles& files_;
  std::vector<std::pair<MaybeDatum, MaybeDatum>> open_;
  std::vector<DatumEdit> edits_;
};

}  // namespace

std::vector<Fact> plan_facts(const LispText& plan, const base::SourceFiles& files) {
  std::vector<Fact> facts;
  std::string order;
  for (const auto form : plan.forms) {
    auto text = print_datum(plan.data, form);
    const auto key = key_of(plan.data, form);
    order += (order.empty() ? "" : " ") + (key.empty() ? shortened(text) : key + ")");
    facts.push_back(
        {FactKind::kAxiom, key, text, shortened(text), place_of(plan.data.source(form), files)});
  }
  if (plan.forms.size() > 1) {
    facts.push_back({FactKind::kDeclaration,
                     kOrderKey,
                     "order " + order,
                     "the forms in this order: " + shortened(order),
                     {files[plan.file].name(), 0}});
  }
  return facts;
}

void drop_equal_order(std::vector<Fact>& old_facts, std::vector<Fact>& new_facts) {
  const auto is_order = [](const Fact& fact) { return fact.key == kOrderKey; };
  // The names of the forms beside that fact; none if one stands twice.
  const auto names = [&](const std::vector<Fact>& facts) {
    std::vector<std::string> out;
    const auto order = std::find_if(facts.begin(), facts.end(), is_order);
    if (order == facts.end()) return out;
    for (const auto& fact : facts) {
      if (fact.kind != FactKind::kAxiom || fact.place.file != order->place.file) continue;
      out.push_back(fact.key.empty() ? fact.text : fact.key);
    }
    auto sorted = out;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) out.clear();
    return out;
  };
  auto before = names(old_facts), after = names(new_facts);
  if (before.empty() || after.empty()) return;
  const std::set<std::string> first(before.begin(), before.end());
  const std::set<std::string> second(after.begin(), after.end());
  std::erase_if(before, [&](const std::string& name) { return !second.contains(name); });
  std::erase_if(after, [&](const std::string& name) { return !first.contains(name); });
  if (before != after) return;
  std::erase_if(old_facts, is_order);
  std::erase_if(new_facts, is_order);
}

std::vector<Fact> binding_facts(base::FileId file, const base::SourceFiles& files) {
  const auto clean = clean_binding(files[file].text());
  std::vector<Fact> facts;
  for (std::size_t i = 0; i < clean.entries.size(); ++i) {
    const auto begin = clean.entries[i];
    const auto end = i + 1 < clean.entries.size() ? clean.entries[i + 1] : clean.text.size();
    const auto entry = std::string_view(clean.text).substr(begin, end - begin);
    std::string text;
    for (const auto word : words_of(entry)) {
      if (word != "\n" && word != "\t" && word != "\r") (text += text.empty() ? "" : " ") += word;
    }
    const auto arrow = text.find(" - >");
    const auto key = arrow == std::string::npos ? text : text.substr(0, arrow);
    const auto line = files[file].position(static_cast<std::uint32_t>(begin)).line;
    facts.push_back({FactKind::kAxiom, key, text, one_line(entry), {files[file].name(), line}});
  }
  return facts;
}

std::string canonical_plan(const LispText& plan) {
  std::string out;
  struct Task {
    DatumId datum;
    std::size_t indent = 0;
    bool closes = false;
  };
  std::vector<Task> tasks;
  for (auto form = plan.forms.rbegin(); form != plan.forms.rend(); ++form) {
    tasks.push_back({*form, 0, false});
  }
  while (!tasks.empty()) {
    const auto task = tasks.back();
    tasks.pop_back();
    if (task.closes) {
      out.insert(out.size() - 1, ")");  // behind what stands last
      continue;
    }
    const auto text = print_datum(plan.data, task.datum);
    const auto items = plan.data.children(task.datum);
    // Deep data are not laid out: print_datum looks at all of it again at every level.
    const bool fits = task.indent + text.size() <= kWidth || items.empty() || task.indent >= kWidth;
    out += std::string(task.indent, ' ');
    if (fits) {
      out += text + '\n';
      continue;
    }
    out += "(" + print_datum(plan.data, items.front()) + '\n';
    tasks.push_back({task.datum, 0, true});
    for (auto i = items.size(); i-- > 1;) tasks.push_back({items[i], task.indent + 2, false});
  }
  return out;
}

std::vector<DatumEdit> datum_edits(const LispText& old_plan, DatumId old_form,
                                   const LispText& new_plan, DatumId new_form,
                                   const base::SourceFiles& files) {
  return EditFinder(old_plan, new_plan, files).run(old_form, new_form);
}

}  // namespace parallax::compiler
