// SPDX-License-Identifier: MIT
#include "design/python/own_shape.hpp"

#include <algorithm>
#include <cmath>

#include "core/files/nearest_word.hpp"
#include "design/python/arguments.hpp"
#include "design/python/errors.hpp"
#include "design/python/scene_records.hpp"
#include "design/shapes/file_part.hpp"
#include "design/shapes/mesh_program.hpp"
#include "design/shapes/part_library.hpp"

namespace fettle::design::python {

namespace py = pybind11;
using description::Shape;
using description::ShapeDimension;
using description::ShapeInstance;
using shapes::FilePart;

std::shared_ptr<py::object> shared_object(py::handle object) {
    return {new py::object(py::reinterpret_borrow<py::object>(object)), [](py::object* held) {
                const py::gil_scoped_acquire locked;
                delete held;
            }};
}

namespace {

using NamedNumbers = std::map<std::string, double>;

// {dimension: metres, or "3mm"}
NamedNumbers lengths_from(const py::dict& given) {
    NamedNumbers lengths;
    for (const auto& [name, value] : given) {
        const std::string of = py::str(name);
        lengths[of] = quantity_from(value, core::base::Dimension::length, of);
    }
    return lengths;
}

// "Frustum.at()"
std::string method_of(py::handle shape, const char* method) {
    return py::str(py::type::of(shape).attr("__name__")).cast<std::string>() + "." + method;
}

void check_dimensions(const std::vector<ShapeDimension>& dimensions, const std::string& where) {
    if (dimensions.empty()) refuse(ErrorCode::missing_key, where, "a shape has dimensions");
    for (const ShapeDimension& dimension : dimensions) {
        if (!std::isfinite(dimension.value))
            refuse(ErrorCode::not_finite, where, "the dimension `" + dimension.name + "` is not a finite number; give metres");
    }
}

std::optional<py::dict> dict_from(const py::object& mapping) {
    try {
        return py::dict(mapping);
    } catch (const py::error_already_set&) {
        return std::nullopt;
    }
}

// In the order that Python has them in.
std::vector<ShapeDimension> dimensions_of(py::handle shape) {
    const std::string where = method_of(shape, "dimensions()");
    const py::object answer = shape.attr("dimensions")();
    const std::optional<py::dict> named = dict_from(answer);
    if (!named || !py::detail::make_caster<NamedNumbers>().load(*named, true))
        refuse(ErrorCode::wrong_type, where, "returned " + shown(answer) + "; {name: metres} is expected");
    std::vector<ShapeDimension> dimensions;
    for (const auto& [name, value] : *named) dimensions.push_back({name.cast<std::string>(), value.cast<double>()});
    check_dimensions(dimensions, where);
    return dimensions;
}

core::geometry::Mesh mesh_from(py::handle answer, const std::string& where) {
    if (!py::isinstance(answer, record_class("Mesh")))
        refuse(ErrorCode::wrong_type, where, "returned " + shown(answer) + "; a fettle.Mesh is expected");
    return mesh_from_python(answer);
}

// The result of `make` for a shape of Python's, or its fault. Takes the interpreter's lock.
template <class Make>
auto made_by(const Make& make, const std::string& where) -> Result<decltype(make())> {
    const py::gil_scoped_acquire locked;
    try {
        return make();
    } catch (py::error_already_set& raised) {
        return errors_of(raised, where);
    } catch (const RaisedErrors& refused) {
        return refused.errors();
    }
}

py::dict named(const std::vector<ShapeDimension>& dimensions, const std::vector<double>& values) {
    py::dict by_name;
    for (std::size_t k = 0; k < values.size(); ++k) by_name[py::str(dimensions[k].name)] = values[k];
    return by_name;
}

/// An object of Python's as a shape: at({name: value}) returns (mesh, {name: d vertices / d dimension}).
class PythonShape : public Shape {
public:
    explicit PythonShape(py::handle shape)
        : shape_(shared_object(shape)), dimensions_(dimensions_of(shape)), always_solid_(shape.attr("always_solid").cast<bool>()) {}

    const std::vector<ShapeDimension>& dimensions() const override { return dimensions_; }
    bool is_always_solid() const override { return always_solid_; }
    py::object object() const { return *shape_; }

