// Chooses which points leave traces, and which other run is seen as a ghost.

import { h } from "../core/dom";
import { bind } from "../core/keys";
import { t } from "../core/texts";
import type { Traced } from "../session/events";
import type { Ghost } from "../session/ghost";
import type { Session } from "../session/session";
import { icon } from "../ui/icons";
import { authorsGhost, keptGhost } from "./ghosts";

const TRACED: [Traced, () => string][] = [
  ["none", () => t("nothing")],
  ["bodies", () => t("centres of mass")],
  ["joints", () => t("joints")],
  ["joint", () => t("the selected joint")],
  ["markers", () => t("markers")],
];
const GHOSTS: [string, () => string][] = [
  ["none", () => t("none")],
  ["author", () => t("author’s numbers")],
  ["kept", () => t("this run, as far as it has come")],
];

export function besideMenu(session: Session): { root: HTMLElement; dispose: () => void } {
  const said = h("p", { class: "help", role: "status" });
  const traced = choice(TRACED, (value) => session.trace(value as Traced));
  const ghost = choice(GHOSTS, (value) => {
    said.textContent = "";
    void ghostOf(session, value)
      .catch(() => null)
      .then((found) => {
        session.showGhost(found ?? undefined);
        if (found === null)
          said.textContent = t("There is no such run: run the mechanism from its start first.");
      });
  });
  const silence = session.on("view", () => {
    traced.value = session.traced;
    // A run that waits for a prediction is not told by another one.
    ghost.disabled = session.held;
    if (!session.ghost) ghost.value = "none";
  });
  const summary = h(
    "summary",
    {
      class: "button quiet small icon-only",
      title: t("Traces and ghost"),
      "aria-label": t("Traces and ghost"),
    },
    icon("trace"),
  );
  const root = h(
    "details",
    { class: "stage-beside" },
    summary,
    h(
      "div",
      { class: "stack" },
      h("label", { class: "switch" }, h("span", null, t("Traces of")), traced),
      h("label", { class: "switch" }, h("span", null, t("Ghost")), ghost),
      said,
    ),
  );
  root.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !root.open) return;
    root.open = false;
    summary.focus();
  });
  const release = bind([
    {
      keys: ["t", "T"],
      shown: "T",
      does: t("Traces of the next kind of points"),
      run: () => session.trace(next(session.traced)),
    },
  ]);
  return {
    root,
    dispose: () => {
      silence();
      release();
    },
  };
}

const next = (traced: Traced): Traced => {
  const at = TRACED.findIndex(([one]) => one === traced);
  return TRACED[(at + 1) % TRACED.length]?.[0] ?? "none";
};

/** The run that is wanted; undefined for none, null where it is not to be had. */
async function ghostOf(session: Session, which: string): Promise<Ghost | undefined | null> {
  if (which === "author") return authorsGhost(session.source);
  if (which === "kept") return keptGhost(session, t("kept run")) ?? null;
  return undefined;
}

function choice(options: [string, () => string][], changed: (value: string) => void): HTMLSelectElement {
  const select = h(
    "select",
    { class: "field compact" },
    ...options.map(([value, label]) => h("option", { value }, label())),
  );
  select.addEventListener("change", () => changed(select.value));
  return select;
}
