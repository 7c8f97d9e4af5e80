// The mechanism's side of a page: picture, controls, inspector. One session, opened and closed here.
import type { SessionSource } from "../core/api";
import { h } from "../core/dom";
import type { Seen } from "../core/link";
import type { Scene } from "../core/types";
import { problemNotice } from "../ui/notice";
import { inspector } from "./inspector";
import { Session } from "./session";
import { restore, shareButton } from "./share";
import { stage } from "./stage";
import { transport } from "./transport";

export interface BenchOptions {
  source: SessionSource;
  scene: Scene | undefined;
  /** What a link asks to be shown. */
  seen?: Seen | undefined;
  /** Where a scene that stands only here is opened from a link, and its text. */
  own?: { path: string; text: string } | undefined;
}

/** Fills `root` and starts the run; the returned function ends both. */
export function workbench(root: HTMLElement, options: BenchOptions): () => void {
  const session = new Session(options.source, options.seen?.numbers);
  const trouble = h("div", { class: "trouble" });
  const picture = stage(session, options.scene, options.seen?.picture);
  const details = inspector(session, options.seen?.panel);
  const share = shareButton({ session, panel: details.current, picture: picture.current, own: options.own });
  const controls = transport(session, options.scene?.simulation?.duration, h("span", { class: "row tight" }, share, picture.toggle));

  session.on("problem", (error) => {
    trouble.replaceChildren(problemNotice(error, session.latest
      ? [{ label: "Reset", run: () => { trouble.replaceChildren(); void session.reset(); } }]
      : [{ label: "Try again", run: () => { trouble.replaceChildren(); void session.start(); } }]));
  });
  root.replaceChildren(picture.root, controls.root, trouble, details.root);
  void session.start().then(async () => {
    if (options.seen && session.latest) await restore(session, options.seen);
  });

  return () => {
    controls.dispose();
    picture.dispose();
    session.close();
  };
}
