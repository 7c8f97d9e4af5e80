"""The equations: each against what it is defined by."""

import numpy as np
import pytest

import triad

SCENES = ["n-four-bar:2", "spatial-slider-crank", "bricard", "crank-rocker", "rssr", "governor"]
KINDS = ["full", "reduced", "shared"]


def states(system):
    """The start, and a state that satisfies nothing."""
    random = np.random.default_rng(7)
    away = system.q0 + 0.1 * random.standard_normal(system.q0.shape)
    return [(system.q0, system.v0), (away, random.standard_normal(system.q0.shape))]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("scene", SCENES)
def test_the_jacobian_and_gamma_are_derivatives_of_phi(scene, kind):
    system = triad.System(scene, coordinates=kind)
    t, h = 0.3, 1e-5
    for q, v in states(system):
        jacobian = system.jacobian(q, t)
        assert jacobian.shape == (len(system.rows), len(system.columns))
        for k in range(len(q)):
            step = np.eye(len(q))[k] * h
            column = (system.phi(q + step, t) - system.phi(q - step, t)) / (2 * h)
            assert np.allclose(jacobian[:, k], column, atol=1e-7), system.columns[k]
        # Along q(t) with velocity v and no acceleration, Φ has the rate Φ_q q̇ − ν and the second derivative −γ.
        along = [system.phi(q + s * h * v, t + s * h) for s in (-1, 0, 1)]
        rate, second = (along[2] - along[0]) / (2 * h), (along[2] - 2 * along[1] + along[0]) / h**2
        size = 1 + np.abs(second).max()
        assert np.allclose(rate, jacobian @ v - system.nu(q, v, t), atol=1e-6 * size)
        assert np.allclose(second, -system.gamma(q, v, t), atol=1e-4 * size)


@pytest.mark.parametrize("kind", KINDS)
def test_the_equations_hold_with_what_solve_gives(kind):
    system = triad.System("n-four-bar:2", coordinates=kind)
    q, v = system.q0, system.v0
    acceleration, multipliers = system.solve(q, v)
    jacobian, mass = system.jacobian(q), system.mass(q)
    assert np.allclose(mass @ acceleration + jacobian.T @ multipliers, system.force(q, v), atol=1e-9)
    assert np.allclose(jacobian @ acceleration, system.gamma(q, v), atol=1e-9)
    assert np.allclose(mass, mass.T)


def test_kinetic_energy_is_half_v_m_v():
    r = triad.run("spatial-double-pendulum", until=0.5, outputs=["balance"])
    system = triad.System("spatial-double-pendulum")
    kinetic = 0.5 * r.v[-1] @ system.mass() @ r.v[-1]
    assert kinetic == pytest.approx(r[next(name for name in r.columns if "kinetic" in name)][-1], rel=1e-12)


def test_sparse_matrices_are_the_dense_ones():
    system = triad.System("n-four-bar:3", coordinates="shared")
    for sparse, dense in [
        (system.jacobian(system.q0, sparse=True), system.jacobian(system.q0)),
        (system.mass(sparse=True), system.mass()),
    ]:
        assert np.array_equal(sparse.toarray(), dense) and sparse.nnz < dense.size / 4


def test_bodies_have_their_twelve_numbers_in_all_coordinates():
    full, reduced = (triad.System("spatial-slider-crank", coordinates=kind) for kind in ("full", "reduced"))
    assert np.allclose(full.natural(full.q0), reduced.natural(reduced.q0), atol=1e-12)
    assert np.array_equal(full.natural(full.q0).reshape(-1), full.q0)


def test_states_of_a_wrong_kind_are_refused():
    system = triad.System("simple-pendulum")
    with pytest.raises(triad.TriadError, match="system.columns") as found:
        system.phi(system.q0[:-1])
    assert found.value.code == "wrong-size"
    with pytest.raises(triad.TriadError, match=r"v\[0\] is NaN"):
        system.gamma(system.q0, np.full_like(system.v0, np.nan))


def test_whole_turns_are_those_with_which_the_rows_hold():
    """A motor that turns a gear, and a nut that has gone several turns along its screw."""

    def body(name, x):
        return {"name": name, "mass": 1, "position": [x, 0, 0], "inertia": {"principal": [0.1, 0.1, 0.2]}}

    def joint(name, kind, other, of, x, **more):
        return {"name": name, "type": kind, "body_i": other, "body_j": of, "point": [x, 0, 0], "axis": [0, 0, 1], **more}

    scene = {
        "name": "turns",
        "gravity": [0, 0, 0],
        "bodies": [body("a", 0), body("b", 1), {**body("nut", 2), "velocity": [0, 0, 2.4], "angular_velocity": [0, 0, 8]}],
        "joints": [
            joint("pin-a", "revolute", "ground", "a", 0),
            joint("pin-b", "revolute", "ground", "b", 1),
            joint("thread", "screw", "ground", "nut", 2, pitch=0.3),
            {"name": "gear", "type": "gear", "joints": ["pin-a", "pin-b"], "ratio": 1.7},
        ],
        "drivers": [{"name": "motor", "type": "angle", "joint": "pin-a", "motion": {"kind": "ramp", "start": 0, "rate": 9}}],
        "simulation": {"duration": 5, "every": 1},
    }
    system, r = triad.System(scene), triad.run(scene)
    assert r.violations.max() < 1e-9
    for t, q in zip(r.t, r.q):
        assert np.abs(system.phi(q, t)).max() < 1e-9, t
