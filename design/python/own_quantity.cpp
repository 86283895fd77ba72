// SPDX-License-Identifier: MIT
#include "fettle/design/python/own_quantity.hpp"

#include <cmath>

#include "fettle/design/python/errors.hpp"
#include "fettle/design/python/model_arrays.hpp"
#include "fettle/design/python/own_shape.hpp"
#include "fettle/design/quantities/clearance.hpp"
#include "fettle/design/quantities/contact_force.hpp"
#include "fettle/design/quantities/energy.hpp"
#include "fettle/design/quantities/joint_load.hpp"
#include "fettle/design/quantities/marker_path.hpp"
#include "fettle/design/quantities/marker_speed.hpp"
#include "fettle/design/quantities/mass.hpp"
#include "fettle/design/quantities/stroke.hpp"

FETTLE_WORDS(fettle::core::base::Dimension, "number", "length", "area", "volume", "angle", "time", "mass", "force", "torque", "energy",
             "speed", "angular_speed", "acceleration", "density", "stiffness")
FETTLE_WORDS(fettle::design::quantities::Over, "end", "sum", "mean", "largest", "least")
FETTLE_WORDS(fettle::design::quantities::EnergyKind, "kinetic", "potential", "spring", "total")
FETTLE_WORDS(fettle::design::quantities::JointLoadKind, "force", "torque", "effort")

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

// nullptr where the entry is None.
std::optional<Rows> array_with(const py::object& found, const std::vector<py::ssize_t>& shape, const char* what) {
    if (found.is_none()) return std::nullopt;
    Rows array = Rows::ensure(found);
    const bool fits =
        array && array.ndim() == static_cast<py::ssize_t>(shape.size()) && std::equal(shape.begin(), shape.end(), array.shape());
    if (!fits) throw py::value_error(what);
    return array;
}

void add_pose_gradient(const py::object& gradient, double scale, Seeds& seeds) {
    auto& bars = seeds.trajectory_bar.pose_bar;
    const auto times = static_cast<py::ssize_t>(bars.size());
    const auto bodies = static_cast<py::ssize_t>(bars.empty() ? 0 : bars.front().size());
    if (const auto array =
            array_with(gradient.attr("positions"), {times, bodies, 3}, "a gradient in positions has shape (steps + 1, bodies, 3)")) {
        const double* next = array->data();
        for (auto& bodies_bar : bars)
            for (auto& bar : bodies_bar)
                for (int i = 0; i < 3; ++i) bar(i, 3) += scale * *next++;
    }
    if (const auto array =
            array_with(gradient.attr("rotations"), {times, bodies, 3, 3}, "a gradient in rotations has shape (steps + 1, bodies, 3, 3)")) {
        const double* next = array->data();
        for (auto& bodies_bar : bars)
            for (auto& bar : bodies_bar)
                for (int i = 0; i < 9; ++i) bar(i / 3, i % 3) += scale * *next++;
    }
}

void add_model_gradient(const py::object& gradient, double scale, Seeds& seeds) {
    auto& bodies = seeds.model_bar.bodies;
    for (const auto& [body, rows] : gradient.attr("vertices").cast<std::map<int, py::object>>()) {
        if (body < 0 || static_cast<std::size_t>(body) >= bodies.size()) throw py::index_error("there is no such body");
        Matrix3X& bar = bodies[static_cast<std::size_t>(body)].vertices_bar;
        const Matrix3X columns = columns_of(rows, "a gradient in vertices has shape (n, 3)");
        if (columns.cols() != bar.cols()) throw py::value_error("a gradient in vertices has a row per vertex of the body");
        bar += scale * columns;
    }
    for (const auto& [body, bar] : gradient.attr("densities").cast<std::map<int, double>>()) {
        if (body < 0 || static_cast<std::size_t>(body) >= bodies.size()) throw py::index_error("there is no such body");
        bodies[static_cast<std::size_t>(body)].density_bar += scale * bar;
    }
}

