#include "io/openscad/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cloud2csg::scad {
namespace {

std::string kind_name(const Value& value) {
  switch (value.kind) {
    case Value::Kind::undefined:
      return "undef";
    case Value::Kind::number:
      return fmt::format("{:.6g}", value.number);
    case Value::Kind::boolean:
      return value.number != 0 ? "true" : "false";
    case Value::Kind::text:
      return "a string";
    case Value::Kind::list:
      return fmt::format("a list of {}", value.items.size());
    case Value::Kind::range:
      return "a range";
  }
  return {};
}

double need_number(const Value& value, std::string_view text) {
  if (value.kind == Value::Kind::number && std::isfinite(value.number)) return value.number;
  refuse(text, value.offset, fmt::format("expected a number, found {}", kind_name(value)));
}

double apply(char operation, double a, double b) {
  switch (operation) {
    case '+':
      return a + b;
    case '-':
      return a - b;
    case '*':
      return a * b;
    case '/':
      return a / b;
    default:
      return std::fmod(a, b);
  }
}

Value number_at(std::size_t offset, double number) {
  return {.kind = Value::Kind::number, .offset = offset, .number = number};
}

bool is_list(const Value& value) {
  return value.kind == Value::Kind::list;
}

/// Numbers with numbers, vectors with vectors of their length, vectors times and by numbers.
Value combined(char operation, const Value& a, const Value& b, std::string_view text) {
  const bool is_sum = operation == '+' || operation == '-';
  Value result = is_list(a) ? a : b;
  if (is_list(a) && is_list(b) && is_sum) {
    if (a.items.size() != b.items.size()) {
      refuse(text, b.offset, fmt::format("expected a list of {}, found {}", a.items.size(), kind_name(b)));
    }
    for (std::size_t i = 0; i < a.items.size(); ++i) {
      result.items[i] = combined(operation, a.items[i], b.items[i], text);
    }
  } else if (is_list(a) && !is_list(b) && (operation == '*' || operation == '/')) {
    for (Value& item : result.items) item = combined(operation, item, b, text);
  } else if (is_list(b) && !is_list(a) && operation == '*') {
    for (Value& item : result.items) item = combined(operation, a, item, text);
  } else {
    result = number_at(a.offset, apply(operation, need_number(a, text), need_number(b, text)));
  }
  return result;
}

Value evaluate_list(const Term& term, const Scope& scope, std::string_view text) {
  Value list{.kind = Value::Kind::list, .offset = term.offset};
  list.items.reserve(term.operands.size());
  for (const Term& item : term.operands) {
    list.items.push_back(evaluate(item, scope, text));
    // Else a few lines, each a list of the one before many times over, would need all memory.
    if (item.kind != Term::Kind::list && is_list(list.items.back())) {
      const std::string found = item.kind == Term::Kind::name ? fmt::format("the list '{}'", item.text) : "a list";
      refuse(text, item.offset, "expected a number, found " + found, k_flatten);
    }
  }
  return list;
}

Value evaluate_range(const Term& term, const Scope& scope, std::string_view text) {
  Value range{.kind = Value::Kind::range, .offset = term.offset};
  for (const Term& bound : term.operands) {
    range.items.push_back(number_at(bound.offset, need_number(evaluate(bound, scope, text), text)));
  }
  if (range.items.size() == 2) {
    // OpenSCAD turns it around, and says that it will not for ever.
    if (range.items[0].number > range.items[1].number) {
      refuse(text, term.offset, "expected a range that rises, found one that falls",
             "give its step: [3 : -1 : 0], or [0 : 1 : -1] for none");
    }
    range.items.insert(range.items.begin() + 1, number_at(term.offset, 1.0));
  }
  if (range.items[1].number == 0.0) refuse(text, range.items[1].offset, "expected a step other than 0");
  return range;
}

}  // namespace

const Value* Scope::find(std::string_view name) const {
  for (const Scope* scope = this; scope != nullptr; scope = scope->outer) {
    if (const auto found = scope->values.find(name); found != scope->values.end()) return &found->second;
  }
  return nullptr;
}

