// SPDX-License-Identifier: MIT
#include <algorithm>

#include "fettle/core/base/text.hpp"
#include "fettle/core/certificate/certificate_checker.hpp"
#include "fettle/core/clearance/clearance.hpp"
#include "fettle/core/clearance/range_clearance.hpp"
#include "fettle/design/python/arguments.hpp"
#include "fettle/design/python/bindings.hpp"
#include "fettle/design/python/errors.hpp"
#include "fettle/design/python/model_arrays.hpp"
#include "fettle/design/python/motion_records.hpp"
#include "fettle/design/python/watch.hpp"

namespace fettle::design::python {

namespace py = pybind11;
using core::base::Dimension;
using core::certificate::Certificate;
using core::clearance::ClearanceOptions;
using core::clearance::JointRanges;
using core::clearance::PairClearance;
using core::clearance::PairRequest;
using core::clearance::RangeClearance;
using core::clearance::RangeClearanceOptions;
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

// Of a PairRequest, or of (a, b) and (a, b, minimum); bodies by name or number.
PairRequest pair_from(py::handle given, const std::vector<std::string>& names, double minimum, const std::string& where) {
    PairRequest pair{.a = 0, .b = 0, .minimum = minimum};
    const auto set_bodies = [&](const py::object& a, const py::object& b) {
        pair.a = body_from(names, a, where + "/a");
        pair.b = body_from(names, b, where + "/b");
    };
    if (py::isinstance(given, record_class("PairRequest"))) {
        set_bodies(given.attr("a"), given.attr("b"));
        pair.minimum = member_of<double>(given, "PairRequest", "minimum");
        pair.far = member_of<double>(given, "PairRequest", "far");
        pair.may_touch = member_of<bool>(given, "PairRequest", "may_touch");
        pair.touch_depth = member_of<double>(given, "PairRequest", "touch_depth");
        return pair;
    }
    const bool some = py::isinstance<py::tuple>(given) || py::isinstance<py::list>(given);
    const std::size_t count = some ? py::len(given) : 0;
    if (count != 2 && count != 3)
        refuse(ErrorCode::wrong_type, where, shown(given) + ": a PairRequest, (a, b) or (a, b, minimum) is wanted, with names of bodies");
    set_bodies(given[py::int_(0)], given[py::int_(1)]);
    if (count == 3) pair.minimum = quantity_from(given[py::int_(2)], Dimension::length, where + "/minimum");
    return pair;
}

void check_pairs(const std::vector<PairRequest>& pairs) {
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const PairRequest& pair = pairs[k];
        const std::string where = "pairs/" + std::to_string(k);
        if (pair.a == pair.b) refuse(ErrorCode::inconsistent, where, "a pair is of two bodies; both are " + std::to_string(pair.a));
        check_at_least(where + "/minimum", pair.minimum, 0);
        check_at_least(where + "/touch_depth", pair.touch_depth, 0);
        if (!(pair.far > 0 && pair.far >= pair.minimum))
            refuse(ErrorCode::out_of_range, where + "/far", "it must be greater than 0, and at least the pair's minimum");
    }
}

// None: all that may collide.
std::vector<PairRequest> pairs_from(const py::object& given, const Model& model, const py::object& given_minimum) {
    const double minimum = quantity_from(given_minimum, Dimension::length, "minimum");
    check_at_least("minimum", minimum, 0);
    if (given.is_none()) return pairs_that_may_collide(model, minimum);
    if (!py::isinstance<py::sequence>(given) || py::isinstance<py::str>(given))
        refuse(ErrorCode::wrong_type, "pairs", shown(given) + ": a list of pairs is wanted");
    const std::vector<std::string> names = body_names(model);
    std::vector<PairRequest> pairs;
    for (const py::handle each : given) pairs.push_back(pair_from(each, names, minimum, "pairs/" + std::to_string(pairs.size())));
    check_pairs(pairs);
    return pairs;
}

