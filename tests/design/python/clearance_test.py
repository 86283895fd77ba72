# SPDX-License-Identifier: MIT
"""`fettle.clearance`: what the command asks and answers, the same rows for the same question."""
import json
import pathlib
import subprocess

import pytest

import fettle
from conftest import EXAMPLES, box
from simulation_test import arm, falling_cube

PROGRAM = pathlib.Path(fettle.__file__).parents[2] / "bin" / "fettle"
TWO_ARM = EXAMPLES / "two_arm" / "two_arm.scene.json"


def plates(places, ignore=()):
    """Boxes of 10 mm at these places [m] along x."""
    bodies = []
    for name, x in places.items():
        body = fettle.Body(name, type="static", mesh=box(0.01, 0.01, 0.01), prescribed=fettle.held())
        body.pose.position = [x, 0, 0]
        bodies.append(body)
    return fettle.build_model(fettle.Scene(bodies=bodies, ignore=list(ignore)))


def test_what_a_scene_ignores_is_listed_and_judged_only_by_name():
    model = plates({"left": 0, "middle": 0.005, "right": 0.03}, ignore=["mid*:left"])
    assert not model.may_collide("left", "middle")
    report = fettle.clearance(model)
    assert report["ignored_by_scene"] == ["left:middle"] and report["joined"] == [] and len(report.pairs) == 2
    assert report.status == "clear" and fettle.clearance(model, pairs="left:middle").status == "violated"
    with pytest.raises(fettle.Error, match="there is no body"):
        plates({"left": 0, "right": 0.03}, ignore=["lift:right"])


def test_groups_patterns_and_minima_of_their_own():
    model = plates({"left": 0, "middle": 0.012, "right": 0.03, "far": 0.1})
    report = fettle.clearance(model, minimum="3mm", groups={"both": ["left", "middle"]}, ignore="far:*")
    assert report.status == "clear" and [row["finding"] for row in report.pairs] == ["clear"]
    row = report.pair("right", "both")
    assert row["body_a" if row["a"] == "both" else "body_b"] == "middle" and row["lower"] == pytest.approx(8e-3, abs=1e-6)
    assert sorted(report["ignored"]) == ["right:far", "far:both"] or len(report["ignored"]) == 2
    strict = fettle.clearance(model, pairs=["left:middle=2.5mm", "*:right=1mm"])
    assert strict.status == "violated" and strict.pairs[0]["finding"] == "below threshold"
    assert strict.pair("left", "middle")["required_by"] == "--pairs"
    assert "violated, as assembled" in repr(strict) and "left:middle" in strict._repr_html_()
    with pytest.raises(KeyError, match="did you mean 'left'"):
        strict.pair("lefft", "middle")
    told = fettle.clearance(model)
    assert told["minimum"] is None and len(told.pairs) == 6
    touching = plates({"lid": 0, "base": 0.01})
    assert fettle.clearance(touching, minimum="1mm").pairs[0]["finding"] == "touching"
    assert fettle.clearance(touching, minimum="1mm", allow_touch="lid:base").status == "clear"
    assert fettle.clearance(plates({"a": 0, "b": 0.05}), process="fdm").pairs[0]["required_by"] == "--process fdm"


def test_against_an_earlier_report_whoever_wrote_it(tmp_path):
    model = falling_cube()
    trajectory = fettle.simulate(model).trajectory
    strict = fettle.clearance(model, trajectory, pairs="cube:table=5mm")
    assert strict.status == "violated" and strict["steps"] == len(trajectory.times) - 1
    strict.write(tmp_path / "before.json")
    loose = fettle.clearance(model, trajectory, pairs="cube:table", baseline=tmp_path / "before.json")
    assert loose["baseline"]["resolved"] == 1 and loose.pairs[0]["change"] == "resolved"
    with pytest.raises(fettle.Error, match="none.json"):
        fettle.clearance(model, baseline=tmp_path / "none.json")


