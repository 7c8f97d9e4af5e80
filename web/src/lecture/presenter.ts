// What a presenter sees: opens a lecture for the run of this page, sends what is looked at, asks, reveals.
import { ApiError, api } from "../api/client";
import type { Tally } from "../api/types";
import { announce, h, setText } from "../core/dom";
import type { Session } from "../session/session";
import type { SharedView } from "../session/shared-view";
import { dialog } from "../ui/dialog";
import { icon } from "../ui/icons";
import { problemNotice } from "../ui/notice";
import { type Question, questionDialog } from "./question-dialog";
import { histogram } from "./voter";

/** Between two messages to the room, ms. */
const SEND_MS = 150;
const POLL_MS = 1000;

interface Room {
  code: string;
  key: string;
}

/** The room belongs to this tab: it goes on after a reload and on the next lesson, but no other tab leads it. */
const STORED = "triad:room";

function keep(room: Room | undefined): void {
  try {
    if (room) sessionStorage.setItem(STORED, JSON.stringify(room));
    else sessionStorage.removeItem(STORED);
  } catch {
    // Without storage the lecture ends with the page.
  }
}

function remembered(): Room | undefined {
  try {
    const room = JSON.parse(sessionStorage.getItem(STORED) ?? "null") as Room | null;
    return room && typeof room.code === "string" && typeof room.key === "string" ? room : undefined;
  } catch {
    return undefined;
  }
}

export interface PresenterPanel {
  button: HTMLElement;
  root: HTMLElement;
  dispose: () => void;
}

export function presenterPanel(session: Session, seen: () => SharedView): PresenterPanel {
  let room = remembered();
  let sent = "";
  let shown = "";
  let waiting = 0;
  let question: Question | undefined;
  const trouble = h("div", { "aria-live": "polite" });
  const followers = h("span", { class: "desk-count", role: "status" }, "nobody follows yet");
  const result = h("div", { class: "desk-result" });
  const revealButton = h(
    "button",
    {
      type: "button",
      class: "button primary",
      hidden: true,
      onclick: () => attempt((it) => api.reveal(it.code, it.key)),
    },
    "Reveal",
  );
  const forgetButton = h(
    "button",
    {
      type: "button",
      class: "button",
      hidden: true,
      onclick: () =>
        void attempt(async (it) => {
          await api.forgetQuestion(it.code, it.key);
          question = undefined;
          showTally(null);
        }),
    },
    "Take it away",
  );
  const code = h("b", { class: "desk-code" });
  const root = h(
    "section",
    { class: "desk", "aria-label": "Lecture", hidden: true },
    h(
      "div",
      { class: "row wrap between" },
      h("p", { class: "row wrap" }, h("span", null, "Lecture room "), code, followers),
      h(
        "span",
        { class: "row wrap tight" },
        h(
          "button",
          { type: "button", class: "button", onclick: () => room && void invite(room) },
          "How to join",
        ),
        h("button", { type: "button", class: "button", onclick: () => askDialog() }, "Ask a question"),
        revealButton,
        forgetButton,
        h("button", { type: "button", class: "button quiet", onclick: () => void end() }, "End the lecture"),
      ),
    ),
    result,
    trouble,
  );
  const button = h(
    "button",
    {
      type: "button",
      class: "button quiet small icon-only",
      "aria-label": "Lecture: let others follow this run",
      title: "Lecture: let others follow this run",
      onclick: () => void open(),
    },
    icon("lecture"),
  );

  const paint = (): void => {
    root.hidden = !room;
    button.hidden = room !== undefined;
    setText(code, room?.code ?? "");
  };
  const forget = (): void => {
    room = undefined;
    keep(undefined);
    paint();
  };
  const attempt = async (run: (room: Room) => Promise<void>): Promise<void> => {
    if (!room) return;
    try {
      await run(room);
      trouble.replaceChildren();
    } catch (error) {
      // A room that is gone, or that another browser leads now, is no longer ours.
      if (error instanceof ApiError && (error.gone || error.problem.status === 403)) forget();
      trouble.replaceChildren(problemNotice(error));
    }
  };
  const open = async (): Promise<void> => {
    const id = session.latest?.id;
    if (!id) return;
    try {
      const opened = await api.openLecture(id);
      room = { code: opened.code, key: opened.key };
      keep(room);
      sent = "";
      shown = id;
      paint();
      announce(`The lecture room ${opened.code} is open.`);
      send();
      await invite(room);
    } catch (error) {
      root.hidden = false;
      trouble.replaceChildren(problemNotice(error));
    }
  };
  const end = (): Promise<void> =>
    attempt(async (it) => {
      await api.closeLecture(it.code, it.key);
      forget();
      announce("The lecture is over.");
    });

  /** Tells the room what is looked at: at most a few times a second, the newest counts. */
  const send = (): void => {
    if (!room || waiting) return;
    waiting = window.setTimeout(() => {
      waiting = 0;
      const id = session.latest?.id;
      const view = { ...seen(), back: session.reviewing };
      // While time runs, followers have it from the run itself.
      if (!session.reviewing) delete view.time;
      const text = JSON.stringify(view);
      if (!id || (text === sent && id === shown)) return;
      void attempt((it) => api.show(it.code, it.key, id === shown ? { view } : { session: id, view })).then(
        () => {
          sent = text;
          shown = id;
        },
      );
    }, SEND_MS);
  };

  const askDialog = (): void =>
    questionDialog(session.joint, async (asked, right) => {
      if (!room) return;
      await api.ask(room.code, room.key, { ...asked, right });
      question = asked;
      void look();
    });
  const showTally = (tally: Tally | null): void => {
    revealButton.hidden = !tally || tally.revealed;
    forgetButton.hidden = !tally;
    result.replaceChildren(
      ...(tally
        ? [
            h("p", { class: "desk-question" }, question?.text ?? "The question that is asked"),
            histogram(question?.choices ?? tally.counts.map((_, k) => `choice ${k + 1}`), tally),
          ]
        : []),
    );
  };
  const look = (): Promise<void> =>
    attempt(async (it) => {
      const state = await api.presenterState(it.code, it.key);
      setText(
        followers,
        state.followers === 0
          ? "nobody follows yet"
          : `${state.followers} ${state.followers === 1 ? "follows" : "follow"}`,
      );
      showTally(state.tally);
    });

  const timer = window.setInterval(() => void look(), POLL_MS);
  const silence = (["shown", "view", "selected", "opened"] as const).map((event) => session.on(event, send));
  paint();
  return {
    button,
    root,
    dispose: () => {
      clearInterval(timer);
      clearTimeout(waiting);
      for (const step of silence) step();
    },
  };
}

/** The code in type that is read from the back of a room, and the address as a picture for phones. */
async function invite(room: Room): Promise<void> {
  const { qr } = await import("./qr");
  const address = new URL(`/room/${room.code}`, location.href).href;
  const here = /^(localhost|127\.|\[::1\])/.test(location.hostname);
  const box = dialog(
    "Join this lecture",
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
          "Open ",
          h("b", null, new URL("/room", location.href).href.replace(/^https?:\/\//, "")),
          " and type",
        ),
        h("p", { class: "invite-code" }, room.code),
        here
          ? h(
              "p",
              { class: "notice is-note" },
              "This address is known to this computer only. For a class start the server with “triad serve --host 0.0.0.0” and open the page at this computer’s address in the network.",
            )
          : null,
      ),
    ),
  );
  box.classList.add("is-wide");
}
