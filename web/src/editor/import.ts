// Imports a robot from a URDF file, with an optional side-car that closes its loops, as the scene of one's own.

import { api } from "../api/client";
import type { ImportedRobot } from "../api/types";
import { h } from "../core/dom";
import { remember } from "../core/prefs";
import { navigate } from "../core/router";
import { t } from "../core/texts";
import { problemNotice } from "../ui/notice";
import { pretty } from "./pointer";

const EXAMPLE =
  '{"joints": [{"name": "closing", "type": "spherical", "body_i": "rod", "point_i": [0, 0, 1], ' +
  '"body_j": "ground", "point_j": [1, 0, 0]}]}';

/** A form that imports a robot and then leads to `target`, where the scene of one's own is edited. */
export function urdfImport(target: string): HTMLElement {
  const urdf = h("input", { type: "file", id: "urdf-file", class: "field", accept: ".urdf,.xml" });
  const side = h("input", { type: "file", id: "urdf-side", class: "field", accept: ".json" });
  const result = h("div", { class: "stack", "aria-live": "polite" });
  const button = h("button", { type: "button", class: "button" }, t("Import"));
  button.addEventListener("click", () => {
    const file = urdf.files?.[0];
    if (!file) {
      result.replaceChildren(h("p", { class: "field-wrong" }, t("Choose the URDF file of a robot first.")));
      return;
    }
    button.disabled = true;
    read(file, side.files?.[0])
      .then((robot) => result.replaceChildren(...robotView(robot, target)))
      .catch((error: unknown) => result.replaceChildren(problemNotice(error)))
      .finally(() => {
        button.disabled = false;
      });
  });
  return h(
    "details",
    { class: "expert" },
    h("summary", null, t("Import a robot (URDF)")),
    h(
      "div",
      { class: "stack" },
      h(
        "p",
        { class: "help" },
        t(
          "A URDF is a tree of links. Loops are closed by a side-car: JSON with joints in the words of a scene, such as {example}.",
          { example: EXAMPLE },
        ),
      ),
      h("label", { for: "urdf-file" }, t("URDF file")),
      urdf,
      h("label", { for: "urdf-side" }, t("Side-car, if the robot has loops (JSON)")),
      side,
      h("div", { class: "row" }, button),
      result,
    ),
  );
}

async function read(urdf: File, side: File | undefined): Promise<ImportedRobot> {
  return api.importUrdf(await urdf.text(), side ? JSON.parse(await side.text()) : undefined);
}

function robotView({ scene, left_out: leftOut }: ImportedRobot, target: string): HTMLElement[] {
  const bodies = t("{n} body | {n} bodies", { n: scene.bodies?.length ?? 0 });
  const joints = t("{n} joint | {n} joints", { n: scene.joints?.length ?? 0 });
  const open = (): void => {
    remember("scene-draft", pretty(scene));
    navigate(target);
  };
  return [
    h("p", null, h("b", null, scene.title ?? scene.name), `: ${bodies}, ${joints}.`),
    leftOut.length > 0
      ? h(
          "div",
          null,
          h("p", null, t("What could not be carried over:")),
          h(
            "ul",
            { class: "left-out" },
            ...leftOut.map((one) =>
              h("li", null, t("Line {line}, {of}: {what}", { line: one.line, of: one.of, what: one.what })),
            ),
          ),
        )
      : h("p", null, t("Everything was carried over.")),
    h("button", { type: "button", class: "button primary", onclick: open }, t("Open as your own scene")),
  ];
}
