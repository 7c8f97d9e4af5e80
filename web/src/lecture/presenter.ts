// A presenter's panel: opens a lecture for the run of this page, sends what is looked at, asks and reveals.

import { ApiError, api } from "../api/client";
import { inClass, teaches } from "../api/identity";
import type { Tally } from "../api/types";
import { addressOf, pathOf } from "../core/address";
import { announce, h, setText } from "../core/dom";
import { parts, t } from "../core/texts";
import type { Session } from "../session/session";
import type { SharedView } from "../session/shared-view";
import { dialog } from "../ui/dialog";
import { icon } from "../ui/icons";
import { problemNotice } from "../ui/notice";
import { type NewQuestion, questionDialog } from "./question-dialog";
import { showSaid } from "./said";
import { Slides } from "./slides";
import { histogram } from "./voter";

/** Time between two messages to the followers, ms. */
const SEND_MS = 150;
/** Time between two questions for the number of followers and answers, ms. */
const POLL_MS = 1000;
/** Where the tab keeps its lecture: it goes on after a reload and on the next lesson, but no other tab leads it. */
const STORED = "triad:room";

/** A lecture as its presenter knows it. */
interface OwnLecture {
  code: string;
  /** Who has it may show, ask and end. */
  key: string;
}

function store(lecture: OwnLecture | undefined): void {
  try {
    if (lecture) sessionStorage.setItem(STORED, JSON.stringify(lecture));
    else sessionStorage.removeItem(STORED);
  } catch {
    // Without storage the lecture ends with the page.
  }
}

function stored(): OwnLecture | undefined {
  try {
    const found = JSON.parse(sessionStorage.getItem(STORED) ?? "null") as OwnLecture | null;
    return found && typeof found.code === "string" && typeof found.key === "string" ? found : undefined;
  } catch {
    return undefined;
  }
}

export class PresenterPanel {
  /** Opens a lecture; it has its place among the controls. */
  readonly button = h(
    "button",
    {
      type: "button",
      class: "button quiet small icon-only",
      "aria-label": t("Lecture: let others follow this run"),
      title: t("Lecture: let others follow this run"),
      onclick: () => void this.open(),
    },
    icon("lecture"),
  );
  readonly root: HTMLElement;
  private readonly code = h("b", { class: "presenter-code" });
  private readonly followers = h(
    "span",
    { class: "presenter-count", role: "status" },
    t("nobody follows yet"),
  );
  private readonly result = h("div", { class: "presenter-result" });
  private readonly prepared = h("div");
  private readonly trouble = h("div", { "aria-live": "polite" });
  private readonly revealButton = action(t("Reveal"), "button primary", () => void this.reveal());
  private readonly withdrawButton = action(t("Take it away"), "button", () => void this.withdraw());
  private readonly undo: (() => void)[];

  private lecture = stored();
  private question: NewQuestion | undefined;
  /** The view that was sent last, as JSON. */
  private sentView = "";
  /** The session that the followers see. */
  private shownSession = "";
  private sendTimer = 0;
  private slides: Slides | undefined;

  /** `seen` is what the page shows now, as a link would carry it. */
  constructor(
    private readonly session: Session,
    private readonly seen: () => SharedView,
  ) {
    this.revealButton.hidden = true;
    this.withdrawButton.hidden = true;
    this.root = this.layout();
    const poll = window.setInterval(() => void this.poll(), POLL_MS);
    this.undo = [
      () => clearInterval(poll),
      ...(["shown", "view", "selected", "opened"] as const).map((event) =>
        session.on(event, () => this.send()),
      ),
    ];
    this.paint();
  }

  dispose(): void {
    clearTimeout(this.sendTimer);
    this.slides?.dispose();
    for (const step of this.undo) step();
  }

  private layout(): HTMLElement {
    const lesson = /^\/lessons\/([^/]+)$/.exec(pathOf(location))?.[1];
    return h(
      "section",
      { class: "presenter", "aria-label": t("Lecture"), hidden: true },
      h(
        "div",
        { class: "row wrap between" },
        h("p", { class: "row wrap" }, h("span", null, t("Lecture room")), " ", this.code, this.followers),
        h(
          "span",
          { class: "row wrap tight" },
          action(t("How to join"), "button", () => this.lecture && void invite(this.lecture)),
          action(t("Ask a question"), "button", () => this.ask()),
          lesson && inClass() && teaches()
            ? action(t("What the class said"), "button", () => showSaid(lesson))
            : null,
          this.revealButton,
          this.withdrawButton,
          action(t("End the lecture"), "button quiet", () => void this.end()),
        ),
      ),
      this.prepared,
      this.result,
      this.trouble,
    );
  }

  private paint(): void {
    this.root.hidden = !this.lecture;
    this.button.hidden = this.lecture !== undefined;
    setText(this.code, this.lecture?.code ?? "");
    if (this.lecture && !this.slides) {
      this.slides = new Slides(this.session, this.seen);
      this.prepared.replaceChildren(this.slides.root);
    } else if (!this.lecture) {
      this.slides?.dispose();
      this.slides = undefined;
      this.prepared.replaceChildren();
    }
  }

