// The reactions of every joint by the chosen convention, the joints that share redundant rows, one body cut free.

import { api } from "../../api/client";
import type { JointMultipliers, Reactions, SessionState } from "../../api/types";
import { h, setText } from "../../core/dom";
import { seconds } from "../../core/format";
import { bind } from "../../core/keys";
import { listed, t } from "../../core/texts";
import type { Drawn } from "../../mechanics/forces";
import type { ReactionConvention } from "../../session/events";
import { type LiveQuery, liveQuery } from "../../session/live-query";
import type { Session } from "../../session/session";
import { drawnOf, textOf } from "../../session/share";
import { empty, problemNotice } from "../../ui/notice";
import type { Panel } from "../../ui/panel";
import { OF_JOINTS, worthLine } from "../accuracy";
import { paintFreeBody } from "./free-body";
import { card, type JointReaction } from "./reaction-card";
import { givenUp } from "./wording";

interface JointReactions {
  multipliers: JointMultipliers[];
  reactions: Reactions;
  /** The state that was shown when they were asked for: it tells their errors. */
  of?: SessionState;
}

export class ReactionsTab implements Panel {
  readonly root: HTMLElement;
  private readonly list = h("div", { class: "joints" });
  private readonly shared = h("div", { class: "stack" });
  private readonly cutFree = h("div", { class: "stack", hidden: true });
  private readonly when = h("p", { class: "when" });
  private readonly worth = worthLine(OF_JOINTS);
  private readonly on: Choice;
  private readonly about: Choice;
  private readonly frame: Choice;
  private readonly drawn: Choice;
  private readonly source: LiveQuery;

  private answer: JointReactions | undefined;
  private paintedSelection: string | null = null;

  constructor(private readonly session: Session) {
    this.on = choice(
      t("Acting on"),
      [
        ["j", t("second body")],
        ["i", t("first body")],
      ],
      (value) => session.setConvention({ on: value as ReactionConvention["on"] }),
    );
    this.about = choice(
      t("Moment about"),
      [
        ["joint", t("the joint")],
        ["center", t("centre of mass")],
      ],
      (value) => session.setConvention({ about: value as ReactionConvention["about"] }),
    );
    this.frame = choice(
      t("Components in"),
      [
        ["world", t("world frame")],
        ["joint", t("joint’s axes")],
        ["body", t("body axes")],
      ],
      (value) => session.setConvention({ in: value as ReactionConvention["in"] }),
    );
    this.drawn = choice(t("Arrows"), [], (value) => {
      const drawn = drawnOf(value);
      if (drawn) session.draw(drawn);
    });
    this.source = liveQuery(
      session,
      (run, at) => this.ask(run, at),
      (value, of) => {
        this.answer = { ...value, of };
        this.paint();
      },
      (error) => this.list.replaceChildren(problemNotice(error)),
      () => Object.values(session.convention).join(""),
    );
    this.root = this.layout();
    this.listen();
  }

  refresh(): void {
    const { session } = this;
    if (this.paintedSelection !== session.joint) {
      this.paint();
      if (session.joint !== null && !session.moving)
        this.list.querySelector(".joint.is-selected")?.scrollIntoView({ block: "nearest" });
    }
    paintFreeBody(this.cutFree, session.shown, session.drawn);
    this.source.refresh();
  }

  private layout(): HTMLElement {
    const fit = h(
      "button",
      {
        type: "button",
        class: "button quiet small",
        hidden: !this.session.controls,
        title: t("Takes the length of the arrows from the recording so far"),
        onclick: () => this.session.fitScale(),
      },
      t("Fit the arrows"),
    );
    return h(
      "div",
      { class: "stack" },
      h("div", { class: "switches" }, this.on.root, this.about.root, this.frame.root, this.drawn.root, fit),
      this.when,
      this.worth.root,
      this.shared,
      this.cutFree,
      this.list,
    );
  }

  private listen(): void {
    const { session } = this;
    session.on("view", () => {
      this.paint();
      this.source.refresh();
    });
    bind([
      {
        keys: ["f", "F"],
        shown: "F",
        does: t("Forces: selected joint, all joints, none"),
        run: () => session.draw(next(session.drawn)),
      },
    ]);
  }

  private async ask(run: string, at: number | undefined): Promise<JointReactions> {
    const { on, about, in: frame } = this.session.convention;
    const [multipliers, reactions] = await Promise.all([
      api.multipliers(run, at),
      api.reactions(run, { on, about, in: frame }, at),
    ]);
    return { multipliers, reactions };
  }

