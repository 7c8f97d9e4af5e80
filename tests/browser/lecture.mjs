// A lecture with three windows: the presenter's own, the projector's without controls, a phone. Started by tests/tests/browser.rs:
//   node lecture.mjs http://127.0.0.1:PORT PICTURE_FOLDER
// Votes hidden until revealed, asked a second time, side by side; hands; a question without a name that the presenter reads
// first; a clicker pressed in the projector's window; blank; the whole as a recording.
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { faults, launch, say, SERIOUS, until, walk } from "./browser.mjs";

const [address, pictures] = process.argv.slice(2);
const browser = await launch();
const complaints = [];
/** Largest file of this short lecture, bytes. */
const MOST_BYTES = 300_000;

async function visitor(name, size, more = {}) {
  const context = await browser.newContext({ viewport: size, bypassCSP: true, ...more });
  const page = await context.newPage();
  page.setDefaultTimeout(60_000);
  page.on("pageerror", (error) => complaints.push(`${name}: ${error}`));
  return page;
}
const clock = (page) => page.locator(".clock").evaluate((field) => Number(field.value));
const seen = (page) => page.locator(".screen-clock").innerText().then(parseFloat);
const press = (page, name) => page.getByRole("button", { name, exact: true }).click();

/** The lecture as a recording: it plays in the page, and from a file without a server. */
async function recorded(presenter, screen) {
  await press(presenter, "Reset to the start");
  await until("the start", () => clock(presenter), (time) => time === 0);
  await press(presenter, "Step by time");
  await until("a second run", () => clock(presenter), (time) => time > 0.05);
  await press(presenter, "Ask a question");
  await press(presenter, "Ask");
  await screen.locator(".screen-choices").waitFor();
  await presenter.getByText(/of 1 have answered/).waitFor();
  await press(presenter, "End the lecture");
  await screen.getByText("The lecture is over.").waitFor();
  const box = presenter.getByRole("dialog", { name: "The lecture as a recording" });
  const time = box.getByRole("slider", { name: "Time of the lecture" });
  const drawn = (page) => page.locator(".player canvas.drawing").evaluate((canvas) => Number(canvas.dataset.time));
  const length = Number(await time.getAttribute("max"));
  // A slider takes no more digits than it shows.
  const end = (Math.floor(100 * length) / 100).toString();
  assert(length > 0, `a recording of ${length} s`);
  await time.fill(end);
  await until("the last moment of the second run", () => drawn(presenter), (at) => at > 0.05);
  await box.getByText("What happens next?").waitFor();
  // What was shown before the presenter's page was reloaded is there too.
  let told = 0;
  for (let part = 0; part <= 100 && told === 0; part += 1) {
    await time.fill((Math.floor(part * length) / 100).toString());
    told = await box.getByText("multiplier negative").count();
  }
  assert(told > 0, "the recording goes on after a reload");
  await time.fill("0");
  await box.getByRole("button", { name: "Play" }).click();
  await until("it plays", () => time.inputValue(), (at) => Number(at) > 0);
  assert.deepEqual(await faults(presenter, { within: "dialog", impacts: SERIOUS }), [], "axe on the recording");
  await presenter.screenshot({ path: join(pictures, "lecture-recording.png") });
  const waiting = presenter.waitForEvent("download");
  await box.getByRole("button", { name: "Save the lecture (HTML)" }).click();
  const file = join(pictures, "lecture.html");
  await (await waiting).saveAs(file);
  const { size } = statSync(file);
  assert(size < MOST_BYTES, `the file has ${size} bytes`);
  const alone = await presenter.context().newPage();
  alone.on("pageerror", (error) => complaints.push(`file: ${error}`));
  await presenter.context().setOffline(true);
  await alone.goto(pathToFileURL(file).href);
  await alone.getByRole("slider", { name: "Time of the lecture" }).fill(end);
  await until("the file shows the last moment", () => drawn(alone), (at) => at > 0.05);
  await alone.getByText("What happens next?").waitFor();
  await alone.screenshot({ path: join(pictures, "lecture-file.png") });
  say(`a recording of ${length.toFixed(0)} s in ${(size / 1e3).toFixed(0)} kB plays in the page and from a file`);
}

