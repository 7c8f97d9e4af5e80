// The workbench as people use it beside lesson 2's mouse. Started by tests/tests/browser.rs:
//   node workbench.mjs http://127.0.0.1:PORT PICTURE_FOLDER
// By keyboard alone from the course to the grade; looking back, files, link; a lecture with a follower on a phone;
// what helps when something is gone; and axe on every view.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { faults, launch, say, SERIOUS, until, walk } from "./browser.mjs";
import { pendulum } from "./pendulum.mjs";

const [address, pictures] = process.argv.slice(2);
const browser = await launch();
const complaints = [];

/** A browser of its own. */
async function visitor(name, size = { width: 1280, height: 900 }, more = {}) {
  const context = await browser.newContext({ viewport: size, bypassCSP: true, permissions: ["clipboard-read", "clipboard-write"], ...more });
  const page = await context.newPage();
  page.setDefaultTimeout(60_000);
  page.on("pageerror", (error) => complaints.push(`${name}: ${error}`));
  return page;
}

/** What a follower loads until the mechanism moves with the presenter, bytes: a lecture hall has one network. */
const MOST_FOLLOWED = 200e3;
async function noSeriousFaults(page, view) {
  assert.deepEqual(await faults(page, { impacts: SERIOUS }), [], `axe on ${view}`);
}
const clock = (page) => page.locator(".clock").evaluate((field) => Number(field.value));
/** Walks with Tab until the focus satisfies a CSS selector. */
async function tabTo(page, selector, key = "Tab") {
  for (let steps = 0; steps < 150; steps += 1) {
    await page.keyboard.press(key);
    if (await page.evaluate((wanted) => document.activeElement?.matches(wanted) === true, selector)) return;
  }
  throw new Error(`no way by ${key} to ${selector}`);
}

async function byKeyboard() {
  const page = await visitor("keyboard", undefined, { reducedMotion: "reduce" });
  await page.goto(`${address}/`);
  await page.getByRole("link", { name: /pendulum/i }).first().waitFor();
  await noSeriousFaults(page, "the course");
  await tabTo(page, "a[href='/lessons/simple-pendulum']");
  await page.keyboard.press("Enter");
  await page.getByRole("heading", { name: /pendulum/i, level: 1 }).waitFor();
  await until("the clock starts", () => clock(page), (time) => time === 0);
  await page.keyboard.press(".");
  await until("the prediction is asked for", () => page.locator("#announce").innerText(), (text) => /run waits/.test(text));
  await noSeriousFaults(page, "the prediction");
  await tabTo(page, ".prediction-form .choice");
  await page.keyboard.press("Enter");
  await tabTo(page, ".prediction-form .labelled + .labelled input");
  await page.keyboard.type("Grace Hopper");
  await tabTo(page, ".prediction-form button.primary");
  await page.keyboard.press("Enter");
  await page.locator("#prediction").getByText("You predicted: As large as the weight").waitFor();
  await page.locator(".whose b", { hasText: "Grace Hopper" }).waitFor();
  await until("the clock starts anew", () => clock(page), (time) => time === 0);
  await page.keyboard.press(".");
  await until("a full stop steps by time", () => clock(page), (time) => time >= 0.099);
  await page.keyboard.press("ArrowRight");
  const stepped = await until("→ steps", () => clock(page), (time) => time > 0.1);
  await page.keyboard.press("ArrowLeft");
  await until("← goes back", () => clock(page), (time) => time < stepped);
  await page.keyboard.press("ArrowRight");
  await until("→ comes back to what is recorded", () => clock(page), (time) => time === stepped);
  await page.keyboard.press(" ");
  await until("space plays", () => clock(page), (time) => time > stepped + 0.2);
  await page.keyboard.press(" ");
  await until("a pause is told", () => page.locator("#announce").innerText(), (text) => /^Paused at/.test(text));
  await page.keyboard.press("f");
  await page.keyboard.press("?");
  await page.getByRole("dialog").getByText("Forces: selected joint").waitFor();
  await noSeriousFaults(page, "the help");
  await page.keyboard.press("Escape");
  await noSeriousFaults(page, "lesson 2");
  const right = await pendulum(page, "Grace Hopper");
  const names = await page.locator(".question input:not([type=radio])").evaluateAll((fields) => fields.map((field) => field.getAttribute("aria-label")));
  assert(names.length > 4 && new Set(names).size === names.length && names.every((name) => /^Question \d+: /.test(name)), JSON.stringify(names));
  const unit = async (id, value) => {
    if (await page.locator(`#q-${id}-unit`).count() === 0) return;
    await tabTo(page, `#q-${id}-unit`);
    await page.keyboard.type(value);
  };
  for (const [id, value, in_] of [["independent-rows", "11", ""], ["tension-bottom", right.tension, "N"], ["period", right.period, "s"]]) {
    await tabTo(page, `#q-${id}-value`);
    await page.keyboard.type(value);
    if (in_) await unit(id, in_);
  }
  for (const [at, axis] of ["x", "y", "z"].entries()) {
    await tabTo(page, `#q-force-on-ground-${axis}`);
    await page.keyboard.type(right.force[at]);
  }
  await unit("force-on-ground", "N");
  await tabTo(page, "input[type=radio]");
  for (let k = 0; k < 6 && !(await page.locator("#q-sign-of-lambda-b").isChecked()); k += 1) await page.keyboard.press("ArrowDown");
  await tabTo(page, "button.primary");
  await page.keyboard.press("Enter");
  await page.getByRole("heading", { name: "Your submissions (1)" }).waitFor();
  assert.match(await page.locator(".history-entry").first().innerText(), /12 of 12/);
  say("lesson 2 from the course to the grade, by keyboard alone");
  await page.context().close();
}

