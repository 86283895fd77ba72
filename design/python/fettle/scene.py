# SPDX-License-Identifier: MIT
"""A scene as plain data (the library's core/scene/): SI units throughout, vectors of three numbers, rotations as matrices (3, 3). A number that
has a dimension may be given as a text with a unit; it is in SI once it is there. In the scene of a design a number that a parameter can move
(BoundNumber) may be a parameter, or a formula of parameters: `body.position = [crank + rod * fettle.cos(phi), 0, 0]`.

    table = fettle.Body("table", type="static", mesh=..., prescribed=fettle.held())
    scene = fettle.Scene(bodies=[table, fettle.Body("cube", mesh=...)], gravity=[0, 0, -9.81], timestep="5ms")
"""
import dataclasses
import os
from typing import Any, Dict, List, Literal, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _fettle
from ._record import Number, Record, faults_of, number, short
from .errors import Error, Fault

Vector = Union[Sequence[Any], NDArray[np.float64]]
PathLike = Union[str, "os.PathLike[str]"]


def _zero() -> NDArray[np.float64]:
    return np.zeros(3)


def _indices(columns: int) -> Any:
    return lambda: np.zeros((0, columns), np.int32)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Deviation(Record):
    """How far a round part reaches out of its mesh, and stays inside of it, at most."""

    outside: Number = number("length", 0.0)  #: [m]
    inside: Number = number("length", 0.0)  #: [m]
    outside_is_proven: bool = True
    inside_is_proven: bool = True
    declared: Number = number("length", 0.0)  #: [m] of both: what rests on tolerances that a STEP file declares


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Mesh(Record):
    """Triangles, counter-clockwise seen from outside; perhaps loose edges. Equal vertices are one (`read_mesh` welds them)."""

    name: str = ""
    vertices: NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.zeros((0, 3)))  #: (n, 3) [m]
    triangles: NDArray[np.int32] = dataclasses.field(default_factory=_indices(3))  #: (m, 3)
    loose_edges: NDArray[np.int32] = dataclasses.field(default_factory=_indices(2))  #: (k, 2), of no triangle
    shell_names: List[str] = dataclasses.field(default_factory=list)  #: one per shell; empty: "name/0", ...
    face_names: List[str] = dataclasses.field(default_factory=list)  #: of a part that was drawn: "bore", "rim end"
    triangle_face: List[int] = dataclasses.field(default_factory=list)  #: per triangle, into face_names; empty: faces have no names
    deviation: Optional[Deviation] = None  #: of a part that was drawn, or a STEP file; None: the mesh stands for nothing but itself
    colour: Optional[Tuple[int, int, int]] = None  #: sRGB, 0 to 255, of a STEP file


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Pose(Record):
    """world = rotation @ x + position."""

    rotation: ArrayLike = dataclasses.field(default_factory=lambda: np.eye(3))
    position: Vector = number("length", factory=_zero)  #: [m]


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class MotionCurve(Record):
    """A coordinate over time, from its start: rate t + the table through (times, values); constant after stop_time."""

    rate: Number = number("any", 0.0)  #: [m/s] or [rad/s]
    times: List[Number] = number("time", factory=list)
    values: List[Number] = number("any", factory=list)
    stop_time: Optional[Number] = number("time", None)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class PoseScript(Record):
    """A kinematic body's poses at times > 0."""

    times: List[Number] = number("time", factory=list)
    poses: List[Pose] = dataclasses.field(default_factory=list)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class FrictionPair(Record):
    material_a: str = ""
    material_b: str = ""
    mu: float = 0.0


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Friction(Record):
    """Coulomb friction; rounds < 0: solves until normal forces and tangents agree."""

    mu: float = 0.0
    materials: Dict[str, float] = dataclasses.field(default_factory=dict)
    pairs: List[FrictionPair] = dataclasses.field(default_factory=list)
    eps_v: Number = number("speed", 1e-3)  #: static speed bound [m/s]
    rounds: int = 2


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Damping(Record):
    """In proportion to mass and inertia."""

    linear: float = 0.0  #: [1/s]
    angular: float = 0.0  #: [1/s]


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class MeshProgram(Record):
    """A command that writes a mesh: {out} and {dimension} in its words stand for the file and the numbers, in `unit`."""

    command: List[PathLike] = dataclasses.field(default_factory=list)
    directory: PathLike = ""  #: that it runs in
    format: Literal["stl", "obj", "off", "ply", "3mf"] = "stl"
    unit: Number = number("length", 1.0, of_unit=True)  #: [m]
    time_limit: Number = number("time", 300.0)  #: [s]


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class ShapeSpec(Record):
    """What makes a body's mesh: a part file, or a program."""

    part: str = ""  #: of the library, a file, or the text of one; empty: a program makes the part
    dimensions: Dict[str, Number] = number("length", factory=dict)  #: [m], but for those that are listed below, in SI
    counts: Dict[str, int] = dataclasses.field(default_factory=dict)
    program: Optional[MeshProgram] = None
    chord: Number = number("length", 0.0)  #: of a part: largest distance of a facet from what it stands for [m]; 0: by counts
    angles: List[str] = dataclasses.field(default_factory=list)  #: dimensions of a part that are angles [rad]
    numbers: List[str] = dataclasses.field(default_factory=list)  #: and those that are plain numbers


