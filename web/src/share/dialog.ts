// What can be taken along of the mechanism: a picture, a film, a page that plays, a frame for other pages.

import { isNone } from "../api/numbers";
import type { Motion, Scene } from "../api/types";
import { addressOf } from "../core/address";
import { announce, h, saveFile, setText } from "../core/dom";
import { fileName } from "../core/format";
import { t } from "../core/texts";
import type { Session } from "../session/session";
import type { Drawing } from "../stage/drawing";
import { dialog } from "../ui/dialog";
import { icon } from "../ui/icons";
import { film, kindOfFilm, lengthOf } from "./film";
import { motionOf } from "./motion";
import { pageFile } from "./page-file";

/** Pixels of a picture for each of the page's: sharp in print. */
const PNG_RATIO = 3;

export interface Taken {
  session: Session;
  drawing: Drawing;
  scene: Scene | undefined;
}

export function takeAlongButton(taken: Taken): HTMLElement {
  return h(
    "button",
    {
      type: "button",
      class: "button quiet small icon-only",
      "aria-label": t("Take it along: picture, film, page that plays"),
      title: t("Take it along: picture, film, page that plays"),
      onclick: () => open(taken),
    },
    icon("save"),
  );
}

function open(taken: Taken): void {
  const { session } = taken;
  const state = session.shown;
  if (!state) return;
  const motion = motionOf(session, taken.scene);
  const said = h("p", { class: "help", role: "status" });
  const leaving = new AbortController();
  const box = dialog(
    t("Take it along"),
    row(
      t("A picture of this moment"),
      t("For a paper or a slide, as the stage shows it."),
      ...pictures(taken, said),
    ),
    row(
      t("A page that plays"),
      motion && motion.until > 0
        ? t(
            "One HTML file with the first {until} s, for a USB stick or an e-mail: it needs no server and no network.",
            { until: motion.until.toFixed(2) },
          )
        : t("Run the mechanism first: what was seen so far goes into the file."),
      press(
        t("Save the page (HTML)"),
        motion && motion.until > 0 ? () => void savePage(taken, motion, said) : null,
      ),
    ),
    row(
      t("A film"),
      kindOfFilm() === undefined
        ? t("This browser records no films; Chromium and Firefox do.")
        : motion && motion.until > 0
          ? t("It is played once while it is recorded, {length} s.", { length: lengthOf(motion).toFixed(0) })
          : t("Run the mechanism first."),
      press(
        t("Record a film"),
        motion && motion.until > 0 && kindOfFilm()
          ? () => void saveFilm(taken, motion, said, leaving.signal)
          : null,
      ),
    ),
    ...frameRow(session),
    said,
  );
  box.addEventListener("close", () => leaving.abort());
}

function row(title: string, about: string, ...actions: HTMLElement[]): HTMLElement {
  return h(
    "section",
    { class: "take" },
    h("h3", null, title),
    h("p", null, about),
    h("div", { class: "row wrap" }, ...actions),
  );
}

function press(label: string, run: (() => void) | null): HTMLButtonElement {
  return h(
    "button",
    { type: "button", class: "button", disabled: run === null, onclick: run ?? (() => {}) },
    label,
  );
}

const nameOf = (session: Session): string => {
  const state = session.shown;
  return fileName(state ? `${state.title}, ${state.time.toFixed(3)} s` : "");
};

function pictures({ session, drawing }: Taken, said: HTMLElement): HTMLElement[] {
  return [
    press(t("Save as SVG"), () => {
      const text = drawing.svg(session.shown?.title ?? "mechanism");
      saveFile(new Blob([text], { type: "image/svg+xml" }), `${nameOf(session)}.svg`);
    }),
    press(t("Save as PNG"), () => {
      drawing.canvas(PNG_RATIO).toBlob((blob) => {
        if (blob) saveFile(blob, `${nameOf(session)}.png`);
        else setText(said, t("This browser could not write the picture; take the SVG."));
      });
    }),
  ];
}

async function savePage({ session }: Taken, motion: Motion, said: HTMLElement): Promise<void> {
  try {
    const blob = await pageFile({ motion, drawn: session.drawn, camera: session.camera });
    saveFile(blob, `${fileName(motion.title)}.html`);
    setText(said, t("Saved, {size} kB.", { size: Math.ceil(blob.size / 1000) }));
  } catch {
    setText(said, t("The file could not be made: is the server still there?"));
  }
}

async function saveFilm(
  { session, drawing }: Taken,
  motion: Motion,
  said: HTMLElement,
  signal: AbortSignal,
): Promise<void> {
  announce(t("The film is being recorded."));
  try {
    const blob = await film(
      motion,
      session,
      drawing,
      (part) => setText(said, t("Recording: {part} %", { part: Math.round(100 * part) })),
      signal,
    );
    saveFile(blob, `${fileName(motion.title)}.${blob.type.includes("mp4") ? "mp4" : "webm"}`);
    setText(said, t("Saved, {size} MB.", { size: (blob.size / 1e6).toFixed(1) }));
  } catch {
    if (!signal.aborted) setText(said, t("This browser could not record the film."));
  }
}

/** The text for a frame in another page: of what the server can show by itself. */
function frameRow(session: Session): HTMLElement[] {
  const source = session.latest?.source;
  const place =
    source && "builtin" in source
      ? `scenes/${source.builtin}`
      : source && "lesson" in source
        ? `lessons/${source.lesson}`
        : "";
  if (!place || !isNone(session.numbers)) return [];
  const address = new URL(addressOf(`/embed/${place}`), location.href);
  address.searchParams.set("play", "1");
  if (session.drawn.what === "all") address.searchParams.set("forces", "all");
  if (session.camera !== "corner") address.searchParams.set("from", session.camera);
  const text = `<iframe src="${address.href.replaceAll("&", "&amp;")}" title="${session.latest?.title.replaceAll('"', "'") ?? ""}" width="640" height="400" loading="lazy"></iframe>`;
  const field = h("input", {
    class: "field",
    readonly: true,
    value: text,
    "aria-label": t("Text of the frame"),
  });
  field.addEventListener("focus", () => field.select());
  return [
    row(
      t("A frame in slides or a course page"),
      t("It plays the recorded run of this mechanism, with its author’s numbers; nobody needs an account."),
      field,
    ),
  ];
}