async function lookingBack() {
  const page = await visitor("looking back");
  await page.goto(`${address}/scenes/n-four-bar:2`);
  await until("the run starts", () => clock(page), (time) => time === 0);
  for (const goal of [0.1, 0.2, 0.3]) {
    await page.getByRole("button", { name: "Step by time" }).click();
    await until("a step", () => clock(page), (time) => time >= goal - 1e-9);
  }
  await page.getByRole("tab", { name: "Reactions" }).click();
  const force = () => page.locator(".joint .data td.strong").first().innerText();
  const newest = await until("reactions", force, (text) => / N$/.test(text));
  await page.locator(".timeline").fill("0.1");
  const then = await until("reactions of then", force, (text) => text !== newest);
  await page.getByText("At 0.100 s.").waitFor();
  await page.getByText(/^Estimated error at 0\.100 s, the largest of all: forces \S+\sN, moments about the joint \S+\sN\sm\.$/).waitFor();
  assert.equal(await page.getByRole("heading", { name: "Inspector", level: 2 }).count(), 1, "the joints' headings stand below one");
  await page.getByRole("tab", { name: "Jacobian" }).click();
  await page.getByText(/rank 59.*at 0\.100 s/).waitFor();
  await page.getByText(/of these \d+ rows (is|are) redundant/).first().waitFor();
  for (const which of ["augmented", "schur"]) {
    await page.locator("select:has(option[value=schur])").selectOption(which);
    await page.getByText(/more by fill, at 0\.100 s/).waitFor();
    await noSeriousFaults(page, `the ${which} matrix`);
  }
  // One link opens the same elsewhere.
  await page.getByRole("button", { name: "Copy a link to this view" }).click();
  const link = await until("the link", () => page.evaluate(() => navigator.clipboard.readText()), (text) => text.includes("show="));
  const other = await visitor("link");
  await other.goto(link);
  await until("the link's time", () => clock(other), (time) => time === 0.1);
  assert.equal(await other.getByRole("tab", { name: "Jacobian" }).getAttribute("aria-selected"), "true");
  await other.getByRole("tab", { name: "Reactions" }).click();
  await until("the same reaction", force, (text) => text === then);
  await other.context().close();
  // A time is typed with its unit or without; what is none is told, and stays to be mended.
  await page.locator(".clock").fill("abc");
  await page.locator(".clock").press("Enter");
  const typed = () => page.locator(".clock").evaluate((field) => `${field.value}: ${field.validationMessage}`);
  assert.match(await typed(), /^abc: Write a time in seconds/);
  await page.locator(".clock").fill("100");
  await page.locator(".clock").press("Enter");
  assert.match(await typed(), /^100: The run goes from 0 to \d+ s: write a time within/);
  await page.locator(".clock").fill("0.2 s");
  await page.locator(".clock").press("Enter");
  await until("the typed time", () => clock(page), (time) => time === 0.2);
  // Files.
  await page.getByRole("tab", { name: "Plots" }).click();
  for (const [kind, start] of [["CSV", "time,"], ["SVG", "<svg"], ["PNG", "\u0089PNG"]]) {
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: kind, exact: true }).click()]);
    assert(readFileSync(await download.path(), "latin1").startsWith(start), `${kind} is one`);
  }
  await noSeriousFaults(page, "the plots");
  await page.screenshot({ path: join(pictures, "workbench-plots.png") });
  say("looked back, opened a link, saved files");
  await page.context().close();
}

