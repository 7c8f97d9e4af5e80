"""What is tried: for each program and problem families of settings, each from coarse to fine."""

RATES = [10, 16, 20, 25, 32, 40, 50, 64, 80, 100, 200, 300, 400, 600, 800, 1200, 1600, 2400, 3200, 4800, 6400]
"""Steps a second; above 100 a multiple of it, so that steps meet the samples."""

FIRST_ORDER = [100, 200, 400, 800, 1600, 3200, 6400, 12800, 25600]
"""The same for methods of low order."""


def powers(first, last, each=2):
    """Tolerances 10^-first … 10^-last, `each` in a decade."""
    return [f"{10 ** (-k / each):.3g}" for k in range(first * each, last * each + 1)]


def triad(_):
    """The program's default: it chooses the integrator itself."""
    return {"auto": [{"integrator": "auto", "tolerance": t} for t in powers(2, 12)]}


def pinocchio(problem):
    """Articulated bodies, or constrained dynamics with a little of Baumgarte, under two integrators."""
    if problem.kind != "four-bar":
        return {
            "DOP853": [{"integrator": "dop853", "tolerance": t} for t in powers(2, 13)],
            "RK4": [{"integrator": "rk4", "rate": n} for n in RATES],
        }
    found = {}
    for gain, mu in ((50, "1e-8"), (50, "1e-6"), (10, "1e-8")):
        loop = {"gain": gain, "mu": mu}
        name = f"gain {gain}, mu {mu}"
        found[f"DOP853, {name}"] = [{"integrator": "dop853", "tolerance": t, **loop} for t in powers(4, 13, each=1)]
        found[f"RK4, {name}"] = [{"integrator": "rk4", "rate": n, **loop} for n in RATES]
    return found


def mujoco(problem):
    """RK4; with loops also the other integrators, the stiffest impedance, and two time constants."""
    if problem.kind != "four-bar":
        return {
            "RK4": [{"integrator": "RK4", "rate": n} for n in RATES],
            "implicitfast": [{"integrator": "implicitfast", "rate": n} for n in FIRST_ORDER],
        }
    return {
        f"{integrator}, {constant} steps": [
            {"integrator": integrator, "rate": n, "impedance": "0.9999", "constant": constant} for n in FIRST_ORDER
        ]
        for integrator in ("discrete", "implicitfast", "RK4")
        for constant in (2, 4)
    }


def exudyn(problem):
    """Explicit solvers on kinematic trees; with loops both kinds of the generalized-alpha solver."""
    if problem.kind != "four-bar":
        return {
            "RK67": [{"solver": "RK67", "rate": n} for n in RATES],
            "RK44": [{"solver": "RK44", "rate": n} for n in RATES],
            "DOPRI5": [{"solver": "DOPRI5", "tolerance": t} for t in powers(3, 13, each=1)],
        }
    return {
        "generalized-alpha, 0.9": [{"solver": "index3", "rate": n, "radius": 0.9} for n in FIRST_ORDER],
        "generalized-alpha, 0.6": [{"solver": "index3", "rate": n, "radius": 0.6} for n in FIRST_ORDER],
        "trapezoidal, index 2": [{"solver": "index2", "rate": n, "radius": 1.0} for n in FIRST_ORDER],
    }


def drake(problem):
    """Error-controlled integrators; with loops ball constraints in discrete time, or bushings."""
    schemes = ("runge_kutta5", "runge_kutta3")
    if problem.kind != "four-bar":
        return {s: [{"integrator": s, "accuracy": a} for a in powers(3, 14, each=1)] for s in schemes}
    bushings = [
        {"integrator": "runge_kutta5", "accuracy": accuracy, "stiffness": stiffness}
        for stiffness, accuracy in (("1e5", "1e-3"), ("1e6", "1e-4"), ("1e7", "1e-5"), ("1e8", "1e-6"))
    ]
    return {"SAP, ball constraints": [{"rate": n} for n in FIRST_ORDER], "RK5, bushings": bushings}


FAMILIES = {"triad": triad, "pinocchio": pinocchio, "mujoco": mujoco, "exudyn": exudyn, "drake": drake}
