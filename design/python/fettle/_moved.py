# SPDX-License-Identifier: MIT
"""Numbers of a scene that were given as parameters or formulas of them, as the library has them: numbers, and what they follow from."""
import dataclasses
from typing import Any, Callable, Dict, List, Mapping, Optional, Tuple

from . import _fettle
from .scene import BoundNumber, Scene

_BODY = ("density", "linear_velocity", "angular_velocity", "force", "torque", "mu")
_FORCES = ("stiffness", "rest", "preload", "damping", "friction", "limits")
_COORDINATES = ("px", "py", "pz", "rx", "ry", "rz")


def _formula_in(value: Any) -> "Optional[_fettle.Formula]":
    """None: a number like any other."""
    if isinstance(value, _fettle.Formula):
        return value
    return _fettle.formula(value) if type(value).__name__ == "Parameter" else None


def _same_places(members: Tuple[str, ...]) -> Dict[str, str]:
    return {name: name for name in members}


def _escaped(name: str) -> str:
    return name.replace("~", "~0").replace("/", "~1")


class _Settler:
    def __init__(self, values: Mapping[str, float]):
        self.values = dict(values)
        self.numbers: List[BoundNumber] = []

    def number(self, value: Any, place: str) -> Any:
        """As it is where no formula is in it."""
        formula = _formula_in(value)
        if formula is not None:
            self.numbers.append(BoundNumber(place, formula))
            return formula.value(self.values)
        if isinstance(value, dict) and any(_formula_in(each) is not None for each in value.values()):
            return {name: self.number(each, place.replace("*", _escaped(name))) for name, each in value.items()}
        if isinstance(value, (list, tuple)) and any(_formula_in(each) is not None for each in value):
            return [self.number(each, f"{place}/{k}") for k, each in enumerate(value)]
        return value

    def record(self, record: Any, prefix: str, places: Mapping[str, str], inner: Optional[Dict[str, Any]] = None) -> Any:
        """With `inner` members in place of its own; itself where nothing changes."""
        found = {name: self.number(getattr(record, name), f"{prefix}/{place}") for name, place in places.items()}
        found.update(inner or {})
        changed = {name: value for name, value in found.items() if value is not getattr(record, name)}
        return dataclasses.replace(record, **changed) if changed else record

    def records(self, records: Any, settle: Callable[[int, Any], Any]) -> Any:
        if not isinstance(records, (list, tuple)) or not all(each is None or dataclasses.is_dataclass(each) for each in records):
            return records  # the scene tells what is wrong
        made = [settle(k, each) for k, each in enumerate(records)]
        return records if all(a is b for a, b in zip(made, records)) else made

    def body(self, k: int, body: Any) -> Any:
        prefix = f"/bodies/{k}"
        rotation = "rotation" if body.orientation.kind == "angles" else "rotation_vector"

        def rate(dof: int, curve: Any) -> Any:
            return curve and self.record(curve, f"{prefix}/prescribed/{_COORDINATES[dof]}", {"rate": "rate"})

        inner = {
            "pose": self.record(body.pose, prefix, {"position": "position"}),
            "orientation": self.record(body.orientation, prefix, {"numbers": rotation}),
            "prescribed": self.records(body.prescribed, rate),
        }
        return self.record(body, prefix, _same_places(_BODY), inner)

    def attachments(self, record: Any, prefix: str) -> Dict[str, Any]:
        inner = {side: self.record(getattr(record, side), prefix, {"point": f"point_{side}", "axis": f"axis_{side}"}) for side in "ab"}
        inner["forces"] = self.record(record.forces, prefix, _same_places(_FORCES))
        return inner

    def joint(self, k: int, joint: Any) -> Any:
        places = {"pitch": "pitch", "swing": "swing", "ratio": "radius" if joint.kind == "rack" else "ratio"}
        return self.record(joint, f"/joints/{k}", places, self.attachments(joint, f"/joints/{k}"))

    def spring(self, k: int, spring: Any) -> Any:
        return self.record(spring, f"/springs/{k}", {}, self.attachments(spring, f"/springs/{k}"))

    def motor(self, k: int, motor: Any) -> Any:
        curve = self.record(motor.curve, f"/motors/{k}/curve", _same_places(("values", "rate")))
        return self.record(motor, f"/motors/{k}", {}, {"curve": curve})

    def load(self, k: int, load: Any) -> Any:
        return self.record(load, f"/loads/{k}", _same_places(("point", "force")))

    def scene(self, scene: Any) -> Any:
        pairs = self.records(scene.friction.pairs, lambda k, pair: self.record(pair, f"/friction/pairs/{k}", {"mu": "mu"}))
        friction = self.record(scene.friction, "", {"mu": "friction/mu", "materials": "materials/*/mu"}, {"pairs": pairs})
        of = scene.mechanism
        parts = {
            "joints": self.records(of.joints, self.joint),
            "springs": self.records(of.springs, self.spring),
            "motors": self.records(of.motors, self.motor),
            "loads": self.records(of.loads, self.load),
        }
        inner = {
            "bodies": self.records(scene.bodies, self.body),
            "friction": friction,
            "mechanism": self.record(of, "", {}, parts),
        }
        return self.record(scene, "", {"gravity": "gravity", "dmin": "contact/dmin"}, inner)


def settled_scene(scene: Scene, values: Mapping[str, float]) -> Tuple[Scene, List[BoundNumber]]:
    """The scene with numbers alone, at these values of the parameters [SI], and what follows from them."""
    settler = _Settler(values)
    return settler.scene(scene), settler.numbers
