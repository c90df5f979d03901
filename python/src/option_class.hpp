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
#include <type_traits>
#include <utility>
#include <vector>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/primitive.hpp"

namespace cloud2csg::python {

/// Vectors are lists of three numbers in Python.
using Rows = std::vector<std::array<double, 3>>;

template <typename Value>
struct PythonType {
  static std::string name() {
    if constexpr (std::is_same_v<Value, bool>) return "bool";
    if constexpr (std::is_integral_v<Value>) return "int";
    if constexpr (std::is_floating_point_v<Value>) return "float";
    if constexpr (std::is_same_v<Value, std::string>) return "str";
    if constexpr (std::is_same_v<Value, Primitive>) return "Primitive";
    if constexpr (std::is_same_v<Value, Eigen::Vector3d>) return "list[float]";
    if constexpr (HasOptionTable<Value>) {
      return pybind11::type::of<Value>().attr("__name__").template cast<std::string>();
    }
    if constexpr (HasNames<Value>) {
      std::string names;
      for (const EnumName<Value>& known : names_of(Value{})) {
        names += fmt::format("{}'{}'", names.empty() ? "" : ", ", known.name);
      }
      return "Literal[" + names + "]";
    }
    return {};
  }
};
template <typename Value>
struct PythonType<std::optional<Value>> {
  static std::string name() { return PythonType<Value>::name() + " | None"; }
};
template <typename Value>
struct PythonType<std::vector<Value>> {
  static std::string name() { return "list[" + PythonType<Value>::name() + "]"; }
};

/// A field's value: nested options by reference (options.search.seed = 3), lists and optional options as copies.
template <typename Value>
decltype(auto) to_python(Value& value) {
  if constexpr (HasNames<Value>) {
    return std::string(to_string(value));
  } else if constexpr (std::is_same_v<Value, std::vector<Eigen::Vector3d>>) {
    Rows rows;
    for (const Eigen::Vector3d& v : value) rows.push_back({v.x(), v.y(), v.z()});
    return rows;
  } else if constexpr (HasOptionTable<Value>) {
    return static_cast<Value&>(value);
  } else {
    return Value(value);
  }
}

/// @throws pybind11::cast_error
template <typename Value>
void from_python(const pybind11::handle& given, Value& value) {
  if constexpr (HasNames<Value>) {
    const std::optional<Value> named = enum_named<Value>(given.cast<std::string>());
    if (!named) throw pybind11::cast_error();
    value = *named;
  } else if constexpr (std::is_same_v<Value, std::vector<Eigen::Vector3d>>) {
    value.clear();
    for (const auto& [x, y, z] : given.cast<Rows>()) value.emplace_back(x, y, z);
  } else {
    // pybind11 would convert None to False.
    if (std::is_same_v<Value, bool> && given.is_none()) throw pybind11::cast_error();
    value = given.cast<Value>();
  }
}

/// An options struct as a Python class, made from its table: keyword constructor, attributes with default and meaning
/// as docstrings, repr, equality, copies and pickles. A value of a wrong type is a TypeError that names the field. The
/// function that takes the options checks ranges.
template <typename Options>
class OptionClass {
 public:
  OptionClass(pybind11::module_& module, const char* name, std::string doc)
      : class_(module, name), name_(name), doc_(std::move(doc)) {
    for_each_field<Options>([this](auto member, const OptionField& field) { this->add(member, field); });
    define_constructors();
    define_values();
    class_.attr("__doc__") = doc_ + "\n\nAll fields are keywords of the constructor, and attributes.\n" + field_docs_;
    class_.attr("__annotations__") = annotations_;
  }

  [[nodiscard]] pybind11::class_<Options>& python() { return class_; }

 private:
  using Setter = std::function<void(Options&, const pybind11::handle&)>;
  struct Field {
    std::string name, type;
    Setter set;
  };
  using Fields = std::shared_ptr<std::vector<Field>>;

  template <typename Value>
  void add(Value Options::*member, const OptionField& field) {
    const std::string name(field.name);
    const std::string type = PythonType<Value>::name();
    const auto get = [member](Options& options) -> decltype(auto) { return to_python(options.*member); };
    Setter set = [what = name_ + "." + name, type, member](Options& options, const pybind11::handle& value) {
      const auto refuse = [&] {
        throw pybind11::type_error(
            fmt::format("{}: expected {}, found {}", what, type, pybind11::repr(value).cast<std::string>()));
      };
      try {
        from_python(value, options.*member);
      } catch (const pybind11::cast_error&) {
        refuse();
      } catch (const pybind11::reference_cast_error&) {  // None for options
        refuse();
      }
    };
    fields_->push_back({.name = name, .type = type, .set = set});
    Options defaults{};
    const auto start = pybind11::repr(pybind11::cast(get(defaults))).template cast<std::string>();
    const std::string text =
        fmt::format("{}, default {}. {}{}{}", type, start, field.text, field.text.ends_with('.') ? "" : ".",
                    field.absent.empty() ? "" : fmt::format(" None: {}.", field.absent));
    class_.def_property(name.c_str(), pybind11::cpp_function(get, pybind11::return_value_policy::reference_internal),
                        pybind11::cpp_function(set), text.c_str());
    field_docs_ += fmt::format("\n{} : {}\n", name, text);
    annotations_[name.c_str()] = type;
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
        "A copy with the named fields changed.");
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

/// `options`, or the defaults for None, with the values in `fields`.
template <typename Options>
Options with_fields(const std::optional<Options>& options, const pybind11::kwargs& fields) {
  const Options start = options.value_or(Options{});
  if (fields.empty()) return start;
  return pybind11::cast(start).attr("replace")(**fields).template cast<Options>();
}

/// Makes the class of a struct; the returned class takes further methods.
template <typename Options>
pybind11::class_<Options> add_options(pybind11::module_& module, const char* name, const char* doc) {
  OptionClass<Options> made(module, name, doc);
  return made.python();
}

}  // namespace cloud2csg::python
