// SPDX-License-Identifier: MIT
#include "design/python/own_quantity.hpp"

#include <algorithm>
#include <cmath>

#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/errors.hpp"
#include "design/python/model_arrays.hpp"
#include "design/python/own_shape.hpp"
#include "design/quantities/body_turn.hpp"
#include "design/quantities/clearance.hpp"
#include "design/quantities/contact_force.hpp"
#include "design/quantities/energy.hpp"
#include "design/quantities/expression.hpp"
#include "design/quantities/in_scenario.hpp"
#include "design/quantities/joint_load.hpp"
#include "design/quantities/joint_position.hpp"
#include "design/quantities/law.hpp"
#include "design/quantities/marker_path.hpp"
#include "design/quantities/marker_position.hpp"
#include "design/quantities/marker_speed.hpp"
#include "design/quantities/mass.hpp"
#include "design/quantities/step_expression.hpp"
#include "design/quantities/stroke.hpp"
#include "design/quantities/worst.hpp"

FETTLE_WORDS(fettle::design::quantities::Over, "end", "sum", "mean", "largest", "least", "peak", "rms", "integral")
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
          at_rest_(member_of<bool>(quantity, "Quantity", "at_rest")) {}

    Dimension dimension() const override { return dimension_; }
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

    Measurement value_of(const Simulated& simulated) const { return measurement_from(ask("value", simulated), method("value()")); }

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

/// The members of a quantity's dataclass.
struct MembersOf {
    py::handle object;
    const char* type;

    template <class T>
    T get(const char* name) const {
        return member_of<T>(object, type, name);
    }
};

std::shared_ptr<const Quantity> stroke_from(py::handle q, const MembersOf& of_q) {
    const auto body = of_q.get<int>("body");
    const auto axis = of_q.get<Vector3>("axis");
    const py::object target = q.attr("target");
    const quantities::StrokeWindow window{of_q.get<std::optional<double>>("from_time"), of_q.get<std::optional<double>>("to_time")};
    if (is_followed(target)) return std::make_shared<quantities::Stroke>(body, axis, formula_from(target), window);
    return std::make_shared<quantities::Stroke>(body, axis, of_q.get<std::optional<double>>("target"), window);
}

// Coordinates may be formulas.
quantities::OwnPoint own_point_from(const py::iterable& coordinates) {
    quantities::OwnPoint out;
    std::vector<double> numbers;
    for (const py::handle coordinate : coordinates) {
        const bool follows = is_followed(coordinate);
        if (follows && numbers.size() < 3) out.formulas[numbers.size()] = formula_from(coordinate);
        numbers.push_back(follows ? 0 : coordinate.cast<double>());
    }
    if (numbers.size() != 3) throw py::value_error("a point has three coordinates");
    out.at = Vector3(numbers[0], numbers[1], numbers[2]);
    return out;
}

bool is_followed_point(py::handle coordinates) {
    if (!py::isinstance<py::iterable>(coordinates)) return false;
    for (const py::handle coordinate : coordinates)
        if (is_followed(coordinate)) return true;
    return false;
}

quantities::OwnPoint own_point_from(const MembersOf& of_q, const char* name) {
    const py::object member = of_q.object.attr(name);
    return is_followed_point(member) ? own_point_from(member) : quantities::OwnPoint(of_q.get<Vector3>(name));
}

std::shared_ptr<const Quantity> marker_path_from(py::handle q, const MembersOf& of_q) {
    std::vector<quantities::OwnPoint> targets;
    bool any_follows = false;
    for (const py::handle target : q.attr("targets")) any_follows = any_follows || is_followed_point(target);
    if (any_follows)
        for (const py::handle target : q.attr("targets")) targets.push_back(own_point_from(py::reinterpret_borrow<py::iterable>(target)));
    else
        for (const Vector3& target : of_q.get<std::vector<Vector3>>("targets")) targets.emplace_back(target);
    return std::make_shared<quantities::MarkerPath>(of_q.get<int>("body"), own_point_from(of_q, "point"), std::move(targets),
                                                    of_q.get<std::vector<double>>("times"));
}

quantities::Reduction reduction_from(const MembersOf& of_q) {
    quantities::Reduction out(of_q.get<quantities::Over>("over"), of_q.get<int>("derivative"));
    out.from = of_q.get<std::optional<double>>("from_time");
    out.to = of_q.get<std::optional<double>>("to_time");
    out.at = of_q.get<std::optional<double>>("at");
    return out;
}

