// The class while it works: who is where, who is stuck, what was just handed in. It is asked for while somebody looks.

import { api } from "../api/client";
import type { Glance } from "../api/types";
import { h } from "../core/dom";
import { dateTime, points } from "../core/format";
import type { Page } from "../core/router";
import { locale, parts, t } from "../core/texts";
import { problemNotice, skeleton } from "../ui/notice";
import { mistakeName, questionHref } from "./figures";

/** Milliseconds between two looks. */
const PAUSE = 10_000;

export function glancePage(outlet: HTMLElement): Page {
  const place = h("div", null, skeleton(6));
  const said = h("p", { class: "help", role: "status" });
  outlet.append(
    h(
      "div",
      { class: "page wide" },
      h("p", null, h("a", { href: "/class" }, t("← Class"))),
      h("header", { class: "page-head" }, h("h1", null, t("The class at a glance"))),
      said,
      place,
    ),
  );
  let timer = 0;
  let shown = "";
  const look = async (): Promise<void> => {
    clearTimeout(timer);
    // Nobody looks at a page in the background.
    if (document.hidden) return;
    try {
      const glance = await api.glance();
      const { at, ...rest } = glance;
      said.textContent = t("As of {time}, and again every {pause} seconds while you look.", {
        time: new Date(at).toLocaleTimeString(locale()),
        pause: PAUSE / 1000,
      });
      const now = JSON.stringify(rest);
      if (now !== shown) repaint(place, glance);
      shown = now;
    } catch (error) {
      shown = "";
      place.replaceChildren(problemNotice(error, [{ label: t("Try again"), run: () => void look() }]));
    }
    if (place.isConnected) timer = window.setTimeout(() => void look(), PAUSE);
  };
  const again = (): void => void look();
  document.addEventListener("visibilitychange", again);
  void look();
  return {
    title: t("At a glance"),
    dispose: () => {
      clearTimeout(timer);
      document.removeEventListener("visibilitychange", again);
    },
  };
}

/** Paints anew; who stands on a link stays there. */
function repaint(place: HTMLElement, glance: Glance): void {
  const focused = place.contains(document.activeElement)
    ? document.activeElement?.getAttribute("href")
    : null;
  place.replaceChildren(stuck(glance), where(glance), handed(glance));
  if (focused) place.querySelector<HTMLElement>(`a[href="${CSS.escape(focused)}"]`)?.focus();
}

const person = (id: string, name: string): HTMLElement =>
  h("a", { href: `/class/${encodeURIComponent(id)}` }, name);

function section(title: string, none: string, count: number, ...children: HTMLElement[]): HTMLElement {
  return h(
    "section",
    { class: "student-lesson" },
    h("h2", null, title),
    ...(count > 0 ? children : [h("p", { class: "help" }, none)]),
  );
}

function stuck({ stuck }: Glance): HTMLElement {
  const items = stuck.map((one) =>
    h(
      "li",
      null,
      ...parts("{name} {n} try at {question} | {name} {n} tries at {question}", {
        n: one.tries,
        name: h("strong", null, person(one.person, one.name)),
        question: h("a", { href: questionHref(one.lesson, one.question) }, `${one.title}: ${one.question}`),
      }),
      one.mistake ? `, ${t("last: {mistake}", { mistake: mistakeName(one.mistake) })}` : "",
      `, ${ago(one.at)}`,
    ),
  );
  return section(
    t("Stuck"),
    t("Nobody has tried a question three times within the last twenty minutes without getting it."),
    items.length,
    h("ul", { class: "cards" }, ...items),
  );
}

function where({ lessons, here, students }: Glance): HTMLElement {
  const rows = lessons.map((lesson) =>
    h(
      "li",
      null,
      h(
        "p",
        { class: "row between" },
        h(
          "a",
          { href: `/class/lessons/${encodeURIComponent(lesson.slug)}` },
          `${lesson.number} ${lesson.title}`,
        ),
        h("span", { class: "count" }, String(lesson.people.length)),
      ),
      h(
        "ul",
        { class: "names" },
        ...lesson.people.map((one) =>
          h(
            "li",
            null,
            person(one.person, one.name),
            one.stuck ? h("span", { class: "flag" }, t("stuck")) : null,
          ),
        ),
      ),
    ),
  );
  return section(
    t("Here: {here} of {students}", { here, students: t("{n} student | {n} students", { n: students }) }),
    t("Nobody has read or tried anything within the last five minutes."),
    rows.length,
    h("ul", { class: "cards" }, ...rows),
  );
}

function handed({ handed, handed_in_all }: Glance): HTMLElement {
  const rows = handed.map((one) =>
    h(
      "tr",
      null,
      h("td", null, h("time", { datetime: one.at, title: dateTime(one.at) }, ago(one.at))),
      h("th", { scope: "row" }, person(one.person, one.name)),
      h("td", null, one.title),
      h(
        "td",
        { class: "number" },
        one.gradable
          ? t("{earned} of {possible}", { earned: points(one.earned), possible: points(one.possible) })
          : t("sent back"),
      ),
    ),
  );
  const head = [t("When"), t("Student"), t("Lesson")];
  return section(
    t("Handed in within twenty minutes: {handed_in_all}", { handed_in_all }),
    t("Nothing."),
    rows.length,
    h(
      "div",
      { class: "table-scroll", tabindex: "0", role: "region", "aria-label": t("Just handed in") },
      h(
        "table",
        { class: "data" },
        h(
          "thead",
          null,
          h(
            "tr",
            null,
            ...head.map((text) => h("th", { scope: "col" }, text)),
            h("th", { scope: "col", class: "number" }, t("Points")),
          ),
        ),
        h("tbody", null, ...rows),
      ),
    ),
  );
}

/** How long ago, in whole minutes. */
function ago(moment: string): string {
  const minutes = Math.floor((Date.now() - Date.parse(moment)) / 60_000);
  return minutes < 1 ? t("just now") : t("{minutes} min ago", { minutes });
}