/** A phone that comes to a lecture, and the bytes that it has loaded. */
async function follower(locale) {
  const phone = await visitor(`follower in ${locale}`, { width: 390, height: 844 }, { locale });
  const network = await phone.context().newCDPSession(phone);
  await network.send("Network.enable");
  let loaded = 0;
  network.on("Network.loadingFinished", ({ encodedDataLength }) => { loaded += encodedDataLength; });
  return [phone, () => loaded];
}

async function lecture() {
  const presenter = await visitor("presenter");
  await presenter.goto(`${address}/scenes/spatial-double-pendulum`);
  await until("the run starts", () => clock(presenter), (time) => time === 0);
  await presenter.getByRole("button", { name: /Lecture: let others/ }).click();
  const code = await presenter.locator(".invite-code").innerText();
  await presenter.locator(".qr").waitFor();
  await noSeriousFaults(presenter, "the invitation");
  await presenter.screenshot({ path: join(pictures, "workbench-invite.png") });
  await presenter.keyboard.press("Escape");
  const [phone, loaded] = await follower("en");
  await phone.goto(`${address}/room`);
  await phone.getByLabel("Code or name of the room").fill(code.toLowerCase());
  await phone.getByRole("button", { name: "Join", exact: true }).click();
  const [german, loadedInGerman] = await follower("de");
  await german.goto(`${address}/room/${code}`);
  for (const page of [phone, german]) await page.getByRole("heading", { level: 1, name: /pendulum/i }).waitFor();
  await presenter.getByRole("button", { name: "Step by time" }).click();
  for (const [page, bytes, language] of [[phone, loaded, "en"], [german, loadedInGerman, "de"]]) {
    await until("the presenter's clock travels", () => clock(page), (time) => time >= 0.099);
    assert.equal(await page.locator("html").getAttribute("lang"), language);
    assert(bytes() > 20e3 && bytes() < MOST_FOLLOWED, `a follower (${language}) loads ${bytes()} bytes`);
    say(`a follower (${language}) loads ${(bytes() / 1e3).toFixed(0)} kB`);
  }
  await german.context().close();
  await presenter.getByRole("tab", { name: "Reactions" }).click();
  await presenter.locator(".joint-select").first().click();
  await phone.locator(".joint.is-selected").waitFor();
  await presenter.getByRole("button", { name: "Ask a question" }).click();
  await presenter.getByLabel(/Number of the right choice/).fill("2");
  await presenter.getByRole("button", { name: "Ask", exact: true }).click();
  await phone.getByRole("button", { name: "negative" }).click();
  await presenter.getByText("1 of 1 have answered").waitFor();
  assert.equal(await presenter.locator(".presenter .histogram").count(), 0, "nor does the presenter, whose page the projector shows");
  assert.equal(await phone.locator(".histogram").count(), 0, "followers see no result before the reveal");
  await noSeriousFaults(phone, "the question");
  await presenter.getByRole("button", { name: "Reveal" }).click();
  await phone.locator(".histogram .is-right").waitFor();
  await presenter.locator(".presenter .histogram .is-right").waitFor();
  await presenter.getByRole("button", { name: "Keep this state" }).click();
  await presenter.getByText("1 of 1", { exact: true }).waitFor();
  const kept = await clock(presenter);
  await presenter.locator(".timeline").fill("0");
  await until("another moment", () => clock(presenter), (time) => time === 0);
  await presenter.keyboard.press("PageDown");
  await until("a clicker brings the slide", () => clock(presenter), (time) => Math.abs(time - kept) < 0.01);
  await presenter.keyboard.press("b");
  assert(await presenter.locator(".curtain").isVisible(), "B blanks the screen");
  await presenter.keyboard.press("b");
  assert(await presenter.locator(".curtain").isHidden(), "and brings it back");
  await presenter.locator(".timeline").fill("0.04");
  await until("looking back travels", () => clock(phone), (time) => time === 0.04);
  await phone.locator(".timeline").fill("0.02");
  await until("roaming", () => phone.locator(".lecture-head .lead").innerText(), (text) => /on your own/.test(text));
  await phone.getByRole("button", { name: "Back to the lecture" }).click();
  await until("back with the presenter", () => clock(phone), (time) => time === 0.04);
  await phone.getByRole("button", { name: "Look around" }).click();
  await until("roaming by a button", () => phone.locator(".lecture-head .lead").innerText(), (text) => /on your own/.test(text));
  await presenter.locator(".timeline").fill("0.06");
  await presenter.getByText("1 looks around alone", { exact: false }).waitFor({ state: "attached" });
  assert.equal(await clock(phone), 0.04, "what is looked at alone stays");
  await phone.getByRole("button", { name: "Back to the lecture" }).click();
  await until("back again", () => clock(phone), (time) => time === 0.06);
  await phone.screenshot({ path: join(pictures, "workbench-follower.png"), fullPage: true });
  const width = await phone.evaluate(() => document.documentElement.scrollWidth);
  assert(width <= 390, `the follower's page is ${width} px wide`);
  await presenter.getByRole("button", { name: "End the lecture" }).click();
  await phone.getByText("The lecture is over.", { exact: false }).waitFor();
  say("a lecture: clock, selection, question, reveal, roaming, the end");
  await presenter.context().close();
  await phone.context().close();
}

