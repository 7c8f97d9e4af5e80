// How picture, numbers and text share the window, and what is dropped on it. Started by tests/tests/browser.rs:
//   node sharing.mjs http://127.0.0.1:PORT PICTURE_FOLDER
// The lines between the parts by mouse and by keyboard, the inspector over the whole width, plots that are not cut at any
// width; then a robot (URDF) that is dropped, pasted, and refused with its line.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { faults, launch, say, until, walk } from "./browser.mjs";

const [address, pictures] = process.argv.slice(2);
const browser = await launch();
const complaints = [];
const ARM = readFileSync(new URL("../data/arm.urdf", import.meta.url), "utf8");

/** A browser of its own. */
async function visitor(name, size, more = {}) {
  const context = await browser.newContext({ viewport: size, bypassCSP: true, reducedMotion: "reduce", locale: "en", ...more });
  const page = await context.newPage();
  page.setDefaultTimeout(60_000);
  page.on("pageerror", (error) => complaints.push(`${name}: ${error}`));
  return page;
}

const clock = (page) => page.locator(".clock").evaluate((field) => Number(field.value));
const picture = (page) => page.locator(".bench > .divider");
const heightOf = (page) => page.locator(".stage").evaluate((stage) => stage.getBoundingClientRect().height);
const valueOf = async (line) => Number(await line.getAttribute("aria-valuenow"));
const wideAs = (page) => page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);

async function lines() {
  const page = await visitor("lines", { width: 1440, height: 900 });
  await page.goto(`${address}/scenes/n-four-bar:40`);
  await until("the run starts", () => clock(page), (time) => time === 0);
  const line = picture(page);
  const before = await heightOf(page);
  // By mouse.
  const box = await line.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2, box.y - 120, { steps: 5 });
  await page.mouse.up();
  const dragged = await until("the picture is smaller", () => heightOf(page), (height) => height < before - 100);
  const value = await valueOf(line);
  assert(Math.abs(value - (100 * dragged) / (900 - 52)) < 1, `aria-valuenow tells it: ${value}`);
  // The browser keeps it.
  await page.reload();
  await until("the run starts again", () => clock(page), (time) => time === 0);
  await until("it is as it was", () => heightOf(page), (height) => Math.abs(height - dragged) < 2);
  // By keyboard, to both ends, and back to the beginning.
  await line.focus();
  await page.keyboard.press("ArrowDown");
  await until("an arrow key moves it", () => valueOf(line), (now) => now === value + 2);
  await page.keyboard.press("Home");
  await until("Home", () => valueOf(line), (now) => now >= 15 && now <= 20);
  await page.keyboard.press("End");
  await until("End", () => valueOf(line), (now) => now >= 70);
  assert(await page.getByRole("tab", { name: "Jacobian" }).isVisible(), "room is left for the inspector");
  await line.dblclick();
  await until("a double-click puts it back", () => heightOf(page), (height) => Math.abs(height - before) < 2);
  // Between text and mechanism.
  const text = page.locator(".lesson > .divider");
  const width = () => page.locator("#text").evaluate((part) => part.getBoundingClientRect().width);
  const usual = await width();
  await text.focus();
  for (let k = 0; k < 5; k += 1) await page.keyboard.press("ArrowLeft");
  await until("the text is narrower", width, (now) => now < usual - 100);
  await page.keyboard.press("Enter");
  await until("Enter puts it back", width, (now) => Math.abs(now - usual) < 2);
  say("lines are dragged, moved by keys, kept and put back");

  // The inspector over the whole width, by its button and by its key.
  await page.getByRole("tab", { name: "Jacobian" }).click();
  await page.getByText(/rank 971/).waitFor();
  const matrix = () => page.locator(".matrix-holder").evaluate((holder) => holder.clientWidth);
  const narrow = await matrix();
  await page.getByRole("button", { name: "Inspector over the whole width" }).click();
  await until("the matrix has room", matrix, (now) => now > narrow + 150);
  assert(await page.locator("#text").isHidden() && await page.locator("canvas.drawing").isVisible(), "the picture stays, the text goes");
  assert.deepEqual(await faults(page), [], "axe on the wide inspector");
  const beside = picture(page);
  assert.equal(await beside.getAttribute("aria-orientation"), "vertical");
  const wide = await matrix();
  await beside.focus();
  for (let k = 0; k < 4; k += 1) await page.keyboard.press("ArrowLeft");
  await until("the line beside moves too", matrix, (now) => now > wide + 50);
  await page.screenshot({ path: join(pictures, "sharing-wide.png") });
  await page.getByRole("tab", { name: "Jacobian" }).focus();
  await page.keyboard.press("w");
  await page.locator("#text").waitFor();
  await page.context().close();
  say("the inspector over the whole width");
}

