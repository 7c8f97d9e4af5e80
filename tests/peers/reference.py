"""References that owe nothing to Triad: minimal coordinates, integrated by extrapolation until nothing changes.

`python3 reference.py heavy-top` prints the table that `engine/tests/data/heavy-top.csv` holds.
"""

import math
import sys

import numpy as np

GRID = 0.0025
"""Interval of the references, s: a quarter of the interval of comparison, so that they can be read between too."""

X = np.longdouble
"""Extended precision (64 bits of mantissa where the machine has it)."""


def extrapolated(f, y, step, order):
    """One step of Gragg, Bulirsch and Stoer: the modified midpoint rule with 2, 4, …, `order` parts, extrapolated."""
    table = []
    for k in range(1, order // 2 + 1):
        parts = 2 * k
        h = step / parts
        before, now = y, y + h * f(y)
        for _ in range(parts - 1):
            before, now = now, before + 2 * h * f(now)
        row = [(before + now + h * f(now)) / 2]
        for j in range(1, k):
            ratio = (parts / (2 * (k - j))) ** 2
            row.append(row[j - 1] + (row[j - 1] - table[-1][j - 1]) / (ratio - 1))
        table.append(row)
    return table[-1][-1]


def solve(f, y, duration, step=GRID, order=12):
    """States at multiples of a step."""
    states = [y]
    for _ in range(round(duration / step)):
        y = extrapolated(f, y, y.dtype.type(step), order)
        states.append(y)
    return np.array(states)


def converged(f, y, duration, points):
    """Points at multiples of GRID, and the largest difference from steps twice as long."""
    fine, coarse = (points(solve(f, y, duration, step)) for step in (GRID, 2 * GRID))
    change = np.linalg.norm((fine[::2] - coarse).astype(float), axis=-1).max()
    return fine.astype(float), float(change)


def angle(kappa, start, rate, duration):
    """φ̈ = κ sin φ; the point (sin φ, cos φ, 0)."""

    def points(states):
        phi = states[:, 0]
        return np.stack([np.sin(phi), np.cos(phi), 0 * phi], axis=-1)[:, None, :]

    return converged(lambda y: np.array([y[1], X(kappa) * np.sin(y[0])]), np.array([X(start), X(rate)]), duration, points)


def pendulum(duration):
    """A01: φ from the upward vertical, released at −π/2."""
    return angle(X("9.81"), -np.arctan(X(1)) * 2, 0, duration)


def four_bar(windows, duration):
    """A02: all uprights turn by φ; N couplers shift with their tips."""
    kappa = X("9.81") * 3 * (3 * windows + 1) / (2 * (4 * X(windows) + 1))
    return angle(kappa, 0, 1, duration)


class Top:
    """Lagrange's top of the scene `heavy-top`, with Euler's angles z-x-z; both momenta about axes are constant."""

    MASS, HEIGHT, RADIUS, SPIN, GRAVITY = X(1), X("0.2"), X("0.15"), X(60), X("9.81")
    AXIAL = MASS * RADIUS**2 / 2
    ACROSS = MASS * RADIUS**2 / 4 + MASS * HEIGHT**2
    TILT = 4 * np.arctan(X(1)) / 3

    def rates(self, y):
        """Rates of θ, θ̇, φ, ψ."""
        theta, nod = y[0], y[1]
        sine, cosine = np.sin(theta), np.cos(theta)
        spin = self.AXIAL * self.SPIN
        precession = spin * (np.cos(self.TILT) - cosine) / (self.ACROSS * sine**2)
        weight = self.MASS * self.GRAVITY * self.HEIGHT
        moment = (self.ACROSS * precession**2 * cosine - spin * precession + weight) * sine
        return np.array([nod, moment / self.ACROSS, precession, self.SPIN - precession * cosine])

    def start(self):
        """θ, θ̇, φ, ψ at the start."""
        return np.array([self.TILT, X(0), X(0), X(0)])

    def points(self, states):
        """Centre of mass, and the point of the rim that starts at the body's x."""
        theta, phi, psi = states[:, 0], states[:, 2], states[:, 3]
        zero = 0 * theta
        along = np.stack([np.cos(phi), np.sin(phi), zero], axis=-1)
        side = np.stack([-np.sin(phi) * np.cos(theta), np.cos(phi) * np.cos(theta), np.sin(theta)], axis=-1)
        axis = np.stack([np.sin(theta) * np.sin(phi), -np.sin(theta) * np.cos(phi), np.cos(theta)], axis=-1)
        turned = np.cos(psi)[:, None] * along + np.sin(psi)[:, None] * side
        centre = self.HEIGHT * axis
        return np.stack([centre, centre + self.RADIUS * turned], axis=1)

    def reference(self, duration):
        """Points, and the largest difference from steps twice as long."""
        return converged(self.rates, self.start(), duration, self.points)


def chain(rods, duration):
    """The far ends of the chain's rods: directions d of the rods, and the forces f in their joints; in doubles.

    A rod whose two moments across are B turns by d × d̈ = (M − A s ḋ) / B, where A is its moment along d, s its spin, which
    is constant as all forces meet its axis, and M = −d × (f_k + f_(k+1)) / 2. The joints' forces follow from the accelerations
    of the points that they join.
    """
    from problems import ACROSS, AXIAL, GRAVITY, chain_start

    directions, rates, spin = chain_start(rods)
    weight = np.array([0, 0, -GRAVITY])
    own = np.arange(rods)
    unit = np.eye(3)

    def f(y):
        d, v = y.reshape(2, rods, 3)
        turning = (unit - d[:, :, None] * d[:, None, :]) / (4 * ACROSS)
        bent = np.cross(v, d) * (-AXIAL * spin / ACROSS) - (v * v).sum(axis=1)[:, None] * d
        matrix = np.zeros((rods, 3, rods, 3))
        matrix[own, :, own] += unit + turning
        matrix[own[1:], :, own[1:]] += unit + turning[:-1]
        matrix[own[:-1], :, own[1:]] += turning[:-1] - unit
        matrix[own[1:], :, own[:-1]] += turning[:-1] - unit
        right = bent / 2
        right[1:] += bent[:-1] / 2
        right[0] -= weight
        force = np.linalg.solve(matrix.reshape(3 * rods, -1), right.ravel()).reshape(rods, 3)
        both = force.copy()
        both[:-1] += force[1:]
        return np.concatenate([v, bent - 2 * np.einsum("kij,kj->ki", turning, both)]).ravel()

    def points(states):
        return states[:, : 3 * rods].reshape(-1, rods, 3).cumsum(axis=1)

    return converged(f, np.concatenate([directions, rates]).ravel(), duration, points)


def between(samples, times):
    """Points at any times, by a polynomial through the 14 samples about each."""
    width = min(14, len(samples))
    found = np.empty((len(times), *samples.shape[1:]))
    for row, time in enumerate(times):
        place = time / GRID
        if abs(place - round(place)) < 1e-9:
            found[row] = samples[round(place)]
            continue
        first = min(max(math.floor(place) - width // 2 + 1, 0), len(samples) - width)
        local = place - first
        factors = np.array([(-1) ** k * math.comb(width - 1, k) / (local - k) for k in range(width)])
        found[row] = np.tensordot(factors / factors.sum(), samples[first : first + width], axes=1)
    return found


def main():
    """Prints the table of the heavy top."""
    if sys.argv[1:] != ["heavy-top"]:
        sys.exit("usage: reference.py heavy-top")
    top, duration = Top(), 5
    states = solve(top.rates, top.start(), duration)
    points, change = top.points(states), top.reference(duration)[1]
    print("# Lagrange's top (scene heavy-top): Euler's angles z-x-z with the two constant momenta, GBS extrapolation of")
    print(f"# order 12 in extended precision; steps twice as long change it by {change:.0e}. Made by tests/peers/reference.py.")
    print("# r: centre of mass; p: the point of the rim that starts at the body's x")
    print("t[s],theta[rad],phi,psi,rx[m],ry,rz,px[m],py,pz")
    for k in range(0, len(states), 40):
        numbers = [*states[k, [0, 2, 3]], *points[k].ravel()]
        print(",".join([f"{k * GRID:.1f}", *(f"{np.float64(x):.16g}" for x in numbers)]))


if __name__ == "__main__":
    main()
