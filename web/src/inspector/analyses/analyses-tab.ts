// Analyses of the scene as it is now, besides its run.

import { api } from "../../api/client";
import type { ModesAbout } from "../../api/types";
import { announce, h, uid } from "../../core/dom";
import { t } from "../../core/texts";
import { type Placed, type Pose, visible } from "../../mechanics/pose";
import type { Session } from "../../session/session";
import { note, problemNotice } from "../../ui/notice";
import type { Panel } from "../../ui/panel";
import {
  type AssemblyResult,
  assemblyView,
  type EquilibriumResult,
  equilibriumView,
  freedomsView,
  type KinematicsResult,
  kinematicsView,
  type Mode,
  type ModesResult,
  modesView,
} from "./results";

/** What vibrations are about. */
const ABOUT: Record<ModesAbout, () => string> = {
  equilibrium: () => t("about the equilibrium near the start"),
  start: () => t("about the start, at rest"),
  steady: () => t("about the steady motion near the start"),
};

export class AnalysesTab implements Panel {
  readonly root: HTMLElement;
  /** What the result that is shown was asked of, and the button that asked. */
  private asked: { scene: string; label: string; button: HTMLButtonElement } | undefined;
  private readonly result = h("section", {
    class: "stack",
    "aria-live": "polite",
    "aria-label": t("Result of the analysis"),
  });
  private readonly back = h(
    "button",
    { type: "button", class: "button small", hidden: true, onclick: () => this.session.setPose(undefined) },
    t("Back to the run"),
  );

  private readonly about = h(
    "select",
    { class: "field compact", "aria-label": t("What small vibrations are about") },
    ...Object.entries(ABOUT).map(([value, label]) => h("option", { value }, label())),
  );

  constructor(private readonly session: Session) {
    const scene = (of: unknown): { scene: unknown } => ({ scene: of });
    this.root = h(
      "div",
      { class: "stack" },
      h("p", { class: "help" }, t("Asked of the scene with the numbers that it has now, from its start.")),
      h(
        "div",
        { class: "analyses" },
        ...this.analysis(
          t("Count freedoms"),
          t("Which rows are independent, and how many ways to move are left."),
          async (it) => freedomsView(await api.check(JSON.stringify(it))),
        ),
        ...this.analysis(
          t("Assemble"),
          t("Closes the joints of a roughly placed mechanism: where its bodies are then."),
          async (it) => assemblyView(await api.analyse<AssemblyResult>("assembly", scene(it))),
        ),
        ...this.analysis(
          t("Kinematics and driving forces"),
          t("The motion that drivers prescribe, and the forces that it takes."),
          async (it) => kinematicsView(await api.analyse<KinematicsResult>("kinematics", scene(it))),
        ),
        ...this.analysis(
          t("Static equilibrium"),
          t("Where the mechanism rests near its start, and whether it stays there."),
          async (it) => this.equilibrium(await api.analyse<EquilibriumResult>("equilibrium", scene(it))),
        ),
        ...this.analysis(
          t("Small vibrations"),
          t("Frequencies and shapes of the small motions:"),
          async (it) => this.vibrations(it),
          this.about,
        ),
      ),
      this.back,
      this.result,
    );
    session.on("scene", () => {
      session.setPose(undefined);
      this.dropOld();
    });
    // Whatever shows the run again takes the pose away: a step, the time line, another moment.
    session.on("shown", () => {
      this.back.hidden = session.pose === undefined;
    });
  }

  refresh(): void {
    // The results belong to the scene's start, not to the moment that is shown.
  }

  /** A button and what it answers. */
  private analysis(
    label: string,
    answers: string,
    analyse: (scene: unknown) => Promise<HTMLElement[]>,
    ...more: HTMLElement[]
  ): HTMLElement[] {
    const button = this.button(label, analyse);
    const told = h("p", { class: "help", id: uid("answers") }, answers, " ", ...more);
    button.setAttribute("aria-describedby", told.id);
    return [button, told];
  }

  /** A button that runs an analysis and shows its result. */
  private button(label: string, analyse: (scene: unknown) => Promise<HTMLElement[]>): HTMLButtonElement {
    const button = h("button", { type: "button", class: "button" }, label);
    button.addEventListener("click", () => {
      const scene = this.session.view?.scene;
      if (!scene) return;
      const show = (...parts: HTMLElement[]): void => {
        this.result.replaceChildren(...parts);
        this.asked = { scene: JSON.stringify(scene), label, button };
      };
      button.disabled = true;
      analyse(scene)
        .then((parts) => {
          show(h("h3", null, label), ...parts);
          this.result.scrollIntoView({ block: "start" });
          announce(t("{label}: the result is below.", { label }));
        })
        .catch((error: unknown) => show(problemNotice(error)))
        .finally(() => {
          button.disabled = false;
          // Numbers may have been changed while it was computed.
          this.dropOld();
        });
    });
    return button;
  }

  /** Takes a result of other numbers away: they would be read as those of the scene, and its poses do not fit it. */
  private dropOld(): void {
    const { asked, session } = this;
    if (!asked || JSON.stringify(session.view?.scene) === asked.scene) return;
    this.asked = undefined;
    session.setPose(undefined);
    this.result.replaceChildren(
      h("h3", null, asked.label),
      note(
        h("p", null, t("The numbers of the scene were changed: the result was of the numbers before.")),
        h(
          "div",
          { class: "notice-actions" },
          h(
            "button",
            { type: "button", class: "button", onclick: () => asked.button.click() },
            t("Compute anew"),
          ),
        ),
      ),
    );
  }

  /** Shows a pose of the bodies in place of the run, which stands still meanwhile. */
  private pose(pose: Pose): void {
    const { session } = this;
    if (session.latest?.playing || session.replaying) void session.pause();
    session.setPose(pose);
  }

  private equilibrium(found: EquilibriumResult): HTMLElement[] {
    this.pose({ bodies: found.bodies });
    return equilibriumView(found, this.session.latest?.bodies.map((body) => body.name) ?? []);
  }

  private async vibrations(scene: unknown): Promise<HTMLElement[]> {
    const about = this.about.value as ModesAbout;
    const found = await api.analyse<ModesResult>("modes", { scene, about });
    return modesView(found, ABOUT[about](), (mode) => this.swing(found.bodies, mode));
  }

  private swing(bodies: Placed[], mode: Mode): void {
    const state = this.session.latest;
    if (state) this.pose({ bodies, shape: mode.shape, size: visible(state) });
  }
}