    Result<ShapeInstance> at(const std::vector<double>& values) const override {
        return made_by(
            [&] {
                const std::string where = method_of(*shape_, "at()");
                const py::object answer = shape_->attr("at")(named(dimensions_, values));
                const bool two = (py::isinstance<py::tuple>(answer) || py::isinstance<py::list>(answer)) && py::len(answer) == 2;
                const std::optional<py::dict> by_name = two ? dict_from(answer[py::int_(1)]) : std::nullopt;
                if (!by_name)
                    refuse(ErrorCode::wrong_type, where,
                           "returned " + shown(answer) + "; (fettle.Mesh, {dimension: derivatives}) is expected");
                ShapeInstance part;
                part.mesh = mesh_from(answer[py::int_(0)], where);
                part.jacobian = jacobian_of(*by_name, part.mesh.vertices.cols(), where);
                return part;
            },
            dimensions_.front().name);
    }

private:
    std::vector<Matrix3X> jacobian_of(const py::dict& by_name, Eigen::Index vertices, const std::string& where) const {
        std::vector<Matrix3X> jacobian;
        for (const ShapeDimension& dimension : dimensions_) {
            const std::string derivative = "the derivative by `" + dimension.name + "` ";
            if (!by_name.contains(dimension.name)) refuse(ErrorCode::missing_key, where, derivative + "is missing");
            jacobian.push_back(columns_of(by_name[py::str(dimension.name)], where, "a derivative of vertices has shape (n, 3)"));
            if (jacobian.back().cols() != vertices)
                refuse(ErrorCode::inconsistent, where, derivative + "has a row per vertex of the mesh: " + std::to_string(vertices));
            if (!jacobian.back().allFinite()) refuse(ErrorCode::not_finite, where, derivative + "has a number that is not finite");
        }
        return jacobian;
    }

    std::shared_ptr<py::object> shape_;
    std::vector<ShapeDimension> dimensions_;
    bool always_solid_;
};

std::vector<ShapeDimension> drawn_dimensions(py::handle shape) {
    std::vector<ShapeDimension> dimensions;
    const std::string record = py::str(py::type::of(shape).attr("__name__"));
    for (const auto& [name, value] : member_of<NamedNumbers>(shape, record.c_str(), "values")) dimensions.push_back({name, value});
    check_dimensions(dimensions, record + ".values");
    return dimensions;
}

/// A function of Python's that makes meshes (fettle.MeshShape); its derivative comes from rebuilt ones.
class PythonMeshShape : public shapes::RebuiltShape {
public:
    explicit PythonMeshShape(py::handle shape)
        : RebuiltShape(drawn_dimensions(shape), maker(drawn_dimensions(shape), shared_object(shape.attr("function"))), rebuilding(shape)),
          shape_(shared_object(shape)) {}
    py::object object() const { return *shape_; }

private:
    static shapes::RebuiltOptions rebuilding(py::handle shape) {
        const shapes::RebuiltOptions options{.unit = member_of<double>(shape, "MeshShape", "unit"),
                                             .rounding = member_of<std::optional<double>>(shape, "MeshShape", "rounding")};
        check_above("mesh shape/unit", options.unit, 0);
        if (options.rounding) check_at_least("mesh shape/rounding", *options.rounding, 0);
        return options;
    }

    static shapes::MeshMaker maker(const std::vector<ShapeDimension>& dimensions, std::shared_ptr<py::object> function) {
        return [dimensions, function = std::move(function)](const std::vector<double>& values) {
            return made_by([&] { return mesh_from((*function)(named(dimensions, values)), "MeshShape.function()"); },
                           dimensions.front().name);
        };
    }

