"""A session between Triad and an institution's sign-in that others wrote, step by step.

The sign-in is django-oauth-toolkit, an OpenID Connect provider for Django that demands PKCE; what a browser does is done by urllib, with
a jar of cookies for each person.

`cargo verify oidc` runs it. By hand: target/oidc/venv/bin/python tests/oidc/session.py target/release/triad
"""

import http.cookiejar
import json
import re
import socket
import subprocess
import sys
import tempfile
import threading
import urllib.error
import urllib.parse
import urllib.request
from pathlib import Path
from socketserver import ThreadingMixIn
from wsgiref.simple_server import WSGIRequestHandler, WSGIServer, make_server

import django
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import rsa
from django.conf import settings

CLIENT, SECRET = "triad-at-school", "a secret: with signs & more"
FOLDER = tempfile.TemporaryDirectory()


def key():
    made = rsa.generate_private_key(public_exponent=65537, key_size=2048)
    coded = made.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    return coded.decode()


def free_port():
    with socket.socket() as held:
        held.bind(("127.0.0.1", 0))
        return held.getsockname()[1]


PORT = free_port()
ISSUER = f"http://127.0.0.1:{PORT}/o"
settings.configure(
    SECRET_KEY="for-this-test",
    ALLOWED_HOSTS=["127.0.0.1"],
    ROOT_URLCONF=__name__,
    DATABASES={"default": {"ENGINE": "django.db.backends.sqlite3", "NAME": str(Path(FOLDER.name) / "provider.db")}},
    INSTALLED_APPS=["django.contrib.auth", "django.contrib.contenttypes", "django.contrib.sessions", "oauth2_provider"],
    MIDDLEWARE=[
        "django.contrib.sessions.middleware.SessionMiddleware",
        "django.contrib.auth.middleware.AuthenticationMiddleware",
    ],
    DEFAULT_AUTO_FIELD="django.db.models.BigAutoField",
    LOGIN_URL="/login",
    USE_TZ=True,
    OAUTH2_PROVIDER={
        "OIDC_ENABLED": True,
        "OIDC_ISS_ENDPOINT": ISSUER,
        "OIDC_RSA_PRIVATE_KEY": key(),
        "PKCE_REQUIRED": True,
        "SCOPES": {"openid": "who you are"},
    },
)
django.setup()

from django.contrib.auth import authenticate, get_user_model, login  # noqa: E402
from django.core.management import call_command  # noqa: E402
from django.core.wsgi import get_wsgi_application  # noqa: E402
from django.http import HttpResponse  # noqa: E402
from django.urls import include, path  # noqa: E402
from oauth2_provider.models import get_application_model  # noqa: E402


def sign_in(request):
    """The page of the institution on which people say who they are."""
    user = authenticate(request, username=request.GET["name"], password=request.GET["password"])
    login(request, user)
    return HttpResponse("signed in")


urlpatterns = [path("o/", include("oauth2_provider.urls")), path("login", sign_in)]


class Quiet(WSGIRequestHandler):
    def log_message(self, *_):
        pass


class Threads(ThreadingMixIn, WSGIServer):
    daemon_threads = True


def step(text):
    print(f"  {text}", flush=True)


