// Tells where the run is computed, and lets one choose.

import { canChoosePlace, computedHere, computeHere } from "../api/place";
import { announce, h } from "../core/dom";
import { t } from "../core/texts";

const about = (): string =>
  t(
    "Where the run is computed. Here: by the engine in this page, without the server; its last digits differ. Answers are always checked by the server's own runs.",
  );

/** A choice where there is one, and a word where there is only this page. */
export function placeMenu(): HTMLElement | null {
  if (!canChoosePlace())
    return computedHere() ? h("span", { class: "help", title: about() }, t("Computed here")) : null;
  const choice = h(
    "select",
    { class: "field compact", id: "computed", "aria-label": t("Where the run is computed"), title: about() },
    h("option", { value: "server", selected: !computedHere() }, t("On the server")),
    h("option", { value: "here", selected: computedHere() }, t("Computed here")),
  );
  choice.addEventListener("change", () => {
    computeHere(choice.value === "here");
    // Every part of the page holds on to its run: it begins again with another.
    location.reload();
  });
  // The menu lives as long as the page's view of the run; a word to one that has gone changes nothing.
  addEventListener(
    "triad:place",
    () => {
      choice.value = "here";
      const full = t("All places of the server are in use: this page computes the run itself.");
      choice.title = `${full} ${about()}`;
      announce(full);
    },
    { once: true },
  );
  return choice;
}