def test_over_ranges_as_the_command_does(tmp_path):
    if not PROGRAM.exists():
        pytest.skip("the program was not built")
    model = fettle.build_model(fettle.read_scene(TWO_ARM), check_start=False)
    done = []
    report = fettle.clearance(model, ranges=True, minimum="5mm", pairs="post:*_hand", proof=True, progress=lambda *at: done.append(at))
    command = [str(PROGRAM), "clearance", str(TWO_ARM), "--ranges", "--minimum", "5mm", "--pairs", "post:*_hand", "--json"]
    command += ["--certificate", str(tmp_path / "fit.certificate.json")]
    told = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
    for key in ("status", "minimum", "least", "tolerance", "source", "pairs", "ignored", "left_out", "uncovered", "notes"):
        assert report[key] == told[key], key
    assert report["tolerance"] == 1e-6 and done[-1] == (2, 2)
    assert {c["joint"] for c in report.pair("post", "left_hand")["coordinates"]} == {"left_shoulder", "left_elbow"}
    assert report.certificate.check(model).accepted
    ranges = fettle.joint_ranges(model)
    assert fettle.clearance(model, ranges=ranges, minimum="5mm", pairs="post:left_hand").pairs[0]["status"] == "clear"
    assert fettle.clearance(model, ranges=ranges, minimum="5mm", pairs="post:left_hand").certificate is None


def test_what_is_refused_is_named_as_the_argument_is():
    model = plates({"left": 0, "right": 0.03})

    def refused(where, part, **arguments):
        with pytest.raises(fettle.Error, match=part) as found:
            fettle.clearance(model, **arguments)
        assert found.value.where == where

    refused("pairs", "did you mean", pairs="lefft:right")
    refused("ignore", "is not a pair", ignore="left")
    refused("groups", "is a body's name", groups={"left": ["right"]})
    refused("allow_touch", "is not a pair", allow_touch=["left"])
    refused("process", "fdmm", process="fdmm")
    refused("minimum", "0 or more", minimum=-1.0)
    refused("tolerance", "more than 0", tolerance=0.0)
    refused("groups", "a dict", groups=["a"])
    refused("pairs", "a list", pairs=3)
    refused("ranges", "True or JointRanges", ranges="all")
    with pytest.raises(fettle.Error, match="in place of a trajectory"):
        fettle.clearance(arm(), fettle.as_assembled(arm()), ranges=True)
    with pytest.raises(fettle.Error, match="no steps"):
        fettle.clearance(model, fettle.as_assembled(model))
    with pytest.raises(fettle.Error, match="touches are not reported"):
        fettle.clearance(arm(), ranges=True, allow_touch="post:bar")


def test_features_are_what_the_command_says():
    crank = EXAMPLES / "slider_crank" / "slider_crank.scene.json"
    model = fettle.build_model(fettle.read_scene(crank), check_start=False)
    found = fettle.features(model, process="fdm", triangles=True)
    told = subprocess.run([PROGRAM, "features", crank, "--process", "fdm", "--json", "--triangles"], capture_output=True, text=True)
    assert found == json.loads(told.stdout)
    assert any(fit["gap"]["proven"] for fit in found["fits"])
    with pytest.raises(fettle.Error, match="more than 0"):
        fettle.features(model, tolerance=0.0)


def test_free_ranges_are_what_the_command_says():
    model = fettle.build_model(fettle.read_scene(TWO_ARM), check_start=False)
    found = fettle.free_ranges(model, joints="left_elbow", minimum="1mm", angle="0.1deg")
    told = subprocess.run(
        [PROGRAM, "ranges", TWO_ARM, "--joint", "left_elbow", "--minimum", "1mm", "--tolerance", "0.1deg", "--json"],
        capture_output=True, text=True, check=True)
    assert found == json.loads(told.stdout)
    with pytest.raises(fettle.Error, match="left_elbow"):
        fettle.free_ranges(model, joints=["left_elbw"])
    with pytest.raises(fettle.Error, match="0 or more"):
        fettle.free_ranges(model, minimum=-1.0)
