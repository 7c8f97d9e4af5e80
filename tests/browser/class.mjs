// A class as its teacher runs it, with students in it. Started by tests/tests/browser.rs:
//   node class.mjs http://127.0.0.1:PORT PICTURE_FOLDER SETUP_LINK
// From the setup link to lessons without students, people and roles, students who hand in, the class at a glance while they
// do, a question with the mistakes behind it, and what other programs take along; axe on every page, in light and in dark.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { faults, launch, say, SERIOUS, walk } from "./browser.mjs";

const [address, pictures, setup] = process.argv.slice(2);
// Ends a visit that hangs, and decides nothing else.
const PATIENCE = 300_000;
const browser = await launch();
const complaints = [];

/** A browser of its own. */
async function visitor(name) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, bypassCSP: true, reducedMotion: "reduce" });
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE);
  page.on("pageerror", (error) => complaints.push(`${name}: ${error}`));
  return page;
}

/** Pictures in light and in dark, and no serious fault in either. */
async function look(page, view, { fullPage = true } = {}) {
  for (const theme of ["light", "dark"]) {
    await page.evaluate((wanted) => { document.documentElement.dataset.theme = wanted; }, theme);
    await page.screenshot({ path: join(pictures, `class-${view}-${theme}.png`), fullPage });
    assert.deepEqual(await faults(page, { impacts: SERIOUS }), [], `axe on ${view}, ${theme}`);
  }
  await page.evaluate(() => { document.documentElement.dataset.theme = "light"; });
  say(`looked at ${view}`);
}

/** Nothing of the page runs over its edge, on a desk or on a phone. */
async function fits(page, view) {
  for (const width of [390, 1280]) {
    await page.setViewportSize({ width, height: 900 });
    const over = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    assert(over <= 0, `${view} is ${over} px wider than ${width}`);
  }
}

/** Asks the server as somebody who has come in. */
async function ask(method, path, cookie, body) {
  const reply = await fetch(`${address}/api/v1${path}`, {
    method, headers: { cookie: cookie ?? "", ...(body ? { "content-type": "application/json" } : {}) },
    body: body ? JSON.stringify(body) : undefined,
  });
  const text = await reply.text();
  assert(reply.ok, `${method} ${path}: ${reply.status} ${text}`);
  return { cookie: reply.headers.get("set-cookie")?.split(";")[0], json: text ? JSON.parse(text) : undefined };
}

const LESSON = "simple-pendulum";
/** A student who hands in the force at the bottom, as multiples of the bob's weight. */
async function student(name, code, factors, sign) {
  const { cookie } = await ask("POST", "/join", undefined, { code, name });
  const lesson = (await ask("GET", `/lessons/${LESSON}`, cookie)).json;
  const weight = 9.81 * lesson.scene.bodies[0].mass;
  const handIn = (factor) => ask("POST", `/lessons/${LESSON}/submissions`, cookie, {
    answers: { "tension-bottom": { value: (factor * weight).toFixed(4), unit: "N" }, "sign-of-lambda": { choice: sign } },
  });
  for (const factor of factors) await handIn(factor);
  return { cookie, handIn };
}

async function begin() {
  const page = await visitor("owner");
  await page.goto(setup);
  await page.getByLabel("Your name, as students see it").fill("Prof. Newton");
  await page.getByLabel("Title of the class").fill("Mechanics II");
  await page.getByRole("button", { name: "Begin" }).click();
  await page.getByText("Welcome, Prof. Newton").waitFor();
  await page.getByRole("link", { name: "To the class" }).click();
  await page.getByRole("heading", { name: "Nobody has joined yet" }).or(page.getByText("Nobody has joined yet")).first().waitFor();
  await look(page, "empty");
  await page.getByRole("button", { name: "For the whole hall" }).click();
  await page.getByRole("dialog").getByText("Join the class").waitFor();
  await look(page, "for-the-hall", { fullPage: false });
  await page.keyboard.press("Escape");
  // Who types the code of the class where that of a lecture is asked for comes to the class.
  const { join_code } = await page.evaluate(() => fetch("/api/v1/course").then((reply) => reply.json()));
  const guest = await visitor("guest");
  await guest.goto(`${address}/room`);
  await guest.getByLabel("Code or name of the room").fill(join_code);
  await guest.keyboard.press("Enter");
  await guest.getByRole("button", { name: "Join the class" }).waitFor();
  assert.equal(await guest.getByLabel("Code of the class").inputValue(), join_code);
  await guest.context().close();
  // Dates and questions are there before anybody has joined.
  await page.getByRole("link", { name: /simple pendulum/i }).click();
  await page.getByRole("heading", { name: "When it is handed in, and what is told" }).waitFor();
  await page.getByRole("link", { name: "tension-bottom" }).click();
  await page.getByText("Nobody has handed in yet").waitFor();
  const code = (await page.evaluate(() => fetch("/api/v1/course").then((reply) => reply.json()))).join_code;
  return { page, code };
}

