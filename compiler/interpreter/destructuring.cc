#include "compiler/interpreter/destructuring.h"

#include <fmt/core.h>

#include <string>
#include <vector>

#include "compiler/interpreter/variables.h"

namespace parallax::compiler {
namespace {

/// Walks one pattern; patterns inside are walked by others.
class Destructurer {
 public:
  Destructurer(FormCompiler& c, DatumId form, DatumId pattern, std::uint32_t place)
      : c_(c), form_(form), pattern_(pattern), place_(place) {}

  void bind() {
    const auto items = c_.data.children(pattern_);
    const bool dotted = c_.data.is_dotted(pattern_);
    if (is_plain(items, dotted)) check_length("%expect-length", items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (dotted && i + 1 == items.size()) {
        rest(items[i]);
        return;
      }
      if (is_marker(items[i])) {
        marker(items[i]);
      } else {
        parameter(items[i]);
      }
    }
    finish(is_plain(items, dotted));
  }

 private:
  bool is_marker(DatumId item) const {
    return c_.data.is_symbol(item) && c_.data.name(item).starts_with("&");
  }
  bool is_plain(FormItems items, bool dotted) const {
    for (const auto item : items) {
      if (is_marker(item)) return false;
    }
    return !dotted;
  }
  void check_length(std::string_view builtin, std::size_t count) {
    c_.code.load(place_, form_);
    c_.code.constant(c_.values.number(Number(static_cast<std::int64_t>(count))), form_);
    c_.code.builtin(builtin, 2, form_);
    c_.code.store_and_drop(place_, form_);
  }

  void marker(DatumId item) {
    mode_ = c_.data.name(item);
    if (mode_ == "&allow-other-keys") {
      other_keys_ = true;
    } else if (mode_ == "&key") {
      keys_ = true;
    } else if (mode_ != "&optional" && mode_ != "&rest" && mode_ != "&body" && mode_ != "&aux" &&
               mode_ != "&environment" && mode_ != "&whole") {
      c_.unsupported(item, "this marker in a pattern");
    }
  }

  void parameter(DatumId item) {
    if (mode_.empty()) return required(item);
    if (mode_ == "&rest" || mode_ == "&body") return rest(item);
    if (mode_ == "&environment") {
      c_.nil(form_);
      name_top(item);
      return;
    }
    if (mode_ == "&whole") {
      c_.code.load(place_, form_);
      name_top(item);
      mode_.clear();
      return;
    }
    const auto parts = c_.data.children(item);
    const bool listed = !parts.empty();
    const auto target = listed ? parts.front() : item;
    const auto value = parts.size() > 1 ? std::optional(parts[1]) : std::nullopt;
    const auto supplied = parts.size() > 2 ? std::optional(parts[2]) : std::nullopt;
    if (parts.size() > 3) c_.malformed(item, "expected (name default supplied)");
    if (mode_ == "&aux") {
      default_value(value);
      name_top(target);
    } else if (mode_ == "&key") {
      key(target, value, supplied);
    } else {
      optional(target, value, supplied);
    }
  }

  void required(DatumId item) {
    c_.code.load(place_, form_);
    c_.code.builtin("%next", 1, form_);
    step();
    name_top(item);
  }

  /// The rest of the list is what follows.
  void step() {
    c_.code.load(place_, form_);
    c_.code.builtin("cdr", 1, form_);
    c_.code.store_and_drop(place_, form_);
  }

  void rest(DatumId item) {
    c_.code.load(place_, form_);
    name_top(item);
    rest_ = true;
  }

  void default_value(std::optional<DatumId> value) {
    if (value) return c_.compile(*value);
    c_.nil(form_);
  }

  void optional(DatumId target, std::optional<DatumId> value, std::optional<DatumId> supplied) {
    c_.code.load(place_, form_);
    const auto to_default = c_.code.jump(PlanOp::kJumpIfNil, form_);
    c_.code.load(place_, form_);
    c_.code.builtin("%next", 1, form_);
    step();
    c_.code.constant(c_.values.truth(), form_);
    const auto to_end = c_.code.jump(PlanOp::kJump, form_);
    c_.code.adjust(-2);
    c_.code.patch_jump(to_default);
    default_value(value);
    c_.nil(form_);
    c_.code.patch_jump(to_end);
    name_both(target, supplied);
  }

