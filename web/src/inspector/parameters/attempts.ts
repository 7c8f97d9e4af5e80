// Requests whose failure is shown beside what asked for them.
import { ApiError } from "../../api/client";
import { h } from "../../core/dom";
import { problemNotice } from "../../ui/notice";

export class Attempts {
  readonly root = h("div", { "aria-live": "polite" });
  /** The server did not answer, which is the failure that is shown. */
  private unanswered = false;

  /** Runs a request; a failure is shown until the next one succeeds. Whether the server answered it. */
  async run(request: () => Promise<void>): Promise<boolean> {
    try {
      await request();
      this.root.replaceChildren();
      this.unanswered = false;
    } catch (error) {
      const unanswered = error instanceof ApiError && error.away;
      // Asked again and again, it is told once.
      if (!(unanswered && this.unanswered)) this.root.replaceChildren(problemNotice(error));
      this.unanswered = unanswered;
    }
    return !this.unanswered;
  }

  /** The server answers again: that it did not is no longer told. */
  answers(): void {
    if (this.unanswered) this.root.replaceChildren();
    this.unanswered = false;
  }
}