class Browser:
    """Somebody's browser: it keeps cookies and follows links."""

    def __init__(self):
        self.jar = http.cookiejar.CookieJar(http.cookiejar.DefaultCookiePolicy(secure_protocols=("http", "https")))
        self.opener = urllib.request.build_opener(urllib.request.HTTPCookieProcessor(self.jar))

    def open(self, address, method="GET", body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(address, data=data, method=method)
        if data is not None:
            request.add_header("Content-Type", "application/json")
        try:
            with self.opener.open(request, timeout=60) as answer:
                return answer.status, answer.geturl(), answer.read()
        except urllib.error.HTTPError as refused:
            return refused.code, refused.geturl(), refused.read()

    def ask(self, address, method="GET", body=None):
        status, _, answer = self.open(address, method, body)
        assert status < 300, (address, status, answer)
        return json.loads(answer) if answer else None

    def is_known_to_institution(self, name):
        status, _, answer = self.open(f"http://127.0.0.1:{PORT}/login?name={name}&password=four-words")
        assert (status, answer) == (200, b"signed in")


def register(home):
    application = get_application_model()
    for who in ["noether", "somebody"]:
        get_user_model().objects.create_user(who, password="four-words")
    application.objects.create(
        name="Triad",
        client_id=CLIENT,
        client_secret=SECRET,
        client_type=application.CLIENT_CONFIDENTIAL,
        authorization_grant_type=application.GRANT_AUTHORIZATION_CODE,
        redirect_uris=f"{home}/oidc/callback",
        algorithm=application.RS256_ALGORITHM,
        skip_authorization=True,
    )


def play(home, setup):
    teacher = Browser()
    teacher.ask(f"{home}/api/v1/setup", "POST", {"token": setup, "name": "Noether"})
    me = teacher.ask(f"{home}/api/v1/me")
    assert me["institution"] == {"name": "the school", "connected": False}, me
    step("a teacher follows the invitation; the server knows the institution's sign-in by its description")

    elsewhere = Browser()
    elsewhere.is_known_to_institution("noether")
    status, where, answer = elsewhere.open(f"{home}/oidc/login")
    assert status == 403 and json.loads(answer)["code"] == "oidc-unknown", (status, where, answer)
    step("an account that nobody has connected does not come in")

    teacher.is_known_to_institution("noether")
    status, where, _ = teacher.open(teacher.ask(f"{home}/api/v1/me/account", "POST")["to"])
    assert (status, where) == (200, f"{home}/class"), (status, where)
    assert teacher.ask(f"{home}/api/v1/me")["institution"]["connected"]
    step("the teacher connects the account: code and verifier against a signed word")

    status, where, _ = elsewhere.open(f"{home}/oidc/login")
    assert (status, where) == (200, f"{home}/class"), (status, where)
    person = elsewhere.ask(f"{home}/api/v1/me")["person"]
    assert (person["name"], person["role"]) == ("Noether", "owner"), person
    step("in another browser the account leads to the same person, in the role that the class gives")

    other = Browser()
    other.is_known_to_institution("somebody")
    status, _, answer = other.open(f"{home}/oidc/login")
    assert status == 403 and json.loads(answer)["code"] == "oidc-unknown", answer
    step("another account of the same institution does not come in")

    settings.OAUTH2_PROVIDER["OIDC_RSA_PRIVATE_KEY"] = key()
    from oauth2_provider.settings import oauth2_settings

    oauth2_settings.reload()
    status, _, answer = Browser.open(elsewhere, f"{home}/oidc/login")
    assert status == 403 and json.loads(answer)["code"] == "oidc-key", (status, answer)
    step("a new key of the institution is not fetched again at once: somebody who makes words up would have it fetched each time")

    assert teacher.open(f"{home}/api/v1/me/account", "DELETE")[0] == 204
    assert not teacher.ask(f"{home}/api/v1/me")["institution"]["connected"]
    step("the teacher disconnects the account")


def main():
    call_command("migrate", verbosity=0)
    server = make_server("127.0.0.1", PORT, get_wsgi_application(), Threads, Quiet)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    port = free_port()
    home = f"http://127.0.0.1:{port}"
    register(home)
    words = ["serve", "--class", "--port", str(port), "--url", home, "--oidc-issuer", ISSUER, "--oidc-name", "the school"]
    words += ["--oidc-client-id", CLIENT, "--oidc-client-secret", SECRET, "--database", "grades.db"]
    program = Path(sys.argv[1]).resolve()
    triad = subprocess.Popen([program, *words], stdout=subprocess.PIPE, text=True, cwd=FOLDER.name)
    try:
        for line in triad.stdout:
            if found := re.search(r"/setup#(\w+)", line):
                break
        play(home, found.group(1))
    finally:
        triad.kill()
        triad.wait()
    print("the session went well")


main()
