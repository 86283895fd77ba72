# SPDX-License-Identifier: MIT
"""What simulations, certifications, evaluations and optimisations answer: plain data, SI units."""
import dataclasses
import decimal
import json
import math
import os
from typing import Any, Dict, Iterable, List, Literal, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from . import _fettle
from ._record import COLUMNS, MOST_LINES, MOST_ROWS, Number, Record, Records, columns, did_you_mean, number
from .scene import JointSide

Array = NDArray[np.float64]
Solids = Literal["unproven", "disjoint", "overlap", "not closed", "not verified"]  #: of the two bodies of a pair


def _zero() -> Array:
    return np.zeros(3)


def _empty() -> Array:
    return np.zeros(0)


def _rows() -> Array:
    return np.zeros((0, 0))


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class StepReport(Record):
    newton_iterations: int = 0
    friction_rounds: int = 0
    contacts: int = 0
    minimum_distance: float = 0.0  #: of the active pairs at the step's end [m]
    residual: float = 0.0
    joint_gap: float = 0.0  #: [m]
    path_joint_gap: float = 0.0  #: [m]


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class SimulationReport(Record):
    status: Literal["ok", "blocked", "not_held", "not_converged", "energy_gained", "interrupted"] = "ok"
    message: str = ""
    steps: List[StepReport] = dataclasses.field(default_factory=list)
    newton_iterations: int = 0
    wall_seconds: float = 0.0


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class ContactForce(Record):
    """Between two bodies at a step's end."""

    a: int = 0
    b: int = 0
    force: Array = dataclasses.field(default_factory=_zero)  #: on a, world [N]
    torque: Array = dataclasses.field(default_factory=_zero)  #: on a, about the world's origin [N m]
    normal: float = 0.0  #: [N]
    friction: Array = dataclasses.field(default_factory=_zero)  #: on a [N]
    distance: float = 0.0  #: [m]
    contacts: int = 0


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class DriveForce(Record):
    """What holds or drives a body's prescribed coordinates."""

    body: int = 0
    force: Array = dataclasses.field(default_factory=_zero)
    torque: Array = dataclasses.field(default_factory=_zero)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class JointForce(Record):
    """On body b, about the joint's point: what keeps the joint together; effort: of a motor, along its coordinate; spring, damping, friction
    and stop: of the joint's own, along its coordinate."""

    joint: int = 0
    force: Array = dataclasses.field(default_factory=_zero)
    torque: Array = dataclasses.field(default_factory=_zero)
    effort: float = 0.0
    spring: float = 0.0
    damping: float = 0.0
    friction: float = 0.0
    stop: float = 0.0


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class StepOutputs(Record):
    time: float = 0.0  #: at the step's end [s]
    kappa: float = 0.0
    kinetic_energy: float = 0.0  #: [J]
    potential_energy: float = 0.0  #: [J]
    contact_energy: float = 0.0  #: [J]
    spring_energy: float = 0.0  #: [J]
    supplied_power: float = 0.0  #: by motors, prescribed coordinates, torques and loads at points [W]
    dissipated_power: float = 0.0  #: by friction and dampers [W]
    linear_momentum: Array = dataclasses.field(default_factory=_zero)  #: [kg m/s]
    angular_momentum: Array = dataclasses.field(default_factory=_zero)  #: [kg m^2/s]
    contacts: List[ContactForce] = dataclasses.field(default_factory=list)
    drives: List[DriveForce] = dataclasses.field(default_factory=list)
    joints: List[JointForce] = dataclasses.field(default_factory=list)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Simulation(Record):
    trajectory: _fettle.Trajectory = dataclasses.field(default_factory=_fettle.Trajectory)
    report: SimulationReport = dataclasses.field(default_factory=SimulationReport)
    outputs: List[StepOutputs] = dataclasses.field(default_factory=list)  #: per step, if asked for


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class PairRequest(Record):
    """Bodies a and b, by name or number, and the clearance that is required of them."""

    a: Union[int, str] = 0
    b: Union[int, str] = 0
    minimum: Number = number("length", 0.0)  #: [m]
    far: Number = number("length", math.inf)  #: [m]
    may_touch: bool = False  #: that they touch is accepted, and so is every gap: `minimum` does not count
    touch_depth: Number = number("length", 0.0)  #: how deep they may be in each other and still touch [m]; 0: 1e-5 of the larger one's size


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Witness(Record):
    """Which two primitives are closest, when, and where."""

    step: int = -1
    segment: int = 0
    s: float = 0.0
    time: float = 0.0
    kind_a: Literal["vertex", "edge", "triangle"] = "vertex"
    kind_b: Literal["vertex", "edge", "triangle"] = "triangle"
    primitive_a: int = -1
    primitive_b: int = -1
    edge_edge: bool = False
    vertex_on_a: bool = True
    point_a: Array = dataclasses.field(default_factory=_zero)  #: world [m]
    point_b: Array = dataclasses.field(default_factory=_zero)
    distance: float = 0.0


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class MarginInterval(Record):
    step: int = -1
    segment: int = 0
    time_start: float = 0.0
    time_end: float = 0.0
    lower: float = 0.0
    upper: float = 0.0


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Overlap(Record):
    depth_lower: float = 0.0  #: [m]
    depth_upper: float = 0.0
    volume_lower: float = 0.0  #: [m^3]
    volume_upper: float = 0.0
    time: float = 0.0
    center: Array = dataclasses.field(default_factory=_zero)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Touch(Record):
    """Two bodies that touch: proven to be nowhere deeper in each other than `depth`."""

    area: float = 0.0  #: of the faces that lie on each other [m^2]
    time: float = 0.0
    depth: float = 0.0  #: [m]
    room: float = 0.0
    is_whole: bool = True  #: False: of too many faces to look at all; the area is at least so large


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class PairClearance(Record):
    """Proven: lower <= the least distance <= upper, rounding included [m]: over a path, or over all positions of the joints."""

    a: int = 0
    b: int = 0
    minimum: float = 0.0
    lower: float = 0.0
    upper: float = 0.0
    is_bounded: bool = True  #: False: nothing is proven
    is_far: bool = False
    status: Literal["clear", "violated", "undecided", "contact"] = "undecided"
    witness: Witness = dataclasses.field(default_factory=Witness)
    complete: bool = True
    intersecting: bool = False
    solids: Solids = "unproven"
    overlap: Optional[Overlap] = None
    touch: Optional[Touch] = None
    clash_not_before: float = 0.0
    clash_time: float = 0.0
    reason: str = ""
    sampled: float = 0.0
    margin: List[MarginInterval] = dataclasses.field(default_factory=list)
    witnesses: List[Witness] = dataclasses.field(default_factory=list)
    tolerance: float = 0.0  #: over ranges: that was asked for, of this pair
    coordinates: List[int] = dataclasses.field(default_factory=list)  #: of JointRanges: those that move one body against the other
    at: List[float] = dataclasses.field(default_factory=list)  #: their values at the witness
    bounds: int = 0  #: over ranges: computed


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class JointCoordinate(Record):
    """A joint's own coordinate, of the one that moves it: scale u + offset."""

    joint: str = ""
    is_angle: bool = False  #: [rad], else [m]
    scale: float = 1.0
    offset: float = 0.0


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class RangeCoordinate(Record):
    """One of JointRanges: low <= start <= high, of the first of its joints [rad or m]."""

    start: float = 0.0
    low: float = 0.0
    high: float = 0.0
    is_whole_turn: bool = False  #: there are no limits: the range is one turn
    joints: List[JointCoordinate] = dataclasses.field(default_factory=list)  #: several, where gears couple them


