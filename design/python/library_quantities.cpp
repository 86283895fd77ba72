// SPDX-License-Identifier: MIT
#include "design/python/library_quantities.hpp"

#include <algorithm>
#include <typeinfo>

#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/errors.hpp"
#include "design/python/model_arrays.hpp"
#include "design/python/own_quantity.hpp"
#include "design/quantities/body_turn.hpp"
#include "design/quantities/clearance.hpp"
#include "design/quantities/contact_force.hpp"
#include "design/quantities/energy.hpp"
#include "design/quantities/event_time.hpp"
#include "design/quantities/expression.hpp"
#include "design/quantities/free_range_end.hpp"
#include "design/quantities/gap.hpp"
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
#include "design/quantities/time_share.hpp"
#include "design/quantities/value_at.hpp"
#include "design/quantities/worst.hpp"

FETTLE_WORDS(fettle::design::quantities::Over, "end", "sum", "mean", "largest", "least", "peak", "rms", "integral")
FETTLE_WORDS(fettle::design::quantities::Direction, "either", "rising", "falling")
FETTLE_WORDS(fettle::design::quantities::EnergyKind, "kinetic", "potential", "spring", "total")
FETTLE_WORDS(fettle::design::quantities::JointLoadKind, "force", "torque", "effort")

namespace fettle::design::python {

namespace py = pybind11;
using description::NamedQuantity;
using description::Quantity;
using namespace quantities;

namespace {

/// Any other quantity of the library's, handed through Python.
struct OpaqueQuantity {
    std::shared_ptr<const Quantity> quantity;
};

/// The members of a quantity's dataclass.
struct Members {
    py::handle object;
    std::string type;

