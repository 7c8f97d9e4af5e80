// Pulling a body by numbers, for whoever cannot or will not drag it in the sketch.
import type { Vec3 } from "../api/types";
import { h } from "../core/dom";
import type { Session } from "../session/session";
import { problemNotice } from "../ui/notice";
import type { Panel } from "../ui/panel";

export function pullPanel(session: Session): Panel {
  const body = h("select", { class: "field compact", "aria-label": "Body to pull" });
  const fields = ["x", "y", "z"].map((axis) =>
    h("input", {
      type: "text",
      inputmode: "decimal",
      autocomplete: "off",
      class: "field number compact",
      value: "0",
      "aria-label": `Pull to ${axis}, in metres`,
    }),
  );
  const trouble = h("div", { "aria-live": "polite" });
  const release = h(
    "button",
    { type: "button", class: "button small", onclick: () => void attempt(() => session.pull(null)) },
    "Let go",
  );
  let offered = "";

  const attempt = async (run: () => Promise<void>): Promise<void> => {
    try {
      await run();
      trouble.replaceChildren();
    } catch (error) {
      trouble.replaceChildren(problemNotice(error));
    }
  };
  const pull = (): void => {
    const to = fields.map((field) => Number(field.value.trim().replace(",", ".").replace("−", "-"))) as Vec3;
    for (const [k, field] of fields.entries())
      field.setAttribute("aria-invalid", String(!Number.isFinite(to[k])));
    if (to.every(Number.isFinite))
      void attempt(() => session.pull({ body: body.value, point: [0, 0, 0], to }));
  };
  const here = (): void => {
    const found = session.latest?.bodies.find((entry) => entry.name === body.value);
    fields.forEach((field, k) => {
      field.value = String(Number((found?.position[k] ?? 0).toFixed(3)));
    });
  };
  body.addEventListener("change", here);
  const refresh = (): void => {
    const names = session.latest?.bodies.map((entry) => entry.name) ?? [];
    if (names.join("|") !== offered) {
      offered = names.join("|");
      body.replaceChildren(...names.map((name) => h("option", { value: name }, name)));
      here();
    }
    release.disabled = !session.latest?.pull;
  };
  const root = h(
    "details",
    { class: "expert" },
    h("summary", null, "Pull a body"),
    h(
      "div",
      { class: "stack" },
      h(
        "p",
        { class: "help" },
        "In the sketch, drag a body: a spring pulls it to the hand while the run goes on. Or pull the centre of mass by numbers, in metres.",
      ),
      h(
        "div",
        { class: "row wrap" },
        body,
        h("span", null, "to"),
        ...fields,
        h("button", { type: "button", class: "button small", onclick: pull }, "Pull"),
        release,
      ),
      trouble,
    ),
  );
  return { root, refresh };
}
