// A list of what fits at the cursor, beside the text: arrows choose, Enter or Tab writes, Escape closes.
import { api } from "../api/client";
import { h, uid } from "../core/dom";
import { type Completion, complete } from "./schema";

const MAX_STATES = 12;

export function suggestions(area: HTMLTextAreaElement, written: () => void): HTMLElement {
  const id = uid("suggest");
  const list = h("ul", {
    class: "suggest",
    id,
    role: "listbox",
    "aria-label": "What fits here",
    hidden: true,
  });
  let schema: unknown;
  let requested = false;
  let shown: Completion | undefined;
  let at = 0;

  area.setAttribute("aria-controls", id);
  area.setAttribute("aria-autocomplete", "list");
  const close = (): void => {
    shown = undefined;
    list.hidden = true;
    area.removeAttribute("aria-activedescendant");
  };
  const mark = (to: number): void => {
    at = to;
    [...list.children].forEach((child, k) => {
      child.setAttribute("aria-selected", String(k === at));
      if (k === at) child.scrollIntoView({ block: "nearest" });
    });
    area.setAttribute("aria-activedescendant", `${id}-${at}`);
  };
  const write = (k: number): void => {
    const offer = shown?.offers[k];
    if (!shown || !offer) return;
    area.setRangeText(offer.text, shown.from, shown.to, "end");
    close();
    written();
  };
  const open = (): void => {
    if (!schema) {
      if (!requested)
        void api
          .sceneSchema()
          .then((found) => {
            schema = found;
            open();
          })
          .catch(() => {
            // Without the schema one types without help; the check says what is wrong all the same.
            requested = false;
          });
      requested = true;
      return;
    }
    const found =
      area.selectionStart === area.selectionEnd
        ? complete(schema, area.value, area.selectionStart)
        : undefined;
    if (!found) {
      close();
      return;
    }
    shown = { ...found, offers: found.offers.slice(0, MAX_STATES) };
    list.replaceChildren(
      ...shown.offers.map((offer, k) =>
        h(
          "li",
          {
            role: "option",
            id: `${id}-${k}`,
            onpointerdown: (event: PointerEvent) => {
              event.preventDefault();
              write(k);
            },
          },
          h("code", null, offer.text),
          h("span", null, offer.about),
        ),
      ),
    );
    list.hidden = false;
    place(list, area);
    mark(0);
  };
  area.addEventListener("keydown", (event) => {
    if (event.key === " " && event.ctrlKey) {
      event.preventDefault();
      open();
      return;
    }
    if (!shown) return;
    if (event.key === "ArrowDown" || event.key === "ArrowUp")
      mark((at + (event.key === "ArrowDown" ? 1 : -1) + shown.offers.length) % shown.offers.length);
    else if (event.key === "Enter" || event.key === "Tab") write(at);
    else if (event.key === "Escape") close();
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  area.addEventListener("input", (event) => {
    const typed = (event as InputEvent).data;
    // A list appears where a word begins or goes on; elsewhere it would be in the way.
    if (typed !== null && typed !== undefined && /["\w-]/.test(typed)) open();
    else close();
  });
  area.addEventListener("blur", close);
  area.addEventListener("scroll", close);
  return list;
}

/** Below the line of the cursor, within the box. */
function place(list: HTMLElement, area: HTMLTextAreaElement): void {
  const before = area.value.slice(0, area.selectionStart);
  const line = before.split("\n").length;
  const column = before.length - before.lastIndexOf("\n") - 1;
  const css = getComputedStyle(area);
  const height = Number.parseFloat(css.lineHeight) || 20;
  const wide = Number.parseFloat(css.fontSize) * 0.6;
  const top = Number.parseFloat(css.paddingTop) + line * height - area.scrollTop;
  list.style.insetBlockStart = `${Math.min(top, Math.max(0, area.clientHeight - 160))}px`;
  list.style.insetInlineStart = `${Math.max(0, Math.min(48 + column * wide - area.scrollLeft, area.clientWidth - 240))}px`;
}
