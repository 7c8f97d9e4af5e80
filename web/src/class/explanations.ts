// What a class predicted and explained in a lesson: read here, with the points of the explanations, which people give.
import { api } from "../api/client";
import type { ClassWords } from "../api/types";
import { announce, authored, h, setText, uid } from "../core/dom";
import { dateTime, points, typedNumber } from "../core/format";
import { setMaths } from "../core/maths";
import { t } from "../core/texts";
import { dialog } from "../ui/dialog";
import { problemNotice, skeleton } from "../ui/notice";
import { numberField } from "./policy-fields";

type Asked = ClassWords["explanations"][number];
type Student = ClassWords["students"][number];
type Explained = Student["explained"][number];

/** Whether somebody has to read it: it has no points, or other words since it had them. */
const waits = (one: Explained): boolean => one.mark == null || one.renewed;

export function saidSection(slug: string): HTMLElement {
  const place = h("div", null, skeleton(3));
  const root = h(
    "section",
    { class: "student-lesson", id: "said" },
    h("h2", null, t("What the class said")),
    place,
  );
  const load = async (): Promise<void> => {
    try {
      const words = await api.classWords(slug);
      root.hidden = words.predictions.length === 0 && words.explanations.length === 0;
      place.replaceChildren(...painted(words, load));
      await setMaths(place);
      if (location.hash === "#said") root.scrollIntoView();
    } catch (error) {
      place.replaceChildren(problemNotice(error, [{ label: t("Try again"), run: () => void load() }]));
    }
  };
  void load();
  return root;
}

function painted(words: ClassWords, again: () => Promise<void>): HTMLElement[] {
  const asked = words.explanations.map((one) => question(words, one, again));
  const roots = asked.map((one) => one.root);
  const count = (): void => {
    for (const one of asked) one.count();
  };
  if (words.students.length === 0)
    return [...roots, h("p", { class: "help" }, t("Nobody has predicted or explained anything yet."))];
  return [
    ...roots,
    h(
      "details",
      { class: "said-by", open: location.hash === "#said" },
      h(
        "summary",
        null,
        t("Read it, with names ({n} student) | Read it, with names ({n} students)", {
          n: words.students.length,
        }),
      ),
      h("ul", { class: "said-list" }, ...words.students.map((one) => student(words, one, count))),
    ),
  ];
}

/** Who waits for the points of a question. */
const waitingFor = (words: ClassWords, asked: Asked): Student[] =>
  words.students.filter((who) => who.explained.some((one) => one.question === asked.id && waits(one)));

/** What was to be explained, a good explanation, and how many wait, counted again when one was given points. */
function question(
  words: ClassWords,
  asked: Asked,
  again: () => Promise<void>,
): { root: HTMLElement; count: () => void } {
  const give = h("button", { type: "button", class: "button small" }, t("Give all that wait full points"));
  give.addEventListener("click", () => giveAll(words, asked, again));
  const waiting = h("span", { role: "status" });
  const count = (): void => {
    const { length } = waitingFor(words, asked);
    give.hidden = length === 0;
    const all =
      length === 0
        ? t("No explanation waits for points.")
        : t("{n} explanation waits for its points. | {n} explanations wait for their points.", { n: length });
    setText(waiting, all);
  };
  count();
  const root = h(
    "div",
    { class: "stack" },
    authored(h("div", { class: "prose" }), asked.prompt_html),
    h("p", { class: "row wrap" }, waiting, " ", give),
    h(
      "details",
      null,
      h("summary", null, t("A good explanation")),
      authored(h("div", { class: "prose" }), asked.good_html),
    ),
  );
  return { root, count };
}

function student(words: ClassWords, one: Student, count: () => void): HTMLElement {
  return h(
    "li",
    { class: "said" },
    h("h3", null, h("a", { href: `/class/${encodeURIComponent(one.person)}` }, one.name)),
    ...one.predicted.map((made) => prediction(words, made)),
    ...one.explained.map((explained) => explanation(words, one, explained, count)),
  );
}

