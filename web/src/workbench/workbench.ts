// The mechanism's side of a page: picture, controls, inspector. One session, opened and closed here.
import type { SessionSource } from "../api/client";
import type { Scene } from "../api/types";
import { h } from "../core/dom";
import type { OwnRun } from "../exercise/field";
import { inspector } from "../inspector/inspector";
import { PresenterPanel } from "../lecture/presenter";
import type { Asked } from "../prediction/panel";
import { keepView, keptView, tellKept } from "../session/reloaded";
import { Session } from "../session/session";
import { restore, type Shared, shareButton, viewOf } from "../session/share";
import type { SharedView } from "../session/shared-view";
import { takeAlongButton } from "../share/dialog";
import { motionOf } from "../share/motion";
import { Stage } from "../stage/stage";
import { type Action, acting } from "./acting";
import { HappenedMarks } from "./happened-marks";
import { placeMenu } from "./place-menu";
import { trouble } from "./run-problems";
import { sharing } from "./sharing";
import { Transport } from "./transport";

/** A slide's picture: pixels for each of the stage's, and how well it is kept. */
const THUMBNAIL = 0.25;
const THUMBNAIL_QUALITY = 0.7;

export interface WorkbenchOptions {
  source: SessionSource;
  scene: Scene | undefined;
  /** What a link asks to be shown. */
  seen?: SharedView | undefined;
  /** Where a scene that stands only here is opened from a link, and its text. */
  own?: { path: string; text: string } | undefined;
  /** What is asked for before the run. */
  asked?: Asked | undefined;
}

/** Fills `root` and starts the run; the text beside it may ask it to act. */
export function workbench(
  root: HTMLElement,
  options: WorkbenchOptions,
): { dispose: () => void; act: (action: Action) => void; run: () => OwnRun | undefined } {
  const kept = keptView(options.source);
  const seen = kept?.view ?? options.seen;
  const session = new Session(options.source, seen?.numbers);
  const made = mountWorkbench(root, session, { ...options, seen });
  options.asked?.hold(session);
  const keep = (): void => {
    // What waits for a prediction shows nothing yet: it is what was kept before.
    if (session.held && kept) keepView(options.source, kept.view, kept.altered);
    else if (session.latest && !session.held) keepView(options.source, made.seen(), session.altered);
  };
  addEventListener("pagehide", keep);
  void session.start().then(async () => {
    await options.asked?.given;
    if (!seen || !session.latest) return;
    await restore(session, seen);
    if (kept) tellKept(session, kept);
  });
  const run = (): OwnRun | undefined =>
    session.view && { scene: session.view.scene as Scene, altered: session.altered };
  const dispose = (): void => {
    removeEventListener("pagehide", keep);
    made.dispose();
  };
  return { dispose, act: acting(session, root, made.selectPanel), run };
}

/** Picture, controls and inspector of a run that somebody else starts. */
export function mountWorkbench(
  root: HTMLElement,
  session: Session,
  options: Partial<WorkbenchOptions>,
): { dispose: () => void; selectPanel: (key: string) => void; seen: () => SharedView } {
  const picture = new Stage(session, options.scene, options.seen?.picture);
  const details = inspector(session, options.seen?.panel);
  const shared: Shared = {
    session,
    panel: details.current,
    picture: () => picture.current(),
    own: options.own,
  };
  const seen = (): SharedView => viewOf(shared);
  const lecture =
    session.controls && !session.here
      ? new PresenterPanel(session, {
          seen,
          picture: () => picture.drawing.canvas(THUMBNAIL).toDataURL("image/webp", THUMBNAIL_QUALITY),
          motion: () => motionOf(session, options.scene),
          replay: (taped) => void import("../share/lecture-dialog").then((made) => made.lectureDialog(taped)),
        })
      : undefined;
  const more = h(
    "span",
    { class: "row tight" },
    session.controls ? placeMenu() : null,
    lecture?.button ?? null,
    session.controls ? shareButton(shared) : null,
    takeAlongButton({ session, drawing: picture.drawing, scene: options.scene }),
    picture.toggle,
  );
  const happened = new HappenedMarks(session, () => {
    details.select("state");
    details.root.querySelector<HTMLElement>(".happened-go")?.focus();
  });
  const controls = new Transport(session, options.scene?.simulation?.duration, more, happened);
  const waits = (): void => {
    details.root.hidden = session.held;
  };
  session.on("view", waits);
  waits();
  const shares = sharing(root, picture.root, details.root);
  root.replaceChildren(
    picture.root,
    shares.divider,
    ...(options.asked ? [options.asked.root] : []),
    controls.root,
    ...(lecture ? [lecture.root] : []),
    trouble(session),
    details.root,
  );
  return {
    selectPanel: details.select,
    seen,
    dispose: () => {
      shares.dispose();
      lecture?.dispose();
      controls.dispose();
      picture.dispose();
      session.close();
    },
  };
}
