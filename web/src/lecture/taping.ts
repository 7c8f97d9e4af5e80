// The presenter's page writes the lecture down while it goes on, over all lessons and scenes that it opens.

import type { Motion, PresenterState } from "../api/types";
import type { Session } from "../session/session";
import { Tape, type Taped } from "./tape";

/** The tape of the lecture that this page leads: it goes on with the next lesson. */
let current: { code: string; tape: Tape } | undefined;
/** Where this window keeps it over a reload: at most some three million letters, of five that browsers allow. */
const KEPT = "triad:tape";

/** The tape of a lecture that was recorded until this page was reloaded. */
function keptTape(code: string): Tape | undefined {
  try {
    const kept = JSON.parse(sessionStorage.getItem(KEPT) ?? "null") as { code: string; taped: Taped } | null;
    return kept?.code === code ? new Tape(kept.taped.title, () => performance.now(), kept.taped) : undefined;
  } catch {
    return undefined;
  }
}

/** The lecture is over: what it recorded is no longer gone on with. */
export function forgetTape(): void {
  current = undefined;
  try {
    sessionStorage.removeItem(KEPT);
  } catch {
    // Nothing is kept where storage is refused.
  }
}

export class Taping {
  private readonly tape: Tape;
  private readonly undo: (() => void)[];
  private heard: Pick<PresenterState, "question" | "remarks"> = { question: null, remarks: [] };
  private blank = false;

  /** `motion` is that of the run so far, if it is known. */
  constructor(
    private readonly session: Session,
    private readonly code: string,
    private readonly motion: () => Motion | undefined,
  ) {
    if (current?.code !== code)
      current = {
        code,
        tape: keptTape(code) ?? new Tape(session.latest?.title ?? code, () => performance.now()),
      };
    this.tape = current.tape;
    addEventListener("pagehide", this.keep);
    this.undo = [
      session.on("parting", () => this.cut()),
      ...(["shown", "view", "selected"] as const).map((event) => session.on(event, () => this.see())),
    ];
    this.see();
  }

  dispose(): void {
    removeEventListener("pagehide", this.keep);
    for (const step of this.undo) step();
    this.cut();
  }

  /** The page is left: where it comes back, as at a reload, the recording goes on. */
  private readonly keep = (): void => {
    this.cut();
    try {
      sessionStorage.setItem(KEPT, JSON.stringify({ code: this.code, taped: this.tape.taped(undefined) }));
    } catch {
      // Without room the recording begins anew.
    }
  };

  /** What is asked and blanked now. */
  hear(heard: Pick<PresenterState, "question" | "remarks">, blank: boolean): void {
    this.heard = heard;
    this.blank = blank;
    this.see();
  }

  taped(): Taped {
    return this.tape.taped(this.motion());
  }

  private cut(): void {
    const motion = this.motion();
    if (motion && motion.until > 0) this.tape.cut(motion);
  }

  private see(): void {
    const { session, heard, blank } = this;
    if (!session.latest) return;
    this.tape.see(session.time, session.moving ? session.speed : 0, {
      joint: session.joint,
      drawn: session.drawn,
      camera: session.camera,
      blank,
      question: heard.question ?? null,
      remark: heard.remarks.find((remark) => remark.shown)?.text ?? null,
    });
  }
}