async function people(page) {
  await page.goto(`${address}/class/people`);
  await page.getByLabel("Who comes with the link is").selectOption("grader");
  await page.getByRole("button", { name: "Make a link" }).click();
  const link = await page.getByLabel("Link for a new grader").inputValue();
  const other = await visitor("grader");
  await other.goto(link);
  await other.getByLabel("Your name, as students see it").fill("Gottfried");
  await other.getByRole("button", { name: "Begin" }).click();
  await other.getByText("Welcome, Gottfried").waitFor();
  await page.reload();
  const role = page.getByLabel("Role of Gottfried");
  assert.equal(await role.inputValue(), "grader");
  await role.selectOption("instructor");
  await look(page, "role");
  await page.getByRole("button", { name: "Make Gottfried instructor" }).click();
  await page.waitForFunction(() => document.querySelector("[aria-label='Role of Gottfried']")?.value === "instructor");
  // Whoever is no owner sees roles and changes none.
  await other.goto(`${address}/class/people`);
  await other.getByText("by an owner of the class").waitFor();
  assert.equal(await other.getByLabel("Role of Prof. Newton").count(), 0);
  await other.context().close();
  await page.reload();
  await role.waitFor();
  await look(page, "people");
}

async function glance(page, code) {
  await page.goto(`${address}/class/now`);
  await page.getByText("Nobody has read or tried anything").waitFor();
  const names = ["Ada Lovelace", "Émilie du Châtelet", "Sofia Kovalevskaya", "Leonhard Euler", "Joseph-Louis Lagrange", "Jean d’Alembert",
    "William Hamilton", "Siméon Poisson", "Carl Jacobi", "Louis Poinsot", "Emmy Noether", "Theodore von Kármán"];
  const tries = [[3], [1, 3], [1, 1.2, 3], [1, 2, 3], [1, 2], [1], [3.02], [2, 3], [-3, 3], [1.5, 1.7], [1, 3], [3]];
  const students = [];
  for (const [k, name] of names.entries()) students.push(await student(name, code, tries[k], "abcb"[k % 4]));
  // The page sees it by itself.
  await page.getByText("Here: 12 of 12 students").waitFor();
  assert.match(await page.getByRole("region", { name: "Just handed in" }).innerText(), /Theodore von Kármán/);
  await page.getByText("Nobody has tried a question three times").waitFor();
  await students[9].handIn(1.9);
  await page.locator(".cards", { hasText: "3 tries at" }).getByText("Louis Poinsot").waitFor();
  await look(page, "glance");
  await students[9].handIn(3);
  await page.getByText("Nobody has tried a question three times").waitFor();
  say("who is stuck, and no more");
  return students;
}

async function question(page) {
  await page.goto(`${address}/class/lessons/${LESSON}`);
  const row = page.getByRole("row", { name: /tension-bottom/ });
  await row.waitFor();
  assert.match(await row.innerText(), /12 of 12/);
  await look(page, "lesson");
  await row.getByRole("link", { name: "tension-bottom" }).click();
  await page.getByRole("heading", { name: "Mistakes" }).waitFor();
  const first = page.locator(".mistakes summary").first();
  assert.match(await first.innerText(), /6 of 12\s+static/);
  assert.equal(await page.getByText("Émilie").filter({ visible: true }).count(), 0, "no names before a press");
  await first.focus();
  await page.keyboard.press("Enter");
  await page.getByRole("link", { name: "Émilie du Châtelet" }).waitFor();
  await look(page, "question");
  await page.getByRole("link", { name: "Next →" }).waitFor();
  await page.goto(`${address}/class/lessons/${LESSON}/questions/sign-of-lambda`);
  await page.getByRole("heading", { name: "What was chosen" }).waitFor();
  await look(page, "choice");
  await fits(page, "a question with options");
  await page.goBack();
  await page.locator(".mistakes summary").first().click();
  await page.getByRole("link", { name: "Émilie du Châtelet" }).click();
  await page.getByRole("heading", { name: "Émilie du Châtelet" }).waitFor();
  await page.locator(".history-entry").first().click();
  await look(page, "student");
  await fits(page, "a student");
}

