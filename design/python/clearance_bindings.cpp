// SPDX-License-Identifier: MIT
#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/base/text.hpp"
#include "core/certificate/certificate_checker.hpp"
#include "core/clearance/clearance.hpp"
#include "core/clearance/range_clearance.hpp"
#include "core/files/json_dump.hpp"
#include "design/clearance/ranges_report.hpp"
#include "design/clearance/report_json.hpp"
#include "design/features/features_report.hpp"
#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/errors.hpp"
#include "design/python/model_arrays.hpp"
#include "design/python/motion_records.hpp"
#include "design/python/watch.hpp"

namespace fettle::design::python {

namespace py = pybind11;
using core::base::Dimension;
using core::certificate::Certificate;
using core::clearance::ClearanceOptions;
using core::clearance::JointRanges;
using core::clearance::PairClearance;
using core::clearance::PairRequest;
using core::clearance::ProvenClearances;
using core::model::Model;
using core::stepper::Trajectory;

namespace {

std::vector<PairRequest> pairs_that_may_collide(const Model& model, double minimum) {
    std::vector<PairRequest> pairs;
    const int bodies = count_of(model.bodies);
    for (int a = 0; a < bodies; ++a)
        for (int b = a + 1; b < bodies; ++b)
            if (core::model::may_collide(model, a, b)) pairs.push_back({.a = a, .b = b, .minimum = minimum});
    return pairs;
}

// Makes a pair of a PairRequest, or of (a, b) and (a, b, minimum); bodies by name or number.
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
        refuse(ErrorCode::wrong_type, where, shown(given) + ": a PairRequest, (a, b) or (a, b, minimum) is expected, with names of bodies");
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
        refuse(ErrorCode::wrong_type, "pairs", shown(given) + ": a list of pairs is expected");
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
py::object as_list(const std::vector<PairClearance>& pairs, const Model& model) {
    return py::module_::import("fettle.results").attr("Pairs")(pairs, body_names(model));
}

std::optional<double> tolerance_from(const py::object& given) {
    if (given.is_none()) return std::nullopt;
    const double tolerance = quantity_from(given, Dimension::length, "tolerance");
    check_above("tolerance", tolerance, 0);
    return tolerance;
}

// `work` gives ProvenClearances; a certificate that was given gets the proofs.
template <class Work>
py::object certified(const Model& model, ClearanceOptions options, Certificate* certificate, const py::object& progress, const Work& work) {
    Watch watch(progress);
    ProvenClearances found;
    {
        const py::gil_scoped_release unlocked;
        options.on_pair = watch.on_count();
        options.should_stop = watch.should_stop();
        found = work(options);
    }
    watch.end();
    if (certificate != nullptr) *certificate = std::move(found.certificate);
    return as_list(found.pairs, model);
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
        py::arg("model"), "The JointRanges of a model. Raises Error for loops, and for coordinates without limits.");
    module.def(
        "certify_ranges",
        [](const Model& model, const py::object& pairs, const py::object& minimum, const py::object& tolerance,
           const std::shared_ptr<JointRanges>& ranges, const std::shared_ptr<Certificate>& certificate, const py::object& progress) {
            const std::vector<PairRequest> wanted = pairs_from(pairs, model, minimum);
            const JointRanges of = ranges ? *ranges : value_or_raise(core::clearance::joint_ranges(model));
            check_ranges(of, model);
            const ClearanceOptions asked = core::clearance::usual_options(wanted, tolerance_from(tolerance));
            return certified(model, asked, certificate.get(), progress, [&](const ClearanceOptions& options) -> ProvenClearances {
                if (certificate) return core::clearance::certify_with_proof(model, of, wanted, options);
                return {core::clearance::certify(model, of, wanted, options), {}};
            });
        },
        py::arg("model"), py::arg("pairs") = py::none(), py::arg("minimum") = 0.0, py::arg("tolerance") = py::none(),
        py::arg("ranges") = py::none(), py::arg("certificate") = py::none(), py::arg("progress") = py::none(),
        "Proven bounds [m] of the least distance of pairs of bodies over all positions of the joints within their limits, in every "
        "combination: Pairs of PairClearance. pairs, minimum: as of certify_clearance. tolerance: None is 1 um or 0.1% of the least "
        "minimum, and 1% of the bodies' size where more than two coordinates move a pair.");
    module.def(
        "pose_at_witness",
        [](const Model& model, const JointRanges& ranges, const PairClearance& pair, const py::object& body) {
            check_ranges(ranges, model);
            const std::vector<std::string> names = body_names(model);
            const auto coordinates = count_of(ranges.linkage.coordinates);
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

// A text, or several.
std::vector<std::string> texts_from(const py::object& given, const char* where) {
    if (py::isinstance<py::str>(given)) return {given.cast<std::string>()};
    if (!py::isinstance<py::sequence>(given))
        refuse(ErrorCode::wrong_type, where, shown(given) + ": a text such as \"A:B\", or a list, is expected");
    std::vector<std::string> texts;
    for (const py::handle each : given) {
        if (!py::isinstance<py::str>(each)) refuse(ErrorCode::wrong_type, where, shown(each) + ": a text such as \"A:B\" is expected");
        texts.push_back(each.cast<std::string>());
    }
    return texts;
}

std::string listed(const std::vector<std::string>& texts) {
    std::string list;
    for (const std::string& text : texts) list += (list.empty() ? "" : ",") + text;
    return list;
}

// {"frame": ["a", "b"]} as the command line has it: "frame=a,b".
std::vector<std::string> groups_from(const py::object& given) {
    if (!py::isinstance<py::dict>(given))
        refuse(ErrorCode::wrong_type, "groups", shown(given) + ": a dict of names and lists of bodies is expected");
    std::vector<std::string> groups;
    for (const auto& [name, bodies] : given.cast<py::dict>())
        groups.push_back(py::str(name).cast<std::string>() + "=" +
                         listed(texts_from(py::reinterpret_borrow<py::object>(bodies), "groups")));
    return groups;
}

// "--allow-touch" -> "allow_touch": what the command calls an option is an argument here.
Errors with_arguments(Errors errors) {
    for (Error& error : errors) {
        if (!error.where.starts_with("--")) continue;
        error.where = error.where == "--group" ? "groups" : error.where.substr(2);
        std::replace(error.where.begin(), error.where.end(), '-', '_');
    }
    return errors;
}

clearance::Subject subject_from(const Model& model, const std::shared_ptr<Trajectory>& trajectory, const py::object& ranges) {
    const bool is_over_ranges = !ranges.is_none() && !(py::isinstance<py::bool_>(ranges) && !ranges.cast<bool>());
    if (!is_over_ranges) {
        if (!trajectory) return clearance::subject_of(model);
        check_motion(model, *trajectory, true);
        return clearance::subject_of(model, *trajectory);
    }
    if (trajectory) refuse(ErrorCode::inconsistent, "ranges", "are in place of a trajectory");
    if (py::isinstance<py::bool_>(ranges)) return value_or_raise(clearance::subject_over_joints(model));
    if (!py::isinstance<JointRanges>(ranges)) refuse(ErrorCode::wrong_type, "ranges", shown(ranges) + ": True or JointRanges is expected");
    check_ranges(ranges.cast<const JointRanges&>(), model);
    return clearance::subject_over(model, {core::clearance::as_assembled(model), ranges.cast<const JointRanges&>()});
}

clearance::PairOptions pair_options_from(const py::object& minimum, const std::string& process, const py::object& pairs,
                                         const py::object& ignore, const py::object& allow_touch, const py::object& groups) {
    clearance::PairOptions options;
    options.pairs = listed(texts_from(pairs, "pairs"));
    options.ignore = listed(texts_from(ignore, "ignore"));
    options.touches = texts_from(allow_touch, "allow_touch");
    std::erase(options.touches, "");
    options.groups = groups_from(groups);
    options.process = process;
    if (minimum.is_none()) return options;
    options.minimum = quantity_from(minimum, Dimension::length, "minimum");
    check_at_least("minimum", *options.minimum, 0);
    return options;
}

py::object report_of(const clearance::Subject& subject, clearance::Question question, const std::optional<Path>& baseline,
                     const py::object& progress) {
    if (subject.domain.is_tree() && !question.pairs.touches.empty())
        refuse(ErrorCode::inconsistent, "allow_touch", "needs a path: over ranges of joints touches are not reported");
    std::optional<clearance::Baseline> before;
    if (baseline) before = value_or_raise(clearance::Baseline::read(baseline->string()));
    Watch watch(progress);
    Result<clearance::ClearanceReport> judged = [&] {
        const py::gil_scoped_release unlocked;
        question.on_pair = watch.on_count();
        question.should_stop = watch.should_stop();
        return clearance::judge_clearances(subject, question);
    }();
    watch.end();
    if (!judged) raise_if_any(with_arguments(judged.errors()));
    if (before) compare_with(*std::move(before), *judged);
    std::shared_ptr<Certificate> certificate;
    if (judged->certificate && !judged->certificate->pairs.empty()) certificate = std::make_shared<Certificate>(*judged->certificate);
    return py::module_::import("fettle.results").attr("ClearanceReport")(core::files::dumped(report_json(*judged, subject)), certificate);
}

void bind_question(py::module_& module) {
    module.def(
        "clearance",
        [](const Model& model, const std::shared_ptr<Trajectory>& trajectory, const py::object& ranges, const py::object& minimum,
           const std::string& process, const py::object& pairs, const py::object& ignore, const py::object& allow_touch,
           const py::object& groups, const py::object& tolerance, bool witnesses, const std::optional<Path>& baseline, bool proof,
           const py::object& progress) {
            clearance::Question question;
            question.pairs = pair_options_from(minimum, process, pairs, ignore, allow_touch, groups);
            question.tolerance = tolerance_from(tolerance);
            question.all_witnesses = witnesses;
            question.proof = proof;
            return report_of(subject_from(model, trajectory, ranges), std::move(question), baseline, progress);
        },
        py::arg("model"), py::arg("trajectory") = py::none(), py::arg("ranges") = false, py::arg("minimum") = py::none(),
        py::arg("process") = "", py::arg("pairs") = "", py::arg("ignore") = "", py::arg("allow_touch") = "", py::arg("groups") = py::dict(),
        py::arg("tolerance") = py::none(), py::arg("witnesses") = false, py::arg("baseline") = py::none(), py::arg("proof") = false,
        py::arg("progress") = py::none(),
        "What `fettle clearance` asks and answers, a ClearanceReport: as assembled, over the trajectory, or, with ranges (True, or "
        "JointRanges), over all positions of the joints. minimum: None reports distances and clashes. process: \"fdm\", \"sla\", \"sls\", "
        "\"mjf\", or your own: NAME or a file of NAME.process.json. pairs, ignore: \"A:B\", \"pin*:plate=0.4mm\" or a list of such; by "
        "default every pair as assembled, else those that may "
        "collide. allow_touch: \"lid:base\". groups: {\"frame\": [\"a\", \"b\"]}, bodies that are one rigid set. tolerance: None is 1 um "
        "or "
        "0.1% of the least minimum. witnesses: all that come as close. baseline: an earlier report's file. proof: with its certificate.");
}

void bind_ranges_question(py::module_& module) {
    module.def(
        "free_ranges",
        [](const Model& model, const py::object& joints, const py::object& minimum, const py::object& ignore, bool anywhere,
           const py::object& angle, const py::object& length, const py::object& reach, const py::object& progress) {
            clearance::RangesQuestion question;
            question.joints = texts_from(joints, "joints");
            std::erase(question.joints, "");
            question.ignore = listed(texts_from(ignore, "ignore"));
            question.options.others_anywhere = anywhere;
            const auto read = [](const py::object& given, Dimension dimension, const char* name, double& out) {
                if (given.is_none()) return;
                out = quantity_from(given, dimension, name);
                check_above(name, out, 0);
            };
            if (!minimum.is_none()) {
                question.options.minimum = quantity_from(minimum, Dimension::length, "minimum");
                check_at_least("minimum", question.options.minimum, 0);
            }
            read(angle, Dimension::angle, "angle", question.options.angle);
            read(length, Dimension::length, "length", question.options.length);
            if (!reach.is_none()) read(reach, Dimension::length, "reach", question.reach.emplace());
            Watch watch(progress);
            const Result<clearance::RangesReport> report = [&] {
                const py::gil_scoped_release unlocked;
                question.on_joint = watch.on_count();
                question.options.should_stop = watch.should_stop();
                return clearance::ask_ranges(model, question);
            }();
            watch.end();
            if (!report) raise_if_any(with_arguments(report.errors()));
            return py::module_::import("json").attr("loads")(core::files::dumped(clearance::ranges_json(*report)));
        },
        py::arg("model"), py::arg("joints") = "", py::arg("minimum") = py::none(), py::arg("ignore") = "", py::arg("anywhere") = false,
        py::arg("angle") = py::none(), py::arg("length") = py::none(), py::arg("reach") = py::none(), py::arg("progress") = py::none(),
        "What `fettle ranges` asks and answers, a dict with the keys of its JSON (SI): from where to where each joint is proven free, and "
        "what stops it, whatever its limits. joints: names, or a name; all by default. minimum: clearance that is kept. ignore: \"A:B\" or "
        "a list of such. anywhere: the other joints anywhere within their limits, not where they start. angle, length: how near an end is "
        "found (0.01 deg, 0.01 mm). reach: how far slides are looked at. progress(done, of).");
}

void bind_features_question(py::module_& module) {
    module.def(
        "features",
        [](const Model& model, const std::string& process, const py::object& tolerance, bool fits, bool triangles,
           const py::object& progress) {
            features::FeaturesQuestion question;
            question.process = process;
            question.fits = fits;
            if (!tolerance.is_none()) {
                question.options.tolerance = quantity_from(tolerance, Dimension::length, "tolerance");
                check_above("tolerance", *question.options.tolerance, 0);
            }
            Watch watch(progress);
            const Result<features::FeaturesReport> report = [&] {
                const py::gil_scoped_release unlocked;
                question.on_body = watch.on_count();
                question.should_stop = watch.should_stop();
                return features::ask_features(model, question);
            }();
            watch.end();
            if (!report) raise_if_any(with_arguments(report.errors()));
            return py::module_::import("json").attr("loads")(core::files::dumped(features::features_json(*report, triangles)));
        },
        py::arg("model"), py::arg("process") = "", py::arg("tolerance") = py::none(), py::arg("fits") = true, py::arg("triangles") = false,
        py::arg("progress") = py::none(),
        "What `fettle features` asks and answers, a dict with the keys of its JSON (SI): planes, bores, pins, cones, spheres and tori of "
        "each "
        "body as assembled, fitted, and which pin sits in which hole. process: by which a fit's play is judged. tolerance: how far corners "
        "may "
        "lie from their surface. triangles: lists those of each feature. progress(done, of).");
}

}  // namespace

void bind_clearance(py::module_& module) {
    bind_features_question(module);
    py::class_<Certificate, std::shared_ptr<Certificate>>(
        module, "Certificate", "The proof of clearances as data: over a path, as assembled, or over ranges of joints.")
        .def(py::init<>())
        .def_readonly("motion", &Certificate::motion)
        .def_readwrite(
            "source", &Certificate::source,
            "The scene or design that it was made from, as seen from the folder that it is written to, so that `fettle validate` "
            "can compare it with that; empty: none.")
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
            "Checked without the search: a CertificateReport. trajectory: None is the start, for what is as "
            "assembled or over ranges of joints.");
    module.def(
        "certify_clearance",
        [](const Model& model, const std::shared_ptr<Trajectory>& trajectory, const py::object& pairs, const py::object& minimum,
           const py::object& tolerance, bool margin_curve, const std::shared_ptr<Certificate>& certificate, const py::object& progress) {
            const std::vector<PairRequest> wanted = pairs_from(pairs, model, minimum);
            const std::shared_ptr<Trajectory> path = or_as_assembled(trajectory, model);
            check_motion(model, *path, trajectory != nullptr);
            ClearanceOptions asked = core::clearance::usual_options(wanted, tolerance_from(tolerance));
            asked.motion = trajectory != nullptr;
            asked.margin_curve = margin_curve;
            return certified(model, asked, certificate.get(), progress, [&](const ClearanceOptions& options) -> ProvenClearances {
                if (certificate) return core::clearance::certify_with_proof(model, *path, wanted, options);
                return {core::clearance::certify(model, *path, wanted, options), {}};
            });
        },
        py::arg("model"), py::arg("trajectory") = py::none(), py::arg("pairs") = py::none(), py::arg("minimum") = 0.0,
        py::arg("tolerance") = py::none(), py::arg("margin_curve") = false, py::arg("certificate") = py::none(),
        py::arg("progress") = py::none(),
        "Proven bounds [m] of the least distance of pairs of bodies, rounding included: over the continuous motion of the trajectory, or, "
        "without one, as assembled: Pairs of PairClearance. pairs: PairRequests, (a, b) or (a, b, minimum), bodies by name or number; "
        "None: all that may collide; with `minimum`, metres or \"0.3mm\". tolerance: None is 1 um or 0.1% of the least minimum. "
        "certificate: "
        "gets the proofs.");
    module.def(
        "as_assembled", [](const Model& model) { return std::make_shared<Trajectory>(core::clearance::as_assembled(model)); },
        py::arg("model"), "The start as a trajectory without steps.");
    bind_ranges(module);
    bind_question(module);
    bind_ranges_question(module);
}

}  // namespace fettle::design::python
