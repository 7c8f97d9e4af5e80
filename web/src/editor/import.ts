// Imports a robot from a URDF file, with an optional side-car that closes its loops, as the scene of one's own.

import { ApiError, api } from "../api/client";
import type { ImportedRobot } from "../api/types";
import { h } from "../core/dom";
import { navigate } from "../core/router";
import { t } from "../core/texts";
import { dialog } from "../ui/dialog";
import { problemNotice } from "../ui/notice";
import { replaceOwn } from "./draft";
import { firstFault } from "./json";
import { lineNamed } from "./markup";
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
    void Promise.all([file.text(), side.files?.[0]?.text()])
      .then(([text, beside]) =>
        show(result, { name: file.name, urdf: text, side: beside }, (scene) => {
          replaceOwn(scene);
          navigate(target);
        }),
      )
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
        t("Choose a file, drop it on this page, or paste its text."),
        " ",
        aboutSideCar(),
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

const aboutSideCar = (): string =>
  t(
    "A URDF is a tree of links. Loops are closed by a side-car: JSON with joints in the words of a scene, such as {example}.",
    { example: EXAMPLE },
  );

/** What becomes of the scene that is there. */
export const replacing = (): string =>
  t("It takes the place of the scene that you have written, which stays as the text before.");

/** A robot as it came: the texts of its file and of its side-car. */
export interface Robot {
  name: string;
  urdf: string;
  side?: string | undefined;
}

/** Imports a robot that was dropped or pasted, and tells what became of it; `open` is given the text of its scene. */
export function importDialog(robot: Robot, open: (scene: string) => void, replaces = false): void {
  const side = h("input", { type: "file", id: "robot-side", class: "field", accept: ".json" });
  const result = h("div", { class: "stack", "aria-live": "polite" }, h("p", null, t("It is being read …")));
  const box = dialog(
    t("Import a robot (URDF)"),
    h(
      "div",
      { class: "stack" },
      result,
      replaces ? h("p", { class: "help" }, replacing()) : null,
      h("label", { for: "robot-side" }, t("Side-car, if the robot has loops (JSON)")),
      side,
      h("p", { class: "help" }, aboutSideCar()),
    ),
  );
  const read = (beside: string | undefined): Promise<void> =>
    show(result, { ...robot, side: beside }, (scene) => {
      box.close();
      open(scene);
    });
  side.addEventListener("change", () => void side.files?.[0]?.text().then(read));
  void read(robot.side);
}

/** Imports, and shows the robot or why it is none. */
async function show(place: HTMLElement, robot: Robot, open: (scene: string) => void): Promise<void> {
  try {
    const side: unknown = robot.side === undefined ? undefined : JSON.parse(robot.side);
    place.replaceChildren(...robotView(await api.importUrdf(robot.urdf, side), open));
  } catch (error) {
    const detail = error instanceof ApiError ? error.problem.detail : undefined;
    const named = lineNamed(detail, robot.urdf);
    const wrong =
      error instanceof SyntaxError
        ? { title: t("The side-car is not JSON"), detail: firstFault(robot.side ?? "")?.why }
        : error;
    place.replaceChildren(
      problemNotice(wrong),
      ...(named
        ? [h("pre", { class: "named-line", tabindex: "0" }, h("code", null, `${named.line}  ${named.text}`))]
        : []),
    );
  }
}

function robotView(
  { scene, left_out: leftOut }: ImportedRobot,
  open: (scene: string) => void,
): HTMLElement[] {
  const bodies = t("{n} body | {n} bodies", { n: scene.bodies?.length ?? 0 });
  const joints = t("{n} joint | {n} joints", { n: scene.joints?.length ?? 0 });
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
    h(
      "div",
      { class: "row" },
      h(
        "button",
        { type: "button", class: "button primary", onclick: () => open(pretty(scene)) },
        t("Open as your own scene"),
      ),
    ),
  ];
}
