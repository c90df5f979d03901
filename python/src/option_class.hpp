#pragma once

#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "cloud2csg/primitive.hpp"

namespace cloud2csg::python {

/// The type that a field has in Python's notation.
template <typename Value>
std::string python_type() {
  if constexpr (std::is_same_v<Value, bool>) return "bool";
  if constexpr (std::is_integral_v<Value>) return "int";
  if constexpr (std::is_floating_point_v<Value>) return "float";
  if constexpr (std::is_same_v<Value, std::string>) return "str";
  if constexpr (std::is_same_v<Value, std::vector<double>>) return "list[float]";
  if constexpr (std::is_same_v<Value, PrimitiveSet>) return "list[Primitive]";
  if constexpr (std::is_aggregate_v<Value>) {
    return pybind11::type::of<Value>().attr("__name__").template cast<std::string>();
  }
  return {};
}
template <typename Value>
struct IsOptional : std::false_type {};
template <typename Value>
struct IsOptional<std::optional<Value>> : std::true_type {};

/// An options struct as a Python class: a constructor with the fields as keywords, attributes with their default and
/// meaning as docstrings, repr, equality, copies and pickles. Values of a wrong type are a TypeError that names the
/// field; whether they are in range is for the function that takes the options to say.
template <typename Options>
class OptionClass {
 public:
  OptionClass(pybind11::module_& module, const char* name, std::string doc)
      : class_(module, name), name_(name), doc_(std::move(doc)) {}

  /// A number, a text or a list, any of them optional; or options that may be absent.
  template <typename Value>
  OptionClass& field(const char* name, Value Options::*member, const std::string& doc) {
    return add(
        name, type_of<Value>(), [member](const Options& options) { return options.*member; },
        [member](Options& options, const pybind11::handle& value) { options.*member = value.cast<Value>(); }, doc);
  }

  /// Vectors, which are lists of three numbers each in Python.
  OptionClass& vectors(const char* name, std::vector<Eigen::Vector3d> Options::*member, const std::string& doc) {
    using Rows = std::vector<std::array<double, 3>>;
    return add(
        name, "list[list[float]]",
        [member](const Options& options) {
          Rows rows;
          rows.reserve((options.*member).size());
          for (const Eigen::Vector3d& v : options.*member) rows.push_back({v.x(), v.y(), v.z()});
          return rows;
        },
        [member](Options& options, const pybind11::handle& value) {
          std::vector<Eigen::Vector3d> vectors;
          for (const auto& [x, y, z] : value.cast<Rows>()) vectors.emplace_back(x, y, z);
          options.*member = std::move(vectors);
        },
        doc);
  }

  /// Options within options: the attribute is a reference, so that options.search.seed = 3 works.
  template <typename Value>
  OptionClass& nested(const char* name, Value Options::*member, const std::string& doc) {
    const auto type = pybind11::type::of<Value>().attr("__name__").template cast<std::string>();
    return add(
        name, type, [member](Options& options) -> Value& { return options.*member; },
        [member](Options& options, const pybind11::handle& value) { options.*member = value.cast<Value>(); }, doc);
  }

  template <typename Value>
  using Choices = std::vector<std::pair<std::string_view, Value>>;

  /// An enumeration, which is a text in Python.
  template <typename Value>
  OptionClass& choice(const char* name, Value Options::*member, const Choices<Value>& choices, const std::string& doc) {
    std::string type;
    for (const auto& [text, value] : choices) type += fmt::format("{}'{}'", type.empty() ? "" : ", ", text);
    type = "Literal[" + type + "]";
    return add(
        name, type,
        [member, choices](const Options& options) {
          for (const auto& [text, value] : choices) {
            if (value == options.*member) return std::string(text);
          }
          return std::string();
        },
        [member, choices](Options& options, const pybind11::handle& wanted) {
          const auto word = wanted.cast<std::string>();
          for (const auto& [text, value] : choices) {
            if (text != word) continue;
            options.*member = value;
            return;
          }
          throw pybind11::cast_error();
        },
        doc);
  }

  /// After all fields.
  pybind11::class_<Options> finish() {
    define_constructors();
    define_values();
    class_.attr("__doc__") = doc_ + "\n\nAll fields are keywords of the constructor, and attributes.\n" + field_docs_;
    class_.attr("__annotations__") = annotations_;
    return class_;
  }

