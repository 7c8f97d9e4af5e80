// The reactions of every joint, by the convention that is chosen; the joints that share redundant rows; one body cut
// free.
import { api } from "../api/client";
import type { JointMultipliers, Reactions, SessionState } from "../api/types";
import { h, setText } from "../core/dom";
import { seconds } from "../core/format";
import { bind } from "../core/keys";
import type { Drawn } from "../mechanics/forces";
import type { ReactionConvention } from "../session/events";
import { liveQuery } from "../session/live-query";
import type { Session } from "../session/session";
import { empty, problemNotice } from "../ui/notice";
import type { Panel } from "../ui/panel";
import { paintFreeBody } from "./free-body";
import { card, type JointReaction } from "./reaction-card";

interface Answer {
  multipliers: JointMultipliers[];
  reactions: Reactions;
}

export function multipliersTab(session: Session): Panel {
  const list = h("div", { class: "joints" });
  const shared = h("div", { class: "stack" });
  const cutFree = h("div", { class: "stack", hidden: true });
  const when = h("p", { class: "when" });
  let seenSelection: string | null = null;
  let answer: Answer | undefined;
  let of: SessionState | undefined;

  const on = choice(
    "Acting on",
    [
      ["j", "second body"],
      ["i", "first body"],
    ],
    (value) => session.setConvention({ on: value as ReactionConvention["on"] }),
  );
  const about = choice(
    "Moment about",
    [
      ["joint", "the joint"],
      ["center", "centre of mass"],
    ],
    (value) => session.setConvention({ about: value as ReactionConvention["about"] }),
  );
  const frame = choice(
    "Components in",
    [
      ["world", "world frame"],
      ["joint", "joint’s axes"],
      ["body", "body axes"],
    ],
    (value) => session.setConvention({ in: value as ReactionConvention["in"] }),
  );
  const drawn = choice("Arrows", [], (value) =>
    session.draw(
      value.startsWith("body:")
        ? { what: "body", body: value.slice(5) }
        : { what: value as "none" | "joint" | "all" },
    ),
  );
  const fit = h(
    "button",
    {
      type: "button",
      class: "button quiet small",
      hidden: !session.controls,
      title: "Takes the length of the arrows from the recording so far",
      onclick: () => session.fitScale(),
    },
    "Fit the arrows",
  );

  const offer = (): void => {
    const bodies = session.latest?.bodies.map((body) => body.name) ?? [];
    drawn.offer([
      ["joint", "selected joint"],
      ["all", "all joints"],
      ["none", "none"],
      ...bodies.map((name): [string, string] => [`body:${name}`, `${name} cut free`]),
    ]);
    drawn.set(session.drawn.what === "body" ? `body:${session.drawn.body}` : session.drawn.what);
    on.set(session.convention.on);
    about.set(session.convention.about);
    frame.set(session.convention.in);
  };

  const paint = (): void => {
    offer();
    const state = session.shown;
    if (!state) return;
    seenSelection = session.joint;
    const keep = heldFocus(list);
    const cards = shownReactions(answer);
    setText(when, `At ${seconds(of?.time ?? state.time)}.`);
    list.replaceChildren(
      ...(cards.length === 0
        ? [empty("No joints", "This scene has no joint, hence no multiplier that is a joint force.")]
        : cards.map((entry) =>
            card(entry, session.joint === entry.joint, () =>
              session.select(session.joint === entry.joint ? null : entry.joint),
            ),
          )),
    );
    keep();
    paintShared(shared, answer?.reactions);
    paintFreeBody(cutFree, state, session.drawn);
  };

  const source = liveQuery(
    session,
    async (run, at): Promise<Answer> => {
      const { on: side, about: point, in: axes } = session.convention;
      const [multipliers, reactions] = await Promise.all([
        api.multipliers(run, at),
        api.reactions(run, { on: side, about: point, in: axes }, at),
      ]);
      return { multipliers, reactions };
    },
    (value, state) => {
      answer = value;
      of = state;
      paint();
    },
    (error) => list.replaceChildren(problemNotice(error)),
    () => `${session.convention.on}${session.convention.about}${session.convention.in}`,
  );
  session.on("view", () => {
    paint();
    source.refresh();
  });
  bind([
    {
      keys: ["f", "F"],
      shown: "F",
      says: "Forces: selected joint, all joints, none",
      run: () => session.draw(next(session.drawn)),
    },
  ]);

  return {
    root: h(
      "div",
      { class: "stack" },
      h("div", { class: "switches" }, on.root, about.root, frame.root, drawn.root, fit),
      shared,
      cutFree,
      list,
      when,
    ),
    refresh: () => {
      if (seenSelection !== session.joint) {
        paint();
        if (session.joint !== null && !session.moving)
          list.querySelector(".joint.is-selected")?.scrollIntoView({ block: "nearest" });
      }
      paintFreeBody(cutFree, session.shown, session.drawn);
      source.refresh();
    },
  };
}

const next = (drawn: Drawn): Drawn => ({
  what: drawn.what === "joint" ? "all" : drawn.what === "all" ? "none" : "joint",
});

function shownReactions(answer: Answer | undefined): JointReaction[] {
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

function paintShared(place: HTMLElement, known: Reactions | undefined): void {
  const sets = known?.redundancies ?? [];
  const key = JSON.stringify(sets);
  if (place.dataset.of === key) return;
  place.dataset.of = key;
  place.hidden = sets.length === 0;
  place.replaceChildren(
    ...sets.map((set) =>
      h(
        "section",
        { class: "notice is-note shared" },
        h(
          "div",
          { class: "notice-body" },
          h(
            "p",
            { class: "notice-title" },
            `${set.joints.join(" and ")} share ${set.rows === 1 ? "one row" : `${set.rows} rows`} too many: components marked ≈ are not unique.`,
          ),
          h(
            "p",
            null,
            "The motion is the same however these joints share the load. What is shown is the smallest set of multipliers that gives it.",
          ),
          set.remedies.length > 0
            ? h(
                "p",
                null,
                h("strong", null, "To make them unique: "),
                set.remedies
                  .map(
                    (remedy) => `let ${remedy.joint} be ${remedy.becomes}, which gives up ${remedy.gives_up}`,
                  )
                  .join("; "),
                ".",
              )
            : null,
        ),
      ),
    ),
  );
}
