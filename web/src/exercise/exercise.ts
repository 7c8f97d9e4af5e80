// The exercise of a lesson: questions as a form, verdicts, and all earlier submissions.

import { api, problemOf } from "../api/client";
import type { Answer, GradedSubmission, Lesson } from "../api/types";
import { addressOf, site } from "../core/address";
import { announce, authored, h, saveFile } from "../core/dom";
import { points } from "../core/format";
import { setMaths } from "../core/maths";
import { student } from "../core/prefs";
import { parts, t } from "../core/texts";
import { problemNotice } from "../ui/notice";
import { setStudent } from "../ui/shell";
import { DraftStore } from "./drafts";
import type { OwnRun } from "./field";
import { type HistoryList, historyList } from "./history";
import { type QuestionField, questionField } from "./question";
import { verdictSummary } from "./verdict";

/** Marks of what needs no more work. */
const DONE = new Set<string | undefined | null>(["right", "kept"]);
/** Label of the button that hands the answers in. */
const check = (): string => t("Check my answers");
/** The file that courses on other systems take: see `triad export`. */
const FILE = "answers.json";

/** Fills `root`; the returned function undoes what outlives it. */
export function exerciseSection(
  root: HTMLElement,
  lesson: Lesson,
  run: () => OwnRun | undefined,
): () => void {
  if (lesson.exercise.questions.length === 0) return () => undefined;
  const section = new ExerciseSection(lesson, run);
  root.append(...section.parts());
  return () => section.dispose();
}

/** What stands in place of the button on a site of files. */
const unchecked = (): HTMLElement =>
  h(
    "p",
    { class: "notice", id: "unchecked" },
    t(
      "This copy of the course has no server: answers are neither checked nor kept here. Open the lesson on your class's server to hand them in, or run “triad” on your own machine to have them checked.",
    ),
  );

class ExerciseSection {
  private readonly draft: DraftStore;
  private readonly fields: QuestionField[];
  private readonly name = h("input", {
    id: "student",
    class: "field",
    autocomplete: "name",
    maxlength: "80",
    required: true,
    value: student.get(),
  });
  private readonly send = h("button", { class: "button primary" }, check());
  private readonly save = h(
    "button",
    {
      class: "button",
      type: "button",
      title: t("For courses that collect answers elsewhere, as {file}", { file: FILE }),
    },
    t("Save as a file"),
  );
  private readonly outcome = h("div", { class: "outcome", tabindex: "-1" });
  private readonly history: HistoryList;
  private readonly form: HTMLFormElement;
  /** What was sent and not yet answered, with the name of the request: sent again, it is the same request. */
  private sent: { text: string; name: string } | undefined;
  /** Follows a change of the name, from whichever part of the page. */
  private readonly renamed = (): void => {
    if (document.activeElement !== this.name) this.name.value = student.get();
    void this.history.load();
  };

  constructor(
    private readonly lesson: Lesson,
    run: () => OwnRun | undefined,
  ) {
    this.draft = new DraftStore(lesson);
    this.fields = lesson.exercise.questions.map((question, at) =>
      questionField(
        lesson,
        question,
        at + 1,
        this.draft.of(question.id),
        () => this.draft.save(this.fields),
        run,
      ),
    );
    this.draft.begin(this.fields);
    this.history = historyList(lesson);
    this.form = this.layout();
    this.form.addEventListener("submit", (event) => {
      event.preventDefault();
      void this.submit();
    });
    this.save.addEventListener("click", () => this.saveAnswers());
    this.name.addEventListener("change", () => setStudent(this.name.value));
    addEventListener("triad:student", this.renamed);
    void this.history.load();
  }

  parts(): HTMLElement[] {
    const { questions, pass_mark: passMark } = this.lesson.exercise;
    const sum = (byPeople: boolean): number =>
      questions
        .filter((question) => (question.kind === "explanation") === byPeople)
        .reduce((sum, question) => sum + question.points, 0);
    const toPass = passMark ? `; ${t("{points} to pass", { points: points(passMark * sum(false)) })}` : "";
    const read =
      sum(true) > 0 ? `; ${t("{points} more that a teacher gives", { points: points(sum(true)) })}` : "";
    return [
      h(
        "div",
        { class: "section-head" },
        h("h2", null, t("Exercise")),
        h(
          "p",
          null,
          `${t("{n} question | {n} questions", { n: questions.length })}, ${t("{n} point | {n} points", { n: sum(false) })}${toPass}${read}`,
        ),
      ),
      whose(this.lesson),
      conventions(this.lesson),
      this.form,
      site ? null : this.history.root,
    ].filter((part) => part !== null);
  }

  dispose(): void {
    removeEventListener("triad:student", this.renamed);
  }

  private layout(): HTMLFormElement {
    return h(
      "form",
      { class: "questions", novalidate: true },
      ...this.fields.map((field) => field.root),
      site
        ? unchecked()
        : h(
            "div",
            { class: "send" },
            student.known()
              ? account()
              : h("div", { class: "send-name" }, h("label", { for: "student" }, t("Your name")), this.name),
            this.send,
            this.save,
          ),
      this.lesson.exercise.opens ? h("p", { class: "opens" }, this.lesson.exercise.opens) : null,
      this.outcome,
    );
  }

