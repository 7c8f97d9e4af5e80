// What the server says on a German page. Started by tests/tests/browser.rs:
//   node told.mjs http://127.0.0.1:PORT PICTURE_FOLDER
// Refusals and notes of scenes, runs and analyses in German with their values, the English original where it is pointed at;
// what is not known stays English and is marked as that.
import assert from "node:assert/strict";
import { join } from "node:path";
import { faults, launch, say, until, walk } from "./browser.mjs";

const [address, pictures] = process.argv.slice(2);
const browser = await launch();
const complaints = [];

async function visitor(name, locale, size = { width: 1280, height: 900 }) {
  const context = await browser.newContext({ viewport: size, bypassCSP: true, reducedMotion: "reduce", locale });
  const page = await context.newPage();
  page.setDefaultTimeout(60_000);
  page.on("pageerror", (error) => complaints.push(`${name}: ${error}`));
  return page;
}

const clock = (page) => page.locator(".clock").evaluate((field) => Number(field.value));
const area = (page) => page.locator("textarea.code");
/** Writes a changed scene into the editor. */
async function write(page, change) {
  const text = await area(page).inputValue();
  await area(page).fill(change(text));
  return text;
}

async function editor() {
  const page = await visitor("editor", "de");
  await page.goto(`${address}/scenes/own`);
  await page.getByText("Diese Szene kann laufen.", { exact: false }).waitFor();
  const right = await area(page).inputValue();
  const notice = page.locator(".check .notice");
  for (const [change, german, english] of [
    [(text) => text.replace('"body_j": "bob"', '"body_j": "bobb"'), /Gelenk „pin“: Es gibt keinen Körper „bobb“/, 'joint "pin": there is no body "bobb"'],
    [(text) => text.replace('"mass": ', '"mas": '), /Zeile \d+\): unbekannter Schlüssel `mas`, möglich sind/, "unknown field `mas`, expected one of"],
    [(text) => text.replace(/"mass": [\d.]+/, '"mass": -2'), /Körper „bob“: Seine Masse ist -2 kg/, 'body "bob": its mass is -2 kg'],
    [(text) => text.replace('"name": "pin"', '"name": "ground"'), /„ground“ kann kein Name sein/, '"ground" cannot be the name of an element'],
    [(text) => text.replace(/,\s*"bodies"/, ' "bodies"'), /^Vor dieser Stelle fehlt ein Komma\.$/],
    [(text) => text.replace(/"mass": [\d.]+/, '"mass": NaN'), /^NaN ist weder Zahl noch Text/],
    [(text) => text.replace(/"mass": [\d.]+/, '"mass": "heavy"'), /string "heavy" statt einer Zahl$/, 'invalid type: string "heavy", expected a number'],
  ]) {
    await write(page, () => change(right));
    await notice.getByText(german).first().waitFor();
    // What is not JSON never reaches the server: the page's own words have no original.
    const original = await notice.getByText(german).first().getAttribute("title");
    if (english) assert(original?.includes(english), `${original} has ${english}`);
    else {
      const wrong = change(right).includes("NaN") ? "NaN" : '"bodies"';
      const line = change(right).split("\n").findIndex((one) => one.includes(wrong)) + 1;
      await notice.getByText(`Zeile ${line} ist noch kein JSON`).waitFor();
    }
    assert.equal(await notice.locator("[lang=en]").count(), 0, "nothing of it is English");
  }
  await page.screenshot({ path: join(pictures, "told-editor.png") });
  assert.deepEqual(await faults(page, { within: ".check" }), [], "axe on a refusal");
  // A start whose velocities had to be changed is told as a note.
  await write(page, () => right.replace(/"mass": /, '"velocity": [0.5, 0, 0], "mass": '));
  const note = page.locator(".report li", { hasText: "Die Geschwindigkeiten verletzten die Zwangsbedingungen um" });
  await note.waitFor();
  assert.match(await note.locator("span").getAttribute("title"), /^velocities violated the constraints by/);
  say("refusals and notes of the editor are German");
  await page.context().close();
}

async function runs() {
  const page = await visitor("runs", "de");
  // The slider is driven farther than its rod is long.
  await page.goto(`${address}/scenes`);
  const scene = await page.evaluate(async () => (await fetch("/api/v1/scenes/spatial-slider-crank")).json());
  scene.drivers = [{ type: "slide", name: "push", joint: "D", motion: { kind: "ramp", start: 0.2, rate: 1 } }];
  await page.evaluate((text) => localStorage.setItem("triad:scene-draft", text), JSON.stringify(scene));
  await page.goto(`${address}/scenes/own`);
  await until("the run starts", () => clock(page), (time) => time === 0);
  await page.locator(".clock").fill("2");
  await page.locator(".clock").press("Enter");
  const trouble = page.locator(".trouble .notice");
  await trouble.getByText(/Kein Schritt über .* hält die Toleranz ein \(nach \d+ Schritten; Antrieb "push" verlangt mehr/).waitFor();
  await trouble.getByText("Lass den Antrieb weniger verlangen", { exact: false }).waitFor();
  await page.screenshot({ path: join(pictures, "told-stopped.png") });
  // A singular start, and an analysis that says what it leaves out.
  await page.goto(`${address}/scenes/n-four-bar:2`);
  await until("the run starts", () => clock(page), (time) => time === 0);
  await page.getByRole("tab", { name: "Analysen" }).click();
  await page.getByRole("button", { name: "Kleine Schwingungen" }).first().click();
  await page.getByText(/Die Geschwindigkeiten des Anfangs bleiben weg|Kein Gleichgewicht|Die Lage ist kein Gleichgewicht/i).first().waitFor();
  await page.getByText("Eigenform 1, wächst").waitFor();
  await page.screenshot({ path: join(pictures, "told-modes.png") });
  say("runs that stop and notes of analyses are German");
  // What nobody has translated stays, and is marked for whoever reads with their ears.
  await page.route("**/api/v1/check", (route) => route.fulfill({ status: 422, contentType: "application/problem+json", body: JSON.stringify({ type: "urn:triad:problem:new-kind", title: "New kind", status: 422, code: "new-kind", detail: "nobody has met this before", hint: "", errors: [], trace_id: "1" }) }));
  await page.goto(`${address}/scenes/own`);
  const strange = page.locator(".check [lang=en]", { hasText: "nobody has met this before" });
  await strange.waitFor();
  await page.context().close();
  // An English page says it as the server does.
  const english = await visitor("english", "en");
  await english.goto(`${address}/scenes/own`);
  await english.getByText("This scene can run.", { exact: false }).waitFor();
  await write(english, (text) => text.replace(/"mass": [\d.]+/, '"mass": -2'));
  await english.getByText('body "bob": its mass is -2 kg, but a mass must be positive').first().waitFor();
  assert.equal(await english.locator(".check [lang]").count(), 0);
  say("unknown sentences stay English, and are marked");
  await english.context().close();
}

await walk({ name: "told", pictures, browser, complaints }, editor, runs);
