// A follower's voice: a hand, and a question without a name.

import { api } from "../api/client";
import { h, setText } from "../core/dom";
import { t } from "../core/texts";
import { icon } from "../ui/icons";
import { problemNotice } from "../ui/notice";
import type { Follower } from "./follower";
import { voter } from "./voter";

/** Longest question, characters, as the server takes it. */
const MOST = 300;

export function voice(follower: Follower): { root: HTMLElement; paint: () => void } {
  const hand = h("button", { type: "button", class: "button", "aria-pressed": "false" }, t("Raise a hand"));
  hand.addEventListener("click", () => follower.raise(!follower.hand));
  const text = h("textarea", {
    class: "field",
    id: "own-question",
    rows: "2",
    maxlength: String(MOST),
    required: true,
  });
  const said = h("div", { "aria-live": "polite" });
  const form = h(
    "form",
    { class: "stack" },
    h("label", { for: "own-question" }, t("Your question; it is sent without a name")),
    text,
    h("div", { class: "row" }, h("button", { class: "button primary" }, t("Send it"))),
  );
  const asking = h(
    "details",
    { class: "voice-ask" },
    h("summary", { class: "button" }, t("Ask something")),
    form,
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    api
      .remark(follower.code, { text: text.value, voter: voter() })
      .then(() => {
        text.value = "";
        asking.open = false;
        said.replaceChildren(h("p", { class: "help" }, t("Sent. The presenter reads it first.")));
      })
      .catch((error: unknown) => said.replaceChildren(problemNotice(error)));
  });
  const shown = h("p", { class: "said-text" });
  const heard = h(
    "section",
    { class: "ballot", hidden: true, "aria-live": "polite", "aria-label": t("A question from the hall") },
    h("h2", null, t("A question from the hall")),
    shown,
  );
  const controls = h("div", { class: "row wrap voice" }, hand, asking, said);
  return {
    root: h("div", null, heard, controls),
    paint: () => {
      const remark = follower.over ? undefined : follower.lecture?.remark;
      heard.hidden = !remark;
      setText(shown, remark?.text ?? "");
      controls.hidden = follower.over;
      hand.setAttribute("aria-pressed", String(follower.hand));
      const label = follower.hand ? t("Your hand is raised") : t("Raise a hand");
      if (hand.textContent !== label) hand.replaceChildren(icon("hand"), label);
    },
  };
}
