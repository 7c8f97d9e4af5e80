"""Random mechanisms as scenes of Triad, for small_motions.py: points and axes are those of the bodies' frames."""

import json
import math
import random

import numpy as np


def unit(vector):
    vector = np.array(vector, float)
    return vector / math.sqrt(vector @ vector)


class Draw:
    """A random mechanism. Its lengths, masses and times are of the same size each; those of scenes are not."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.length, self.mass = 10 ** self.choice([0, 0, 0, -2, 2]), 10 ** self.choice([0, 0, 0, -3, 3])
        self.force = self.mass * 9.81
        self.time = math.sqrt(self.length / 9.81)

    def choice(self, options):
        return self.random.choice(options)

    def within(self, low, high):
        return self.random.uniform(low, high)

    def vector(self, size=1.0):
        return np.array([self.within(-size, size) for _ in range(3)])

    def direction(self):
        while True:
            vector = self.vector()
            if 0.3 < np.linalg.norm(vector) < 1:
                return unit(vector)

    def rotation(self):
        return np.linalg.qr(np.column_stack([self.direction() for _ in range(3)]))[0]

    def body(self, name, position):
        axes = self.rotation()
        axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
        moments = sorted(self.within(0.3, 1) for _ in range(3))
        moments[2] = min(moments[2], 0.95 * (moments[0] + moments[1]))
        turn = self.rotation()
        tensor = turn @ np.diag(moments) @ turn.T * (0.1 * self.mass * self.length**2)
        return {"name": name, "mass": self.mass * self.within(0.5, 2), "position": position.tolist(),
                "orientation": {"u": axes[:, 0].tolist(), "v": axes[:, 1].tolist()},
                "center_of_mass": self.vector(0.3 * self.length).tolist(),
                "inertia": {"tensor": ((tensor + tensor.T) / 2).tolist()}}

    def scene(self, name):
        bodies, joints = [], []
        kinds = ["revolute"] * 4 + ["spherical", "universal", "cylindrical", "screw", "prismatic", "planar", "fixed"]
        kinds += ["point-on-line", "point-in-plane"]
        places = {"ground": np.zeros(3)}
        for letter in "abcd"[: self.choice([1, 2, 2, 3, 3, 4])]:
            before = self.choice(list(places))
            places[letter] = places[before] + self.direction() * self.length * self.within(0.6, 1.2)
            bodies.append(self.body(letter, places[letter]))
            joints.append({"name": "J" + letter, "type": self.choice(kinds), "body_i": before, "body_j": letter,
                           "point": (places[before] + places[letter]) / 2 + self.direction() * 0.2 * self.length, "axis": self.direction()})
        for k in range(self.choice([0, 0, 1, 1, 2])):
            i, j = self.random.sample(list(places), 2)
            i, j = (j, i) if j == "ground" else (i, j)
            kind = self.choice(["rod", "rod", "point-on-line", "point-in-plane"])
            joints.append({"name": f"L{k}", "type": kind, "body_i": i, "body_j": j,
                           "point": (places[i] + places[j]) / 2 + self.direction() * 0.3 * self.length, "axis": self.direction(),
                           "other": places[j] + self.direction() * 0.3 * self.length})
        scene = {"name": name, "gravity": (self.direction() * 9.81).tolist(), "bodies": bodies, "joints": joints, "loads": []}
        self.attach(scene)
        revolutes = [joint["name"] for joint in joints if joint["type"] == "revolute"]
        if len(revolutes) > 1 and self.choice([True, False]):
            pair, ratio = self.random.sample(revolutes, 2), self.choice([-2.0, 0.5, 3.0, 1.7])
            scene["joints"].append({"name": "G", "type": "gear", "joints": pair, "ratio": ratio})
        self.load(scene)
        return scene

    def attach(self, scene):
        """Points and axes of joints in the frames of their bodies."""
        frames = {"ground": (np.zeros(3), np.eye(3))}
        for body in scene["bodies"]:
            u, v = (np.array(body["orientation"][key]) for key in "uv")
            frames[body["name"]] = np.array(body["position"]), np.column_stack([u, v, np.cross(u, v)])
        for joint in scene["joints"]:
            point, axis, other = (joint.pop(key, None) for key in ("point", "axis", "other"))
            second = self.direction()
            for side in "ij":
                origin, axes = frames[joint["body_" + side]]
                there = other if joint["type"] == "rod" and side == "j" else point
                joint["point_" + side] = (axes.T @ (there - origin)).tolist()
                along = unit(np.cross(axis, second)) if joint["type"] == "universal" and side == "j" else axis
                only_first = joint["type"].startswith("point")
                if joint["type"] not in ("spherical", "rod", "fixed") and not (only_first and side == "j"):
                    joint["axis_" + side] = (axes.T @ along).tolist()
            if joint["type"] == "rod":
                joint["length"] = float(np.linalg.norm(other - point))
            if joint["type"] == "screw":
                joint["pitch"] = self.within(-1, 1) * self.length

    def load(self, scene):
        force, length, loads = self.force, self.length, scene["loads"]

        def add(kind, name, stiffness, size, **more):
            loads.append({"type": kind, "name": name, "stiffness": stiffness, "damping": self.damping(size), **more})

        for joint in scene["joints"]:
            name, kind = joint["name"], joint["type"]
            if kind in ("revolute", "cylindrical") and self.choice([True, False]):
                stiffness = force * length * self.within(0, 2)
                add("torsion", "T" + name, stiffness, force * length * 0.3, joint=name, free_angle=self.within(-1, 1))
            if kind in ("prismatic", "cylindrical"):
                free = self.within(-0.2, 0.2) * length
                add("slider", "S" + name, force / length * self.within(2, 8), force / length, joint=name, free_length=free)
        for k, body in enumerate(scene["bodies"]):
            hangs = scene["joints"][k]["type"] in ("revolute", "spherical", "universal", "prismatic", "cylindrical", "fixed")
            if not hangs or self.choice([True, False]):
                other = self.choice(["ground", scene["bodies"][0]["name"]] if k else ["ground"])
                points = {"point_" + side: self.vector(0.5 * length).tolist() for side in "ij"}
                add("spring", f"P{k}", force / length * self.within(2, 8), force / length, body_i=other, body_j=body["name"],
                    free_length=self.within(0, 1) * length, **points)

    def damping(self, size):
        """None, some, or so much that motions creep."""
        return self.choice([0.0, 1.0, 1.0, 30.0]) * self.within(0, 1) * size * self.time


def beside(scene, copies):
    """The scene and copies of it: of each, what is added to names, how far it is away, and by what its damping is multiplied."""
    out = {**scene, **{kind: list(scene[kind]) for kind in ("bodies", "joints", "loads")}}
    for mark, away, damping in copies:
        for kind in ("bodies", "joints", "loads"):
            for element in scene[kind]:
                copy = json.loads(json.dumps(element))
                for key in ("name", "body_i", "body_j", "joint"):
                    if copy.get(key, "ground") != "ground":
                        copy[key] += mark
                if "joints" in copy:
                    copy["joints"] = [name + mark for name in copy["joints"]]
                if "damping" in copy:
                    copy["damping"] *= damping
                for place, body in (("position", None), ("point_i", copy.get("body_i")), ("point_j", copy.get("body_j"))):
                    if place in copy and body in (None, "ground"):
                        copy[place] = (np.array(copy[place]) + away).tolist()
                out[kind].append(copy)
    return out