Value evaluate(const Term& term, const Scope& scope, std::string_view text) {
  Value value{.kind = Value::Kind::number, .offset = term.offset, .number = term.number};
  switch (term.kind) {
    case Term::Kind::number:
      break;
    case Term::Kind::text:
      value.kind = Value::Kind::text;
      break;
    case Term::Kind::boolean:
      value.kind = Value::Kind::boolean;
      break;
    case Term::Kind::undefined:
      value.kind = Value::Kind::undefined;
      break;
    case Term::Kind::name: {
      const Value* const found = scope.find(term.text);
      if (found == nullptr) {
        refuse(text, term.offset, fmt::format("expected a variable that has a value here, found '{}'", term.text),
               k_flatten);
      }
      value = *found;
      value.offset = term.offset;
      break;
    }
    case Term::Kind::list:
      return evaluate_list(term, scope, text);
    case Term::Kind::range:
      return evaluate_range(term, scope, text);
    case Term::Kind::negation:
      value = combined('*', number_at(term.offset, -1.0), evaluate(term.operands.front(), scope, text), text);
      break;
    case Term::Kind::denial: {
      const Value denied = evaluate(term.operands.front(), scope, text);
      if (denied.kind != Value::Kind::boolean) {
        refuse(text, denied.offset, fmt::format("expected true or false, found {}", kind_name(denied)));
      }
      value = {.kind = Value::Kind::boolean, .offset = term.offset, .number = denied.number != 0 ? 0.0 : 1.0};
      break;
    }
    case Term::Kind::chain:
      value = evaluate(term.operands.front(), scope, text);
      for (std::size_t i = 0; i < term.text.size(); ++i) {
        value = combined(term.text[i], value, evaluate(term.operands[i + 1], scope, text), text);
      }
      break;
  }
  return value;
}

std::vector<Value> turns_of(const Value& value, std::size_t most, std::string_view text) {
  if (is_list(value)) return value.items;
  if (value.kind != Value::Kind::range) {
    refuse(text, value.offset, fmt::format("expected a list or a range like [0 : 3], found {}", kind_name(value)));
  }
  const double begin = value.items[0].number;
  const double step = value.items[1].number;
  const double end = value.items[2].number;
  // The next larger number, as in OpenSCAD: [0 : 0.1 : 0.3] has its end, though three tenths are a little more.
  const double steps = std::nextafter((end - begin) / step, std::numeric_limits<double>::max());
  if (steps < 0) return {};
  if (!(steps < static_cast<double>(most))) {
    refuse(text, value.offset, fmt::format("expected at most {} turns of a loop, found more", most));
  }
  std::vector<Value> turns;
  for (std::size_t i = 0; static_cast<double>(i) <= steps; ++i) {
    turns.push_back(number_at(value.offset, begin + static_cast<double>(i) * step));
  }
  return turns;
}

Arguments::Arguments(const Statement& call, std::span<const std::string_view> order,
                     std::span<const std::string_view> others, const Scope& scope, std::string_view text)
    : text_(text), offset_(call.offset) {
  std::size_t place = 0;
  for (const Argument& argument : call.arguments) {
    std::string name = argument.name;
    if (name.empty()) {
      if (place == order.size()) {
        refuse(
            text, argument.value.offset,
            fmt::format("expected at most {} arguments of {}() without a name, found more", order.size(), call.name));
      }
      name = order[place++];
    }
    const bool is_known = name.starts_with('$') || std::ranges::find(order, name) != order.end() ||
                          std::ranges::find(others, name) != others.end();
    if (!is_known) {
      refuse(text, argument.value.offset, fmt::format("expected an argument of {}(), found '{}'", call.name, name));
    }
    if (!values_.emplace(name, evaluate(argument.value, scope, text)).second) {
      refuse(text, argument.value.offset, fmt::format("expected '{}' once, found it twice", name));
    }
  }
  if (const Value* const facets = scope.find("$fn"); facets != nullptr) values_.emplace("$fn", *facets);
}

const Value* Arguments::find(std::string_view name) const {
  const auto found = values_.find(name);
  return found == values_.end() || found->second.kind == Value::Kind::undefined ? nullptr : &found->second;
}

std::optional<double> Arguments::number(std::string_view name) const {
  const Value* const value = find(name);
  return value == nullptr ? std::nullopt : std::optional(need_number(*value, text_));
}

bool Arguments::flag(std::string_view name) const {
  const Value* const value = find(name);
  if (value == nullptr) return false;
  if (value->kind != Value::Kind::boolean) fail(*value, fmt::format("true or false for '{}'", name));
  return value->number != 0;
}

std::vector<double> Arguments::numbers(const Value& value) const {
  if (value.kind != Value::Kind::list) fail(value, "a list of numbers");
  std::vector<double> numbers;
  numbers.reserve(value.items.size());
  for (const Value& item : value.items) numbers.push_back(need_number(item, text_));
  return numbers;
}

Eigen::Vector3d Arguments::vector(const Value& value, double rest) const {
  const std::vector<double> found = numbers(value);
  if (found.empty() || found.size() > 3) fail(value, "one to three numbers");
  Eigen::Vector3d vector = Eigen::Vector3d::Constant(rest);
  std::ranges::copy(found, vector.data());
  return vector;
}

void Arguments::fail(const Value& at, const std::string& expected) const {
  refuse(text_, at.offset, fmt::format("expected {}, found {}", expected, kind_name(at)));
}

}  // namespace cloud2csg::scad
