// The run as a table: which outputs, and how often.

import { api } from "../../api/client";
import type { Output, Scene } from "../../api/types";
import { h, saveFile } from "../../core/dom";
import { t } from "../../core/texts";
import type { Session } from "../../session/session";
import { dialog } from "../../ui/dialog";
import { problemNotice } from "../../ui/notice";

/** What may be chosen, in the order of the columns. */
export const OUTPUTS: [Output, () => string][] = [
  ["bodies", () => t("Bodies: centre of mass, principal axes, velocities")],
  ["frames", () => t("Frames: reference point and axes as the scene writes them")],
  ["accelerations", () => t("Accelerations of bodies")],
  ["reactions", () => t("Reactions of joints and drivers")],
  ["drivers", () => t("Drivers: value, rate, effort, power")],
  ["joints", () => t("Joints: angles and slides with their rates")],
  ["loads", () => t("Loads: forces, lengths, powers")],
  ["markers", () => t("Markers: positions and velocities")],
  ["energy", () => t("Energy")],
  ["balance", () => t("Balance of energy")],
  ["violations", () => t("Violations of the constraints")],
  ["errors", () => t("Estimated errors")],
];
/** What a table holds that nobody has chosen. */
const USUAL: Output[] = ["bodies", "reactions", "energy", "violations", "errors"];

/** The outputs of a request: what is checked, and what the scene chooses of single elements of the same kind. */
export function chosen(checked: Output[], scene: Scene): Output[] {
  const single = (scene.simulation?.outputs ?? []).filter((output) => output.includes(":"));
  return checked.flatMap((kind) => {
    const own = single.filter((output) => output.startsWith(`${kind}:`));
    return own.length > 0 ? own : [kind];
  });
}

/** What may be chosen of a scene: one that estimates no errors has none. */
export const offeredOf = (scene: Scene): typeof OUTPUTS =>
  OUTPUTS.filter(([kind]) => kind !== "errors" || scene.simulation?.error_estimate !== false);

/** Asks which numbers of the whole run are wanted, and saves them as CSV. */
export function tableDialog(session: Session): void {
  const scene = session.view?.scene as Scene | undefined;
  if (!scene) return;
  const before = (scene.simulation?.outputs ?? USUAL).map((output) => output.split(":")[0]);
  const offered = offeredOf(scene);
  const boxes = offered.map(([kind]) =>
    h("input", { type: "checkbox", value: kind, checked: before.includes(kind) }),
  );
  const every = h("input", {
    type: "number",
    class: "field compact",
    min: "0",
    step: "any",
    value: String(scene.simulation?.every ?? 0.01),
  });
  const told = h("div", { "aria-live": "polite" });
  const save = h("button", { type: "submit", class: "button primary" }, t("Save as CSV"));
  const form = h(
    "form",
    { class: "stack" },
    h(
      "p",
      { class: "help" },
      t("The scene with the numbers that it has now is run from its start to its end."),
    ),
    h(
      "fieldset",
      { class: "stack" },
      h("legend", null, t("Columns")),
      ...offered.map(([, label], k) =>
        h("label", { class: "switch" }, boxes[k] ?? "", h("span", null, label())),
      ),
    ),
    h("label", { class: "switch" }, h("span", null, t("Time between rows, s")), every),
    told,
    save,
  );
  const box = dialog(t("Table of the run"), form);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const checked = boxes.filter((one) => one.checked).map((one) => one.value);
    if (checked.length === 0) {
      told.replaceChildren(h("p", { class: "help" }, t("Choose at least one group of columns.")));
      return;
    }
    save.disabled = true;
    api
      .table({ scene, outputs: chosen(checked, scene), every: Number(every.value) })
      .then((table) => {
        saveFile(table, `${scene.name}.csv`);
        box.close();
      })
      .catch((error: unknown) => told.replaceChildren(problemNotice(error)))
      .finally(() => {
        save.disabled = false;
      });
  });
}
