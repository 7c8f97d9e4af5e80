// The button that copies a link to what is seen, and the way back from such a link.

import { isNone } from "../api/numbers";
import type { Camera } from "../api/types";
import { pathOf } from "../core/address";
import { announce, h } from "../core/dom";
import { reducedMotion } from "../core/prefs";
import { t } from "../core/texts";
import type { Drawn } from "../mechanics/forces";
import { icon } from "../ui/icons";
import { banner } from "../ui/notice";
import type { ReactionConvention } from "./events";
import type { Session } from "./session";
import { linkTo, MAX_LENGTH, type SharedView } from "./shared-view";

/** How long the notice of success stays, ms. */
const GLANCE_MS = 6000;

export interface Shared {
  session: Session;
  panel: () => string;
  picture: () => "drawing" | "viewer";
  /** Where a scene of one's own is opened, and its text. */
  own?: { path: string; text: string } | undefined;
}

export function shareButton(shared: Shared): HTMLElement {
  return h(
    "button",
    {
      type: "button",
      class: "button quiet small icon-only",
      "aria-label": t("Copy a link to this view"),
      title: t("Copy a link to this view: numbers, time, joint, panel"),
      onclick: () => void copy(shared),
    },
    icon("link"),
  );
}

async function copy(shared: Shared): Promise<void> {
  const { moving } = shared.session;
  const seen = { ...viewOf(shared), ...(moving ? { plays: true } : {}) };
  const link = await linkTo(shared.own?.path ?? pathOf(location), seen);
  if (link.length > MAX_LENGTH) {
    banner(
      t("This scene is too large for a link ({link} kB). Save its file and send that.", {
        link: Math.round(link.length / 1000),
      }),
      { label: t("Close"), run: () => banner(null) },
    );
    return;
  }
  try {
    await navigator.clipboard.writeText(link);
    announce(t("The link to this view is copied."));
    banner(
      shared.session.altered
        ? t(
            "The link is copied. This run was changed on its way; the link runs it with these numbers from the start.",
          )
        : moving
          ? t("The link to this view is copied: whoever opens it sees the run go on from here.")
          : t("The link to this view is copied: whoever opens it sees the same."),
      { label: t("Fine"), run: () => banner(null) },
    );
    setTimeout(() => banner(null), GLANCE_MS);
  } catch {
    // Without leave to write to the clipboard the address itself becomes the link.
    history.replaceState(null, "", link);
    banner(t("The browser does not let this page copy. The link stands in the address bar now."), {
      label: t("Fine"),
      run: () => banner(null),
    });
  }
}

export function viewOf({ session, panel, picture, own }: Shared): SharedView {
  const { convention, drawn, camera } = session;
  const seen: SharedView = {
    time: Number(session.time.toPrecision(12)),
    panel: panel(),
    picture: picture(),
    told: `${convention.on}.${convention.about}.${convention.in}`,
    drawn: textOf(drawn),
    camera,
  };
  if (!isNone(session.numbers)) seen.numbers = session.numbers;
  if (session.joint !== null) seen.joint = session.joint;
  if (session.plot !== undefined) seen.plot = session.plot;
  if (own) seen.scene = own.text;
  return seen;
}

/** Brings a session that has just started to what a link shows. */
export async function restore(session: Session, seen: SharedView): Promise<void> {
  // What is shown is the run, not an analysis that stands over it.
  session.setPose(undefined);
  applyView(session, seen);
  if (seen.camera && CAMERAS.includes(seen.camera as Camera) && seen.camera !== session.camera)
    session.lookFrom(seen.camera as Camera);
  if (seen.time) await session.goTo(seen.time);
  // What waits for something, a prediction, is not asked for it unbidden.
  if (seen.plays && !session.held && !reducedMotion()) await session.play();
}

const CAMERAS: Camera[] = ["corner", "front", "side", "above"];

/** Selects a joint, states and draws forces as somebody else does. */
export function applyView(session: Session, seen: SharedView): void {
  if (seen.told) {
    const [on, about, frame] = seen.told.split(".");
    const convention: Partial<ReactionConvention> = {};
    if (on === "i" || on === "j") convention.on = on;
    if (about === "joint" || about === "center") convention.about = about;
    if (frame === "world" || frame === "joint" || frame === "body") convention.in = frame;
    session.setConvention(convention);
  }
  const drawn = drawnOf(seen.drawn);
  if (drawn) session.draw(drawn);
  if (seen.plot !== undefined) session.choosePlot(seen.plot);
  session.select(
    seen.joint && session.latest?.forces.some((entry) => entry.joint === seen.joint) ? seen.joint : null,
  );
}

/** Which forces are drawn, as a link and a list of choices write it: joint, all, none, or body:NAME. */
export const textOf = (drawn: Drawn): string => (drawn.what === "body" ? `body:${drawn.body}` : drawn.what);

/** The inverse of `textOf`; undefined for any other text. */
export function drawnOf(text: string | undefined): Drawn | undefined {
  if (text?.startsWith("body:")) return { what: "body", body: text.slice(5) };
  return text === "joint" || text === "all" || text === "none" ? { what: text } : undefined;
}
