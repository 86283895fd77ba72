# SPDX-License-Identifier: MIT
"""A design as plain data (the library's design/description/): SI units, or numbers with units as in a scene; bodies by number or by name.
Shapes and quantities of one's own derive from Shape and Quantity.

    design = fettle.Design(scene=fettle.Scene(timestep=0.01), steps=50)
    fettle.add_part(design, fettle.Body("pin"), fettle.Part("cylinder", {"radius": 5e-3}))
    radius = fettle.Parameter("radius", "5mm", "4mm", "6mm", "mm")
    design.parameters.append(radius)
    design.set("/bodies/pin/shape/dimensions/radius", radius)
    design.scene.bodies[0].position = [0, 0, 2 * radius + "0.5 mm"]
    design.objective.append(fettle.ObjectiveTerm("force per mass", quantity=force / mass))  # of quantities
"""
import dataclasses
import math
import operator
import zlib
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _fettle
from ._moved import settled_scene
from ._record import Given, Number, Record, did_you_mean, faults_of, number
from .errors import Error, Fault
from .results import Measurement
from .scene import Body, BoundNumber, Mesh, MeshProgram, PathLike, Scene, Vector

Array = NDArray[np.float64]
Which = Union[int, str]  # a body, by its number or its name
Operand = Union["_fettle.Formula", "Parameter", float, str]  # a text: a number with a unit


class Shape:
    """A part whose vertices are a function of named dimensions [m]. Derive from it; called from several threads, one after the other."""

    __slots__ = ()

    #: Are the triangles of `at` always a solid's? Where this is not said, the mesh of every trial is checked.
    always_solid: bool = False

    def dimensions(self) -> Dict[str, float]:
        """Names and values of the part as drawn [m]."""
        raise NotImplementedError

    def at(self, values: Dict[str, float]) -> Tuple[Mesh, Mapping[str, ArrayLike]]:
        """The part at these dimensions, and d vertices / d dimension (n, 3) by name. The triangles are the same for all values.
        Raise fettle.Error or ValueError for dimensions that make no part."""
        raise NotImplementedError


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Part(Record, Shape):
    """A part of the library (fettle.parts() lists them), or of a file of one's own, "spacer.part.json"; dimensions that are left out are as in
    its file."""

    part: str
    values: Dict[str, Number] = number("length", factory=dict)  #: dimensions [m], angles [rad]
    counts: Dict[str, int] = dataclasses.field(default_factory=dict)  #: teeth, slots, ...; segments of a full circle
    chord: Number = number("length", 0.0)  #: how far facets may be from what is round [m]; 0: by the segments

    def dimensions(self) -> Dict[str, float]:
        return _fettle.part_dimensions(self)

    def at(self, values: Dict[str, float]) -> Tuple[Mesh, Mapping[str, ArrayLike]]:
        return _fettle.shape_at(self, values)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class FunctionShape(Record, Shape):
    """A part from a function: function(dimensions) -> (Mesh, {dimension: d vertices / d dimension (n, 3)})."""

    function: Callable[[Dict[str, float]], Tuple[Mesh, Mapping[str, ArrayLike]]]
    values: Dict[str, Number] = number("length")  #: [m]
    always_solid: bool = False

    def dimensions(self) -> Dict[str, float]:
        return self.values

    def at(self, values: Dict[str, float]) -> Tuple[Mesh, Mapping[str, ArrayLike]]:
        return self.function(values)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class MeshShape(Record):
    """A part from any function that makes a mesh (CadQuery, build123d, trimesh): function(dimensions) -> Mesh, everything in metres. Its
    derivative comes from rebuilt meshes (design/shapes/rebuilt_shape.hpp); triangles may differ from mesh to mesh, the topology not."""

    function: Callable[[Dict[str, float]], Mesh]
    values: Dict[str, Number] = number("length")  #: as drawn [m]
    unit: Number = number("length", 1e-3, of_unit=True)  #: that coordinates were rounded in: their digits tell the rounding [m]
    rounding: Optional[Number] = number("length", None)  #: of coordinates, if it is known [m]


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class ProgramShape(Record):
    """A part from a program that writes a mesh file: ProgramShape(MeshProgram(["openscad", "-o", "{out}", ...], unit=1e-3), {"radius": 3e-3})."""

    program: MeshProgram
    values: Dict[str, Number] = number("length")  #: as drawn [m]


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class QuantityGradient(Record):
    """Derivatives of a number in what a simulated design is made of; None or absent: zero."""

    positions: Optional[ArrayLike] = None  #: (steps + 1, bodies, 3)
    rotations: Optional[ArrayLike] = None  #: (steps + 1, bodies, 3, 3), entry by entry
    vertices: Dict[int, ArrayLike] = dataclasses.field(default_factory=dict)  #: by body, (n, 3)
    densities: Dict[int, float] = dataclasses.field(default_factory=dict)  #: by body


