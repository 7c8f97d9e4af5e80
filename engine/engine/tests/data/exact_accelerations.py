"""Accelerations of the mechanisms of check-vectors.json in arithmetic of 60 digits.

The equations are written down once more, from the data of the scenes alone: nothing of Triad and nothing of the program
that made the check vectors is used, so that the rounding of both can be told from each other. It needs mpmath (BSD):

    python3 -m venv exact && exact/bin/pip install mpmath==1.3.0
    exact/bin/python engine/tests/data/exact_accelerations.py > engine/tests/data/exact-accelerations.json
"""

import json
from pathlib import Path

from mpmath import matrix, mp, mpf

mp.dps = 60
X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def body(mass, inertia, point=(0, 0, 0)):
    """Mass in kg, principal moments of inertia about the centre in kg m²; the centre is at `point`."""
    return mpf(mass), [mpf(x) for x in inertia]


class Vector:
    """A vector of a body: value, velocity, Jacobian ({column: 3 entries}) and what its acceleration has without q̈."""

    def __init__(self, value, velocity, jacobian, rest):
        self.value, self.velocity, self.jacobian, self.rest = value, velocity, jacobian, rest

    @staticmethod
    def fixed(value):
        return Vector([mpf(x) for x in value], [mpf(0)] * 3, {}, [mpf(0)] * 3)

    def times(self, factor):
        factor = mpf(factor)
        scale = lambda v: [factor * x for x in v]
        return Vector(scale(self.value), scale(self.velocity),
                      {c: scale(v) for c, v in self.jacobian.items()}, scale(self.rest))

    def plus(self, other):
        add = lambda a, b: [x + y for x, y in zip(a, b)]
        jacobian = {c: list(v) for c, v in self.jacobian.items()}
        for column, entries in other.jacobian.items():
            jacobian[column] = add(jacobian.get(column, [mpf(0)] * 3), entries)
        return Vector(add(self.value, other.value), add(self.velocity, other.velocity), jacobian,
                      add(self.rest, other.rest))


class Frame:
    """Point r and vectors u, v, w of one body, from its slice of q and q̇."""

    def __init__(self, full, first, q, rate):
        part = lambda k: Vector(q[first + 3 * k:first + 3 * k + 3], rate[first + 3 * k:first + 3 * k + 3],
                                {first + 3 * k + i: [mpf(int(i == j)) for j in range(3)] for i in range(3)},
                                [mpf(0)] * 3)
        self.r, self.u, self.v = part(0), part(1), part(2)
        if full:
            self.w = part(3)
            return
        u, v = self.u, self.v
        jacobian = {c: cross(e, v.value) for c, e in u.jacobian.items()}
        jacobian |= {c: cross(u.value, e) for c, e in v.jacobian.items()}
        velocity = [a + b for a, b in zip(cross(u.velocity, v.value), cross(u.value, v.velocity))]
        self.w = Vector(cross(u.value, v.value), velocity, jacobian, [2 * x for x in cross(u.velocity, v.velocity)])

    def along(self, c):
        return self.u.times(c[0]).plus(self.v.times(c[1])).plus(self.w.times(c[2]))

    def point(self, c):
        return self.r.plus(self.along(c))


class Equations:
    """M q̈ + Φ_qᵀλ = g, Φ_q q̈ = γ."""

    def __init__(self, full, bodies, gravity, q, rate):
        size = 12 if full else 9
        self.n = size * len(bodies)
        q, rate = [mpf(x) for x in q], [mpf(x) for x in rate]
        self.frames = [Frame(full, size * k, q, rate) for k in range(len(bodies))]
        self.mass, self.force, self.rows, self.gamma = matrix(self.n, self.n), [mpf(0)] * self.n, [], []
        for frame, (mass, inertia) in zip(self.frames, bodies):
            half = sum(inertia) / 2
            self.weigh(frame.r, mass, gravity)
            for director, moment in zip((frame.u, frame.v, frame.w), inertia):
                self.weigh(director, half - moment, (0, 0, 0))
            self.angle(frame.u, frame.u), self.angle(frame.v, frame.v), self.angle(frame.u, frame.v)
            if full:
                self.angle(frame.w, frame.w), self.angle(frame.u, frame.w), self.angle(frame.v, frame.w)

    def weigh(self, vector, mass, gravity):
        """Jᵀ m (J q̈ + rest) = Jᵀ m gravity."""
        pull = [mass * (mpf(g) - a) for g, a in zip(gravity, vector.rest)]
        for a, x in vector.jacobian.items():
            self.force[a] += dot(x, pull)
            for b, y in vector.jacobian.items():
                self.mass[a, b] += mass * dot(x, y)

    def row(self, entries, gamma):
        self.rows.append(entries)
        self.gamma.append(gamma)

    def angle(self, a, b):
        """a·b is constant."""
        entries = {c: dot(v, b.value) for c, v in a.jacobian.items()}
        for c, v in b.jacobian.items():
            entries[c] = entries.get(c, mpf(0)) + dot(v, a.value)
        self.row(entries, -(2 * dot(a.velocity, b.velocity) + dot(a.value, b.rest) + dot(b.value, a.rest)))

    def same(self, a, b, components=range(3)):
        """a = b, component by component."""
        difference = a.plus(b.times(-1))
        for k in components:
            self.row({c: v[k] for c, v in difference.jacobian.items()}, -difference.rest[k])

    def accelerations(self):
        """By elimination with full pivoting; a pivot below 1e-9 is a dependent row."""
        n, m = self.n, len(self.rows)
        table = [[self.mass[i, j] for j in range(n)] + [mpf(0)] * m + [self.force[i]] for i in range(n)]
        for k, (entries, gamma) in enumerate(zip(self.rows, self.gamma)):
            line = [mpf(0)] * (n + m) + [gamma]
            for column, value in entries.items():
                line[column] = value
                table[column][n + k] = value
            table.append(line)
        order = list(range(n + m))
        rank = n + m
        for step in range(n + m):
            size, i, j = max((abs(table[i][j]), i, j) for i in range(step, n + m) for j in range(step, n + m))
            if size < mpf("1e-9"):
                rank = step
                break
            table[step], table[i] = table[i], table[step]
            if j != step:
                order[step], order[j] = order[j], order[step]
                for line in table:
                    line[step], line[j] = line[j], line[step]
            pivot = table[step]
            for line in table[step + 1:]:
                if line[step]:
                    factor = line[step] / pivot[step]
                    for c in range(step, n + m + 1):
                        if pivot[c]:
                            line[c] -= factor * pivot[c]
        solution = [mpf(0)] * (n + m)
        for step in reversed(range(rank)):
            line = table[step]
            known = sum(line[c] * solution[order[c]] for c in range(step + 1, rank))
            solution[order[step]] = (line[n + m] - known) / line[step]
        return solution[:n]