async function all() {
  const presenter = await visitor("presenter", { width: 1280, height: 900 });
  const shot = (page, name) => page.screenshot({ path: join(pictures, `lecture-${name}.png`) });
  await presenter.goto(`${address}/scenes/spatial-slider-crank`);
  await until("the run starts", () => clock(presenter), (time) => time === 0);
  await presenter.getByRole("button", { name: /Lecture: let others/ }).click();
  const code = await presenter.locator(".invite-code").innerText();
  await presenter.keyboard.press("Escape");

  // The projector's window belongs to the presenter's browser: a clicker pressed in it reaches the presenter.
  const opened = presenter.waitForEvent("popup");
  await press(presenter, "Window for the projector");
  const screen = await opened;
  screen.on("pageerror", (error) => complaints.push(`screen: ${error}`));
  await screen.setViewportSize({ width: 1920, height: 1080 });
  await screen.getByRole("heading", { level: 1, name: /slider/i }).waitFor();
  await screen.locator(".screen-room", { hasText: code }).waitFor();
  await presenter.locator(".desk[open]").waitFor();
  assert.equal(await screen.locator("button:visible, input:visible, nav:visible").count(), 0, "the hall sees no controls");
  say("the projector has a window of its own, and the desk unfolds");

  const phone = await visitor("phone", { width: 390, height: 844 });
  await phone.goto(`${address}/room/${code}`);
  await press(phone, "Raise a hand");
  await presenter.locator(".desk summary", { hasText: "1 hand ·" }).waitFor();
  await presenter.getByText("1 follows", { exact: true }).waitFor();
  await phone.getByText("Ask something").click();
  await phone.getByLabel(/Your question/).fill("Why is the multiplier negative here?");
  await press(phone, "Send it");
  await presenter.locator(".desk-remarks", { hasText: "multiplier negative" }).waitFor();
  assert.equal(await screen.getByText("multiplier negative").count(), 0, "the presenter reads it first");
  await press(presenter, "Show to everybody");
  for (const page of [screen, phone]) await page.getByText("multiplier negative").waitFor();
  await shot(screen, "remark-1920");
  await press(presenter, "Done");
  await screen.locator(".screen-asked").waitFor({ state: "hidden" });
  await press(presenter, "Put hands down");
  await phone.locator("[aria-pressed=false]", { hasText: "Raise a hand" }).waitFor();
  say("a hand, and a question without a name");

  await press(presenter, "Ask a question");
  await presenter.getByLabel(/Number of the right choice/).fill("2");
  await press(presenter, "Ask");
  await press(phone, "positive");
  // Only the presenter sees how they stand.
  await presenter.locator(".desk .histogram .number", { hasText: "1" }).waitFor();
  await screen.locator(".screen-choices").waitFor();
  assert.equal(await screen.locator(".histogram").count() + await phone.locator(".histogram").count(), 0, "hidden until revealed");
  await shot(presenter, "presenter-1280");
  await shot(screen, "asked-1920");
  await press(presenter, "Vote again");
  await phone.getByText(/Asked again/).waitFor();
  await press(phone, "negative");
  await presenter.locator(".desk .histogram .is-before").first().waitFor();
  assert.equal(await screen.locator(".histogram").count(), 0, "nor is the second vote seen");
  await press(presenter, "Reveal");
  for (const page of [screen, phone]) {
    await page.locator(".histogram .is-right").waitFor();
    const rows = await page.locator(".histogram tbody tr").evaluateAll((all) =>
      all.map((row) => [...row.querySelectorAll(".number")].map((cell) => Number(cell.textContent))));
    assert.deepEqual(rows, [[1, 0], [0, 1], [0, 0]], "the first vote beside the second");
  }
  const letters = await screen.locator(".screen-asked h2").evaluate((head) => parseFloat(getComputedStyle(head).fontSize));
  assert(letters >= 32, `the question has letters of ${letters} px`);
  const room = await screen.locator(".stage").boundingBox();
  assert(room.height > 400, `the stage keeps ${room.height} px beside the votes`);
  await shot(screen, "votes-1920");
  await shot(phone, "phone-390");
  for (const [page, name] of [[presenter, "presenter"], [screen, "screen"], [phone, "phone"]])
    assert.deepEqual(await faults(page, { impacts: SERIOUS }), [], `axe on the ${name}'s window`);
  await press(presenter, "Take it away");
  say("two votes side by side");

  await press(presenter, "Step by time");
  await until("the clock goes on", () => clock(presenter), (time) => time > 0.05);
  await press(presenter, "Keep this state");
  await presenter.getByLabel("Notes to this slide").fill("Ask for the sign first.");
  const kept = await clock(presenter);
  await presenter.locator(".timeline").fill("0");
  await until("the hall sees the start", () => seen(screen), (time) => time === 0);
  await screen.bringToFront();
  await screen.keyboard.press("PageDown");
  await until("a clicker in the projector's window", () => clock(presenter), (time) => Math.abs(time - kept) < 0.01);
  await until("and the hall sees it", () => seen(screen), (time) => Math.abs(time - kept) < 0.01);
  await screen.keyboard.press("b");
  await screen.locator(".curtain").waitFor();
  assert(await presenter.locator(".curtain").isHidden(), "the presenter still sees the run");
  assert(await phone.locator(".stage").isVisible(), "and so do followers");
  await presenter.bringToFront();
  await presenter.keyboard.press("b");
  await screen.locator(".curtain").waitFor({ state: "hidden" });
  await presenter.reload();
  await until("notes outlive a reload", () => presenter.getByLabel("Notes to this slide").count(), (count) => count === 1);
  await presenter.keyboard.press("PageDown");
  await until("and belong to their slide", () => presenter.getByLabel("Notes to this slide").inputValue(), (text) => text === "Ask for the sign first.");
  say("slides with notes, a clicker, blank");

  await screen.emulateMedia({ colorScheme: "dark" });
  await presenter.emulateMedia({ colorScheme: "dark" });
  await shot(screen, "screen-dark-1920");
  await shot(presenter, "presenter-dark-1280");
  await recorded(presenter, screen);
}

await walk({ name: "lecture", pictures, browser, complaints }, all);
