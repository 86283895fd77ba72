# SPDX-License-Identifier: MIT
"""Scenes in memory: simulated, certified, stored; arrays, callbacks, interruption."""
import gc
import os
import pickle
import signal
import threading
import time

import numpy as np
import pytest

import fettle
from conftest import box


def falling_cube(height=5.1e-3, steps=10):
    table = fettle.Body("table", type="static", mesh=box(0.05, 0.05, 0.01, "table"), prescribed=fettle.held())
    table.pose.position = [0, 0, -5e-3]
    cube = fettle.Body("cube", mesh=box(0.01, 0.01, 0.01, "cube"), density=1240.0)
    cube.pose.position = [0, 0, height]
    scene = fettle.Scene(bodies=[table, cube], gravity=[0, 0, -9.81], timestep=0.01, end_time=0.01 * steps)
    return fettle.build_model(scene)


def test_a_cube_falls_as_the_implicit_step_has_it():
    model = falling_cube(height=1.0)
    simulation = fettle.simulate(model, steps=10)
    assert simulation.report.status == "ok"
    heights = simulation.trajectory.positions[:, 1, 2]
    steps = np.arange(11)
    assert heights == pytest.approx(1 - 9.81 * 0.01**2 * steps * (steps + 1) / 2, abs=1e-12)
    assert simulation.trajectory.times == pytest.approx(0.01 * steps)
    assert np.array_equal(simulation.trajectory.rotations[:, 1], np.tile(np.eye(3), (11, 1, 1)))
    assert model.mass(1) == pytest.approx(1240 * 1e-6)


def test_certified_and_proven_by_the_checker(tmp_path):
    model = falling_cube()
    trajectory = fettle.simulate(model).trajectory
    certificate = fettle.Certificate()
    done = []
    (pair,) = fettle.certify_clearance(model, trajectory, certificate=certificate, progress=lambda *at: done.append(at))
    assert 0 < pair.lower <= pair.upper <= 1e-4
    assert pair.upper - pair.lower <= 1e-6
    assert pair.solids == "disjoint"
    assert done[-1] == (1, 1)
    assert certificate.check(model, trajectory).accepted
    (assembled,) = fettle.certify_clearance(model, minimum=0.2e-3)
    assert assembled.status == "violated"
    assert assembled.lower <= 0.1e-3 <= assembled.upper + 1e-15
    # As files, and read again: the same path, which the proof still fits.
    certificate.write(str(tmp_path / "fall.certificate.json"))
    fettle.write_trajectory(str(tmp_path / "fall.trajectory.json"), trajectory, model)
    again, stored = fettle.read_trajectory(str(tmp_path / "fall.trajectory.json"))
    assert again == trajectory
    assert fettle.Certificate.read(str(tmp_path / "fall.certificate.json")).check(stored, again).accepted
    other = fettle.simulate(falling_cube(height=5.2e-3)).trajectory
    assert fettle.Certificate.read(str(tmp_path / "fall.certificate.json")).check(model, other).stale


def test_views_outlive_what_they_look_into():
    model = falling_cube()
    trajectory = fettle.simulate(model, steps=2).trajectory
    vertices, triangles = model.vertices(1), model.triangles(1)
    positions, rotations = trajectory.positions_at(-1), trajectory.rotations_at(-1)
    expected = [array.copy() for array in (vertices, triangles, positions, rotations)]
    assert np.array_equal(positions, trajectory.positions[-1])
    assert np.array_equal(rotations, trajectory.rotations[-1])
    assert not vertices.flags.owndata and not vertices.flags.writeable and not positions.flags.writeable
    del model, trajectory
    gc.collect()
    _ = [np.ones(1000) for _ in range(1000)]
    for array, copy in zip((vertices, triangles, positions, rotations), expected):
        assert np.array_equal(array, copy)


def test_trajectories_and_results_pickle():
    simulation = fettle.simulate(falling_cube(), steps=5, outputs=True)
    assert len(simulation.outputs) == 5
    assert simulation.outputs[0].kinetic_energy > 0
    again = pickle.loads(pickle.dumps(simulation))
    assert again == simulation
    assert again.trajectory != fettle.simulate(falling_cube(), steps=4).trajectory
    pairs = fettle.certify_clearance(falling_cube(), simulation.trajectory)
    assert pickle.loads(pickle.dumps(pairs)) == pairs


