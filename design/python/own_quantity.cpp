// SPDX-License-Identifier: MIT
#include "design/python/own_quantity.hpp"

#include <algorithm>
#include <cmath>
#include <typeinfo>

#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/errors.hpp"
#include "design/python/model_arrays.hpp"
#include "design/python/own_shape.hpp"

namespace fettle::design::python {

namespace py = pybind11;
using description::Measurement;
using description::Quantity;
using description::Seeds;
using description::Simulated;

namespace {

/// What Python sees of a simulated design, for the time of one call: everything it hands out is a copy.
class SimulatedView {
public:
    explicit SimulatedView(const Simulated& simulated) : simulated_(&simulated) {}
    void close() { simulated_ = nullptr; }
    const Simulated& get() const {
        if (simulated_ == nullptr)
            throw std::runtime_error("a Simulated is valid while value() or gradient() runs; keep its arrays instead");
        return *simulated_;
    }

private:
    const Simulated* simulated_;
};

using Rows = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A QuantityGradient that Python returned, and from where ("MeanHeight.gradient()").
struct FoundGradient {
    py::object gradient;
    std::string where;
    bool is_looked_at = true;  ///< by the evaluation, which fails where a number is not finite

    void check(bool finite, const std::string& member) const {
        if (!finite && !is_looked_at) refuse(ErrorCode::not_finite, where + "/" + member, "it has a number that is not finite");
    }
};

// nullopt where the member is None.
std::optional<Rows> array_with(const FoundGradient& found, const char* member, const std::vector<py::ssize_t>& shape, const char* what) {
    const py::object given = found.gradient.attr(member);
    if (given.is_none()) return std::nullopt;
    Rows array = Rows::ensure(given);
    const bool fits =
        array && array.ndim() == static_cast<py::ssize_t>(shape.size()) && std::equal(shape.begin(), shape.end(), array.shape());
    if (!fits) refuse(ErrorCode::wrong_type, found.where + "/" + member, what);
    found.check(Eigen::Map<const VectorX>(array.data(), array.size()).allFinite(), member);
    return array;
}

void add_pose_gradient(const FoundGradient& found, double scale, Seeds& seeds) {
    auto& bars = seeds.trajectory_bar.pose_bar;
    const auto times = static_cast<py::ssize_t>(bars.size());
    const auto bodies = static_cast<py::ssize_t>(bars.empty() ? 0 : bars.front().size());
    if (const auto array = array_with(found, "positions", {times, bodies, 3}, "a gradient in positions has shape (steps + 1, bodies, 3)")) {
        const double* next = array->data();
        for (auto& bodies_bar : bars)
            for (auto& bar : bodies_bar)
                for (int i = 0; i < 3; ++i) bar(i, 3) += scale * *next++;
    }
    if (const auto array =
            array_with(found, "rotations", {times, bodies, 3, 3}, "a gradient in rotations has shape (steps + 1, bodies, 3, 3)")) {
        const double* next = array->data();
        for (auto& bodies_bar : bars)
            for (auto& bar : bodies_bar)
                for (int i = 0; i < 9; ++i) bar(i / 3, i % 3) += scale * *next++;
    }
}

double number_from(py::handle answer, const std::string& where, const char* wanted = "a number") {
    py::detail::make_caster<double> number;
    if (answer.is_none() || !number.load(answer, true))
        refuse(ErrorCode::wrong_type, where, "returned " + shown(answer) + "; " + wanted + " is expected");
    return py::detail::cast_op<double>(number);
}

void add_model_gradient(const FoundGradient& found, double scale, Seeds& seeds) {
    auto& bodies = seeds.model_bar.bodies;
    const auto bar_of = [&](const char* member, int body) -> auto& {
        if (body < 0 || static_cast<std::size_t>(body) >= bodies.size())
            refuse(ErrorCode::out_of_range, found.where + "/" + member,
                   "there is no body " + std::to_string(body) + "; there are " + std::to_string(bodies.size()) + ", counted from 0");
        return bodies[body];
    };
    for (const auto& [body, rows] : member_of<std::map<int, py::object>>(found.gradient, "QuantityGradient", "vertices")) {
        Matrix3X& bar = bar_of("vertices", body).vertices_bar;
        const std::string where = found.where + "/vertices/" + std::to_string(body);
        const Matrix3X columns = columns_of(rows, where, "a gradient in vertices has shape (n, 3)");
        if (columns.cols() != bar.cols())
            refuse(ErrorCode::inconsistent, where,
                   "a gradient in vertices has a row per vertex of the body: " + std::to_string(bar.cols()));
        found.check(columns.allFinite(), "vertices/" + std::to_string(body));
        bar += scale * columns;
    }
    for (const auto& [body, bar] : member_of<std::map<int, py::object>>(found.gradient, "QuantityGradient", "densities")) {
        const std::string member = "densities/" + std::to_string(body);
        const double derivative = number_from(bar, found.where + "/" + member);
        found.check(std::isfinite(derivative), member);
        bar_of("densities", body).density_bar += scale * derivative;
    }
}

// A number as computed, or a Measurement with bounds. What is not finite is left to the evaluation, which then has failed.
Measurement measurement_from(py::handle answer, const std::string& where) {
    if (!py::isinstance(answer, record_class("Measurement")))
        return description::computed(number_from(answer, where, "a number or a fettle.Measurement"));
    const auto member = [&](const char* name) { return number_from(answer.attr(name), where + "/" + name); };
    const double value = member("value");
    if (!std::isfinite(value)) return description::computed(value);
    if (!(member("lower") <= value && value <= member("upper")))
        refuse(ErrorCode::out_of_range, where, "a Measurement's value lies between its lower and its upper bound");
    return answer.cast<Measurement>();
}

constexpr double rounding_of_squares = 1e-9;  // of a value, by which the sum of its deviations' squares may miss it

/// An object of Python's as a quantity.
class PythonQuantity : public Quantity {
public:
    explicit PythonQuantity(py::handle quantity)
        : quantity_(shared_object(quantity)),
          dimension_(member_of<Dimension>(quantity, "Quantity", "dimension")),
          at_rest_(member_of<bool>(quantity, "Quantity", "at_rest")),
          is_number_(member_of<bool>(quantity, "Quantity", "is_number")) {}