  /// name, (name ...) or ((:keyword name) ...).
  void key(DatumId target, std::optional<DatumId> value, std::optional<DatumId> supplied) {
    auto word = target;
    const auto pair = c_.data.children(target);
    if (pair.size() == 2) {
      word = pair[0];
      target = pair[1];
    }
    if (!c_.data.is_symbol(word) && !c_.data.is_keyword(word)) {
      c_.malformed(form_, "a keyword parameter is a name");
      word = target;
    }
    const auto keyword = c_.values.keyword(c_.data.is_list(word) ? "" : c_.data.name(word));
    known_keys_.push_back(keyword);
    c_.code.load(place_, form_);
    c_.code.constant(keyword, form_);
    c_.code.builtin("%argument", 2, form_);
    const auto place = c_.code.height() - 1;
    c_.code.load(place, form_);
    c_.code.builtin("%given", 1, form_);
    c_.code.load(place + 1, form_);
    const auto to_default = c_.code.jump(PlanOp::kJumpIfNil, form_);
    const auto to_end = c_.code.jump(PlanOp::kJump, form_);
    c_.code.patch_jump(to_default);
    default_value(value);
    c_.code.store_and_drop(place, form_);
    c_.code.patch_jump(to_end);
    name_both(target, supplied);
  }

  /// The value, and above it whether it was given.
  void name_both(DatumId target, std::optional<DatumId> supplied) {
    if (supplied && c_.data.is_symbol(*supplied)) bind_top(c_, *supplied, form_);
    const auto place = c_.code.height() - 2;
    if (c_.data.is_list(target)) return destructure(c_, form_, target, place);
    if (!c_.data.is_symbol(target)) return c_.unsupported(target, "a pattern consists of names");
    bind_variable(c_, target, place, form_);
  }

  void name_top(DatumId target) {
    if (c_.data.is_nil(target)) return;  // (a nil b): a part that nobody wants
    if (c_.data.is_list(target)) return destructure(c_, form_, target, c_.code.height() - 1);
    if (!c_.data.is_symbol(target)) return c_.unsupported(target, "a pattern consists of names");
    bind_top(c_, target, form_);
  }

  void finish(bool plain) {
    if (keys_ && !other_keys_) {
      c_.code.load(place_, form_);
      c_.code.constant(c_.values.list(known_keys_), form_);
      c_.code.builtin("%expect-keys", 2, form_);
      c_.code.store_and_drop(place_, form_);
    } else if (!plain && !keys_ && !rest_) {
      check_length("%expect-length", 0);
    }
  }

  FormCompiler& c_;
  DatumId form_;
  DatumId pattern_;
  std::uint32_t place_ = 0;
  std::string mode_;
  bool rest_ = false;
  bool keys_ = false;
  bool other_keys_ = false;
  std::vector<ValueId> known_keys_;
};

}  // namespace

void destructure(FormCompiler& c, DatumId form, DatumId pattern, std::uint32_t place) {
  Destructurer(c, form, pattern, place).bind();
}

void compile_macro_parameters(FormCompiler& c, DatumId parameters) {
  auto items = c.data.children(parameters);
  if (!c.data.is_list(parameters) && !c.data.is_nil(parameters)) {
    c.malformed(parameters, "expected the parameters of a macro");
    return c.nil(parameters);
  }
  if (items.size() > 1 && c.data.is_symbol(items[0], "&whole")) {
    c.code.load(0, parameters);
    if (c.data.is_symbol(items[1])) bind_top(c, items[1], parameters);
    const auto source = c.data.source(parameters);
    const bool dotted = c.data.is_dotted(parameters);
    parameters = dotted && items.size() > 3
                     ? c.data.add_dotted({items.begin() + 2, items.end() - 1}, items.back(), source)
                     : c.data.add_list(items.subspan(2), source);
  }
  c.code.load(0, parameters);
  c.code.builtin("cdr", 1, parameters);
  destructure(c, parameters, parameters, c.code.height() - 1);
}

}  // namespace parallax::compiler