// A number that is exact, or a Measurement with bounds.
Measurement measurement_from(const py::object& answer) {
    if (!py::isinstance(answer, record_class("Measurement"))) return description::exact(answer.cast<double>());
    auto measured = answer.cast<Measurement>();
    if (!(measured.lower <= measured.value && measured.value <= measured.upper))
        throw py::value_error("a Measurement's value lies between its lower and its upper bound");
    return measured;
}

constexpr double rounding_of_squares = 1e-9;  // of a value, by which the sum of its deviations' squares may miss it

/// An object of Python's as a quantity.
class PythonQuantity : public Quantity {
public:
    explicit PythonQuantity(py::handle quantity)
        : quantity_(shared_object(quantity)),
          dimension_(quantity.attr("dimension").cast<Dimension>()),
          at_rest_(quantity.attr("at_rest").cast<bool>()) {}

    Dimension dimension() const override { return dimension_; }
    bool is_at_rest() const override { return at_rest_; }
    py::object object() const { return *quantity_; }

    Measurement value(const Simulated& simulated) const override {
        const py::gil_scoped_acquire locked;
        return measurement_from(ask("value", simulated));
    }

    void add_seeds(const Simulated& simulated, const Measurement&, double scale, Seeds& seeds) const override {
        const py::gil_scoped_acquire locked;
        add_gradient(ask("gradient", simulated), scale, seeds);
    }

    VectorX deviations(const Simulated& simulated) const override {
        const py::gil_scoped_acquire locked;
        const Rows found = Rows::ensure(ask("deviations", simulated));
        if (!found || found.ndim() != 1) throw py::value_error("a quantity's deviations() are numbers, of shape (m,)");
        const VectorX deviations = Eigen::Map<const VectorX>(found.data(), found.size());
        if (deviations.size() == 0) return deviations;
        const double value = measurement_from(ask("value", simulated)).value, squares = deviations.squaredNorm();
        if (!(std::abs(squares - value) <= rounding_of_squares * std::max(std::abs(value), squares)))
            throw py::value_error("the squares of a quantity's deviations() sum up to its value()");
        return deviations;
    }

    void add_deviation_seeds(const Simulated& simulated, int i, double scale, Seeds& seeds) const override {
        const py::gil_scoped_acquire locked;
        add_gradient(ask("deviation_gradient", simulated, i), scale, seeds);
    }

private:
    static void add_gradient(const py::object& gradient, double scale, Seeds& seeds) {
        if (!py::isinstance(gradient, record_class("QuantityGradient")))
            throw py::type_error("a quantity's gradient() and deviation_gradient() return a fettle.QuantityGradient");
        add_pose_gradient(gradient, scale, seeds);
        add_model_gradient(gradient, scale, seeds);
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
    bool at_rest_;
};

/// Any other quantity of the library's, handed through Python.
struct OpaqueQuantity {
    std::shared_ptr<const Quantity> quantity;
};

std::shared_ptr<const Quantity> library_quantity(py::handle q) {
    using namespace quantities;
    const auto is = [&](const char* name) { return py::isinstance(q, record_class(name)); };
    const auto body = [&] { return q.attr("body").cast<int>(); };
    if (is("Clearance")) {
        const ClearanceRange range{.a = q.attr("a").cast<int>(),
                                   .b = q.attr("b").cast<int>(),
                                   .motion = q.attr("motion").cast<bool>(),
                                   .window = q.attr("window").cast<int>(),
                                   .windows = q.attr("windows").cast<int>()};
        return std::make_shared<Clearance>(range, q.attr("minimum").cast<double>());
    }
    if (is("Mass")) {
        std::vector<Mass::Of> of;
        for (const auto& [index, kind] : q.attr("bodies").cast<std::vector<std::pair<int, core::scene::MassKind>>>())
            of.push_back({index, kind});
        return std::make_shared<Mass>(std::move(of));
    }
    if (is("Stroke"))
        return std::make_shared<Stroke>(body(), q.attr("axis").cast<Vector3>(), q.attr("target").cast<std::optional<double>>());
    if (is("MarkerPath")) {
        return std::make_shared<MarkerPath>(body(), q.attr("point").cast<Vector3>(), q.attr("targets").cast<std::vector<Vector3>>(),
                                            q.attr("times").cast<std::vector<double>>());
    }
    const auto over = [&] { return q.attr("over").cast<Over>(); };
    if (is("MarkerSpeed")) {
        const MarkerSpeed::Of of{body(), q.attr("point").cast<Vector3>(), q.attr("axis").cast<Vector3>()};
        return std::make_shared<MarkerSpeed>(of, over());
    }
    if (is("JointLoad")) {
        JointLoad::Of of{q.attr("kind").cast<JointLoadKind>(), q.attr("name").cast<std::string>(), q.attr("axis").cast<Vector3>(),
                         q.attr("effort_dimension").cast<Dimension>()};
        return std::make_shared<JointLoad>(std::move(of), over());
    }
    if (is("ContactLoad")) {
        ContactForce::Of of{body(), q.attr("other").cast<std::optional<int>>(), q.attr("axis").cast<Vector3>(),
                            q.attr("about").cast<std::optional<Vector3>>()};
        return std::make_shared<ContactForce>(of, over());
    }
    if (is("Energy")) return std::make_shared<Energy>(q.attr("kind").cast<EnergyKind>(), over());
    return nullptr;
}

}  // namespace

