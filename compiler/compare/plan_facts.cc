// Facts of plans and binding tables, for comparison, and the edits between two forms of a plan.
//
// A fact is a form in canonical print with its name as key; another one tells the order of the
// forms. Edits are found from the outside in. Lists with equal heads are aligned by the longest
// common subsequence of their children (Wagner and Fischer 1974); between those that stay, data
// that stand unchanged inside a new one are a wrap (or an unwrapping), other data are compared
// in pairs if both sides have as many, and otherwise are removed and added. Lists with different
// heads are replaced as a whole.
//
// Cost: the product of two lists' lengths times the size of their texts. Products above a limit
// are not aligned, and the search for wraps ends after a limited number of steps.

#include "compiler/compare/plan_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "compiler/base/words.h"
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

Fact order_fact(const char* key, const char* of_what, std::vector<std::string> sequence,
                const std::string& file) {
  std::string whole, shown;
  for (const auto& name : sequence) {
    whole += ' ' + name;
    if (shown.size() <= kMaxFormShown) shown += ' ' + shortened(name);
  }
  return {FactKind::kDeclaration,
          key,
          "order" + whole,
          fmt::format("{} in this order:{}", of_what, shortened(shown)),
          {file, 0},
          std::move(sequence)};
}

/// Does what both lists have stand in the same order? Not known where a name stands twice.
bool are_in_one_order(std::vector<std::string> before, std::vector<std::string> after) {
  const std::set<std::string> first(before.begin(), before.end());
  const std::set<std::string> second(after.begin(), after.end());
  if (first.size() != before.size() || second.size() != after.size()) return before == after;
  std::erase_if(before, [&](const std::string& name) { return !second.contains(name); });
  std::erase_if(after, [&](const std::string& name) { return !first.contains(name); });
  return before == after;
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
    compare_rest({&left, 1}, {&right, 1});
    while (!open_.empty()) {
      const auto next = std::move(open_.back());
      open_.pop_back();
      if (next.found) {
        edits_.push_back(*next.found);
      } else if (next.x && next.y) {
        compare(*next.x, *next.y);
      } else {
        report(next.x, next.y);
      }
    }
    return std::move(edits_);
  }

 private:
  using MaybeDatum = std::optional<DatumId>;
  /// A pair to be compared, or the edit found for it already.
  struct Pair {
    MaybeDatum x, y;
    std::optional<DatumEdit> found;
  };

  void report(MaybeDatum x, MaybeDatum y) {
    DatumEdit edit;
    if (x) {
      edit.removed = print_datum(a_.data, *x);
      edit.old_place = place_of(a_.data.source(*x), files_);
    }
    if (y) {
      edit.added = print_datum(b_.data, *y);
      edit.new_place = place_of(b_.data.source(*y), files_);
    }
    if (x && y) {
      std::tie(edit.removed, edit.added) = changed_parts(edit.removed, edit.added);
    } else {
      edit.removed = shortened(std::move(edit.removed));
      edit.added = shortened(std::move(edit.added));
    }
    edits_.push_back(std::move(edit));
  }

  /// The outer datum with `...` for the first `length` of some data that stand in it side by side.
  struct Wrap {
    std::string text;
    std::size_t length = 0;
  };

  /// Does the first of the inner data stand, as it is, somewhere inside the outer one? With those
  /// behind it that follow there as well.
  std::optional<Wrap> find_wrap(const LispData& inner_data, std::span<const DatumId> inner,
                                const LispData& outer_data, DatumId outer) {
    // A name or a number may stand anywhere.
    if (++wrap_steps_ > kMaxAligned || inner_data.children(inner.front()).empty()) {
      return std::nullopt;
    }
    struct Place {
      DatumId list;
      std::size_t parent = 0;    // in `places`
      std::size_t position = 0;  // among its children
    };
    std::vector<Place> places = {{outer, 0, 0}};
    for (std::size_t at = 0; at < places.size(); ++at) {
      const auto items = outer_data.children(places[at].list);
      for (std::size_t i = 0; i < items.size(); ++i) {
        if (wrap_steps_++ > kMaxAligned) return std::nullopt;
        std::size_t length = 0;
        while (length < inner.size() && i + length < items.size() &&
               equal_data(inner_data, inner[length], outer_data, items[i + length])) {
          ++length;
        }
        if (length > 0) {
          return Wrap{around(outer_data, places, at, i, length), length};
        }
        if (!outer_data.children(items[i]).empty()) places.push_back({items[i], at, i});
      }
    }
    return std::nullopt;
  }

  /// Text around those children of a place, up to the first place.
  template <typename Places>
  static std::string around(const LispData& data, const Places& places, std::size_t at,
                            std::size_t position, std::size_t length) {
    std::string front, back;
    for (;;) {
      std::string before, after;
      const auto siblings = data.children(places[at].list);
      for (std::size_t k = 0; k < siblings.size(); ++k) {
        if (k < position) before += print_datum(data, siblings[k]) + ' ';
        if (k >= position + length) after += ' ' + print_datum(data, siblings[k]);
      }
      front = "(" + before + front;
      back += after + ")";
      if (at == 0) return front + "..." + back;
      position = places[at].position;
      length = 1;
      at = places[at].parent;
    }
  }

  DatumEdit wrap_edit(const Wrap& wrap, DatumId first, DatumId outer, bool added) const {
    DatumEdit edit;
    edit.around = shortened(print_datum((added ? a_ : b_).data, first));
    if (wrap.length > 1) edit.around += " and what follows it";
    (added ? edit.added : edit.removed) = shortened(wrap.text);
    edit.old_place = place_of(a_.data.source(added ? first : outer), files_);
    edit.new_place = place_of(b_.data.source(added ? outer : first), files_);
    return edit;
  }

  /// Data that have no equal on the other side: what one of them wraps is found, the rest is
  /// compared in pairs or stands alone.
  void compare_rest(std::span<const DatumId> xs, std::span<const DatumId> ys) {
    while (next_wrap(xs, ys)) {
    }
    pair_up(xs, ys);
  }

  /// Takes the first wrap and what stands before it off both sides. False if there is none, or if
  /// looking for it takes too long.
  bool next_wrap(std::span<const DatumId>& xs, std::span<const DatumId>& ys) {
    for (std::size_t i = 0; i < xs.size(); ++i) {
      for (std::size_t j = 0; j < ys.size(); ++j) {
        if (wrap_steps_ > kMaxAligned) return false;
        auto wrap = find_wrap(a_.data, xs.subspan(i), b_.data, ys[j]);
        const bool added = wrap.has_value();
        if (!wrap) wrap = find_wrap(b_.data, ys.subspan(j), a_.data, xs[i]);
        if (!wrap) continue;
        pair_up(xs.first(i), ys.first(j));
        const auto edit =
            added ? wrap_edit(*wrap, xs[i], ys[j], true) : wrap_edit(*wrap, ys[j], xs[i], false);
        open_.push_back({{}, {}, edit});
        xs = xs.subspan(i + (added ? wrap->length : 1));
        ys = ys.subspan(j + (added ? 1 : wrap->length));
        return true;
      }
    }
    return false;
  }

  void pair_up(std::span<const DatumId> xs, std::span<const DatumId> ys) {
    const bool paired = xs.size() == ys.size();
    for (std::size_t i = 0; i < xs.size(); ++i) {
      open_.push_back({xs[i], paired ? MaybeDatum(ys[i]) : std::nullopt, {}});
    }
    for (std::size_t j = 0; !paired && j < ys.size(); ++j) open_.push_back({{}, ys[j], {}});
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
      compare_rest(xs.subspan(i, next_i - i), ys.subspan(j, next_j - j));
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
  std::vector<Pair> open_;
  std::vector<DatumEdit> edits_;
  std::size_t wrap_steps_ = 0;
};

}  // namespace

