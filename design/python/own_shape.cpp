// SPDX-License-Identifier: MIT
#include "fettle/design/python/own_shape.hpp"

#include "fettle/design/python/errors.hpp"
#include "fettle/design/python/scene_records.hpp"
#include "fettle/design/shapes/generated_part.hpp"
#include "fettle/design/shapes/mesh_program.hpp"

namespace fettle::design::python {

namespace py = pybind11;
using description::Shape;
using description::ShapeDimension;
using description::ShapeInstance;
using shapes::GeneratedPart;

std::shared_ptr<py::object> shared_object(py::handle object) {
    return {new py::object(py::reinterpret_borrow<py::object>(object)), [](py::object* held) {
                const py::gil_scoped_acquire locked;
                delete held;
            }};
}

namespace {

std::vector<ShapeDimension> dimensions_of(py::handle shape) {
    std::vector<ShapeDimension> dimensions;
    const py::dict named = shape.attr("dimensions")();
    for (const auto& [name, value] : named) dimensions.push_back({name.cast<std::string>(), value.cast<double>()});
    if (dimensions.empty()) throw py::value_error("a shape has dimensions");
    return dimensions;
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
        const py::gil_scoped_acquire locked;
        try {
            py::dict given;
            for (std::size_t k = 0; k < values.size(); ++k) given[py::str(dimensions_[k].name)] = values[k];
            const py::tuple answer = shape_->attr("at")(given);
            if (answer.size() != 2) throw py::type_error("a shape's at() returns (mesh, derivatives by dimension)");
            ShapeInstance part;
            part.mesh = answer[0].cast<core::geometry::Mesh>();
            part.jacobian = jacobian_of(answer[1], part.mesh.vertices.cols());
            return part;
        } catch (py::error_already_set& raised) {
            return errors_of(raised, dimensions_.front().name);
        }
    }

private:
    std::vector<Matrix3X> jacobian_of(const py::dict& by_name, Eigen::Index vertices) const {
        std::vector<Matrix3X> jacobian;
        for (const ShapeDimension& dimension : dimensions_) {
            if (!by_name.contains(dimension.name)) throw py::key_error("no derivative by the dimension " + dimension.name);
            jacobian.push_back(columns_of(by_name[py::str(dimension.name)], "a derivative of vertices has shape (n, 3)"));
            if (jacobian.back().cols() != vertices) throw py::value_error("a derivative has a row per vertex of the mesh");
        }
        return jacobian;
    }

    std::shared_ptr<py::object> shape_;
    std::vector<ShapeDimension> dimensions_;
    bool always_solid_;
};

std::vector<ShapeDimension> drawn_dimensions(py::handle shape) {
    std::vector<ShapeDimension> dimensions;
    for (const auto& [name, value] : shape.attr("values").cast<std::map<std::string, double>>()) dimensions.push_back({name, value});
    if (dimensions.empty()) throw py::value_error("a shape has dimensions");
    return dimensions;
}

/// A function of Python's that makes meshes (fettle.MeshShape); its derivative comes from rebuilt ones.
class PythonMeshShape : public shapes::RebuiltShape {
public:
    explicit PythonMeshShape(py::handle shape)
        : RebuiltShape(drawn_dimensions(shape), maker(drawn_dimensions(shape), shared_object(shape.attr("function"))),
                       {.unit = shape.attr("unit").cast<double>(), .rounding = shape.attr("rounding").cast<std::optional<double>>()}),
          shape_(shared_object(shape)) {}
    py::object object() const { return *shape_; }

private:
    static shapes::MeshMaker maker(const std::vector<ShapeDimension>& dimensions, std::shared_ptr<py::object> function) {
        return [dimensions, function = std::move(function)](const std::vector<double>& values) -> Result<core::geometry::Mesh> {
            const py::gil_scoped_acquire locked;
            try {
                py::dict given;
                for (std::size_t k = 0; k < values.size(); ++k) given[py::str(dimensions[k].name)] = values[k];
                return (*function)(given).cast<core::geometry::Mesh>();
            } catch (py::error_already_set& raised) {
                return errors_of(raised, dimensions.front().name);
            }
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
    if (py::isinstance(shape, record_class("GeneratedPart"))) {
        const auto generator = shape.attr("generator").cast<std::string>();
        const auto dimensions = shape.attr("values").cast<std::map<std::string, double>>();
        return value_or_raise(GeneratedPart::create(generator, dimensions, {shape.attr("segments").cast<int>()}));
    }
    if (py::isinstance(shape, record_class("MeshShape"))) return std::make_shared<PythonMeshShape>(shape);
    if (py::isinstance(shape, record_class("ProgramShape")))
        return value_or_raise(shapes::ProgramPart::create(shape.attr("program").cast<shapes::MeshProgram>(), drawn_dimensions(shape)));
    if (!py::isinstance(shape, record_class("Shape"))) throw py::type_error("a body's shape is a fettle.Shape");
    return std::make_shared<PythonShape>(shape);
}

py::object shape_to_python(const std::shared_ptr<const Shape>& shape) {
    if (!shape) return py::none();
    if (const auto* own = dynamic_cast<const PythonShape*>(shape.get())) return own->object();
    if (const auto* part = dynamic_cast<const GeneratedPart*>(shape.get()))
        return record_class("GeneratedPart")(part->generator(), named_dimensions(*part), part->options().segments);
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
        .def("at", [](const OpaqueShape& self, const std::map<std::string, double>& values) { return instance(*self.shape, values); });
    module.def(
        "shape_at",
        [](const py::object& shape, const std::map<std::string, double>& values) { return instance(*shape_from_python(shape), values); },
        py::arg("shape"), py::arg("values") = std::map<std::string, double>(),
        "(mesh, {dimension: d vertices / d dimension, (n, 3)}) of a shape at these dimensions [m]; those left out are as drawn.");
    module.def(
        "shape_remarks",
        [](const py::object& given, const std::map<std::string, double>& values) {
            const auto shape = shape_from_python(given);
            const std::vector<double> ordered = in_order(*shape, values);
            const py::gil_scoped_release unlocked;
            return shape->remarks(ordered);
        },
        py::arg("shape"), py::arg("values") = std::map<std::string, double>(),
        "How a shape's derivative was found at these dimensions, and how exact it is; empty: it is exact.");
    module.def(
        "generators",
        [] {
            py::dict table;
            for (const shapes::GeneratorInfo& info : shapes::generator_table()) {
                py::dict dimensions;
                for (const auto& dimension : info.dimensions) dimensions[py::str(dimension.name)] = dimension.default_value;
                table[py::str(info.name)] = dimensions;
            }
            return table;
        },
        "{generator: {dimension: default [m]}}");
}

}  // namespace fettle::design::python
