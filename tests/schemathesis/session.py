"""Schemathesis reads the interface's own description and asks every operation of it, well and badly. Run by `cargo verify http`:

    session.py TRIAD [EXAMPLES]

Three times: a server at home; a class as its owner; a class as nobody. No answer may be a fault of the server (5xx), and every
answer has a status, a media type and a body that the description names. EXAMPLES is how many requests are drawn for each operation;
below ten the tens of thousands that are wrong in one place each are left out, and the three servers take some minutes.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import urllib.request

# Drawn for each operation: with all phases each of the three servers takes half an hour and more on two processors.
EXAMPLES = 30
# From so many on everything that is wrong in one place is asked, too.
THOROUGH = 10
CHECKS = "not_a_server_error,status_code_conformance,content_type_conformance,response_schema_conformance"


def serve(triad, folder, *options):
    """Starts a server on a free port: the process, its address, and the rest of what it says first."""
    # A server that is full refuses by 503, which is none of its faults: there is room for all that is begun.
    room = ["--max-sessions", "100000", "--max-rooms", "100000"]
    command = [triad, "serve", "--port", "0", "--database", str(folder / "grades.db"), *room, *options]
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    address = next(word for word in process.stdout.readline().split() if word.startswith("http://"))
    return process, address


def owner(process, address):
    """Comes in by the link that the server prints; the cookie."""
    link = next(word for line in process.stdout for word in line.split() if "/setup#" in word)
    body = json.dumps({"token": link.split("#", 1)[1], "name": "Owner"}).encode()
    request = urllib.request.Request(f"{address}/api/v1/setup", body, {"Content-Type": "application/json"})
    with urllib.request.urlopen(request) as answer:
        return answer.headers["Set-Cookie"].split(";")[0]


def ask_everything(address, examples, *more):
    """Whether all answers are as described."""
    program = pathlib.Path(sys.executable).with_name("st")
    command = [program, "run", f"{address}/api/openapi.json", "--checks", CHECKS, "--max-examples", str(examples)]
    phases = "examples,coverage,fuzzing" if examples >= THOROUGH else "examples,fuzzing"
    command += ["--phases", phases, "--seed", "1", "--continue-on-failure", "--no-shrink"]
    command += ["--warnings", "off", "--suppress-health-check", "all", "--request-timeout", "120", *more]
    return subprocess.run(command, cwd=tempfile.gettempdir(), check=False).returncode == 0


def main():
    triad = str(pathlib.Path(sys.argv[1]).resolve())
    examples = int(sys.argv[2]) if len(sys.argv) > 2 else int(os.environ.get("TRIAD_EXAMPLES", EXAMPLES))
    failed = []
    for name, options in [("home", []), ("owner", ["--class"]), ("nobody", ["--class"])]:
        with tempfile.TemporaryDirectory() as folder:
            process, address = serve(triad, pathlib.Path(folder), *options)
            try:
                more = []
                if name == "owner":
                    # Who signs out is nobody from there on.
                    more = ["--header", f"Cookie:{owner(process, address)}", "--exclude-path", "/api/v1/sign-out"]
                print(f"schemathesis: {name}", flush=True)
                if not ask_everything(address, examples, *more):
                    failed.append(name)
                # It has lived through all of it.
                urllib.request.urlopen(f"{address}/api/v1/health").read()
            finally:
                process.terminate()
                process.wait(60)
    if failed:
        sys.exit(f"schemathesis: answers that are not described, or faults, as {', '.join(failed)}")


main()