std::vector<Fact> plan_facts(const LispText& plan, const base::SourceFiles& files) {
  std::vector<Fact> facts;
  std::vector<std::string> order;
  for (const auto form : plan.forms) {
    auto text = print_datum(plan.data, form);
    const auto key = key_of(plan.data, form);
    order.push_back(key.empty() ? text : key + ")");
    facts.push_back(
        {FactKind::kAxiom, key, text, shortened(text), place_of(plan.data.source(form), files)});
  }
  if (order.size() > 1) {
    facts.push_back(order_fact(kOrderKey, "the forms", std::move(order), files[plan.file].name()));
  }
  return facts;
}

Fact declaration_order(const std::vector<Fact>& facts) {
  std::vector<std::string> order;
  for (const auto& fact : facts) {
    if (fact.kind == FactKind::kDeclaration) order.push_back(fact.key);
  }
  const auto file = facts.empty() ? std::string() : facts.front().place.file;
  return order_fact("order of the declarations", "the declarations", std::move(order), file);
}

void drop_equal_order(std::vector<Fact>& old_facts, std::vector<Fact>& new_facts) {
  for (std::size_t i = 0; i < old_facts.size();) {
    const auto twin = std::find_if(new_facts.begin(), new_facts.end(), [&](const Fact& fact) {
      return !fact.sequence.empty() && fact.key == old_facts[i].key;
    });
    const bool same = !old_facts[i].sequence.empty() && twin != new_facts.end() &&
                      are_in_one_order(old_facts[i].sequence, twin->sequence);
    if (!same) {
      ++i;
      continue;
    }
    new_facts.erase(twin);
    old_facts.erase(old_facts.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

std::vector<Fact> binding_facts(base::FileId file, const base::SourceFiles& files) {
  const auto clean = clean_binding(files[file].text());
  std::vector<Fact> facts;
  std::vector<std::string> order;
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
    order.push_back(key);
    facts.push_back(
        {FactKind::kAxiom, key, text, base::one_line(entry), {files[file].name(), line}});
  }
  if (order.size() > 1) {
    facts.push_back(order_fact("order of the entries", "the entries of the binding table",
                               std::move(order), files[file].name()));
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
