// Requests whose failure is shown beside what asked for them.
import { h } from "../../core/dom";
import { problemNotice } from "../../ui/notice";

export class Attempts {
  readonly root = h("div", { "aria-live": "polite" });

  /** Runs a request; a failure is shown until the next one succeeds. */
  async run(request: () => Promise<void>): Promise<void> {
    try {
      await request();
      this.root.replaceChildren();
    } catch (error) {
      this.root.replaceChildren(problemNotice(error));
    }
  }
}
