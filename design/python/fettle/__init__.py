# SPDX-License-Identifier: MIT
"""Tunes mechanisms of rigid parts under certified clearance: the library of fettle, from Python.

SI units throughout (m, kg, s, rad, N). Scenes and designs are plain data (dataclasses); what is wrong with them raises fettle.Error, whose
`errors` have code, where and message. Long calls let other threads run, and end on Ctrl-C.

    scene = fettle.read_scene("hinge.scene.json")
    model = fettle.build_model(scene)
    simulation = fettle.simulate(model)
    for pair in fettle.certify_clearance(model, simulation.trajectory, minimum=0.3e-3):
        print(pair.status, pair.lower, pair.upper)

    problem = fettle.DesignProblem(fettle.read_design("hinge.design.json").design)
    value, gradient = problem.value_and_gradient(problem.values)
    outcome = fettle.optimise(problem, progress=print)
"""
from ._fettle import (
    Certificate,
    DesignProblem,
    Model,
    OpaqueQuantity,
    OpaqueShape,
    Simulated,
    ThreadLimit,
    Trajectory,
    __version__,
    build_model,
    certify_clearance,
    check_gradients,
    design_text,
    draw_picture,
    export_files,
    follow_scripts,
    from_si,
    generators,
    judge_mesh,
    optimise,
    optimise_file,
    parse_design,
    parse_scene,
    read_design,
    read_mesh,
    read_scene,
    read_trajectory,
    shape_at,
    shape_remarks,
    simulate,
    start_of_seed,
    to_si,
    write_report,
    write_trajectory,
)
from .design import (
    Bounds,
    Clearance,
    Constraint,
    ContactLoad,
    Design,
    DesignFile,
    Energy,
    FunctionShape,
    GeneratedPart,
    JointLoad,
    MarkerPath,
    MarkerSpeed,
    Mass,
    MeshShape,
    Move,
    ObjectiveTerm,
    OptimiserSettings,
    Origin,
    Parameter,
    ProgramShape,
    Quantity,
    QuantityGradient,
    Relation,
    Shape,
    Stroke,
    add_part,
)
from .errors import Error, EvaluationError, Fault
from .exploration import Exploration, explore, read_exploration
from .results import (
    CertificateFault,
    CertificateReport,
    CheckReport,
    CheckRow,
    ContactChange,
    ContactDifference,
    ContactFeature,
    ContactForce,
    ContactState,
    DesignEvaluation,
    DriveForce,
    JointForce,
    LineRow,
    MarginInterval,
    Measurement,
    NoiseLevel,
    Optimality,
    OptimiseOutcome,
    OptimiserReport,
    Overlap,
    PairClearance,
    PairRequest,
    QuantityRoughness,
    RoughnessReport,
    Rows,
    Simulation,
    SimulationReport,
    StageReport,
    StepOutputs,
    StepReport,
    SweepAgreement,
    Witness,
)
from .scene import (
    Attachment,
    Body,
    CoordinateForces,
    Curve,
    Damping,
    Friction,
    FrictionPair,
    Inertial,
    Joint,
    Mechanism,
    Mesh,
    MeshProgram,
    MotionCurve,
    Motor,
    PointLoad,
    Pose,
    PoseScript,
    Scene,
    ShapeSpec,
    Spring,
    held,
)

__all__ = [name for name in dir() if not name.startswith("_") and name not in ("design", "errors", "exploration", "results", "scene")]
