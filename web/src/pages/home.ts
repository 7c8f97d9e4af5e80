// The list of lessons in their parts, with how far one has come, under a mechanism that moves.

import { api } from "../api/client";
import type { LessonSummary } from "../api/types";
import { addressOf } from "../core/address";
import { AUTHORED, h } from "../core/dom";
import { student } from "../core/prefs";
import type { Page } from "../core/router";
import { t } from "../core/texts";
import type { HomePictures } from "../gallery/home-pictures";
import { begun, type Standing, standingLabel, standings } from "../gallery/standing";
import { icon } from "../ui/icons";
import { empty, problemNotice, skeleton } from "../ui/notice";
import { lastBookmark } from "./reading-position";

/** Submissions that are asked for to show the progress: more than a student hands in. */
const MAX_SUBMISSIONS = 200;

export function homePage(outlet: HTMLElement): Page {
  const page = new HomePage();
  outlet.append(page.root);
  return { title: "Triad", dispose: () => page.dispose() };
}

class HomePage {
  readonly root: HTMLElement;
  private readonly list = h("div", { class: "contents", "aria-busy": "true" }, skeleton(8));
  private readonly progress = h("p", { class: "contents-progress" });
  /** Keeps the place of the mechanism, so that nothing jumps when it comes. */
  private readonly picture = h("div", { class: "hero-picture" });
  private readonly gallery = h("section", { class: "home-gallery", "aria-label": t("Mechanisms to watch") });
  private readonly start = h(
    "a",
    { class: "button primary large", href: "#lessons-title" },
    t("Start with the first lesson"),
  );
  private readonly leaving = new AbortController();
  private pictures: HomePictures | undefined;
  private readonly renamed = (): void => void this.load();

  constructor() {
    this.root = h(
      "div",
      { class: "page home" },
      this.hero(),
      h(
        "section",
        { "aria-labelledby": "lessons-title" },
        h(
          "div",
          { class: "section-head" },
          h("h2", { id: "lessons-title" }, t("Lessons")),
          h("div", { class: "row wrap" }, this.progress, h("a", { href: "/course" }, t("What needs what"))),
        ),
        this.list,
      ),
      this.gallery,
      ownScene(),
    );
    addEventListener("triad:student", this.renamed);
    void this.load();
    void this.draw();
  }

  dispose(): void {
    this.leaving.abort();
    this.pictures?.dispose();
    removeEventListener("triad:student", this.renamed);
  }

  private hero(): HTMLElement {
    const place = lastBookmark();
    if (place) {
      this.start.href = addressOf(place.href);
      this.start.textContent = t("Go on with “{title}”", { title: place.title });
    }
    return h(
      "section",
      { class: "hero" },
      h(
        "div",
        { class: "hero-text" },
        h("h1", null, t("Mechanisms in space, one constraint at a time")),
        h(
          "p",
          { class: "lead" },
          t("Read a little, run a real mechanism, look at its Jacobian and its joint forces, then answer."),
          " ",
          t(
            "Bodies are described by points and unit vectors alone: no angles, a constant mass matrix, quadratic constraints.",
          ),
        ),
        h(
          "p",
          { class: "go-on" },
          this.start,
          h("a", { class: "button large", href: "/scenes" }, t("Watch mechanisms")),
        ),
      ),
      this.picture,
    );
  }

  private async draw(): Promise<void> {
    const { signal } = this.leaving;
    const { homePictures } = await import("../gallery/home-pictures");
    if (signal.aborted) return;
    this.pictures = await homePictures(this.picture, this.list, this.gallery, signal);
    if (signal.aborted) this.pictures.dispose();
    else this.pictures.lessons();
  }