  private async submit(): Promise<void> {
    const who = this.name.value.trim();
    const { has_variants: hasVariants, seed } = this.lesson;
    if (student.known() && !who) location.assign(addressOf("/join"));
    else if (!who) this.demandName();
    else if (hasVariants && seed !== who) this.changeVariant(who);
    else {
      setStudent(who);
      await this.grade(who);
    }
  }

  private demandName(): void {
    this.outcome.replaceChildren(
      problemNotice({
        title: t("Who is answering?"),
        detail: t("Your submission is stored under your name."),
        hint: t("Write your name next to the button."),
      }),
    );
    this.name.focus();
  }

  /** Loads the lesson again with the numbers of that name. */
  private changeVariant(who: string): void {
    announce(t("{who}, these are your own numbers now. Look at your answers, then check them.", { who }));
    // The name may be the one that is known already, from another page.
    if (student.get() === who) dispatchEvent(new Event("triad:student"));
    setStudent(who);
  }

  /** What would be handed in. */
  private body(who: string): { student: string; seed?: string; answers: Record<string, Answer> } {
    const { has_variants: hasVariants, seed } = this.lesson;
    const answers = Object.fromEntries(this.fields.map((field) => [field.id, field.answer()]));
    return hasVariants ? { student: who, seed, answers } : { student: who, answers };
  }

  /** Saves what would be handed in, for the name that is written beside the button. */
  private saveAnswers(): void {
    const who = this.name.value.trim();
    const { has_variants: hasVariants, seed } = this.lesson;
    if (who && hasVariants && seed !== who && !student.known()) {
      this.changeVariant(who);
      return;
    }
    saveFile(new Blob([`${JSON.stringify(this.body(who), null, 2)}\n`], { type: "application/json" }), FILE);
    announce(t("Your answers are saved as {file}.", { file: FILE }));
  }

  private async grade(who: string): Promise<void> {
    const { slug } = this.lesson;
    this.send.disabled = true;
    this.send.textContent = t("Checking…");
    try {
      const body = this.body(who);
      const text = JSON.stringify(body);
      if (this.sent?.text !== text) this.sent = { text, name: requestName() };
      const verdict = await api.submit(slug, body, this.sent.name, (before) => {
        this.send.textContent =
          before > 0 ? t("Waiting, {before} before you…", { before }) : t("Being graded…");
      });
      this.sent = undefined;
      await this.showVerdict(verdict, body.answers);
      this.history.add(verdict);
    } catch (error) {
      this.outcome.replaceChildren(problemNotice(error));
      announce(problemOf(error).title);
    } finally {
      this.send.disabled = false;
      this.send.textContent = check();
    }
  }

  private async showVerdict(verdict: GradedSubmission, sent: Record<string, Answer>): Promise<void> {
    const byId = new Map(verdict.questions.map((question) => [question.id, question]));
    for (const field of this.fields) field.show(byId.get(field.id), sent[field.id] ?? {});
    this.outcome.replaceChildren(verdictSummary(verdict));
    await setMaths(this.form);
    this.outcome.focus({ preventScroll: true });
    const wrong = this.fields.find((field) => !DONE.has(byId.get(field.id)?.verdict));
    (wrong?.root ?? this.outcome).scrollIntoView({ block: "nearest" });
  }
}

/** Who hands in, where the server knows. */
function account(): HTMLElement {
  const name = student.get();
  return h(
    "p",
    { class: "send-name" },
    name ? t("Handed in by {name}", { name }) : t("Join your class to hand in"),
  );
}

/** A name that no other request has. Browsers make UUIDs only where the connection is encrypted. */
function requestName(): string {
  return Array.from(crypto.getRandomValues(new Uint8Array(16)), (byte) =>
    byte.toString(16).padStart(2, "0"),
  ).join("");
}

/** What the scene takes for granted: axes, gravity, masses, positive senses. */
function conventions(lesson: Lesson): HTMLElement | null {
  const html = lesson.exercise.conventions_html;
  return html
    ? h("aside", { class: "conventions", "aria-label": t("Conventions") }, authored(h("div"), html))
    : null;
}

/** Says whose numbers these are; without a name, asks for one. */
function whose(lesson: Lesson): HTMLElement | null {
  if (!lesson.has_variants) return null;
  if (lesson.seed)
    return h(
      "p",
      { class: "whose" },
      ...parts("These are the numbers of {name}. Everybody has their own.", {
        name: h("b", null, lesson.seed),
      }),
    );
  if (student.known())
    return h(
      "p",
      { class: "whose" },
      ...parts("{join} to see your own numbers.", {
        join: h("a", { href: "/join" }, t("Join your class")),
      }),
    );
  const name = h("input", { id: "whose", class: "field", autocomplete: "name", maxlength: "80" });
  const form = h(
    "form",
    { class: "whose" },
    h("label", { for: "whose" }, t("Everybody has their own numbers in this exercise. Your name:")),
    name,
    h("button", { class: "button small" }, t("Show my numbers")),
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    if (name.value.trim()) setStudent(name.value);
    else name.focus();
  });
  return form;
}