std::vector<quantities::NamedQuantity> named_parts_from(py::handle q) {
    std::vector<quantities::NamedQuantity> parts;
    for (const auto& [name, part] : q.attr("parts").cast<py::dict>()) {
        auto quantity = quantity_from_python(part);
        if (!quantity) throw py::type_error("an expression's parts are quantities by name");
        parts.push_back({py::str(name), std::move(quantity)});
    }
    return parts;
}

// Texts are read by Design._prepared, which knows the parameters.
std::shared_ptr<const Quantity> expression_from(py::handle q) {
    const std::vector<quantities::NamedQuantity> parts = named_parts_from(q);
    const py::object formula = q.attr("formula");
    if (py::isinstance<py::str>(formula)) return value_or_raise(quantities::Expression::parse(formula.cast<std::string>(), parts));
    return value_or_raise(quantities::Expression::create(formula_from(formula), parts));
}

// Values may be formulas; these are 0 in the table.
std::shared_ptr<const Quantity> law_from(py::handle q, const MembersOf& of_q, const quantities::Reduction& reduction) {
    quantities::Law::Of of;
    of.dimension = of_q.get<Dimension>("of");
    of.curve.kind = of_q.get<core::scene::CurveKind>("profile");
    of.curve.times = of_q.get<std::vector<double>>("times");
    py::list numbers;
    for (const py::handle value : q.attr("values")) {
        const bool follows = is_followed(value);
        if (follows) of.moved.push_back({count_of(numbers), formula_from(value)});
        numbers.append(follows ? py::object(py::float_(0.0)) : py::reinterpret_borrow<py::object>(value));
    }
    if (const py::object along = q.attr("along"); !along.is_none()) {
        of.along = std::dynamic_pointer_cast<const quantities::StepSeries>(quantity_from_python(along));
        if (!of.along) refuse(ErrorCode::unsupported, "Law/along", "a law is along a quantity that each step has a number of");
    }
    of.curve.values = of.moved.empty() ? of_q.get<std::vector<double>>("values") : numbers.cast<std::vector<double>>();
    return std::make_shared<quantities::Law>(std::move(of), reduction);
}

std::shared_ptr<const Quantity> step_expression_from(py::handle q, const quantities::Reduction& reduction) {
    const std::vector<quantities::NamedQuantity> parts = named_parts_from(q);
    const py::object formula = q.attr("formula");
    if (py::isinstance<py::str>(formula))
        return value_or_raise(quantities::StepExpression::parse(formula.cast<std::string>(), parts, reduction));
    return value_or_raise(quantities::StepExpression::create(formula_from(formula), parts, reduction));
}

