# SPDX-License-Identifier: MIT
"""A clearance that is proven: a hammer on a hinge swings past a post; how near does it come, over the whole continuous motion? The proof is
data, and is checked without the search that found it."""
import fettle


def box(x, y, z):
    mesh, _ = fettle.Part("box", {"size_x": x, "size_y": y, "size_z": z}).at({})
    return mesh


hammer = fettle.Body("hammer", mesh=box(0.04, 0.01, 0.01))
post = fettle.Body("post", type="static", mesh=box(0.01, 0.01, 0.01), prescribed=fettle.held())
post.pose.position = [-0.02, 0, -0.0465]  # its upper edge is just out of the hammer's reach
hinge = fettle.Joint("hinge")
hinge.a = fettle.Attachment("", [-0.02, 0, 0], [0, 1, 0])
hinge.b = fettle.Attachment("hammer", [-0.02, 0, 0], [0, 1, 0])
scene = fettle.Scene(bodies=[hammer, post], gravity=[0, 0, -9.81], end_time=0.5)
scene.mechanism.joints.append(hinge)

model = fettle.build_model(scene)
trajectory = fettle.simulate(model).trajectory
certificate = fettle.Certificate()
(pair,) = fettle.certify_clearance(model, trajectory, minimum=0.3e-3, certificate=certificate)
nearest = pair.witness.time
print(f"{pair.status}: at least {1000 * pair.lower:.4f} mm, at most {1000 * pair.upper:.4f} mm, nearest at {nearest:.3f} s")
check = certificate.check(model, trajectory)
print(f"the certificate is {'accepted' if check.accepted else 'rejected'}: {check.leaves} leaves")
assert pair.status == "clear" and check.accepted