def held() -> List[Optional[MotionCurve]]:
    """All six coordinates held where they are: what static bodies have; kinematic ones put curves or rates in."""
    return [MotionCurve() for _ in range(6)]


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Inertial(Record):
    """Mass and inertia that are given, not counted from the mesh."""

    mass: Number = number("mass", 0.0)  #: [kg]
    centre: Vector = number("length", factory=_zero)  #: of mass, in the mesh file's frame [m]
    inertia: ArrayLike = dataclasses.field(default_factory=lambda: np.zeros((3, 3)))  #: about the centre, axes of that frame [kg m^2]


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Orientation(Record):
    """A rotation as a file writes it, which a body's pose has its rotation from: three angles, R = Rz(c) Ry(b) Rx(a), or a rotation
    vector."""

    kind: Literal["angles", "vector"] = "angles"
    numbers: Vector = number("angle", factory=_zero)  #: [rad]


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Variable(Record):
    """A named number of a scene's file. What follows from others has a formula of them; a design can move the rest."""

    name: str = ""
    formula: "_fettle.Formula" = dataclasses.field(default_factory=lambda: _fettle.formula(0.0))
    value: float = 0.0  #: SI


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class BoundNumber(Record):
    """A number of a scene that follows from variables or parameters. Places are JSON pointers, with bodies, joints, springs, dampers, motors
    and loads by number or name: "/bodies/pin/shape/dimensions/radius", "/bodies/pin/position/2", "/joints/0/point_a/0",
    "/motors/drive/speed"; the library's core/scene/place.hpp lists them."""

    place: str = ""
    formula: "_fettle.Formula" = dataclasses.field(default_factory=lambda: _fettle.formula(0.0))


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Body(Record):
    """A rigid part. `prescribed`: px py pz rx ry rz in world axes, None: free."""

    name: str = ""
    where: str = ""
    type: Literal["dynamic", "static", "kinematic"] = "dynamic"
    mesh: Mesh = dataclasses.field(default_factory=Mesh)  #: in the file's frame [m]
    shape: Optional[ShapeSpec] = None
    mesh_policy: Literal["strict", "tolerant", "lenient"] = "strict"
    density: Number = number("density", 1000.0)  #: [kg/m^3], [kg/m^2], [kg/m] or [kg], by mass_kind
    density_given: bool = True
    mass_kind: Literal["volume", "area", "length", "vertex"] = "volume"
    mass_kind_given: bool = True  #: False: the file does not say so, the mesh suggests it
    inertial: Optional[Inertial] = None  #: in place of density times what the mesh has
    material: str = ""
    mu: Optional[float] = None
    pose: Pose = dataclasses.field(default_factory=Pose)
    orientation: Orientation = dataclasses.field(default_factory=Orientation)
    linear_velocity: Vector = number("speed", factory=_zero)  #: [m/s]
    angular_velocity: Vector = number("angular_speed", factory=_zero)  #: [rad/s]
    prescribed: List[Optional[MotionCurve]] = dataclasses.field(default_factory=lambda: [None] * 6)
    script: PoseScript = dataclasses.field(default_factory=PoseScript)
    force: Vector = number("force", factory=_zero)  #: [N]
    torque: Vector = number("torque", factory=_zero)  #: [N m]
    damping: Damping = dataclasses.field(default_factory=Damping)
    reference_point: Optional[Vector] = number("length", None)  #: in the file's frame [m]
    group: int = -1  #: bodies of one group (>= 0) never collide

    @property
    def position(self) -> Vector:
        """The pose's [m]."""
        return self.pose.position

    @position.setter
    def position(self, value: Vector) -> None:
        self.pose.position = value


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Curve(Record):
    """What drives a motor: rate t + the table; see the library's core/scene/curve.hpp for the kinds."""

    kind: Literal["linear", "cubic", "trapezoid", "control_points"] = "linear"
    rate: Number = number("any", 0.0)
    times: List[Number] = number("time", factory=list)
    values: List[Number] = number("any", factory=list)
    stop_time: Optional[Number] = number("time", None)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Attachment(Record):
    """A point and a direction in a body's file frame; body "": of the world."""

    body: str = ""
    point: Vector = number("length", factory=_zero)  #: [m]
    axis: Vector = dataclasses.field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class CoordinateForces(Record):
    """Spring, damper, Coulomb friction and stops along one coordinate."""

    stiffness: Number = number("any", 0.0)
    rest: Optional[Number] = number("any", None)
    preload: Number = number("any", 0.0)
    damping: float = 0.0
    friction: Number = number("any", 0.0)
    limits: Optional[Sequence[Number]] = number("any", None)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Assemble(Record):
    """On which side of a joint a closed linkage is assembled."""

    side: Literal["left", "right", "ahead", "behind"] = "left"
    from_: str = ""  #: a joint at the other end of one of its bodies; "": the only one of `a`
    to: str = ""  #: of the other body; "": the only one of `b`


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class JointSide(Record):
    """A joint's side of a closed linkage."""

    joint: str = ""
    assemble: Assemble = dataclasses.field(default_factory=Assemble)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Joint(Record):
    name: str = ""
    where: str = ""
    kind: Literal["ball", "revolute", "prismatic", "cylindrical", "planar", "fixed", "screw", "gear", "rack"] = "revolute"
    a: Attachment = dataclasses.field(default_factory=Attachment)
    b: Attachment = dataclasses.field(default_factory=Attachment)
    pitch: Number = number("length", 0.0)  #: screw: slide per turn [m]
    swing: Optional[Number] = number("angle", None)  #: ball: how far apart the two axes may be [rad]
    of: Sequence[str] = ("", "")  #: gear, rack: two joints
    ratio: Number = number("any", 1.0)  #: of a gear; of a rack its radius [m]
    forces: CoordinateForces = dataclasses.field(default_factory=CoordinateForces)
    collide: bool = False
    assemble: Optional[Assemble] = None


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Spring(Record):
    """From point to point, or about or along a joint's coordinate."""

    name: str = ""
    where: str = ""
    joint: str = ""
    a: Attachment = dataclasses.field(default_factory=Attachment)
    b: Attachment = dataclasses.field(default_factory=Attachment)
    forces: CoordinateForces = dataclasses.field(default_factory=CoordinateForces)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Motor(Record):
    """Drives a joint's coordinate ("motion"), or pushes along it ("effort")."""

    name: str = ""
    where: str = ""
    joint: str = ""
    kind: Literal["motion", "effort"] = "motion"
    curve: Curve = dataclasses.field(default_factory=Curve)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class PointLoad(Record):
    name: str = ""
    where: str = ""
    body: str = ""
    point: Vector = number("length", factory=_zero)  #: in the body's file frame [m]
    force: Vector = number("force", factory=_zero)  #: world [N]


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Mechanism(Record):
    joints: List[Joint] = dataclasses.field(default_factory=list)
    springs: List[Spring] = dataclasses.field(default_factory=list)
    motors: List[Motor] = dataclasses.field(default_factory=list)
    loads: List[PointLoad] = dataclasses.field(default_factory=list)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Scene(Record):
    path: PathLike = ""
    length_unit: Number = number("length", 1.0, of_unit=True)  #: of the file [m], for reports
    bodies: List[Body] = dataclasses.field(default_factory=list)
    gravity: Vector = number("acceleration", factory=_zero)  #: [m/s^2]
    timestep: Number = number("time", 0.01)  #: [s]
    end_time: Optional[Number] = number("time", None)  #: [s]
    dhat: Optional[Number] = number("length", None)  #: activation distance of contact [m]
    dmin: Number = number("length", 0.0)  #: minimum separation [m]
    kappa: Optional[Number] = number("stiffness", None)  #: barrier stiffness [N/m]
    area_weighted: bool = False
    round_contact: Optional[bool] = None  #: None: round surfaces wherever they can be, like True
    contact_damping_time: Number = number("time", 0.0)  #: [s]
    friction: Friction = dataclasses.field(default_factory=Friction)
    mechanism: Mechanism = dataclasses.field(default_factory=Mechanism)
    integrator: Literal["implicit_euler", "bdf2", "newmark", "quasi_static"] = "implicit_euler"
    velocity_tolerance: Optional[Number] = number("speed", None)  #: [m/s]
    max_newton_iterations: int = 3000
    variables: List[Variable] = dataclasses.field(default_factory=list)
    numbers: List[BoundNumber] = dataclasses.field(default_factory=list)  #: that follow from variables
    ignore: List[str] = dataclasses.field(default_factory=list)  #: "a:b", pairs that pass through each other; * for any letters
    warnings: List[str] = dataclasses.field(default_factory=list)

    def body(self, name: str) -> int:
        """Index of the body of that name."""
        names = [body.name for body in self.bodies]
        if name not in names:
            raise KeyError(f"there is no body {name!r}; there are {', '.join(names)}")
        return names.index(name)

    def _prepared(self) -> "Scene":
        """Raises Error where something is not of its class, a body has no name, or a number was given in a unit of another dimension than
        its joint, motor or coordinate has."""
        faults = _faults_of_classes(self)
        faults = faults or _faults_of_names(self) + _faults_of_units(self)
        if faults:
            raise Error(faults)
        return self


