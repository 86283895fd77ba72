// SPDX-License-Identifier: MIT
#include "core/base/parallel.hpp"
#include "core/base/version.hpp"
#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/errors.hpp"

PYBIND11_MODULE(_fettle, module) {
    namespace python = fettle::design::python;
    module.attr("__version__") = fettle::core::base::version();
    python::bind_errors(module);
    pybind11::class_<fettle::core::base::ThreadLimit>(module, "ThreadLimit", "Caps the threads of all loops while it lives.")
        .def(pybind11::init([](int threads) {
                 python::check_at_least("threads", threads, 1);
                 return std::make_unique<fettle::core::base::ThreadLimit>(threads);
             }),
             pybind11::arg("threads"));
    python::bind_formula(module);
    python::bind_scene(module);
    python::bind_model(module);
    python::bind_trajectory(module);
    python::bind_clearance(module);
    python::bind_design(module);
    python::bind_problem(module);
    python::bind_studies(module);
    python::bind_exploration(module);
    python::bind_tolerances(module);
    python::bind_exports(module);
    python::bind_session(module);
}
