#include "io/scripts/openscad_blocks.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace cloud2csg::openscad {
namespace {

using Kind = script::Step::Kind;

/// Not recursive: a chain may be as deep as it is long.
class BlockPrinter {
 public:
  BlockPrinter(const script::Plan& plan, const Wording& wording, Intersections intersections)
      : plan_(plan), wording_(wording), intersections_(intersections) {}

  std::string print() {
    to_do_.push_back({.step = plan_.steps.size() - 1, .text = {}, .level = 0});
    while (!to_do_.empty()) {
      const Item item = std::move(to_do_.back());
      to_do_.pop_back();
      if (item.text.empty()) {
        print_step(item.step, item.level);
      } else {
        print_line(item.text, item.level);
      }
    }
    return std::move(out_);
  }

 private:
  /// Pending output: a line, or a step if the text is empty.
  struct Item {
    std::size_t step;
    std::string text;
    std::size_t level;
  };

  void print_line(const std::string& text, std::size_t level) {
    constexpr std::size_t k_deepest = 40;  // keeps a long chain from growing quadratically
    out_.append(2 * std::min(level, k_deepest), ' ');
    out_ += text + "\n";
  }

  void print_step(std::size_t index, std::size_t level) {
    const script::Step& step = plan_.steps[index];
    const std::optional<std::string> before = wording_.before(index);
    if (!before) return;
    if (step.kind == Kind::primitive || step.kind == Kind::everything) {
      print_line(*before + wording_.statement_of(index), level);
    } else if (step.kind == Kind::common) {
      print_common(step, *before, level);
    } else if (step.kept.empty()) {
      print_line("union();  // the empty solid", level);
    } else {
      open(*before + "union", level);
      push(step.kept, level + 1);
    }
  }

  void print_common(const script::Step& step, const std::string& before, std::size_t level) {
    if (step.removed.empty()) {
      push_intersection(step.kept, before, level);
      return;
    }
    open(before + "difference", level);
    push(step.removed, level + 1);
    if (step.kept.size() == 1) {
      push(step.kept, level + 1);
    } else {
      push_intersection(step.kept, "", level + 1);
    }
  }

  void push_intersection(const std::vector<std::size_t>& steps, const std::string& before, std::size_t level) {
    const std::size_t blocks = intersections_ == Intersections::in_pairs ? steps.size() - 1 : 1;
    for (std::size_t block = 0; block < blocks; ++block) {
      push_line("}", level + block);
      if (block + 1 < blocks) push({steps[steps.size() - 1 - block]}, level + block + 1);
    }
    push({steps.begin(), steps.end() - static_cast<std::ptrdiff_t>(blocks - 1)}, level + blocks);
    for (std::size_t block = blocks; block-- > 0;) {
      push_line((block == 0 ? before : "") + "intersection() {", level + block);
    }
  }

  void open(const std::string& operation, std::size_t level) {
    print_line(operation + "() {", level);
    push_line("}", level);
  }

  void push_line(const std::string& text, std::size_t level) {
    to_do_.push_back({.step = 0, .text = text, .level = level});
  }

  /// Pushes in reverse, because the stack is last in, first out.
  void push(const std::vector<std::size_t>& steps, std::size_t level) {
    for (std::size_t i = steps.size(); i-- > 0;) to_do_.push_back({.step = steps[i], .text = {}, .level = level});
  }

  const script::Plan& plan_;
  const Wording& wording_;
  Intersections intersections_;
  std::vector<Item> to_do_ = {};
  std::string out_ = {};
};

}  // namespace

std::string print_blocks(const script::Plan& plan, const Wording& wording, Intersections intersections) {
  return BlockPrinter(plan, wording, intersections).print();
}

}  // namespace cloud2csg::openscad
