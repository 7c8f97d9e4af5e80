// The free-body diagram of two links, as a student draws it. Started by tests/tests/browser.rs:
//   node diagram.mjs http://127.0.0.1:PORT PICTURE_FOLDER
// With the mouse: forces dragged out of points, moments clicked; mistakes are told; the right one gets the run's numbers.
// With the keyboard alone: the same diagram out of lists, in light and dark, wide and on a phone; axe on each.
import assert from "node:assert/strict";
import { join } from "node:path";
import { faults, launch, say, walk } from "./browser.mjs";

const [address, pictures] = process.argv.slice(2);
const browser = await launch();
const complaints = [];

/** Length of a drag, px of the screen; more than what counts as a click. */
const DRAG = 60;
/** The eight arrows of the stretched arm, as the page calls them: body, point, what. */
const RIGHT = [
  ["upper", "shoulder", "force upwards (+y)"],
  ["upper", "motor 1", "moment anticlockwise (+z)"],
  ["upper", "centre of mass", "force downwards (−y)"],
  ["upper", "elbow", "force downwards (−y)"],
  ["upper", "motor 2", "moment clockwise (−z)"],
  ["lower", "elbow", "force upwards (+y)"],
  ["lower", "motor 2", "moment anticlockwise (+z)"],
  ["lower", "centre of mass", "force downwards (−y)"],
];
const inWords = ([body, point, what]) => `${what} at ${point} on ${body}`;

async function student(name, more = {}) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 1000 }, bypassCSP: true, ...more });
  const page = await context.newPage();
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("console", (line) => {
    if (line.type() === "error" && !/WebGL|GPU|favicon/i.test(line.text())) complaints.push(line.text());
  });
  await page.goto(`${address}/lessons/two-links`);
  await page.locator("#q-cut .cut-layer").waitFor();
  const named = page.getByLabel(/Your name/).last();
  await named.fill(name);
  await named.press("Enter");
  await page.locator(".whose b", { hasText: name }).waitFor();
  return page;
}

const handIn = async (page, press) => {
  const answered = page.waitForResponse((reply) => reply.url().includes("/submissions") && reply.request().method() === "POST");
  await press();
  const verdict = await (await answered).json();
  return verdict.questions.find((question) => question.id === "cut");
};
const check = (page) => page.getByRole("button", { name: "Check my answers" });
const drawn = (page) => page.locator("#q-cut .arrow-list li").evaluateAll((rows) => rows.map((row) => row.firstChild.textContent.trim()));
const announced = (page, words) => page.locator("[aria-live]").filter({ hasText: words }).first().waitFor({ state: "attached" });

/** The point of a body in the picture: bodies stand in the order of the list, points in that of theirs. */
async function spot(page, body, words) {
  const places = page.locator("#q-cut .cut-layer g:has(> .cut-name)").filter({ hasText: words });
  const at = places.nth(body === "lower" && (await places.count()) > 1 ? 1 : 0).locator(".cut-point");
  await at.scrollIntoViewIfNeeded();
  const box = await at.boundingBox();
  return [box.x + box.width / 2, box.y + box.height / 2];
}

async function drag(page, body, words, [dx, dy]) {
  const [x, y] = await spot(page, body, words);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + dx / 2, y + dy / 2, { steps: 4 });
  assert.notEqual(await page.locator("#q-cut .drawn-trail").getAttribute("d"), "", "the drag can be seen");
  await page.mouse.move(x + dx, y + dy, { steps: 4 });
  await page.mouse.up();
  assert.equal(await page.locator("#q-cut .drawn-trail").getAttribute("d"), "");
}

async function clean(page, what) {
  assert.deepEqual(await faults(page, { within: "#q-cut" }), [], `axe on ${what}`);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  assert(wide <= 0, `${what} is ${wide} px wider than the screen`);
}

/** Names of points that lie on one another cannot be read. */
async function namesApart(page) {
  const boxes = await page.locator("#q-cut .cut-name").evaluateAll((names) => names.map((name) => [name.textContent, name.getBoundingClientRect().toJSON()]));
  assert(boxes.length >= 6, "every point has a name");
  for (const [k, [name, a]] of boxes.entries()) {
    for (const [other, b] of boxes.slice(k + 1)) {
      const apart = a.right <= b.left + 1 || b.right <= a.left + 1 || a.bottom <= b.top + 4 || b.bottom <= a.top + 4;
      assert(apart, `${name} lies on ${other}`);
    }
  }
}