_OF_COORDINATE = {
    "length": {"rate": "speed", "stiffness": "stiffness", "preload": "force", "friction": "force"},
    "angle": {"rate": "angular_speed", "stiffness": "angular_stiffness", "preload": "torque", "friction": "torque"},
}
_COORDINATES = {"revolute": "angle", "screw": "angle", "prismatic": "length", "cylindrical": "length"}
_EFFORTS = {"length": "force", "angle": "torque"}


def _unless(found: Any, wanted: type, where: str) -> List[Fault]:
    if isinstance(found, wanted):
        return []
    return [Fault("wrong_type", where, f"{short(found)}, of type {type(found).__name__}: a fettle.{wanted.__name__} is expected")]


def _unless_all(found: Any, wanted: type, where: str) -> List[Fault]:
    if not isinstance(found, (list, tuple)):
        return [Fault("wrong_type", where, f"{short(found)}, of type {type(found).__name__}: a list of fettle.{wanted.__name__} is expected")]
    return [fault for k, each in enumerate(found) for fault in _unless(each, wanted, f"{where}/{k}")]


def _faults_of_classes(scene: Scene) -> List[Fault]:
    faults = _unless_all(scene.bodies, Body, "scene/bodies") + _unless(scene.mechanism, Mechanism, "scene/mechanism")
    if faults:
        return faults
    mechanism = scene.mechanism
    for member, kind in (("joints", Joint), ("springs", Spring), ("motors", Motor), ("loads", PointLoad)):
        faults += _unless_all(getattr(mechanism, member), kind, f"mechanism/{member}")
    if faults:
        return faults
    for body in scene.bodies:
        curves: Any = body.prescribed
        for k, curve in enumerate(curves if isinstance(curves, (list, tuple)) else [curves]):
            faults += _unless(curve, MotionCurve, f"body `{body.name}`/prescribed/{k}") if curve is not None else []
    for joint in mechanism.joints:
        faults += _unless(joint.forces, CoordinateForces, f"joint `{joint.name}`/forces")
    for spring in mechanism.springs:
        faults += _unless(spring.forces, CoordinateForces, f"spring `{spring.name}`/forces")
    for motor in mechanism.motors:
        faults += _unless(motor.curve, Curve, f"motor `{motor.name}`/curve")
    return faults


