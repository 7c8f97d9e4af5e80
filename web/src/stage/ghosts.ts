// Where ghosts come from: the run that is kept, or the recorded one of the scene's author.

import { api, type SessionSource } from "../api/client";
import type { Motion, Scene } from "../api/types";
import { t } from "../core/texts";
import type { Ghost } from "../session/ghost";
import { Recorded } from "../session/recorded";
import type { Session } from "../session/session";

/** The run as far as it has come, kept while others are run. */
export function keptGhost(session: Session, name: string): Ghost | undefined {
  const kept = session.copy();
  const start = kept.past.all[0];
  const until = kept.past.all.at(-1)?.time ?? 0;
  if (start?.time !== 0) return undefined;
  return {
    name,
    scene: session.view?.scene as Scene | undefined,
    start,
    moment: (time) => {
      const state = time <= until ? kept.past.at(time) : undefined;
      return state && (kept.track.at(time, state) ?? kept.past.between(time));
    },
  };
}

/** The recorded run of a scene with its author's numbers; null where there is none, as of a text that stands only here. */
export async function authorsGhost(source: SessionSource): Promise<Ghost | null> {
  const motion = await motionOf(source);
  if (!motion) return null;
  const run = new Recorded(motion);
  return {
    name: t("author’s numbers"),
    scene: motion.scene,
    start: run.moment(0),
    moment: (time) => (time <= motion.until ? run.moment(time) : undefined),
  };
}

function motionOf(source: SessionSource): Promise<Motion> | undefined {
  if ("lesson" in source) return api.motion("lessons", source.lesson);
  return "builtin" in source ? api.motion("scenes", source.builtin) : undefined;
}
