import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { SessionState } from "../../api/types";
import { Clock } from "../../session/clock";
import type { Session } from "../../session/session";
import { applyView } from "../../session/share";
import { parseView } from "../../session/shared-view";
import { fake, fakePage, found } from "../../testing/page";
import { state } from "../../testing/state";
import { PlotsTab, runName } from "./plots-tab";

vi.mock("../../core/theme", () => ({ onTheme: vi.fn() }));
vi.mock("./plotter", () => ({ draw: vi.fn() }));

beforeEach(() => {
  fakePage();
  vi.useFakeTimers();
});
afterEach(() => {
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

const joint = { joint: "A", on: "a", by: "ground", at: [0, 0, 0], force: [-4, 0, 0], moment: [0, 0, 0] };
const at = (time: number): SessionState => ({ ...state(time, 0), forces: [joint as never] });

/** A run of a second whose force in A is unique but at its start. */
function shown(): { session: Session; tab: PlotsTab; readout: () => string } {
  vi.stubGlobal("fetch", (path: string) => {
    const unique = !/at=0$/.test(path);
    const parts = [0, 0, 0].map((value) => ({ value, unique }));
    return Promise.resolve(
      Response.json({ time: 0, redundancies: [], reactions: [{ joint: "A", force: parts, moment: parts }] }),
    );
  });
  const session = Object.assign(new Clock(), {
    numbers: { values: {}, places: {} },
    altered: false,
    convention: { on: "j", about: "joint", in: "world" },
    plot: undefined as string | undefined,
    joint: null,
    select: vi.fn(),
    choosePlot(plot: string) {
      session.plot = plot;
      session.trace("none");
    },
  });
  for (const time of [0, 0.5, 1]) session.past.add(at(time));
  session.latest = at(1);
  const tab = new PlotsTab(session as unknown as Session);
  session.on("shown", () => tab.refresh());
  return {
    session: session as unknown as Session,
    tab,
    readout: () => found(tab.root, ".readout").textContent,
  };
}

it("whether a force is unique belongs to the moment that is looked at", async () => {
  const { session, readout } = shown();
  session.choosePlot("joint:A:force");
  const settled = (): Promise<unknown> => vi.advanceTimersByTimeAsync(1000);
  session.seek(0);
  await settled();
  expect(readout()).toContain("≈ Fx = −4");
  session.seek(0.5);
  await settled();
  expect(readout()).toMatch(/At 0\.500 s: {1,2}Fx = −4/);
  session.seek(0);
  await settled();
  expect(readout()).toContain("≈ Fx = −4");
});

it("the plot that a presenter or a link has chosen is shown", async () => {
  const { session, tab, readout } = shown();
  tab.refresh();
  expect(readout()).toContain("ΔE");
  applyView(session, parseView({ plot: "body:bob:velocity" }) ?? {});
  expect(readout()).toContain("vx");
  expect(found(tab.root, "select").value).toBe("body:bob:velocity");
  // What another scene has no more is not an empty plot.
  applyView(session, parseView({ plot: "body:nobody:velocity" }) ?? {});
  expect(readout()).toContain("ΔE");
  // Each has a name of its own.
  const keys = fake(found(tab.root, "select")).children.map((option) => option.getAttribute("value"));
  expect(new Set(keys).size).toBe(keys.length);
  await vi.dynamicImportSettled();
});

it("a run that was changed on its way is not kept as that of its author", () => {
  const numbers = { values: {}, places: {} };
  expect(runName({ numbers, altered: false })).toBe("the scene as its author wrote it");
  expect(runName({ numbers, altered: true })).toBe("the scene as its author wrote it, changed on its way");
});
