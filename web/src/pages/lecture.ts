// A lecture, followed: the presenter's run, the question that is asked, and the way to look around and come back.
import { ApiError, api } from "../api/client";
import { h, setText } from "../core/dom";
import { navigate, type Page, setTitle } from "../core/router";
import { Follower } from "../lecture/follower";
import { ballot } from "../lecture/voter";
import { linkTo } from "../session/shared-view";
import { icon } from "../ui/icons";
import { problemNotice } from "../ui/notice";
import { mountWorkbench } from "../workbench/workbench";

export function joinPage(outlet: HTMLElement): Page {
  const code = h("input", {
    id: "room-code",
    class: "field room-code",
    autocomplete: "off",
    autocapitalize: "characters",
    spellcheck: "false",
    maxlength: "8",
    required: true,
  });
  const wrong = h("div", { "aria-live": "polite" });
  const form = h(
    "form",
    { class: "stack" },
    h("label", { for: "room-code" }, "Code of the room"),
    code,
    wrong,
    h("div", { class: "row" }, h("button", { class: "button primary" }, "Join")),
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const typed = code.value.trim().toUpperCase();
    api
      .room(typed)
      .then(() => navigate(`/room/${encodeURIComponent(typed)}`))
      .catch((error: unknown) => wrong.replaceChildren(problemNotice(error)));
  });
  outlet.append(
    h(
      "div",
      { class: "page narrow" },
      h("h1", null, "Join a lecture"),
      h("p", { class: "lead" }, "Type the code that your instructor shows. No account is needed."),
      form,
    ),
  );
  code.focus();
  return { title: "Join a lecture" };
}

export function lecturePage(outlet: HTMLElement, params: string[]): Page {
  const code = (params[0] ?? "").toUpperCase();
  const leaving = new AbortController();
  const place = h("section", { class: "bench", "aria-label": "Mechanism" });
  const title = h("h1", null, "Lecture");
  const status = h("p", { class: "lead", role: "status" });
  const back = h(
    "button",
    { type: "button", class: "button primary", hidden: true },
    icon("live"),
    "Back to the lecture",
  );
  const own = h("a", { class: "button", hidden: true, href: "/" }, "Try it yourself");
  const votes = ballot(code);
  const head = h(
    "header",
    { class: "room-head" },
    h("div", null, h("p", { class: "lesson-kicker" }, `Room ${code}`), title, status),
    h("div", { class: "row wrap" }, back, own),
  );
  outlet.append(h("div", { class: "room" }, head, votes.root, place));
  let end: (() => void) | undefined;

  const open = (): void => {
    const follower = new Follower(code);
    const made = mountWorkbench(place, follower, {});
    end = made.dispose;
    follower.panel = made.selectPanel;
    back.onclick = () => follower.comeBackToLecture();
    const paint = (): void => {
      const board = follower.lecture;
      votes.show(follower.over ? null : (board?.question ?? null));
      setText(title, board?.title ?? "Lecture");
      if (board?.title) setTitle(board.title);
      setText(
        status,
        follower.over
          ? "The lecture is over. What was shown can still be looked at here."
          : !board?.source
            ? "The presenter shows nothing at the moment."
            : follower.roaming
              ? "You look around on your own; the lecture goes on."
              : "You see what the presenter shows.",
      );
      back.hidden = !follower.roaming || follower.over;
      void ownLink(follower).then((href) => {
        own.hidden = href === undefined;
        if (href) own.href = href;
      });
    };
    follower.on("lecture", paint);
    follower.on("scene", paint);
    void follower.start();
  };

  api
    .room(code, leaving.signal)
    .then(open)
    .catch((error: unknown) => {
      if (leaving.signal.aborted) return;
      const missing = error instanceof ApiError && error.gone;
      place.remove();
      status.textContent = missing
        ? "There is no such room. The lecture may be over, or the code is another."
        : "";
      head.after(problemNotice(error, [{ label: "Type the code again", run: () => navigate("/room") }]));
    });
  return {
    title: "Lecture",
    dispose: () => {
      leaving.abort();
      end?.();
    },
  };
}

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
