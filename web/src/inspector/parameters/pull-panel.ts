// Pulling a body by numbers, for whoever cannot or will not drag it in the drawing.

import type { Vec3 } from "../../api/types";
import { h } from "../../core/dom";
import { typedNumber } from "../../core/format";
import { t } from "../../core/texts";
import type { Session } from "../../session/session";
import type { Panel } from "../../ui/panel";
import { Attempts } from "./attempts";

export class PullPanel implements Panel {
  readonly root: HTMLElement;
  private readonly body = h("select", { class: "field compact", "aria-label": t("Body to pull") });
  private readonly fields = ["x", "y", "z"].map((axis) =>
    h("input", {
      type: "text",
      inputmode: "decimal",
      autocomplete: "off",
      class: "field number compact",
      value: "0",
      "aria-label": t("Pull to {axis}, in metres", { axis }),
    }),
  );
  private readonly release = h(
    "button",
    {
      type: "button",
      class: "button small",
      onclick: () => void this.attempts.run(() => this.session.pull(null)),
    },
    t("Let go"),
  );
  private readonly attempts = new Attempts();
  /** Names of the bodies that are offered. */
  private offered = "";

  constructor(private readonly session: Session) {
    this.body.addEventListener("change", () => this.showPosition());
    this.root = this.layout();
  }

  refresh(): void {
    const names = this.session.latest?.bodies.map((entry) => entry.name) ?? [];
    if (names.join("|") !== this.offered) {
      this.offered = names.join("|");
      this.body.replaceChildren(...names.map((name) => h("option", { value: name }, name)));
      this.showPosition();
    }
    this.release.disabled = !this.session.latest?.pull;
  }

  private layout(): HTMLElement {
    return h(
      "details",
      { class: "expert" },
      h("summary", null, t("Pull a body")),
      h(
        "div",
        { class: "stack" },
        h(
          "p",
          { class: "help" },
          t(
            "In the drawing, drag a body: a spring pulls it to the hand while the run goes on. Or pull the centre of mass by numbers, in metres.",
          ),
        ),
        h(
          "div",
          { class: "row wrap" },
          this.body,
          h("span", null, t("to")),
          ...this.fields,
          h("button", { type: "button", class: "button small", onclick: () => this.pull() }, t("Pull")),
          this.release,
        ),
        this.attempts.root,
      ),
    );
  }

  /** Begins with the place where the body is. */
  private showPosition(): void {
    const found = this.session.latest?.bodies.find((entry) => entry.name === this.body.value);
    this.fields.forEach((field, k) => {
      field.value = String(Number((found?.position[k] ?? 0).toFixed(3)));
    });
  }

  private pull(): void {
    const to = this.fields.map((field) => typedNumber(field.value)) as Vec3;
    for (const [k, field] of this.fields.entries())
      field.setAttribute("aria-invalid", String(!Number.isFinite(to[k])));
    if (to.every(Number.isFinite))
      void this.attempts.run(() => this.session.pull({ body: this.body.value, point: [0, 0, 0], to }));
  }
}
