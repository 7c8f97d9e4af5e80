// The learning platform of the class, for those who teach it: what is linked, and which scores it has.

import { api } from "../api/client";
import { me } from "../api/identity";
import type { PlatformList, PlatformView } from "../api/types";
import { h } from "../core/dom";
import { dateTime } from "../core/format";
import { t } from "../core/texts";
import { note, problemNotice } from "../ui/notice";

/** Shows the platforms in `root`; nothing where none is registered. */
export async function showPlatforms(root: HTMLElement): Promise<void> {
  if (!["instructor", "owner"].includes(me().person?.role ?? "")) return;
  try {
    paint(root, await api.platforms());
  } catch (error) {
    root.replaceChildren(problemNotice(error));
  }
}

function paint(root: HTMLElement, list: PlatformList): void {
  if (list.platforms.length === 0) {
    root.replaceChildren();
    return;
  }
  const said = h("div", { role: "status" });
  const press = (label: string, run: () => Promise<string>): HTMLButtonElement => {
    const button = h("button", { type: "button", class: "button small" }, label);
    button.addEventListener("click", () => {
      button.disabled = true;
      run()
        .then((text) => said.replaceChildren(note(h("p", null, text))))
        .catch((error: unknown) => said.replaceChildren(problemNotice(error)))
        .finally(() => (button.disabled = false));
    });
    return button;
  };
  const body = h("div", { class: "stack" }, ...list.platforms.map(platform));
  const roster = press(t("Take over the roster"), async () => {
    const taken = await api.takeRoster();
    return t("{people} listed, {new} of them new. Open this page again to see them.", {
      people: t("{n} person | {n} people", { n: taken.listed }),
      new: taken.new,
    });
  });
  const send = press(t("Send scores now"), async () => {
    const after = await api.sendScores();
    body.replaceChildren(...after.platforms.map(platform));
    return t("Done: the table says what the platform has.");
  });
  const offers = list.platforms.some((one) => one.courses.some((course) => course.roster));
  root.replaceChildren(
    h(
      "div",
      { class: "section-head" },
      h("h2", null, t("Learning platform")),
      h("div", { class: "row wrap" }, offers ? roster : "", send),
    ),
    list.reached
      ? ""
      : note(
          t(
            "The server was started without --url https://…: nobody comes from there, and no scores are sent.",
          ),
        ),
    body,
    said,
  );
}

function platform(view: PlatformView): HTMLElement {
  const courses = view.courses.map((course) => course.title).join(", ");
  return h(
    "div",
    { class: "stack" },
    h(
      "p",
      null,
      h("strong", null, view.issuer),
      ": ",
      courses === ""
        ? t("nobody who teaches has opened a lesson from there yet. The first who does links their course.")
        : t("people of {courses} come in from their course.", { courses }),
    ),
    view.problem === ""
      ? ""
      : note(
          view.paused_until
            ? t("{problem}. It is asked again at {paused_until}; nothing is lost.", {
                problem: view.problem,
                paused_until: dateTime(view.paused_until),
              })
            : t("Last problem: {problem}.", { problem: view.problem }),
        ),
    view.columns.length === 0 ? "" : columns(view),
  );
}

function columns(view: PlatformView): HTMLElement {
  const rows = view.columns.map((column) =>
    h(
      "tr",
      null,
      h("th", { scope: "row" }, column.lesson),
      h("td", { class: "number" }, String(column.scores)),
      h("td", { class: "number" }, String(column.sent)),
      h("td", { class: "number" }, String(column.scores - column.sent)),
      h("td", null, column.last ? dateTime(column.last) : ""),
      h(
        "td",
        null,
        column.problem,
        column.given_up > 0
          ? ` ${t("{given_up} wait for “Send scores now”.", { given_up: column.given_up })}`
          : "",
        column.ready ? "" : ` ${t("The platform is being asked for a column.")}`,
      ),
    ),
  );
  const head = [t("Scores"), t("Sent"), t("Waiting")].map((text) =>
    h("th", { scope: "col", class: "number" }, text),
  );
  return h(
    "div",
    { class: "table-scroll", tabindex: "0", role: "region", "aria-label": t("Scores that the platform has") },
    h(
      "table",
      { class: "data" },
      h("caption", null, t("Scores in the platform's grade book. What is held back is not sent.")),
      h(
        "thead",
        null,
        h(
          "tr",
          null,
          h("th", { scope: "col" }, t("Lesson")),
          ...head,
          h("th", { scope: "col" }, t("Last sent")),
          h("th", { scope: "col" }, t("Problem")),
        ),
      ),
      h("tbody", null, ...rows),
    ),
  );
}