def _faults_of_names(scene: Scene) -> List[Fault]:
    return [
        Fault("out_of_range", f"scene/bodies/{k}/name", "a body needs a name: pairs, joints and files find it by that")
        for k, body in enumerate(scene.bodies)
        if body.name == ""
    ]


def _faults_of_units(scene: Scene) -> List[Fault]:
    faults: List[Fault] = []

    def check(record: Any, coordinate: str, where: str, members: Sequence[str]) -> None:
        for member in members:
            dimension = _OF_COORDINATE[coordinate].get(member, coordinate)
            faults.extend(faults_of(getattr(record, member), dimension, f"{where}/{member}"))

    laws = ("stiffness", "rest", "preload", "friction", "limits")
    for body in scene.bodies:
        for k, curve in enumerate(body.prescribed):
            if curve is not None:
                check(curve, "length" if k < 3 else "angle", f"body `{body.name}`/prescribed/{k}", ("rate", "values"))
    coordinates = {joint.name: _COORDINATES.get(joint.kind, "length") for joint in scene.mechanism.joints}
    for joint in scene.mechanism.joints:
        check(joint.forces, coordinates[joint.name], f"joint `{joint.name}`/forces", laws)
        faults += faults_of(joint.ratio, "length" if joint.kind == "rack" else "number", f"joint `{joint.name}`/ratio")
    for spring in scene.mechanism.springs:
        check(spring.forces, coordinates.get(spring.joint, "length"), f"spring `{spring.name}`/forces", laws)
    for motor in scene.mechanism.motors:
        coordinate, where = coordinates.get(motor.joint, "length"), f"motor `{motor.name}`/curve"
        if motor.kind == "motion":
            check(motor.curve, coordinate, where, ("rate", "values"))
        else:
            faults += faults_of(motor.curve.values, _EFFORTS[coordinate], f"{where}/values")
            faults += faults_of(motor.curve.rate, "", f"{where}/rate")
    return faults