def test_progress_and_what_it_raises():
    model, steps = falling_cube(), []
    fettle.simulate(model, steps=3, progress=lambda done, of: steps.append((done, of)))
    assert steps == [(1, 3), (2, 3), (3, 3)]

    def fail(done, of):
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        fettle.simulate(model, steps=1000, progress=fail)


def test_ctrl_c_ends_a_long_call():
    model = falling_cube(height=1.0)
    timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        fettle.simulate(model, steps=100_000_000)
    assert time.monotonic() - begin < 30


def test_other_threads_run_meanwhile():
    model, ticks = falling_cube(height=1.0), []
    over = threading.Event()

    def tick():
        while not over.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.monotonic()
    fettle.simulate(model, steps=60_000)
    end = time.monotonic()
    over.set()
    thread.join()
    during = [t for t in ticks if begin < t < end]
    assert len(during) > 10
    assert len(during) > (end - begin) / 0.1


def test_what_does_not_fit_is_refused():
    model = falling_cube()
    with pytest.raises(IndexError):
        model.vertices(2)
    with pytest.raises(ValueError, match="two bodies"):
        fettle.certify_clearance(model, pairs=[fettle.PairRequest(1, 1)])
    with pytest.raises(IndexError):
        fettle.certify_clearance(model, pairs=[fettle.PairRequest(0, 7)])
    with pytest.raises(fettle.Error, match="intersect") as found:
        falling_cube(height=4e-3)
    assert found.value.code == "bodies_intersect"


def arm():
    """A bar on a hinge that turns by 60 degrees each way, and a post beyond."""
    bar = fettle.Body("bar", mesh=box(0.04, 0.008, 0.004))
    bar.pose.position = ["20mm", 0, 0]
    post = fettle.Body("post", type="static", mesh=box(0.004, 0.004, 0.02), prescribed=fettle.held())
    post.pose.position = [0, "30mm", 0]
    limits = fettle.CoordinateForces(limits=["-60deg", "60deg"])
    hinge = fettle.Joint("hinge", b=fettle.Attachment("bar", point=["-20mm", 0, 0]), forces=limits)
    return fettle.build_model(fettle.Scene(bodies=[bar, post], mechanism=fettle.Mechanism(joints=[hinge])))


def test_clearance_over_the_ranges_of_joints(tmp_path):
    model = arm()
    ranges = fettle.joint_ranges(model)
    assert repr(ranges).startswith(f"JointRanges({len(ranges.coordinates)} coordinate")
    (hinge,) = ranges.coordinates
    assert hinge.joints[0].joint == "hinge" and hinge.joints[0].is_angle and not hinge.is_whole_turn
    assert (hinge.low, hinge.high) == pytest.approx((-np.pi / 3, np.pi / 3)) and ranges.held == []
    certificate, done = fettle.Certificate(), []
    found = fettle.certify_ranges(
        model, [("post", "bar", "1mm")], ranges=ranges, certificate=certificate, progress=lambda *at: done.append(at)
    )
    pair = found.pair("bar", "post")
    # By hand: the bar at 60 degrees, a rectangle of 40 x 8 mm from the hinge, and the square of 4 mm round (0, 30).
    turn = np.array([[0.5, -np.sqrt(0.75)], [np.sqrt(0.75), 0.5]])
    by_hand = (turn.T @ [2e-3, 28e-3])[1] - 4e-3
    assert pair.lower <= by_hand <= pair.upper and pair.upper - pair.lower <= 1e-5
    assert pair.status == "clear" and pair.solids == "disjoint" and done[-1] == (1, 1)
    assert pair.coordinates == [0] and pair.at == pytest.approx([np.pi / 3], abs=1e-3)
    pose = fettle.pose_at_witness(model, ranges, pair, "bar")
    assert pose.position == pytest.approx([0.01, 0.02 * np.sqrt(0.75), 0], abs=1e-4)
    certificate.write(tmp_path / "arm.certificate.json")
    assert fettle.Certificate.read(tmp_path / "arm.certificate.json").check(model).accepted
    (violated,) = fettle.certify_ranges(model, minimum="15mm", tolerance="1um")
    assert violated.status == "violated" and violated.tolerance == 1e-6
    with pytest.raises(fettle.Error, match="no joint"):
        fettle.certify_ranges(falling_cube())
    with pytest.raises(fettle.Error, match="not of this model"):
        fettle.certify_ranges(fettle.build_model(fettle.Scene(bodies=[fettle.Body("cube", mesh=box(1, 1, 1))])), [], ranges=ranges)
