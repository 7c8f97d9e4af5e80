// How the picture, the numbers and the text share the window: lines that are dragged, and the numbers over the whole width.

import { announce, h } from "../core/dom";
import { bind } from "../core/keys";
import { t } from "../core/texts";
import { Divider } from "../ui/divider";
import { icon } from "../ui/icons";

/** The line between picture and inspector, and the inspector's button for the whole width. */
export function sharing(
  bench: HTMLElement,
  stage: HTMLElement,
  inspector: HTMLElement,
): { divider: HTMLElement; dispose: () => void } {
  const isBeside = (): boolean => getComputedStyle(bench).display === "grid";
  const divider = new Divider({
    label: t("Size of the picture"),
    divided: () => (isBeside() ? "beside" : "picture"),
    first: stage,
    whole: () => {
      if (isBeside()) {
        const { left, width } = bench.getBoundingClientRect();
        return { start: left, size: width };
      }
      const header = document.getElementById("header")?.offsetHeight ?? 0;
      return { start: stage.getBoundingClientRect().top, size: innerHeight - header };
    },
  });
  const toggle = (): void => {
    const wide = bench.classList.toggle("is-wide");
    button.setAttribute("aria-pressed", String(wide));
    title.hidden = !wide;
    title.textContent = document.title;
    divider.tell();
    announce(
      wide
        ? t("The inspector has the whole width; the text is hidden.")
        : t("The text stands beside the mechanism again."),
    );
  };
  const button = h(
    "button",
    {
      type: "button",
      class: "button quiet small icon-only inspector-wide",
      "aria-label": t("Inspector over the whole width"),
      title: t("Inspector over the whole width (W)"),
      "aria-pressed": "false",
      onclick: toggle,
    },
    icon("wide"),
  );
  // The heading of the page is hidden with the text: this one is read out in its place.
  const title = h("h1", { class: "visually-hidden", hidden: true });
  if (bench.closest(".lesson")) inspector.prepend(title);
  inspector.prepend(button);
  bench.classList.remove("is-wide");
  const undo = bind([
    {
      keys: ["w", "W"],
      shown: "W",
      does: t("Inspector over the whole width, or beside the text"),
      run: toggle,
    },
  ]);
  return {
    divider: divider.root,
    dispose: () => {
      undo();
      divider.dispose();
    },
  };
}