    Dimension dimension() const override { return dimension_; }
    description::QuantityFacts facts() const override { return {.is_number = is_number_}; }
    bool is_at_rest() const override { return at_rest_; }
    py::object object() const { return *quantity_; }

    Measurement value(const Simulated& simulated) const override {
        const py::gil_scoped_acquire locked;
        return value_of(simulated);
    }

    void add_seeds(const Simulated& simulated, const Measurement&, double scale, Seeds& seeds) const override {
        const py::gil_scoped_acquire locked;
        add_gradient({ask("gradient", simulated), method("gradient()")}, scale, seeds);
    }

    VectorX deviations(const Simulated& simulated) const override {
        const py::gil_scoped_acquire locked;
        const Rows found = Rows::ensure(ask("deviations", simulated));
        const std::string where = method("deviations()");
        if (!found || found.ndim() != 1) refuse(ErrorCode::wrong_type, where, "a quantity's deviations() are numbers, of shape (m,)");
        const VectorX deviations = Eigen::Map<const VectorX>(found.data(), found.size());
        if (deviations.size() == 0) return deviations;
        const double value = value_of(simulated).value, squares = deviations.squaredNorm();
        if (!(std::abs(squares - value) <= rounding_of_squares * std::max(std::abs(value), squares)))
            refuse(ErrorCode::inconsistent, where, "the squares of a quantity's deviations() sum up to its value()");
        return deviations;
    }

    void add_deviation_seeds(const Simulated& simulated, int i, double scale, Seeds& seeds) const override {
        const py::gil_scoped_acquire locked;
        add_gradient({ask("deviation_gradient", simulated, i), method("deviation_gradient()"), false}, scale, seeds);
    }

private:
    static void add_gradient(const FoundGradient& found, double scale, Seeds& seeds) {
        if (!py::isinstance(found.gradient, record_class("QuantityGradient")))
            refuse(ErrorCode::wrong_type, found.where, "returned " + shown(found.gradient) + "; a fettle.QuantityGradient is expected");
        add_pose_gradient(found, scale, seeds);
        add_model_gradient(found, scale, seeds);
    }

    std::string method(const char* name) const {
        return py::str(py::type::of(*quantity_).attr("__name__")).cast<std::string>() + "." + name;
    }

    Measurement value_of(const Simulated& simulated) const {
        Measurement found = measurement_from(ask("value", simulated), method("value()"));
        if (is_number_ && (found.lower != found.upper || found.is_proven))
            refuse(ErrorCode::inconsistent, method("value()"), "it has bounds, and the quantity says that it `is_number`, which has none");
        return found;
    }

    template <class... More>
    py::object ask(const char* what, const Simulated& simulated, More... more) const {
        const py::object view = py::cast(SimulatedView(simulated));
        const auto close = [&] { view.cast<SimulatedView&>().close(); };
        try {
            py::object answer = quantity_->attr(what)(view, more...);
            close();
            return answer;
        } catch (...) {
            close();
            throw;
        }
    }

    std::shared_ptr<py::object> quantity_;
    Dimension dimension_;
    bool at_rest_, is_number_;
};

}  // namespace

std::shared_ptr<const Quantity> own_quantity_from_python(py::handle quantity) {
    if (!py::isinstance(quantity, record_class("Quantity")))
        throw py::type_error("what is measured is a fettle.Quantity, not " + shown(quantity));
    return std::make_shared<PythonQuantity>(quantity);
}

py::object own_quantity_to_python(const Quantity& quantity) {
    return typeid(quantity) == typeid(PythonQuantity) ? static_cast<const PythonQuantity&>(quantity).object() : py::object();
}

void bind_simulated(py::module_& module) {
    const auto model = [](const SimulatedView& view) -> const core::model::Model& { return view.get().model; };
    py::class_<SimulatedView>(module, "Simulated",
                              "A design, simulated; valid while the call that it is handed to runs. Arrays are copies.")
        .def_property_readonly("body_names", [](const SimulatedView& view) { return view.get().trajectory.body_names; })
        .def_property_readonly(
            "times", [](const SimulatedView& view) { return times_of(view.get().trajectory); }, "(steps + 1) [s]")
        .def_property_readonly(
            "positions", [](const SimulatedView& view) { return positions_of(view.get().trajectory); },
            "(steps + 1, bodies, 3), of the reference points [m]")
        .def_property_readonly(
            "rotations", [](const SimulatedView& view) { return rotations_of(view.get().trajectory); }, "(steps + 1, bodies, 3, 3)")
        .def_property_readonly(
            "reference_points", [model](const SimulatedView& view) { return reference_points_of(model(view)); },
            "(bodies, 3), in the files' frames [m]")
        .def(
            "vertices",
            [model](const SimulatedView& view, int body) { return rows_of(Matrix3X(body_at(model(view), body).mesh.vertices)); },
            py::arg("body"), "(n, 3), relative to the reference point [m]")
        .def(
            "triangles", [model](const SimulatedView& view, int body) { return index_rows<3>(body_at(model(view), body).mesh.triangles); },
            py::arg("body"), "(m, 3)")
        .def(
            "density", [model](const SimulatedView& view, int body) { return body_at(model(view), body).density; }, py::arg("body"));
}

}  // namespace fettle::design::python