  private async load(): Promise<void> {
    const { signal } = this.leaving;
    let lessons: LessonSummary[];
    try {
      lessons = await api.lessons(signal);
    } catch (error) {
      if (signal.aborted) return;
      this.list.replaceChildren(
        problemNotice(error, [{ label: t("Try again"), run: () => void this.load() }]),
      );
      return;
    }
    this.paint(lessons, new Map());
    const who = student.get();
    if (!who) return;
    // Progress is a nicety: without it the list stays as it is.
    const verdicts = await api.submissions({ student: who, limit: MAX_SUBMISSIONS }, signal).catch(() => []);
    if (!signal.aborted) this.paint(lessons, standings(verdicts));
  }

  private paint(lessons: LessonSummary[], known: Map<string, Standing>): void {
    this.list.removeAttribute("aria-busy");
    const [first] = lessons;
    if (!first) {
      this.start.hidden = true;
      this.list.replaceChildren(
        empty(t("No lessons yet"), t("This server was started without any lesson. Scenes can still be run.")),
      );
      return;
    }
    if (!lastBookmark()) this.start.href = addressOf(hrefOf(first));
    const passed = lessons.filter((lesson) => known.get(lesson.slug)?.is === "passed").length;
    this.progress.textContent = student.get()
      ? t("{passed} of {lessons} passed", { passed, lessons: lessons.length })
      : t("{n} lesson | {n} lessons", { n: lessons.length });
    this.list.replaceChildren(...parts(lessons, known));
    this.pictures?.lessons();
  }
}

const hrefOf = (lesson: LessonSummary): string => `/lessons/${encodeURIComponent(lesson.slug)}`;

/** The lessons under the headings of their parts. */
function parts(lessons: LessonSummary[], known: Map<string, Standing>): HTMLElement[] {
  const found: { title: string | null | undefined; lessons: LessonSummary[] }[] = [];
  for (const lesson of lessons) {
    const last = found.at(-1);
    if (last && last.title === lesson.part) last.lessons.push(lesson);
    else found.push({ title: lesson.part, lessons: [lesson] });
  }
  return found.map(({ title, lessons: own }) => {
    const passed = own.filter((lesson) => known.get(lesson.slug)?.is === "passed").length;
    const rows = h(
      "ol",
      { class: "lesson-list" },
      ...own.map((lesson) => row(lesson, known.get(lesson.slug))),
    );
    if (!title) return rows;
    return h(
      "section",
      { class: "lesson-part" },
      h(
        "h3",
        { class: "group-title" },
        h("span", { lang: AUTHORED }, title),
        passed > 0
          ? h("span", { class: "group-count" }, t("{passed} of {own} passed", { passed, own: own.length }))
          : null,
      ),
      rows,
    );
  });
}

function row(lesson: LessonSummary, known: Standing | undefined): HTMLElement {
  const standing = known ?? { is: begun(lesson.slug) ? "begun" : "new" };
  return h(
    "li",
    { class: "lesson-row" },
    h("div", { class: "lesson-picture", "aria-hidden": "true", "data-picture": lesson.slug }),
    h(
      "div",
      { class: "lesson-what" },
      h(
        !lesson.part ? "h3" : "h4",
        null,
        h("span", { class: "lesson-number", "aria-hidden": "true" }, String(lesson.number)),
        h("a", { href: hrefOf(lesson), lang: AUTHORED }, lesson.title),
      ),
      h("p", { lang: AUTHORED }, lesson.summary),
    ),
    h(
      "div",
      { class: "lesson-meta" },
      h("span", null, t("{minutes} min", { minutes: lesson.minutes })),
      standingLabel(standing),
    ),
  );
}

function ownScene(): HTMLElement {
  return h(
    "section",
    { class: "aside-strip" },
    h(
      "div",
      null,
      h("h2", null, t("Or build your own")),
      h(
        "p",
        null,
        t("Run a built-in mechanism without a lesson, change it, or write a new one."),
        " ",
        t("Triad counts its degrees of freedom and names its redundant rows as you type."),
      ),
    ),
    h("a", { class: "button", href: "/scenes" }, icon("cube"), t("Open the scenes")),
  );
}