async function trouble() {
  const page = await visitor("trouble");
  let session = "";
  page.on("response", (reply) => {
    if (reply.url().endsWith("/api/v1/sessions") && reply.request().method() === "POST") void reply.json().then((state) => { session = state.links?.self ?? session; });
  });
  await page.goto(`${address}/scenes/simple-pendulum`);
  await until("the run starts", () => session, (link) => link !== "");
  // The session expires.
  const first = session;
  await page.evaluate((link) => fetch(link, { method: "DELETE" }), first);
  await page.getByText("The simulation was gone from the server.").first().waitFor();
  assert.notEqual(session, first, "a fresh session took its place");
  // The server is gone, and comes back.
  await page.context().route("**/api/**", (route) => route.abort());
  await page.evaluate(() => undefined);
  const second = session;
  await page.context().unroute("**/api/**");
  await page.evaluate((link) => fetch(link, { method: "DELETE" }), second);
  await page.context().route("**/api/**", (route) => route.abort());
  await page.getByText("The connection to the server is lost.", { exact: false }).waitFor();
  await page.screenshot({ path: join(pictures, "workbench-server-gone.png") });
  await page.context().unroute("**/api/**");
  // It tries by itself too: the button may be gone before it is pressed.
  await page.getByRole("button", { name: "Try now" }).click({ timeout: 3000 }).catch(() => {});
  await page.getByText("The simulation was gone from the server.").first().waitFor();
  say("an expired session and a lost server are told and mended");
  // A run that cannot go on: the slider is driven farther than its rod is long.
  const scene = await page.evaluate(async () => (await fetch("/api/v1/scenes/spatial-slider-crank")).json());
  scene.drivers = [{ type: "slide", name: "push", joint: "D", motion: { kind: "ramp", start: 0.2, rate: 1 } }];
  await page.evaluate((text) => localStorage.setItem("triad:scene-draft", text), JSON.stringify(scene));
  await page.goto(`${address}/scenes/own`);
  const outcome = page.locator(".trouble .notice, .check .notice").first();
  await until("the run starts or is refused", async () => (await outcome.count()) > 0 || (await page.locator(".clock").count()) > 0, Boolean);
  await page.locator(".clock").waitFor();
  await page.locator(".clock").fill("2");
  await page.locator(".clock").press("Enter");
  await page.locator(".trouble .notice-title").waitFor();
  assert(await page.locator(".trouble .notice-hint").count() > 0, "it says what to try");
  await noSeriousFaults(page, "a run that stopped");
  await page.screenshot({ path: join(pictures, "workbench-stopped.png") });
  await page.locator(".trouble").getByRole("button", { name: "Reset to the start" }).click();
  await until("the notice goes", () => page.locator(".trouble .notice").count(), (count) => count === 0);
  say("a run that stopped says why and what to try");
  await page.context().close();
  // The viewer cannot be loaded: the drawing stays.
  const blocked = await visitor("no viewer");
  await blocked.context().addInitScript(() => localStorage.setItem("triad:picture", "viewer"));
  await blocked.context().route("**/*.wasm", (route) => route.abort());
  await blocked.goto(`${address}/scenes/simple-pendulum`);
  await blocked.getByText("The drawing and the tables show the same run.", { exact: false }).first().waitFor();
  await blocked.locator("canvas.drawing").waitFor();
  say("without the viewer the drawing stays");
  await blocked.context().close();
}

