// SPDX-License-Identifier: MIT
#include "core/records/trajectory_io.hpp"
#include "core/stepper/scripted_motion.hpp"
#include "core/stepper/simulate.hpp"
#include "design/python/arguments.hpp"
#include "design/python/bindings.hpp"
#include "design/python/errors.hpp"
#include "design/python/model_arrays.hpp"
#include "design/python/motion_records.hpp"
#include "design/python/watch.hpp"

namespace fettle::design::python {

namespace py = pybind11;
using core::kinematics::Pose;
using core::model::Model;
using core::stepper::Trajectory;

namespace {

core::stepper::Simulation simulate(const Model& model, const std::optional<int>& steps, bool for_gradient, bool outputs,
                                   const py::object& progress) {
    const int count = steps_from(steps);
    Watch watch(progress);
    core::stepper::Simulation simulation;
    {
        const py::gil_scoped_release unlocked;
        core::stepper::SimulationOptions options;
        options.steps = count;
        options.for_gradient = for_gradient;
        options.outputs = outputs;
        options.on_step = watch.on_step();
        options.should_stop = watch.should_stop();
        simulation = core::stepper::simulate(model, options);
    }
    watch.end();
    return simulation;
}

py::tuple read_trajectory(const Path& path) {
    core::records::StoredTrajectory stored;
    {
        const py::gil_scoped_release unlocked;
        stored = value_or_raise(core::records::read_trajectory(path.string()));
    }
    return py::make_tuple(std::make_shared<Trajectory>(std::move(stored.trajectory)), std::make_shared<Model>(std::move(stored.model)));
}

void write_trajectory(const Path& path, const Trajectory& trajectory, const Model& model, const Path& scene_path) {
    check_same_bodies(trajectory, model);
    raise_if_any(core::records::write_trajectory(path.string(), trajectory, model, scene_path.string()));
}

std::size_t time_index(const Trajectory& trajectory, int t) {
    const int count = count_of(trajectory.poses);
    if (t < -count || t >= count)
        throw py::index_error("the trajectory has no instant " + std::to_string(t) + "; it has " + std::to_string(count) +
                              ", counted from 0");
    return static_cast<std::size_t>(t < 0 ? t + count : t);
}

// A view of the poses of one instant, every `sizeof(Pose)` bytes from `first`.
py::array pose_view(const py::object& self, int t, const std::vector<py::ssize_t>& shape, bool rotation) {
    const auto& poses = self.cast<const Trajectory&>().poses[time_index(self.cast<const Trajectory&>(), t)];
    constexpr py::ssize_t number = sizeof(double);
    std::vector<py::ssize_t> sizes{static_cast<py::ssize_t>(poses.size())}, strides{sizeof(Pose)};
    sizes.insert(sizes.end(), shape.begin(), shape.end());
    strides.push_back(number);
    if (rotation) strides.push_back(3 * number);  // columns stand together
    const double* first = poses.empty() ? nullptr : rotation ? poses.front().rotation.data() : poses.front().position.data();
    return read_only(py::array(py::dtype::of<double>(), sizes, strides, first, self));
}

// A trajectory's numbers in one list, so that it can be pickled: poses by rows, then the nodes of each step.
py::tuple packed(const Trajectory& trajectory) {
    std::vector<double> numbers;
    std::vector<int> nodes;
    std::vector<std::vector<double>> fractions;
    for (const auto& poses : trajectory.poses) {
        for (const Pose& pose : poses) {
            numbers.insert(numbers.end(), pose.rotation.data(), pose.rotation.data() + 9);
            numbers.insert(numbers.end(), pose.position.data(), pose.position.data() + 3);
        }
    }
    for (const auto& step : trajectory.steps) {
        nodes.push_back(count_of(step.nodes));
        fractions.push_back(step.fractions);
        for (const auto& node : step.nodes) {
            for (const auto& point : node) {
                numbers.insert(numbers.end(), point.position.data(), point.position.data() + 3);
                numbers.insert(numbers.end(), point.rotation_vector.data(), point.rotation_vector.data() + 3);
            }
        }
    }
    const py::array_t<double> array(static_cast<py::ssize_t>(numbers.size()), numbers.data());
    return py::make_tuple(trajectory.time_start, trajectory.timestep, trajectory.times, trajectory.body_names, array, nodes, fractions);
}

Trajectory unpacked(const py::tuple& state) {
    Trajectory trajectory;
    trajectory.time_start = state[0].cast<double>();
    trajectory.timestep = state[1].cast<double>();
    trajectory.times = state[2].cast<std::vector<double>>();
    trajectory.body_names = state[3].cast<std::vector<std::string>>();
    const auto array = state[4].cast<py::array_t<double, py::array::c_style>>();
    const auto nodes = state[5].cast<std::vector<int>>();
    const auto fractions = state[6].cast<std::vector<std::vector<double>>>();
    const std::size_t bodies = trajectory.body_names.size();
    std::size_t wanted = 12 * bodies * (nodes.size() + 1);
    for (const int count : nodes) wanted += 6 * bodies * static_cast<std::size_t>(count);
    if (static_cast<std::size_t>(array.size()) != wanted || fractions.size() != nodes.size())
        throw py::value_error("this is not a trajectory's state");
    const double* next = array.data();
    const auto take = [&](double* out, int count) {
        std::copy_n(next, count, out);
        next += count;
    };
    trajectory.poses.assign(nodes.size() + 1, std::vector<Pose>(bodies));
    for (auto& poses : trajectory.poses) {
        for (Pose& pose : poses) {
            take(pose.rotation.data(), 9);
            take(pose.position.data(), 3);
        }
    }
    for (std::size_t t = 0; t < nodes.size(); ++t) {
        core::stepper::TrajectoryStep& step = trajectory.steps.emplace_back();
        step.fractions = fractions[t];
        step.nodes.assign(nodes[t], std::vector<core::kinematics::ChartPoint>(bodies));
        for (auto& node : step.nodes) {
            for (auto& point : node) {
                take(point.position.data(), 3);
                take(point.rotation_vector.data(), 3);
            }
        }
    }
    return trajectory;
}

}  // namespace

py::array positions_of(const Trajectory& trajectory) {
    const std::size_t bodies = trajectory.body_names.size();
    py::array_t<double> out({trajectory.poses.size(), bodies, std::size_t{3}});
    double* next = out.mutable_data();
    for (const auto& poses : trajectory.poses)
        for (const Pose& pose : poses) next = std::copy_n(pose.position.data(), 3, next);
    return out;
}

py::array rotations_of(const Trajectory& trajectory) {
    const std::size_t bodies = trajectory.body_names.size();
    py::array_t<double> out({trajectory.poses.size(), bodies, std::size_t{3}, std::size_t{3}});
    double* next = out.mutable_data();
    for (const auto& poses : trajectory.poses) {
        for (const Pose& pose : poses) {
            const Matrix3 by_rows = pose.rotation.transpose();
            next = std::copy_n(by_rows.data(), 9, next);
        }
    }
    return out;
}

py::array times_of(const Trajectory& trajectory) {
    py::array_t<double> out(static_cast<py::ssize_t>(trajectory.poses.size()));
    for (std::size_t t = 0; t < trajectory.poses.size(); ++t)
        out.mutable_at(static_cast<py::ssize_t>(t)) = core::stepper::time_at(trajectory, static_cast<int>(t));
    return out;
}

void bind_trajectory(py::module_& module) {
    py::class_<Trajectory, std::shared_ptr<Trajectory>>(
        module, "Trajectory", "Configurations, and the continuous path between them. Poses are those of the bodies' reference points.")
        .def(py::init<>())
        .def_readonly("body_names", &Trajectory::body_names)
        .def_readonly("timestep", &Trajectory::timestep, "[s]")
        .def_property_readonly("times", &times_of, "(steps + 1) [s]")
        .def_property_readonly("positions", &positions_of, "(steps + 1, bodies, 3) [m]; a copy.")
        .def_property_readonly("rotations", &rotations_of, "(steps + 1, bodies, 3, 3), world = rotation @ X + position; a copy.")
        .def(
            "positions_at", [](const py::object& self, int t) { return pose_view(self, t, {3}, false); }, py::arg("t"),
            "(bodies, 3) at one instant [m]; a read-only view, no copy.")
        .def(
            "rotations_at",
            [](const py::object& self, int t) {
                return pose_view(self, t, {3, 3}, true);
            },
            py::arg("t"), "(bodies, 3, 3) at one instant; a read-only view, no copy.")
        .def("__len__", [](const Trajectory& trajectory) { return trajectory.steps.size(); })
        .def("__eq__",
             [](const Trajectory& a, const py::object& b) {
                 if (!py::isinstance<Trajectory>(b)) return false;
                 const py::object dumps = py::module_::import("pickle").attr("dumps");
                 return dumps(packed(a)).equal(dumps(packed(b.cast<const Trajectory&>())));
             })
        .def("__repr__", [](const py::object& self) { return py::module_::import("fettle._shown").attr("trajectory_line")(self); })
        .def(
            "_repr_html_", [](const py::object& self) { return py::module_::import("fettle._shown").attr("trajectory_html")(self); },
            "How a notebook shows it.")
        .def(py::pickle(&packed, &unpacked));
    module.def(
        "simulate", &simulate, py::arg("model"), py::arg("steps") = py::none(), py::arg("for_gradient") = false, py::arg("outputs") = false,
        py::arg("progress") = py::none(),
        "Runs a model through time; the same bits for any number of threads. steps: None runs until the model's end_time (1000 steps "
        "where it has none). progress(done, steps) is called after each step.");
    module.def(
        "follow_scripts",
        [](const Model& model, const std::optional<int>& steps) {
            return std::make_shared<Trajectory>(core::stepper::follow_scripts(model, steps_from(steps)));
        },
        py::arg("model"), py::arg("steps") = py::none(), py::call_guard<py::gil_scoped_release>(),
        "Motion without dynamics and contact: prescribed coordinates follow their scripts, all else stays.");
    module.def("read_trajectory", &read_trajectory, py::arg("path"), "(Trajectory, Model) of a *.trajectory.json.");
    module.def("write_trajectory", &write_trajectory, py::arg("path"), py::arg("trajectory"), py::arg("model"), py::arg("scene_path") = "",
               py::call_guard<py::gil_scoped_release>());
}

}  // namespace fettle::design::python
