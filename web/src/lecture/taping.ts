// The presenter's page writes the lecture down while it goes on, over all lessons and scenes that it opens.

import type { Motion, PresenterState } from "../api/types";
import type { Session } from "../session/session";
import { Tape, type Taped } from "./tape";

/** The tape of the lecture that this page leads: it goes on with the next lesson. A reload begins a new one. */
let current: { code: string; tape: Tape } | undefined;

export class Taping {
  private readonly tape: Tape;
  private readonly undo: (() => void)[];
  private heard: Pick<PresenterState, "question" | "remarks"> = { question: null, remarks: [] };
  private blank = false;

  /** `motion` is that of the run so far, if it is known. */
  constructor(
    private readonly session: Session,
    code: string,
    private readonly motion: () => Motion | undefined,
  ) {
    if (current?.code !== code)
      current = { code, tape: new Tape(session.latest?.title ?? code, () => performance.now()) };
    this.tape = current.tape;
    this.undo = [
      session.on("parting", () => this.cut()),
      ...(["shown", "view", "selected"] as const).map((event) => session.on(event, () => this.see())),
    ];
    this.see();
  }

  dispose(): void {
    for (const step of this.undo) step();
    this.cut();
  }

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
