// What is dropped on a page of scenes, or pasted there: a scene as JSON, or a robot as URDF with an optional side-car.

import { h } from "../core/dom";
import { recall } from "../core/prefs";
import { t } from "../core/texts";
import { dialog } from "../ui/dialog";
import { importDialog, replacing } from "./import";
import { isMarkup } from "./markup";

/** Larger files are not read: twice what the server takes of a robot. */
const MOST_BYTES = 8 << 20;

export interface Receiver {
  /** Puts a scene's text in the place of the one that is written. */
  open: (text: string) => void;
  /** The text before can be had back: nothing is asked first. */
  undoable: boolean;
}

/** Takes what is dropped and pasted until the returned function is called. */
export function takeIncoming(receiver: Receiver): () => void {
  const veil = h(
    "div",
    { class: "drop-veil", "aria-hidden": "true" },
    h("p", null, t("Drop a scene (JSON) or a robot (URDF)")),
  );
  const ending = new AbortController();
  const listen = <K extends "dragover" | "dragleave" | "drop" | "paste">(
    kind: K,
    heard: (event: DocumentEventMap[K]) => void,
  ): void => document.addEventListener(kind, heard, { signal: ending.signal });
  const brings = ({ dataTransfer }: DragEvent): boolean => dataTransfer?.types.includes("Files") ?? false;

  listen("dragover", (event) => {
    if (!brings(event)) return;
    // Without this the browser would leave the page for the file.
    event.preventDefault();
    document.body.append(veil);
  });
  listen("dragleave", (event) => {
    if (event.relatedTarget === null) veil.remove();
  });
  listen("drop", (event) => {
    veil.remove();
    const field = event.target instanceof HTMLInputElement && event.target.type === "file";
    if (field) return;
    const text = event.dataTransfer?.getData("text/plain") ?? "";
    if (!brings(event) && !isMarkup(text)) return;
    event.preventDefault();
    if (brings(event)) void takeFiles([...(event.dataTransfer?.files ?? [])], receiver);
    else importDialog({ name: t("The text"), urdf: text }, receiver.open, replaces(receiver));
  });
  listen("paste", (event) => {
    const files = [...(event.clipboardData?.files ?? [])];
    const text = event.clipboardData?.getData("text/plain") ?? "";
    const elsewhere = event.target instanceof HTMLElement && event.target.closest("dialog, input");
    if (elsewhere || !(files.length > 0 || isMarkup(text))) return;
    event.preventDefault();
    if (files.length > 0) void takeFiles(files, receiver);
    else importDialog({ name: t("The text"), urdf: text }, receiver.open, replaces(receiver));
  });
  return () => {
    veil.remove();
    ending.abort();
  };
}

/** Whether a scene would be lost. */
const replaces = ({ undoable }: Receiver): boolean => !undoable && recall("scene-draft") !== null;

async function takeFiles(files: File[], receiver: Receiver): Promise<void> {
  const [first] = files;
  if (!first) return;
  const large = files.find((file) => file.size > MOST_BYTES);
  if (large) {
    refuse(t("{name} is too large for a scene or a robot.", { name: large.name }));
    return;
  }
  const read = await Promise.all(files.map(async (file) => ({ name: file.name, text: await file.text() })));
  const robot = read.find(({ text }) => isMarkup(text));
  const json = read.find(({ text }) => /^\uFEFF?\s*\{/.test(text));
  if (robot)
    importDialog({ name: robot.name, urdf: robot.text, side: json?.text }, receiver.open, replaces(receiver));
  else if (json) offerScene(json, receiver);
  else refuse(t("{name} is neither a scene (JSON) nor a robot (URDF).", { name: first.name }));
}

function refuse(why: string): void {
  dialog(t("This cannot be opened"), h("p", { class: "field-wrong", role: "alert" }, why));
}

/** A scene from a file; where another is being written, its author is asked first. */
function offerScene({ name, text }: { name: string; text: string }, receiver: Receiver): void {
  if (!replaces(receiver)) {
    receiver.open(text);
    return;
  }
  const box = dialog(
    t("Open {name}", { name }),
    h("p", null, replacing()),
    h(
      "div",
      { class: "row" },
      h(
        "button",
        {
          type: "button",
          class: "button primary",
          onclick: () => {
            box.close();
            receiver.open(text);
          },
        },
        t("Open as your own scene"),
      ),
    ),
  );
}