    std::shared_ptr<py::object> shape_;
};

/// Any other shape of the library's, handed through Python.
struct OpaqueShape {
    std::shared_ptr<const Shape> shape;
};

std::vector<double> in_order(const Shape& shape, const std::map<std::string, double>& values) {
    std::vector<double> ordered;
    std::vector<std::string_view> known;
    for (const ShapeDimension& dimension : shape.dimensions()) known.push_back(dimension.name);
    for (const auto& [name, value] : values) {
        if (std::find(known.begin(), known.end(), name) == known.end())
            refuse(ErrorCode::unknown_key, name, "the shape has no dimension \"" + name + "\"; " + core::files::did_you_mean(name, known));
        if (!std::isfinite(value)) refuse(ErrorCode::not_finite, name, "it is not a finite number; give metres");
    }
    for (const ShapeDimension& dimension : shape.dimensions()) {
        const auto found = values.find(dimension.name);
        ordered.push_back(found == values.end() ? dimension.value : found->second);
    }
    return ordered;
}

// Without the lock: a shape of Python's takes it when it is asked, on whatever thread.
ShapeInstance unlocked_at(const Shape& shape, const std::vector<double>& values) {
    const py::gil_scoped_release unlocked;
    return value_or_raise(shape.at(values));
}

py::tuple instance(const Shape& shape, const std::map<std::string, double>& values) {
    ShapeInstance part = unlocked_at(shape, in_order(shape, values));
    py::dict jacobian;
    for (std::size_t k = 0; k < part.jacobian.size(); ++k)
        jacobian[py::str(shape.dimensions()[k].name)] = rows_of(std::move(part.jacobian[k]));
    return py::make_tuple(mesh_to_python(std::move(part.mesh)), jacobian);
}

std::map<std::string, double> named_dimensions(const Shape& shape) {
    std::map<std::string, double> named;
    for (const ShapeDimension& dimension : shape.dimensions()) named[dimension.name] = dimension.value;
    return named;
}

}  // namespace

std::shared_ptr<const Shape> shape_from_python(py::handle shape) {
    if (shape.is_none()) return nullptr;
    if (py::isinstance<OpaqueShape>(shape)) return shape.cast<const OpaqueShape&>().shape;
    if (py::isinstance(shape, record_class("Part"))) {
        const shapes::PartOptions options{member_of<core::part_files::Counts>(shape, "Part", "counts"),
                                          member_of<double>(shape, "Part", "chord")};
        check_at_least("part/chord", options.chord, 0);
        return value_or_raise(
            FilePart::create(member_of<std::string>(shape, "Part", "part"), member_of<NamedNumbers>(shape, "Part", "values"), options));
    }
    if (py::isinstance(shape, record_class("MeshShape"))) return std::make_shared<PythonMeshShape>(shape);
    if (py::isinstance(shape, record_class("ProgramShape")))
        return value_or_raise(
            shapes::ProgramPart::create(member_of<shapes::MeshProgram>(shape, "ProgramShape", "program"), drawn_dimensions(shape)));
    if (!py::isinstance(shape, record_class("Shape"))) throw py::type_error("a body's shape is a fettle.Shape, not " + shown(shape));
    return std::make_shared<PythonShape>(shape);
}

py::object shape_to_python(const std::shared_ptr<const Shape>& shape) {
    if (!shape) return py::none();
    if (const auto* own = dynamic_cast<const PythonShape*>(shape.get())) return own->object();
    if (const auto* part = dynamic_cast<const FilePart*>(shape.get()))
        return record_class("Part")(part->part(), named_dimensions(*part), part->options().counts, part->options().chord);
    if (const auto* made = dynamic_cast<const PythonMeshShape*>(shape.get())) return made->object();
    if (const auto* part = dynamic_cast<const shapes::ProgramPart*>(shape.get()))
        return record_class("ProgramShape")(part->program(), named_dimensions(*part));
    return py::cast(OpaqueShape{shape});
}

void bind_shapes(py::module_& module) {
    py::class_<OpaqueShape>(module, "OpaqueShape", "A shape of the library's that Python has no class for.")
        .def(
            "__eq__", [](const OpaqueShape& a, const OpaqueShape& b) { return a.shape == b.shape; }, py::is_operator())
        .def("dimensions", [](const OpaqueShape& self) { return named_dimensions(*self.shape); })
        .def("at", [](const OpaqueShape& self, const py::dict& values) { return instance(*self.shape, lengths_from(values)); });
    module.def(
        "shape_at",
        [](const py::object& shape, const py::dict& values) { return instance(*shape_from_python(shape), lengths_from(values)); },
        py::arg("shape"), py::arg("values") = py::dict(),
        "(mesh, {dimension: d vertices / d dimension, (n, 3)}) of a shape at these dimensions, metres or \"3mm\"; those left out are as "
        "drawn.");
    module.def(
        "shape_mesh",
        [](const py::object& given) {
            const auto shape = shape_from_python(given);
            return mesh_to_python([&] {
                const py::gil_scoped_release unlocked;
                return value_or_raise(description::drawn_mesh(*shape));
            }());
        },
        py::arg("shape"), "The mesh of a shape as drawn, without derivatives.");
    module.def(
        "shape_remarks",
        [](const py::object& given, const py::dict& values) {
            const auto shape = shape_from_python(given);
            const std::vector<double> ordered = in_order(*shape, lengths_from(values));
            const py::gil_scoped_release unlocked;
            return shape->remarks(ordered, description::all_dimensions(*shape));
        },
        py::arg("shape"), py::arg("values") = py::dict(),
        "How a shape's derivative was found at these dimensions, and how exact it is; empty: it is exact.");
    module.def(
        "part_dimensions", [](const py::object& part) { return named_dimensions(*shape_from_python(part)); }, py::arg("part"),
        "{dimension: value} of a part, SI: as it says, or else as its file does.");
    module.def(
        "parts",
        [] {
            py::dict table;
            for (const shapes::LibraryPart& each : shapes::part_library())
                table[py::str(std::string(each.name))] = shapes::find_part(std::string(each.name)).value().about();
            return table;
        },
        "{part: what it is} of the library.");
}

}  // namespace fettle::design::python
