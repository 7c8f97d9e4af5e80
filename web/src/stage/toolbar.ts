// The small buttons over the drawing: fit, whole screen, picture as a file.

import { h, saveFile } from "../core/dom";
import { fileName } from "../core/format";
import { bind } from "../core/keys";
import { t } from "../core/texts";
import type { Session } from "../session/session";
import { type IconName, icon } from "../ui/icons";
import { besideMenu } from "./beside-menu";
import type { Drawing } from "./drawing";

export function toolbar(
  session: Session,
  drawing: Drawing,
  stage: () => HTMLElement,
): { root: HTMLElement; dispose: () => void } {
  const fit = (): void => drawing.fit();
  const whole = (): void => {
    if (document.fullscreenElement) void document.exitFullscreen();
    else void stage().requestFullscreen?.();
  };
  const save = (): void => {
    const state = session.shown;
    const title = state ? `${state.title}, ${state.time.toFixed(3)} s` : "mechanism";
    saveFile(new Blob([drawing.svg(title)], { type: "image/svg+xml" }), `${fileName(title)}.svg`);
  };
  const release = bind([
    { keys: ["0"], shown: "0", does: t("Show all of the mechanism, as large as it fits"), run: fit },
    { keys: ["e", "E"], shown: "E", does: t("The drawing on the entire screen, and back"), run: whole },
  ]);
  const beside = besideMenu(session);
  const root = h(
    "div",
    { class: "stage-tools", role: "group", "aria-label": t("Drawing") },
    tool("fit", t("Show all of it, as large as it fits (0)"), fit),
    tool("full", t("Entire screen (E)"), whole),
    tool("save", t("Save this picture (SVG)"), save),
    beside.root,
  );
  return {
    root,
    dispose: () => {
      release();
      beside.dispose();
    },
  };
}

function tool(name: IconName, title: string, run: () => void): HTMLElement {
  return h(
    "button",
    { type: "button", class: "button quiet small icon-only", title, "aria-label": title, onclick: run },
    icon(name),
  );
}
