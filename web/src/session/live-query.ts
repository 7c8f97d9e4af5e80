// Values of the moment that is shown, asked for only while somebody looks: one request at a time, newest moment wins.
import type { SessionState } from "../api/types";
import type { Session } from "./session";

/** Pause between two requests, ms. */
const PAUSE_MS = 300;

export interface LiveQuery {
  refresh: () => void;
}

/** `ask` is given the run's address and the time, if it is not the present; the answer is of the latest state that is kept until then. */
export function liveQuery<T>(
  session: Session,
  ask: (run: string, at: number | undefined) => Promise<T>,
  show: (value: T, of: SessionState) => void,
  failed: (error: unknown) => void,
  query: () => string = () => "",
): LiveQuery {
  let busy = false;
  let seen = "";

  const keyOf = (state: SessionState): string =>
    `${state.id}@${session.reviewing ? session.time : state.time}@${state.changes}@${session.reviewing}${query()}`;
  const refresh = (): void => {
    const state = session.shown;
    if (!state || busy) return;
    const key = keyOf(state);
    if (key === seen) return;
    busy = true;
    ask(state.links.self, session.reviewing ? session.time : undefined)
      .then((value) => {
        seen = key;
        show(value, state);
      })
      .catch((error: unknown) => {
        seen = key;
        failed(error);
      })
      .finally(() => {
        setTimeout(() => {
          busy = false;
          const now = session.shown;
          if (now && !session.moving && keyOf(now) !== key) refresh();
        }, PAUSE_MS);
      });
  };
  return { refresh };
}
