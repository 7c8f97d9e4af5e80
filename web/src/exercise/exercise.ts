// The exercise of a lesson: questions as a form, verdicts, and all earlier submissions.
import { api, problemOf } from "../api/client";
import type { GradedSubmission, Lesson } from "../api/types";
import { announce, h } from "../core/dom";
import { plural, points } from "../core/format";
import { setMaths } from "../core/maths";
import { recall, remember, student } from "../core/prefs";
import { problemNotice } from "../ui/notice";
import { setStudent } from "../ui/shell";
import { historyList } from "./history";
import { type QuestionField, questionField } from "./question";
import { verdictSummary } from "./verdict";

/** Fills `root`; the returned function undoes what outlives it. */
export function exerciseSection(root: HTMLElement, lesson: Lesson): () => void {
  const { questions } = lesson.exercise;
  if (questions.length === 0) return () => undefined;
  const total = questions.reduce((sum, question) => sum + question.points, 0);
  // Answers belong to the numbers that they are about.
  const draftKey: `draft:${string}` =
    lesson.has_variants && lesson.seed ? `draft:${lesson.slug}:${lesson.seed}` : `draft:${lesson.slug}`;
  const draft = readDraft(recall(draftKey));
  let ready = false;

  const saveDraft = (): void => {
    const values: Record<string, string[]> = {};
    // Hints that are being opened again must not be forgotten meanwhile.
    if (!ready) return;
    for (const field of fields) {
      values[field.id] = field.draft();
      const opened = Math.max(field.hints(), Number(draft[`${field.id}#hints`]?.[0] ?? 0));
      if (opened > 0) values[`${field.id}#hints`] = [String(opened)];
    }
    remember(draftKey, JSON.stringify(values));
  };
  const fields: QuestionField[] = questions.map((question, at) =>
    questionField(
      lesson,
      question,
      at + 1,
      { draft: draft[question.id], hints: Number(draft[`${question.id}#hints`]?.[0] ?? 0) },
      saveDraft,
    ),
  );
  ready = true;

  const name = h("input", {
    id: "student",
    class: "field",
    autocomplete: "name",
    maxlength: "80",
    required: true,
    value: student.get(),
  });
  const send = h("button", { class: "button primary" }, "Check my answers");
  const outcome = h("div", { class: "outcome", tabindex: "-1" });
  const past = historyList(lesson);
  const form = h(
    "form",
    { class: "questions", novalidate: true },
    ...fields.map((field) => field.root),
    h(
      "div",
      { class: "send" },
      h("div", { class: "send-name" }, h("label", { for: "student" }, "Your name"), name),
      send,
    ),
    outcome,
  );

  const submit = async (): Promise<void> => {
    const who = name.value.trim();
    if (!who) {
      outcome.replaceChildren(
        problemNotice({
          title: "Who is answering?",
          detail: "Your submission is stored under your name.",
          hint: "Write your name next to the button.",
        }),
      );
      name.focus();
      return;
    }
    if (lesson.has_variants && lesson.seed !== who) {
      // The lesson is loaded again with the numbers of that name; what was typed stays for comparison.
      rememberFor(lesson, who, recall(draftKey));
      announce(`${who}, these are your own numbers now. Look at your answers, then check them.`);
      // The name may be the one that is known already, from another page.
      if (student.get() === who) dispatchEvent(new Event("triad:student"));
      setStudent(who);
      return;
    }
    setStudent(who);
    send.disabled = true;
    send.textContent = "Checking…";
    try {
      const answers = Object.fromEntries(fields.map((field) => [field.id, field.answer()]));
      const verdict = await api.submit(
        lesson.slug,
        who,
        answers,
        lesson.has_variants ? lesson.seed : undefined,
      );
      await showVerdict(verdict);
      past.add(verdict);
    } catch (error) {
      outcome.replaceChildren(problemNotice(error));
      announce(problemOf(error).title);
    } finally {
      send.disabled = false;
      send.textContent = "Check my answers";
    }
  };

  const showVerdict = async (verdict: GradedSubmission): Promise<void> => {
    const byId = new Map(verdict.questions.map((question) => [question.id, question]));
    for (const field of fields) field.show(byId.get(field.id));
    outcome.replaceChildren(verdictSummary(verdict));
    await setMaths(form);
    outcome.focus({ preventScroll: true });
    const worst = fields.find((field) => byId.get(field.id)?.verdict !== "right");
    (verdict.passed && !worst ? outcome : (worst?.root ?? outcome)).scrollIntoView({ block: "nearest" });
  };

  form.addEventListener("submit", (event) => {
    event.preventDefault();
    void submit();
  });
  name.addEventListener("change", () => setStudent(name.value));
  const renamed = (): void => {
    if (document.activeElement !== name) name.value = student.get();
    void past.load();
  };
  addEventListener("triad:student", renamed);

  root.append(
    ...[
      h(
        "div",
        { class: "section-head" },
        h("h2", null, "Exercise"),
        h(
          "p",
          null,
          `${plural(questions.length, "question")}, ${plural(total, "point")}${lesson.exercise.pass_mark ? `; ${points(lesson.exercise.pass_mark * total)} to pass` : ""}`,
        ),
      ),
      whose(lesson),
      form,
      past.root,
    ].filter((part) => part !== null),
  );
  void past.load();
  return () => removeEventListener("triad:student", renamed);
}

/** Says whose numbers these are; without a name, asks for one. */
function whose(lesson: Lesson): HTMLElement | null {
  if (!lesson.has_variants) return null;
  if (lesson.seed)
    return h(
      "p",
      { class: "whose" },
      "These are the numbers of ",
      h("b", null, lesson.seed),
      ". Everybody has their own.",
    );
  const name = h("input", { id: "whose", class: "field", autocomplete: "name", maxlength: "80" });
  const form = h(
    "form",
    { class: "whose" },
    h("label", { for: "whose" }, "Everybody has their own numbers in this exercise. Your name:"),
    name,
    h("button", { class: "button small" }, "Show my numbers"),
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    if (name.value.trim()) setStudent(name.value);
    else name.focus();
  });
  return form;
}

/** A draft that was begun before the name was known goes on under the name. */
function rememberFor(lesson: Lesson, who: string, draft: string | null): void {
  const key: `draft:${string}` = `draft:${lesson.slug}:${who}`;
  if (draft && !recall(key)) remember(key, draft);
}

function readDraft(text: string | null): Record<string, string[]> {
  if (!text) return {};
  try {
    const value: unknown = JSON.parse(text);
    if (typeof value !== "object" || value === null) return {};
    return Object.fromEntries(
      Object.entries(value).filter(
        (entry): entry is [string, string[]] =>
          Array.isArray(entry[1]) && entry[1].every((part) => typeof part === "string"),
      ),
    );
  } catch {
    return {};
  }
}
