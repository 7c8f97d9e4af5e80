// A list of what fits at the cursor, beside the text: arrows choose, Enter or Tab writes, Escape closes.

import { api } from "../api/client";
import { h, uid } from "../core/dom";
import { t } from "../core/texts";
import { type Completion, complete, type Offer } from "./schema";

/** Suggestions that are shown at a time. */
const MAX_OFFERS = 12;

/** The list beside a text; `written` is called when a suggestion has been written into it. */
export function suggestions(area: HTMLTextAreaElement, written: () => void): HTMLElement {
  return new Suggestions(area, written).root;
}

class Suggestions {
  readonly root: HTMLElement;
  private readonly id = uid("suggest");
  private schema: unknown;
  private requested = false;
  private shown: Completion | undefined;
  /** Index of the suggestion that is marked. */
  private at = 0;

  constructor(
    private readonly area: HTMLTextAreaElement,
    private readonly written: () => void,
  ) {
    this.root = h("ul", {
      class: "suggest",
      id: this.id,
      role: "listbox",
      "aria-label": t("What fits here"),
      hidden: true,
    });
    area.setAttribute("aria-controls", this.id);
    area.setAttribute("aria-autocomplete", "list");
    area.addEventListener("keydown", (event) => this.press(event));
    area.addEventListener("input", (event) => {
      const typed = (event as InputEvent).data;
      // A list appears where a word begins or goes on; elsewhere it would be in the way.
      if (typed !== null && typed !== undefined && /["\w-]/.test(typed)) this.open();
      else this.close();
    });
    area.addEventListener("blur", () => this.close());
    area.addEventListener("scroll", () => this.close());
  }

  private press(event: KeyboardEvent): void {
    const { key } = event;
    if (key === " " && event.ctrlKey) {
      event.preventDefault();
      this.open();
      return;
    }
    if (!this.shown) return;
    const count = this.shown.offers.length;
    if (key === "ArrowDown") this.mark((this.at + 1) % count);
    else if (key === "ArrowUp") this.mark((this.at - 1 + count) % count);
    else if (key === "Enter" || key === "Tab") this.write(this.at);
    else if (key === "Escape") this.close();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private open(): void {
    const { area } = this;
    if (!this.schema) {
      this.requestSchema();
      return;
    }
    const found =
      area.selectionStart === area.selectionEnd
        ? complete(this.schema, area.value, area.selectionStart)
        : undefined;
    if (!found) {
      this.close();
      return;
    }
    this.shown = { ...found, offers: found.offers.slice(0, MAX_OFFERS) };
    this.root.replaceChildren(...this.shown.offers.map((offer, k) => this.option(offer, k)));
    this.root.hidden = false;
    place(this.root, area);
    this.mark(0);
  }

  private requestSchema(): void {
    if (this.requested) return;
    this.requested = true;
    void api
      .sceneSchema()
      .then((schema) => {
        this.schema = schema;
        this.open();
      })
      .catch(() => {
        // Without the schema there are no suggestions; the check finds what is wrong all the same.
        this.requested = false;
      });
  }

  private option(offer: Offer, k: number): HTMLElement {
    return h(
      "li",
      {
        role: "option",
        id: `${this.id}-${k}`,
        onpointerdown: (event: PointerEvent) => {
          event.preventDefault();
          this.write(k);
        },
      },
      h("code", null, offer.text),
      h("span", null, offer.about),
    );
  }

  private mark(to: number): void {
    this.at = to;
    [...this.root.children].forEach((child, k) => {
      child.setAttribute("aria-selected", String(k === to));
      if (k === to) child.scrollIntoView({ block: "nearest" });
    });
    this.area.setAttribute("aria-activedescendant", `${this.id}-${to}`);
  }

  private write(k: number): void {
    const offer = this.shown?.offers[k];
    if (!this.shown || !offer) return;
    this.area.setRangeText(offer.text, this.shown.from, this.shown.to, "end");
    this.close();
    this.written();
  }

  private close(): void {
    this.shown = undefined;
    this.root.hidden = true;
    this.area.removeAttribute("aria-activedescendant");
  }
}

/** Width of the line numbers, px. */
const GUTTER = 48;
/** Height that the list may need, px. */
const LIST_HEIGHT = 160;
/** Width that the list needs to be read, px. */
const LIST_WIDTH = 240;

/** Below the line of the cursor, within the box. */
function place(list: HTMLElement, area: HTMLTextAreaElement): void {
  const before = area.value.slice(0, area.selectionStart);
  const line = before.split("\n").length;
  const column = before.length - before.lastIndexOf("\n") - 1;
  const css = getComputedStyle(area);
  const height = Number.parseFloat(css.lineHeight) || 20;
  const wide = Number.parseFloat(css.fontSize) * 0.6;
  const top = Number.parseFloat(css.paddingTop) + line * height - area.scrollTop;
  const left = GUTTER + column * wide - area.scrollLeft;
  list.style.insetBlockStart = `${Math.min(top, Math.max(0, area.clientHeight - LIST_HEIGHT))}px`;
  list.style.insetInlineStart = `${Math.max(0, Math.min(left, area.clientWidth - LIST_WIDTH))}px`;
}
