// What a picture shows, for those who do not see it.

import type { SessionState } from "../api/types";
import { num, seconds } from "../core/format";
import { t } from "../core/texts";

/** Bodies whose places are told; of the others only how many there are. */
const TOLD = 4;

/** The moment and where the bodies are. */
export function inWords(state: SessionState): string {
  const bodies = state.bodies.slice(0, TOLD).map((body) =>
    t("{name} at {position} m", {
      name: body.name,
      position: body.position.map((x) => num(x, 3)).join(", "),
    }),
  );
  const left = state.bodies.length - TOLD;
  const more = left > 0 ? `, ${t("and {n} more body | and {n} more bodies", { n: left })}` : "";
  return t("Drawing of the mechanism at {time}: {bodies}{more}.", {
    time: seconds(state.time),
    bodies: bodies.join("; "),
    more,
  });
}