  private async open(): Promise<void> {
    const id = this.session.latest?.id;
    if (!id) return;
    try {
      const opened = await api.openLecture(id);
      this.lecture = { code: opened.code, key: opened.key };
      store(this.lecture);
      this.sentView = "";
      this.shownSession = id;
      this.paint();
      announce(t("The lecture room {code} is open.", { code: opened.code }));
      this.send();
      await invite(this.lecture);
    } catch (error) {
      this.root.hidden = false;
      this.trouble.replaceChildren(problemNotice(error));
    }
  }

  private end(): Promise<void> {
    return this.attempt(async ({ code, key }) => {
      await api.closeLecture(code, key);
      this.forget();
      announce(t("The lecture is over."));
    });
  }

  private forget(): void {
    this.lecture = undefined;
    store(undefined);
    this.paint();
  }

  /** Sends a request for the lecture that is open; a failure is shown in the panel. */
  private async attempt(run: (lecture: OwnLecture) => Promise<void>): Promise<void> {
    if (!this.lecture) return;
    try {
      await run(this.lecture);
      this.trouble.replaceChildren();
    } catch (error) {
      // A lecture that is over, or that another browser leads now, is no longer ours.
      if (error instanceof ApiError && (error.gone || error.problem.status === 403)) this.forget();
      this.trouble.replaceChildren(problemNotice(error));
    }
  }

  /** Sends what is looked at to the followers: at most a few times a second, the newest counts. */
  private send(): void {
    if (!this.lecture || this.sendTimer) return;
    this.sendTimer = window.setTimeout(() => {
      this.sendTimer = 0;
      const id = this.session.latest?.id;
      const view = { ...this.seen(), back: this.session.reviewing };
      // While time runs, followers have it from the run itself.
      if (!this.session.reviewing) delete view.time;
      const text = JSON.stringify(view);
      const same = id === this.shownSession;
      if (!id || (same && text === this.sentView)) return;
      void this.attempt(({ code, key }) => api.show(code, key, same ? { view } : { session: id, view })).then(
        () => {
          this.sentView = text;
          this.shownSession = id;
        },
      );
    }, SEND_MS);
  }

  private ask(): void {
    questionDialog(this.session.joint, async (question, right) => {
      if (!this.lecture) return;
      await api.ask(this.lecture.code, this.lecture.key, { ...question, right });
      this.question = question;
      void this.poll();
    });
  }

  private reveal(): Promise<void> {
    return this.attempt(({ code, key }) => api.reveal(code, key));
  }

  private withdraw(): Promise<void> {
    return this.attempt(async ({ code, key }) => {
      await api.withdrawQuestion(code, key);
      this.question = undefined;
      this.showTally(null);
    });
  }

  private poll(): Promise<void> {
    return this.attempt(async ({ code, key }) => {
      const { followers, tally } = await api.presenterState(code, key);
      setText(
        this.followers,
        followers === 0 ? t("nobody follows yet") : t("{n} follows | {n} follow", { n: followers }),
      );
      this.showTally(tally, followers);
    });
  }

  private showTally(tally: Tally | null, followers = 0): void {
    this.revealButton.hidden = !tally || tally.revealed;
    this.withdrawButton.hidden = !tally;
    if (!tally) {
      this.result.replaceChildren();
      return;
    }
    const choices =
      this.question?.choices ?? tally.counts.map((_, k) => t("choice {number}", { number: k + 1 }));
    this.result.replaceChildren(
      h("p", { class: "presenter-question" }, this.question?.text ?? t("The question that is asked")),
      // This page is what the projector shows: how the answers stand would sway those who have not answered.
      tally.revealed ? histogram(choices, tally) : answered(tally, followers),
    );
  }
}

function answered({ counts }: Tally, followers: number): HTMLElement {
  const count = counts.reduce((sum, each) => sum + each, 0);
  return h(
    "p",
    { role: "status" },
    t("{count} of {all} have answered. How they stand is seen when it is revealed.", {
      count,
      all: Math.max(count, followers),
    }),
  );
}

function action(label: string, cls: string, run: () => void): HTMLButtonElement {
  return h("button", { type: "button", class: cls, onclick: run }, label);
}

/** Shows the code in type that is read from the back of a lecture hall, and the address as a picture for phones. */
async function invite(lecture: OwnLecture): Promise<void> {
  const { qr } = await import("./qr");
  const address = new URL(addressOf(`/room/${lecture.code}`), location.href).href;
  const here = /^(localhost|127\.|\[::1\])/.test(location.hostname);
  const box = dialog(
    t("Join this lecture"),
    h(
      "div",
      { class: "invite" },
      qr(address),
      h(
        "div",
        { class: "stack" },
        h(
          "p",
          null,
          ...parts("Open {address} and type", {
            address: h(
              "b",
              null,
              new URL(addressOf("/room"), location.href).href.replace(/^https?:\/\//, ""),
            ),
          }),
        ),
        h("p", { class: "invite-code" }, lecture.code),
        here
          ? h(
              "p",
              { class: "notice is-note" },
              t(
                "This address is known to this computer only. For a class start the server with “triad serve --host 0.0.0.0” and open the page at this computer’s address in the network.",
              ),
            )
          : null,
      ),
    ),
  );
  box.classList.add("is-wide");
}