    template <class T>
    T get(const char* name) const {
        return member_of<T>(object, type.c_str(), name);
    }
};

// What parameters move may be a formula.

std::shared_ptr<const Quantity> stroke_from(const Members& q) {
    const auto body = q.get<int>("body");
    const auto axis = q.get<Vector3>("axis");
    const py::object target = q.object.attr("target");
    const StrokeWindow window{q.get<std::optional<double>>("from_time"), q.get<std::optional<double>>("to_time")};
    if (is_followed(target)) return std::make_shared<Stroke>(body, axis, formula_from(target), window);
    return std::make_shared<Stroke>(body, axis, q.get<std::optional<double>>("target"), window);
}

py::object stroke_to(const Stroke& q) {
    py::object target = py::none();
    if (q.target())
        target = q.target()->is_constant() ? py::float_(core::expression::value_of<double>(*q.target(), {})) : py::cast(*q.target());
    return record_class("Stroke")(q.body(), q.axis(), target, q.window().from, q.window().to);
}

bool is_followed_point(py::handle coordinates) {
    if (!py::isinstance<py::iterable>(coordinates)) return false;
    for (const py::handle coordinate : coordinates)
        if (is_followed(coordinate)) return true;
    return false;
}

OwnPoint followed_point_from(const py::iterable& coordinates) {
    OwnPoint out;
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

OwnPoint point_from(const Members& q, const char* name) {
    const py::object member = q.object.attr(name);
    return is_followed_point(member) ? followed_point_from(member) : OwnPoint(q.get<Vector3>(name));
}

py::object point_to(const OwnPoint& point, bool as_list = false) {
    if (!point.follows() && !as_list) return py::cast(point.at);
    py::list out;
    for (std::size_t k = 0; k < 3; ++k)
        out.append(point.formulas[k] ? py::cast(*point.formulas[k]) : py::object(py::float_(point.at[static_cast<Eigen::Index>(k)])));
    return std::move(out);
}

std::shared_ptr<const Quantity> marker_path_from(const Members& q) {
    const py::object given = q.object.attr("targets");
    const bool any_follows = std::any_of(given.begin(), given.end(), is_followed_point);
    std::vector<OwnPoint> targets;
    if (any_follows)
        for (const py::handle target : given) targets.push_back(followed_point_from(py::reinterpret_borrow<py::iterable>(target)));
    else
        for (const Vector3& target : q.get<std::vector<Vector3>>("targets")) targets.emplace_back(target);
    return std::make_shared<MarkerPath>(q.get<int>("body"), point_from(q, "point"), std::move(targets),
                                        q.get<std::vector<double>>("times"));
}

// Where one of its targets follows from parameters, all of them are lists.
py::object marker_path_to(const MarkerPath& q) {
    const bool any_follows = std::any_of(q.targets().begin(), q.targets().end(), [](const OwnPoint& point) { return point.follows(); });
    py::list targets;
    for (const OwnPoint& target : q.targets()) targets.append(point_to(target, any_follows));
    return record_class("MarkerPath")(q.body(), point_to(q.point()), targets, q.times());
}

std::shared_ptr<const Quantity> clearance_from(const Members& q) {
    const ClearanceRange range{.a = q.get<int>("a"),
                               .b = q.get<int>("b"),
                               .motion = q.get<bool>("motion"),
                               .window = q.get<int>("window"),
                               .windows = q.get<int>("windows"),
                               .from = q.get<std::optional<double>>("from_time"),
                               .to = q.get<std::optional<double>>("to_time"),
                               .ranges = q.get<bool>("ranges"),
                               .faces_a = q.get<std::vector<std::string>>("faces_a"),
                               .faces_b = q.get<std::vector<std::string>>("faces_b")};
    return std::make_shared<Clearance>(range, q.get<double>("minimum"));
}

py::object clearance_to(const Clearance& q) {
    const ClearanceRange& range = q.range();
    return record_class("Clearance")(range.a, range.b, range.motion, range.window, range.windows, q.minimum(), range.from, range.to,
                                     range.ranges, range.faces_a, range.faces_b);
}

std::shared_ptr<const Quantity> free_range_from(const Members& q) {
    FreeRangeEnd::Of of;
    of.joint = q.get<std::string>("joint");
    of.dimension = q.get<Dimension>("coordinate_dimension");
    const auto end = q.get<std::string>("end");
    of.is_above = end == "above";
    of.clearance = q.get<double>("clearance");
    of.reach = q.get<double>("reach");
    of.others_anywhere = q.get<bool>("anywhere");
    if (end != "above" && end != "below") refuse(ErrorCode::out_of_range, "FreeRange/end", "`" + end + "` is neither `above` nor `below`");
    check_above("FreeRange/clearance", of.clearance, 0);
    check_above("FreeRange/reach", of.reach, 0);
    return std::make_shared<FreeRangeEnd>(std::move(of));
}

py::object free_range_to(const FreeRangeEnd& q) {
    const FreeRangeEnd::Of& of = q.of();
    return record_class("FreeRange")(of.joint, of.is_above ? "above" : "below", of.dimension, of.clearance, of.reach, of.others_anywhere);
}

std::shared_ptr<const Quantity> mass_from(const Members& q) {
    std::vector<Mass::Of> of;
    for (const auto& [body, kind] : q.get<std::vector<std::pair<int, core::scene::MassKind>>>("bodies")) of.push_back({body, kind});
    return std::make_shared<Mass>(std::move(of));
}

py::object mass_to(const Mass& q) {
    py::list of;
    for (const Mass::Of& one : q.bodies()) of.append(py::make_tuple(one.body, one.kind));
    return record_class("Mass")(of);
}

std::vector<NamedQuantity> parts_from(const Members& q) {
    std::vector<NamedQuantity> parts;
    for (const auto& [name, part] : q.object.attr("parts").cast<py::dict>()) {
        auto quantity = quantity_from_python(part);
        if (!quantity) throw py::type_error("an expression's parts are quantities by name");
        parts.push_back({py::str(name), std::move(quantity)});
    }
    return parts;
}

py::dict parts_to(const std::vector<NamedQuantity>& named) {
    py::dict parts;
    for (const NamedQuantity& part : named) parts[py::str(part.name)] = quantity_to_python(part.quantity);
    return parts;
}

// Texts that name parameters are read by Design._prepared, which knows these.
std::shared_ptr<const Quantity> expression_from(const Members& q) {
    const std::vector<NamedQuantity> parts = parts_from(q);
    const py::object formula = q.object.attr("formula");
    if (py::isinstance<py::str>(formula)) return value_or_raise(Expression::parse(formula.cast<std::string>(), parts));
    return value_or_raise(Expression::create(formula_from(formula), parts));
}

py::object expression_to(const Expression& q) { return record_class("Expression")(q.formula(), parts_to(q.parts())); }

std::shared_ptr<const Quantity> worst_from(const Members& q) {
    std::vector<std::shared_ptr<const Quantity>> parts;
    for (const py::handle part : q.object.attr("parts")) {
        parts.push_back(quantity_from_python(part));
        if (!parts.back() || parts.back()->dimension() != parts.front()->dimension())
            throw py::type_error("the parts of Worst are quantities of one dimension");
    }
    if (parts.empty()) throw py::value_error("Worst wants a part");
    return std::make_shared<Worst>(std::move(parts), q.get<bool>("greatest"));
}

py::object worst_to(const Worst& q) {
    py::list parts;
    for (const auto& part : q.parts()) parts.append(quantity_to_python(part));
    return record_class("Worst")(parts, q.greatest());
}

std::shared_ptr<const Quantity> in_scenario_from(const Members& q) {
    auto quantity = quantity_from_python(q.object.attr("quantity"));
    if (!quantity) throw py::type_error("InScenario wants a quantity");
    const int scenario = q.get<int>("scenario");
    check_at_least("InScenario/scenario", scenario, 0);
    return in_scenario(quantity, scenario);
}

py::object in_scenario_to(const InScenario& q) { return record_class("InScenario")(quantity_to_python(q.quantity()), q.scenario()); }

// In quantities over the steps an expression stands for what it is at each of them.

std::shared_ptr<const StepSeries> series_from(const Members& q, const char* name) {
    const auto quantity = quantity_from_python(q.object.attr(name));
    auto series = quantity ? series_of(over_steps(quantity)) : nullptr;
    if (!series) refuse(ErrorCode::unsupported, q.type + "/" + name, "a quantity that each step has a number of is wanted");
    return series;
}

core::expression::Formula threshold_from(const Members& q, const StepSeries& series) {
    const py::object threshold = q.object.attr("threshold");
    if (is_followed(threshold)) return formula_from(threshold);
    return core::expression::constant_formula(q.get<double>("threshold"), core::expression::powers_of(series.numbers_dimension()));
}

py::object threshold_to(const core::expression::Formula& threshold) {
    return threshold.is_constant() ? py::float_(core::expression::value_of<double>(threshold, {})) : py::cast(threshold);
}

std::shared_ptr<const Quantity> event_time_from(const Members& q) {
    EventTime::Of of;
    of.series = series_from(q, "of");
    of.threshold = threshold_from(q, *of.series);
    of.direction = q.get<Direction>("direction");
    of.occurrence = q.get<int>("occurrence");
    of.from = q.get<std::optional<double>>("from_time");
    of.to = q.get<std::optional<double>>("to_time");
    of.name = q.get<std::string>("name");
    return std::make_shared<EventTime>(std::move(of));
}

py::object event_time_to(const EventTime& q) {
    const EventTime::Of& of = q.of();
    return record_class("EventTime")(quantity_to_python(of.series), threshold_to(of.threshold), of.direction, of.occurrence, of.from, of.to,
                                     of.name);
}

std::shared_ptr<const Quantity> value_at_from(const Members& q) {
    ValueAt::Of of{series_from(q, "of"), quantity_from_python(q.object.attr("time"))};
    if (!of.time) refuse(ErrorCode::unsupported, "ValueAt/time", "the time of an event is wanted, or an expression of such times");
    return std::make_shared<ValueAt>(std::move(of));
}

py::object value_at_to(const ValueAt& q) {
    return record_class("ValueAt")(quantity_to_python(q.of().series), quantity_to_python(q.of().time));
}

std::shared_ptr<const Quantity> time_share_from(const Members& q) {
    TimeShare::Of of;
    of.series = series_from(q, "of");
    of.threshold = threshold_from(q, *of.series);
    of.is_above = q.get<bool>("above");
    if (!q.object.attr("along").is_none()) of.along = series_from(q, "along");
    of.from = q.get<std::optional<double>>("from_time");
    of.to = q.get<std::optional<double>>("to_time");
    return std::make_shared<TimeShare>(std::move(of));
}

py::object time_share_to(const TimeShare& q) {
    const TimeShare::Of& of = q.of();
    return record_class("TimeShare")(quantity_to_python(of.series), threshold_to(of.threshold), of.is_above, quantity_to_python(of.along),
                                     of.from, of.to);
}

// Series, whose reductions the table reads and writes.

std::shared_ptr<const Quantity> gap_from(const Members& q, const Reduction& reduction) {
    return std::make_shared<Gap>(Gap::Of{q.get<int>("a"), q.get<int>("b")}, reduction);
}

py::object gap_to(const Gap& q) { return record_class("Gap")(q.of().a, q.of().b, q.over()); }

std::shared_ptr<const Quantity> marker_position_from(const Members& q, const Reduction& reduction) {
    const MarkerPosition::Of of{q.get<int>("body"), point_from(q, "point"), q.get<Vector3>("axis"), point_from(q, "origin")};
    return std::make_shared<MarkerPosition>(of, reduction);
}

py::object marker_position_to(const MarkerPosition& q) {
    return record_class("MarkerPosition")(q.of().body, point_to(q.of().point), q.over(), q.of().axis, point_to(q.of().origin));
}

std::shared_ptr<const Quantity> marker_speed_from(const Members& q, const Reduction& reduction) {
    const MarkerSpeed::Of of{q.get<int>("body"), point_from(q, "point"), q.get<Vector3>("axis")};
    return std::make_shared<MarkerSpeed>(of, reduction);
}

py::object marker_speed_to(const MarkerSpeed& q) {
    return record_class("MarkerSpeed")(q.of().body, point_to(q.of().point), q.over(), q.of().axis);
}

std::shared_ptr<const Quantity> joint_position_from(const Members& q, const Reduction& reduction) {
    const JointPosition::Of of{q.get<std::string>("joint"), q.get<Dimension>("coordinate_dimension")};
    return std::make_shared<JointPosition>(of, reduction);
}

py::object joint_position_to(const JointPosition& q) { return record_class("JointPosition")(q.of().joint, q.over(), q.of().dimension); }

std::shared_ptr<const Quantity> body_turn_from(const Members& q, const Reduction& reduction) {
    return std::make_shared<BodyTurn>(q.get<int>("body"), q.get<Vector3>("axis"), reduction);
}

py::object body_turn_to(const BodyTurn& q) { return record_class("BodyTurn")(q.body(), q.axis(), q.over()); }

std::shared_ptr<const Quantity> joint_load_from(const Members& q, const Reduction& reduction) {
    JointLoad::Of of{q.get<JointLoadKind>("kind"), q.get<std::string>("name"), q.get<Vector3>("axis"),
                     q.get<Dimension>("effort_dimension")};
    return std::make_shared<JointLoad>(std::move(of), reduction);
}

py::object joint_load_to(const JointLoad& q) {
    return record_class("JointLoad")(q.of().kind, q.of().name, q.over(), q.of().axis, q.of().effort_dimension);
}

std::shared_ptr<const Quantity> contact_force_from(const Members& q, const Reduction& reduction) {
    ContactForce::Of of{q.get<int>("body"), q.get<std::optional<int>>("other"), q.get<Vector3>("axis")};
    if (!q.object.attr("about").is_none()) of.about = point_from(q, "about");
    return std::make_shared<ContactForce>(of, reduction);
}

py::object contact_force_to(const ContactForce& q) {
    const py::object about = q.of().about ? point_to(*q.of().about) : py::object(py::none());
    return record_class("ContactLoad")(q.of().body, q.of().other, q.over(), q.of().axis, about);
}

std::shared_ptr<const Quantity> energy_from(const Members& q, const Reduction& reduction) {
    return std::make_shared<Energy>(q.get<EnergyKind>("kind"), reduction);
}

py::object energy_to(const Energy& q) { return record_class("Energy")(q.kind(), q.over()); }

// Values that are formulas are 0 in the table.
std::shared_ptr<const Quantity> law_from(const Members& q, const Reduction& reduction) {
    Law::Of of;
    of.dimension = q.get<Dimension>("of");
    of.curve.kind = q.get<core::scene::CurveKind>("profile");
    of.curve.times = q.get<std::vector<double>>("times");
    py::list numbers;
    for (const py::handle value : q.object.attr("values")) {
        const bool follows = is_followed(value);
        if (follows) of.moved.push_back({count_of(numbers), formula_from(value)});
        numbers.append(follows ? py::object(py::float_(0.0)) : py::reinterpret_borrow<py::object>(value));
    }
    if (const py::object along = q.object.attr("along"); !along.is_none()) {
        of.along = series_of(quantity_from_python(along));
        if (!of.along) refuse(ErrorCode::unsupported, "Law/along", "a law is along a quantity that each step has a number of");
    }
    of.curve.values = of.moved.empty() ? q.get<std::vector<double>>("values") : numbers.cast<std::vector<double>>();
    return std::make_shared<Law>(std::move(of), reduction);
}

py::object law_to(const Law& q) {
    py::list values;
    for (const double value : q.of().curve.values) values.append(value);
    for (const MovedValue& each : q.of().moved) values[each.index] = py::cast(each.formula);
    return record_class("Law")(q.of().dimension, q.of().curve.times, values, q.of().curve.kind, q.over(), quantity_to_python(q.of().along));
}

std::shared_ptr<const Quantity> step_expression_from(const Members& q, const Reduction& reduction) {
    const std::vector<NamedQuantity> parts = parts_from(q);
    const py::object formula = q.object.attr("formula");
    if (py::isinstance<py::str>(formula)) return value_or_raise(StepExpression::parse(formula.cast<std::string>(), parts, reduction));
    return value_or_raise(StepExpression::create(formula_from(formula), parts, reduction));
}

py::object step_expression_to(const StepExpression& q) {
    return record_class("StepExpression")(q.formula(), parts_to(q.parts()), q.over());
}

Reduction reduction_from(const Members& q) {
    Reduction out(q.get<Over>("over"), q.get<int>("derivative"));
    out.from = q.get<std::optional<double>>("from_time");
    out.to = q.get<std::optional<double>>("to_time");
    out.at = q.get<std::optional<double>>("at");
    return out;
}

void add_reduction(const Reduction& reduction, const py::object& out) {  // `over` has been told
    out.attr("derivative") = reduction.derivative;
    out.attr("from_time") = reduction.from;
    out.attr("to_time") = reduction.to;
    out.attr("at") = reduction.at;
}

struct Row {
    const char* name;  // of the dataclass
    const std::type_info* type;
    std::shared_ptr<const Quantity> (*from)(const Members&);
    py::object (*to)(const Quantity&);
};

template <class T, auto from, auto to>
Row row(const char* name) {
    const auto read = [](const Members& q) {
        if constexpr (std::is_base_of_v<StepSeries, T>)
            return from(q, reduction_from(q));
        else
            return from(q);
    };
    const auto write = [](const Quantity& quantity) {
        const T& q = static_cast<const T&>(quantity);
        py::object out = to(q);
        if constexpr (std::is_base_of_v<StepSeries, T>) add_reduction(q.reduction(), out);
        return out;
    };
    return {name, &typeid(T), read, write};
}

const std::vector<Row>& table() {
    static const std::vector<Row> rows{
        row<Clearance, clearance_from, clearance_to>("Clearance"),
        row<FreeRangeEnd, free_range_from, free_range_to>("FreeRange"),
        row<Mass, mass_from, mass_to>("Mass"),
        row<Stroke, stroke_from, stroke_to>("Stroke"),
        row<MarkerPath, marker_path_from, marker_path_to>("MarkerPath"),
        row<MarkerPosition, marker_position_from, marker_position_to>("MarkerPosition"),
        row<MarkerSpeed, marker_speed_from, marker_speed_to>("MarkerSpeed"),
        row<JointPosition, joint_position_from, joint_position_to>("JointPosition"),
        row<JointLoad, joint_load_from, joint_load_to>("JointLoad"),
        row<BodyTurn, body_turn_from, body_turn_to>("BodyTurn"),
        row<ContactForce, contact_force_from, contact_force_to>("ContactLoad"),
        row<Gap, gap_from, gap_to>("Gap"),
        row<Energy, energy_from, energy_to>("Energy"),
        row<Law, law_from, law_to>("Law"),
        row<EventTime, event_time_from, event_time_to>("EventTime"),
        row<ValueAt, value_at_from, value_at_to>("ValueAt"),
        row<TimeShare, time_share_from, time_share_to>("TimeShare"),
        row<Expression, expression_from, expression_to>("Expression"),
        row<StepExpression, step_expression_from, step_expression_to>("StepExpression"),
        row<InScenario, in_scenario_from, in_scenario_to>("InScenario"),
        row<Worst, worst_from, worst_to>("Worst"),
    };
    return rows;
}

}  // namespace

std::shared_ptr<const Quantity> quantity_from_python(py::handle quantity) {
    if (quantity.is_none()) return nullptr;
    if (py::isinstance<OpaqueQuantity>(quantity)) return quantity.cast<const OpaqueQuantity&>().quantity;
    for (const Row& each : table())
        if (py::isinstance(quantity, record_class(each.name)))
            return each.from({quantity, py::str(py::type::of(quantity).attr("__name__")).cast<std::string>()});
    return own_quantity_from_python(quantity);
}

py::object quantity_to_python(const std::shared_ptr<const Quantity>& quantity) {
    if (!quantity) return py::none();
    const Quantity& q = *quantity;
    for (const Row& each : table())
        if (typeid(q) == *each.type) return each.to(q);
    const py::object own = own_quantity_to_python(q);
    return own ? own : py::cast(OpaqueQuantity{quantity});
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
    bind_simulated(module);
}

}  // namespace fettle::design::python