class Measured:
    """Arithmetic with quantities: force / mass and stroke - 2 * gap are an Expression."""

    __slots__ = ()

    def __add__(self, other: "Term") -> "Expression":
        return _combined("+", self, other)

    def __radd__(self, other: "Term") -> "Expression":
        return _combined("+", other, self)

    def __sub__(self, other: "Term") -> "Expression":
        return _combined("-", self, other)

    def __rsub__(self, other: "Term") -> "Expression":
        return _combined("-", other, self)

    def __mul__(self, other: "Term") -> "Expression":
        return _combined("*", self, other)

    def __rmul__(self, other: "Term") -> "Expression":
        return _combined("*", other, self)

    def __truediv__(self, other: "Term") -> "Expression":
        return _combined("/", self, other)

    def __rtruediv__(self, other: "Term") -> "Expression":
        return _combined("/", other, self)

    def __pow__(self, other: "Term") -> "Expression":
        return _combined("**", self, other)

    def __neg__(self) -> "Expression":
        return _combined("*", -1.0, self)


class Quantity(Measured):
    """A number that a simulated design has. Derive from it; a pure function. A value that is not finite is an evaluation that failed."""

    __slots__ = ()

    #: What it measures: "number", "length", "area", "volume", "angle", "time", "mass", "force", ...
    dimension: str = "number"
    #: Does a simulation change nothing of it (of the parts as assembled, or of their shapes alone)?
    at_rest: bool = False
    #: Is its value a number without bounds? A StepExpression may name it then.
    is_number: bool = False

    def value(self, simulated: "_fettle.Simulated") -> Union[float, Measurement]:
        """SI. A number that is known within bounds alone: a fettle.Measurement, lower <= value <= upper; requirements are judged by its
        bounds, and `value` is what is optimised and differentiated. Bounds that you have proven have is_proven=True."""
        raise NotImplementedError

    def gradient(self, simulated: "_fettle.Simulated") -> QuantityGradient:
        """Derivative of the value."""
        raise NotImplementedError

    def deviations(self, simulated: "_fettle.Simulated") -> ArrayLike:
        """(m,) numbers whose squares sum up to the value (SI, so in the square root of its unit), in an order that does not change; empty,
        where it is no such sum. Given them, the optimisers "sqp" and "gauss_newton" know the curvature of the objective."""
        return ()

    def deviation_gradient(self, simulated: "_fettle.Simulated", i: int) -> QuantityGradient:
        """Derivative of deviations(simulated)[i]; asked for where there are deviations."""
        raise NotImplementedError


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class FunctionQuantity(Record, Quantity):
    """A number from two functions: function(simulated) -> value, derivative(simulated) -> QuantityGradient."""

    function: Callable[["_fettle.Simulated"], Union[float, Measurement]]
    derivative: Callable[["_fettle.Simulated"], QuantityGradient]
    dimension: str = "number"  #: what it measures, as Quantity.dimension
    at_rest: bool = False
    is_number: bool = False

    def value(self, simulated: "_fettle.Simulated") -> Union[float, Measurement]:
        return self.function(simulated)

    def gradient(self, simulated: "_fettle.Simulated") -> QuantityGradient:
        return self.derivative(simulated)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Clearance(Record, Measured):
    """Certified least distance of two bodies, or of faces of theirs [m]: as assembled, over the motion (or a part or window of it), or over all
    positions of the joints."""

    a: Which
    b: Which
    motion: bool = False
    window: int = 0
    windows: int = 1
    minimum: Number = number("length", 0.0)
    from_time: Optional[Number] = number("time", None)  #: the part of the motion
    to_time: Optional[Number] = number("time", None)
    ranges: bool = False
    faces_a: List[str] = dataclasses.field(default_factory=list)  #: names of faces that count alone; empty: the whole body
    faces_b: List[str] = dataclasses.field(default_factory=list)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class FreeRange(Record, Measured):
    """The value of a joint's coordinate up to which it is proven free, from its start on, one way [rad or m], everything else as assembled:
    how far a lid opens before it meets its frame."""

    joint: str
    end: str = "above"  #: or "below": the way on which the coordinate grows, or falls
    coordinate_dimension: str = "angle"  #: "length" of a joint that slides
    clearance: Number = number("length", 1e-6)  #: that all bodies keep on the way
    reach: Number = number("length", 1.0)  #: how far a slide is looked at
    anywhere: bool = False  #: the other joints anywhere within their limits, not where they start


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Mass(Record, Measured):
    """Mass of bodies, given as (body, kind), kind as in Body.mass_kind [kg]."""

    bodies: Sequence[Tuple[Which, str]]


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Stroke(Record, Measured):
    """Along a unit axis [m]; with a target, which may be a formula of parameters, the square of the deviation from it [m^2]."""

    body: Which
    axis: Vector
    target: Optional[Number] = number("length", None)
    from_time: Optional[Number] = number("time", None)  #: the part of the motion that counts
    to_time: Optional[Number] = number("time", None)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class MarkerPath(Record, Measured):
    """Mean squared distance of a body's point from targets, all of whose coordinates may be formulas of parameters [m^2]; without times each
    at its nearest."""

    body: Which
    point: Vector = number("length")
    targets: Sequence[Vector] = number("length")
    times: Sequence[Number] = number("time", ())


