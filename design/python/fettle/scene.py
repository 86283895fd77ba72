# SPDX-License-Identifier: MIT
"""A scene as plain data (the library's core/scene/): SI units throughout, vectors of three numbers, rotations as matrices (3, 3).

    table = fettle.Body("table", type="static", mesh=..., prescribed=fettle.held())
    scene = fettle.Scene(bodies=[table, fettle.Body("cube", mesh=...)], gravity=[0, 0, -9.81])
"""
import dataclasses
from typing import Any, Dict, List, Literal, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._record import Record

Vector = Union[Sequence[float], NDArray[np.float64]]


def _zero() -> NDArray[np.float64]:
    return np.zeros(3)


def _indices(columns: int) -> Any:
    return lambda: np.zeros((0, columns), np.int32)


@dataclasses.dataclass(eq=False, slots=True)
class Mesh(Record):
    """Triangles, counter-clockwise seen from outside; perhaps loose edges. Equal vertices are one (`read_mesh` welds them)."""

    name: str = ""
    vertices: NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.zeros((0, 3)))  #: (n, 3) [m]
    triangles: NDArray[np.int32] = dataclasses.field(default_factory=_indices(3))  #: (m, 3)
    loose_edges: NDArray[np.int32] = dataclasses.field(default_factory=_indices(2))  #: (k, 2), of no triangle
    shell_names: List[str] = dataclasses.field(default_factory=list)  #: one per shell; empty: "name/0", ...


@dataclasses.dataclass(eq=False, slots=True)
class Pose(Record):
    """world = rotation @ x + position."""

    rotation: ArrayLike = dataclasses.field(default_factory=lambda: np.eye(3))
    position: Vector = dataclasses.field(default_factory=_zero)  #: [m]


@dataclasses.dataclass(eq=False, slots=True)
class MotionCurve(Record):
    """A coordinate over time, from its start: rate t + the table through (times, values); constant after stop_time."""

    rate: float = 0.0  #: [m/s] or [rad/s]
    times: List[float] = dataclasses.field(default_factory=list)
    values: List[float] = dataclasses.field(default_factory=list)
    stop_time: Optional[float] = None


@dataclasses.dataclass(eq=False, slots=True)
class PoseScript(Record):
    """A kinematic body's poses at times > 0."""

    times: List[float] = dataclasses.field(default_factory=list)
    poses: List[Pose] = dataclasses.field(default_factory=list)


@dataclasses.dataclass(eq=False, slots=True)
class FrictionPair(Record):
    material_a: str = ""
    material_b: str = ""
    mu: float = 0.0


@dataclasses.dataclass(eq=False, slots=True)
class Friction(Record):
    """Coulomb friction; rounds < 0: solves until normal forces and tangents agree."""

    mu: float = 0.0
    materials: Dict[str, float] = dataclasses.field(default_factory=dict)
    pairs: List[FrictionPair] = dataclasses.field(default_factory=list)
    eps_v: float = 1e-3  #: static speed bound [m/s]
    rounds: int = 1


@dataclasses.dataclass(eq=False, slots=True)
class Damping(Record):
    """In proportion to mass and inertia."""

    linear: float = 0.0  #: [1/s]
    angular: float = 0.0  #: [1/s]


@dataclasses.dataclass(eq=False, slots=True)
class MeshProgram(Record):
    """A command that writes a mesh: {out} and {dimension} in its words stand for the file and the numbers, in `unit`."""

    command: List[str] = dataclasses.field(default_factory=list)
    directory: str = ""  #: that it runs in
    format: Literal["stl", "obj", "off", "ply", "3mf"] = "stl"
    unit: float = 1.0  #: [m]
    time_limit: float = 300.0  #: [s]


@dataclasses.dataclass(eq=False, slots=True)
class ShapeSpec(Record):
    """What makes a body's mesh: a generator, or a program."""

    generator: str = ""  #: its name; empty: a program makes the part
    dimensions: Dict[str, float] = dataclasses.field(default_factory=dict)  #: [m]
    counts: Dict[str, int] = dataclasses.field(default_factory=dict)
    program: Optional[MeshProgram] = None


def held() -> List[Optional[MotionCurve]]:
    """All six coordinates held where they are: what static bodies have; kinematic ones put curves or rates in."""
    return [MotionCurve() for _ in range(6)]


@dataclasses.dataclass(eq=False, slots=True)
class Inertial(Record):
    """Mass and inertia that are given, not counted from the mesh."""

    mass: float = 0.0  #: [kg]
    centre: Vector = dataclasses.field(default_factory=_zero)  #: of mass, in the mesh file's frame [m]
    inertia: ArrayLike = dataclasses.field(default_factory=lambda: np.zeros((3, 3)))  #: about the centre, axes of that frame [kg m^2]


