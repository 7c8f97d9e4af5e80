// The list of lessons, written like the contents page of a book, with how far one has come.
import { api } from "../api/client";
import type { GradedSubmission, LessonSummary } from "../api/types";
import { h } from "../core/dom";
import { plural, points } from "../core/format";
import { student } from "../core/prefs";
import type { Page } from "../core/router";
import { heroDrawing } from "../ui/hero";
import { icon } from "../ui/icons";
import { empty, problemNotice, skeleton } from "../ui/notice";
import { lastBookmark } from "./reading-position";

interface Best {
  earned: number;
  possible: number;
  passed: boolean;
  attempts: number;
}

/** Submissions that are asked for to show the progress: more than a student hands in. */
const MAX_SUBMISSIONS = 200;

export function homePage(outlet: HTMLElement): Page {
  const leaving = new AbortController();
  const list = h("div", { class: "contents", "aria-busy": "true" }, skeleton(8));
  const progress = h("p", { class: "contents-progress" });
  outlet.append(
    h(
      "div",
      { class: "page home" },
      hero(),
      h(
        "section",
        { "aria-labelledby": "lessons-title" },
        h("div", { class: "section-head" }, h("h2", { id: "lessons-title" }, "Lessons"), progress),
        list,
      ),
      ownScene(),
    ),
  );

  const load = async (): Promise<void> => {
    let lessons: LessonSummary[];
    try {
      lessons = await api.lessons(leaving.signal);
    } catch (error) {
      if (leaving.signal.aborted) return;
      list.replaceChildren(problemNotice(error, [{ label: "Try again", run: () => void load() }]));
      return;
    }
    paint(list, progress, lessons, new Map());
    const who = student.get();
    if (!who) return;
    // Progress is a nicety: without it the list stays as it is.
    const verdicts = await api
      .submissions({ student: who, limit: MAX_SUBMISSIONS }, leaving.signal)
      .catch(() => []);
    if (!leaving.signal.aborted) paint(list, progress, lessons, bestOf(verdicts));
  };
  const renamed = (): void => void load();
  addEventListener("triad:student", renamed);
  void load();

  return {
    title: "Triad",
    dispose: () => {
      leaving.abort();
      removeEventListener("triad:student", renamed);
    },
  };
}

function hero(): HTMLElement {
  const place = lastBookmark();
  return h(
    "section",
    { class: "hero" },
    h(
      "div",
      { class: "hero-text" },
      h("h1", null, "Mechanisms in space, one constraint at a time"),
      h(
        "p",
        { class: "lead" },
        "Read a little, run a real mechanism, look at its Jacobian and its joint forces, then answer. ",
        "Bodies are described by points and unit vectors alone: no angles, a constant mass matrix, quadratic constraints.",
      ),
      place
        ? h(
            "p",
            { class: "go-on" },
            h("a", { class: "button primary", href: place.href }, `Go on with “${place.title}”`),
          )
        : null,
    ),
    heroDrawing(),
  );
}

function ownScene(): HTMLElement {
  return h(
    "section",
    { class: "aside-strip" },
    h(
      "div",
      null,
      h("h2", null, "Or build your own"),
      h(
        "p",
        null,
        "Run a built-in mechanism without a lesson, change it, or write a new one. ",
        "Triad counts its degrees of freedom and names its redundant rows as you type.",
      ),
    ),
    h("a", { class: "button", href: "/scenes" }, icon("cube"), "Open the scenes"),
  );
}

function paint(
  list: HTMLElement,
  progress: HTMLElement,
  lessons: LessonSummary[],
  best: Map<string, Best>,
): void {
  list.removeAttribute("aria-busy");
  if (lessons.length === 0) {
    list.replaceChildren(
      empty("No lessons yet", "This server was started without any lesson. Scenes can still be run."),
    );
    return;
  }
  const passed = lessons.filter((lesson) => best.get(lesson.slug)?.passed).length;
  progress.textContent = student.get()
    ? `${passed} of ${lessons.length} passed`
    : plural(lessons.length, "lesson");
  list.replaceChildren(
    h("ol", { class: "lesson-list" }, ...lessons.map((lesson) => row(lesson, best.get(lesson.slug)))),
  );
}

function bestOf(verdicts: GradedSubmission[]): Map<string, Best> {
  const best = new Map<string, Best>();
  for (const verdict of verdicts) {
    // What could not be judged earns nothing and is no attempt, but the lesson is begun.
    const before = best.get(verdict.lesson);
    best.set(verdict.lesson, {
      earned: Math.max(before?.earned ?? 0, verdict.gradable ? (verdict.earned ?? 0) : 0),
      possible: verdict.possible,
      passed: (before?.passed ?? false) || (verdict.passed ?? false),
      attempts: (before?.attempts ?? 0) + (verdict.gradable ? 1 : 0),
    });
  }
  return best;
}

function row(lesson: LessonSummary, best: Best | undefined): HTMLElement {
  return h(
    "li",
    { class: "lesson-row" },
    h("span", { class: "lesson-number", "aria-hidden": "true" }, String(lesson.number)),
    h(
      "div",
      { class: "lesson-what" },
      h("h3", null, h("a", { href: `/lessons/${encodeURIComponent(lesson.slug)}` }, lesson.title)),
      h("p", null, lesson.summary),
    ),
    h("div", { class: "lesson-meta" }, h("span", null, `${lesson.minutes} min`), standing(best)),
  );
}

function standing(best: Best | undefined): HTMLElement {
  if (!best) return h("span", { class: "standing" }, "Not started");
  const score = `${points(best.earned)} of ${points(best.possible)}`;
  if (best.passed) return h("span", { class: "standing is-right" }, icon("check"), `Passed, ${score}`);
  return h("span", { class: "standing is-open" }, icon("dash"), `${score} so far`);
}