@dataclasses.dataclass(eq=False, repr=False, slots=True, kw_only=True)
class Series(Record, Measured):
    """What each instant of a motion has a number of: the steps' ends and, of where something is, the start. A quantity is what comes of
    them, in this order: the derivative in time, the window (the instants within `from_time` and `to_time`; None: the start, the end), and
    what is taken `over` it: "end", "sum", "mean", "largest", "least", "peak" (the largest absolute value), "rms", or "integral" in time. Or
    the number `at` a time, linear between the instants. Of a library's kind: derive from Quantity instead."""

    derivative: int = 0  #: 0, 1, 2: the first is a velocity, the second an acceleration
    from_time: Optional[Number] = number("time", None)  #: [s]
    to_time: Optional[Number] = number("time", None)  #: [s]
    at: Optional[Number] = number("time", None)  #: [s]; in place of `over` and a window


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class MarkerPosition(Series):
    """Where a body's point (in its file frame) is at the start and the steps' ends, from an origin [m]: along an axis, else the distance. With
    derivative=2 its acceleration, by differences of the steps. Coordinates of both may be formulas of parameters."""

    body: Which
    point: Vector = number("length")
    over: str = "end"
    axis: Vector = dataclasses.field(default_factory=lambda: np.zeros(3))  #: the component along this unit vector; zeros: the magnitude
    origin: Vector = number("length", factory=lambda: np.zeros(3))  #: [m], world


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class MarkerSpeed(Series):
    """Velocity of a body's point (in its file frame) at the steps' ends, as the integrator has it [m/s]. The point's coordinates may be
    formulas of parameters."""

    body: Which
    point: Vector = number("length")
    over: str = "end"
    axis: Vector = dataclasses.field(default_factory=lambda: np.zeros(3))  #: the component along this unit vector; zeros: the magnitude


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class JointLoad(Series):
    """Force [N] or torque [N m] that a joint carries, or the effort of a motor [N m or N], at the steps' ends."""

    kind: str  #: "force", "torque"; "effort" of a motor
    name: str  #: of the joint, of the motor
    over: str = "end"
    axis: Vector = dataclasses.field(default_factory=lambda: np.zeros(3))  #: the component along this unit vector; zeros: the magnitude
    effort_dimension: str = "torque"  #: of a motor's effort; "force" where it drives a travel


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class JointPosition(Series):
    """Angle of a joint that turns [rad], travel of one that slides [m], at the start and the steps' ends; angles count turns."""

    joint: str
    over: str = "end"
    coordinate_dimension: str = "angle"  #: "length" of a joint that slides


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class BodyTurn(Series):
    """How far a body has turned about an axis since the start, at the steps' ends [rad]."""

    body: Which
    axis: Vector  #: a unit vector, world
    over: str = "end"


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class ContactLoad(Series):
    """Resultant force of contact on a body, friction included, at the steps' ends [N], of `other` or of all."""

    body: Which
    other: Optional[Which] = None
    over: str = "end"
    axis: Vector = dataclasses.field(default_factory=lambda: np.zeros(3))  #: the component along this unit vector; zeros: the magnitude
    about: Optional[Vector] = number("length", None)  #: the torque about this point of the body's file frame [N m], in place of the force


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Energy(Series):
    """Energy of all bodies, joints and springs at the steps' ends [J]."""

    kind: str  #: "kinetic", "potential", "spring", "total"
    over: str = "end"


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Gap(Series):
    """The gap between two bodies as contact measures it, at the start and the steps' ends [m]: computed, for events."""

    a: Which
    b: Which
    over: str = "end"


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class EventTime(Record, Measured):
    """When a quantity of the steps crosses a threshold [s]: one that says nothing but a derivative, such as a StepExpression or
    JointPosition("slide", derivative=1), whose crossing of 0 is a reversal.

        first, second = (fettle.EventTime(fettle.JointPosition("slide", derivative=1), occurrence=k) for k in (1, 2))
        duration = second - first

    Where the event does not happen the design cannot be evaluated, and the reason says how near it came."""

    of: Any = None
    threshold: Number = number("any", 0.0)  #: in the unit of what crosses it; may be a formula of parameters
    direction: str = "either"  #: or "rising", "falling"
    occurrence: int = 1  #: 1: the first crossing in this direction, 2: the second, -1: the last
    from_time: Optional[Number] = number("time", None)  #: only crossings from here on
    to_time: Optional[Number] = number("time", None)
    name: str = "the quantity"  #: what messages call what crosses


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class ValueAt(Record, Measured):
    """What a quantity of the steps is at a time that another quantity says: an EventTime, or an expression of such."""

    of: Any = None
    time: Any = None


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class TimeShare(Record, Measured):
    """The share of the time, 0 to 1, during which a quantity of the steps is above a threshold (above=False: below it); `along` another
    one, of what that travels."""

    of: Any = None
    threshold: Number = number("any", 0.0)  #: as of an EventTime
    above: bool = True
    along: Any = None  #: the drive, in place of the time
    from_time: Optional[Number] = number("time", None)
    to_time: Optional[Number] = number("time", None)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Law(Series):
    """A table over the time that a motion is to follow, for a StepExpression: `lift - Law("length", [0, 1], [0, "3 mm"], "cubic")`. Its values
    (SI, or with units of what it is of) may be formulas of parameters; outside its times it is constant. With `along`, another quantity of
    the steps, `times` are numbers of that one (SI)."""

    of: str  #: "length", "angle", ...
    times: Sequence[Number] = number("time")
    values: Sequence[Number] = number("any")
    profile: str = "linear"  #: or "cubic", "trapezoid", "control_points", as Curve.kind
    over: str = "end"
    along: Any = None  #: what the table is over, in place of the time


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Expression(Record, Measured):
    """A formula of other quantities, by name, and of parameters: what arithmetic with quantities gives, and

        fettle.Expression("max(left, right) / arm", {"left": left, "right": right, "arm": fettle.Mass([("arm", "volume")])})

    Numbers of a text without a unit count in SI. Its bounds enclose the formula over those of the quantities."""

    formula: "Union[_fettle.Formula, str]" = ""
    parts: Dict[str, Any] = dataclasses.field(default_factory=dict)  #: quantities


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class StepExpression(Series):
    """A formula of what other quantities are at the same step, of the step's `time`, and of parameters: a deviation from a law, a
    transmission error, power. A formula's text, or arithmetic with quantities:

        fettle.StepExpression(output - 2 * input, over="peak")
        fettle.StepExpression("lift - 3 mm * sin(2 rad/s * time)", {"lift": lift}, over="rms", from_time=0.2)

    Parts of which nothing is said but a derivative stand for their steps; those with another `over`, a window or `at` for their number."""

    formula: "Union[Expression, _fettle.Formula, str]" = ""
    parts: Dict[str, Any] = dataclasses.field(default_factory=dict)  #: quantities; of an Expression its own
    over: str = "end"


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class InScenario(Record, Measured):
    """A quantity in one of the design's scenarios, by number; of an expression, what it names that is in none yet."""

    quantity: Any = None
    scenario: int = 0


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Worst(Record, Measured):
    """The greatest (greatest=False: the least) of several quantities, such as one in all scenarios."""

    parts: List[Any] = dataclasses.field(default_factory=list)
    greatest: bool = True


