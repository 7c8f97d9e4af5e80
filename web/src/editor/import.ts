// A robot from a URDF file, with an optional side-car that closes its loops: becomes the scene of one's own.
import { api } from "../api/client";
import { h } from "../core/dom";
import { plural } from "../core/format";
import { remember } from "../core/prefs";
import { navigate } from "../core/router";
import { problemNotice } from "../ui/notice";
import { pretty } from "./pointer";

export function urdfImport(target: string): HTMLElement {
  const urdf = h("input", { type: "file", id: "urdf-file", class: "field", accept: ".urdf,.xml" });
  const side = h("input", { type: "file", id: "urdf-side", class: "field", accept: ".json" });
  const result = h("div", { class: "stack", "aria-live": "polite" });
  const run = h("button", { type: "button", class: "button", onclick: () => void read() }, "Import");

  const read = async (): Promise<void> => {
    const file = urdf.files?.[0];
    if (!file) {
      result.replaceChildren(h("p", { class: "field-wrong" }, "Choose the URDF file of a robot first."));
      return;
    }
    run.disabled = true;
    try {
      const beside = side.files?.[0];
      const { scene, left_out: left } = await api.importUrdf(
        await file.text(),
        beside ? JSON.parse(await beside.text()) : undefined,
      );
      const text = pretty(scene);
      result.replaceChildren(
        h(
          "p",
          null,
          h("b", null, scene.title ?? scene.name),
          `: ${plural(scene.bodies?.length ?? 0, "body", "bodies")}, ${plural(scene.joints?.length ?? 0, "joint")}.`,
        ),
        left.length > 0
          ? h(
              "div",
              null,
              h("p", null, "What could not be carried over:"),
              h(
                "ul",
                { class: "left-out" },
                ...left.map((one) => h("li", null, `Line ${one.line}, ${one.of}: ${one.what}`)),
              ),
            )
          : h("p", null, "Everything was carried over."),
        h(
          "button",
          {
            type: "button",
            class: "button primary",
            onclick: () => {
              remember("scene-draft", text);
              navigate(target);
            },
          },
          "Open as your own scene",
        ),
      );
    } catch (error) {
      result.replaceChildren(problemNotice(error));
    } finally {
      run.disabled = false;
    }
  };
  return h(
    "details",
    { class: "expert" },
    h("summary", null, "Import a robot (URDF)"),
    h(
      "div",
      { class: "stack" },
      h(
        "p",
        { class: "help" },
        'A URDF is a tree of links. Loops are closed by a side-car: JSON with joints in the words of a scene, such as {"joints": [{"name": "closing", "type": "spherical", "body_i": "rod", "point_i": [0, 0, 1], "body_j": "ground", "point_j": [1, 0, 0]}]}.',
      ),
      h("label", { for: "urdf-file" }, "URDF file"),
      urdf,
      h("label", { for: "urdf-side" }, "Side-car, if the robot has loops (JSON)"),
      side,
      h("div", { class: "row" }, run),
      result,
    ),
  );
}