void check_motion(const Model& model, const Trajectory& trajectory, bool motion) {
    check_same_bodies(trajectory, model);
    if (motion && trajectory.steps.empty())
        refuse(ErrorCode::inconsistent, "trajectory", "it has no steps, and so no motion; without one, parts are judged as assembled");
}

// With the names that the bodies have.
template <class Pair>
py::object as_list(const std::vector<Pair>& pairs, const Model& model) {
    return py::module_::import("fettle.results").attr("Pairs")(pairs, body_names(model));
}

struct ClearanceArguments {
    const Model& model;
    const Trajectory& trajectory;
    const std::vector<PairRequest>& pairs;
};

std::vector<PairClearance> certify(const ClearanceArguments& about, ClearanceOptions options, const py::object& progress) {
    check_motion(about.model, about.trajectory, options.motion);
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

std::vector<RangeClearance> certify_ranges(const Model& model, const JointRanges& ranges, const std::vector<PairRequest>& pairs,
                                           RangeClearanceOptions options, const py::object& progress) {
    Watch watch(progress);
    std::vector<RangeClearance> found;
    {
        const py::gil_scoped_release unlocked;
        options.on_pair = watch.on_count();
        options.should_stop = watch.should_stop();
        found = core::clearance::certify_ranges(model, ranges, pairs, options);
    }
    watch.end();
    return found;
}

void check_ranges(const JointRanges& ranges, const Model& model) {
    if (ranges.linkage.bodies.size() != model.bodies.size())
        refuse(ErrorCode::inconsistent, "ranges", "they are not of this model's joints");
}

void bind_ranges(py::module_& module) {
    py::class_<JointRanges, std::shared_ptr<JointRanges>>(
        module, "JointRanges", "Which coordinates a model's joints have, and within which limits: where --ranges looks.")
        .def_property_readonly(
            "coordinates", [](const JointRanges& self) { return self.linkage.coordinates; }, "RangeCoordinates, in the linkage's order")
        .def_readonly("held", &JointRanges::held, "Bodies that could move, and stay where they start.")
        .def("__repr__", [](const JointRanges& self) {
            return "JointRanges(" + core::base::counted(self.linkage.coordinates.size(), "coordinate") + ")";
        });
    module.def(
        "joint_ranges",
        [](const Model& model) { return std::make_shared<JointRanges>(value_or_raise(core::clearance::joint_ranges(model))); },
        py::arg("model"), "The JointRanges of a model. Raises Error for balls, planar joints, loops, and coordinates without limits.");
    module.def(
        "certify_ranges",
        [](const Model& model, const py::object& pairs, const py::object& minimum, const py::object& tolerance,
           const std::shared_ptr<JointRanges>& ranges, const std::shared_ptr<Certificate>& certificate, const py::object& progress) {
            const std::vector<PairRequest> wanted = pairs_from(pairs, model, minimum);
            RangeClearanceOptions options = core::clearance::usual_options(wanted);
            if (!tolerance.is_none()) {
                options.tolerance = quantity_from(tolerance, Dimension::length, "tolerance");
                options.coarse = 0;
                check_above("tolerance", options.tolerance, 0);
            }
            options.certificate = certificate.get();
            const JointRanges of = ranges ? *ranges : value_or_raise(core::clearance::joint_ranges(model));
            check_ranges(of, model);
            return as_list(certify_ranges(model, of, wanted, options, progress), model);
        },
        py::arg("model"), py::arg("pairs") = py::none(), py::arg("minimum") = 0.0, py::arg("tolerance") = py::none(),
        py::arg("ranges") = py::none(), py::arg("certificate") = py::none(), py::arg("progress") = py::none(),
        "Proven bounds [m] of the least distance of pairs of bodies over all positions of the joints within their limits, in every "
        "combination: Pairs of RangeClearance. pairs, minimum: as of certify_clearance. tolerance: None is 10 um or 1% of the least "
        "minimum, and 1% of the bodies' size where more than two coordinates move a pair.");
    module.def(
        "pose_at_witness",
        [](const Model& model, const JointRanges& ranges, const RangeClearance& pair, const py::object& body) {
            check_ranges(ranges, model);
            const std::vector<std::string> names = body_names(model);
            const auto coordinates = static_cast<int>(ranges.linkage.coordinates.size());
            const bool known = pair.coordinates.size() == pair.at.size() && std::all_of(pair.coordinates.begin(), pair.coordinates.end(),
                                                                                        [&](int c) { return c >= 0 && c < coordinates; });
            if (!known) refuse(ErrorCode::inconsistent, "pair", "it is not of these ranges");
            body_at(model, pair.a), body_at(model, pair.b);
            return core::clearance::pose_at_witness(model, ranges, pair, body_from(names, body, "body"));
        },
        py::arg("model"), py::arg("ranges"), py::arg("pair"), py::arg("body"),
        "Where a body's reference point is at a pair's witness, a Pose: what moves both of the pair stays where it starts.");
}

std::shared_ptr<Trajectory> or_as_assembled(const std::shared_ptr<Trajectory>& trajectory, const Model& model) {
    return trajectory ? trajectory : std::make_shared<Trajectory>(core::clearance::as_assembled(model));
}

}  // namespace

