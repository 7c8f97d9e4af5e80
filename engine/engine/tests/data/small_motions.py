"""Equilibria and small motions of random mechanisms, from their energies alone.

Nothing of Triad is used, and no equation of motion either: joints are scalar functions of the poses that are zero, loads are an
energy V and the coordinates x of dampers. A position rests where the gradient of V + λᵀΦ is zero, and its small motions z along
the null space N of Φ' solve (κ² Nᵀ M N + κ Nᵀ Σ d x' x'ᵀ N + Nᵀ (V + λᵀΦ)'' N) z = 0. Gradients are those of a complex step, exact
to rounding; second derivatives are differences of order four of them. It needs numpy and scipy (BSD):

    python3 -m venv small && small/bin/pip install numpy==2.4.6 scipy==1.17.1
    small/bin/python engine/engine/tests/data/small_motions.py > engine/engine/tests/data/small-motions.json
"""

import json
import math

import numpy as np
from random_mechanisms import Draw, beside, unit
from scipy.linalg import eig, eigh, null_space

SCENES = 40
TINY = 1e-30  # the complex step


def cross_matrix(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def turned(turn):
    """A rotation about `turn`, by its length but for its third power: rational, so that complex steps pass."""
    half = cross_matrix(turn) / 2
    return np.linalg.solve(np.eye(3) - half, np.eye(3) + half)


def across(axis):
    """Two unit vectors across another."""
    first = unit(cross_matrix(axis)[np.argmin(abs(axis))])
    return first, cross_matrix(axis) @ first


class Mechanism:
    """A scene of Triad with points and axes in the frames of its bodies."""

    def __init__(self, scene):
        self.scene = scene
        self.gravity = np.array(scene["gravity"])
        self.index = {body["name"]: k for k, body in enumerate(scene["bodies"])}
        self.centers = [np.array(body["center_of_mass"]) for body in scene["bodies"]]
        self.joints = {joint["name"]: joint for joint in scene["joints"]}
        self.stated = []
        for body, center in zip(scene["bodies"], self.centers):
            u, v = (np.array(body["orientation"][key]) for key in "uv")
            axes = np.column_stack([u, v, np.cross(u, v)])
            self.stated.append((np.array(body["position"]) + axes @ center, axes))
        self.length = max(np.linalg.norm(r) for r, _ in self.stated)
        # Angles of joints as they were last: from there they are counted on.
        self.angles = {name: 0.0 for name, joint in self.joints.items() if joint["type"] in ("revolute", "cylindrical", "screw")}

    def frame(self, poses, body):
        return (np.zeros(3), np.eye(3)) if body == "ground" else poses[self.index[body]]

    def point(self, poses, body, local):
        r, axes = self.frame(poses, body)
        return np.array(local) if body == "ground" else r + axes @ (np.array(local) - self.centers[self.index[body]])

    def ends(self, poses, element):
        return [self.point(poses, element["body_" + side], element["point_" + side]) for side in "ij"]

    def relative(self, poses, joint):
        """Rotation of body j in body i since the stated position."""
        (_, i), (_, j) = (self.frame(poses, joint["body_" + side]) for side in "ij")
        (_, i0), (_, j0) = (self.frame(self.stated, joint["body_" + side]) for side in "ij")
        return i.T @ j @ j0.T @ i0

    def angle(self, poses, name):
        joint, before = self.joints[name], self.angles[name]
        first, second = across(unit(joint["axis_i"]))
        moved = self.relative(poses, joint) @ first
        sine, cosine = second @ moved, first @ moved
        c, s = math.cos(before), math.sin(before)
        return before + np.arctan((sine * c - cosine * s) / (cosine * c + sine * s))

    def slide(self, poses, joint):
        p, q = self.ends(poses, joint)
        return (self.frame(poses, joint["body_i"])[1] @ unit(joint["axis_i"])) @ (q - p)

    def rows(self, poses):
        return np.concatenate([np.atleast_1d(self.rows_of(poses, joint)) for joint in self.scene["joints"]])

    def rows_of(self, poses, joint):
        kind = joint["type"]
        if kind == "gear":
            first, second = joint["joints"]
            return (self.angle(poses, second) - joint["ratio"] * self.angle(poses, first)) * self.length
        p, q = self.ends(poses, joint)
        if kind == "rod":
            return ((q - p) @ (q - p) - joint["length"] ** 2) / (2 * joint["length"])
        if kind == "spherical":
            return q - p
        i, j = (self.frame(poses, joint["body_" + side])[1] for side in "ij")
        if kind == "fixed":
            turn = self.relative(poses, joint)
            return np.concatenate([q - p, self.length * np.array([turn[2, 1], turn[0, 2], turn[1, 0]])])
        axis = unit(joint["axis_i"])
        if kind == "universal":
            return np.append(q - p, self.length * (i @ axis) @ (j @ unit(joint["axis_j"])))
        side_rows = np.array([(i @ side) @ (q - p) for side in across(axis)])
        if kind == "point-on-line":
            return side_rows
        if kind == "point-in-plane":
            return self.slide(poses, joint)
        parallel = self.length * np.array([(i @ side) @ (j @ unit(joint["axis_j"])) for side in across(axis)])
        if kind == "revolute":
            return np.concatenate([q - p, parallel])
        if kind == "planar":
            return np.append(parallel, self.slide(poses, joint))
        rows = np.concatenate([parallel, side_rows])
        if kind == "prismatic":
            first, second = across(axis)
            return np.append(rows, self.length * second @ self.relative(poses, joint) @ first)
        if kind == "screw":
            turned_by = self.angle(poses, joint["name"])
            return np.append(rows, self.slide(poses, joint) - joint["pitch"] / math.tau * turned_by)
        assert kind == "cylindrical"
        return rows

    def coordinate(self, poses, load):
        if load["type"] == "spring":
            p, q = self.ends(poses, load)
            return np.sqrt((q - p) @ (q - p)) - load["free_length"]
        if load["type"] == "torsion":
            return self.angle(poses, load["joint"]) - load["free_angle"]
        return self.slide(poses, self.joints[load["joint"]]) - load["free_length"]

    def energy(self, poses):
        weights = sum(body["mass"] * self.gravity @ r for body, (r, _) in zip(self.scene["bodies"], poses))
        return sum(load["stiffness"] / 2 * self.coordinate(poses, load) ** 2 for load in self.scene["loads"]) - weights

    def moved(self, poses, z):
        """Poses after small motions, arcs measured at the mechanism's length."""
        out = []
        for k, (r, axes) in enumerate(poses):
            out.append((r + z[6 * k : 6 * k + 3], turned(z[6 * k + 3 : 6 * k + 6] / self.length) @ axes))
        return out

    def slope(self, function, poses, basis=None, at=0.0):
        """Gradient, or Jacobian, of a function of the poses along a basis, at a small motion away from them."""
        basis = np.eye(6 * len(poses)) if basis is None else basis
        columns = [function(self.moved(poses, at + 1j * TINY * z)) for z in basis.T]
        return np.array(columns).imag.T / TINY

    def closed(self, poses):
        for _ in range(20):
            open_by = self.rows(poses)
            if max(abs(open_by)) < 1e-15 * self.length:
                break
            poses = self.moved(poses, -np.linalg.lstsq(self.slope(self.rows, poses), open_by)[0])
        return poses

    def take(self, poses):
        """Counts the angles of joints on."""
        self.angles = {name: float(self.angle(poses, name)) for name in self.angles}

    def held(self, poses, orders=(1, 2)):
        """Null space, gradient along it and stiffness at a position, by differences of order two or four."""
        rows, gradient = self.slope(self.rows, poses), self.slope(self.energy, poses)
        basis = null_space(rows, rcond=1e-10)
        multipliers = np.linalg.lstsq(rows.T, -gradient)[0]

        def function(at):
            return self.energy(at) + multipliers @ self.rows(at)

        step = 1e-3 * self.length
        columns = []
        for z in basis.T:
            changes = [self.slope(function, poses, basis, k * step * z) - self.slope(function, poses, basis, -k * step * z) for k in orders]
            columns.append((8 * changes[0] - changes[1]) / (12 * step) if len(orders) > 1 else changes[0] / (2 * step))
        stiffness = np.array(columns)
        return basis, basis.T @ gradient, (stiffness + stiffness.T) / 2

    def rest(self):
        """The position of rest below the stated one, by Newton's method downhill; `None` if it is not found."""
        poses = self.closed(self.stated)
        self.take(poses)
        if null_space(self.slope(self.rows, poses), rcond=1e-10).size == 0:
            return None
        left = math.inf
        for _ in range(40):
            basis, gradient, stiffness = self.held(poses, (1,))
            values, motions = eigh(stiffness)
            size = max(abs(gradient))
            if size < 1e-10 * max(abs(values)) * self.length and size > left / 4:
                return poses
            left = size
            along = motions.T @ gradient
            step = -basis @ motions @ (along / np.maximum(abs(values), 1e-9 * max(abs(values))))
            step *= min(1, 0.5 * self.length / max(np.linalg.norm(step), 1e-300))
            here = self.energy(poses)
            for _ in range(30):
                there = self.closed(self.moved(poses, step))
                if self.energy(there) <= here + 1e-13 * abs(here):
                    break
                step /= 4
            poses = there
            self.take(poses)
        return None

    def eigenvalues(self, poses):
        """Those of the upper half plane; `None` if the position is not stable, or not the only one near by."""
        basis, _, stiffness = self.held(poses)
        mass = np.zeros((basis.shape[0], basis.shape[0]))
        for k, (body, (_, axes)) in enumerate(zip(self.scene["bodies"], poses)):
            mass[6 * k : 6 * k + 3, 6 * k : 6 * k + 3] = body["mass"] * np.eye(3)
            inertia = axes @ np.array(body["inertia"]["tensor"]) @ axes.T / self.length**2
            mass[6 * k + 3 : 6 * k + 6, 6 * k + 3 : 6 * k + 6] = inertia
        mass = basis.T @ mass @ basis
        damping = np.zeros_like(mass)
        for load in self.scene["loads"]:
            along = basis.T @ self.slope(lambda at, load=load: self.coordinate(at, load), poses)
            damping += load["damping"] * np.outer(along, along)
        n = len(mass)
        zero, one = np.zeros((n, n)), np.eye(n)
        values = eig(np.block([[zero, one], [-stiffness, -damping]]), np.block([[one, zero], [zero, mass]]), right=False)
        stiffnesses = eigh(stiffness, eigvals_only=True)
        if stiffnesses[0] < 1e-5 * stiffnesses[-1]:
            return None
        real = abs(values.imag) < 1e-9 * abs(values)
        values = np.where(real, values.real, values)[real | (values.imag > 0)]
        return sorted(values, key=lambda x: (x.imag, x.real))


def started(scene, draw):
    """The scene near its position of rest, so that there is no doubt which one is meant; `None` if it has none."""
    mechanism = Mechanism(scene)
    rest = mechanism.rest()
    if rest is None:
        return None
    basis = mechanism.held(rest)[0]
    away = basis @ np.array([draw.within(-1, 1) for _ in range(basis.shape[1])])
    poses = mechanism.closed(mechanism.moved(rest, 0.05 * mechanism.length * away / np.linalg.norm(away)))
    mechanism.take(poses)
    for body, center, (r, axes) in zip(scene["bodies"], mechanism.centers, poses):
        body["position"] = (r - axes @ center).tolist()
        body["orientation"] = {"u": axes[:, 0].tolist(), "v": axes[:, 1].tolist()}
    for load in scene["loads"]:
        if load["type"] == "torsion":
            load["free_angle"] -= mechanism.angles[load["joint"]]
    for joint in scene["joints"]:
        # Slides of screws are counted from the stated position.
        if joint["type"] == "screw":
            along = mechanism.slide(poses, joint) * unit(joint["axis_i"])
            joint["point_i"] = (np.array(joint["point_i"]) + along).tolist()
    return scene


def reference(seed):
    draw = Draw(seed)
    scene = started(draw.scene(f"random-{seed}"), draw)
    if scene is None:
        return None
    if len(scene["bodies"]) < 3 and draw.choice([True, False]):
        # Eigenvalues that are equal, or differ in their damping alone: those of one freedom then have the same modulus.
        dampings = draw.choice([[1.0], [0.3], [0.4, 0.7, 1.7]])
        scene = beside(scene, [(str(k + 2), draw.vector(2 * draw.length), damping) for k, damping in enumerate(dampings)])
    mechanism = Mechanism(scene)
    rest = mechanism.rest()
    values = rest and mechanism.eigenvalues(rest)
    if not values:
        return None
    return {"scene": scene, "centers": [r.tolist() for r, _ in rest], "eigenvalues": [[x.real, x.imag] for x in values]}


def main():
    found, seed = [], 0
    while len(found) < SCENES:
        seed += 1
        one = reference(seed)
        found += [one] if one else []
    print(json.dumps(found, separators=(",", ":")).replace('{"scene"', '\n{"scene"'))


if __name__ == "__main__":
    main()
