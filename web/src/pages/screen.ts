// A lecture as the hall sees it: a window for the projector, without controls. It shows what the presenter shows, a question
// and, once revealed, how the answers stand; a clicker's keys go on to the presenter's window.

import { api } from "../api/client";
import { addressOf } from "../core/address";
import { h, setText } from "../core/dom";
import { bind } from "../core/keys";
import { type Page, setTitle } from "../core/router";
import { t } from "../core/texts";
import { forTheHall } from "../core/theme";
import { Follower } from "../lecture/follower";
import { histogram } from "../lecture/histogram";
import { writtenRoom } from "../lecture/room-name";
import { type ScreenKey, screenKeys } from "../lecture/screen-keys";
import { analysisTold, changedLine } from "../lecture/standing";
import { Stage } from "../stage/stage";
import { problemNotice } from "../ui/notice";

export function screenPage(outlet: HTMLElement, params: string[]): Page {
  const page = new Screen(writtenRoom(params[0] ?? ""));
  outlet.append(page.root);
  return { title: t("Lecture"), dispose: () => page.dispose() };
}

class Screen {
  readonly root: HTMLElement;
  private readonly title = h("h1", null);
  private readonly clock = h("p", { class: "screen-clock" });
  /** That the presenter looks at an analysis. */
  private readonly analysis = h("p", { role: "status" });
  private readonly asked = h("section", { class: "screen-asked", hidden: true, "aria-live": "polite" });
  private readonly curtain = h("div", { class: "curtain", hidden: true });
  private readonly follower: Follower;
  private readonly stage: Stage;
  private readonly keys: BroadcastChannel;
  private readonly undo: (() => void)[];
  private shown = "";

  constructor(code: string) {
    this.follower = new Follower(code, true);
    this.stage = new Stage(this.follower, undefined, "drawing");
    this.keys = screenKeys(code);
    const room = new URL(addressOf("/room"), location.href);
    this.root = h(
      "div",
      { class: "screen" },
      h(
        "header",
        { class: "screen-head" },
        this.title,
        this.clock,
        h("p", { class: "screen-room" }, `${room.host}${room.pathname}`, " ", h("b", null, code)),
      ),
      h("div", { class: "screen-told" }, this.analysis, changedLine(this.follower)),
      this.stage.root,
      this.asked,
      this.curtain,
    );
    document.documentElement.dataset.screen = "";
    const press = (keys: string[], does: string, run: () => void) => ({
      keys,
      shown: keys[0] ?? "",
      does,
      run,
    });
    const hand = (key: ScreenKey) => () => this.keys.postMessage(key);
    this.undo = [
      forTheHall(),
      bind([
        press(["PageDown", "ArrowRight"], t("Lecture: next slide"), hand("next")),
        press(["PageUp", "ArrowLeft"], t("Lecture: slide before"), hand("before")),
        press(["b", "B", "."], t("Lecture: blank the screen, and back"), hand("blank")),
        press(["f", "F"], t("The whole screen"), () => void wholeScreen()),
      ]),
      this.follower.on("lecture", () => this.paint()),
      this.follower.on("shown", () => this.tick()),
      () => delete document.documentElement.dataset.screen,
    ];
    this.root.addEventListener("dblclick", () => void wholeScreen());
    api
      .lecture(code)
      .then(() => this.follower.start())
      .catch((error: unknown) => this.root.replaceChildren(problemNotice(error)));
  }

  dispose(): void {
    for (const step of this.undo) step();
    this.keys.close();
    this.stage.dispose();
    this.follower.close();
  }

  private tick(): void {
    const { time, latest, pose } = this.follower;
    // An analysis is of no moment of the run.
    setText(this.clock, latest && !pose ? `${time.toFixed(2)} s` : "");
  }

  private paint(): void {
    const { lecture, over, analysis } = this.follower;
    setText(this.analysis, analysis && !over ? analysisTold(analysis.pose !== undefined) : "");
    setText(this.title, over ? t("The lecture is over.") : (lecture?.title ?? t("Lecture")));
    if (lecture?.title) setTitle(lecture.title);
    this.curtain.hidden = over || (lecture?.view as { blank?: unknown } | null)?.blank !== true;
    const question = over ? null : (lecture?.question ?? null);
    const remark = over ? null : (lecture?.remark ?? null);
    const key = JSON.stringify([question, remark]);
    if (key === this.shown) return;
    this.shown = key;
    this.asked.hidden = !question && !remark;
    this.asked.replaceChildren(
      ...(remark
        ? [h("h2", null, t("A question from the hall")), h("p", { class: "said-text" }, remark.text)]
        : []),
      ...(question ? ask(question) : []),
    );
  }
}

type Asked = NonNullable<NonNullable<Follower["lecture"]>["question"]>;

/** The choices as they are read aloud, or how the answers stand. */
function ask({ text, choices, result, again }: Asked): HTMLElement[] {
  const second =
    again && !result
      ? [h("p", { class: "help" }, t("Asked again: talk it over with your neighbour, then vote anew."))]
      : [];
  const list = result
    ? histogram(choices, result)
    : h("ul", { class: "screen-choices" }, ...choices.map((choice) => h("li", null, choice)));
  return [h("h2", null, text), ...second, list];
}

async function wholeScreen(): Promise<void> {
  try {
    if (document.fullscreenElement) await document.exitFullscreen();
    else await document.documentElement.requestFullscreen();
  } catch {
    // The browser has a key of its own for it.
  }
}