std::shared_ptr<const Quantity> library_quantity(py::handle q) {
    using namespace quantities;
    const std::string type = py::str(py::type::of(q).attr("__name__"));
    const auto is = [&](const char* name) { return py::isinstance(q, record_class(name)); };
    const MembersOf of_q{q, type.c_str()};
    const auto body = [&] { return of_q.get<int>("body"); };
    if (is("Clearance")) {
        const ClearanceRange range{.a = of_q.get<int>("a"),
                                   .b = of_q.get<int>("b"),
                                   .motion = of_q.get<bool>("motion"),
                                   .window = of_q.get<int>("window"),
                                   .windows = of_q.get<int>("windows"),
                                   .from = of_q.get<std::optional<double>>("from_time"),
                                   .to = of_q.get<std::optional<double>>("to_time"),
                                   .ranges = of_q.get<bool>("ranges"),
                                   .faces_a = of_q.get<std::vector<std::string>>("faces_a"),
                                   .faces_b = of_q.get<std::vector<std::string>>("faces_b")};
        return std::make_shared<Clearance>(range, of_q.get<double>("minimum"));
    }
    if (is("Mass")) {
        std::vector<Mass::Of> of;
        for (const auto& [index, kind] : of_q.get<std::vector<std::pair<int, core::scene::MassKind>>>("bodies"))
            of.push_back({index, kind});
        return std::make_shared<Mass>(std::move(of));
    }
    if (is("Stroke")) return stroke_from(q, of_q);
    if (is("MarkerPath")) return marker_path_from(q, of_q);
    if (is("Expression")) return expression_from(q);
    if (is("Worst")) {
        std::vector<std::shared_ptr<const Quantity>> parts;
        for (const py::handle part : q.attr("parts")) {
            parts.push_back(quantity_from_python(part));
            if (!parts.back() || parts.back()->dimension() != parts.front()->dimension())
                throw py::type_error("the parts of Worst are quantities of one dimension");
        }
        if (parts.empty()) throw py::value_error("Worst wants a part");
        return std::make_shared<Worst>(std::move(parts), of_q.get<bool>("greatest"));
    }
    if (is("InScenario")) {
        auto quantity = quantity_from_python(q.attr("quantity"));
        if (!quantity) throw py::type_error("InScenario wants a quantity");
        const int scenario = of_q.get<int>("scenario");
        check_at_least("InScenario/scenario", scenario, 0);
        return in_scenario(quantity, scenario);
    }
    if (!is("Series")) return nullptr;
    const Reduction reduction = reduction_from(of_q);
    if (is("Law")) return law_from(q, of_q, reduction);
    if (is("StepExpression")) return step_expression_from(q, reduction);
    if (is("MarkerPosition")) {
        const MarkerPosition::Of of{body(), own_point_from(of_q, "point"), of_q.get<Vector3>("axis"), own_point_from(of_q, "origin")};
        return std::make_shared<MarkerPosition>(of, reduction);
    }
    if (is("MarkerSpeed")) {
        const MarkerSpeed::Of of{body(), own_point_from(of_q, "point"), of_q.get<Vector3>("axis")};
        return std::make_shared<MarkerSpeed>(of, reduction);
    }
    if (is("JointPosition"))
        return std::make_shared<JointPosition>(
            JointPosition::Of{of_q.get<std::string>("joint"), of_q.get<Dimension>("coordinate_dimension")}, reduction);
    if (is("BodyTurn")) return std::make_shared<BodyTurn>(body(), of_q.get<Vector3>("axis"), reduction);
    if (is("JointLoad")) {
        JointLoad::Of of{of_q.get<JointLoadKind>("kind"), of_q.get<std::string>("name"), of_q.get<Vector3>("axis"),
                         of_q.get<Dimension>("effort_dimension")};
        return std::make_shared<JointLoad>(std::move(of), reduction);
    }
    if (is("ContactLoad")) {
        ContactForce::Of of{body(), of_q.get<std::optional<int>>("other"), of_q.get<Vector3>("axis")};
        if (!q.attr("about").is_none()) of.about = own_point_from(of_q, "about");
        return std::make_shared<ContactForce>(of, reduction);
    }
    if (is("Energy")) return std::make_shared<Energy>(of_q.get<EnergyKind>("kind"), reduction);
    return nullptr;
}

}  // namespace

std::shared_ptr<const Quantity> quantity_from_python(py::handle quantity) {
    if (quantity.is_none()) return nullptr;
    if (py::isinstance<OpaqueQuantity>(quantity)) return quantity.cast<const OpaqueQuantity&>().quantity;
    if (auto found = library_quantity(quantity)) return found;
    if (!py::isinstance(quantity, record_class("Quantity")))
        throw py::type_error("what is measured is a fettle.Quantity, not " + shown(quantity));
    return std::make_shared<PythonQuantity>(quantity);
}

