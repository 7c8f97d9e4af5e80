// Other words for somebody who lost theirs.

import { api } from "../api/client";
import { h } from "../core/dom";
import { t } from "../core/texts";
import { dialog } from "../ui/dialog";
import { problemNotice } from "../ui/notice";

export function renewWords(id: string, name: string): void {
  const told = h("p", { class: "four-words", "aria-live": "polite" });
  const button = h("button", { type: "button", class: "button primary" }, t("Make new words"));
  button.addEventListener("click", () => {
    api
      .newWords(id)
      .then((fresh) => {
        told.textContent = fresh.words;
        button.remove();
      })
      .catch((error: unknown) => told.replaceChildren(problemNotice(error)));
  });
  dialog(
    t("New words for {name}", { name }),
    h(
      "p",
      null,
      t("The words and the link of before are worth nothing then, and their browsers are signed out."),
    ),
    told,
    h("div", { class: "row" }, button),
  );
}
