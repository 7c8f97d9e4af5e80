// One lesson: text, mechanism, exercise. The text comes first, everything else when it can be read.
import { ApiError, api } from "../api/client";
import type { Lesson, LessonSummary } from "../api/types";
import { authored, h } from "../core/dom";
import { hasMaths, loadMaths, setMaths } from "../core/maths";
import { student } from "../core/prefs";
import { type Page, setTitle } from "../core/router";
import { exerciseSection } from "../exercise/exercise";
import { requestedView } from "../session/requested-view";
import { problemNotice, skeleton } from "../ui/notice";
import { trackReadingPosition } from "./reading-position";
import { steps } from "./steps";

const MATHS_PATIENCE_MS = 350;

export function lessonPage(outlet: HTMLElement, params: string[]): Page {
  const slug = params[0] ?? "";
  const leaving = new AbortController();
  const undo: (() => void)[] = [];
  const text = h("article", { class: "reading", id: "text", "aria-busy": "true" }, skeleton(14));
  const bench = h(
    "section",
    { class: "bench", id: "mechanism", "aria-label": "Mechanism" },
    workbenchPlaceholder(),
  );
  const exercise = h("section", { class: "exercise", id: "exercise", "aria-label": "Exercise" });
  outlet.append(
    h("div", { class: "lesson" }, text, bench, exercise),
    h(
      "nav",
      { class: "jump", "aria-label": "Parts of this lesson" },
      h("a", { href: "#text" }, "Text"),
      h("a", { href: "#mechanism" }, "Mechanism"),
      h("a", { href: "#exercise" }, "Exercise"),
    ),
  );

  let shown: Lesson | undefined;

  const load = async (): Promise<void> => {
    try {
      const lesson = await api.lesson(slug, student.get(), leaving.signal);
      shown = lesson;
      setTitle(lesson.title);
      // A short wait for KaTeX saves a jump of the whole text; a long one would keep it from the reader.
      if (hasMaths(lesson.html))
        await Promise.race([loadMaths(), new Promise((done) => setTimeout(done, MATHS_PATIENCE_MS))]);
      if (leaving.signal.aborted) return;
      showText(text, lesson);
      exercise.replaceChildren();
      undo.push(exerciseSection(exercise, lesson));
      await setMaths(text);
      await setMaths(exercise);
      if (location.hash) document.getElementById(location.hash.slice(1))?.scrollIntoView();
      undo.push(trackReadingPosition(slug, lesson.title));
      await afterPaint();
      void showNeighbours(text, exercise, slug, leaving.signal);
      if (leaving.signal.aborted) return;
      await openBench(lesson);
    } catch (error) {
      if (leaving.signal.aborted) return;
      text.removeAttribute("aria-busy");
      const missing = error instanceof ApiError && error.gone;
      text.replaceChildren(
        h("h1", null, missing ? "There is no such lesson" : "The lesson could not be loaded"),
        problemNotice(error, missing ? [] : [{ label: "Try again", run: () => void load() }]),
        h("p", null, h("a", { href: "/" }, "All lessons")),
      );
      bench.hidden = missing;
    }
  };

  const openBench = async (lesson: Lesson): Promise<void> => {
    const [{ workbench }, seen] = await Promise.all([import("../workbench/workbench"), requestedView()]);
    if (leaving.signal.aborted) return;
    undo.push(
      workbench(bench, {
        source: lesson.seed ? { lesson: slug, seed: lesson.seed } : { lesson: slug },
        scene: lesson.scene,
        seen,
      }),
    );
  };

  // Another name, other numbers: text, mechanism and exercise are made anew.
  const renamed = (): void => {
    if (!shown?.has_variants || shown.seed === student.get()) return;
    for (const step of undo.splice(0)) step();
    bench.replaceChildren(workbenchPlaceholder());
    void load().then(() => exercise.scrollIntoView({ block: "start" }));
  };
  addEventListener("triad:student", renamed);

  void load();
  return {
    title: "Lesson",
    dispose: () => {
      leaving.abort();
      removeEventListener("triad:student", renamed);
      for (const step of undo) step();
    },
  };
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
    const named = lessons.find((lesson) => before.pathname === `/lessons/${lesson.slug}`);
    if (named) before.textContent = named.title;
  }
  const link = (which: string, lesson: LessonSummary | undefined): HTMLElement | null =>
    lesson
      ? h(
          "a",
          { href: `/lessons/${encodeURIComponent(lesson.slug)}` },
          h("span", null, which),
          h("b", null, lesson.title),
        )
      : null;
  place.append(
    h(
      "nav",
      { class: "neighbours", "aria-label": "Other lessons" },
      link("Lesson before", lessons[at - 1]),
      link("Next lesson", lessons[at + 1]),
    ),
  );
}

/** Keeps the room that the workbench will take, so that nothing jumps when it arrives. */
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
        h("a", { href: "/" }, "Lessons"),
        ` / ${lesson.number}, about ${lesson.minutes} minutes`,
      ),
      h("h1", null, lesson.title),
      lesson.prerequisites.length > 0
        ? h("p", { class: "before" }, "Read before: ", ...joined(lesson.prerequisites))
        : null,
      lesson.objectives.length > 0
        ? h(
            "div",
            { class: "objectives" },
            h("h2", null, "After this lesson you can"),
            h("ul", null, ...lesson.objectives.map((goal) => h("li", null, goal))),
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