/** On a phone and on a narrow, a usual and a hall's window nothing runs over the side, in light and dark. */
async function widths() {
  for (const [width, height, colorScheme] of [[390, 844, "light"], [1280, 800, "dark"], [1440, 900, "light"], [1920, 1080, "dark"], [2560, 1300, "light"]]) {
    const page = await visitor(`${width} px`, { width, height }, { colorScheme });
    await page.goto(`${address}/scenes/spatial-slider-crank`);
    // Pressed before the run is there: it waits for it.
    await page.getByRole("button", { name: "Step by time" }).click();
    await until("a step", () => clock(page), (time) => time > 0);
    await page.getByRole("tab", { name: "Plots" }).click();
    const plot = () => page.locator(".plot").evaluate((place) => {
      const canvas = place.querySelector("canvas")?.getBoundingClientRect();
      const [own, panel] = [place, place.closest(".inspector")].map((part) => part.getBoundingClientRect());
      return canvas && [canvas.right <= own.right + 1 && own.right <= panel.right + 1, Math.round(canvas.width - own.width)];
    });
    await until(`the plot fits at ${width}`, plot, (fits) => fits?.[0] === true && Math.abs(fits[1]) <= 1);
    for (const press of width >= 1024 ? ["w", "w"] : []) {
      await page.keyboard.press(press);
      await until(`the plot takes its new width at ${width}`, plot, (fits) => fits?.[0] === true && Math.abs(fits[1]) <= 1);
    }
    const line = picture(page);
    await line.focus();
    const [less, more] = width === 2560 ? ["ArrowLeft", "ArrowRight"] : ["ArrowUp", "ArrowDown"];
    const value = await valueOf(line);
    await page.keyboard.press(less);
    await until(`the line moves at ${width}`, () => valueOf(line), (now) => now < value);
    await page.keyboard.press(more);
    const [content, window] = await wideAs(page);
    assert(content <= window, `the page is ${content} px wide in ${window}`);
    assert.deepEqual(await faults(page), [], `axe at ${width}, ${colorScheme}`);
    await page.screenshot({ path: join(pictures, `sharing-${width}.png`) });
    await page.context().close();
  }
  say("plots are whole, and nothing runs over the side, from 390 to 2560 px");
}

/** Lets go of files over the page. */
async function drop(page, files, target = "body") {
  const transfer = await page.evaluateHandle((list) => {
    const data = new DataTransfer();
    for (const [name, text] of list) data.items.add(new File([text], name));
    return data;
  }, files);
  for (const kind of ["dragover", "drop"]) await page.dispatchEvent(target, kind, { dataTransfer: transfer, bubbles: true, cancelable: true });
}

async function paste(page, text, target) {
  const transfer = await page.evaluateHandle((pasted) => {
    const data = new DataTransfer();
    data.setData("text/plain", pasted);
    return data;
  }, text);
  await page.locator(target).evaluate(
    (place, clipboardData) => place.dispatchEvent(new ClipboardEvent("paste", { clipboardData, bubbles: true, cancelable: true })),
    transfer,
  );
}

async function robots() {
  const page = await visitor("robots", { width: 1280, height: 900 });
  await page.goto(`${address}/scenes`);
  await page.getByRole("heading", { name: "Scenes", level: 1 }).waitFor();
  const box = page.getByRole("dialog");
  await drop(page, [["arm.urdf", ARM]]);
  await box.getByText("What could not be carried over:").waitFor();
  await box.getByText(/Line \d+, .*mesh/i).first().waitFor();
  assert.deepEqual(await faults(page), [], "axe on the import");
  await page.screenshot({ path: join(pictures, "sharing-urdf.png") });
  await box.getByRole("button", { name: "Open as your own scene" }).click();
  await page.getByText("It has 2 degrees of freedom.").waitFor();
  // Into the text of the editor, which stays until the robot is opened.
  const area = page.locator("textarea.code");
  const before = await area.inputValue();
  await paste(page, ARM.replace("Small Arm", "Pasted Arm"), "textarea.code");
  await box.getByText("Pasted Arm").waitFor();
  assert.equal(await area.inputValue(), before);
  await box.getByRole("button", { name: "Open as your own scene" }).click();
  assert.match(await area.inputValue(), /Pasted Arm/);
  await page.getByRole("button", { name: "Back to the text before" }).click();
  assert.equal(await area.inputValue(), before);
  // A loop is closed by a side-car that comes along.
  const side = JSON.stringify({ joints: [{ name: "closing", type: "spherical", body_i: "lower", point_i: [0, 0, 0.8], body_j: "ground", point_j: [0.5, 0, 1.2] }] });
  await drop(page, [["arm.urdf", ARM], ["loop.json", side]]);
  await box.getByText(/3 joints/).waitFor();
  await page.keyboard.press("Escape");
  // A mistake is told with its line, and the line is shown.
  await paste(page, ARM.replace('mass value="2"', 'mass value="heavy"'), "body");
  await box.getByText("line 6: value is “heavy”, not a number".replace(/[“”]/g, '"')).first().waitFor();
  await box.locator(".named-line", { hasText: 'value="heavy"' }).waitFor();
  await page.keyboard.press("Escape");
  // What is typed or already stands there is offered, not only refused.
  await area.fill(ARM);
  await page.getByRole("button", { name: "Import it as a robot (URDF)" }).click();
  await box.getByText("What could not be carried over:").waitFor();
  await page.keyboard.press("Escape");
  // Scenes come by the same way; anything else is refused by its name.
  await drop(page, [["mine.json", before]], "textarea.code");
  await until("the scene is there", () => area.inputValue(), (text) => text === before);
  await drop(page, [["holiday.jpg", "\u00ff\u00d8"]]);
  await box.getByText("holiday.jpg is neither a scene (JSON) nor a robot (URDF).").waitFor();
  await page.keyboard.press("Escape");
  say("robots and scenes are dropped and pasted, with what was left out and where they are wrong");
  await page.context().close();
}

await walk({ name: "sharing", pictures, browser, complaints }, lines, widths, robots);
