// What has happened in a run: its events, and the singular positions that it has passed.

import type { EventOccurrence, SessionState } from "../api/types";
import { sci, seconds } from "../core/format";
import { listed, t } from "../core/texts";

/** Joints of a passage that are named; large mechanisms have hundreds. */
const NAMED = 4;
/** Decimals of a time in a list: those of the clock do not answer a question for four digits. */
const DECIMALS = 6;
/** Times that differ by less are the same, s. */
const SAME_TIME = 1e-9;

type Known = Pick<SessionState, "events" | "earlier_events" | "passages" | "earlier_passages">;

/** Something that has happened, to be told beside its time. */
export interface Happening {
  kind: "event" | "stop" | "passage";
  /** The author's name of an event. */
  name: string;
  time: number;
  /** When, as exactly as it is known. */
  when: string;
  /** What, in a few words. */
  words: string;
  /** The same with its time, as a sentence. */
  sentence: string;
}

/** What was told last: a state of the same lists is told the same. */
let last: { of: Known; told: readonly Happening[] } | undefined;

/** All that is known to have happened, in the order of time. */
export function happenings(state: Known): readonly Happening[] {
  if (last?.of.events !== state.events || last.of.passages !== state.passages)
    last = { of: state, told: toldOf(state) };
  return last.told;
}

function toldOf(state: Known): Happening[] {
  const events = (state.events ?? []).map(ofEvent);
  const passages = (state.passages ?? []).map(({ time, joints }): Happening => {
    const named = listed(
      joints.length > NAMED + 1
        ? [...joints.slice(0, NAMED), t("{n} more | {n} more", { n: joints.length - NAMED })]
        : joints,
    );
    return {
      kind: "passage",
      name: "",
      time,
      when: seconds(time, DECIMALS),
      words: t("singular position passed, at {joints}", { joints: named }),
      sentence: t("Singular position passed at {time}, at {joints}", {
        time: seconds(time, DECIMALS),
        joints: named,
      }),
    };
  });
  return [...events, ...passages].sort((a, b) => a.time - b.time);
}

function ofEvent({ name, time, error, stop }: EventOccurrence): Happening {
  const off = error === null || error === undefined ? "" : ` ± ${sci(error, 1)} s`;
  const at = { name, time: seconds(time, DECIMALS) };
  return {
    kind: stop ? "stop" : "event",
    name,
    time,
    when: `${at.time}${off}`,
    words: stop ? t("“{name}”: the run ends there", { name }) : name,
    sentence: stop ? t("“{name}” ended the run at {time}", at) : t("“{name}” at {time}", at),
  };
}

/** How much has happened before what is told. */
export const leftOut = (state: Known): number => (state.earlier_events ?? 0) + (state.earlier_passages ?? 0);

/** The event that ended the run, if one did. Of a run that went on with other numbers it is one among others. */
export function endedBy(state: SessionState | undefined): Happening | undefined {
  if (!state?.finished) return undefined;
  // Others may happen at the same moment, and stand after it.
  const ends = ({ stop, time }: EventOccurrence): boolean => stop && Math.abs(time - state.time) <= SAME_TIME;
  const event = state.events?.find(ends);
  return event && ofEvent(event);
}

/** Lists that are the same as those of the state before are kept once: thousands of states are. */
export function shareLists(before: SessionState | undefined, state: SessionState): void {
  if (!before) return;
  for (const key of ["events", "passages"] as const) {
    const [then, now] = [before[key], state[key]];
    const same =
      then?.length === now?.length &&
      before[`earlier_${key}`] === state[`earlier_${key}`] &&
      JSON.stringify(then) === JSON.stringify(now);
    if (same) Object.assign(state, { [key]: then });
  }
}
