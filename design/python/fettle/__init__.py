# SPDX-License-Identifier: MIT
"""Tunes mechanisms of rigid parts under certified clearance: the library of fettle, from Python.

SI units throughout (m, kg, s, rad, N); a number that has a dimension may be given with a unit, "0.3mm". Paths are str or os.PathLike.
Scenes and designs are plain data (dataclasses); what is wrong with them raises fettle.Error, whose `errors` have code, where and message.
Long calls let other threads run, and end on Ctrl-C.

    scene = fettle.read_scene("hinge.scene.json")
    model = fettle.build_model(scene)
    simulation = fettle.simulate(model)
    report = fettle.clearance(model, simulation.trajectory, minimum="0.3mm")     # what `fettle clearance` asks and answers
    print(report)                                                   # names, verdicts, proven bounds [m]
    print(report.pair("pin", "plate")["lower"])

    problem = fettle.DesignProblem(fettle.read_design("hinge.design.json").design)
    value, gradient = problem.value_and_gradient(problem.values)
    outcome = fettle.optimise(problem, progress=print)

In a notebook fettle.view(model, simulation.trajectory) shows the parts and their motion. A pickle can run code when it is read: load none
but your own.
"""
import types as _types

try:
    from . import _fettle as _fettle
except ImportError as _fault:
    if "_fettle" not in str(_fault):
        raise
    raise ImportError(
        "fettle's compiled module is not here: in the project's folder build it by `cmake --build build/release --target fettle_python`, "
        "or install the package by `pip install .`"
    ) from _fault

