// A lecture as a follower sees it: the presenter's run, the question, and the way to look around and come back.

import { ApiError, api } from "../api/client";
import { inClass, me } from "../api/identity";
import { h, setText } from "../core/dom";
import { navigate, type Page, setTitle } from "../core/router";
import { parts, t } from "../core/texts";
import { Follower } from "../lecture/follower";
import { writtenRoom } from "../lecture/room-name";
import { changedLine, statusOf } from "../lecture/standing";
import { voice } from "../lecture/voice";
import { ballot } from "../lecture/voter";
import { linkTo } from "../session/shared-view";
import { icon } from "../ui/icons";
import { problemNotice } from "../ui/notice";
import { mountWorkbench } from "../workbench/workbench";

/** Letters in the code of a class. */
const CLASS_CODE = 8;
/** Longest name of a room. */
const LONGEST = 40;
/** How often who waits for a lecture asks whether it has begun, ms: a full hall does not ask at the same moment. */
const [WAIT_MS, SPREAD_MS] = [4000, 3000];

export function joinPage(outlet: HTMLElement): Page {
  const code = h("input", {
    id: "lecture-code",
    class: "field lecture-code",
    autocomplete: "off",
    autocapitalize: "none",
    spellcheck: "false",
    maxlength: LONGEST,
    required: true,
  });
  const wrong = h("div", { "aria-live": "polite" });
  const form = h(
    "form",
    { class: "stack" },
    h("label", { for: "lecture-code" }, t("Code or name of the room")),
    code,
    wrong,
    h("div", { class: "row" }, h("button", { class: "button primary" }, t("Join"))),
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const typed = writtenRoom(code.value);
    const enter = (): void => navigate(`/room/${encodeURIComponent(typed)}`);
    api
      .lecture(typed)
      .then(enter)
      .catch((error: unknown) => {
        if (notBegun(error)) enter();
        // Codes of rooms are shorter, and no room has this name: who types that of the class wants to join it.
        else if (typed.length === CLASS_CODE && inClass() && !me().person)
          navigate(`/join?code=${encodeURIComponent(typed)}`);
        else wrong.replaceChildren(problemNotice(error));
      });
  });
  outlet.append(
    h(
      "div",
      { class: "page narrow" },
      h("h1", null, t("Join a lecture")),
      h("p", { class: "lead" }, t("Type the code that your instructor shows. No account is needed.")),
      form,
      // Who is told to join a class comes here first: the word stands in the header.
      inClass() && !me().person
        ? h(
            "p",
            { class: "help" },
            ...parts("A code of a class, not of a lecture? {link}", {
              link: h("a", { href: "/join" }, t("Join the class")),
            }),
          )
        : null,
    ),
  );
  code.focus();
  return { title: t("Join a lecture") };
}

export function lecturePage(outlet: HTMLElement, params: string[]): Page {
  const page = new LecturePage(writtenRoom(params[0] ?? ""));
  outlet.append(page.root);
  return { title: t("Lecture"), dispose: () => page.dispose() };
}

class LecturePage {
  readonly root: HTMLElement;
  private readonly title = h("h1", null, t("Lecture"));
  private readonly status = h("p", { class: "lead", role: "status" });
  private readonly back = h(
    "button",
    { type: "button", class: "button primary", hidden: true },
    icon("live"),
    t("Back to the lecture"),
  );
  private readonly alone = h("button", { type: "button", class: "button", hidden: true }, t("Look around"));
  private readonly own = h("a", { class: "button", hidden: true, href: "/" }, t("Try it yourself"));
  private readonly bench = h("section", { class: "bench", "aria-label": t("Mechanism") });
  private readonly votes: ReturnType<typeof ballot>;
  private readonly leaving = new AbortController();
  private endRun: (() => void) | undefined;

  constructor(private readonly code: string) {
    this.votes = ballot(code);
    const head = h(
      "header",
      { class: "lecture-head" },
      h("div", null, h("p", { class: "lesson-kicker" }, t("Room {code}", { code })), this.title, this.status),
      h("div", { class: "row wrap" }, this.back, this.alone, this.own),
    );
    this.root = h("div", null, head, this.votes.root, this.bench);
    this.enter(head);
  }

  private enter(head: HTMLElement): void {
    const { signal } = this.leaving;
    api
      .lecture(this.code, signal)
      .then(() => this.open())
      .catch((error: unknown) => {
        if (signal.aborted) return;
        if (!notBegun(error)) {
          this.fail(head, error);
          return;
        }
        setText(
          this.status,
          t("The lecture in this room has not begun. This page goes in by itself when it does."),
        );
        setTimeout(() => !signal.aborted && this.enter(head), WAIT_MS + SPREAD_MS * Math.random());
      });
  }

  dispose(): void {
    this.leaving.abort();
    this.endRun?.();
  }

  private open(): void {
    const follower = new Follower(this.code);
    const made = mountWorkbench(this.bench, follower, {});
    this.endRun = made.dispose;
    follower.panel = made.selectPanel;
    const own = voice(follower);
    this.votes.root.after(own.root);
    this.status.after(changedLine(follower));
    const paint = (): void => {
      this.paint(follower);
      own.paint();
    };
    own.paint();
    this.back.onclick = () => follower.comeBackToLecture();
    // From the moment that is shown: it stays until the follower comes back.
    this.alone.onclick = () => void follower.pause();
    follower.on("lecture", paint);
    follower.on("scene", paint);
    void follower.start();
  }

  private fail(head: HTMLElement, error: unknown): void {
    const missing = error instanceof ApiError && error.gone;
    this.bench.remove();
    this.status.textContent = missing
      ? t("There is no such room. The lecture may be over, or the code is another.")
      : "";
    head.after(problemNotice(error, [{ label: t("Type the code again"), run: () => navigate("/room") }]));
  }

  private paint(follower: Follower): void {
    const { lecture, over, roaming } = follower;
    this.votes.show(over ? null : (lecture?.question ?? null));
    setText(this.title, lecture?.title ?? t("Lecture"));
    if (lecture?.title) setTitle(lecture.title);
    setText(this.status, statusOf(follower));
    this.back.hidden = !roaming || over;
    this.alone.hidden = roaming || over || !lecture?.source;
    void ownLink(follower).then((href) => {
      this.own.hidden = href === undefined;
      if (href) this.own.href = href;
    });
  }
}

/** Whether a room has its name, and no lecture yet. */
const notBegun = (error: unknown): boolean =>
  error instanceof ApiError && error.problem.code === "room-not-open";

/** Where a follower runs the same scene alone, with the presenter's numbers. */
async function ownLink(follower: Follower): Promise<string | undefined> {
  const source = follower.lecture?.source;
  const scene = follower.view?.scene;
  if (!source || !scene) return undefined;
  const changed = JSON.stringify(scene) !== JSON.stringify(follower.view?.original);
  if (!changed && "lesson" in source) return `/lessons/${encodeURIComponent(source.lesson)}`;
  if (!changed && "builtin" in source) return `/scenes/${encodeURIComponent(source.builtin)}`;
  return linkTo("/scenes/own", { scene: JSON.stringify(scene) });
}
