// Values that are asked for only while somebody looks: one request at a time, newest time wins.
import type { SessionState } from "../core/types";
import type { Session } from "./session";

const PAUSE_MS = 300;

export interface Fetched {
  refresh: () => void;
}

export function fetched<T>(session: Session, ask: (id: string) => Promise<T>, show: (value: T, of: SessionState) => void, failed: (error: unknown) => void, asked: () => string = () => ""): Fetched {
  let busy = false;
  let seen = "";

  const refresh = (): void => {
    const state = session.latest;
    if (!state || busy) return;
    const key = `${state.id}@${state.time}@${state.changes}${asked()}`;
    if (key === seen) return;
    busy = true;
    ask(state.id)
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
          refreshIfMoved(key);
        }, PAUSE_MS);
      });
  };
  const refreshIfMoved = (key: string): void => {
    const state = session.latest;
    if (state && !state.playing && `${state.id}@${state.time}@${state.changes}${asked()}` !== key) refresh();
  };
  return { refresh };
}
