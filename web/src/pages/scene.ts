// One scene: its text on one side, its run on the other.

import { ApiError, api } from "../api/client";
import type { Scene } from "../api/types";
import { AUTHORED, h, saveFile } from "../core/dom";
import { recall, remember, student } from "../core/prefs";
import { type Page, setTitle } from "../core/router";
import { t } from "../core/texts";
import { SceneEditor } from "../editor/editor";
import { importDialog } from "../editor/import";
import { takeIncoming } from "../editor/incoming";
import { pretty } from "../editor/pointer";
import { ONE_BODY, TWO_BODIES } from "../editor/starters";
import { requestedView } from "../session/requested-view";
import type { SharedView } from "../session/shared-view";
import { icon } from "../ui/icons";
import { problemNotice } from "../ui/notice";
import { type WorkbenchOptions, workbench } from "../workbench/workbench";
import { besideText, jumpBar, workbenchPlaceholder } from "./lesson";
import { OWN_SCENE, openOwn } from "./scenes";

/** A scene of one's own begins as this built-in one. */
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
  return open(outlet, { name, own: name === OWN_SCENE });
}

/** The scene of a lesson as text, with the student's own numbers in it. */
export function lessonScenePage(outlet: HTMLElement, params: string[]): Page {
  const lesson = params[0] ?? "";
  return open(outlet, { name: lesson, own: false, lesson });
}

function open(outlet: HTMLElement, subject: Subject): Page {
  const page = new ScenePage(subject);
  const bar = jumpBar(t("Parts of this page"), { text: t("Text"), mechanism: t("Mechanism") });
  outlet.append(page.root, bar);
  return { title: subject.own ? t("Your own scene") : subject.name, dispose: () => page.dispose() };
}

class ScenePage {
  readonly root: HTMLElement;
  private readonly title: HTMLElement;
  private readonly about = h("p", { class: "lead" });
  private readonly restore = h(
    "button",
    { type: "button", class: "button", hidden: true, onclick: () => this.undoEdits() },
    t("Undo all changes"),
  );
  /** The text that was there before another beginning was chosen. */
  private before: string | undefined;
  private readonly goBack = h(
    "button",
    { type: "button", class: "button quiet small", hidden: true, onclick: () => this.begin(this.before) },
    t("Back to the text before"),
  );
  private readonly preview = h("input", { type: "checkbox", id: "preview", checked: true });
  private readonly status = h("p", { class: "help", role: "status" });
  private readonly editor: SceneEditor;
  private readonly side: HTMLElement;
  private readonly bench = h(
    "section",
    { class: "bench", id: "mechanism", "aria-label": t("Mechanism") },
    workbenchPlaceholder(),
  );
  private readonly leaving = new AbortController();
  /** Where the browser keeps what was edited; a built-in scene is not kept. */
  private readonly draftKey: "scene-draft" | `scene-draft:${string}` | null;
  private endRun: (() => void) | undefined;
  private readonly refuse: () => void;
  /** Takes a scene from elsewhere: into one's own, where the text before can be had back. */
  private readonly take = (text: string): void => {
    if (this.subject.own) this.begin(text);
    else openOwn(text);
  };
  /** The text as it was loaded. */
  private original = "";
  /** The text that runs. */
  private shownText = "";

  constructor(private readonly subject: Subject) {
    const { name, own, lesson } = subject;
    this.draftKey = lesson ? `scene-draft:${lesson}` : own ? "scene-draft" : null;
    this.title = h("h1", null, own ? t("Your own scene") : name);
    this.editor = new SceneEditor(
      (text) => this.edited(text),
      (text) => {
        // What can run is shown at once, at its start; what is already shown stays.
        if (this.preview.checked && text !== this.shownText) this.runText();
        else if (text === this.shownText) this.status.textContent = "";
      },
      (line) => {
        this.status.textContent = t("Line {line}: see the remark below the text.", { line });
      },
      (urdf) => importDialog({ name: t("The text"), urdf }, this.take),
    );
    this.refuse = takeIncoming({ undoable: own, open: this.take });
    this.side = this.layout();
    this.root = besideText(this.side, this.bench);
    this.root.classList.add("is-scene");
    void this.load();
  }

  dispose(): void {
    this.leaving.abort();
    this.refuse();
    this.editor.dispose();
    this.endRun?.();
  }