  private paint(): void {
    const { session, list } = this;
    this.paintChoices();
    const state = session.shown;
    if (!state) return;
    this.paintedSelection = session.joint;
    const restoreFocus = heldFocus(list);
    const cards = shownReactions(this.answer).map((entry) => {
      const selected = session.joint === entry.joint;
      return card(entry, selected, () => session.select(selected ? null : entry.joint));
    });
    setText(this.when, t("At {time}.", { time: seconds(this.answer?.reactions.time ?? state.time) }));
    this.worth.root.hidden = cards.length === 0;
    this.worth.show(this.answer?.of ?? state);
    list.replaceChildren(...cards);
    if (cards.length === 0)
      list.replaceChildren(
        empty(t("No joints"), t("This scene has no joint, hence no multiplier that is a joint force.")),
      );
    restoreFocus();
    paintShared(this.shared, this.answer?.reactions);
    paintFreeBody(this.cutFree, state, session.drawn);
  }

  private paintChoices(): void {
    const { convention, drawn, latest } = this.session;
    this.drawn.offer([
      ["joint", t("selected joint")],
      ["all", t("all joints")],
      ["none", t("none")],
      ...(latest?.bodies ?? []).map(({ name }): [string, string] => [
        `body:${name}`,
        t("{name} cut free", { name }),
      ]),
    ]);
    this.drawn.set(textOf(drawn));
    this.on.set(convention.on);
    this.about.set(convention.about);
    this.frame.set(convention.in);
  }
}

const next = (drawn: Drawn): Drawn => ({
  what: drawn.what === "joint" ? "all" : drawn.what === "all" ? "none" : "joint",
});

function shownReactions(answer: JointReactions | undefined): JointReaction[] {
  return (answer?.reactions.reactions ?? []).map((entry) => ({
    ...entry,
    rows: answer?.multipliers.find((one) => one.joint === entry.joint)?.rows ?? [],
  }));
}

/** The cards are made anew as time goes on; whoever stands in one with the keyboard stays there. */
function heldFocus(list: HTMLElement): () => void {
  const focused = document.activeElement;
  if (!(focused instanceof HTMLElement) || !list.contains(focused)) return () => undefined;
  const at = [...list.children].findIndex((child) => child.contains(focused));
  const what = focused.classList.contains("joint-select") ? ".joint-select" : ".table-scroll";
  return () => list.children[at]?.querySelector<HTMLElement>(what)?.focus({ preventScroll: true });
}

interface Choice {
  root: HTMLElement;
  offer: (options: [string, string][]) => void;
  set: (value: string) => void;
}

function choice(label: string, options: [string, string][], changed: (value: string) => void): Choice {
  const select = h("select", { class: "field compact" });
  let offered = "";
  const offer: Choice["offer"] = (list) => {
    const key = list.map(([value]) => value).join("|");
    if (key === offered) return;
    offered = key;
    select.replaceChildren(...list.map(([value, text]) => h("option", { value }, text)));
  };
  offer(options);
  select.addEventListener("change", () => changed(select.value));
  return {
    root: h("label", { class: "switch" }, h("span", null, label), select),
    offer,
    set: (value) => {
      if (select.value !== value) select.value = value;
    },
  };
}

/** Says which joints share redundant rows, and what would make their reactions unique. */
function paintShared(place: HTMLElement, known: Reactions | undefined): void {
  const sets = known?.redundancies ?? [];
  const key = JSON.stringify(sets);
  if (place.dataset.of === key) return;
  place.dataset.of = key;
  place.hidden = sets.length === 0;
  place.replaceChildren(...sets.map(redundancyNotice));
}

function redundancyNotice(set: Reactions["redundancies"][number]): HTMLElement {
  const rows = set.rows === 1 ? t("one row") : t("{rows} rows", { rows: set.rows });
  const remedies = set.remedies.map((remedy) =>
    t("let {joint} be {becomes}, which gives up {gives_up}", {
      joint: remedy.joint,
      becomes: remedy.becomes,
      gives_up: givenUp(remedy.gives_up),
    }),
  );
  return h(
    "section",
    { class: "notice is-note shared" },
    h(
      "div",
      { class: "notice-body" },
      h(
        "p",
        { class: "notice-title" },
        t("{joints} share {rows} too many: components marked ≈ are not unique.", {
          joints: listed(set.joints),
          rows,
        }),
      ),
      h(
        "p",
        null,
        t(
          "The motion is the same however these joints share the load. What is shown is the smallest set of multipliers that gives it.",
        ),
      ),
      remedies.length > 0
        ? h("p", null, h("strong", null, t("To make them unique:")), " ", remedies.join("; "), ".")
        : null,
    ),
  );
}
