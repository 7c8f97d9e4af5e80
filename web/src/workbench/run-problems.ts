// What went wrong with a run, and what helps: each kind has its own way out.

import { problemOf } from "../api/client";
import type { Problem } from "../api/types";
import { h } from "../core/dom";
import { seconds } from "../core/format";
import { t } from "../core/texts";
import type { Session } from "../session/session";
import { type Action, problemNotice } from "../ui/notice";

export function trouble(session: Session): HTMLElement {
  const root = h("div", { class: "trouble" });
  const clear = (): void => root.replaceChildren();
  session.on("problem", (error) => {
    const problem: Problem = problemOf(error);
    root.replaceChildren(problemNotice(problem, ways(session, clear)));
  });
  // The way out was taken elsewhere, or by itself.
  session.on("shown", () => {
    if (session.latest && !session.latest.error && root.dataset.of === "stopped") clear();
    root.dataset.of = session.latest?.error ? "stopped" : "";
  });
  return root;
}

function ways(session: Session, clear: () => void): Action[] {
  const state = session.latest;
  if (!state)
    return [
      {
        label: t("Try again"),
        run: () => {
          clear();
          void session.start();
        },
      },
    ];
  const stopped = state.error !== null && state.error !== undefined;
  return [
    ...(stopped && session.past.all.length > 1
      ? [
          {
            label: t("Look at the last good moments before {time}", { time: seconds(state.time) }),
            run: () => session.seek(Math.max(0, state.time - 1)),
          },
        ]
      : []),
    ...(stopped && session.canUndo
      ? [
          {
            label: t("Undo the last change"),
            run: () => {
              clear();
              void session.undo();
            },
          },
        ]
      : []),
    {
      label: t("Reset to the start"),
      run: () => {
        clear();
        void session.reset();
      },
    },
  ];
}