AnyQuantity = Union[Measured, "_fettle.OpaqueQuantity"]
Term = Union[Measured, Operand]  # of an expression
AnyShape = Union[Shape, MeshShape, ProgramShape, "_fettle.OpaqueShape"]


class _AnyBody(List[str]):
    """Names of bodies, where it does not matter which."""

    def __contains__(self, name: object) -> bool:
        return True

    def index(self, *_: Any) -> int:
        return 0


def _dimension(quantity: Any) -> str:
    return _fettle.quantity_dimension(_numbered(quantity, _AnyBody(), []))


def _as_part(quantity: Any) -> Tuple["_fettle.Formula", Dict[str, Any]]:
    """A quantity in an expression; equal ones have one name."""
    if isinstance(quantity, Expression):
        return _formula_of(quantity, []), quantity.parts
    kind = type(quantity).__name__
    if isinstance(quantity, Record) and not isinstance(quantity, Quantity):
        members = [(field.name, getattr(quantity, field.name)) for field in dataclasses.fields(quantity)]
        text = repr([(name, value.tolist() if isinstance(value, np.ndarray) else value) for name, value in members])
        name = f"{kind}_{zlib.crc32(text.encode()):08x}"
    else:
        name = f"{kind}_{id(quantity):x}"
    return _fettle.measured(name, _dimension(quantity)), {name: quantity}