void bind_clearance(py::module_& module) {
    py::class_<Certificate, std::shared_ptr<Certificate>>(
        module, "Certificate", "The proof of clearances as data: over a path, as assembled, or over ranges of joints.")
        .def(py::init<>())
        .def_readonly("motion", &Certificate::motion)
        .def(
            "write", [](const Certificate& self, const Path& path) { raise_if_any(core::certificate::write_certificate(path, self)); },
            py::arg("path"))
        .def_static(
            "read", [](const Path& path) { return value_or_raise(core::certificate::read_certificate(path)); }, py::arg("path"))
        .def(
            "check",
            [](const Certificate& self, const Model& model, const std::shared_ptr<Trajectory>& trajectory) {
                const std::shared_ptr<Trajectory> path = or_as_assembled(trajectory, model);
                check_same_bodies(*path, model);
                const py::gil_scoped_release unlocked;
                return core::certificate::check_certificate(self, model, *path);
            },
            py::arg("model"), py::arg("trajectory") = py::none(),
            "Checked by code that shares nothing with the search: a CertificateReport. trajectory: None is the start, for what is as "
            "assembled or over ranges of joints.");
    module.def(
        "certify_clearance",
        [](const Model& model, const std::shared_ptr<Trajectory>& trajectory, const py::object& pairs, const py::object& minimum,
           const py::object& tolerance, bool margin_curve, const std::shared_ptr<Certificate>& certificate, const py::object& progress) {
            const std::vector<PairRequest> wanted = pairs_from(pairs, model, minimum);
            ClearanceOptions options;
            options.tolerance = quantity_from(tolerance, Dimension::length, "tolerance");
            check_above("tolerance", options.tolerance, 0);
            const std::shared_ptr<Trajectory> path = or_as_assembled(trajectory, model);
            options.motion = trajectory != nullptr;
            options.margin_curve = margin_curve;
            options.certificate = certificate.get();
            return as_list(certify({model, *path, wanted}, options, progress), model);
        },
        py::arg("model"), py::arg("trajectory") = py::none(), py::arg("pairs") = py::none(), py::arg("minimum") = 0.0,
        py::arg("tolerance") = 1e-6, py::arg("margin_curve") = false, py::arg("certificate") = py::none(), py::arg("progress") = py::none(),
        "Proven bounds [m] of the least distance of pairs of bodies, rounding included: over the continuous motion of the trajectory, or, "
        "without one, as assembled: Pairs of PairClearance. pairs: PairRequests, (a, b) or (a, b, minimum), bodies by name or number; "
        "None: all that may collide; with `minimum`, metres or \"0.3mm\". certificate: gets the proofs.");
    module.def(
        "as_assembled", [](const Model& model) { return std::make_shared<Trajectory>(core::clearance::as_assembled(model)); },
        py::arg("model"), "The start as a trajectory without steps.");
    bind_ranges(module);
}

}  // namespace fettle::design::python
