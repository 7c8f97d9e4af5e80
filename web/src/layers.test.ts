import { readdirSync, readFileSync } from "node:fs";
import { join, normalize, sep } from "node:path";
import { fileURLToPath } from "node:url";
import { expect, it } from "vitest";

/** The folders in reading order: each imports from those before it only. A lint finds circles between files. */
const LAYERS = [
  "texts",
  "core",
  "engine",
  "api",
  "ui",
  "mechanics",
  "session",
  "editor",
  "exercise",
  "lecture",
  "prediction",
  "stage",
  "player",
  "gallery",
  "share",
  "inspector",
  "workbench",
  "class",
  "pages",
];
/** For unit tests only. */
const TESTING = "testing";

it("folders import only from folders before them", () => {
  const root = fileURLToPath(new URL(".", import.meta.url));
  const wrong: string[] = [];
  for (const file of readdirSync(root, { recursive: true, encoding: "utf8" })) {
    const folder = file.split(sep)[0] ?? "";
    if (!file.endsWith(".ts") || file === folder || folder === TESTING) continue;
    expect(LAYERS, `the layer of ${file}`).toContain(folder);
    const test = file.endsWith(".test.ts");
    for (const [, path] of readFileSync(join(root, file), "utf8").matchAll(
      /(?:from|import\(|import) ?"(\.[^"]+)"/g,
    )) {
      const target = normalize(join(file, "..", path ?? "")).split(sep);
      const to = target[0] ?? "";
      // Style sheets import nothing.
      if (to === "styles") continue;
      if (target.length === 1 || to === folder || (test && to === TESTING)) continue;
      if (!(LAYERS.indexOf(to) >= 0 && LAYERS.indexOf(to) < LAYERS.indexOf(folder)))
        wrong.push(`${file}: ${path}`);
    }
  }
  expect(wrong).toEqual([]);
});