std::shared_ptr<const Quantity> quantity_from_python(py::handle quantity) {
    if (quantity.is_none()) return nullptr;
    if (py::isinstance<OpaqueQuantity>(quantity)) return quantity.cast<const OpaqueQuantity&>().quantity;
    if (auto found = library_quantity(quantity)) return found;
    if (!py::isinstance(quantity, record_class("Quantity"))) throw py::type_error("what is measured is a fettle.Quantity");
    return std::make_shared<PythonQuantity>(quantity);
}

py::object quantity_to_python(const std::shared_ptr<const Quantity>& quantity) {
    using namespace quantities;
    if (!quantity) return py::none();
    if (const auto* own = dynamic_cast<const PythonQuantity*>(quantity.get())) return own->object();
    if (const auto* q = dynamic_cast<const Clearance*>(quantity.get())) {
        const ClearanceRange& range = q->range();
        return record_class("Clearance")(range.a, range.b, range.motion, range.window, range.windows, q->minimum());
    }
    if (const auto* q = dynamic_cast<const Mass*>(quantity.get())) {
        py::list of;
        for (const Mass::Of& one : q->bodies()) of.append(py::make_tuple(one.body, one.kind));
        return record_class("Mass")(of);
    }
    if (const auto* q = dynamic_cast<const Stroke*>(quantity.get())) return record_class("Stroke")(q->body(), q->axis(), q->target());
    if (const auto* q = dynamic_cast<const MarkerPath*>(quantity.get()))
        return record_class("MarkerPath")(q->body(), q->point(), q->targets(), q->times());
    if (const auto* q = dynamic_cast<const MarkerSpeed*>(quantity.get()))
        return record_class("MarkerSpeed")(q->of().body, q->of().point, q->over(), q->of().axis);
    if (const auto* q = dynamic_cast<const JointLoad*>(quantity.get()))
        return record_class("JointLoad")(q->of().kind, q->of().name, q->over(), q->of().axis, q->of().effort_dimension);
    if (const auto* q = dynamic_cast<const ContactForce*>(quantity.get()))
        return record_class("ContactLoad")(q->of().body, q->of().other, q->over(), q->of().axis, q->of().about);
    if (const auto* q = dynamic_cast<const Energy*>(quantity.get())) return record_class("Energy")(q->kind(), q->over());
    return py::cast(OpaqueQuantity{quantity});
}

void bind_quantities(py::module_& module) {
    py::class_<OpaqueQuantity>(module, "OpaqueQuantity", "A quantity of the library's that Python has no class for; it is not pickled.")
        .def(
            "__eq__", [](const OpaqueQuantity& a, const OpaqueQuantity& b) { return a.quantity == b.quantity; }, py::is_operator());
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
