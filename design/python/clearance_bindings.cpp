// SPDX-License-Identifier: MIT
#include "fettle/core/certificate/certificate_checker.hpp"
#include "fettle/core/clearance/clearance.hpp"
#include "fettle/core/records/trajectory_io.hpp"
#include "fettle/design/python/arguments.hpp"
#include "fettle/design/python/bindings.hpp"
#include "fettle/design/python/errors.hpp"
#include "fettle/design/python/model_arrays.hpp"
#include "fettle/design/python/motion_records.hpp"
#include "fettle/design/python/watch.hpp"

namespace fettle::design::python {

namespace py = pybind11;
using core::certificate::Certificate;
using core::clearance::ClearanceOptions;
using core::clearance::PairClearance;
using core::clearance::PairRequest;
using core::model::Model;
using core::stepper::Trajectory;

namespace {

std::vector<PairRequest> pairs_that_may_collide(const Model& model, double minimum) {
    std::vector<PairRequest> pairs;
    const int bodies = static_cast<int>(model.bodies.size());
    for (int a = 0; a < bodies; ++a)
        for (int b = a + 1; b < bodies; ++b)
            if (core::model::may_collide(model, a, b)) pairs.push_back({.a = a, .b = b, .minimum = minimum});
    return pairs;
}

void check_request(const Model& model, const Trajectory& trajectory, const std::vector<PairRequest>& pairs, bool motion) {
    check_same_bodies(trajectory, model);
    if (motion && trajectory.steps.empty())
        refuse(ErrorCode::inconsistent, "trajectory", "it has no steps, and so no motion; without one, parts are judged as assembled");
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const PairRequest& pair = pairs[k];
        const std::string where = "pairs/" + std::to_string(k);
        body_at(model, pair.a), body_at(model, pair.b);
        if (pair.a == pair.b) refuse(ErrorCode::inconsistent, where, "a pair is of two bodies; both are " + std::to_string(pair.a));
        check_at_least(where + "/minimum", pair.minimum, 0);
        if (!(pair.far > 0 && pair.far >= pair.minimum))
            refuse(ErrorCode::out_of_range, where + "/far", "it must be greater than 0, and at least the pair's minimum");
    }
}

struct ClearanceArguments {
    const Model& model;
    const Trajectory& trajectory;
    const std::vector<PairRequest>& pairs;
};

std::vector<PairClearance> certify(const ClearanceArguments& about, ClearanceOptions options, const py::object& progress) {
    check_request(about.model, about.trajectory, about.pairs, options.motion);
    Watch watch(progress);
    std::vector<PairClearance> found;
    {
        const py::gil_scoped_release unlocked;
        options.on_pair = watch.on_count();
        options.should_stop = watch.should_stop();
        found = core::clearance::certify_clearance(about.model, about.trajectory, about.pairs, options);
    }
    watch.end();
    return found;
}

std::shared_ptr<Trajectory> or_as_assembled(const std::shared_ptr<Trajectory>& trajectory, const Model& model) {
    return trajectory ? trajectory : std::make_shared<Trajectory>(core::clearance::as_assembled(model));
}

}  // namespace

void bind_clearance(py::module_& module) {
    py::class_<Certificate, std::shared_ptr<Certificate>>(module, "Certificate", "The proof of clearances as data.")
        .def(py::init<>())
        .def_readonly("motion", &Certificate::motion)
        .def(
            "write",
            [](const Certificate& self, const std::string& path) { raise_if_any(core::certificate::write_certificate(path, self)); },
            py::arg("path"))
        .def_static(
            "read", [](const std::string& path) { return value_or_raise(core::certificate::read_certificate(path)); }, py::arg("path"))
        .def(
            "check",
            [](const Certificate& self, const Model& model, const Trajectory& trajectory) {
                check_same_bodies(trajectory, model);
                const py::gil_scoped_release unlocked;
                return core::certificate::check_certificate(self, model, trajectory);
            },
            py::arg("model"), py::arg("trajectory"), "Checked by code that shares nothing with the search: a CertificateReport.");
    module.def(
        "certify_clearance",
        [](const Model& model, const std::shared_ptr<Trajectory>& trajectory, const std::optional<std::vector<PairRequest>>& pairs,
           double minimum, double tolerance, bool margin_curve, const std::shared_ptr<Certificate>& certificate,
           const py::object& progress) {
            check_at_least("minimum", minimum, 0);
            check_above("tolerance", tolerance, 0);
            const std::shared_ptr<Trajectory> path = or_as_assembled(trajectory, model);
            ClearanceOptions options;
            options.tolerance = tolerance;
            options.motion = trajectory != nullptr;
            options.margin_curve = margin_curve;
            options.certificate = certificate.get();
            const auto wanted = pairs ? *pairs : pairs_that_may_collide(model, minimum);
            return certify({model, *path, wanted}, options, progress);
        },
        py::arg("model"), py::arg("trajectory") = py::none(), py::arg("pairs") = py::none(), py::arg("minimum") = 0.0,
        py::arg("tolerance") = 1e-6, py::arg("margin_curve") = false, py::arg("certificate") = py::none(), py::arg("progress") = py::none(),
        "Proven bounds [m] of the least distance of pairs of bodies, rounding included: over the continuous motion of the trajectory, or, "
        "without one, as assembled. pairs: PairRequests; None: all that may collide, with `minimum`. certificate: gets the proofs.");
}

}  // namespace fettle::design::python
