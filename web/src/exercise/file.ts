// Questions that are answered by a file: what a program wrote, a table, a scene. Chosen from the disk or pasted.

import { api, problemOf } from "../api/client";
import type { Answer, Question } from "../api/types";
import { site } from "../core/address";
import { announce, h } from "../core/dom";
import { recall } from "../core/prefs";
import { t } from "../core/texts";
import { icon } from "../ui/icons";
import type { Inputs, QuestionContext } from "./field";

/** Largest file that the server reads, in bytes. */
const LARGEST = 1 << 20;
/** Longest text that the browser remembers. */
const LONGEST_DRAFT = 100_000;

/** Files larger than this many times what the server reads are not even opened. */
const OPENED_TIMES = 4;

const KINDS: Record<string, { label: () => string; accept: string; example: () => string }> = {
  implement: {
    label: () => t("What your program wrote (JSON or CSV)"),
    accept: ".json,.csv,.txt",
    example: () => "answer.json",
  },
  trajectory: { label: () => t("Your table (CSV)"), accept: ".csv,.txt,.tsv", example: () => t("a table") },
  model: { label: () => t("Your scene (JSON)"), accept: ".json", example: () => t("a scene") },
};

export function fileInput(question: Question, context: QuestionContext, draft: string[] | undefined): Inputs {
  const input = new FileInput(question, context, draft?.[0] ?? "");
  return { root: input.root, answer: () => input.answer(), draft: () => input.draft() };
}

class FileInput {
  readonly root: HTMLElement;
  private readonly text: HTMLTextAreaElement;
  private readonly pick: HTMLInputElement;
  private readonly status: HTMLElement;
  private readonly clear = h(
    "button",
    { type: "button", class: "button quiet small", onclick: () => this.empty() },
    t("Clear"),
  );

  constructor(question: Question, context: QuestionContext, draft: string) {
    const kind = KINDS[question.kind] ?? {
      label: () => t("Your file"),
      accept: "",
      example: () => t("a file"),
    };
    const { base, described } = context;
    this.text = h("textarea", {
      id: `${base}-text`,
      class: "field file-text",
      rows: question.kind === "model" ? "10" : "5",
      spellcheck: "false",
      autocapitalize: "off",
      autocomplete: "off",
      "aria-label": context.named(kind.label()),
      "aria-describedby": `${described} ${base}-status`,
      placeholder: t("Paste {example} here, or choose a file", { example: kind.example() }),
    });
    this.text.value = draft;
    this.pick = h("input", {
      type: "file",
      id: `${base}-file`,
      accept: kind.accept,
      "aria-label": context.named(t("Choose a file: {label}", { label: kind.label() })),
    });
    this.status = h("p", { class: "file-status", id: `${base}-status`, role: "status" });
    this.root = h(
      "div",
      { class: "answer is-file" },
      ...handouts(question, context),
      h(
        "div",
        { class: "file-pick" },
        this.pick,
        ...this.editorScenes(question, context),
        ...this.runsTable(question, context),
        this.clear,
      ),
      this.text,
      this.status,
    );
    this.listen();
    this.showStatus();
  }

  /** What stands in this browser's editors goes into the field without the detour by the disk. */
  private editorScenes(question: Question, { slug }: QuestionContext): HTMLElement[] {
    if (question.kind !== "model") return [];
    const kept = [
      [t("Hand in my own scene from the editor"), recall("scene-draft")],
      [t("Hand in this lesson’s scene as I changed it"), recall(`scene-draft:${slug}`)],
    ] as const;
    return kept.flatMap(([label, text]) =>
      text
        ? [
            h(
              "button",
              { type: "button", class: "button small", onclick: () => this.fill(text, t("a scene")) },
              label,
            ),
          ]
        : [],
    );
  }

  /** What the run beside the questions shows goes into the field as the table that is asked for; only a server writes it. */
  private runsTable(question: Question, context: QuestionContext): HTMLElement[] {
    if (question.kind !== "trajectory" || site) return [];
    const button = h("button", { type: "button", class: "button small" }, t("Hand in this run’s table"));
    button.addEventListener("click", () => {
      button.disabled = true;
      void this.takeTable(question, context).finally(() => {
        button.disabled = false;
      });
    });
    return [button];
  }

