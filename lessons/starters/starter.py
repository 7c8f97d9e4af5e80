"""Triad, lesson {{lesson}}, question {{question}}.

Reads states.json, evaluates your equations at each state, writes answer.json, which you hand in.
Needs Python 3 and nothing else.   Run:  python3 starter.py
"""
import json


def vectors(body, x):
    """The four vectors r, u, v, w of a body in a list of coordinates x (q or qd)."""
    first = body["first_column"]
    parts = [x[first + k:first + k + 3] for k in (0, 3, 6)]
    if body["coordinates"] == "full":
        return parts + [x[first + 9:first + 12]]
    return parts + [None]  # reduced: w = u x v is yours to compute


def equations(given, q, qd, t, state):
    """What is asked for, at one state. given has bodies, joint_rows, rows, columns, gravity."""
    n, m = len(given["columns"]), len(given["rows"])
    # Your equations begin here.
{{returns}}
    # Your equations end here.
    return answer


def main():
    with open("states.json", encoding="utf-8") as file:
        given = json.load(file)
    answers = [equations(given, s["q"], s["qd"], s["t"], k) for k, s in enumerate(given["states"])]
    with open("answer.json", "w", encoding="utf-8") as file:
        json.dump({"states": answers}, file)
    print("answer.json written:", len(answers), "states, seed", repr(given["seed"]))


main()