const SAID = "virtual-work";
/** What the class predicted and explained: read with names, marked, and shown in the lecture room without names. */
async function said(page, students) {
  const asked = (await ask("GET", `/lessons/${SAID}`, students[0].cookie)).json;
  const [{ id, options }] = asked.predictions;
  // Each has the forty words that are asked for.
  const texts = [
    "The bar can only push or pull along itself, because its ends turn freely. A virtual displacement goes along the circle, so this force does no work in it, and one number says how large it is and which way it goes.",
    "There is one rule for the mass, so there is one unknown number. The force of the bar points along the gradient of this rule, and the two components of the force are both given by it and by the multiplier alone.",
    "Because of Newton. The bar holds the mass and the mass holds the bar, so the force of the bar is what is left when weight and acceleration are known; I would say it is one number because it is one bar.",
  ];
  for (const [k, { cookie }] of students.entries()) {
    await ask("POST", `/lessons/${SAID}/predictions`, cookie, { prediction: id, choice: k === 5 ? null : options[k % 3].id, why: k % 4 === 0 ? "it has to turn" : "" });
    if (k < texts.length) await ask("POST", `/lessons/${SAID}/submissions`, cookie, { answers: { "in-words": { value: texts[k] } } });
  }
  await page.goto(`${address}/class/lessons/${SAID}#said`);
  await page.getByText("3 explanations wait for their points.").waitFor();
  const first = page.locator(".said", { hasText: "Ada Lovelace" });
  await first.getByText("it has to turn").waitFor();
  assert.match(await first.locator("blockquote").innerText(), /does no work/);
  await look(page, "said");
  await page.setViewportSize({ width: 390, height: 844 });
  await look(page, "said-phone");
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  assert(wide <= 0, `the class's words are ${wide} px wider than a phone`);
  await page.setViewportSize({ width: 1280, height: 900 });

  await first.getByLabel(/^Points, of/).fill("1.5");
  await first.getByLabel("Remark").fill("where does its size come from?");
  await page.keyboard.press("Enter");
  await first.getByText("1.5 of 2 points given.").waitFor();
  await page.getByText("2 explanations wait for their points.").waitFor();
  await page.getByRole("button", { name: "Give all that wait full points" }).click();
  await page.getByRole("dialog").getByRole("button", { name: "Give them" }).click();
  await page.getByText("No explanation waits for points.").waitFor();
  await first.getByText(/1\.5 of 2 points by Prof\. Newton/).waitFor();
  say("explanations were read and marked");
  await hall(page);
}

/** The same from the lesson's page, in the lecture room: nobody's name, and what came true only at a press. */
async function hall(page) {
  await page.goto(`${address}/lessons/${SAID}`);
  await page.getByRole("button", { name: "Lecture: let others follow this run" }).click();
  await page.getByRole("dialog").getByText("Join this lecture").waitFor();
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "What the class said" }).click();
  const box = page.getByRole("dialog");
  await box.getByText("1 skipped it.").waitFor();
  await box.getByText("The shortest first, without names.").waitFor();
  assert.match(await box.locator(".said-text").innerText(), /gradient|Newton|virtual/);
  await box.getByText("1 of 3").waitFor();
  await box.getByRole("button", { name: "Next →" }).click();
  await box.getByText("2 of 3").waitFor();
  assert.doesNotMatch(await box.innerText(), /Lovelace|Châtelet|Kovalevskaya/);
  await look(page, "hall", { fullPage: false });
  assert.equal(await box.getByText("right answer", { exact: false }).count(), 0, "what came true is not told yet");
  await box.getByRole("button", { name: "What came true" }).first().click();
  await look(page, "hall-told", { fullPage: false });
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "End the lecture" }).click();
  say("shown in the lecture room without names");
}

async function exchange(page, students) {
  await ask("POST", "/record/requests", students[3].cookie, { lesson: LESSON, text: "is that not right too?" });
  await page.goto(`${address}/class`);
  await page.getByRole("heading", { name: "12 students" }).waitFor();
  await page.locator(".askers", { hasText: "1 asks for a look again" }).getByRole("link", { name: "Leonhard Euler" }).waitFor();
  await look(page, "table");
  const file = "Student,ID,SIS User ID,SIS Login ID,Section,02 Simple pendulum (4711)\n\"Lovelace, Ada\",9,,,M,\nNobody,10,,,M,3\n";
  const title = await page.locator(".lesson-links a", { hasText: /simple pendulum/i }).innerText();
  const download = page.waitForEvent("download");
  await page.getByLabel("File of Canvas").setInputFiles({
    name: "canvas.csv", mimeType: "text/csv", buffer: Buffer.from(file.replace("02 Simple pendulum", `02 ${title}`)),
  });
  const filled = readFileSync(await (await download).path(), "utf8");
  assert.match(filled, /"Lovelace, Ada","9","","","M","[1-9]/);
  await page.getByText("In the file, and not in this class: Nobody.").waitFor();
  say("a file of Canvas was filled in");
}

async function own({ cookie }) {
  const page = await visitor("student");
  const [name, value] = cookie.split("=");
  await page.context().addCookies([{ name, value, url: address }]);
  await page.goto(`${address}/record`);
  await page.getByText(/pendulum/i).first().waitFor();
  await look(page, "own");
  await page.goto(`${address}/class/now`);
  await page.getByText(/may not do this/).waitFor();
}

async function all() {
  const { page, code } = await begin();
  await people(page);
  const students = await glance(page, code);
  await question(page);
  await said(page, students);
  await exchange(page, students);
  await own(students[1]);
}

await walk({ name: "class", pictures, browser, complaints }, all);
