// A presenter's panel: opens a lecture for the run of this page, sends what is looked at, asks and reveals.

import { ApiError, api } from "../api/client";
import { inClass, teaches } from "../api/identity";
import type { Motion, PresenterState, Tally } from "../api/types";
import { addressOf, pathOf } from "../core/address";
import { announce, h, setText } from "../core/dom";
import { t } from "../core/texts";
import type { Session } from "../session/session";
import type { SharedView } from "../session/shared-view";
import { icon } from "../ui/icons";
import { problemNotice } from "../ui/notice";
import { viewOfPose } from "./analysis-view";
import { Desk } from "./desk";
import { histogram } from "./histogram";
import { invite } from "./invite";
import { type OwnLecture, store, stored } from "./own-lecture";
import { questionDialog } from "./question-dialog";
import { nameForm, openOwnRoom, openRoom } from "./room-name";
import { showSaid } from "./said";
import { screenKeys } from "./screen-keys";
import { Slides } from "./slides";
import type { Taped } from "./tape";
import { forgetTape, Taping } from "./taping";

/** Time between two messages to the followers, ms. */
const SEND_MS = 150;
/** Time between two questions for the number of followers and answers, ms. */
const POLL_MS = 1000;
export interface PresenterHooks {
  /** What the page shows now, as a link would carry it, and a small picture of it. */
  seen: () => SharedView;
  picture: () => string | undefined;
  /** The motion so far, if it is known. */
  motion: () => Motion | undefined;
  /** Plays the lecture so far, and saves it. */
  replay: (taped: Taped) => void;
}