  private async takeTable({ id }: Question, { slug, run }: QuestionContext): Promise<void> {
    const own = run();
    if (!own) {
      this.say(t("The mechanism beside the text has not started yet: try again in a moment."), true);
      return;
    }
    this.say(t("The scene with the numbers that it has now is run from its start to its end."), false);
    try {
      this.fill(
        await api.askedTable(slug, id, own.scene),
        own.altered
          ? t("the table of a run with these numbers from its start, as this one was changed on its way")
          : t("this run’s table"),
      );
    } catch (error) {
      const { title, detail, hint } = problemOf(error);
      this.say([detail ?? title, hint].filter(Boolean).join(" "), true);
    }
  }

  private say(text: string, bad: boolean): void {
    this.status.classList.toggle("is-bad", bad);
    this.status.textContent = text;
  }

  answer(): Answer {
    return { file: this.text.value };
  }

  draft(): string[] {
    return [this.text.value.length > LONGEST_DRAFT ? "" : this.text.value];
  }

  private listen(): void {
    this.pick.addEventListener("change", () => void this.load(this.pick.files?.[0]));
    this.text.addEventListener("input", () => this.showStatus());
    this.root.addEventListener("dragover", (event) => event.preventDefault());
    this.root.addEventListener("drop", (event) => {
      event.preventDefault();
      void this.load(event.dataTransfer?.files[0]);
    });
  }

  /** How large the text is, and whether it is too large. */
  private showStatus(name?: string): void {
    const text = this.text.value;
    const bytes = new Blob([text]).size;
    const large = bytes > LARGEST;
    this.text.toggleAttribute("aria-invalid", large);
    this.status.classList.toggle("is-bad", large);
    this.clear.hidden = text === "";
    const lines = t("{n} line | {n} lines", { n: text.trim().split("\n").length });
    if (!text.trim()) this.status.textContent = "";
    else if (large)
      this.status.textContent = t("{size}: too large. At most {most} are read; write fewer rows or digits.", {
        size: size(bytes),
        most: size(LARGEST),
      });
    else this.status.textContent = `${name ? `${name}, ` : ""}${size(bytes)}, ${lines}`;
  }

  private async load(file: File | undefined): Promise<void> {
    if (!file) return;
    if (file.size > OPENED_TIMES * LARGEST) {
      this.status.classList.add("is-bad");
      this.status.textContent = t("{name} has {size}: too large. At most {most} are read.", {
        name: file.name,
        size: size(file.size),
        most: size(LARGEST),
      });
      return;
    }
    this.fill(await file.text(), file.name);
  }

  private fill(text: string, name: string): void {
    this.text.value = text;
    announce(t("{name} is in the field.", { name }));
    this.text.dispatchEvent(new Event("input", { bubbles: true }));
    this.showStatus(name);
  }

  private empty(): void {
    this.text.value = "";
    this.pick.value = "";
    this.text.dispatchEvent(new Event("input", { bubbles: true }));
    this.text.focus();
  }
}

const size = (bytes: number): string =>
  bytes < 2048
    ? t("{bytes} bytes", { bytes })
    : bytes < 2 << 20
      ? t("{bytes} KiB", { bytes: Math.round(bytes / 1024) })
      : t("{bytes} MiB", { bytes: (bytes / (1 << 20)).toFixed(1) });

/** What the student needs before anything can be handed in: states, starters, the columns of the table. */
function handouts(question: Question, { slug, seed }: QuestionContext): HTMLElement[] {
  if (question.kind === "implement") {
    const link = (href: string, name: string, text: string): HTMLElement =>
      h("a", { href, download: name, class: "button small" }, icon("save"), text);
    return [
      h(
        "div",
        { class: "handed-out" },
        link(api.statesUrl(slug, question.id, seed), "states.json", seed ? t("Your states") : t("States")),
        h("span", { class: "handed-label" }, t("Starter:")),
        link(api.starterUrl(slug, question.id, "python"), "starter.py", "Python"),
        link(api.starterUrl(slug, question.id, "octave"), "starter.m", "MATLAB / Octave"),
        link(api.starterUrl(slug, question.id, "julia"), "starter.jl", "Julia"),
      ),
    ];
  }
  if (question.kind === "trajectory" && question.columns) {
    return [
      h(
        "dl",
        { class: "columns" },
        h("dt", null, "t"),
        h("dd", null, t("time, s")),
        ...question.columns.flatMap((column) => [h("dt", null, column.name), h("dd", null, column.what)]),
      ),
    ];
  }
  return [];
}