def pendulum(full, q, rate):
    at = Equations(full, [body(1, ["0.3"] * 3)], (0, mpf("-9.81"), 0), q, rate)
    frame = at.frames[0]
    at.same(frame.point((1, 0, 0)), Vector.fixed((0, 0, 0)))
    at.same(frame.w, Vector.fixed(Z))
    return at


def heavy_top(full, q, rate):
    at = Equations(full, [body(15, ["0.234375", "0.234375", "0.46875"])], (0, 0, mpf("-9.81")), q, rate)
    # The tip lies one metre below the centre on the axis of symmetry, w.
    at.same(at.frames[0].point((0, 0, -1)), Vector.fixed((0, 0, 0)))
    return at


def chain(full, q, rate):
    slender = mpf("0.2") * mpf("0.04") / 12
    at = Equations(full, [body("0.2", ["8e-5", slender, slender])] * 6, (0, 0, mpf("-9.81")), q, rate)
    end = Vector.fixed((0, 0, 0))
    for frame in at.frames:
        at.same(frame.point((mpf("-0.1"), 0, 0)), end)
        end = frame.point((mpf("0.1"), 0, 0))
    return at


def four_bar(full, q, rate):
    """Three uprights (0, 1, 2) along their u and two couplers (3, 4)."""
    twelfth = mpf(1) / 12
    at = Equations(full, [body(1, [twelfth] * 3)] * 5, (0, mpf("-9.81"), 0), q, rate)
    near, far = (mpf("-0.5"), 0, 0), (mpf("0.5"), 0, 0)
    for k in range(3):
        at.same(at.frames[k].point(near), Vector.fixed((k, 0, 0)))
        at.same(at.frames[k].w, Vector.fixed(Z))
    for left, coupler, right in ((0, 3, 1), (1, 4, 2)):
        a, h, b = (at.frames[k] for k in (left, coupler, right))
        at.same(a.point(far), h.point(near)), at.same(a.w, h.w)
        at.same(h.point(far), b.point(far)), at.same(h.w, b.w)
    return at


def slider_crank(full, q, rate):
    bodies = [body("0.12", ["1e-4", "1e-5", "1e-4"]), body("0.5", ["4e-4", "4e-3", "4e-3"]), body(2, ["1e-4"] * 3)]
    at = Equations(full, bodies, (0, 0, mpf("-9.81")), q, rate)
    crank, rod, slider = at.frames
    at.same(crank.r, Vector.fixed((0, mpf("0.1"), mpf("0.12")))), at.same(crank.u, Vector.fixed(X))
    at.same(crank.point((0, 0, mpf("0.08"))), rod.point((mpf("-0.15"), 0, 0)))
    at.same(rod.point((mpf("0.15"), 0, 0)), slider.r), at.angle(rod.w, slider.v)
    at.same(slider.r, Vector.fixed((0, 0, 0)), (1, 2))
    at.same(slider.u, Vector.fixed(X)), at.same(slider.v, Vector.fixed(Y))
    return at


MODELS = {"pendulum": pendulum, "heavy_top": heavy_top, "chain6_spherical": chain, "double_four_bar": four_bar,
          "spatial_slider_crank": slider_crank}

if __name__ == "__main__":
    here = Path(__file__).parent
    cases = json.loads((here / "check-vectors.json").read_text())["mechanisms"]
    exact = [{"model": c["model"], "kind": c["kind"],
              "qddot": [float(x) for x in MODELS[c["model"]](c["kind"] == "full", c["q"], c["qdot"]).accelerations()]}
             for c in cases]
    print(json.dumps({"source": "exact_accelerations.py: 60 digits, rounded once to double precision",
                      "mechanisms": exact}, indent=None))