def _metres(value: float, rounding: str) -> str:
    """Six digits, never towards what is not proven."""
    if not math.isfinite(value):
        return str(value)
    return f"{decimal.Context(prec=6, rounding=rounding).create_decimal(value):g}"


class Pairs(Records[PairClearance]):
    """What certify_clearance and certify_ranges answer: a list in the order in which pairs were asked for, that knows the bodies' names."""

    def __init__(self, pairs: Iterable[PairClearance] = (), body_names: Sequence[str] = ()):
        super().__init__(pairs)
        self.body_names: List[str] = list(body_names)

    def pair(self, a: str, b: str) -> PairClearance:
        """The one of two bodies, by name, in either order."""
        for name in (a, b):
            if name not in self.body_names:
                raise KeyError(f"there is no body {name!r}; {did_you_mean(name, self.body_names)}")
        for each in self:
            if {a, b} == {self.body_names[each.a], self.body_names[each.b]}:
                return each
        raise KeyError(f"the pair of {a!r} and {b!r} was not asked for")

    def _name(self, body: int) -> str:
        return self.body_names[body] if 0 <= body < len(self.body_names) else str(body)

    def _row(self, of: PairClearance) -> Tuple[str, ...]:
        names = f"{self._name(of.a)}:{self._name(of.b)}"
        return names, of.status, _metres(of.lower, decimal.ROUND_FLOOR), _metres(of.upper, decimal.ROUND_CEILING), f"{of.minimum:g}"

    def __repr__(self) -> str:
        if not self:
            return "no pairs"
        lines = [f"{names}  {status}  {lower} .. {upper} m" for names, status, lower, upper, _ in map(self._row, self[: MOST_LINES - 1])]
        more = [f"... and {len(self) - len(lines)} more pairs"] if len(self) > len(lines) else []
        return "\n".join([line[:COLUMNS] for line in lines] + more)

    def _repr_html_(self) -> str:
        rows: List[Sequence[Any]] = [[*self._row(each), each.reason] for each in self[: MOST_ROWS + 1]]
        rows += [[]] * (len(self) - len(rows))
        title = f"{len(self)} {'pair' if len(self) == 1 else 'pairs'}: proven bounds of the least distance [m]"
        return columns(title, ["pair", "status", "at least", "at most", "required", "reason"], rows)


