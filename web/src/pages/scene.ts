// One scene: its text on one side, its run on the other.
import { ApiError, api } from "../api/client";
import type { Scene } from "../api/types";
import { h } from "../core/dom";
import { recall, remember, student } from "../core/prefs";
import { type Page, setTitle } from "../core/router";
import { sceneEditor } from "../editor/editor";
import { pretty } from "../editor/pointer";
import { requestedView } from "../session/requested-view";
import type { SharedView } from "../session/shared-view";
import { icon } from "../ui/icons";
import { problemNotice } from "../ui/notice";
import { type WorkbenchOptions, workbench } from "../workbench/workbench";
import { workbenchPlaceholder } from "./lesson";
import { OWN_SCENE } from "./scenes";

const STARTING_SCENE = "simple-pendulum";

/** A built-in scene, a lesson's, or one that a student writes. */
interface Subject {
  name: string;
  own: boolean;
  /** Slug of the lesson whose scene it is. */
  lesson?: string;
}

export function scenePage(outlet: HTMLElement, params: string[]): Page {
  const name = params[0] ?? "";
  return openScene(outlet, { name, own: name === OWN_SCENE });
}

/** The scene of a lesson as text, with the student's own numbers in it. */
export function lessonScenePage(outlet: HTMLElement, params: string[]): Page {
  const lesson = params[0] ?? "";
  return openScene(outlet, { name: lesson, own: false, lesson });
}

function openScene(outlet: HTMLElement, { name, own, lesson }: Subject): Page {
  const draftKey = lesson ? (`scene-draft:${lesson}` as const) : own ? ("scene-draft" as const) : null;
  const leaving = new AbortController();
  let endRun: (() => void) | undefined;
  let original = "";

  const title = h("h1", null, own ? "Your own scene" : name);
  const about = h("p", { class: "lead" });
  const bench = h(
    "section",
    { class: "bench", id: "mechanism", "aria-label": "Mechanism" },
    workbenchPlaceholder(),
  );
  const run = h(
    "button",
    { type: "button", class: "button primary", onclick: () => runText() },
    icon("play"),
    "Run this text",
  );
  const restore = h(
    "button",
    { type: "button", class: "button", hidden: true, onclick: () => undoEdits() },
    "Undo all changes",
  );
  const state = h("p", { class: "help", role: "status" });
  let shownAs = "";
  const preview = h("input", { type: "checkbox", id: "preview" });
  preview.checked = true;
  const editor = sceneEditor(
    (text) => {
      restore.hidden = text === original;
      state.textContent = text === original ? "" : "Changed, not run yet.";
      if (draftKey) remember(draftKey, text);
    },
    (text) => {
      // What can run is shown at once, at its start; what is already shown stays.
      if (!preview.checked || text === shownAs) return;
      runText();
    },
  );
  const side = h(
    "article",
    { class: "reading is-editor" },
    h(
      "header",
      { class: "lesson-head" },
      h(
        "p",
        { class: "lesson-kicker" },
        lesson
          ? h("a", { href: `/lessons/${encodeURIComponent(lesson)}` }, "Back to the lesson")
          : h("a", { href: "/scenes" }, "Scenes"),
      ),
      title,
      about,
    ),
    h(
      "div",
      { class: "row wrap" },
      run,
      restore,
      h(
        "button",
        { type: "button", class: "button quiet", onclick: () => download() },
        icon("save"),
        "Save the file",
      ),
      h("span", { class: "check-line" }, preview, h("label", { for: "preview" }, "Show it as I type")),
      state,
    ),
    editor.root,
  );
  outlet.append(h("div", { class: "lesson is-scene" }, side, bench));

  const open = (options: WorkbenchOptions): void => {
    endRun?.();
    endRun = workbench(bench, options);
  };
  const runText = (seen?: SharedView): void => {
    try {
      const scene = JSON.parse(editor.text()) as Scene;
      shownAs = editor.text();
      state.textContent = "";
      open({
        source: { scene },
        scene,
        seen,
        own: { path: `/scenes/${OWN_SCENE}`, text: JSON.stringify(scene) },
      });
    } catch {
      state.textContent = "The text is not JSON yet: see the remark below it.";
    }
  };
  const undoEdits = (): void => {
    editor.set(original);
    restore.hidden = true;
    state.textContent = "";
    if (draftKey) remember(draftKey, null);
  };
  const download = (): void => {
    const link = h("a", {
      href: URL.createObjectURL(new Blob([editor.text()], { type: "application/json" })),
      download: `${own ? "scene" : name.replaceAll(":", "-")}.json`,
    });
    link.click();
    URL.revokeObjectURL(link.href);
  };

  const load = async (): Promise<void> => {
    try {
      const scene = lesson
        ? await lessonScene(lesson, leaving.signal)
        : await api.scene(own ? STARTING_SCENE : name, leaving.signal);
      original = pretty(scene);
      const seen = await requestedView();
      const draft = draftKey ? ((own ? shownText(seen) : null) ?? recall(draftKey)) : null;
      if (own) {
        about.textContent =
          "It starts as a pendulum and is kept in this browser. What you write is checked as you type.";
      } else {
        title.textContent = scene.title ?? name;
        about.textContent = scene.description ?? "";
        setTitle(scene.title ?? name);
      }
      shownAs = draft ?? original;
      editor.set(shownAs);
      restore.hidden = draft === null || draft === original;
      if (draftKey) runText(seen);
      else open({ source: { builtin: name }, scene, seen });
    } catch (error) {
      if (leaving.signal.aborted) return;
      const missing = error instanceof ApiError && error.gone;
      side.replaceChildren(
        h("h1", null, missing ? "There is no such scene" : "The scene could not be loaded"),
        problemNotice(error, missing ? [] : [{ label: "Try again", run: () => void load() }]),
        h("p", null, h("a", { href: "/scenes" }, "All scenes")),
      );
      bench.hidden = missing;
    }
  };
  void load();

  return {
    title: own ? "Your own scene" : name,
    dispose: () => {
      leaving.abort();
      editor.dispose();
      endRun?.();
    },
  };
}

async function lessonScene(slug: string, signal: AbortSignal): Promise<Scene> {
  return (await api.lesson(slug, student.get(), signal)).scene;
}

/** The scene of a link, written as a person would. What stands in this browser's own draft stays there until it is edited. */
function shownText(seen: SharedView | undefined): string | null {
  if (seen?.scene === undefined) return null;
  try {
    return pretty(JSON.parse(seen.scene));
  } catch {
    return seen.scene;
  }
}
