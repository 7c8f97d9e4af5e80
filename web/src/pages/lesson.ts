// One lesson: text, mechanism, exercise. The text comes first, the others when it can be read.

import { ApiError, api } from "../api/client";
import type { Lesson, LessonSummary } from "../api/types";
import { pathOf } from "../core/address";
import { AUTHORED, authored, h } from "../core/dom";
import { hasMaths, loadMaths, setMaths } from "../core/maths";
import { student } from "../core/prefs";
import { type Page, setTitle } from "../core/router";
import { t } from "../core/texts";
import { exerciseSection } from "../exercise/exercise";
import type { OwnRun } from "../exercise/field";
import { predictionCounts } from "../prediction/counts";
import { PredictionPanel } from "../prediction/panel";
import { requestedView } from "../session/requested-view";
import { Divider } from "../ui/divider";
import { problemNotice, skeleton } from "../ui/notice";
import { makePressable } from "./actions";
import { handoutHead, printButton } from "./handout";
import { trackReadingPosition } from "./reading-position";
import { steps } from "./steps";

/** Longest wait for the formulas before the text is shown, ms. */
const MATHS_PATIENCE_MS = 350;

export function lessonPage(outlet: HTMLElement, params: string[]): Page {
  const page = new LessonPage(params[0] ?? "");
  outlet.append(...page.parts());
  return { title: t("Lesson"), dispose: () => page.dispose() };
}

class LessonPage {
  private readonly text = h("article", { class: "reading", id: "text", "aria-busy": "true" }, skeleton(14));
  private readonly bench = h(
    "section",
    { class: "bench", id: "mechanism", "aria-label": t("Mechanism") },
    workbenchPlaceholder(),
  );
  private readonly exercise = h("section", {
    class: "exercise",
    id: "exercise",
    "aria-label": t("Exercise"),
  });
  private readonly leaving = new AbortController();
  private readonly undo: (() => void)[] = [];
  private shown: Lesson | undefined;
  private run: (() => OwnRun | undefined) | undefined;
  /** Another name, other numbers: text, mechanism and exercise are made anew. */
  private readonly renamed = (): void => {
    if (!this.shown?.has_variants || this.shown.seed === student.get()) return;
    const answering = this.exercise.contains(document.activeElement);
    for (const step of this.undo.splice(0)) step();
    this.bench.replaceChildren(workbenchPlaceholder());
    void this.load().then(() => {
      if (answering) this.exercise.scrollIntoView({ block: "start" });
    });
  };

  constructor(private readonly slug: string) {
    addEventListener("triad:student", this.renamed);
    void this.load();
  }

  parts(): HTMLElement[] {
    return [
      besideText(this.text, this.bench, this.exercise),
      jumpBar(t("Parts of this lesson"), {
        text: t("Text"),
        mechanism: t("Mechanism"),
        exercise: t("Exercise"),
      }),
    ];
  }

  dispose(): void {
    this.leaving.abort();
    removeEventListener("triad:student", this.renamed);
    for (const step of this.undo) step();
  }

  private async load(): Promise<void> {
    const { signal } = this.leaving;
    try {
      const lesson = await api.lesson(this.slug, student.get(), signal);
      this.shown = lesson;
      setTitle(lesson.title);
      // A short wait for KaTeX saves a jump of the whole text; a long one would keep it from the reader.
      if (hasMaths(lesson.html))
        await Promise.race([loadMaths(), new Promise((done) => setTimeout(done, MATHS_PATIENCE_MS))]);
      if (signal.aborted) return;
      await this.show(lesson);
      await afterPaint();
      void showNeighbours(this.text, this.exercise, this.slug, signal);
      if (!signal.aborted) await this.openBench(lesson);
    } catch (error) {
      if (!signal.aborted) this.fail(error);
    }
  }

  /** Shows text and exercise. */
  private async show(lesson: Lesson): Promise<void> {
    const head = handoutHead(lesson);
    this.undo.push(head.dispose);
    showText(this.text, lesson);
    this.text.prepend(head.root);
    this.exercise.replaceChildren();
    const counts = predictionCounts(lesson);
    if (counts) this.text.append(counts);
    this.undo.push(exerciseSection(this.exercise, lesson, () => this.run?.()));
    await setMaths(this.text);
    await setMaths(this.exercise);
    if (location.hash) document.getElementById(location.hash.slice(1))?.scrollIntoView();
    this.undo.push(trackReadingPosition(this.slug, lesson.title));
  }

  private async openBench(lesson: Lesson): Promise<void> {
    const [{ workbench }, seen] = await Promise.all([import("../workbench/workbench"), requestedView()]);
    if (this.leaving.signal.aborted) return;
    const source = lesson.seed ? { lesson: this.slug, seed: lesson.seed } : { lesson: this.slug };
    const asked = lesson.predictions.length > 0 ? new PredictionPanel(lesson) : undefined;
    if (asked) this.undo.push(() => asked.dispose());
    const bench = workbench(this.bench, { source, scene: lesson.scene, seen, asked });
    this.run = bench.run;
    this.undo.push(bench.dispose);
    for (const step of this.text.querySelectorAll<HTMLElement>("#steps li")) makePressable(step, bench.act);
  }

