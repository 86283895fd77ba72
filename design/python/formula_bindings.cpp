// SPDX-License-Identifier: MIT
#include "core/expression/parse_formula.hpp"
#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/errors.hpp"
#include "design/python/records.hpp"

namespace fettle::design::python {

namespace py = pybind11;
using core::expression::Formula;
using core::expression::Node;
using core::expression::Operation;
using core::expression::Scope;

bool is_followed(py::handle given) { return py::isinstance<Formula>(given) || py::isinstance(given, record_class("Parameter")); }

Formula formula_from(py::handle given) {
    if (py::isinstance<Formula>(given)) return given.cast<Formula>();
    if (py::isinstance(given, record_class("Parameter"))) {
        const std::string unit = py::str(given.attr("unit"));
        const Unit* known = unit.empty() ? core::base::find_unit("1") : core::base::find_unit(unit);
        if (known == nullptr) refuse(ErrorCode::out_of_range, "formula", "\"" + unit + "\" is no unit");
        Formula out = core::expression::input_formula(py::str(given.attr("name")), core::expression::powers_of(known->dimension));
        out.text = core::expression::quoted_if_needed(out.inputs.front());
        return out;
    }
    if (py::isinstance<py::str>(given))
        return value_or_raise(core::expression::parse_formula(given.cast<std::string>(), Scope(), "formula"));
    if (py::isinstance<py::bool_>(given) || !PyNumber_Check(given.ptr()))
        refuse(ErrorCode::wrong_type, "formula", shown(given) + ": a formula, a parameter, a number or a text with a unit is expected");
    Formula out = core::expression::constant_formula(given.cast<double>());
    out.text = py::repr(py::float_(given.cast<double>())).cast<std::string>();
    return out;
}

namespace {

// A quantity knows what arithmetic with it is (fettle.Expression).
bool is_quantity(py::handle given) { return py::isinstance(given, record_class("Measured")); }

py::object not_here() { return py::reinterpret_borrow<py::object>(Py_NotImplemented); }

// `pattern` with its operands: a, b, c, d. Dimensions and their faults are those of texts.
Formula combined(const std::string& pattern, const std::vector<Formula>& operands) {
    Scope scope;
    std::string text;
    for (const char c : pattern) {
        const bool is_operand = c >= 'A' && c < 'A' + static_cast<char>(operands.size());
        const std::string& own = is_operand ? operands[c - 'A'].text : text;
        const bool is_plain = own.find_first_of(" +-*/^<") == std::string::npos;
        text += !is_operand ? std::string(1, c) : is_plain ? own : "(" + own + ")";
    }
    for (std::size_t k = 0; k < operands.size(); ++k)
        scope.names.push_back({std::string(1, static_cast<char>('A' + k)), operands[k].dimension, operands[k]});
    Formula out = value_or_raise(core::expression::parse_formula(pattern, scope, "formula `" + text + "`"));
    out.text = text;
    return out;
}

std::vector<double> inputs_of(const Formula& formula, const py::dict& values) {
    std::vector<double> out;
    for (const std::string& name : formula.inputs) {
        if (!values.contains(name.c_str())) refuse(ErrorCode::missing_key, "formula", "a value of `" + name + "` is expected");
        out.push_back(values[name.c_str()].cast<double>());
    }
    return out;
}

py::tuple state_of(const Formula& formula) {
    std::vector<std::tuple<int, std::array<int, 3>, double>> nodes;
    for (const Node& node : formula.nodes) nodes.emplace_back(static_cast<int>(node.operation), node.operands, node.number);
    return py::make_tuple(nodes, formula.inputs, formula.dimension.exponents, formula.text);
}

// However they are written.
bool same_numbers(const py::tuple& a, const py::tuple& b) { return a[0].equal(b[0]) && a[1].equal(b[1]) && a[2].equal(b[2]); }

Formula from_state(const py::tuple& state) {
    Formula out;
    for (const auto& [operation, operands, number] : state[0].cast<std::vector<std::tuple<int, std::array<int, 3>, double>>>())
        out.nodes.push_back({static_cast<Operation>(operation), operands, number});
    out.inputs = state[1].cast<std::vector<std::string>>();
    out.dimension.exponents = state[2].cast<std::array<double, 4>>();
    out.text = state[3].cast<std::string>();
    // Nothing is evaluated of a pickle that is none of ours.
    const auto is_sound = [&](std::size_t k) {
        const Node& node = out.nodes[k];
        if (node.operation > Operation::choose) return false;
        const int limit = node.operation == Operation::input ? count_of(out.inputs) : static_cast<int>(k);
        const int count = node.operation == Operation::input ? 1 : operand_count(node.operation);
        for (int i = 0; i < count; ++i)
            if (node.operands[i] < 0 || node.operands[i] >= limit) return false;
        return true;
    };
    bool sound = !out.nodes.empty();
    for (std::size_t k = 0; sound && k < out.nodes.size(); ++k) sound = is_sound(k);
    if (!sound) refuse(ErrorCode::inconsistent, "formula", "this is no formula that was pickled");
    return out;
}

}  // namespace

void bind_formula(py::module_& module) {
    py::class_<Formula> formula(module, "Formula",
                                "A number that follows from parameters, with its exact derivative: what arithmetic with parameters gives.");
    formula
        .def(py::init([](const std::string& text, const std::map<std::string, std::string>& units) {
                 Scope scope;
                 scope.what = "parameter";
                 for (const auto& [name, unit] : units) {
                     const Unit* known = core::base::find_unit(unit);
                     if (known == nullptr) refuse(ErrorCode::out_of_range, "formula", "\"" + unit + "\" is no unit");
                     scope.names.push_back({name, core::expression::powers_of(known->dimension)});
                 }
                 return value_or_raise(core::expression::parse_formula(text, scope, "formula `" + text + "`"));
             }),
             py::arg("text"), py::arg("units") = std::map<std::string, std::string>(),
             "Of a text, and the units of the parameters that it names. Numbers without a unit count in SI.")
        .def_readonly("text", &Formula::text)
        .def_readonly("inputs", &Formula::inputs, "The parameters that it follows from.")
        .def_property_readonly("dimension", [](const Formula& self) { return described(self.dimension); })
        .def(
            "value",
            [](const Formula& self, const py::dict& values) { return core::expression::value_of<double>(self, inputs_of(self, values)); },
            py::arg("values"), "At values of its inputs [SI], by name.")
        .def(
            "gradient",
            [](const Formula& self, const py::dict& values) {
                const auto at = core::expression::differentiated(self, inputs_of(self, values));
                std::map<std::string, double> out;
                for (std::size_t k = 0; k < self.inputs.size(); ++k) out[self.inputs[k]] = at.gradient[k];
                return out;
            },
            py::arg("values"), "Its derivative in each input there, by name.")
        .def("__repr__", [](const Formula& self) { return "Formula(" + std::string(py::repr(py::str(self.text))) + ")"; })
        .def(
            "__eq__",
            [](const Formula& self, const py::object& other) {
                return py::isinstance<Formula>(other) && same_numbers(state_of(self), state_of(other.cast<Formula>()));
            },
            py::is_operator())
        .def("__hash__", [](const Formula& self) { return py::hash(py::cast(self.inputs.size() + self.nodes.size())); })
        .def(py::pickle(&state_of, &from_state));
    const auto both_ways = [&](const char* name, const char* reflected, const std::string& sign) {
        formula.def(
            name,
            [sign](const Formula& a, const py::object& b) -> py::object {
                return is_quantity(b) ? not_here() : py::cast(combined("A " + sign + " B", {a, formula_from(b)}));
            },
            py::is_operator());
        formula.def(
            reflected,
            [sign](const Formula& b, const py::object& a) {
                return combined("A " + sign + " B", {formula_from(a), b});
            },
            py::is_operator());
    };
    both_ways("__add__", "__radd__", "+");
    both_ways("__sub__", "__rsub__", "-");
    both_ways("__mul__", "__rmul__", "*");
    both_ways("__truediv__", "__rtruediv__", "/");
    both_ways("__pow__", "__rpow__", "^");
    formula.def("__neg__", [](const Formula& a) { return combined("-A", {a}); });
    formula.def("__pos__", [](const Formula& a) { return a; });
    formula.def("__abs__", [](const Formula& a) { return combined("abs(A)", {a}); });
    module.def(
        "measured",
        [](const std::string& name, Dimension dimension) {
            Formula out = core::expression::input_formula(name, core::expression::powers_of(dimension));
            out.text = core::expression::quoted_if_needed(name);
            return out;
        },
        py::arg("name"), py::arg("dimension"), "A quantity in an expression, by the name that it has there.");
    module.def("formula", &formula_from, py::arg("of"), "A parameter, a number or a text with a unit as a formula.");
    for (const char* name : {"sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "exp", "log"}) {
        module.def(
            name, [name](const py::object& a) { return combined(std::string(name) + "(A)", {formula_from(a)}); }, py::arg("a"));
    }
    for (const auto& [name, word] :
         {std::pair("minimum", "min"), std::pair("maximum", "max"), std::pair("hypot", "hypot"), std::pair("atan2", "atan2")}) {
        module.def(
            name,
            [word = std::string(word)](const py::object& a, const py::object& b) {
                return combined(word + "(A, B)", {formula_from(a), formula_from(b)});
            },
            py::arg("a"), py::arg("b"));
    }
    module.def(
        "if_less",
        [](const py::object& a, const py::object& b, const py::object& x, const py::object& y) {
            return combined("if(A < B, C, D)", {formula_from(a), formula_from(b), formula_from(x), formula_from(y)});
        },
        py::arg("a"), py::arg("b"), py::arg("x"), py::arg("y"), "x where a < b, else y.");
}

}  // namespace fettle::design::python