async function editing() {
  const page = await visitor("editor");
  await page.goto(`${address}/scenes`);
  await page.getByText("Import a robot (URDF)").click();
  await page.locator("#urdf-file").setInputFiles({ name: "arm.urdf", mimeType: "text/xml", buffer: readFileSync(new URL("../data/arm.urdf", import.meta.url)) });
  await page.getByRole("button", { name: "Import", exact: true }).click();
  await page.getByText("What could not be carried over:").waitFor();
  await noSeriousFaults(page, "the scenes");
  await page.getByRole("button", { name: "Open as your own scene" }).click();
  await page.getByText("It has 2 degrees of freedom.").waitFor();
  const area = page.locator("textarea.code");
  await area.evaluate((field) => { const at = field.value.indexOf('"mass"'); field.focus(); field.setSelectionRange(at, at); });
  await page.keyboard.press("Enter");
  await page.keyboard.press("ArrowUp");
  await page.keyboard.type('"coo');
  await page.locator(".suggest li").first().waitFor();
  await page.keyboard.press("Enter");
  await page.keyboard.type('"re');
  await page.locator(".suggest li").first().waitFor();
  await page.keyboard.press("Enter");
  await page.keyboard.type(",");
  assert.match(await area.inputValue(), /"coordinates": "reduced",\s+"mass"/);
  await until("degrees of freedom while typing", () => page.locator(".report .figure", { hasText: "Coordinates" }).innerText(), (text) => /21/.test(text));
  await area.evaluate((field) => { field.value = field.value.replace('"mass": 2', '"mass": -2'); field.dispatchEvent(new Event("input")); });
  await page.locator(".gutter .is-marked").waitFor();
  await noSeriousFaults(page, "the editor");
  await area.evaluate((field) => { field.value = field.value.replace('"mass": -2', '"masss": 2'); field.dispatchEvent(new Event("input")); });
  await page.getByRole("button", { name: "Write “mass” in place of “masss”" }).click();
  assert.match(await area.inputValue(), /"mass": 2/);
  await page.getByText("This scene can run.").waitFor();
  // What stands in the editor is handed in without the detour by the disk.
  const written = await area.inputValue();
  await page.goto(`${address}/lessons/slider-crank`);
  await page.getByRole("button", { name: "Hand in my own scene from the editor" }).click();
  assert.equal(await page.locator(".answer.is-file textarea").last().inputValue(), written);
  // And what the run beside the questions shows, with the numbers that it has now.
  await page.goto(`${address}/lessons/verification`);
  await until("the run starts", () => clock(page), (time) => time === 0);
  // Who only looks skips the prediction, and needs no name for it.
  await page.locator("#prediction").getByRole("button", { name: "Skip" }).click();
  const table = page.locator("#q-your-run textarea");
  const take = async () => {
    await table.fill("");
    await page.getByRole("button", { name: "Hand in this run’s table" }).click();
    return until("the table", () => table.inputValue(), (text) => text !== "");
  };
  const rows = await take();
  assert.deepEqual([rows.slice(0, 12), rows.trim().split("\n").length], ["t,x,y\n0,-1,0", 1002]);
  await page.locator("#q-your-run").screenshot({ path: join(pictures, "workbench-table.png") });
  await page.getByRole("tab", { name: "Parameters" }).click();
  const tolerance = page.getByLabel("Tolerance", { exact: true }).last();
  await tolerance.fill("0.01");
  await tolerance.press("Enter");
  await until("the run begins anew", async () => (await take()) !== rows, (changed) => changed);
  say("a robot imported, completion, freedoms while typing, an error at its place, what was meant, and the scene and a run's table handed in");
  await page.context().close();
}

/** What was computed of other numbers is not shown beside those of now. */
async function analyses() {
  const page = await visitor("analyses");
  await page.goto(`${address}/scenes/simple-pendulum`);
  await until("the run starts", () => clock(page), (time) => time === 0);
  const tab = (name) => page.getByRole("tab", { name, exact: true }).click();
  await tab("Analyses");
  await page.getByRole("button", { name: "Small vibrations" }).click();
  await page.getByText("0.498488").waitFor();
  await tab("Parameters");
  // With the unit that stands behind the field.
  const gravity = page.getByLabel(/^Gravity, in/);
  await gravity.fill("3 m/s²");
  await gravity.press("Enter");
  await tab("Analyses");
  await page.getByText("the result was of the numbers before").waitFor();
  assert.equal(await page.getByText("0.498488").count(), 0);
  await page.getByRole("button", { name: "Compute anew" }).click();
  await page.getByText("0.275664").waitFor();
  say("an analysis of numbers that were changed is taken away, and computed anew");
  await page.context().close();
}

await walk({ name: "workbench", pictures, browser, complaints }, byKeyboard, lookingBack, lecture, editing, analyses, trouble);