class _Answer:
    """What a command prints with --json."""

    def __init__(self, text: str):
        self.answer: Dict[str, Any] = json.loads(text)

    @property
    def status(self) -> str:
        return str(self.answer["status"])

    def __getitem__(self, key: str) -> Any:
        return self.answer[key]


class ClearanceReport(_Answer):
    """What `clearance` answers, pairs worst first: what `fettle clearance --json` prints (docs/interface.md), and the proof.
    `status` is "clear", "violated" or "undecided".

    report.status, report.pairs[0]["finding"], report.pair("pin", "plate")["lower"], report["notes"]
    """

    def __init__(self, text: str, certificate: Optional[_fettle.Certificate] = None):
        super().__init__(text)
        self.certificate = certificate  #: None: none was asked for, or nothing is proven

    @property
    def pairs(self) -> List[Dict[str, Any]]:
        return list(self.answer["pairs"])

    def pair(self, a: str, b: str) -> Dict[str, Any]:
        """The row of two bodies or groups, by name, in either order."""
        for row in self.pairs:
            if {a, b} == {row["a"], row["b"]}:
                return row
        names = sorted({row[key] for row in self.pairs for key in ("a", "b")})
        unknown = [name for name in (a, b) if name not in names]
        told = f"; no pair has {unknown[0]!r}; {did_you_mean(unknown[0], names)}" if unknown else ""
        raise KeyError(f"the pair of {a!r} and {b!r} was not judged{told}")

    def write(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """As JSON: a `baseline` for later reports, of the command too."""
        with open(path, "w", encoding="utf-8") as file:
            json.dump(self.answer, file, indent=2)

    def _rows(self, most: int) -> List[List[str]]:
        def metres(value: Optional[float], rounding: str) -> str:
            return "-" if value is None else _metres(value, rounding)

        return [
            [
                f"{row['a']}:{row['b']}",
                row["finding"],
                metres(row["lower"], decimal.ROUND_FLOOR),
                metres(row["upper"], decimal.ROUND_CEILING),
                "-" if row["minimum"] is None else f"{row['minimum']:g}",
                row.get("reason", ""),
            ]
            for row in self.pairs[:most]
        ]

    def __repr__(self) -> str:
        lines = [f"{self.status}, {self.answer['source']}"]
        lines += [f"{pair}  {finding}  {lower} .. {upper} m" for pair, finding, lower, upper, *_ in self._rows(MOST_LINES - 2)]
        more = [f"... and {len(self.pairs) - len(lines) + 1} more pairs"] if len(self.pairs) > len(lines) - 1 else []
        return "\n".join([line[:COLUMNS] for line in lines] + more)

    def _repr_html_(self) -> str:
        rows: List[Sequence[Any]] = [*self._rows(MOST_ROWS + 1)]
        rows += [[]] * (len(self.pairs) - len(rows))
        title = f"{self.status}: proven bounds of the least distance {self.answer['source']} [m]"
        return columns(title, ["pair", "finding", "at least", "at most", "required", "reason"], rows)


class ToleranceReport(_Answer):
    """What `tolerance` answers: what `fettle tolerance --json` prints (docs/interface.md), and the samples. `status` is "ok", "undecided"
    or "interrupted".

    report.status, report["samples"]["yield"], report.response("stroke")["linear"]["standard_deviation"]
    report.deviations[k], report.values[k]: of sample k, per tolerance and per response [SI]; values NaN where it failed
    """

    def __init__(self, text: str, deviations: Array, values: Array):
        super().__init__(text)
        self.deviations = deviations
        self.values = values

    @property
    def responses(self) -> List[Dict[str, Any]]:
        """The objective, the constraints, the relations."""
        return list(self.answer["responses"])

    def response(self, name: str) -> Dict[str, Any]:
        for row in self.responses:
            if row["name"] == name:
                return row
        raise KeyError(f"there is no response {name!r}; {did_you_mean(name, [row['name'] for row in self.responses])}")

    def _rows(self) -> List[List[str]]:
        def percent(value: Optional[Dict[str, Any]]) -> str:
            return "-" if value is None else f"{100 * value['within']:.4g}%"

        return [
            [
                row["name"],
                f"{row['nominal']:.6g}",
                f"{row['linear']['standard_deviation']:.3g}",
                percent(row["linear"].get("yield")),
                percent((row["sampled"] or {}).get("yield")),
                row["contributions"][0]["of"] if row["contributions"] else "-",
            ]
            for row in self.responses
        ]

    def __repr__(self) -> str:
        lines = [f"{self.status}, {len(self.values)} samples"]
        lines += ["  ".join(row) for row in self._rows()[: MOST_LINES - 1]]
        return "\n".join(line[:COLUMNS] for line in lines)

    def _repr_html_(self) -> str:
        title = f"{self.status}, {len(self.values)} samples [SI]"
        return columns(title, ["response", "as drawn", "sigma", "yield, linear", "yield, sampled", "most by"], self._rows())


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class CertificateFault(Record):
    where: str = ""
    message: str = ""


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class CertificateReport(Record):
    faults: List[CertificateFault] = dataclasses.field(default_factory=list)
    stale: bool = False
    leaves: int = 0
    pieces: int = 0

    @property
    def accepted(self) -> bool:
        """Every claim is proven."""
        return not self.faults


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Measurement(Record):
    """lower <= value <= upper; `value` is what the optimiser sees. Requirements are judged by lower and upper."""

    value: float = 0.0
    lower: float = 0.0
    upper: float = 0.0
    is_proven: bool = False  #: True: the true value lies within the bounds; False: they are as computed, and nothing bounds their error
    clearance: Optional[PairClearance] = None
    fault: str = ""


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Rows(Record):
    values: Array = dataclasses.field(default_factory=_empty)  #: (k)
    jacobian: Array = dataclasses.field(default_factory=_rows)  #: (k, n)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Run(Record):
    """What was simulated of a design: one of its scenarios."""

    simulation: Simulation = dataclasses.field(default_factory=Simulation)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class DesignEvaluation(Record):
    """A design, simulated and measured; not usable: `reason` says why, and objective and violation are NaN."""

    usable: bool = False
    reason: str = ""
    runs: List[Run] = dataclasses.field(default_factory=list)  #: one per scenario, at least one
    terms: List[Measurement] = dataclasses.field(default_factory=list)
    constraints: List[Measurement] = dataclasses.field(default_factory=list)
    relations: Rows = dataclasses.field(default_factory=Rows)
    objective: float = math.nan
    violation: float = math.nan  #: largest, in the constraints' units; 0: every requirement is met
    gradient: Array = dataclasses.field(default_factory=_empty)  #: (n)
    jacobian: Array = dataclasses.field(default_factory=_rows)  #: (m, n)
    residuals: Array = dataclasses.field(default_factory=_empty)  #: (r)
    residual_jacobian: Array = dataclasses.field(default_factory=_rows)  #: (r, n)
    forward_seconds: float = 0.0
    backward_seconds: float = 0.0

    @property
    def simulation(self) -> Simulation:
        """Of the first scenario, or of the design that has none."""
        return self.runs[0].simulation


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class StageReport(Record):
    model: str = ""
    evaluations: int = 0
    objective: float = 0.0
    violation: float = 0.0
    message: str = ""


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class Optimality(Record):
    judged: bool = False
    predicted_gain: float = 0.0
    worth: float = 0.0
    radius: float = 0.0
    step: Array = dataclasses.field(default_factory=_empty)
    multipliers: Array = dataclasses.field(default_factory=_empty)
    residual: Array = dataclasses.field(default_factory=_empty)
    held: List[str] = dataclasses.field(default_factory=list)
    refused: str = ""
    improvable: List[int] = dataclasses.field(default_factory=list)
    noise: Array = dataclasses.field(default_factory=_empty)
    noise_in_objective: float = 0.0
    roughest: int = -1


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class OptimiserReport(Record):
    status: Literal["optimal", "feasible", "infeasible", "interrupted", "start_failed"] = "start_failed"
    message: str = ""
    point: Array = dataclasses.field(default_factory=_empty)  #: (n) the best design, SI
    objective: float = math.nan  #: its objective (repair=True: the squared change); NaN: nothing could be evaluated
    violation: float = math.nan  #: largest, in the constraints' units; 0: every requirement is met
    feasible: bool = False
    optimality: Optimality = dataclasses.field(default_factory=Optimality)
    evaluations: int = 0
    failures: int = 0
    iterations: int = 0
    budget_spent: bool = False
    stages: List[StageReport] = dataclasses.field(default_factory=list)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class OptimiseOutcome(Record):
    report: OptimiserReport = dataclasses.field(default_factory=OptimiserReport)
    start: Array = dataclasses.field(default_factory=_empty)
    #: On which sides joints say that closed linkages are assembled.
    sides: List[JointSide] = dataclasses.field(default_factory=list)
    objective_start: Optional[float] = None
    final: DesignEvaluation = dataclasses.field(default_factory=DesignEvaluation)
    clearance: List[PairClearance] = dataclasses.field(default_factory=list)
    limits: List[str] = dataclasses.field(default_factory=list)
    unbuildable: List[str] = dataclasses.field(default_factory=list)
    replayed: int = 0

    def _repr_html_(self) -> str:
        report, final = self.report, self.final
        title = f"{report.status}: {report.message}"
        rows: List[Sequence[Any]] = [["objective", "-" if self.objective_start is None else f"{self.objective_start:.6g}", f"{report.objective:.6g}", ""]]
        rows += [[f"parameter {k}", f"{start:.6g}", f"{now:.6g}", ""] for k, (start, now) in enumerate(zip(self.start, report.point))]
        rows += [
            [f"constraint {k}", "", f"{each.value:.6g}", "proven" if each.is_proven else "computed"]
            for k, each in enumerate(final.constraints)
        ]
        rows += [["largest violation", "", f"{report.violation:.3g}", ""], ["evaluations", "", str(report.evaluations), ""]]
        return columns(title, ["SI, in the order of the problem's names", "at the start", "now", ""], rows)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class CheckRow(Record):
    quantity: str = ""
    parameter: str = ""
    adjoint: float = 0.0
    difference: float = 0.0
    difference_error: float = 0.0
    relative_error: float = 0.0
    kink: float = 0.0  #: slope above minus slope below, where they stay apart
    lies_between: bool = False  #: at a kink: does the adjoint, of the slopes of both sides
    resolved: bool = True


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class LineRow(Record):
    """As CheckRow, along roughness.direction; slope: about 2 where the gradient is right and the quantity smooth."""

    quantity: str = ""
    adjoint: float = 0.0
    difference: float = 0.0
    difference_error: float = 0.0
    relative_error: float = 0.0
    resolved: bool = True
    kink: float = 0.0
    lies_between: bool = False
    slope: float = 0.0


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class SweepAgreement(Record):
    disagreement: float = 0.0  #: of the reverse and the forward sweep, relative
    quantity: str = ""
    failure: str = ""


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class NoiseLevel(Record):
    noise: float = 0.0
    second_derivative: float = 0.0
    third_derivative: float = 0.0
    second_derivative_error: float = 0.0
    third_derivative_error: float = 0.0
    status: Literal["detected", "spacing_too_small", "spacing_too_large"] = "spacing_too_large"


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class QuantityRoughness(Record):
    name: str = ""
    size: float = 0.0
    slope: float = 0.0
    noise: NoiseLevel = dataclasses.field(default_factory=NoiseLevel)
    fine: NoiseLevel = dataclasses.field(default_factory=NoiseLevel)
    rounding: float = 0.0
    holds: float = 0.0  #: how far the gradient holds, in shares of the parameters' ranges
    breaks: float = 0.0
    tolerance: float = 0.0
    rough: bool = False


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class RoughnessReport(Record):
    measured: bool = False
    direction: Array = dataclasses.field(default_factory=_empty)
    spacing: float = 0.0
    fine_spacing: float = 0.0
    quantities: List[QuantityRoughness] = dataclasses.field(default_factory=list)
    simulations: int = 0
    failures: List[str] = dataclasses.field(default_factory=list)
    interrupted: bool = False


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class ContactFeature(Record):
    kind: Literal["vertex", "edge", "face"] = "vertex"
    vertices: List[int] = dataclasses.field(default_factory=list)


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class ContactState(Record):
    a: int = 0
    b: int = 0
    on_a: ContactFeature = dataclasses.field(default_factory=ContactFeature)
    on_b: ContactFeature = dataclasses.field(default_factory=ContactFeature)
    place: Array = dataclasses.field(default_factory=_zero)  #: world [m]
    is_mollified: bool = False
    slides: bool = False


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class ContactDifference(Record):
    event: Literal["touch", "part", "new_features", "parallel", "crossing", "slide", "stick"] = "touch"
    step: int = 0
    was: ContactState = dataclasses.field(default_factory=ContactState)
    is_: ContactState = dataclasses.field(default_factory=ContactState)
    others: bool = False


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class ContactChange(Record):
    """The nearest change of one sort between two bodies as one parameter moves to one side: none at `from_`, one at `to` (SI, signed)."""

    parameter: str = ""
    from_: float = 0.0
    to: float = 0.0
    share: float = 0.0
    at: ContactDifference = dataclasses.field(default_factory=ContactDifference)
    body_a: str = ""
    body_b: str = ""
    time: float = 0.0
    count: int = 1
    scenario: str = ""  #: its name; empty: the design has none


@dataclasses.dataclass(eq=False, repr=False, slots=True)
class CheckReport(Record):
    rows: List[CheckRow] = dataclasses.field(default_factory=list)
    along: List[LineRow] = dataclasses.field(default_factory=list)
    sweeps: SweepAgreement = dataclasses.field(default_factory=SweepAgreement)
    left_out: List[str] = dataclasses.field(default_factory=list)
    largest_relative_error: float = 0.0
    roughness: RoughnessReport = dataclasses.field(default_factory=RoughnessReport)
    first_step: float = 0.0
    contact_changes: List[ContactChange] = dataclasses.field(default_factory=list)
    contacts_reach: Array = dataclasses.field(default_factory=_rows)  #: (n, 2) below and above, in shares of the range
    simulations: int = 0
    failures: List[str] = dataclasses.field(default_factory=list)
    interrupted: bool = False

    def _repr_html_(self) -> str:
        worst = sorted(self.rows, key=lambda row: -row.relative_error if math.isfinite(row.relative_error) else -math.inf)
        rows = [
            [row.quantity, row.parameter, f"{row.adjoint:.7g}", f"{row.difference:.7g}", f"{row.relative_error:.1e}", "" if row.resolved else "not resolved"]
            for row in worst
        ]
        title = f"gradient check{', interrupted' if self.interrupted else ''}: largest relative error {self.largest_relative_error:.1e}, {self.simulations} simulations, SI"
        return columns(title, ["quantity", "parameter", "adjoint", "difference", "relative error", ""], rows)
