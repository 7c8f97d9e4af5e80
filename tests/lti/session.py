"""A session between Triad and a learning platform that others wrote, step by step.

The platform is Open edX's own side of LTI (`lti-consumer-xblock`): it makes the launches, gives the tokens and checks what Triad
signs. Around it stands an HTTP server of the standard library; what a browser does is done by urllib. PyLTI1p3, a tool that
others wrote, judges the platform's words beside Triad, and with them those of the small platform in Triad's own tests.

`cargo verify lti` runs it. By hand: target/lti/venv/bin/python tests/lti/session.py target/release/triad [WORD.json]
"""

import html
import json
import re
import subprocess
import sys
import tempfile
import threading
import urllib.error
import urllib.parse
import urllib.request
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import django
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import rsa
from django.conf import settings

settings.configure(
    PLATFORM_NAME="Open edX at school",
    SECRET_KEY="for-this-test",
    CACHES={"default": {"BACKEND": "django.core.cache.backends.locmem.LocMemCache"}},
)
django.setup()

from lti_consumer.data import Lti1p3LaunchData  # noqa: E402
from lti_consumer.lti_1p3.consumer import LtiAdvantageConsumer  # noqa: E402
from pylti1p3.message_launch import MessageLaunch  # noqa: E402
from pylti1p3.tool_config import ToolConfDict  # noqa: E402

CLIENT, DEPLOYMENT, CONTEXT = "triad-at-school", "1", "course-v1:School+Mech+2026"
SCORE = "https://purl.imsglobal.org/spec/lti-ags/scope/score"
PEOPLE = "https://purl.imsglobal.org/spec/lti-nrps/scope/contextmembership.readonly"
LESSON = "simple-pendulum"
PATIENCE = 120  # seconds: only bounds a test that hangs


def step(text):
    print(f"  {text}", flush=True)


class Judge(MessageLaunch):
    """PyLTI1p3's checks of a platform's word, without its sessions and cookies."""

    def __init__(self, token, keys, issuer):
        registered = {"client_id": CLIENT, "auth_login_url": issuer, "auth_token_url": issuer, "key_set": keys}
        tool = ToolConfDict({issuer: [{**registered, "deployment_ids": [DEPLOYMENT, "7"], "default": True}]})
        super().__init__(None, tool, session_service=object(), cookie_service=object())
        self.set_auto_validation(False)
        self._token = token

    def _get_request_param(self, key):
        return self._token if key == "id_token" else ""

    def judged(self):
        self.validate_jwt_format().validate_registration().validate_jwt_signature()
        return self.validate_deployment().validate_message()._get_jwt_body()


class Platform:
    """Open edX's consumer behind an HTTP server."""

    def __init__(self):
        self.scores, self.arrived = [], threading.Event()
        handler = type("Handler", (Handler,), {"platform": self})
        self.server = ThreadingHTTPServer(("127.0.0.1", 0), handler)
        self.url = f"http://127.0.0.1:{self.server.server_port}"
        self.key = rsa.generate_private_key(public_exponent=65537, key_size=2048).private_bytes(
            serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
        )
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def consumer(self, tool, key=None):
        made = LtiAdvantageConsumer(
            iss=self.url,
            lti_oidc_url=f"{tool}/lti/login",
            lti_launch_url=f"{tool}/lessons/{LESSON}",
            client_id=CLIENT,
            deployment_id=DEPLOYMENT,
            rsa_key=key or self.key,
            rsa_key_id="school-1",
            redirect_uris=[f"{tool}/lti/launch"],
            tool_keyset_url=f"{tool}/lti/keys",
        )
        made.enable_ags(lineitems_url=f"{self.url}/items", lineitem_url=f"{self.url}/items/1?of=edx")
        made.enable_nrps(f"{self.url}/people")
        made.enable_deep_linking(f"{tool}/lti/choice", f"{self.url}/chosen")
        made.set_context_claim(CONTEXT, context_title="Mechanics at school")
        made.set_resource_link_claim("block-1", title="A pendulum")
        return made