  private fail(error: unknown): void {
    this.text.removeAttribute("aria-busy");
    const missing = error instanceof ApiError && error.gone;
    this.text.replaceChildren(
      h("h1", null, missing ? t("There is no such lesson") : t("The lesson could not be loaded")),
      problemNotice(error, missing ? [] : [{ label: t("Try again"), run: () => void this.load() }]),
      h("p", null, h("a", { href: "/" }, t("All lessons"))),
    );
    this.bench.hidden = missing;
  }
}

/** Where to go on: the lessons before and after this one. What to read before gets its title. */
async function showNeighbours(
  text: HTMLElement,
  place: HTMLElement,
  slug: string,
  signal: AbortSignal,
): Promise<void> {
  const lessons = await api.lessons(signal).catch(() => []);
  const at = lessons.findIndex((lesson) => lesson.slug === slug);
  if (signal.aborted || at < 0) return;
  for (const before of text.querySelectorAll<HTMLAnchorElement>(".before a")) {
    const named = lessons.find((lesson) => pathOf(before) === `/lessons/${lesson.slug}`);
    if (named) before.textContent = named.title;
  }
  const link = (which: string, lesson: LessonSummary | undefined): HTMLElement | null =>
    lesson
      ? h(
          "a",
          { href: `/lessons/${encodeURIComponent(lesson.slug)}` },
          h("span", null, which),
          h("b", { lang: AUTHORED }, lesson.title),
        )
      : null;
  // A lesson that was made anew for another name may have been told them meanwhile.
  place.querySelector(":scope > .neighbours")?.remove();
  place.append(
    h(
      "nav",
      { class: "neighbours", "aria-label": t("Other lessons") },
      link(t("Lesson before"), lessons[at - 1]),
      link(t("Next lesson"), lessons[at + 1]),
    ),
  );
}

/** On narrow screens: links to the parts of a page, by their ids. */
export function jumpBar(label: string, parts: Record<string, string>): HTMLElement {
  return h(
    "nav",
    { class: "jump", "aria-label": label },
    ...Object.entries(parts).map(([id, name]) => h("a", { href: `#${id}` }, name)),
  );
}

/** Text and mechanism beside each other, with a line between them that is dragged. */
export function besideText(text: HTMLElement, bench: HTMLElement, ...more: HTMLElement[]): HTMLElement {
  const root = h("div", { class: "lesson" }, text);
  const divider = new Divider({
    label: t("Width of the text"),
    divided: () => "text",
    first: text,
    whole: () => {
      const { left, width } = root.getBoundingClientRect();
      return { start: left, size: width };
    },
  });
  root.append(divider.root, bench, ...more);
  return root;
}

/** Keeps the place that the workbench will take, so that nothing jumps when it arrives. */
export function workbenchPlaceholder(): HTMLElement {
  return h(
    "div",
    { class: "bench-wait", "aria-hidden": "true" },
    h("div", { class: "stage" }),
    h("div", { class: "transport" }),
  );
}

const afterPaint = (): Promise<void> =>
  new Promise((done) => {
    // A hidden tab paints no frame: the timer stands in.
    const timer = setTimeout(done, 250);
    requestAnimationFrame(() =>
      requestAnimationFrame(() => {
        clearTimeout(timer);
        done();
      }),
    );
  });

function showText(place: HTMLElement, lesson: Lesson): void {
  place.removeAttribute("aria-busy");
  const prose = authored(h("div", { class: "prose" }), lesson.html);
  // The page shows the title itself; a text that opens with the same heading would say it twice.
  const first = prose.firstElementChild;
  if (first?.tagName === "H1") first.remove();
  place.replaceChildren(
    h(
      "header",
      { class: "lesson-head" },
      h(
        "p",
        { class: "lesson-kicker" },
        h("a", { href: "/" }, t("Lessons")),
        ` / ${t("{number}, about {minutes} minutes", { number: lesson.number, minutes: lesson.minutes })}`,
        printButton(),
      ),
      h("h1", { lang: AUTHORED }, lesson.title),
      lesson.prerequisites.length > 0
        ? h("p", { class: "before" }, t("Read before:"), " ", ...joined(lesson.prerequisites))
        : null,
      lesson.objectives.length > 0
        ? h(
            "div",
            { class: "objectives" },
            h("h2", null, t("After this lesson you can")),
            h("ul", { lang: AUTHORED }, ...lesson.objectives.map((goal) => h("li", null, goal))),
          )
        : null,
    ),
    prose,
    ...steps(lesson),
  );
}

function joined(slugs: string[]): (HTMLElement | string)[] {
  return slugs.flatMap((slug, at) => [
    ...(at > 0 ? ["; "] : []),
    /^[a-z0-9-]+$/.test(slug) ? h("a", { href: `/lessons/${slug}` }, slug.replaceAll("-", " ")) : slug,
  ]);
}
