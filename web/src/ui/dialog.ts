// A dialog over the page: closed by Escape, by its cross, or by a click beside it.

import { h } from "../core/dom";
import { t } from "../core/texts";
import { icon } from "./icons";

export function dialog(title: string, ...children: HTMLElement[]): HTMLDialogElement {
  const box = h(
    "dialog",
    { class: "dialog", "aria-labelledby": "dialog-title" },
    h(
      "div",
      { class: "dialog-head" },
      h("h2", { id: "dialog-title" }, title),
      h(
        "button",
        {
          type: "button",
          class: "header-button square",
          "aria-label": t("Close"),
          onclick: () => box.close(),
        },
        icon("close"),
      ),
    ),
    ...children,
  );
  box.addEventListener("close", () => box.remove());
  box.addEventListener("click", (event) => {
    if (event.target === box) box.close();
  });
  document.body.append(box);
  box.showModal();
  return box;
}
