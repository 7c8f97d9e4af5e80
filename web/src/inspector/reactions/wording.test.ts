import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { beforeAll, expect, it, vi } from "vitest";
import { loadLanguage } from "../../core/texts";
import { aboutIn, frameIn, givenUp } from "./wording";

const engine = (file: string): string =>
  readFileSync(
    fileURLToPath(new URL(`../../../../engine/engine/src/reactions/${file}`, import.meta.url)),
    "utf8",
  );

beforeAll(() => {
  vi.stubGlobal("navigator", { languages: ["de"] });
  vi.stubGlobal("document", { documentElement: {} });
  return loadLanguage();
});

it("what the engine says of a reaction is said in German", () => {
  expect(aboutIn('the point of "pin" on "bob"')).toBe("den Punkt von „pin“ auf „bob“");
  expect(aboutIn('the centre of mass of "bob"')).toBe("den Schwerpunkt von „bob“");
  expect(aboutIn("the world's origin")).toBe("den Ursprung der Welt");
  expect(frameIn("world")).toBe("Weltsystem");
  expect(frameIn('frame of "bob"')).toBe("System von „bob“");
  expect(frameIn('joint "pin", x along its axis')).toBe("Gelenk „pin“, x entlang seiner Achse");
  expect(frameIn("something else")).toBe("something else");
});

it("all that a joint may give up is known here", () => {
  const said = Array.from(
    engine("uniqueness/remedy.rs").matchAll(/"((?:one of )?the (?:force|moment)[^"]*)"/g),
    (found) => found[1] ?? "",
  );
  expect(said.length).toBeGreaterThan(7);
  for (const words of said) expect(givenUp(words)).toMatch(/^(?:eines der|das|die) /);
});
