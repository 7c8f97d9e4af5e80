// One body cut free, with every force on it, their sum, and mass times acceleration.

import type { SessionState, Vec3 } from "../../api/types";
import { h } from "../../core/dom";
import { num } from "../../core/format";
import { t } from "../../core/texts";
import { type Drawn, freeBody, momentAbout } from "../../mechanics/forces";
import { norm } from "../../mechanics/vec";

export function paintFreeBody(place: HTMLElement, state: SessionState | undefined, drawn: Drawn): void {
  place.hidden = drawn.what !== "body";
  if (drawn.what !== "body" || !state) return;
  const body = state.bodies.find((entry) => entry.name === drawn.body);
  if (!body) return;
  const { arrows, sum, inertia } = freeBody(state, drawn.body);
  const largest = Math.max(1e-300, ...arrows.map((arrow) => norm(arrow.force)));
  // Beside the largest force this is rounding.
  const clean = (part: number): number => (Math.abs(part) < 1e-12 * largest ? 0 : part);
  const line = (label: string, force: Vec3, moment: Vec3 | null, strong = false): HTMLElement =>
    h(
      "tr",
      { class: strong ? "strong" : "" },
      h("th", { scope: "row" }, label),
      ...[...force, ...(moment ?? [])].map((part) => h("td", { class: "number" }, num(clean(part), 5))),
      moment ? null : h("td", { colspan: "3" }),
    );
  place.replaceChildren(
    h("h3", null, t("{body}, cut free", { body: drawn.body })),
    h(
      "div",
      {
        class: "table-scroll",
        tabindex: "0",
        role: "region",
        "aria-label": t("Forces on {body}", { body: drawn.body }),
      },
      h(
        "table",
        { class: "data" },
        h(
          "caption",
          null,
          t("Forces in newtons and moments about the centre of mass in newton metres, world frame"),
        ),
        h(
          "thead",
          null,
          h(
            "tr",
            null,
            h("th", { scope: "col" }, t("Force")),
            ...["Fx", "Fy", "Fz", "Mx", "My", "Mz"].map((name) =>
              h("th", { scope: "col", class: "number" }, name),
            ),
          ),
        ),
        h(
          "tbody",
          null,
          ...arrows.map((arrow) =>
            line(arrow.label, arrow.force, arrow.kind === "load" ? null : momentAbout(arrow, body.position)),
          ),
          line("sum", sum, null, true),
          line(t("mass × acceleration"), inertia, null, true),
        ),
      ),
    ),
  );
}