 private:
  using Setter = std::function<void(Options&, const pybind11::handle&)>;
  struct Field {
    std::string name, type;
    Setter set;
  };
  using Fields = std::shared_ptr<std::vector<Field>>;

  template <typename Value>
  static std::string type_of() {
    if constexpr (IsOptional<Value>::value) {
      return python_type<typename Value::value_type>() + " | None";
    } else {
      return python_type<Value>();
    }
  }

  template <typename Getter>
  OptionClass& add(const char* name, const std::string& type, Getter getter, const Setter& setter,
                   const std::string& doc) {
    Setter set = [what = name_ + "." + name, type, setter](Options& options, const pybind11::handle& value) {
      try {
        setter(options, value);
      } catch (const pybind11::cast_error&) {
        throw pybind11::type_error(
            fmt::format("{}: expected {}, found {}", what, type, pybind11::repr(value).cast<std::string>()));
      }
    };
    fields_->push_back({.name = name, .type = type, .set = set});
    const Options defaults{};
    const auto start =
        pybind11::repr(pybind11::cast(getter(const_cast<Options&>(defaults)))).template cast<std::string>();
    const std::string text = fmt::format("{}, default {}. {}", type, start, doc);
    class_.def_property(name, pybind11::cpp_function(getter, pybind11::return_value_policy::reference_internal),
                        pybind11::cpp_function(set), text.c_str());
    field_docs_ += fmt::format("\n{} : {}\n", name, text);
    annotations_[name] = type;
    return *this;
  }

  static void set_fields(Options& options, const std::string& class_name, const Fields& fields,
                         const pybind11::dict& values) {
    for (const auto& [key, value] : values) {
      const auto name = key.template cast<std::string>();
      const Field* found = nullptr;
      for (const Field& field : *fields) {
        if (field.name == name) found = &field;
      }
      if (found == nullptr) throw pybind11::type_error(fmt::format("{} has no field '{}'", class_name, name));
      found->set(options, value);
    }
  }

  static pybind11::dict values_of(const pybind11::object& self, const Fields& fields) {
    pybind11::dict values;
    for (const Field& field : *fields) values[field.name.c_str()] = self.attr(field.name.c_str());
    return values;
  }

  void define_constructors() {
    const auto make = [name = name_, fields = fields_](const pybind11::dict& values) {
      Options options{};
      set_fields(options, name, fields, values);
      return options;
    };
    class_.def(pybind11::init([make](const pybind11::kwargs& values) { return make(values); }));
    class_.def(
        "replace",
        [name = name_, fields = fields_](const Options& self, const pybind11::kwargs& values) {
          Options options = self;
          set_fields(options, name, fields, values);
          return options;
        },
        "A copy with other values for the fields that are named.");
    class_.def("__copy__", [](const Options& self) { return self; });
    class_.def("__deepcopy__", [](const Options& self, const pybind11::dict&) { return self; });
    class_.def(pybind11::pickle([fields = fields_](const pybind11::object& self) { return values_of(self, fields); },
                                [make](const pybind11::dict& values) { return make(values); }));
  }

  void define_values() {
    class_.def("__repr__", [name = name_, fields = fields_](const pybind11::object& self) {
      std::string text;
      for (const Field& field : *fields) {
        text += fmt::format("{}{}={}", text.empty() ? "" : ", ", field.name,
                            pybind11::repr(self.attr(field.name.c_str())).template cast<std::string>());
      }
      return fmt::format("{}({})", name, text);
    });
    class_.def("__eq__", [fields = fields_](const pybind11::object& self, const pybind11::object& other) {
      return pybind11::isinstance<Options>(other) && values_of(self, fields).equal(values_of(other, fields));
    });
    class_.attr("__hash__") = pybind11::none();
  }

  pybind11::class_<Options> class_;
  std::string name_, doc_, field_docs_;
  Fields fields_ = std::make_shared<std::vector<Field>>();
  pybind11::dict annotations_;
};

/// `options`, or the defaults where it is None, with other values for the fields that `fields` names.
template <typename Options>
Options with_fields(const std::optional<Options>& options, const pybind11::kwargs& fields) {
  const Options start = options.value_or(Options{});
  if (fields.empty()) return start;
  return pybind11::cast(start).attr("replace")(**fields).template cast<Options>();
}

}  // namespace cloud2csg::python
