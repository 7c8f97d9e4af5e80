// Questions that are answered by a file: what a program wrote, a table, a scene. Chosen from the disk or pasted.
import { api } from "../api/client";
import type { Question } from "../api/types";
import { announce, h } from "../core/dom";
import { plural } from "../core/format";
import { icon } from "../ui/icons";
import type { Inputs, QuestionContext } from "./field";

/** Largest file that the server reads, in bytes. */
const LARGEST = 1 << 20;
/** Longest text that the browser remembers. */
const LONGEST_DRAFT = 100_000;

const ASKED: Record<string, { label: string; accept: string; say: string }> = {
  implement: {
    label: "What your program wrote (JSON or CSV)",
    accept: ".json,.csv,.txt",
    say: "answer.json",
  },
  trajectory: { label: "Your table (CSV)", accept: ".csv,.txt,.tsv", say: "a table" },
  model: { label: "Your scene (JSON)", accept: ".json", say: "a scene" },
};

export function fileInput(question: Question, place: QuestionContext, draft: string[] | undefined): Inputs {
  const kind = ASKED[question.kind] ?? { label: "Your file", accept: "", say: "a file" };
  const { base } = place;
  const text = h("textarea", {
    id: `${base}-text`,
    class: "field file-text",
    rows: question.kind === "model" ? "10" : "5",
    spellcheck: "false",
    autocapitalize: "off",
    autocomplete: "off",
    "aria-label": kind.label,
    "aria-describedby": `${place.described} ${base}-told`,
    placeholder: `Paste ${kind.say} here, or choose a file`,
  });
  text.value = draft?.[0] ?? "";
  const pick = h("input", {
    type: "file",
    id: `${base}-file`,
    accept: kind.accept,
    "aria-label": `Choose a file: ${kind.label}`,
  });
  const status = h("p", { class: "file-told", id: `${base}-told`, role: "status" });
  const clear = h("button", { type: "button", class: "button quiet small" }, "Clear");

  const tell = (name?: string): void => {
    const bytes = new Blob([text.value]).size;
    const large = bytes > LARGEST;
    text.toggleAttribute("aria-invalid", large);
    status.classList.toggle("is-bad", large);
    status.textContent = !text.value.trim()
      ? ""
      : large
        ? `${size(bytes)}: too large. At most ${size(LARGEST)} are read; write fewer rows or digits.`
        : `${name ? `${name}, ` : ""}${size(bytes)}, ${plural(text.value.trim().split("\n").length, "line")}`;
    clear.hidden = text.value === "";
  };
  const take = async (file: File | undefined): Promise<void> => {
    if (!file) return;
    if (file.size > 4 * LARGEST) {
      status.classList.add("is-bad");
      status.textContent = `${file.name} has ${size(file.size)}: too large. At most ${size(LARGEST)} are read.`;
      return;
    }
    text.value = await file.text();
    tell(file.name);
    announce(`${file.name} is in the field.`);
    text.dispatchEvent(new Event("input", { bubbles: true }));
    tell(file.name);
  };
  pick.addEventListener("change", () => void take(pick.files?.[0]));
  text.addEventListener("input", () => tell());
  clear.addEventListener("click", () => {
    text.value = "";
    pick.value = "";
    text.dispatchEvent(new Event("input", { bubbles: true }));
    text.focus();
  });
  const root = h(
    "div",
    { class: "answer is-file" },
    ...before(question, place),
    h("div", { class: "file-pick" }, pick, clear),
    text,
    status,
  );
  root.addEventListener("dragover", (event) => event.preventDefault());
  root.addEventListener("drop", (event) => {
    event.preventDefault();
    void take(event.dataTransfer?.files[0]);
  });
  tell();
  return {
    root,
    answer: () => ({ file: text.value }),
    draft: () => [text.value.length > LONGEST_DRAFT ? "" : text.value],
  };
}

const size = (bytes: number): string =>
  bytes < 2048
    ? `${bytes} bytes`
    : bytes < 2 << 20
      ? `${Math.round(bytes / 1024)} KiB`
      : `${(bytes / (1 << 20)).toFixed(1)} MiB`;

/** What is handed out before anything can be handed in. */
function before(question: Question, { slug, seed }: QuestionContext): HTMLElement[] {
  if (question.kind === "implement") {
    const link = (href: string, name: string, text: string): HTMLElement =>
      h("a", { href, download: name, class: "button small" }, icon("save"), text);
    return [
      h(
        "div",
        { class: "handed-out" },
        link(api.statesUrl(slug, question.id, seed), "states.json", seed ? "Your states" : "States"),
        h("span", { class: "handed-label" }, "Starter:"),
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
        h("dd", null, "time, s"),
        ...question.columns.flatMap((column) => [h("dt", null, column.name), h("dd", null, column.what)]),
      ),
    ];
  }
  return [];
}