class Handler(BaseHTTPRequestHandler):
    platform = None

    def log_message(self, *_):
        pass

    def answer(self, status, body):
        text = json.dumps(body).encode()
        self.send_response(status)
        self.send_header("content-type", "application/json")
        self.send_header("content-length", str(len(text)))
        self.end_headers()
        self.wfile.write(text)

    def may(self, scope):
        token = self.headers["authorization"].removeprefix("Bearer ")
        return self.platform.edx.check_token(token, [scope])

    def do_GET(self):
        path = urllib.parse.urlsplit(self.path).path
        if path == "/keys":
            return self.answer(200, self.platform.edx.get_public_keyset())
        if path == "/people" and self.may(PEOPLE):
            listed = [("ada", "Ada Lovelace", "Learner"), ("bob", "Bob Byrne", "Learner")]
            members = [{"user_id": i, "name": n, "roles": [r], "status": "Active"} for i, n, r in listed]
            return self.answer(200, {"id": self.platform.url, "members": members})
        return self.answer(404, {})

    def do_POST(self):
        text = self.rfile.read(int(self.headers["content-length"])).decode()
        path = urllib.parse.urlsplit(self.path).path
        if path == "/token":
            form = dict(urllib.parse.parse_qsl(text))
            return self.answer(200, self.platform.edx.access_token(form))
        if path == "/items/1/scores" and self.may(SCORE):
            self.platform.scores.append(json.loads(text))
            self.platform.arrived.set()
            return self.answer(200, {})
        return self.answer(403, {})


class Still(urllib.request.HTTPRedirectHandler):
    def redirect_request(self, *_):
        return None


class Browser:
    """What a browser does: cookies, forms, and where a page sends it."""

    def __init__(self, tool):
        self.tool, self.cookies = tool, {}
        self.opener = urllib.request.build_opener(Still)

    def ask(self, url, body=None, kind="application/json", origin=None):
        head = {"cookie": "; ".join(f"{name}={value}" for name, value in self.cookies.items())}
        data = None
        if body is not None:
            data = body.encode()
            head |= {"content-type": kind, "origin": origin or self.tool}
        try:
            reply = self.opener.open(urllib.request.Request(url, data=data, headers=head), timeout=PATIENCE)
        except urllib.error.HTTPError as error:
            reply = error
        for cookie in reply.headers.get_all("set-cookie") or []:
            name, value = cookie.split(";")[0].split("=", 1)
            self.cookies[name] = value
        return reply.status, reply.headers, reply.read().decode()

    def json(self, path, body=None):
        status, _, text = self.ask(f"{self.tool}{path}", body)
        assert status < 300, (path, status, text)
        return json.loads(text)

    def launch(self, edx, message="LtiResourceLinkRequest", change=lambda form: form):
        """From the platform's link to where the tool sends on: its answer."""
        data = Lti1p3LaunchData(
            user_id="1", user_role="student", config_id="1", resource_link_id="block-1", message_type=message
        )
        status, headers, text = self.ask(edx.prepare_preflight_url(data))
        assert status == 302, (status, text)
        asked = dict(urllib.parse.parse_qsl(urllib.parse.urlsplit(headers["location"]).query))
        form = change(edx.generate_launch_request(asked))
        encoded = urllib.parse.urlencode(form)
        kind = "application/x-www-form-urlencoded"
        return self.ask(asked["redirect_uri"], encoded, kind, "http://127.0.0.1:1"), form


def refused(answer, code):
    (status, _, text), _ = answer
    told = json.loads(text)
    assert told["code"] == code, (code, status, text)
    step(f"refused: {told['detail']} [{code}]")


def served(program, folder):
    """Starts Triad with a class; the process and its address."""
    with ThreadingHTTPServer(("127.0.0.1", 0), BaseHTTPRequestHandler) as free:
        port = free.server_port
    url = f"http://127.0.0.1:{port}"
    words = [program, "serve", "--class", "--port", str(port), "--url", url, "--database", f"{folder}/grades.db"]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    for line in process.stdout:
        if line.startswith("Students:"):
            return process, url
    raise SystemExit("the server did not start")


def session(program, folder):
    process, tool = served(program, folder)
    try:
        platform = Platform()
        words = [program, "lti", "add", "--issuer", platform.url, "--client-id", CLIENT, "--deployment", DEPLOYMENT]
        words += ["--jwks-url", f"{platform.url}/keys", "--login-url", f"{platform.url}/auth"]
        words += ["--token-url", f"{platform.url}/token", "--database", f"{folder}/grades.db", "--url", tool]
        said = subprocess.run(words, check=True, capture_output=True, text=True).stdout
        step(f"registered: {said.splitlines()[0]}")
        talk(platform, tool)
    finally:
        process.terminate()
        _, errors = process.communicate(timeout=PATIENCE)
    for secret in ["eyJ", "Ada", "Bearer"]:
        assert secret not in errors, f"the log tells {secret}: {errors}"
    step("the server's log has no token and no name")


