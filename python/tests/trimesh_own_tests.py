"""trimesh's own tests of its collision manager, run with ours.

Assertions that need convex solids or depths are listed, each with its reason. A listed one that holds is an error, and so is one
that trimesh's file does not have.
"""

import ast
import logging
import sys
import types
import unittest

import numpy as np
import trimesh
import trimesh.collision

SOLID = "a convex mesh is a solid to FCL, with a depth: meshes are surfaces here"
DEPTH = "depths are not computed: the distance of two that collide is 0"
LISTED = {
    "g.np.allclose(c.point, g.np.array([5.0, -0.5, 0.5]))": SOLID,
    "g.np.isclose(c.depth, 1.0)": SOLID,
    "g.np.allclose(c.normal, g.np.array([-1.0, 0.0, 0.0]))": SOLID,
    "g.np.isclose(dist, -0.25)": DEPTH,
    "test_scene": "its model is not in trimesh's source package",
}


class _Listed(ast.NodeTransformer):
    """Puts a record of the outcome in the place of each listed assertion."""

    def visit_Assert(self, node):
        text = ast.unparse(node.test)
        return ast.parse(f"_record({text!r}, lambda: {text})").body[0] if text in LISTED else node


def run(source):
    """Run a source of tests with the manager that trimesh.collision has, and return all faults, a sentence each."""
    outcomes = {}

    def record(text, holds):
        try:
            outcome = bool(holds())
        except NotImplementedError:
            outcome = False
        outcomes.setdefault(text, []).append(outcome)

    # The tests skip without FCL. An empty module shows that they run without it.
    modules = {"generic": _generic(), "fcl": types.ModuleType("fcl")}
    kept = {name: sys.modules.get(name) for name in modules}
    sys.modules.update(modules)
    try:
        space = {"__name__": "own_tests", "_record": record}
        exec(compile(ast.fix_missing_locations(_Listed().visit(ast.parse(source))), "own_tests", "exec"), space)
        faults = []
        for kind in [value for value in space.values() if isinstance(value, type) and issubclass(value, unittest.TestCase)]:
            for test in unittest.defaultTestLoader.loadTestsFromTestCase(kind):
                result = unittest.TestResult()
                test.run(result)
                name = test._testMethodName
                if name in LISTED:
                    outcomes[name] = [result.wasSuccessful()]
                else:
                    faults += [f"{name}: {trace}" for _, trace in result.errors + result.failures]
    finally:
        for name, module in kept.items():
            sys.modules.pop(name)
            if module is not None:
                sys.modules[name] = module
    faults += [f"{name} is listed, and no test has it" for name in LISTED if name not in outcomes]
    faults += [f"{name} is listed ({LISTED[name]}), and holds" for name, held in outcomes.items() if all(held)]
    return faults


def _generic():
    """What the tests take from trimesh's module of that name, which its source package lacks."""
    generic = types.ModuleType("generic")
    generic.np, generic.trimesh, generic.unittest = np, trimesh, unittest
    generic.log, generic.random = logging.getLogger("trimesh"), np.random.default_rng(0).random

    def get_mesh(name):
        if name != "unit_cube.STL":
            raise FileNotFoundError(name)
        return trimesh.creation.box()

    generic.get_mesh = get_mesh
    return generic