@dataclasses.dataclass(eq=False, slots=True)
class Body(Record):
    """A rigid part. `prescribed`: px py pz rx ry rz in world axes, None: free."""

    name: str = ""
    where: str = ""
    type: Literal["dynamic", "static", "kinematic"] = "dynamic"
    mesh: Mesh = dataclasses.field(default_factory=Mesh)  #: in the file's frame [m]
    shape: Optional[ShapeSpec] = None
    mesh_policy: Literal["strict", "tolerant", "lenient"] = "strict"
    density: float = 1000.0  #: [kg/m^3], [kg/m^2], [kg/m] or [kg], by mass_kind
    density_given: bool = True
    mass_kind: Literal["volume", "area", "length", "vertex"] = "volume"
    inertial: Optional[Inertial] = None  #: in place of density times what the mesh has
    material: str = ""
    mu: Optional[float] = None
    pose: Pose = dataclasses.field(default_factory=Pose)
    linear_velocity: Vector = dataclasses.field(default_factory=_zero)  #: [m/s]
    angular_velocity: Vector = dataclasses.field(default_factory=_zero)  #: [rad/s]
    prescribed: List[Optional[MotionCurve]] = dataclasses.field(default_factory=lambda: [None] * 6)
    script: PoseScript = dataclasses.field(default_factory=PoseScript)
    force: Vector = dataclasses.field(default_factory=_zero)  #: [N]
    torque: Vector = dataclasses.field(default_factory=_zero)  #: [N m]
    damping: Damping = dataclasses.field(default_factory=Damping)
    reference_point: Optional[Vector] = None  #: in the file's frame [m]
    group: int = -1  #: bodies of one group (>= 0) never collide


@dataclasses.dataclass(eq=False, slots=True)
class Curve(Record):
    """What drives a motor: rate t + the table; see the library's core/scene/curve.hpp for the kinds."""

    kind: Literal["linear", "cubic", "trapezoid", "control_points"] = "linear"
    rate: float = 0.0
    times: List[float] = dataclasses.field(default_factory=list)
    values: List[float] = dataclasses.field(default_factory=list)
    stop_time: Optional[float] = None


@dataclasses.dataclass(eq=False, slots=True)
class Attachment(Record):
    """A point and a direction in a body's file frame; body "": of the world."""

    body: str = ""
    point: Vector = dataclasses.field(default_factory=_zero)  #: [m]
    axis: Vector = dataclasses.field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))


@dataclasses.dataclass(eq=False, slots=True)
class CoordinateForces(Record):
    """Spring, damper, Coulomb friction and stops along one coordinate."""

    stiffness: float = 0.0
    rest: Optional[float] = None
    preload: float = 0.0
    damping: float = 0.0
    friction: float = 0.0
    limits: Optional[Sequence[float]] = None


@dataclasses.dataclass(eq=False, slots=True)
class Joint(Record):
    name: str = ""
    where: str = ""
    kind: Literal["ball", "revolute", "prismatic", "cylindrical", "planar", "fixed", "screw", "gear", "rack"] = "revolute"
    a: Attachment = dataclasses.field(default_factory=Attachment)
    b: Attachment = dataclasses.field(default_factory=Attachment)
    pitch: float = 0.0  #: screw: slide per turn [m]
    of: Sequence[str] = ("", "")  #: gear, rack: two joints
    ratio: float = 1.0
    forces: CoordinateForces = dataclasses.field(default_factory=CoordinateForces)
    collide: bool = False


@dataclasses.dataclass(eq=False, slots=True)
class Spring(Record):
    """From point to point, or about or along a joint's coordinate."""

    name: str = ""
    where: str = ""
    joint: str = ""
    a: Attachment = dataclasses.field(default_factory=Attachment)
    b: Attachment = dataclasses.field(default_factory=Attachment)
    forces: CoordinateForces = dataclasses.field(default_factory=CoordinateForces)


@dataclasses.dataclass(eq=False, slots=True)
class Motor(Record):
    """Drives a joint's coordinate ("motion"), or pushes along it ("effort")."""

    name: str = ""
    where: str = ""
    joint: str = ""
    kind: Literal["motion", "effort"] = "motion"
    curve: Curve = dataclasses.field(default_factory=Curve)


@dataclasses.dataclass(eq=False, slots=True)
class PointLoad(Record):
    name: str = ""
    where: str = ""
    body: str = ""
    point: Vector = dataclasses.field(default_factory=_zero)  #: in the body's file frame [m]
    force: Vector = dataclasses.field(default_factory=_zero)  #: world [N]


@dataclasses.dataclass(eq=False, slots=True)
class Mechanism(Record):
    joints: List[Joint] = dataclasses.field(default_factory=list)
    springs: List[Spring] = dataclasses.field(default_factory=list)
    motors: List[Motor] = dataclasses.field(default_factory=list)
    loads: List[PointLoad] = dataclasses.field(default_factory=list)


@dataclasses.dataclass(eq=False, slots=True)
class Scene(Record):
    path: str = ""
    length_unit: float = 1.0  #: of the file [m], for reports
    bodies: List[Body] = dataclasses.field(default_factory=list)
    gravity: Vector = dataclasses.field(default_factory=_zero)  #: [m/s^2]
    timestep: float = 0.01  #: [s]
    end_time: Optional[float] = None  #: [s]
    dhat: Optional[float] = None  #: activation distance of contact [m]
    dmin: float = 0.0  #: minimum separation [m]
    kappa: Optional[float] = None  #: barrier stiffness [N/m]
    area_weighted: bool = False
    contact_damping_time: float = 0.0  #: [s]
    friction: Friction = dataclasses.field(default_factory=Friction)
    mechanism: Mechanism = dataclasses.field(default_factory=Mechanism)
    integrator: Literal["implicit_euler", "bdf2", "newmark", "quasi_static"] = "implicit_euler"
    velocity_tolerance: Optional[float] = None  #: [m/s]
    max_newton_iterations: int = 3000
    warnings: List[str] = dataclasses.field(default_factory=list)

    def body(self, name: str) -> int:
        """Index of the body of that name."""
        names = [body.name for body in self.bodies]
        if name not in names:
            raise KeyError(f"there is no body {name!r}; there are {', '.join(names)}")
        return names.index(name)