_SIGNS: Dict[str, Callable[[Any, Any], Any]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv, "**": operator.pow
}


def _combined(sign: str, a: Any, b: Any) -> "Expression":
    (left, left_parts), (right, right_parts) = (_as_part(x) if isinstance(x, Measured) else (_fettle.formula(x), {}) for x in (a, b))
    for name in left_parts.keys() & right_parts.keys():
        if left_parts[name] != right_parts[name]:
            raise Error([Fault("inconsistent", "expression", f"both sides call a quantity {name!r}, and mean different ones")])
    return Expression(_SIGNS[sign](left, right), {**left_parts, **right_parts})


def _formula_of(expression: "Union[Expression, StepExpression]", parameters: Sequence["Parameter"]) -> "_fettle.Formula":
    if isinstance(expression.formula, Expression):
        return _formula_of(expression.formula, parameters)
    if not isinstance(expression.formula, str):
        return expression.formula
    unit_of = {dimension: unit for unit, dimension in _fettle.units().items()}
    units = {parameter.name: parameter.unit or "1" for parameter in parameters}
    if isinstance(expression, StepExpression):
        units["time"] = "s"
    units.update({name: unit_of[_dimension(part)] for name, part in expression.parts.items()})
    return _fettle.Formula(expression.formula, units)


