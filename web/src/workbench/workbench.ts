// The mechanism's side of a page: picture, controls, inspector. One session, opened and closed here.
import type { SessionSource } from "../core/api";
import { h } from "../core/dom";
import type { Scene } from "../core/types";
import { problemNotice } from "../ui/notice";
import { inspector } from "./inspector";
import { Session } from "./session";
import { stage } from "./stage";
import { transport } from "./transport";

export interface BenchOptions {
  source: SessionSource;
  scene: Scene | undefined;
}

/** Fills `root` and starts the run; the returned function ends both. */
export function workbench(root: HTMLElement, options: BenchOptions): () => void {
  const session = new Session(options.source);
  const trouble = h("div", { class: "trouble" });
  const picture = stage(session, options.scene);
  const controls = transport(session, options.scene?.simulation?.duration, picture.toggle);
  const details = inspector(session);

  session.on("problem", (error) => {
    trouble.replaceChildren(problemNotice(error, session.latest
      ? [{ label: "Reset", run: () => { trouble.replaceChildren(); void session.reset(); } }]
      : [{ label: "Try again", run: () => { trouble.replaceChildren(); void session.start(); } }]));
  });
  root.replaceChildren(picture.root, controls.root, trouble, details.root);
  void session.start();

  return () => {
    controls.dispose();
    picture.dispose();
    session.close();
  };
}
