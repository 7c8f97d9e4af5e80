// One scene: its text on one side, its run on the other.

import { ApiError, api } from "../api/client";
import type { Scene } from "../api/types";
import { addressOf, pathOf } from "../core/address";
import { AUTHORED, h, saveFile } from "../core/dom";
import { student } from "../core/prefs";
import { type Page, setTitle } from "../core/router";
import { parts, t } from "../core/texts";
import { SceneDraft } from "../editor/draft";
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
  /** Shows in turn the texts that others took the place of: another beginning, an undone text, that of another tab. */
  private readonly goBack = h(
    "button",
    { type: "button", class: "button quiet", hidden: true, onclick: () => this.back() },
    t("Back to the text before"),
  );
  /** A built-in scene is nobody's text: where one's own of it goes. */
  private readonly elsewhere = h(
    "p",
    { class: "help", hidden: true },
    ...parts(
      "A built-in scene stays as it is. When you leave, your text waits at {own}, as the text before.",
      {
        own: h("a", { href: `/scenes/${OWN_SCENE}` }, t("Your own scene")),
      },
    ),
  );
  private readonly othersSaid = h("span");
  /** What another tab of this browser has written of the same text. */
  private readonly others = h(
    "p",
    { class: "row wrap tight", role: "status", hidden: true },
    this.othersSaid,
    h(
      "button",
      { type: "button", class: "button small", onclick: () => this.showTheirs() },
      t("Show its text"),
    ),
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
  private readonly draft: SceneDraft | null;
  private endRun: (() => void) | undefined;
  private readonly refuse: () => void;
  /** Hears no more of other tabs. */
  private readonly deaf: (() => void) | undefined;
  /** Takes a scene from elsewhere: into one's own, where the text before can be had back. */
  private readonly take = (text: string): void => {
    if (this.subject.own) this.begin(text);
    else openOwn(text);
  };
  /** The text as it was loaded. */
  private original = "";
  /** The text is that of a link: the browser's own stays until this one is edited, and is put aside then. */
  private linked = false;
  /** The text that runs. */
  private shownText = "";

  constructor(private readonly subject: Subject) {
    const { name, own, lesson } = subject;
    this.draft = lesson ? new SceneDraft({ lesson }) : own ? new SceneDraft("own") : null;
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
    this.deaf = this.draft?.onTheirs(() => this.hearTheirs());
    addEventListener("pagehide", () => this.leave(), { signal: this.leaving.signal });
    void this.load();
  }

  dispose(): void {
    this.leaving.abort();
    this.leave();
    this.refuse();
    this.deaf?.();
    this.editor.dispose();
    this.endRun?.();
  }

  /** What was made of a built-in scene is not lost. */
  private leave(): void {
    if (!this.draft && this.changed) new SceneDraft("own").putAside(this.editor.text());
  }

  /** Something is written that was not loaded. */
  private get changed(): boolean {
    return this.original !== "" && this.editor.text() !== this.original;
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
        this.goBack,
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
      this.others,
      this.elsewhere,
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
    );
  }

  /** Puts a text in the place of the one that is there, which can be had back. */
  private begin(text: string): void {
    const before = this.editor.text();
    if (text !== before) this.draft?.putAside(before);
    this.put(text);
  }

  private back(): void {
    const text = this.draft?.back(this.editor.text());
    if (text !== undefined) this.put(text);
  }

  private put(text: string): void {
    this.editor.set(text);
    this.edited(text);
    this.runText();
  }

  /** Another tab writes the same text: what this one shows stays until its reader wants the other. */
  private hearTheirs(): void {
    if (this.draft?.theirs() !== this.editor.text())
      this.tellTheirs(t("Another tab of this browser has changed this text."));
  }

  private tellTheirs(said: string): void {
    this.othersSaid.textContent = said;
    this.others.hidden = false;
  }

  private showTheirs(): void {
    const theirs = this.draft?.theirs();
    this.others.hidden = true;
    if (theirs === undefined) this.back();
    else {
      // From now on this tab knows it: it takes the place of nothing.
      this.draft?.read();
      this.begin(theirs);
    }
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
      const linked = own ? sceneText(seen) : null;
      this.linked = linked !== null;
      const text = linked ?? this.draft?.read() ?? this.original;
      this.describe(scene);
      this.shownText = text;
      this.editor.set(text);
      this.offer();
      if (this.draft) this.runText(seen);
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
    this.status.textContent = text === this.original ? "" : t("Changed, not run yet.");
    this.keep(text);
  }

  private undoEdits(): void {
    this.draft?.putAside(this.editor.text());
    this.editor.set(this.original);
    this.status.textContent = "";
    this.keep(null);
  }

  private keep(text: string | null): void {
    this.others.hidden = true;
    const linked = this.linked;
    this.linked = false;
    // The page shows a draft from now on, when it is loaded anew, too.
    if (linked) history.replaceState(null, "", addressOf(pathOf(location)));
    if (this.draft?.keep(text) && !linked)
      this.tellTheirs(t("Another tab of this browser had changed this text: what it wrote is kept."));
    this.offer();
  }

  /** Offers what there is to go back to. */
  private offer(): void {
    this.restore.hidden = !this.changed;
    this.elsewhere.hidden = this.draft !== null || !this.changed;
    this.goBack.hidden = !this.draft?.aside().some((text) => text !== this.editor.text());
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

/** The scene of a link, written as a person would. */
function sceneText(seen: SharedView | undefined): string | null {
  if (seen?.scene === undefined) return null;
  try {
    return pretty(JSON.parse(seen.scene));
  } catch {
    return seen.scene;
  }
}
