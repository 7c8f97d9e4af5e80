// What a scene can be asked besides running it, on the scene as it is now.
import { api } from "../api/client";
import type { Reaction, Vec3 } from "../api/types";
import { announce, h } from "../core/dom";
import { fixed, num, plural, sci, seconds } from "../core/format";
import { reducedMotion } from "../core/prefs";
import { type ModeMotion, type Placed, placed, swung, visible } from "../mechanics/pose";
import { norm } from "../mechanics/vec";
import type { Session } from "../session/session";
import { problemNotice } from "../ui/notice";
import type { Panel } from "../ui/panel";
import { liveTable } from "../ui/table";

interface Mode {
  kind: string;
  frequency: number;
  growth: number;
  damping_ratio: number;
  shape: ModeMotion[];
}

const MAX_ROWS = 21;
/** A mode is shown at a pace that eyes follow, s a period. */
const PERIOD = 2;

export function analysesTab(session: Session): Panel {
  const result = h("section", {
    class: "stack",
    "aria-live": "polite",
    "aria-label": "Result of the analysis",
  });
  const back = h(
    "button",
    { type: "button", class: "button small", hidden: true, onclick: () => pose(undefined) },
    "Back to the run",
  );
  const names = (): string[] => session.latest?.bodies.map((body) => body.name) ?? [];

  const pose = (make: Session["pose"]): void => {
    if (make && session.latest?.playing) void session.pause();
    session.setPose(make);
    back.hidden = !make;
  };
  const run = (label: string, ask: (scene: unknown) => Promise<HTMLElement[]>): HTMLButtonElement => {
    const button = h(
      "button",
      {
        type: "button",
        class: "button",
        onclick: () => {
          const scene = session.view?.scene;
          if (!scene) return;
          button.disabled = true;
          ask(scene)
            .then((parts) => {
              result.replaceChildren(h("h3", null, label), ...parts);
              announce(`${label}: the result is below.`);
            })
            .catch((error: unknown) => result.replaceChildren(problemNotice(error)))
            .finally(() => {
              button.disabled = false;
            });
        },
      },
      label,
    );
    return button;
  };

  const check = run("Count freedoms", async (scene) => {
    const report = await api.check(JSON.stringify(scene));
    return [
      figures([
        ["Bodies", String(report.bodies)],
        ["Coordinates", String(report.coordinates)],
        ["Rows", String(report.rows)],
        ["Rank", String(report.rank)],
        ["Degrees of freedom", String(report.degrees_of_freedom)],
      ]),
      report.redundant.length > 0
        ? h(
            "p",
            null,
            "Redundant rows: ",
            report.redundant.map((entry) => `${entry.joint} (${entry.rows.join(", ")})`).join("; "),
            ".",
          )
        : h("p", null, "No row is redundant."),
    ];
  });
  const assembly = run("Assemble", async (scene) => {
    const found = await api.analyse<{
      bodies: { body: string; position: Vec3; moved: number; turned: number }[];
      iterations: number;
      opening: number;
      left: number;
    }>("assembly", { scene });
    const table = liveTable(
      "Where the bodies came to lie",
      "Body",
      ["x", "y", "z"]
        .map((label) => ({ label, unit: "m", number: true }))
        .concat([
          { label: "moved", unit: "m", number: true },
          { label: "turned", unit: "rad", number: true },
        ]),
    );
    table.update(
      found.bodies.map((body) => ({
        head: body.body,
        cells: [...body.position.map((part) => fixed(part, 5)), sci(body.moved), sci(body.turned)],
      })),
    );
    return [
      figures([
        ["Steps", String(found.iterations)],
        ["Open at the start", `${sci(found.opening)} m`],
        ["Open now", `${sci(found.left)} m`],
      ]),
      table.root,
    ];
  });
  const kinematics = run("Kinematics and driving forces", async (scene) => {
    const found = await api.analyse<{
      states: { time: number; bodies: Placed[]; reactions: { reactions: Reaction[] } }[];
      iterations: number;
    }>("kinematics", { scene });
    const drivers =
      found.states[0]?.reactions.reactions.filter((entry) => entry.driver).map((entry) => entry.joint) ?? [];
    const table = liveTable(
      "What each driver must exert, in the world frame",
      "Time",
      drivers.flatMap((name) => [
        { label: `${name}: force`, unit: "N", number: true },
        { label: "moment", unit: "N m", number: true },
      ]),
    );
    const stride = Math.max(1, Math.ceil(found.states.length / MAX_ROWS));
    table.update(
      found.states
        .filter((_, k) => k % stride === 0)
        .map((state) => ({
          head: seconds(state.time),
          cells: drivers.flatMap((name) => {
            const entry = state.reactions.reactions.find((one) => one.joint === name);
            const size = (parts: { value: number }[]): string =>
              num(norm(parts.map((part) => part.value) as Vec3), 6);
            return entry ? [size(entry.force), size(entry.moment)] : ["–", "–"];
          }),
        })),
    );
    return [
      h("p", null, `${plural(found.states.length, "position")}, ${plural(found.iterations, "Newton step")}.`),
      table.root,
    ];
  });
  const equilibrium = run("Static equilibrium", async (scene) => {
    const found = await api.analyse<{
      iterations: number;
      residual: number;
      least_stiffness: number;
      stable: boolean | null;
      bodies: Placed[];
      reactions: { reactions: Reaction[] };
    }>("equilibrium", { scene });
    const state = session.latest;
    if (state) pose(() => placed(state, found.bodies));
    const table = liveTable(
      "Centres of mass at rest",
      "Body",
      ["x", "y", "z"].map((label) => ({ label, unit: "m", number: true })),
    );
    table.update(
      found.bodies.map((body, k) => ({
        head: names()[k] ?? "",
        cells: body.position.map((part) => fixed(part, 6)),
      })),
    );
    const forces = liveTable(
      "Reactions at rest, world frame",
      "Joint",
      ["Fx", "Fy", "Fz"]
        .map((label) => ({ label, unit: "N", number: true }))
        .concat(["Mx", "My", "Mz"].map((label) => ({ label, unit: "N m", number: true }))),
    );
    forces.update(
      found.reactions.reactions.map((entry) => ({
        head: entry.joint,
        cells: [...entry.force, ...entry.moment].map(
          (part) => `${part.unique ? "" : "≈ "}${num(part.value, 5)}`,
        ),
      })),
    );
    return [
      figures([
        ["Stable", found.stable === null ? "undecided" : found.stable ? "yes" : "no"],
        ["Least stiffness", `${num(found.least_stiffness, 5)} N/m`],
        ["Left over", `${sci(found.residual)} N`],
        ["Steps", String(found.iterations)],
      ]),
      table.root,
      forces.root,
    ];
  });
  const modes = run("Small vibrations", async (scene) => {
    const found = await api.analyse<{ freedoms: number; modes: Mode[]; bodies: Placed[]; notes: string[] }>(
      "modes",
      { scene },
    );
    return [
      h(
        "p",
        null,
        `${plural(found.freedoms, "degree")} of freedom about the equilibrium near the start. Choose a mode to see it swing in the sketch.`,
      ),
      modesTable(found.modes, (mode) => swing(found.bodies, mode)),
      ...found.notes.map((note) => h("p", { class: "help" }, note)),
    ];
  });
  const swing = (bodies: Placed[], mode: Mode): void => {
    const state = session.latest;
    if (!state) return;
    const size = visible(state);
    pose((now) =>
      placed(
        state,
        swung(bodies, mode.shape, reducedMotion() ? 0 : ((now / 1000 / PERIOD) % 1) * 2 * Math.PI, size),
      ),
    );
  };
  session.on("scene", () => pose(undefined));

  return {
    root: h(
      "div",
      { class: "stack" },
      h("p", { class: "help" }, "Asked of the scene with the numbers that it has now, from its start."),
      h("div", { class: "row wrap" }, check, assembly, kinematics, equilibrium, modes, back),
      result,
    ),
    refresh: () => undefined,
  };
}