class _Arithmetic:
    """A parameter in formulas: crank + coupler * fettle.cos(phi) is a Formula."""

    __slots__ = ()

    def _as_formula(self) -> "_fettle.Formula":
        parameter: Any = self
        return _fettle.formula(parameter)

    def __add__(self, other: Operand) -> "_fettle.Formula":
        return self._as_formula() + other

    def __radd__(self, other: Operand) -> "_fettle.Formula":
        return _fettle.formula(other) + self._as_formula()

    def __sub__(self, other: Operand) -> "_fettle.Formula":
        return self._as_formula() - other

    def __rsub__(self, other: Operand) -> "_fettle.Formula":
        return _fettle.formula(other) - self._as_formula()

    def __mul__(self, other: Operand) -> "_fettle.Formula":
        return self._as_formula() * other

    def __rmul__(self, other: Operand) -> "_fettle.Formula":
        return _fettle.formula(other) * self._as_formula()

    def __truediv__(self, other: Operand) -> "_fettle.Formula":
        return self._as_formula() / other

    def __rtruediv__(self, other: Operand) -> "_fettle.Formula":
        return _fettle.formula(other) / self._as_formula()

    def __pow__(self, other: Operand) -> "_fettle.Formula":
        return self._as_formula() ** other

    def __neg__(self) -> "_fettle.Formula":
        return -self._as_formula()


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Parameter(Record, _Arithmetic):
    """value, lower, upper in SI, or as texts with units of `unit`'s dimension; `unit` is what people read it in."""

    name: str = ""
    value: Number = number("unit", 0.0)
    lower: Number = number("unit", 0.0)
    upper: Number = number("unit", 0.0)
    unit: str = ""
    reference: Optional[Number] = number("unit", None)  #: where settings that the scene leaves open are chosen; None: at `value`

    def __post_init__(self) -> None:
        # Now that the unit is known.
        self.value, self.lower, self.upper, self.reference = self.value, self.lower, self.upper, self.reference


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Bounds(Record):
    lower: Number = number("any", -math.inf)  #: SI
    upper: Number = number("any", math.inf)
    margin: Number = number("any", 0.0)  #: by which the optimiser keeps away from both
    unit: Number = number("any", 1.0, of_unit=True)  #: SI value of the unit that violations are counted in, or its name


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class ObjectiveTerm(Record):
    """Contributes weight * value / unit."""

    name: str = ""
    weight: float = 1.0
    unit: Number = number("any", 1.0, of_unit=True)
    quantity: Optional[AnyQuantity] = None


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Constraint(Record):
    name: str = ""
    bounds: Bounds = dataclasses.field(default_factory=Bounds)
    quantity: Optional[AnyQuantity] = None


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Relation(Record):
    """Between parameters alone: a formula ("crank / rod", or of parameters: crank / rod), or at(p) -> (value, gradient), p all in SI.

    Numbers without a unit in a text are SI here; of a file that was read, formula is a Formula, in which they count as the file says."""

    name: str = ""
    bounds: Bounds = dataclasses.field(default_factory=Bounds)
    tolerance: float = 0.0
    formula: "Union[_fettle.Formula, Parameter, str]" = ""
    at: Optional[Callable[[Array], Tuple[float, ArrayLike]]] = None


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class OptimiserSettings(Record):
    name: str = "sqp"
    max_evaluations: int = 100
    tolerance: float = 1e-4
    keep_sides: bool = False  #: random starts assemble closed linkages on the sides as written alone


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Scenario(Record):
    """A setting beside which the design is simulated: its scene with other loads, friction, motors, start, time step ..."""

    name: str = ""
    scene: Scene = dataclasses.field(default_factory=Scene)  #: with the same bodies and joints as the design's
    shapes: List[Optional[AnyShape]] = dataclasses.field(default_factory=list)  #: as Design.shapes
    numbers: List[BoundNumber] = dataclasses.field(default_factory=list)  #: as Design.numbers
    steps: int = 0


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Design(Record):
    """A scene, what may be changed in it, what is wanted and what is required."""

    scene: Scene = dataclasses.field(default_factory=Scene)
    shapes: List[Optional[AnyShape]] = dataclasses.field(default_factory=list)  #: per body; None: the mesh stays as it is
    steps: int = 0
    clearance_tolerance: Number = number("length", 1e-9)  #: [m]
    parameters: List[Parameter] = dataclasses.field(default_factory=list)
    numbers: List[BoundNumber] = dataclasses.field(default_factory=list)  #: of the scene, that follow from parameters; see set()
    #: what is simulated; none: the scene as it stands. Quantities are about the first, or about the one that InScenario says
    scenarios: List[Scenario] = dataclasses.field(default_factory=list)
    objective: List[ObjectiveTerm] = dataclasses.field(default_factory=list)
    constraints: List[Constraint] = dataclasses.field(default_factory=list)
    relations: List[Relation] = dataclasses.field(default_factory=list)
    optimiser: OptimiserSettings = dataclasses.field(default_factory=OptimiserSettings)

    def set(self, place: str, value: "Operand | Sequence[Operand]") -> None:
        """Lets a number of the scene, or the numbers of a vector, follow from parameters (BoundNumber says what a place is). A text is a
        formula of the parameters' names; numbers without a unit count in SI.

            design.set("/bodies/rod/position", [crank + rod * fettle.cos(phi), 0, 0])
            design.set("/bodies/pin/shape/dimensions/radius", "bore - gap")
        """
        if isinstance(value, (list, tuple, np.ndarray)):
            for k, entry in enumerate(value):
                self.set(f"{place}/{k}", entry)
            return
        component: Any = value
        if isinstance(component, str):
            formula = _fettle.Formula(component, {parameter.name: parameter.unit or "1" for parameter in self.parameters})
        else:
            formula = _fettle.formula(component)
        self.numbers = [number for number in self.numbers if number.place != place] + [BoundNumber(place, formula)]

    def _prepared(self) -> "Design":
        """As the library takes it: bodies by number. Raises Error where a name is no body's, or a number was given in a unit of another
        dimension than what it bounds."""
        faults: List[Fault] = []
        names = [body.name for body in self.scene.bodies]

        def of(quantity: Any) -> Any:
            return _numbered(quantity, names, faults, self.parameters)

        values = {parameter.name: parameter.value for parameter in self.parameters}

        def settled(of: Any) -> Any:
            scene, numbers = settled_scene(of.scene, values)
            return dataclasses.replace(of, scene=scene, numbers=[*of.numbers, *numbers])

        made: Design = dataclasses.replace(
            settled(self),
            scenarios=[settled(scenario) for scenario in self.scenarios],
            objective=[dataclasses.replace(term, quantity=of(term.quantity)) for term in self.objective],
            constraints=[dataclasses.replace(c, quantity=of(c.quantity)) for c in self.constraints],
        )
        faults = faults or _faults_of_units(made)
        if faults:
            raise Error(faults)
        return made


