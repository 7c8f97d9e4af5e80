// A lecture room with a name of its own. Started by tests/tests/browser.rs:
//   node named-room.mjs http://127.0.0.1:PORT PICTURE_FOLDER
// An instructor chooses the name once; followers who come too early wait and go in by themselves; the next lecture has the same
// address; somebody else is refused.
import assert from "node:assert/strict";
import { join } from "node:path";
import { faults, launch, say, until, walk } from "./browser.mjs";

const [address, pictures] = process.argv.slice(2);
const browser = await launch();
const complaints = [];

async function visitor(name, size = { width: 1280, height: 900 }) {
  const context = await browser.newContext({ viewport: size, bypassCSP: true, reducedMotion: "reduce", locale: "en" });
  const page = await context.newPage();
  page.setDefaultTimeout(60_000);
  page.on("pageerror", (error) => complaints.push(`${name}: ${error}`));
  return page;
}

/** Holds requests of a page back; what is returned lets them go on and gives the statuses of their answers. */
async function held(page, url) {
  const routes = [];
  const keep = (route) => void routes.push(route);
  await page.route(url, keep);
  await until("something is asked", () => routes.length, (count) => count > 0);
  return async () => {
    const answers = routes.map((route) => page.waitForResponse((answer) => answer.request() === route.request()));
    await Promise.all(routes.map((route) => route.continue()));
    await page.unroute(url, keep);
    return (await Promise.all(answers)).map((answer) => answer.status());
  };
}

const clock = (page) => page.locator(".clock").evaluate((field) => Number(field.value));
const code = (page) => page.locator(".invite-code").innerText();
/** Pixels of the picture in the colour of the pendulum's rod and bob. */
const drawnBodies = (page) => page.locator("canvas.drawing").evaluate((canvas) => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let k = 0; k < data.length; k += 4) if (data[k + 2] > 200 && data[k + 2] - data[k] > 60 && data[k + 1] > 150) count += 1;
  return count;
});
async function lecture(page) {
  await page.goto(`${address}/scenes/simple-pendulum`);
  await until("the run starts", () => clock(page), (time) => time === 0);
  await page.getByRole("button", { name: /Lecture: let others/ }).click();
  await page.locator(".invite-code").waitFor();
}
async function choose(page, name) {
  await page.getByText("A link that stays the same for the whole term").click();
  await page.getByLabel("Name of the room").fill(name);
  await page.getByRole("button", { name: "Use this name" }).click();
}

async function term() {
  const presenter = await visitor("presenter", { width: 1920, height: 1080 });
  await lecture(presenter);
  const first = await code(presenter);
  assert.match(first, /^[A-Z2-9]{5}$/, "at first a code");
  // A question that was on its way to the room of that code comes back when it is closed: the room with a name stays.
  const letGo = await held(presenter, `**/rooms/${first}/desk`);
  await choose(presenter, "MBS-2026");
  await until("the room has its name", () => code(presenter), (shown) => shown === "mbs-2026");
  assert.ok((await letGo()).includes(404), "the room before does not answer any more");
  assert.deepEqual(await faults(presenter, { within: "dialog" }), [], "axe on the invitation");
  await presenter.screenshot({ path: join(pictures, "named-room-invite.png") });
  await presenter.keyboard.press("Escape");
  // A phone with the link of the slides, in whatever letters.
  const phone = await visitor("phone", { width: 390, height: 844 });
  await phone.goto(`${address}/room/MBS-2026`);
  await phone.getByText("You see what the presenter shows.").waitFor();
  await presenter.getByRole("button", { name: "Step by time" }).click();
  await until("the phone follows", () => clock(phone), (time) => time > 0.05);
  // Who comes late sees the bodies too, whose parts are known from the start of the run.
  const late = await visitor("late", { width: 390, height: 844 });
  await late.goto(`${address}/room/mbs-2026`);
  for (const page of [presenter, phone, late]) await until("the bodies are drawn", () => drawnBodies(page), (count) => count > 150);
  await late.screenshot({ path: join(pictures, "named-room-late.png") });
  await late.context().close();
  await presenter.getByRole("button", { name: "End the lecture" }).click();
  await phone.getByText("The lecture is over.", { exact: false }).waitFor();
  say("a room with a name");

  // Next week: who is early waits in the room, and the lecture opens under its name by itself.
  await phone.goto(`${address}/room`);
  await phone.getByLabel("Code or name of the room").fill("mbs-2026");
  await phone.getByRole("button", { name: "Join", exact: true }).click();
  await phone.getByText("The lecture in this room has not begun.", { exact: false }).waitFor();
  assert.deepEqual(await faults(phone), [], "axe on a room that waits");
  await phone.screenshot({ path: join(pictures, "named-room-waits.png") });
  await lecture(presenter);
  assert.equal(await code(presenter), "mbs-2026");
  await phone.getByText("You see what the presenter shows.").waitFor();
  say("the next lecture has the same address, and who was early goes in");

  // Somebody else is refused, and told why; a name that is none as well.
  const other = await visitor("other");
  await lecture(other);
  await choose(other, "mbs-2026");
  await other.getByText("the room mbs-2026 belongs to somebody else").waitFor();
  await other.screenshot({ path: join(pictures, "named-room-taken.png") });
  await other.getByLabel("Name of the room").fill("mbs 2026!");
  await other.getByRole("button", { name: "Use this name" }).click();
  await other.getByText('a room cannot be named "mbs 2026!"').waitFor();
  assert.match(await code(other), /^[A-Z2-9]{5}$/, "the lecture goes on under its code");
  // Back to codes.
  const dialog = presenter.getByRole("dialog");
  await dialog.getByText("A link that stays the same for the whole term").click();
  await dialog.getByRole("button", { name: "Use a code again" }).click();
  await until("a code again", () => code(presenter), (shown) => /^[A-Z2-9]{5}$/.test(shown));
  say("a name that is taken or none is refused; codes are had again");
  for (const page of [presenter, phone, other]) await page.context().close();
}

await walk({ name: "named-room", pictures, browser, complaints }, term);
