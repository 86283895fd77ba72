// SPDX-License-Identifier: MIT
#include "core/setup/build_model.hpp"
#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/errors.hpp"
#include "design/python/model_arrays.hpp"

namespace fettle::design::python {

namespace py = pybind11;
using core::model::Body;
using core::model::Model;

namespace {

std::shared_ptr<Model> build_model(const core::scene::Scene& scene, const py::object& given_kappa, bool check_start) {
    std::optional<double> kappa;
    if (!given_kappa.is_none()) kappa = quantity_from(given_kappa, core::base::Dimension::stiffness, "kappa");
    if (kappa) check_above("kappa", *kappa, 0);
    check_above("scene/length_unit", scene.length_unit, 0);
    check_at_least("scene/max_newton_iterations", scene.max_newton_iterations, 1);
    core::setup::BuildOptions options;
    options.kappa = kappa;
    options.check_start = check_start;
    std::shared_ptr<Model> model;
    {
        const py::gil_scoped_release unlocked;
        model = std::make_shared<Model>(value_or_raise(core::setup::build_model(scene, options)));
    }
    warn_of(model->warnings);
    return model;
}

}  // namespace

std::vector<std::string> body_names(const Model& model) {
    std::vector<std::string> names;
    for (const Body& body : model.bodies) names.push_back(body.name);
    return names;
}

const Body& body_at(const Model& model, int body) {
    if (body < 0 || static_cast<std::size_t>(body) >= model.bodies.size())
        throw py::index_error("there is no body " + std::to_string(body) + "; there are " + std::to_string(model.bodies.size()) +
                              ", counted from 0");
    return model.bodies[body];
}

py::array read_only(py::array array) {
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

py::array vertices_of(const Model& model, int body, py::handle owner) {
    const Matrix3X& vertices = body_at(model, body).mesh.vertices;
    return read_only(py::array_t<double>({vertices.cols(), Eigen::Index{3}}, vertices.data(), owner));
}

py::array triangles_of(const Model& model, int body, py::handle owner) {
    const auto& triangles = body_at(model, body).mesh.triangles;
    const int* first = triangles.empty() ? nullptr : triangles.front().data();
    return read_only(py::array_t<int>({triangles.size(), std::size_t{3}}, first, owner));
}

py::array reference_points_of(const Model& model) {
    py::array_t<double> points({model.bodies.size(), std::size_t{3}});
    auto out = points.mutable_unchecked<2>();
    for (std::size_t b = 0; b < model.bodies.size(); ++b)
        for (int i = 0; i < 3; ++i) out(static_cast<py::ssize_t>(b), i) = model.bodies[b].reference_point[i];
    return points;
}

namespace {

int body_named(const Model& model, const py::object& body) { return body_from(body_names(model), body, "body"); }

}  // namespace

void bind_model(py::module_& module) {
    py::class_<Model, std::shared_ptr<Model>>(
        module, "Model",
        "Bodies with mass, hierarchy and prescribed coordinates; const once built. A body is asked for "
        "by its number or its name.")
        .def_property_readonly("body_names", &body_names)
        .def_property_readonly(
            "body_types",
            [](const Model& model) {
                std::vector<core::scene::BodyType> types;
                for (const Body& body : model.bodies) types.push_back(body.type);
                return types;
            },
            "\"dynamic\", \"static\" or \"kinematic\", per body.")
        .def("__repr__", [](const py::object& self) { return py::module_::import("fettle._shown").attr("model_line")(self); })
        .def(
            "_repr_html_", [](const py::object& self) { return py::module_::import("fettle._shown").attr("model_html")(self); },
            "How a notebook shows it: a table of the bodies, and the parts at the start.")
        .def_property_readonly("reference_points", &reference_points_of,
                               "(bodies, 3): c of each body in its file's frame [m]; poses are c's, vertices relative to it.")
        .def(
            "vertices",
            [](const py::object& self, const py::object& body) {
                const auto& model = self.cast<const Model&>();
                return vertices_of(model, body_named(model, body), self);
            },
            py::arg("body"), "(n, 3), relative to the body's reference point [m]; a read-only view, no copy.")
        .def(
            "triangles",
            [](const py::object& self, const py::object& body) {
                const auto& model = self.cast<const Model&>();
                return triangles_of(model, body_named(model, body), self);
            },
            py::arg("body"), "(m, 3), counter-clockwise seen from outside; a read-only view, no copy.")
        .def(
            "mass", [](const Model& model, const py::object& body) { return body_at(model, body_named(model, body)).moments(3, 3); },
            py::arg("body"), "[kg]; 0 unless dynamic.")
        .def(
            "density", [](const Model& model, const py::object& body) { return body_at(model, body_named(model, body)).density; },
            py::arg("body"))
        .def(
            "mesh", [](const Model& model, const py::object& body) { return body_at(model, body_named(model, body)).mesh; },
            py::arg("body"), "A copy of the body's mesh, relative to its reference point.")
        .def(
            "may_collide",
            [](const Model& model, const py::object& a, const py::object& b) {
                return core::model::may_collide(model, body_named(model, a), body_named(model, b));
            },
            py::arg("a"), py::arg("b"), "Does contact act between these two bodies?")
        .def_property_readonly(
            "gravity", [](const Model& model) { return Vector3(model.gravity); }, "[m/s^2]")
        .def_readonly("timestep", &Model::timestep, "[s]")
        .def_readonly("end_time", &Model::end_time, "[s]; negative: not given.")
        .def_readonly("dhat", &Model::dhat, "Activation distance [m].")
        .def_readonly("dmin", &Model::dmin, "Minimum separation [m].")
        .def_readonly("kappa", &Model::kappa, "Barrier stiffness [N/m].")
        .def_readonly("length_unit", &Model::length_unit, "Unit of length of the scene's file [m].")
        .def_readonly("warnings", &Model::warnings)
        .def("__len__", [](const Model& model) { return model.bodies.size(); });
    module.def("build_model", &build_model, py::arg("scene"), py::arg("kappa") = py::none(), py::arg("check_start") = true,
               "Scene -> Model. Raises Error with every fault found, by body, mesh and element; warns of what can hardly be meant.");
}

}  // namespace fettle::design::python