def _body_number(body: Which, names: Sequence[str], where: str, faults: List[Fault]) -> int:
    if not isinstance(body, str):
        return body
    if body in names:
        return names.index(body)
    faults.append(Fault("out_of_range", where, f"there is no body {body!r}; {did_you_mean(body, names)}"))
    return 0


def _numbered(record: Any, names: Sequence[str], faults: List[Fault], parameters: Sequence[Parameter] = ()) -> Any:
    """A quantity with its bodies by number, and texts of expressions as formulas."""
    kind = type(record)
    if kind is Expression:
        parts = {name: _numbered(part, names, faults, parameters) for name, part in record.parts.items()}
        return Expression(_formula_of(record, parameters), parts)
    if kind is StepExpression:
        of = record.formula.parts if isinstance(record.formula, Expression) else record.parts
        parts = {name: _numbered(part, names, faults, parameters) for name, part in of.items()}
        formula = _formula_of(record, parameters)
        if "time" in formula.inputs and "time" not in parts and any(parameter.name == "time" for parameter in parameters):
            faults.append(Fault("inconsistent", "StepExpression/formula", "a parameter is called `time`, which here is the step's; rename it"))
        return dataclasses.replace(record, formula=formula, parts=parts)
    if kind is Law:
        faults.extend(faults_of(record.values, record.of, "Law/values"))
        return record if record.along is None else dataclasses.replace(record, along=_numbered(record.along, names, faults, parameters))
    if kind in (EventTime, TimeShare, ValueAt):
        quantities = {name: getattr(record, name) for name in ("of", "along", "time") if name in kind.__dataclass_fields__}
        numbered = {name: _numbered(of, names, faults, parameters) for name, of in quantities.items() if of is not None}
        if isinstance(getattr(record, "threshold", None), Given):
            faults.extend(faults_of(record.threshold, _dimension(record.of), f"{kind.__name__}/threshold"))
        return dataclasses.replace(record, **numbered)
    if kind is Worst:
        return Worst([_numbered(part, names, faults, parameters) for part in record.parts], record.greatest)
    if kind is InScenario:
        return InScenario(_numbered(record.quantity, names, faults, parameters), record.scenario)
    if kind is Mass:
        if all(not isinstance(body, str) for body, _ in record.bodies):
            return record
        return Mass([(_body_number(body, names, "Mass/bodies", faults), of) for body, of in record.bodies])
    if not isinstance(record, Record) or isinstance(record, Quantity):
        return record
    members = {name: getattr(record, name) for name in ("a", "b", "body", "other") if name in kind.__dataclass_fields__}
    numbers = {
        name: _body_number(body, names, f"{kind.__name__}/{name}", faults) for name, body in members.items() if isinstance(body, str)
    }
    return dataclasses.replace(record, **numbers) if numbers else record


