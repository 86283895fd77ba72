# SPDX-License-Identifier: MIT
"""A design as an OpenMDAO component: `Mechanism(problem)` has the parameters for inputs, the objective and the constraints for outputs, and
their exact partial derivatives: python3 openmdao_component.py [DESIGN]. OpenMDAO is not in Debian: where it is not installed, a stand-in
below shows how the component is called."""
import pathlib
import sys

import numpy as np

import fettle

try:
    from openmdao.api import ExplicitComponent
except ImportError:

    class ExplicitComponent:  # type: ignore[no-redef]
        """What OpenMDAO does with a component, as far as this example needs it."""

        def __init__(self):
            self.inputs, self.outputs, self.partials = {}, {}, {}
            self.setup()

        def add_input(self, name, val):
            self.inputs[name] = np.array(val, float)

        def add_output(self, name, shape=1):
            self.outputs[name] = np.zeros(shape)

        def declare_partials(self, of, wrt):
            self.partials[of, wrt] = None

        def run(self, **inputs):
            self.inputs.update({name: np.array(value, float) for name, value in inputs.items()})
            self.compute(self.inputs, self.outputs)
            self.compute_partials(self.inputs, self.partials)
            return self.outputs, self.partials


class Mechanism(ExplicitComponent):
    """Inputs `p` (SI); outputs `objective` and `constraints`."""

    def __init__(self, problem: fettle.DesignProblem):
        self.problem = problem
        self.last = (None, None)
        super().__init__()

    def setup(self):
        self.add_input("p", val=self.problem.values)
        self.add_output("objective")
        self.add_output("constraints", shape=max(1, len(self.problem.design.constraints)))
        for output in ("objective", "constraints"):
            self.declare_partials(output, "p")

    def at(self, p):
        if self.last[0] != p.tobytes():
            self.last = (p.tobytes(), self.problem.values_and_jacobians(p))
        return self.last[1]

    def compute(self, inputs, outputs):
        outputs["objective"], _, outputs["constraints"], _ = self.at(inputs["p"])

    def compute_partials(self, inputs, partials):
        _, partials["objective", "p"], _, partials["constraints", "p"] = self.at(inputs["p"])


if __name__ == "__main__":
    slider_crank = pathlib.Path(__file__).resolve().parent.parent / "slider_crank" / "slider_crank.design.json"
    design = fettle.read_design(sys.argv[1] if len(sys.argv) > 1 else str(slider_crank)).design
    design.steps = min(design.steps, 5)
    component = Mechanism(fettle.DesignProblem(design))
    if hasattr(component, "run"):
        outputs, partials = component.run()
        print(f"objective {outputs['objective']:.6g}, {len(outputs['constraints'])} constraints, d objective/dp {partials['objective', 'p']}")