# `X as X`: for type checkers the name is public.
from ._calls import in_plain_words as _in_plain_words
from ._fettle import (
    Certificate as Certificate,
    DesignProblem as DesignProblem,
    Formula as Formula,
    JointRanges as JointRanges,
    Model as Model,
    OpaqueQuantity as OpaqueQuantity,
    OpaqueShape as OpaqueShape,
    Simulated as Simulated,
    SharedSamples as SharedSamples,
    ThreadLimit as ThreadLimit,
    Trajectory as Trajectory,
    __version__ as __version__,
    acos as acos,
    as_assembled as as_assembled,
    asin as asin,
    atan as atan,
    atan2 as atan2,
    build_model as build_model,
    certify_clearance as certify_clearance,
    certify_ranges as certify_ranges,
    check_gradients as check_gradients,
    clearance as clearance,
    cos as cos,
    design_text as design_text,
    draw_picture as draw_picture,
    exp as exp,
    export_files as export_files,
    follow_scripts as follow_scripts,
    formula as formula,
    features as features,
    free_ranges as free_ranges,
    from_si as from_si,
    hypot as hypot,
    if_less as if_less,
    joint_ranges as joint_ranges,
    judge_mesh as judge_mesh,
    log as log,
    maximum as maximum,
    measured as measured,
    minimum as minimum,
    optimise as optimise,
    optimise_file as optimise_file,
    parse_design as parse_design,
    parse_quantity as parse_quantity,
    parse_scene as parse_scene,
    part_dimensions as part_dimensions,
    parts as parts,
    pose_at_witness as pose_at_witness,
    quantity_dimension as quantity_dimension,
    read_design as read_design,
    read_mesh as read_mesh,
    read_scene as read_scene,
    read_trajectory as read_trajectory,
    sample_of_seed as sample_of_seed,
    shape_at as shape_at,
    shape_mesh as shape_mesh,
    shape_remarks as shape_remarks,
    seeds_of_list as seeds_of_list,
    simulate as simulate,
    sin as sin,
    sqrt as sqrt,
    start_of_seed as start_of_seed,
    tan as tan,
    to_si as to_si,
    units as units,
    view_page as view_page,
    write_report as write_report,
    write_trajectory as write_trajectory,
)
from .design import (
    BodyTurn as BodyTurn,
    Bounds as Bounds,
    Clearance as Clearance,
    Constraint as Constraint,
    ContactLoad as ContactLoad,
    Design as Design,
    DesignFile as DesignFile,
    Energy as Energy,
    EventTime as EventTime,
    Expression as Expression,
    FreeRange as FreeRange,
    FunctionQuantity as FunctionQuantity,
    FunctionShape as FunctionShape,
    Gap as Gap,
    InScenario as InScenario,
    JointLoad as JointLoad,
    JointPosition as JointPosition,
    Law as Law,
    MarkerPath as MarkerPath,
    MarkerPosition as MarkerPosition,
    MarkerSpeed as MarkerSpeed,
    Mass as Mass,
    Measured as Measured,
    MeshShape as MeshShape,
    ObjectiveTerm as ObjectiveTerm,
    OptimiserSettings as OptimiserSettings,
    Parameter as Parameter,
    Part as Part,
    ProgramShape as ProgramShape,
    Quantity as Quantity,
    QuantityGradient as QuantityGradient,
    Relation as Relation,
    Scenario as Scenario,
    Series as Series,
    Shape as Shape,
    StepExpression as StepExpression,
    Stroke as Stroke,
    TimeShare as TimeShare,
    ValueAt as ValueAt,
    Worst as Worst,
    add_part as add_part,
)
from .errors import Error as Error, EvaluationError as EvaluationError, Fault as Fault
from .exploration import Exploration as Exploration, explore as explore, read_exploration as read_exploration
from .notebook import View as View, view as view
from .results import (
    CertificateFault as CertificateFault,
    CertificateReport as CertificateReport,
    CheckReport as CheckReport,
    CheckRow as CheckRow,
    ClearanceReport as ClearanceReport,
    ContactChange as ContactChange,
    ContactDifference as ContactDifference,
    ContactFeature as ContactFeature,
    ContactForce as ContactForce,
    ContactState as ContactState,
    DesignEvaluation as DesignEvaluation,
    DriveForce as DriveForce,
    JointCoordinate as JointCoordinate,
    JointForce as JointForce,
    LineRow as LineRow,
    MarginInterval as MarginInterval,
    Measurement as Measurement,
    NoiseLevel as NoiseLevel,
    Optimality as Optimality,
    OptimiseOutcome as OptimiseOutcome,
    OptimiserReport as OptimiserReport,
    Overlap as Overlap,
    PairClearance as PairClearance,
    PairRequest as PairRequest,
    Pairs as Pairs,
    QuantityRoughness as QuantityRoughness,
    RangeCoordinate as RangeCoordinate,
    RoughnessReport as RoughnessReport,
    Rows as Rows,
    Run as Run,
    Simulation as Simulation,
    SimulationReport as SimulationReport,
    StageReport as StageReport,
    StepOutputs as StepOutputs,
    StepReport as StepReport,
    ToleranceReport as ToleranceReport,
    Touch as Touch,
    SweepAgreement as SweepAgreement,
    Witness as Witness,
)
from .scene import (
    Assemble as Assemble,
    Attachment as Attachment,
    Body as Body,
    BoundNumber as BoundNumber,
    CoordinateForces as CoordinateForces,
    Curve as Curve,
    Damping as Damping,
    Deviation as Deviation,
    Friction as Friction,
    FrictionPair as FrictionPair,
    Inertial as Inertial,
    Joint as Joint,
    JointSide as JointSide,
    Mechanism as Mechanism,
    Mesh as Mesh,
    MeshProgram as MeshProgram,
    MotionCurve as MotionCurve,
    Motor as Motor,
    Orientation as Orientation,
    PointLoad as PointLoad,
    Pose as Pose,
    PoseScript as PoseScript,
    Scene as Scene,
    ShapeSpec as ShapeSpec,
    Spring as Spring,
    Variable as Variable,
    held as held,
)
from .session import (
    JudgedDesign as JudgedDesign,
    News as News,
    Pulled as Pulled,
    Session as Session,
    SessionResult as SessionResult,
    Tuning as Tuning,
    open as open,
)
from .tolerances import tolerance as tolerance

for _name, _function in list(globals().items()):
    if isinstance(_function, _types.BuiltinFunctionType):
        globals()[_name] = _in_plain_words(_function)

_MODULES = ("design", "errors", "exploration", "notebook", "results", "scene", "session", "tolerances")
__all__ = [name for name in dir() if not name.startswith("_") and name not in _MODULES]
