// Who teaches signs in with the account of their institution, below a path of another site. Started by tests/tests/browser.rs:
//   node oidc.mjs http://127.0.0.1:PORT PICTURE_FOLDER SETUP_LINK PORT_OF_THE_INSTITUTION
// The button before and after the account is connected, what is told to whom nobody knows and to whom the institution refuses, and
// the page after signing out; axe on each of them. The institution is a provider as small as it can be, in this file.
import assert from "node:assert/strict";
import { createHash, generateKeyPairSync, sign } from "node:crypto";
import { mkdirSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { faults, launch, say, SERIOUS } from "./browser.mjs";

const [, pictures, setup, port] = process.argv.slice(2);
const home = setup.split("/setup#")[0];
const issuer = `http://127.0.0.1:${port}`;
mkdirSync(pictures, { recursive: true });
// Ends a visit that hangs, and decides nothing else.
const PATIENCE = 300_000;

const { publicKey, privateKey } = generateKeyPairSync("rsa", { modulusLength: 2048 });
const coded = (value) => Buffer.from(JSON.stringify(value)).toString("base64url");
/** Whether the institution is away. */
let isAway = false;
/** What was asked for each code that was given. */
const codes = new Map();
/** A word that the institution signs. */
function signed(claims) {
  const text = `${coded({ alg: "RS256", kid: "one" })}.${coded(claims)}`;
  return `${text}.${sign("sha256", Buffer.from(text), privateKey).toString("base64url")}`;
}
const answers = {
  "/.well-known/openid-configuration": () => ({
    issuer, authorization_endpoint: `${issuer}/auth`, token_endpoint: `${issuer}/token`, jwks_uri: `${issuer}/keys`,
  }),
  "/keys": () => ({ keys: [{ ...publicKey.export({ format: "jwk" }), kid: "one", alg: "RS256", use: "sig" }] }),
  "/token": (words) => {
    const { asked, who } = codes.get(words.get("code"));
    codes.delete(words.get("code"));
    assert.equal(words.get("redirect_uri"), `${home}/oidc/callback`);
    assert.equal(createHash("sha256").update(words.get("code_verifier")).digest("base64url"), asked.get("code_challenge"));
    const now = Math.floor(Date.now() / 1000);
    const word = { iss: issuer, aud: "triad", sub: who, iat: now, exp: now + 300, nonce: asked.get("nonce") };
    return { access_token: "none", token_type: "Bearer", id_token: signed(word) };
  },
};
/** The page on which people say who they are: a link for each answer. */
function page(asked) {
  const back = (words) => `${asked.get("redirect_uri")}?${new URLSearchParams({ ...words, state: asked.get("state") })}`;
  const links = ["emmy", "somebody"].map((who) => {
    const code = `${who} ${codes.size}`;
    codes.set(code, { asked, who });
    return [`I am ${who}`, back({ code })];
  });
  const all = [...links, ["I would rather not", back({ error: "access_denied" })]];
  return `<h1>The school</h1>${all.map(([text, to]) => `<p><a href="${to.replaceAll("&", "&amp;")}">${text}</a></p>`).join("")}`;
}
const institution = createServer(async (request, response) => {
  const { pathname, searchParams } = new URL(request.url, issuer);
  let body = "";
  for await (const part of request) body += part;
  const isPage = pathname === "/auth";
  if (isAway && !isPage) response.statusCode = 503;
  response.setHeader("content-type", isPage ? "text/html" : "application/json");
  response.end(isPage ? page(searchParams) : JSON.stringify(answers[pathname]?.(new URLSearchParams(body)) ?? null));
}).listen(Number(port), "127.0.0.1");

const browser = await launch();
const complaints = [];
/** A browser of its own. */
async function visitor(name) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, bypassCSP: true, reducedMotion: "reduce" });
  const view = await context.newPage();
  view.setDefaultTimeout(PATIENCE);
  view.on("pageerror", (error) => complaints.push(`${name}: ${error}`));
  return view;
}
/** A picture, and no serious fault. */
async function look(view, name) {
  await view.screenshot({ path: join(pictures, `oidc-${name}.png`), fullPage: true });
  assert.deepEqual(await faults(view, { impacts: SERIOUS }), [], `axe on ${name}`);
  say(`looked at ${name}`);
}
const SIGN_IN = "Sign in with the school";
/** From the page of the class to that of the institution, and back with an answer. */
async function signIn(view, answer) {
  if (view.url() !== `${home}/join`) await view.goto(`${home}/join`);
  await view.getByRole("button", { name: SIGN_IN }).click();
  await view.getByRole("link", { name: answer }).click();
}
/** The page that says why somebody does not come in. */
async function refused(view, code) {
  await view.getByRole("heading", { name: "This did not work" }).waitFor();
  const text = await view.locator("main").innerText();
  assert(text.includes(code) && text.includes("What to do:"), text);
}
/** From there to the ways in. */
const again = async (view) => {
  await view.getByRole("link", { name: "To the ways in" }).click();
  await view.getByRole("button", { name: SIGN_IN }).waitFor();
};

const owner = await visitor("owner");
await owner.goto(setup);
await owner.getByLabel("Your name, as students see it").fill("Noether");
await owner.getByRole("button", { name: "Begin" }).click();
await owner.getByText("Welcome, Noether").waitFor();

const other = await visitor("other");
await other.goto(`${home}/join`);
await other.getByRole("button", { name: SIGN_IN }).waitFor();
await look(other, "sign-in");
await signIn(other, "I am emmy");
await refused(other, "oidc-unknown");
await look(other, "refused");
await again(other);

// Whoever is in connects the account: a press on the name at the top.
const name = (view) => view.getByRole("button", { name: "Noether, your account" });
await owner.getByRole("link", { name: "To the class" }).click();
await name(owner).click();
await look(owner, "connect");
await owner.getByRole("button", { name: "Connect the school" }).click();
await owner.getByRole("link", { name: "I am emmy" }).click();
await owner.waitForURL(`${home}/class`);
await name(owner).click();
await owner.getByText("You also come back with the account of your institution").waitFor();
await look(owner, "connected");

await signIn(other, "I am emmy");
await other.waitForURL(`${home}/class`);
await name(other).waitFor();
await look(other, "signed-in");
await name(other).click();
await other.getByRole("button", { name: "Sign out of this browser" }).click();
await other.waitForURL(`${home}/`);
await other.getByRole("button", { name: "Sign in" }).first().waitFor();
await look(other, "signed-out");

await signIn(other, "I am somebody");
await refused(other, "oidc-unknown");
await signIn(other, "I would rather not");
await refused(other, "oidc-reported");
await look(other, "reported");

await owner.getByRole("button", { name: "Disconnect this account" }).click();
await name(owner).click();
await owner.getByRole("button", { name: "Connect the school" }).waitFor();
await signIn(other, "I am emmy");
await refused(other, "oidc-unknown");
// A fault that is nobody's here: a person gets a page, too.
isAway = true;
await signIn(other, "I am emmy");
await refused(other, "oidc-provider");
await look(other, "away");
assert.deepEqual(complaints, []);
say("an account of the institution, from the first press to the last");
await browser.close();
institution.close();
