// SPDX-License-Identifier: MIT
// The module `fettle_for_tests`: what the tests of the Python package ask the library beside it, with the package's own conversions:
// records that pass through the library, its defaults of all of them, and a design evaluated without passing through Python.
#include "design/python/errors.hpp"
#include "design/python/studies_records.hpp"

namespace fettle::tests::python {

namespace py = pybind11;

namespace {

template <class T>
void add_default(py::dict& defaults) {
    defaults[design::python::Record<T>::python_name] = py::cast(T());
}

py::dict defaults() {
    py::dict all;
    add_default<fettle::core::certificate::CertificateFault>(all);
    add_default<fettle::core::certificate::CertificateReport>(all);
    add_default<fettle::core::certificate::JointCoordinate>(all);
    add_default<fettle::core::certificate::LinkageCoordinate>(all);
    add_default<fettle::core::clearance::MarginInterval>(all);
    add_default<fettle::core::clearance::Overlap>(all);
    add_default<fettle::core::clearance::PairClearance>(all);
    add_default<fettle::core::clearance::PairRequest>(all);
    add_default<fettle::core::clearance::Touch>(all);
    add_default<fettle::core::clearance::Witness>(all);
    add_default<fettle::core::energy::ContactForce>(all);
    add_default<fettle::core::geometry::Deviation>(all);
    add_default<fettle::core::kinematics::Pose>(all);
    add_default<fettle::core::model::JointSide>(all);
    add_default<fettle::core::scene::Attachment>(all);
    add_default<fettle::core::scene::Body>(all);
    add_default<fettle::core::scene::CoordinateForces>(all);
    add_default<fettle::core::scene::Curve>(all);
    add_default<fettle::core::scene::Damping>(all);
    add_default<fettle::core::scene::Friction>(all);
    add_default<fettle::core::scene::Friction::Pair>(all);
    add_default<fettle::core::scene::Inertial>(all);
    add_default<fettle::core::scene::Joint>(all);
    add_default<fettle::core::scene::Mechanism>(all);
    add_default<fettle::core::scene::MotionCurve>(all);
    add_default<fettle::core::scene::Motor>(all);
    add_default<fettle::core::scene::PointLoad>(all);
    add_default<fettle::core::scene::PoseScript>(all);
    add_default<fettle::core::scene::Scene>(all);
    add_default<fettle::design::shapes::MeshProgram>(all);
    add_default<fettle::core::scene::ShapeSpec>(all);
    add_default<fettle::core::scene::Spring>(all);
    add_default<fettle::core::stepper::DriveForce>(all);
    add_default<fettle::core::stepper::JointForce>(all);
    add_default<fettle::core::stepper::Simulation>(all);
    add_default<fettle::core::stepper::SimulationReport>(all);
    add_default<fettle::core::stepper::StepOutputs>(all);
    add_default<fettle::core::stepper::StepReport>(all);
    add_default<fettle::design::description::Bounds>(all);
    add_default<fettle::design::description::Constraint>(all);
    add_default<fettle::design::description::Design>(all);
    add_default<fettle::design::description::Measurement>(all);
    add_default<fettle::core::scene::BoundNumber>(all);
    add_default<fettle::core::scene::Assemble>(all);
    add_default<fettle::core::scene::Orientation>(all);
    add_default<fettle::core::scene::Variable>(all);
    add_default<fettle::design::description::ObjectiveTerm>(all);
    add_default<fettle::design::description::OptimiserSettings>(all);
    add_default<fettle::design::description::Parameter>(all);
    add_default<fettle::design::optimisers::NoiseLevel>(all);
    add_default<fettle::design::optimisers::Optimality>(all);
    add_default<fettle::design::optimisers::OptimiserReport>(all);
    add_default<fettle::design::optimisers::Rows>(all);
    add_default<fettle::design::problem::Run>(all);
    add_default<fettle::design::optimisers::StageReport>(all);
    add_default<fettle::design::problem::DesignEvaluation>(all);
    add_default<fettle::design::reading::DesignFile>(all);
    add_default<fettle::design::gradient_audit::CheckReport>(all);
    add_default<fettle::design::gradient_audit::CheckRow>(all);
    add_default<fettle::design::gradient_audit::ContactChange>(all);
    add_default<fettle::design::gradient_audit::ContactDifference>(all);
    add_default<fettle::design::gradient_audit::ContactFeature>(all);
    add_default<fettle::design::gradient_audit::ContactState>(all);
    add_default<fettle::design::gradient_audit::LineRow>(all);
    add_default<fettle::design::studies::OptimiseOutcome>(all);
    add_default<fettle::design::gradient_audit::QuantityRoughness>(all);
    add_default<fettle::design::gradient_audit::RoughnessReport>(all);
    add_default<fettle::design::gradient_audit::SweepAgreement>(all);
    all["Relation"] = py::cast(design::description::Relation());
    return all;
}

py::tuple evaluate_file(const std::string& path, int steps) {
    design::description::Design read = design::python::value_or_raise(design::reading::read_design(path)).design;
    read.steps = steps;
    const auto problem = design::python::value_or_raise(design::problem::DesignProblem::create(std::move(read)));
    const design::problem::DesignEvaluation at = problem.evaluate(design::description::values_of(problem.design().parameters));
    return py::make_tuple(at.reason, at.objective, at.gradient);
}

}  // namespace
}  // namespace fettle::tests::python

PYBIND11_MODULE(fettle_for_tests, module) {
    using namespace fettle::tests::python;
    using fettle::design::description::Design;
    py::module_::import("fettle");
    module.def("scene_round_trip", [](const fettle::core::scene::Scene& scene) { return scene; });
    module.def("design_round_trip", [](const Design& design) { return fettle::design::python::with_formulas(design); });
    module.def("defaults", &defaults);
    module.def("evaluate_file", &evaluate_file, py::arg("path"), py::arg("steps"));
}
