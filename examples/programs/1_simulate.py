# SPDX-License-Identifier: MIT
"""A scene made in memory: a cube falls 1 mm onto a table, and comes to rest. SI units throughout."""
import fettle


def box(side, height):
    mesh, _ = fettle.Part("box", {"size_x": side, "size_y": side, "size_z": height}).at({})
    return mesh


table = fettle.Body("table", type="static", mesh=box(0.05, 0.01), prescribed=fettle.held())
table.pose.position = [0, 0, -0.005]
cube = fettle.Body("cube", mesh=box(0.01, 0.01), density=1240)
cube.pose.position = [0, 0, 0.006]
scene = fettle.Scene(bodies=[table, cube], gravity=[0, 0, -9.81], timestep=0.005, end_time=0.2)

simulation = fettle.simulate(fettle.build_model(scene))
trajectory = simulation.trajectory
for time, position in zip(trajectory.times[::10], trajectory.positions[::10, 1]):
    print(f"{time:.3f} s: the cube's middle is at {1000 * position[2]:.4f} mm")
height = trajectory.positions[-1, 1, 2] - 0.005
print(f"{simulation.report.status}: {len(trajectory)} steps, {1000 * height:.4f} mm above the table")
