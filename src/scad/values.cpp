#include "scad/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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
      value.kind = Value::Kind::list;
      value.items.reserve(term.operands.size());
      for (const Term& item : term.operands) {
        value.items.push_back(evaluate(item, scope, text));
        // Else a few lines, each a list of the one before many times over, would need all memory.
        if (item.kind == Term::Kind::name && value.items.back().kind == Value::Kind::list) {
          refuse(text, item.offset, fmt::format("expected a number, found the list '{}'", item.text), k_flatten);
        }
      }
      break;
    case Term::Kind::negation:
      value.number = -need_number(evaluate(term.operands.front(), scope, text), text);
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
      value.number = need_number(evaluate(term.operands.front(), scope, text), text);
      for (std::size_t i = 0; i < term.text.size(); ++i) {
        value.number =
            apply(term.text[i], value.number, need_number(evaluate(term.operands[i + 1], scope, text), text));
      }
      break;
  }
  return value;
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