/** Whether a room can be opened: in a class those who teach do. */
const mayLead = (): boolean => !inClass() || teaches();

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
      hidden: !mayLead(),
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
  private readonly againButton = action(t("Vote again"), "button", () => void this.again());
  private readonly withdrawButton = action(t("Take it away"), "button", () => void this.withdraw());
  private readonly undo: (() => void)[];

  private lecture = stored();
  /** The view that was sent last, as JSON. */
  private sentView = "";
  /** The session that the followers see. */
  private shownSession = "";
  private sendTimer = 0;
  private slides: Slides | undefined;
  private readonly curtain = h("div", { class: "curtain", hidden: true });
  private readonly desk = new Desk({
    show: (number, shown) => this.led((code, key) => api.showRemark(code, key, number, shown)),
    settle: (number) => this.led((code, key) => api.settleRemark(code, key, number)),
    lower: () => this.led((code, key) => api.lowerHands(code, key)),
  });
  /** Windows that show the lecture to the hall. */
  private screens = 0;
  /** Keys that were pressed in such a window. */
  private pressed: BroadcastChannel | undefined;

  private taping: Taping | undefined;

  constructor(
    private readonly session: Session,
    private readonly hooks: PresenterHooks,
  ) {
    for (const button of [this.revealButton, this.againButton, this.withdrawButton]) button.hidden = true;
    this.curtain.addEventListener("click", () => this.slides?.blank());
    document.body.append(this.curtain);
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
    this.pressed?.close();
    this.taping?.dispose();
    this.curtain.remove();
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
          action(t("How to join"), "button", () => void this.invite()),
          action(t("Window for the projector"), "button", () => this.openScreen()),
          action(t("Ask a question"), "button", () => this.ask()),
          lesson && inClass() && teaches()
            ? action(t("What the class said"), "button", () => showSaid(lesson))
            : null,
          this.revealButton,
          this.againButton,
          this.withdrawButton,
          action(t("As a recording"), "button", () => this.taping && this.hooks.replay(this.taping.taped())),
          action(t("End the lecture"), "button quiet", () => void this.end()),
        ),
      ),
      this.prepared,
      this.result,
      this.desk.root,
      this.trouble,
    );
  }

  /** The window that the hall sees; without one it sees this page. */
  private openScreen(): void {
    if (this.lecture)
      open(addressOf(`/room/${this.lecture.code}/screen`), "triad-screen", "popup,width=1280,height=720");
  }

  private paint(): void {
    this.root.hidden = !this.lecture;
    this.button.hidden = this.lecture !== undefined || !mayLead();
    setText(this.code, this.lecture?.code ?? "");
    if (this.lecture && !this.slides) {
      const slides = new Slides({
        session: this.session,
        seen: this.hooks.seen,
        picture: this.hooks.picture,
        blank: () => this.drawCurtain(),
      });
      this.slides = slides;
      this.prepared.replaceChildren(slides.root);
      this.desk.place(slides.notes);
      this.taping = new Taping(this.session, this.lecture.code, this.hooks.motion);
      this.pressed = screenKeys(this.lecture.code);
      this.pressed.onmessage = ({ data }) => {
        if (data === "blank") slides.blank();
        else slides.step(data === "next" ? 1 : -1);
      };
    } else if (!this.lecture) {
      this.slides?.dispose();
      this.slides = undefined;
      this.pressed?.close();
      this.taping?.dispose();
      this.taping = undefined;
      this.desk.place(undefined);
      this.curtain.hidden = true;
      this.prepared.replaceChildren();
    }
  }

  /** Blanks what the hall sees: the projector's window, or this page where there is none. */
  private drawCurtain(): void {
    this.curtain.hidden = !(this.slides?.blanked && this.screens === 0);
    this.send();
  }

  private async open(): Promise<void> {
    const id = this.session.latest?.id;
    if (!id) return;
    try {
      const { opened, refused } = await openOwnRoom(id);
      this.lead(id, opened);
      await this.invite(refused);
    } catch (error) {
      this.root.hidden = false;
      this.trouble.replaceChildren(problemNotice(error));
    }
  }

  private lead(session: string, { code, key }: OwnLecture): void {
    this.lecture = { code, key };
    store(this.lecture);
    this.sentView = "";
    this.shownSession = session;
    this.paint();
    announce(t("The lecture room {code} is open.", { code }));
    this.send();
  }

  /** Shows how to join, and why the room does not have its name. */
  private async invite(refused?: unknown): Promise<void> {
    if (!this.lecture) return;
    const use = async (name: string | undefined): Promise<void> => {
      await this.rename(name);
      box.close();
      await this.invite();
    };
    const box = await invite(this.lecture.code, nameForm(this.lecture.code, use, refused));
  }

  /** Goes on in a room of that name, or of a code; the room before ends. */
  private async rename(name: string | undefined): Promise<void> {
    const [before, id] = [this.lecture, this.session.latest?.id];
    if (!before || !id) return;
    const opened = await openRoom(id, name);
    if (opened.code === before.code) return;
    await api.closeLecture(before.code, before.key).catch(() => undefined);
    this.forget();
    this.lead(id, opened);
  }

  private end(): Promise<void> {
    return this.attempt(async ({ code, key }) => {
      await api.closeLecture(code, key);
      // It can be kept until the page is left.
      const taped = this.taping?.taped();
      this.forget();
      announce(t("The lecture is over."));
      if (taped && taped.parts.length > 0) this.hooks.replay(taped);
    });
  }

  private forget(): void {
    this.lecture = undefined;
    store(undefined);
    this.paint();
    forgetTape();
  }

  /** Sends a request for the lecture that is open; a failure is shown in the panel. */
  private async attempt(run: (lecture: OwnLecture) => Promise<void>): Promise<void> {
    const { lecture } = this;
    if (!lecture) return;
    try {
      await run(lecture);
      this.trouble.replaceChildren();
    } catch (error) {
      // The room has another name since: what its old one answers says nothing about it.
      if (this.lecture !== lecture) return;
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
      const blank = this.slides?.blanked ?? false;
      const { reviewing: back, pose } = this.session;
      const view = { ...this.hooks.seen(), back, blank, ...viewOfPose(pose) };
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
      void this.poll();
    });
  }

  /** Sends what the presenter decided, and looks at once what became of it. */
  private led(run: (code: string, key: string) => Promise<void>): void {
    void this.attempt(({ code, key }) => run(code, key)).then(() => this.poll());
  }

  private again(): Promise<void> {
    return this.attempt(({ code, key }) => api.askSecondTime(code, key)).then(() => this.poll());
  }

  private reveal(): Promise<void> {
    return this.attempt(({ code, key }) => api.reveal(code, key));
  }

  private withdraw(): Promise<void> {
    return this.attempt(async ({ code, key }) => {
      await api.withdrawQuestion(code, key);
      await this.poll();
    });
  }

  private poll(): Promise<void> {
    return this.attempt(async ({ code, key }) => {
      const state = await api.presenterState(code, key);
      const { followers } = state;
      setText(
        this.followers,
        followers === 0 ? t("nobody follows yet") : t("{n} follows | {n} follow", { n: followers }),
      );
      if (state.screens !== this.screens) {
        this.screens = state.screens;
        this.drawCurtain();
      }
      this.taping?.hear(state, this.slides?.blanked ?? false);
      this.showTally(state);
    });
  }

  private showTally(state: PresenterState): void {
    const { tally, question, followers, screens } = state;
    this.revealButton.hidden = !tally || tally.revealed;
    this.againButton.hidden = !tally;
    this.withdrawButton.hidden = !tally;
    if (!tally || !question) {
      this.desk.paint(state, undefined);
      this.result.replaceChildren();
      return;
    }
    // Where this page is what the projector shows, how the answers stand would sway those who have not answered.
    this.desk.paint(state, tally.revealed ? undefined : histogram(question.choices, tally));
    this.result.replaceChildren(
      h("p", { class: "presenter-question" }, question.text),
      tally.revealed ? histogram(question.choices, tally) : answered(tally, followers, screens > 0),
    );
  }
}

function answered({ counts }: Tally, followers: number, apart: boolean): HTMLElement {
  const count = counts.reduce((sum, each) => sum + each, 0);
  const values = { count, all: Math.max(count, followers) };
  return h(
    "p",
    { role: "status" },
    apart
      ? t("{count} of {all} have answered.", values)
      : t("{count} of {all} have answered. How they stand is seen when it is revealed.", values),
  );
}

function action(label: string, cls: string, run: () => void): HTMLButtonElement {
  return h("button", { type: "button", class: cls, onclick: run }, label);
}