def talk(platform, tool):
    edx = platform.edx = platform.consumer(tool)
    ada, teacher = Browser(tool), Browser(tool)
    edx.set_user_data("ada", "student", full_name="Ada Lovelace")
    refused(ada.launch(edx), "lti-not-linked")

    edx.set_user_data("prof", "instructor", full_name="Emmy Noether")
    (status, headers, text), form = teacher.launch(edx)
    assert status == 303 and headers["location"] == f"{tool}/lessons/{LESSON}", (status, text)
    judged = Judge(form["id_token"], edx.get_public_keyset(), platform.url).judged()
    assert judged["sub"] == "prof"
    step("PyLTI1p3 accepts the same word")
    me = teacher.json("/api/v1/me")["person"]
    assert (me["name"], me["role"]) == ("Emmy Noether", "instructor"), me
    step(f"a teacher opened a lesson: {me['name']}, {me['role']}; the course is linked")

    (status, _, text), _ = teacher.launch(edx, "LtiDeepLinkingRequest")
    assert status == 200, text
    ticket = html.unescape(re.search(r'name="ticket" value="([^"]+)"', text)[1])
    chosen = urllib.parse.urlencode([("ticket", ticket), ("lesson", "screw"), ("lesson", LESSON)])
    status, _, text = teacher.ask(f"{tool}/lti/choice", chosen, "application/x-www-form-urlencoded")
    items = edx.check_and_decode_deep_linking_token(re.search(r'name="JWT" value="([^"]+)"', text)[1])
    step(f"lessons chosen, and Open edX takes them: {[item['title'] for item in items]}")
    assert [item["lineItem"]["resourceId"] for item in items] == [LESSON, "screw"], items

    edx.set_user_data("ada", "student", full_name="Ada Lovelace")
    again, form = ada.launch(edx)
    assert again[0] == 303, again
    me = ada.json("/api/v1/me")["person"]
    assert (me["name"], me["role"]) == ("Ada Lovelace", "student"), me
    step(f"a student opened the lesson: {me['name']}, {me['role']}")
    refused((ada.ask(f"{tool}/lti/launch", urllib.parse.urlencode(form), "application/x-www-form-urlencoded"), 0), "lti-browser")
    other = rsa.generate_private_key(public_exponent=65537, key_size=2048).private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    eve = platform.consumer(tool, other)
    eve.set_user_data("prof", "instructor", full_name="Eve")
    refused(Browser(tool).launch(eve), "lti-signature")

    lesson = ada.json(f"/api/v1/lessons/{LESSON}")
    right = f"{3 * 9.81 * lesson['scene']['bodies'][0]['mass']:.4f}"
    for value in ["1.000", right]:
        platform.arrived.clear()
        body = json.dumps({"answers": {"tension-bottom": {"value": value, "unit": "N"}}})
        verdict = ada.json(f"/api/v1/lessons/{LESSON}/submissions", body)
        assert platform.arrived.wait(PATIENCE), "no score came"
        step(f"handed in, earned {verdict['earned']}; the platform has {json.dumps(platform.scores[-1])}")
    given = [score["scoreGiven"] for score in platform.scores]
    times = [score["timestamp"] for score in platform.scores]
    assert given == [0.0, 3.0] and times == sorted(set(times)), (given, times)
    assert {score["userId"] for score in platform.scores} == {"ada"}

    taken = teacher.json("/api/v1/lti/roster", "{}")
    assert taken == {"listed": 2, "new": 1}, taken
    names = sorted(one["name"] for one in teacher.json("/api/v1/people"))
    step(f"roster taken over: {names}")
    state = teacher.json("/api/v1/lti")["platforms"][0]
    assert [(one["lesson"], one["sent"]) for one in state["columns"]] == [(LESSON, 1)], state


def main():
    program = str(Path(sys.argv[1]).resolve())
    print("A session with Open edX's platform:")
    with tempfile.TemporaryDirectory() as folder:
        session(program, folder)
    if len(sys.argv) > 2:
        word = json.loads(Path(sys.argv[2]).read_text())
        Judge(word["token"], word["keys"], word["issuer"]).judged()
        step("PyLTI1p3 accepts the word of the small platform in Triad's own tests")
    print("All as it should be.")


main()