async function byMouse() {
  const page = await student("Grace Hopper");
  await namesApart(page);
  assert.deepEqual(await page.locator("#q-cut .cut-free text").allTextContents(), ["upper", "lower"], "each body has its name in the picture");
  const up = [0, -DRAG];
  const down = [4, DRAG];
  // The lower link hangs on the upper one and does not push it up: action and reaction.
  await drag(page, "upper", "shoulder", up);
  await drag(page, "upper", "centre", down);
  await drag(page, "upper", "elbow", up);
  await drag(page, "lower", "elbow", up);
  await drag(page, "lower", "centre", down);
  await page.mouse.click(...(await spot(page, "upper", "shoulder")));
  await page.mouse.click(...(await spot(page, "lower", "elbow")));
  assert.equal((await drawn(page)).length, 7);
  let verdict = await handIn(page, () => check(page).click());
  assert.equal(verdict.verdict, "wrong");
  const words = await page.locator("#q-cut").innerText();
  assert.match(words, /elbow/, "the feedback names the place");
  await page.locator("#q-cut").screenshot({ path: join(pictures, "diagram-wrong.png") });
  say(`wrong by mouse: ${verdict.message_html.replace(/<[^>]+>/g, " ").replace(/\s+/g, " ").slice(0, 160)}`);

  // Dragged the other way the arrow turns round; clicked twice the moment of the motor acts clockwise; three times it is gone.
  await drag(page, "upper", "elbow", down);
  for (let clicks = 0; clicks < 2; clicks += 1) await page.mouse.click(...(await spot(page, "upper", "elbow")));
  for (let clicks = 0; clicks < 3; clicks += 1) await page.mouse.click(...(await spot(page, "lower", "hand")));
  assert.deepEqual((await drawn(page)).sort(), RIGHT.map(inWords).sort());
  verdict = await handIn(page, () => check(page).click());
  assert.equal(verdict.verdict, "right", verdict.message_html);
  assert.match(await page.locator("#q-cut").innerText(), /\d N/, "the numbers of the run stand there");
  await page.locator("#q-cut").screenshot({ path: join(pictures, "diagram-right.png") });
  // What was drawn is there again.
  await page.reload();
  await page.locator("#q-cut .arrow-list li").nth(7).waitFor();
  say("right by mouse, and kept");
  await page.context().close();
}

/** Tab until the wanted element has the focus: what cannot be reached this way cannot be used by keyboard. */
async function tabTo(page, element) {
  for (let presses = 0; presses < 60; presses += 1) {
    if (await element.evaluate((wanted) => wanted === document.activeElement)) return;
    await page.keyboard.press("Tab");
  }
  throw new Error(`${element} cannot be reached by Tab`);
}

/** Chooses an option of the list that has the focus, as one does by typing. */
async function choose(page, list, words) {
  await tabTo(page, list);
  for (let presses = 0; presses < 12; presses += 1) {
    if ((await list.evaluate((select) => select.selectedOptions[0]?.textContent)) === words) return;
    await page.keyboard.press("ArrowDown");
  }
  throw new Error(`no option ${words}`);
}

async function byKeyboard(scheme, width) {
  const what = `${scheme} at ${width} px`;
  const page = await student(`Ada ${scheme} ${width}`, { colorScheme: scheme, viewport: { width, height: 900 } });
  const question = page.locator("#q-cut");
  const list = (name) => question.getByRole("combobox", { name, exact: true });
  const add = question.getByRole("button", { name: "Add", exact: true });
  // One arrow too many, taken away again.
  const arrows = [...RIGHT, ["lower", "hand", "force upwards (+y)"]];
  for (const [body, point, kind] of arrows) {
    // Back to the first list, from where the order of Tab is that of the page.
    await list("Body").focus();
    await page.keyboard.press("Home");
    await choose(page, list("Body"), body);
    await tabTo(page, list("Point"));
    await page.keyboard.press("Home");
    await choose(page, list("Point"), point);
    await tabTo(page, list("Force or moment"));
    await page.keyboard.press("Home");
    await choose(page, list("Force or moment"), kind);
    await tabTo(page, add);
    await page.keyboard.press("Enter");
    await announced(page, `Added: ${inWords([body, point, kind])}`);
  }
  const tooMuch = question.getByRole("button", { name: `Remove ${inWords(arrows[8])}` });
  await tabTo(page, tooMuch);
  await page.keyboard.press("Enter");
  await announced(page, `Removed: ${inWords(arrows[8])}`);
  const focus = await page.evaluate(() => document.activeElement?.closest("#q-cut") !== null);
  assert(focus, "whoever removes an arrow by keyboard stays in the question");
  assert.deepEqual(await drawn(page), RIGHT.map(inWords));
  await clean(page, `the drawn diagram in ${what}`);
  const heights = await question.locator(".cut-picture text").evaluateAll((names) => names.map((name) => {
    const scale = name.ownerSVGElement.getBoundingClientRect().width / name.ownerSVGElement.viewBox.baseVal.width;
    return Number.parseFloat(getComputedStyle(name).fontSize) * scale;
  }));
  assert(heights.length > 4 && Math.min(...heights) > 11.5, `names of points are read in ${what}: ${heights} px`);
  const verdict = await handIn(page, async () => {
    await tabTo(page, check(page));
    await page.keyboard.press("Enter");
  });
  assert.equal(verdict.verdict, "right", verdict.message_html);
  await clean(page, `the judged diagram in ${what}`);
  await question.screenshot({ path: join(pictures, `diagram-${scheme}-${width}.png`) });
  say(`right by keyboard in ${what}`);
  await page.context().close();
}

async function all() {
  await byMouse();
  await byKeyboard("light", 1440);
  await byKeyboard("dark", 390);
}

await walk({ name: "diagram", pictures, browser, complaints }, all);