namespace {

py::object number_or_formula(const core::expression::Formula& formula) {
    return formula.is_constant() ? py::object(py::float_(core::expression::value_of<double>(formula, {}))) : py::cast(formula);
}

py::object python_point(const quantities::OwnPoint& point, bool as_list = false) {
    if (!point.follows() && !as_list) return py::cast(point.at);
    py::list out;
    for (std::size_t k = 0; k < 3; ++k)
        out.append(point.formulas[k] ? py::cast(*point.formulas[k]) : py::object(py::float_(point.at[static_cast<Eigen::Index>(k)])));
    return std::move(out);
}

// Where one of them follows from parameters, lists all of them.
py::list python_points(const std::vector<quantities::OwnPoint>& points) {
    const bool any_follows = std::any_of(points.begin(), points.end(), [](const auto& point) { return point.follows(); });
    py::list out;
    for (const quantities::OwnPoint& point : points) out.append(python_point(point, any_follows));
    return out;
}

py::list law_values(const quantities::Law& law) {
    py::list values;
    for (const double value : law.of().curve.values) values.append(value);
    for (const quantities::MovedValue& each : law.of().moved) values[each.index] = py::cast(each.formula);
    return values;
}

py::dict python_parts(const std::vector<quantities::NamedQuantity>& named) {
    py::dict parts;
    for (const quantities::NamedQuantity& part : named) parts[py::str(part.name)] = quantity_to_python(part.quantity);
    return parts;
}

py::object series_to_python(const std::shared_ptr<const Quantity>& quantity, const quantities::StepSeries& series) {
    using namespace quantities;
    py::object out;
    if (const auto* q = dynamic_cast<const MarkerPosition*>(quantity.get()))
        out = record_class("MarkerPosition")(q->of().body, python_point(q->of().point), q->over(), q->of().axis,
                                             python_point(q->of().origin));
    else if (const auto* q = dynamic_cast<const MarkerSpeed*>(quantity.get()))
        out = record_class("MarkerSpeed")(q->of().body, python_point(q->of().point), q->over(), q->of().axis);
    else if (const auto* q = dynamic_cast<const JointPosition*>(quantity.get()))
        out = record_class("JointPosition")(q->of().joint, q->over(), q->of().dimension);
    else if (const auto* q = dynamic_cast<const BodyTurn*>(quantity.get()))
        out = record_class("BodyTurn")(q->body(), q->axis(), q->over());
    else if (const auto* q = dynamic_cast<const JointLoad*>(quantity.get()))
        out = record_class("JointLoad")(q->of().kind, q->of().name, q->over(), q->of().axis, q->of().effort_dimension);
    else if (const auto* q = dynamic_cast<const ContactForce*>(quantity.get()))
        out = record_class("ContactLoad")(q->of().body, q->of().other, q->over(), q->of().axis,
                                          q->of().about ? python_point(*q->of().about) : py::object(py::none()));
    else if (const auto* q = dynamic_cast<const Energy*>(quantity.get()))
        out = record_class("Energy")(q->kind(), q->over());
    else if (const auto* q = dynamic_cast<const Law*>(quantity.get()))
        out = record_class("Law")(q->of().dimension, q->of().curve.times, law_values(*q), q->of().curve.kind, q->over(),
                                  q->of().along ? quantity_to_python(q->of().along) : py::object(py::none()));
    else if (const auto* q = dynamic_cast<const StepExpression*>(quantity.get()))
        out = record_class("StepExpression")(q->formula(), python_parts(q->parts()), q->over());
    else
        return py::cast(OpaqueQuantity{quantity});
    const Reduction& reduction = series.reduction();
    out.attr("derivative") = reduction.derivative;
    out.attr("from_time") = reduction.from;
    out.attr("to_time") = reduction.to;
    out.attr("at") = reduction.at;
    return out;
}

}  // namespace

py::object quantity_to_python(const std::shared_ptr<const Quantity>& quantity) {
    using namespace quantities;
    if (!quantity) return py::none();
    if (const auto* own = dynamic_cast<const PythonQuantity*>(quantity.get())) return own->object();
    if (const auto* q = dynamic_cast<const Clearance*>(quantity.get())) {
        const ClearanceRange& range = q->range();
        return record_class("Clearance")(range.a, range.b, range.motion, range.window, range.windows, q->minimum(), range.from, range.to,
                                         range.ranges, range.faces_a, range.faces_b);
    }
    if (const auto* q = dynamic_cast<const Mass*>(quantity.get())) {
        py::list of;
        for (const Mass::Of& one : q->bodies()) of.append(py::make_tuple(one.body, one.kind));
        return record_class("Mass")(of);
    }
    if (const auto* q = dynamic_cast<const Stroke*>(quantity.get())) {
        const py::object target = q->target() ? number_or_formula(*q->target()) : py::object(py::none());
        return record_class("Stroke")(q->body(), q->axis(), target, q->window().from, q->window().to);
    }
    if (const auto* q = dynamic_cast<const MarkerPath*>(quantity.get())) {
        return record_class("MarkerPath")(q->body(), python_point(q->point()), python_points(q->targets()), q->times());
    }
    if (const auto* q = dynamic_cast<const Expression*>(quantity.get()))
        return record_class("Expression")(q->formula(), python_parts(q->parts()));
    if (const auto* q = dynamic_cast<const Worst*>(quantity.get())) {
        py::list parts;
        for (const auto& part : q->parts()) parts.append(quantity_to_python(part));
        return record_class("Worst")(parts, q->greatest());
    }
    if (const auto* q = dynamic_cast<const InScenario*>(quantity.get()))
        return record_class("InScenario")(quantity_to_python(q->quantity()), q->scenario());
    if (const auto* series = dynamic_cast<const StepSeries*>(quantity.get())) return series_to_python(quantity, *series);
    return py::cast(OpaqueQuantity{quantity});
}

void bind_quantities(py::module_& module) {
    py::class_<OpaqueQuantity>(module, "OpaqueQuantity", "A quantity of the library's that Python has no class for; it is not pickled.")
        .def(
            "__eq__", [](const OpaqueQuantity& a, const OpaqueQuantity& b) { return a.quantity == b.quantity; }, py::is_operator());
    module.def(
        "quantity_dimension",
        [](const py::object& given) {
            const auto quantity = quantity_from_python(given);
            return quantity ? quantity->dimension() : Dimension::number;
        },
        py::arg("quantity"), "What a quantity measures: \"length\", \"mass\", ...");
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
