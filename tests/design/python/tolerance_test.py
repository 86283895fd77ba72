# SPDX-License-Identifier: MIT
"""Designs as made."""
import json

import numpy as np
import pytest

import fettle

SCENE = {
    "fettle_scene": 1,
    "units": "mm",
    "variables": {"length": "10 mm"},
    "bodies": [{"name": "block", "density": 1000, "shape": {"part": "box", "dimensions": {"size_x": "= length", "size_y": 10, "size_z": 10}}}],
}
DESIGN = {
    "fettle_design": 1,
    "scene": "block.scene.json",
    "units": "mm",
    "parameters": [{"name": "depth", "value": 10, "lower": 5, "upper": 20}],
    "set": {"/bodies/block/shape/dimensions/size_y": "= depth"},
    "objective": [{"type": "mass", "bodies": ["block"]}],
    "constraints": [{"type": "mass", "name": "mass", "bodies": ["block"], "upper": "1.02 g"}],
    "tolerances": {"depth": "+-0.3 mm", "length": "h10"},
}


@pytest.fixture
def block(tmp_path):
    (tmp_path / "block.scene.json").write_text(json.dumps(SCENE))
    (tmp_path / "block.design.json").write_text(json.dumps(DESIGN))
    return tmp_path / "block.design.json"


def test_samples_are_what_the_parts_weigh(block, tmp_path):
    seen = []
    report = fettle.tolerance(block, samples=20, samples_file=str(tmp_path / "made.jsonl"), progress=lambda done, of: seen.append((done, of)))
    assert report.status == "ok"
    assert seen[-1] == (25, 25)  # as drawn, two for each tolerance, the samples
    names = [tolerance["of"] for tolerance in report["tolerances"]]
    depth, length = (report.deviations[:, names.index(name)] for name in ("depth", "length"))
    np.testing.assert_allclose(report.values[:, 1], 1e3 * (10e-3 + length) * (10e-3 + depth) * 10e-3, rtol=1e-9)
    assert report.response("mass")["linear"]["standard_deviation"] == pytest.approx(
        0.1 * np.hypot(0.1e-3, 58e-6 / 6), rel=1e-6
    )
    assert "20 samples" in repr(report) and "mass" in report._repr_html_()
    with pytest.raises(KeyError, match="did you mean"):
        report.response("mas")


def test_samples_of_a_file_are_not_made_again(block, tmp_path):
    kept = str(tmp_path / "made.jsonl")
    few = fettle.tolerance(block, samples=5, samples_file=kept, second_order=False)
    seen = []
    more = fettle.tolerance(block, samples=8, samples_file=kept, second_order=False, progress=lambda done, of: seen.append((done, of)))
    assert seen[-1] == (4, 4)  # as drawn, and three samples
    np.testing.assert_array_equal(more.values[:5], few.values)
    np.testing.assert_array_equal(more.values, fettle.tolerance(block, samples=8).values)
    with pytest.raises(fettle.Error, match="another design, version, seed"):
        fettle.tolerance(block, samples=5, seed=2, samples_file=kept)


def test_another_process_and_what_it_leaves_out(block):
    text = json.loads(block.read_text())
    text["process"], text["tolerances"] = "fdm", {"*": "length"}
    block.write_text(json.dumps(text))
    spread = {}
    for process in ("", "sla"):
        report = fettle.tolerance(block, second_order=False, process=process)
        assert report["process"] == (process or "fdm")
        spread[process] = report.response("mass")["linear"]["standard_deviation"]
    assert spread["sla"] < spread[""]
    assert report["untoleranced"] == []


def test_what_is_missing_is_told(block):
    text = json.loads(block.read_text())
    del text["tolerances"]
    block.write_text(json.dumps(text))
    with pytest.raises(fettle.Error, match="no `tolerances`"):
        fettle.tolerance(block)
    with pytest.raises(fettle.Error, match="samples"):
        fettle.tolerance(block, samples=-1)


def test_samples_of_workers_are_the_same(block, tmp_path):
    alone = fettle.tolerance(block, samples=12, seed=3)
    for workers in (1, 3):
        seen = []
        shared = fettle.tolerance(block, samples=12, seed=3, workers=workers, progress=lambda done, of: seen.append((done, of)))
        np.testing.assert_array_equal(shared.values, alone.values)
        np.testing.assert_array_equal(shared.deviations, alone.deviations)
        assert shared.answer == alone.answer
        assert seen[-1] == (17, 17) and len(seen) == 17
    # Kept samples are not made again, and those of workers go on with those of threads.
    kept = str(tmp_path / "made.jsonl")
    fettle.tolerance(block, samples=5, seed=3, samples_file=kept)
    seen = []
    more = fettle.tolerance(block, samples=12, seed=3, samples_file=kept, workers=2, progress=lambda done, of: seen.append((done, of)))
    assert seen[-1] == (12, 12)
    assert more.answer == alone.answer
    assert len(open(kept).readlines()) == 13
    assert fettle.tolerance(block, workers=2).answer == fettle.tolerance(block).answer


def test_workers_of_what_cannot_be(block, tmp_path):
    with pytest.raises(fettle.Error, match="workers"):
        fettle.tolerance(block, samples=2, workers=0)
    with pytest.raises(fettle.Error, match="none.design.json"):
        fettle.tolerance(tmp_path / "none.design.json", samples=2, workers=1)
    with pytest.raises(fettle.Error, match="dask"):
        fettle.tolerance(block, samples=2, dask="nowhere")
    with pytest.raises(fettle.Error):
        fettle.tolerance(block, samples=2, workers=1, samples_file=str(tmp_path))


def test_a_robust_design_has_values_and_gradients(block):
    text = json.loads(block.read_text())
    text["over_tolerances"] = {"sigma": 3}
    text["tolerances"] = {"depth": "+-0.3 mm", "length": "+-0.6 mm"}
    block.write_text(json.dumps(text))
    problem = fettle.DesignProblem.of_file(block)
    for depth in (9.5e-3, 10e-3):
        _, _, values, jacobian = problem.values_and_jacobians([depth])
        # Mass 1 g/cm^3 length depth height, with sigma 0.1 mm of the depth and 0.2 mm of the length.
        sigma = 10.0 * np.hypot(10e-3 * 0.1e-3, depth * 0.2e-3)
        assert values[0] == pytest.approx(10.0 * 10e-3 * depth + 3 * sigma, rel=1e-9)
        slope = 10.0 * depth * 0.2e-3**2 / np.hypot(10e-3 * 0.1e-3, depth * 0.2e-3)
        assert jacobian[0, 0] == pytest.approx(10.0 * 10e-3 + 3 * slope, rel=1e-5)
    with pytest.raises(fettle.Error, match="over_tolerances"):
        problem.design
    with pytest.raises(fettle.Error, match="of_file"):
        fettle.read_design(block)
    with pytest.raises(fettle.Error, match="nowhere"):
        fettle.DesignProblem.of_file("nowhere.design.json")