function prediction(words: ClassWords, made: Student["predicted"][number]): HTMLElement {
  const asked = words.predictions.find((one) => one.id === made.prediction);
  const option = asked?.options.find((one) => one.id === made.choice);
  return h(
    "p",
    null,
    h("b", null, t("Predicted:"), " "),
    option ? authored(h("span", { class: "prediction-option" }), option.html) : t("skipped"),
    option
      ? h("span", { class: "flag" }, made.choice === asked?.happens ? t("came true") : t("went otherwise"))
      : null,
    made.why ? ` “${made.why}”` : "",
  );
}

function explanation(words: ClassWords, who: Student, one: Explained, count: () => void): HTMLElement {
  const most = words.explanations.find((asked) => asked.id === one.question)?.points ?? 0;
  const state = h("p", { class: "help", role: "status" }, stateOf(one, most));
  const [pointsId, remarkId] = [uid("points"), uid("remark")];
  const given = numberField(one.mark?.points == null ? "" : String(one.mark.points), { low: 0, high: most });
  given.id = pointsId;
  given.required = true;
  const remark = h("input", {
    id: remarkId,
    class: "field",
    maxlength: "2000",
    value: one.mark?.remark ?? "",
  });
  const form = h(
    "form",
    { class: "row wrap mark-form" },
    h("label", { for: pointsId }, t("Points, of {most}", { most: points(most) })),
    given,
    h("label", { for: remarkId }, t("Remark")),
    remark,
    h("button", { class: "button small" }, t("Give")),
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const decided = {
      lesson: words.slug,
      question: one.question,
      points: typedNumber(given.value),
      reason: remark.value.trim(),
    };
    api
      .decide(who.person, decided)
      .then(() => {
        state.textContent = t("{given} of {most} points given.", {
          given: points(decided.points),
          most: points(most),
        });
        // Who gives all that wait full points does not mean this one any more.
        const at = new Date().toISOString();
        one.mark = { question: one.question, points: decided.points, remark: decided.reason, by: "", at };
        one.renewed = false;
        place.classList.remove("is-waiting");
        count();
      })
      .catch((error: unknown) => state.replaceChildren(problemNotice(error)));
  });
  const place = h(
    "div",
    { class: `explained ${waits(one) ? "is-waiting" : ""}` },
    h(
      "p",
      null,
      h("b", null, t("Explained:"), " "),
      h("time", { datetime: one.at, class: "help" }, dateTime(one.at)),
    ),
    h("blockquote", { class: "explanation" }, one.text),
    state,
    form,
  );
  return place;
}

function stateOf(one: Explained, most: number): string {
  if (one.mark?.points == null) return t("Waits for its points.");
  const given = t("{given} of {most} points by {name}, {at}.", {
    given: points(one.mark.points),
    most: points(most),
    name: one.mark.by,
    at: dateTime(one.mark.at),
  });
  return one.renewed ? `${given} ${t("The words are other ones since: it waits once more.")}` : given;
}

/** Full points for everybody who waits, after one more question. */
function giveAll(words: ClassWords, asked: Asked, again: () => Promise<void>): void {
  const waiting = waitingFor(words, asked);
  const trouble = h("div", { "aria-live": "polite" });
  const give = h("button", { type: "button", class: "button primary" }, t("Give them"));
  give.addEventListener("click", async () => {
    give.disabled = true;
    try {
      for (const who of waiting)
        await api.decide(who.person, {
          lesson: words.slug,
          question: asked.id,
          points: asked.points,
          reason: "",
        });
      box.close();
      announce(
        t("{n} explanation got full points. | {n} explanations got full points.", { n: waiting.length }),
      );
      await again();
    } catch (error) {
      trouble.replaceChildren(problemNotice(error));
      give.disabled = false;
    }
  });
  const box = dialog(
    t("Full points for all that wait"),
    h(
      "p",
      null,
      t(
        "{n} student gets {points} points, read or not. Each can be changed later. | {n} students get {points} points, read or not. Each can be changed later.",
        { n: waiting.length, points: points(asked.points) },
      ),
    ),
    trouble,
    h("div", { class: "row" }, give),
  );
}