function figures(list: [string, string][]): HTMLElement {
  return h(
    "dl",
    { class: "figures" },
    ...list.map(([label, value]) =>
      h("div", { class: "figure" }, h("dt", null, label), h("dd", null, value)),
    ),
  );
}

function modesTable(modes: Mode[], show: (mode: Mode) => void): HTMLElement {
  const buttons: HTMLButtonElement[] = [];
  const rows = modes.map((mode, k) => {
    const button = h(
      "button",
      {
        type: "button",
        class: "button small",
        "aria-pressed": "false",
        "aria-label": `Show mode ${k + 1}`,
        onclick: () => {
          for (const other of buttons) other.setAttribute("aria-pressed", String(other === button));
          show(mode);
        },
      },
      "Show",
    );
    buttons.push(button);
    return h(
      "tr",
      null,
      h("th", { scope: "row" }, `Mode ${k + 1}, ${mode.kind}`),
      h("td", { class: "number" }, num(mode.frequency, 6)),
      h("td", { class: "number" }, mode.frequency > 0 ? num(1 / mode.frequency, 5) : "–"),
      h("td", { class: "number" }, num(mode.growth, 4)),
      h("td", { class: "number" }, num(mode.damping_ratio, 4)),
      h("td", null, button),
    );
  });
  return h(
    "div",
    { class: "table-scroll", tabindex: "0", role: "region", "aria-label": "Modes" },
    h(
      "table",
      { class: "data" },
      h(
        "thead",
        null,
        h(
          "tr",
          null,
          h("th", { scope: "col" }, "Mode"),
          ...[
            ["Frequency", "Hz"],
            ["Period", "s"],
            ["Growth", "1/s"],
            ["Damping ratio", ""],
          ].map(([label, unit]) =>
            h(
              "th",
              { scope: "col", class: "number" },
              label,
              unit ? h("span", { class: "unit" }, ` ${unit}`) : null,
            ),
          ),
          h("th", { scope: "col" }, h("span", { class: "visually-hidden" }, "Picture")),
        ),
      ),
      h("tbody", null, ...rows),
    ),
  );
}