def _faults_of_units(design: Design) -> List[Fault]:
    """The faults of numbers with units in objective and constraints: their quantity determines the dimension."""
    faults: List[Fault] = []
    measured: List[Tuple[Any, str, Dict[str, Any]]] = [
        (term.quantity, f"objective term `{term.name}`", {"unit": term.unit}) for term in design.objective
    ]
    for c in design.constraints:
        members = {name: getattr(c.bounds, name) for name in ("lower", "upper", "margin", "unit")}
        measured.append((c.quantity, f"constraint `{c.name}`/bounds", members))
    for of, where, members in measured:
        units = {name: value for name, value in members.items() if isinstance(value, Given)}
        if units and of is not None:
            dimension = _fettle.quantity_dimension(of)
            faults += [fault for name, value in units.items() for fault in faults_of(value, dimension, f"{where}/{name}")]
    return faults


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class DesignFile(Record):
    """A design and what its file says besides."""

    design: Design = dataclasses.field(default_factory=Design)
    path: PathLike = ""
    text: str = ""
    scene_path: PathLike = ""
    length_unit: str = ""
    output: str = ""
    warnings: List[str] = dataclasses.field(default_factory=list)


def add_part(design: Design, body: Body, shape: AnyShape) -> int:
    """Adds a body with the shape as drawn for its mesh. Returns its index."""
    body.mesh = _fettle.shape_mesh(shape)
    design.scene.bodies.append(body)
    design.shapes += [None] * (len(design.scene.bodies) - len(design.shapes))
    design.shapes[-1] = shape
    return len(design.scene.bodies) - 1