  private layout(): HTMLElement {
    const { lesson } = this.subject;
    const back = lesson
      ? h("a", { href: `/lessons/${encodeURIComponent(lesson)}` }, t("Back to the lesson"))
      : h("a", { href: "/scenes" }, t("Scenes"));
    return h(
      "article",
      { class: "reading is-editor", id: "text" },
      h("header", { class: "lesson-head" }, h("p", { class: "lesson-kicker" }, back), this.title, this.about),
      h(
        "div",
        { class: "row wrap" },
        h(
          "button",
          { type: "button", class: "button primary", onclick: () => this.runText() },
          icon("play"),
          t("Run this text"),
        ),
        this.restore,
        h(
          "button",
          { type: "button", class: "button quiet", onclick: () => this.download() },
          icon("save"),
          t("Save the file"),
        ),
        h(
          "span",
          { class: "check-line" },
          this.preview,
          h("label", { for: "preview" }, t("Show it as I type")),
        ),
        this.status,
      ),
      this.subject.own ? this.beginnings() : null,
      this.editor.root,
    );
  }

  /** With what a scene of one's own may begin. */
  private beginnings(): HTMLElement {
    const press = (label: string, text: () => string): HTMLElement =>
      h("button", { type: "button", class: "button small", onclick: () => this.begin(text()) }, label);
    return h(
      "div",
      { class: "row wrap tight", role: "group", "aria-label": t("Begin anew with") },
      h("span", null, t("Begin anew with")),
      press(t("one body"), () => pretty(ONE_BODY)),
      press(t("two bodies and their joints"), () => pretty(TWO_BODIES)),
      press(t("a pendulum"), () => this.original),
      this.goBack,
    );
  }

  /** Puts a text in the place of the one that is there, which can be had back. */
  private begin(text: string | undefined): void {
    if (text === undefined) return;
    const [before, back] = [this.editor.text(), text === this.before];
    this.before = back ? undefined : before;
    this.goBack.hidden = back;
    this.editor.set(text);
    this.edited(text);
    this.runText();
  }

  private async load(): Promise<void> {
    const { name, own, lesson } = this.subject;
    const { signal } = this.leaving;
    try {
      const scene = lesson
        ? await lessonScene(lesson, signal)
        : await api.scene(own ? STARTING_SCENE : name, signal);
      this.original = pretty(scene);
      const seen = await requestedView();
      const draft = this.draftKey ? ((own ? sceneText(seen) : null) ?? recall(this.draftKey)) : null;
      this.describe(scene);
      this.shownText = draft ?? this.original;
      this.editor.set(this.shownText);
      this.restore.hidden = draft === null || draft === this.original;
      if (this.draftKey) this.runText(seen);
      else this.run({ source: { builtin: name }, scene, seen });
    } catch (error) {
      if (!signal.aborted) this.fail(error);
    }
  }

  private describe(scene: Scene): void {
    if (this.subject.own) {
      this.about.textContent = t(
        "It starts as a pendulum and is kept in this browser. What you write is checked as you type.",
      );
      return;
    }
    const title = scene.title ?? this.subject.name;
    this.title.textContent = title;
    this.about.textContent = scene.description ?? "";
    this.about.lang = AUTHORED;
    setTitle(title);
  }

  private fail(error: unknown): void {
    const missing = error instanceof ApiError && error.gone;
    this.side.replaceChildren(
      h("h1", null, missing ? t("There is no such scene") : t("The scene could not be loaded")),
      problemNotice(error, missing ? [] : [{ label: t("Try again"), run: () => void this.load() }]),
      h("p", null, h("a", { href: "/scenes" }, t("All scenes"))),
    );
    this.bench.hidden = missing;
  }

  private edited(text: string): void {
    this.restore.hidden = text === this.original;
    this.status.textContent = text === this.original ? "" : t("Changed, not run yet.");
    if (this.draftKey) remember(this.draftKey, text);
  }

  private undoEdits(): void {
    this.editor.set(this.original);
    this.restore.hidden = true;
    this.status.textContent = "";
    if (this.draftKey) remember(this.draftKey, null);
  }

  private run(options: WorkbenchOptions): void {
    this.endRun?.();
    this.endRun = workbench(this.bench, options).dispose;
  }

  private runText(seen?: SharedView): void {
    try {
      const scene = JSON.parse(this.editor.text()) as Scene;
      this.shownText = this.editor.text();
      this.status.textContent = "";
      const own = { path: `/scenes/${OWN_SCENE}`, text: JSON.stringify(scene) };
      this.run({ source: { scene }, scene, seen, own });
    } catch {
      this.status.textContent = t("The text is not JSON yet: see the remark below it.");
    }
  }

  private download(): void {
    const name = this.subject.own ? "scene" : this.subject.name.replaceAll(":", "-");
    saveFile(new Blob([this.editor.text()], { type: "application/json" }), `${name}.json`);
  }
}

async function lessonScene(slug: string, signal: AbortSignal): Promise<Scene> {
  return (await api.lesson(slug, student.get(), signal)).scene;
}

/** The scene of a link, written as a person would. The browser's own draft stays until this text is edited. */
function sceneText(seen: SharedView | undefined): string | null {
  if (seen?.scene === undefined) return null;
  try {
    return pretty(JSON.parse(seen.scene));
  } catch {
    return seen.scene;
  }
}
